// SPDX-License-Identifier: MIT
#include "cli/render/field_figure.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "cli/render/exits.h"
#include "cli/render/final_gates.h"
#include "cli/render/text.h"
#include "cli/render/type_marks.h"

namespace gatewalk::cli {

using markov::CellProbabilities;

FieldPicture::FieldPicture(std::string name, const markov::FinalDistribution& final,
                           const lattice::EndingShares& shares, const lattice::FieldExits& by_place)
    : title(std::move(name)),
      final_gates(final.final_cells),
      trapped(markov::trapped_cells(final)),
      departed(markov::departed_cells(final)),
      endings(shown_endings(shares, final)),
      exits(by_place) {}

FieldPicture::FieldPicture(std::string name, const lattice::FieldTally& tally,
                           const lattice::FieldExits& by_place)
    : title(std::move(name)),
      final_gates(lattice::shares(tally.final_gates)),
      trapped(tally.trapped_gates.cast<double>() / static_cast<double>(tally.trials)),
      departed(tally.departed_gates.cast<double>() / static_cast<double>(tally.trials)),
      endings(tally.endings, tally.trials),
      exits(by_place) {}

FieldPicture::FieldPicture(std::string name, const markov::WalkTally& tally)
    : title(std::move(name)),
      final_gates(tally.final_cells.cast<double>() / static_cast<double>(tally.walks)),
      trapped(tally.trapped_cells.cast<double>() / static_cast<double>(tally.walks)),
      departed(tally.departed_cells.cast<double>() / static_cast<double>(tally.walks)),
      endings(tally.endings, tally.walks) {}

SmallMap::SmallMap(const markov::CellProbabilities& shown)
    : map(shown, 101, 101),  // gates, each way
      columns(static_cast<double>(map.columns.blocks())),
      rows(static_cast<double>(map.rows.blocks())) {
  constexpr double kLeft = 58, kTop = 44, kWidest = 300, kHighest = 300;
  const double cell = std::min(kWidest / columns, kHighest / rows);
  box = {kLeft, kLeft + std::max(0.3 * kWidest, cell * columns), kTop,
         kTop + std::max(100.0, cell * rows)};
}

std::string tics_of(const FieldMap::Span& span, Eigen::Index zero, double length, double apart) {
  std::string list;
  const auto most = std::max<Eigen::Index>(3, static_cast<Eigen::Index>(length / apart));
  const Eigen::Index blocks = span.blocks(), step = (blocks - 1) / most + 1;
  const Eigen::Index centre = std::clamp<Eigen::Index>(span.block_of(zero), 0, blocks - 1) % step;
  for (Eigen::Index i = centre; i < blocks; i += step)
    list += (list.empty() ? "'" : ", '") + std::to_string(span.middle(i) - zero) + "' " +
            std::to_string(i);
  return "(" + list + ")";
}

std::string range_of(const FieldMap::Span& span) {
  return "[-0.5:" + digits(static_cast<double>(span.blocks()) - 0.5) + "]";
}

namespace {

constexpr Eigen::Index kMostDrawn = 101;  // gates or blocks of gates, each way

/// Places within one picture, px.
struct Plan {
  static constexpr double kLeft = 58, kMap = 270, kSmall = 108, kSmallLeft = 384;
  double top, map_width, map_height, cell_width, cell_height, legend_height;
  bool with_exits;
  std::size_t endings;

