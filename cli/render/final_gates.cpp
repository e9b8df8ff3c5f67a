// SPDX-License-Identifier: MIT
#include "cli/render/final_gates.h"

#include <algorithm>
#include <cmath>

#include "cli/render/json.h"
#include "cli/render/text.h"
#include "lattice/statistics/compare.h"

namespace gatewalk::cli {

Json to_json(const lattice::Comparison& c) {
  Json j;
  j["corrcoef"] = c.corrcoef;
  j["corrcoef_floor"] = c.floor.corrcoef;
  j["rmse_per_100"] = c.rmse_per_100;
  j["rmse_per_100_floor"] = c.floor.rmse_per_100;
  j["total_variation"] = c.total_variation;
  j["total_variation_floor"] = c.floor_total_variation;
  j["total_variation_floor_95"] = c.floor_total_variation_95;
  j["p_values"] = {{"chi_squared", c.p_chi_squared},
                   {"total_variation", c.p_total_variation},
                   {"energy_distance", c.p_energy},
                   {"null_draws", c.null_draws}};
  return j;
}

Json to_json(const lattice::Judgement& j) {
  Json adjusted = {{"total_variation", j.total_variation.p_adjusted},
                   {"energy_distance", j.energy.p_adjusted},
                   {"chi_squared", j.chi_squared.p_adjusted}};
  for (const EndingName& e : kEndingNames)
    adjusted["endings"][e.key] = j.endings[static_cast<std::size_t>(e.ending)].p_adjusted;
  adjusted["endings"]["never_sampled"] =
      j.endings[static_cast<std::size_t>(markov::Ending::unsampled)].p_adjusted;
  return {{"differs", j.differs()},
          {"p", j.p},
          {"level", lattice::Judgement::kLevel},
          {"p_adjusted", adjusted},
          {"total_variation_by_chance",
           {{"mean", j.chance_total_variation}, {"at_95", j.chance_total_variation_95}}},
          {"null_draws", j.null_draws}};
}

namespace {

template <class Cells>
Json rows_of(const Cells& cells) {
  Json rows = Json::array();
  for (Eigen::Index r = 0; r < cells.rows(); ++r) {
    Json row = Json::array();
    for (Eigen::Index c = 0; c < cells.cols(); ++c) row.push_back(cells(r, c));
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace

Json grid(const markov::CellCounts& cells) { return rows_of(cells); }
Json grid(const markov::CellProbabilities& cells) { return rows_of(cells); }

namespace {

/// All of them if they can be printed; else those between ends that hold next to nothing, in blocks
/// if they are still too many.
FieldMap::Span span_of(const Eigen::ArrayXd& shares, Eigen::Index most) {
  constexpr double kNextToNothing = 5e-5;  // prints as 0.00 %
  FieldMap::Span span{0, shares.size(), 1};
  if (span.count <= most) return span;
  const double small = kNextToNothing * shares.sum();
  Eigen::Index low = 0, high = shares.size() - 1;
  for (double left = shares(low); left < small && low < high; left += shares(low)) ++low;
  for (double left = shares(high); left < small && high > low; left += shares(high)) --high;
  span = {low, high - low + 1, (high - low) / most + 1};
  return span;
}

}  // namespace

Json small_grid(const markov::CellCounts& cells) {
  return cells.size() > kMostGatesInJson ? Json() : grid(cells);
}
Json small_grid(const markov::CellProbabilities& cells) {
  return cells.size() > kMostGatesInJson ? Json() : grid(cells);
}

void say_left_out(Json& json, int columns, int rows) {
  if (Eigen::Index{columns} * rows <= kMostGatesInJson) return;
  json["left_out"] = "maps of " + std::to_string(columns) + " x " + std::to_string(rows) +
                     " gates (null here; JSON has up to " + std::to_string(kMostGatesInJson) +
                     " gates): --netcdf FILE.nc writes them";
}

void add_final_gates(Json& json, const markov::FinalDistribution& f) {
  json["final_gates"] = small_grid(f.final_cells);
  json["trapped_gates"] = small_grid(markov::trapped_cells(f));
  json["departed_gates"] = small_grid(markov::departed_cells(f));
  json["trapped"] = f.trapped;
  json["departed"] = f.left_field;
  json["cut_off"] = shown_endings(lattice::EndingShares(f.endings), f)
                        .share[static_cast<std::size_t>(markov::Ending::cut_off)];
  json["never_sampled"] = f.unsampled;
}

FieldMap::FieldMap(const markov::CellProbabilities& shares, Eigen::Index most_rows,
                   Eigen::Index most_columns)
    : rows(span_of(shares.rowwise().sum(), most_rows)),
      columns(span_of(shares.colwise().sum().transpose(), most_columns)),
      middle_column(shares.cols() / 2) {
  if (rows.block == 1 && columns.block == 1) return;
  // The start's column in the middle of a block, so that left and right can be compared.
  columns.block |= 1;
  const Eigen::Index end = columns.first + columns.count;
  const Eigen::Index to_left =
      middle_column - columns.block / 2 - columns.first;  // from the middle block
  columns.first +=
      to_left - (to_left + (to_left > 0 ? columns.block - 1 : 0)) / columns.block * columns.block;
  columns.count = end - columns.first;
}

markov::CellProbabilities FieldMap::blocks_of(const markov::CellProbabilities& shares) const {
  markov::CellProbabilities blocks(rows.blocks(), columns.blocks());
  for (Eigen::Index i = 0; i < blocks.rows(); ++i)
    for (Eigen::Index k = 0; k < blocks.cols(); ++k) {
      const Eigen::Index low = i * rows.block, from = columns.first + k * columns.block,
                         left = std::max<Eigen::Index>(0, from),
                         right = std::min(shares.cols(), from + columns.block);
      blocks(i, k) =
          shares.block(rows.first + low, left, std::min(rows.block, rows.count - low), right - left)
              .sum();
    }
  return blocks;
}

std::string elsewhere_text(const FieldMap& map, const markov::CellProbabilities& shares) {
  if (map.rows.count >= shares.rows() && map.columns.count >= shares.cols()) return "";
  return "elsewhere in the " + std::to_string(shares.cols()) + " x " +
         std::to_string(shares.rows()) +
         " gates: " + percent(std::max(0.0, shares.sum() - map.blocks_of(shares).sum()), 1.0, 4);
}

std::string short_percent(double share) {
  if (share == 0.0) return "\"\"";
  if (share < 5e-4) return "<.1";
  return fixed(100.0 * share, share < 0.0995 ? 1 : 0);
}

std::string map_of(const markov::CellProbabilities& shares, const std::string& what,
                   const std::string& unit) {
  const FieldMap map(shares, 40, 15);
  std::string text = what + ", " + unit + " (i_y upwards, i_x to the right";
  if (map.rows.block > 1 || map.columns.block > 1)
    text += "; blocks of " + std::to_string(map.columns.block) + " x " +
            std::to_string(map.rows.block) + " gates: i_x in their middle, i_y at their lower end";
  text += ")\n";
  const markov::CellProbabilities blocks = map.blocks_of(shares);
  int width = 7;  // shares take six places at most, and a blank; visits may take more
  for (const double share : blocks.reshaped())
    width = std::max(width, static_cast<int>(fixed(100.0 * share, 2).size()) + 1);
  for (Eigen::Index r = blocks.rows() - 1; r >= 0; --r) {
    text += padded(std::to_string(map.rows.first + r * map.rows.block), 4) + " |";
    for (const double share : blocks.row(r))
      text += padded(share == 0.0 ? "." : fixed(100.0 * share, 2), width);
    text += "\n";
  }
  text += "  i_x ";
  for (Eigen::Index c = 0; c < blocks.cols(); ++c)
    text += padded(std::to_string(map.columns.middle(c) - map.middle_column), width);
  text += "\n";
  if (const std::string rest = elsewhere_text(map, shares); !rest.empty()) text += rest + "\n";
  return text;
}

namespace {

constexpr auto kBack = static_cast<std::size_t>(lattice::kWentBack.ending);

/// `back`: some went back, which is an ending of its own then.
template <class Values>
Json by_name(const Values& values, bool back) {
  Json j;
  for (const EndingName& e : kEndingNames) j[e.key] = values[static_cast<std::size_t>(e.ending)];
  if (back) j[lattice::kWentBack.key] = values[kBack];
  return j;
}

}  // namespace

std::string percents(double share) {
  return share > 0.0 && share < 5e-5 ? digits(100.0 * share, 2) : fixed(100.0 * share, 2);
}

Json endings(const std::array<std::int64_t, markov::kEndings>& counts) {
  return by_name(counts, counts[kBack] > 0);
}
Json endings(const std::array<double, markov::kEndings>& shares) {
  return by_name(shares, shares[kBack] > 0.0);
}
Json endings_95(const lattice::EndingShares& shares) {
  return by_name(shares.interval, shares.share[kBack] > 0.0);
}

lattice::EndingShares shown_endings(lattice::EndingShares shares,
                                    const markov::FinalDistribution& f) {
  for (std::size_t e = 0; e < markov::kEndings; ++e) {
    constexpr double kHardlyAny = 1e-6;  // more than this is no rounding, whatever is left walking
    if (shares.share[e] > std::min(f.rounding + f.remainder, kHardlyAny)) continue;
    shares.share[e] = 0.0;
    if (!std::isnan(shares.interval[e][0])) shares.interval[e][0] = 0.0;
  }
  return shares;
}

Rest rest_of(const markov::FinalDistribution& f) {
  Rest rest{f.unsampled, f.remainder};
  if (f.endless > 0.0) rest.stopped = "in states without a way out";
  return rest;
}

std::string rest_text(const Rest& rest) {
  std::string text;
  if (rest.never_sampled > 0.0)
    text += "reach a state never sampled: " + percent(rest.never_sampled, 1.0, 4) + "\n";
  if (rest.still_walking > 1e-8)
    text += "still walking " + rest.stopped + ": " + percent(rest.still_walking, 1.0, 6) + "\n";
  return text;
}

std::string rest_warning(const Rest& rest, const std::string& where) {
  constexpr double kCounts = 1e-6;
  const double all = rest.never_sampled + rest.still_walking;
  if (!(all > kCounts)) return "";
  std::string what;
  const auto add = [&](double share, const std::string& words) {
    if (share > 0.0) what += (what.empty() ? "" : ", ") + percents(share) + " % " + words;
  };
  add(rest.never_sampled, "reach a state that was never sampled");
  add(rest.still_walking, "were still walking " + rest.stopped);
  return where + "the endings add up to " + percents(1.0 - all) + " %: " + what +
         "; how these end is not known, each share may be larger by as much";
}

std::string with_interval(double share, const std::array<double, 2>& interval) {
  if (std::isnan(interval[0])) return percents(share);
  return percents(share) + " [" + percents(interval[0]) + ", " + percents(interval[1]) + "]";
}

std::string endings_text(const lattice::EndingShares& shares, const std::string& of) {
  std::string text;
  std::vector<EndingName> names(kEndingNames.begin(), kEndingNames.end());
  if (shares.share[kBack] > 0.0) names.push_back(lattice::kWentBack);
  for (const EndingName& e : names) {
    const auto at = static_cast<std::size_t>(e.ending);
    text += padded(e.name, -11) + padded(percents(shares.share[at]), 7) + " %";
    if (!std::isnan(shares.interval[at][0]))
      text +=
          "  [" + percents(shares.interval[at][0]) + ", " + percents(shares.interval[at][1]) + "]";
    if (at == static_cast<std::size_t>(kEndingNames.front().ending)) text += "  " + of;
    text += "\n";
  }
  return text;
}

std::string map_of_trapped(const markov::CellProbabilities& shares) {
  constexpr Eigen::Index kMost = 15;
  if (shares.rows() > kMost || shares.cols() > kMost || shares.sum() == 0.0) return "";
  return map_of(shares, "of these trapped");
}

}  // namespace gatewalk::cli
