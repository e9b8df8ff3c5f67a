// SPDX-License-Identifier: MIT
#include "cli/render/final_gates.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "cli/fields/text.h"
#include "cli/fields/text_table.h"
#include "lattice/statistics/compare.h"
#include "lattice/statistics/paired_change.h"

namespace gatewalk::cli {

void describe(Fields& out, const lattice::Comparison& c) {
  const auto with_floor = [&](const Field& field, double value, std::string_view floor,
                              double by_chance) {
    out.number(field, value);
    out.number({floor, field.unit,
                "floor: value that sampling noise alone gives, the best to expect; null: unknown, "
                "as for pairs"},
               by_chance);
  };
  with_floor(
      {"corrcoef", "1", "Pearson correlation of the two maps of final gates, over all gates"},
      c.corrcoef, "corrcoef_floor", c.floor.corrcoef);
  with_floor({"rmse_per_100", "trials per 100",
              "root mean squared difference of the two maps of final gates, over all gates"},
             c.rmse_per_100, "rmse_per_100_floor", c.floor.rmse_per_100);
  with_floor(
      {"total_variation", "1",
       "total variation of the two maps of final gates: half the sum of absolute differences"},
      c.total_variation, "total_variation_floor", c.floor_total_variation);
  out.number({"total_variation_floor_q95", "1",
              "95 % of the total variations that sampling noise alone gives are at most this"},
             c.floor_total_variation_95);
  out.object(
      {"p_values", "p-values: how often chance makes the two maps at least as different"},
      [&](Fields& p) {
        p.number({"chi_squared", "1", "p-value of the chi-squared statistic"}, c.p_chi_squared);
        p.number({"total_variation", "1", "p-value of the total variation"}, c.p_total_variation);
        p.number({"energy_distance", "1", "p-value of the energy distance; null: too many gates"},
                 c.p_energy);
        p.count({"null_draws", "1", "random draws behind the p-values"}, c.null_draws);
      });
}

void describe_change(Fields& out, const lattice::PairedChange& change) {
  out.number({"changed_share", "1", "share of the trials whose final gate changes"},
             change.changed);
  out.number({"total_variation_uncertainty", "1",
              "95 %: the total variation may be this far from that of infinitely many trials"},
             change.uncertainty());
}

void describe_map(Fields& out, const Field& f, const markov::CellProbabilities& cells,
                  const GateLimits& limits) {
  if (cells.size() > kMostGatesInJson)
    out.no_estimated_grid(f);
  else
    out.grid(f, cells, limits);
}

void describe_by_chance(Fields& out, double mean, double q95) {
  out.object(
      {"total_variation_by_chance", "total variation of the final gates that chance alone makes"},
      [&](Fields& f) {
        f.number({"mean", "1", "mean over the random draws"}, mean);
        f.number({"q95", "1", "95 % of the random draws have at most this"}, q95);
      });
}

void describe(Fields& out, const lattice::JointTest& j) {
  out.flag({"differs", "verdict: whether p is at most the level"}, j.differs());
  out.number({"p", "1", "p-value of all statistics together: the smallest of p_adjusted"}, j.p);
  out.number({"level", "1", "level of significance of the verdict"}, lattice::JointTest::kLevel);
  out.object(
      {"p_adjusted", "p-value of each statistic, corrected for testing all; null: no counts of it"},
      [&](Fields& p) {
        p.number({"total_variation", "1", "p-value of the total variation of the final gates"},
                 j.total_variation.p_adjusted);
        p.number(
            {"energy_distance", "1",
             "p-value of the energy distance of the final gates; null also for too many gates"},
            j.energy.p_adjusted);
        p.number({"chi_squared", "1", "p-value of the chi-squared statistic of the final gates"},
                 j.chi_squared.p_adjusted);
        p.object({"endings", "p-value of the share of each ending"}, [&](Fields& e) {
          for (const EndingName& name : kEndingNames)
            e.number({name.key, "1",
                      fmt::format("p-value of the share of bodies that {}", meaning_of(name))},
                     j.endings[static_cast<std::size_t>(name.ending)].p_adjusted);
          e.number({"never_sampled", "1",
                    "p-value of the share of bodies that reach a state whose row has no run"},
                   j.endings[static_cast<std::size_t>(markov::Ending::unsampled)].p_adjusted);
        });
      });
  describe_by_chance(out, j.chance_total_variation, j.chance_total_variation_95);
  out.count({"null_draws", "1", "random draws behind the p-values"}, j.null_draws);
}

namespace {

/// The gates to show: all if they can be printed; else without the ends that hold next to nothing,
/// and in blocks if there are still too many.
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

void describe_left_out(Fields& out, int columns, int rows) {
  out.optional(Eigen::Index{columns} * rows > kMostGatesInJson, [&](Fields& f) {
    f.text({"left_out", "which maps are null because they have too many gates"},
           fmt::format("maps of {} x {} gates (null here; JSON has up to {} gates): --netcdf "
                       "FILE.nc writes them",
                       columns, rows, kMostGatesInJson));
  });
}

FieldMap::FieldMap(const markov::CellProbabilities& shares, Eigen::Index start,
                   Eigen::Index most_rows, Eigen::Index most_columns)
    : rows(span_of(shares.rowwise().sum(), most_rows)),
      columns(span_of(shares.colwise().sum().transpose(), most_columns)),
      start_column(start) {
  if (rows.block == 1 && columns.block == 1) return;
  // The start's column is in the middle of a block, so that left and right can be compared.
  columns.block |= 1;
  const Eigen::Index end = columns.first + columns.count;
  const Eigen::Index to_left =
      start_column - columns.block / 2 - columns.first;  // from the middle block
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
  return fmt::format("elsewhere in the {} x {} gates: {}", shares.cols(), shares.rows(),
                     percent(std::max(0.0, shares.sum() - map.blocks_of(shares).sum()), 1.0, 4));
}

std::string short_percent(double share) {
  if (share == 0.0) return "\"\"";
  if (share < 5e-4) return "<.1";
  return fixed(100.0 * share, share < 0.0995 ? 1 : 0);
}

std::string map_of(const markov::CellProbabilities& shares, Eigen::Index start,
                   const std::string& what, const std::string& unit) {
  constexpr Eigen::Index kMostRows = 40, kMostColumns = 12;  // with one more these fit into a line
  const FieldMap map(shares, start, kMostRows, kMostColumns);
  std::string text = fmt::format("{}, {} (i_y upwards, i_x to the right)\n", what, unit);
  if (map.rows.block > 1 || map.columns.block > 1)
    text += fmt::format(
        "(blocks of {} x {} gates; i_x is that of the middle gate, i_y that of the lowest)\n",
        map.columns.block, map.rows.block);
  const markov::CellProbabilities blocks = map.blocks_of(shares);
  int width = 7;  // shares take at most six places and a blank; visits may take more
  for (const double share : blocks.reshaped())
    width = std::max(width, static_cast<int>(fixed(100.0 * share, 2).size()) + 1);
  for (Eigen::Index r = blocks.rows() - 1; r >= 0; --r) {
    text += fmt::format("{:>4} |", map.rows.first + r * map.rows.block);
    for (const double share : blocks.row(r))
      text += fmt::format("{:>{}}", share == 0.0 ? "." : fixed(100.0 * share, 2), width);
    text += "\n";
  }
  text += "  i_x ";
  for (Eigen::Index c = 0; c < blocks.cols(); ++c)
    text += fmt::format("{:>{}}", map.columns.middle(c) - map.start_column, width);
  text += "\n";
  if (const std::string rest = elsewhere_text(map, shares); !rest.empty()) text += rest + "\n";
  return text;
}

namespace {

constexpr auto kBack = static_cast<std::size_t>(lattice::kWentBack.ending);

/// Calls `put` with key and meaning of each ending; `back` adds the ending "went back".
template <class Put>
void by_ending(Fields& f, bool back, std::string_view what, Put put) {
  const auto add = [&](const EndingName& e) {
    put(Field(e.key, "1", fmt::format("{} bodies that {}", what, meaning_of(e))),
        static_cast<std::size_t>(e.ending));
  };
  for (const EndingName& e : kEndingNames) add(e);
  f.optional(back, [&](Fields&) { add(lattice::kWentBack); });
}

constexpr char kNumberOf[] = "number of", kShareOf[] = "share of";

}  // namespace

std::string percents(double share) {
  return share > 0.0 && share < 5e-5 ? digits(100.0 * share, 2) : fixed(100.0 * share, 2);
}

std::string_view meaning_of(const EndingName& e) {
  switch (e.ending) {
    case markov::Ending::far_edge:
      return "leave the field over its far side";
    case markov::Ending::left_edge:
      return "leave the field over its left side";
    case markov::Ending::right_edge:
      return "leave the field over its right side";
    case markov::Ending::near_edge:
      return "leave the field over the side that they came in by";
    case markov::Ending::trapped:
      return "are trapped in a gate";
    case markov::Ending::cut_off:
      return "have visited as many gates as field.max_gates allows, and would have gone on";
    case markov::Ending::unsampled:
      break;
  }
  return "reach a state from which there is no gate run";
}

const EndingName& ending_name(markov::Ending ending) {
  return *std::ranges::find(kAllEndingNames, ending, &EndingName::ending);
}

std::vector<std::string> ending_keys() {
  std::vector<std::string> keys;
  for (const EndingName& e : kAllEndingNames) keys.emplace_back(e.key);
  return keys;
}

void describe_answer_from(Fields& out, bool from_trials) {
  out.text(
      Label("answer_from",
            "source of the answer: the chain, or the shares of the full trials if more precise")
          .one_of({"chain", "trials"}),
      from_trials ? "trials" : "chain");
}

void describe_endings(Fields& out, const Label& l, const EndingCounts& counts) {
  out.object(l, [&](Fields& f) {
    by_ending(f, counts[kBack] > 0, kNumberOf,
              [&](const Field& e, std::size_t at) { f.count(e, counts[at]); });
  });
}
void describe_endings(Fields& out, const Label& l, const EndingChances& shares) {
  out.object(l, [&](Fields& f) {
    by_ending(f, shares[kBack] > 0.0, kShareOf,
              [&](const Field& e, std::size_t at) { f.number(e, shares[at]); });
  });
}
void describe_endings(Fields& out, const Label& l, const EndingCounts& counts, double bodies,
                      const lattice::EndingShares& shares) {
  out.estimates(l, [&](Fields& f) {
    by_ending(f, counts[kBack] > 0, kNumberOf, [&](const Field& e, std::size_t at) {
      f.counted(e, counts[at], bodies, shares.interval[at]);
    });
  });
}
void describe_endings(Fields& out, const Label& l, const lattice::EndingShares& shares) {
  out.estimates(l, [&](Fields& f) {
    by_ending(f, shares.share[kBack] > 0.0, kShareOf, [&](const Field& e, std::size_t at) {
      f.estimate(e, shares.share[at], shares.interval[at]);
    });
  });
}

void describe_endings(Fields& out, const EndingCounts& counts, double bodies,
                      const lattice::EndingShares& shares) {
  describe_endings(out, {"endings", "how bodies end: number of bodies by ending"}, counts, bodies,
                   shares);
}
void describe_endings(Fields& out, const lattice::EndingShares& shares) {
  describe_endings(out, {"endings", "how bodies end: share of all bodies by ending"}, shares);
}

lattice::EndingShares shown_endings(lattice::EndingShares shares,
                                    const markov::FinalDistribution& f) {
  for (std::size_t e = 0; e < markov::kEndings; ++e) {
    constexpr double kHardlyAny = 1e-6;  // a larger share is no rounding error
    if (shares.share[e] > std::min(f.rounding + f.remainder, kHardlyAny)) continue;
    shares.share[e] = 0.0;
    if (!std::isnan(shares.interval[e][0])) shares.interval[e][0] = 0.0;
  }
  return shares;
}

Rest rest_of(const markov::FinalDistribution& f) {
  Rest rest{f.unsampled(), f.remainder};
  if (f.endless > 0.0) rest.stopped = "in states without a way out";
  return rest;
}

void describe(Fields& out, const Rest& rest) {
  out.number(
      {"never_sampled", "1",
       "share of bodies left out of endings because they reach a state whose row has no run"},
      rest.never_sampled);
  out.number({"still_walking", "1",
              "share of bodies left out of endings because they still walk when the program stops"},
             rest.still_walking);
}

std::string rest_text(const Rest& rest) {
  std::string text;
  if (rest.never_sampled > 0.0)
    text += fmt::format("Share that reaches a state without any run: {}\n",
                        percent(rest.never_sampled, 1.0, 4));
  if (rest.still_walking > 1e-8)
    text += fmt::format("Share that is still walking {}: {}\n", rest.stopped,
                        percent(rest.still_walking, 1.0, 6));
  return text;
}

std::string rest_warning(const Rest& rest, const std::string& where) {
  constexpr double kCounts = 1e-6;
  const double all = rest.never_sampled + rest.still_walking;
  if (!(all > kCounts)) return "";
  std::string what;
  const auto add = [&](double share, const std::string& words) {
    if (share > 0.0)
      what += fmt::format("{}{} % {}", what.empty() ? "" : ", ", percents(share), words);
  };
  add(rest.never_sampled, "reach a state that was never sampled");
  add(rest.still_walking, "were still walking " + rest.stopped);
  return fmt::format("{}the endings add up to {} %: {}; each share may be larger by as much", where,
                     percents(1.0 - all), what);
}

namespace {

/// percents(), but not with digits that mean nothing beside an interval that begins at 0.
std::string percents_beside(double share, const std::array<double, 2>& interval) {
  return interval[0] == 0.0 ? fixed(100.0 * share, 2) : percents(share);
}

}  // namespace

std::string with_interval(double share, const std::array<double, 2>& interval) {
  if (std::isnan(interval[0])) return percents(share);
  return fmt::format("{} [{}, {}]", percents_beside(share, interval), percents(interval[0]),
                     percents(interval[1]));
}

std::string endings_text(const lattice::EndingShares& shares, const std::string& of,
                         const std::vector<markov::Ending>& impossible) {
  std::string text;
  bool is_marked = false;
  for (const EndingName& e : kAllEndingNames) {
    if (shares.rules_out(e.ending)) continue;
    const auto at = static_cast<std::size_t>(e.ending);
    const auto& [low, high] = shares.interval[at];
    text += fmt::format("{:<11}{:>7} %", e.name,
                        percents_beside(shares.share[at], shares.interval[at]));
    if (shares.share[at] == 0.0 && std::ranges::count(impossible, e.ending) > 0) {
      text += "  -";
      is_marked = true;
    } else if (!std::isnan(low)) {
      text += fmt::format("  [{}, {}]", percents(low), percents(high));
    }
    if (!of.empty() && e.ending == kEndingNames.front().ending) text += "  " + of;
    text += "\n";
  }
  return text + (is_marked ? "-: impossible, because no sequence of moves leads there.\n" : "");
}

std::string map_of_trapped(const markov::CellProbabilities& shares, Eigen::Index start,
                           const std::string& unit) {
  constexpr Eigen::Index kMost = 15;
  if (shares.rows() > kMost || shares.cols() > kMost || shares.sum() == 0.0) return "";
  return map_of(shares, start, "Trapped bodies by gate", unit);
}

}  // namespace gatewalk::cli