  Plan(const FieldMap& map, double from_top, double legend, bool exits, std::size_t bars)
      : top(from_top + 42), legend_height(legend), with_exits(exits), endings(bars) {
    const auto columns = static_cast<double>(map.columns.blocks()),
               rows = static_cast<double>(map.rows.blocks());
    // Gates are drawn square where neither side would become too long or too short.
    const double cell = std::min(kMap / columns, 300.0 / rows);
    map_width = std::max(0.3 * kMap, cell * columns);
    map_height = std::max(120.0, cell * rows);
    cell_width = map_width / columns;
    cell_height = map_height / rows;
  }
  [[nodiscard]] Box map() const { return {kLeft, kLeft + map_width, top, top + map_height}; }
  [[nodiscard]] Box colours() const {
    const double left = map().right + 10;
    return {left, left + 10, top, top + map_height};
  }
  /// The upper (0) or lower (1) of the two small maps.
  [[nodiscard]] Box small(int i) const {
    const double each = std::min(kSmall * map_height / map_width, 0.5 * map_height - 14);
    const double begin = i == 0 ? top : top + map_height - each;
    return {kSmallLeft, kSmallLeft + std::min(kSmall, each * map_width / map_height), begin,
            begin + each};
  }
  [[nodiscard]] double legend() const { return map().bottom + 52; }
  [[nodiscard]] Box bars() const {
    const double begin = legend() + legend_height + 14;
    return {102, 300, begin, begin + height_of_bars(endings)};
  }
  [[nodiscard]] double exits() const { return bars().bottom + 8; }
  [[nodiscard]] double end() const { return exits() + (with_exits ? height_of_exits() : 0.0); }
};

/// "column row root_of_share label"
std::string rows_of(const FieldMap& map, const CellProbabilities& shares) {
  std::string out;
  const CellProbabilities shown = map.blocks_of(shares);
  for (Eigen::Index r = 0; r < shown.rows(); ++r)
    for (Eigen::Index c = 0; c < shown.cols(); ++c)
      out += std::to_string(c) + " " + std::to_string(r) + " " +
             digits(std::sqrt(100.0 * shown(r, c))) + " " + short_percent(shown(r, c)) + "\n";
  return out;
}

std::string image(const std::string& data) { return "plot " + data + cells(); }

/// The large map with its numbers.
std::string large_map(const FieldMap& map, const Plan& plan, const Sheet& sheet,
                      const std::string& data, const RootScale& scale, const TypeMarks& types) {
  const Box box = plan.map();
  std::string blocks;
  if (map.rows.block > 1 || map.columns.block > 1)
    blocks = ", blocks of " + std::to_string(map.columns.block) + " x " +
             std::to_string(map.rows.block) + " gates";
  std::string out = sheet.margins(box) + kFrame + "set xrange " + range_of(map.columns) +
                    "\nset yrange " + range_of(map.rows) + "\nset xtics " +
                    tics_of(map.columns, map.middle_column, plan.map_width, 30) + "\nset ytics " +
                    tics_of(map.rows, 0, plan.map_height, 22) + "\n" +
                    Sheet::map_axes(map.rows.first + map.rows.count) +
                    sheet.text("final gate, % of bodies" + blocks, Plan::kLeft, plan.top - 12) +
                    scale.colours(sheet, plan.colours());
  const TypeMarks::Drawn marks = types.on(map, plan.cell_width, plan.cell_height, data.substr(1));
  out += types.legend(sheet, plan.legend(), marks.fits) + marks.data + image(data);
  if (plan.cell_width >= 26 && plan.cell_height >= 15)
    out += ", '' using 1:2:4:" + ink(std::sqrt(scale.most())) +
           " with labels tc rgb variable font ',12'";
  return out + marks.plot + "\nunset label\n";
}

/// Maps without numbers: of whom, with the same colours.
std::string small_map(const std::string& title, const FieldMap& map, const Box& box,
                      const Sheet& sheet, const std::string& data) {
  return sheet.margins(box) +
         "set border 15\nunset xtics\nunset ytics\nunset xlabel\nunset "
         "ylabel\nset xrange " +
         range_of(map.columns) + "\nset yrange " + range_of(map.rows) + "\n" +
         sheet.text(title, box.left, box.top - 10, kSmallFont) + "unset colorbox\n" + image(data) +
         "\nunset label\n";
}

/// The endings with their intervals, and what they leave out; who went back where cells let bodies
/// go there.
std::vector<ShareBar> bars_of(const lattice::EndingShares& all, const ShownField& shown) {
  const lattice::EndingShares endings =
      std::isnan(all.interval.front().front()) ? all : all.with_limit(shown.field.max_gates);
  const auto& faces = shown.map.section.faces;
  const bool back = std::any_of(faces.begin(), faces.end(),
                                [](const dynamics::Face& face) { return face.di_y < 0; });
  std::vector<ShareBar> bars;
  for (const EndingName& e : kAllEndingNames) {
    if (e.ending == markov::Ending::near_edge && !back) continue;
    const auto at = static_cast<std::size_t>(e.ending);
    bars.push_back({e.name, endings.share[at], endings.interval[at]});
  }
  constexpr double kCounts = 1e-6;
  constexpr auto kUnsampled = static_cast<std::size_t>(markov::Ending::unsampled);
  if (endings.share[kUnsampled] > kCounts)
    bars.push_back({"never sampled", endings.share[kUnsampled], endings.interval[kUnsampled]});
  const double rest = 1.0 - std::accumulate(endings.share.begin(), endings.share.end(), 0.0);
  if (rest > kCounts) bars.push_back({"not known", rest, {std::nan(""), std::nan("")}});
  return bars;
}

}  // namespace

Figure figure_of(const std::vector<FieldPicture>& pictures, const ShownField& shown) {
  const TypeMarks types(shown);
  if (pictures.empty() || pictures.size() > kMostPictures)
    throw std::invalid_argument("a figure shows 1 to " + std::to_string(kMostPictures) +
                                " starts, these are " + std::to_string(pictures.size()));
  std::vector<FieldMap> maps;
  std::vector<Plan> plans;
  double height = 0.0, most = 0.0;
  for (const FieldPicture& p : pictures) {
    maps.emplace_back(p.final_gates, kMostDrawn, kMostDrawn);
    plans.emplace_back(maps.back(), height, types.legend_height(), p.exits.has_value(),
                       bars_of(p.endings, shown).size());
    height = plans.back().end();
    most = std::max(most, maps.back().blocks_of(p.final_gates).maxCoeff());
  }
  const RootScale scale(100.0 * most);
  const Sheet sheet{static_cast<int>(std::ceil(height))};
  std::string out =
      std::string(kSequential) + "set multiplot\n" + kFrame + "set cbrange " + scale.range() + "\n";
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const FieldPicture& p = pictures[i];
    const Plan& plan = plans[i];
    const std::string tag = std::to_string(i);
    const auto block = [&](const char* name, const CellProbabilities& shares) {
      return data_block(name + tag, rows_of(maps[i], shares));
    };
    if (const std::string rest = elsewhere_text(maps[i], p.final_gates); !rest.empty())
      out += sheet.text("elsewhere" + rest.substr(rest.rfind(':')), Plan::kSmallLeft - 24,
                        plan.top - 30, kSmallFont);
    out += block("$all", p.final_gates) + block("$trapped", p.trapped) +
           block("$left", p.departed) + sheet.text(p.title, 8, plan.top - 30) +
           large_map(maps[i], plan, sheet, "$all" + tag, scale, types) +
           small_map("trapped, % of all", maps[i], plan.small(0), sheet, "$trapped" + tag) +
           small_map("departed, % of all", maps[i], plan.small(1), sheet, "$left" + tag) +
           share_bars(sheet, plan.bars(), "$endings" + tag, bars_of(p.endings, shown));
    if (p.exits) out += panels_of(*p.exits, shown, sheet, plan.exits(), tag);
  }
  return {Sheet::kWidth, sheet.height, out + "unset multiplot\n", kFont};
}

}  // namespace gatewalk::cli
