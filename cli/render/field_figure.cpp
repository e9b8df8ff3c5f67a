// SPDX-License-Identifier: MIT
#include "cli/render/field_figure.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "cli/fields/text.h"
#include "cli/render/exits.h"
#include "cli/render/final_gates.h"
#include "cli/render/type_marks.h"

namespace gatewalk::cli {

using markov::CellProbabilities;

SmallMap::SmallMap(const CellProbabilities& shown, const lattice::FieldParams& field)
    : map(shown, field.start_column(), 101, 101) {  // gates, each way
  constexpr double kLeft = 58, kTop = 44, kWidest = 300, kHighest = 300;
  const auto columns = static_cast<double>(map.columns.blocks()),
             rows = static_cast<double>(map.rows.blocks());
  const double cell = std::min(kWidest / columns, kHighest / rows);
  box = {kLeft, kLeft + std::max(0.3 * kWidest, cell * columns), kTop,
         kTop + std::max(100.0, cell * rows)};
}

Panel& add_map(Panels& out, const FieldMap& map, const Box& box, double apart) {
  // An axis over blocks of gates. Blocks are named by their middle gate, counted from `zero`.
  const auto axis = [](const char* name, const FieldMap::Span& span, Eigen::Index zero,
                       double length, double between) {
    const auto most = std::max<Eigen::Index>(3, static_cast<Eigen::Index>(length / between));
    const Eigen::Index blocks = span.blocks(), step = (blocks - 1) / most + 1;
    std::vector<Tic> tics;
    for (Eigen::Index i = std::clamp<Eigen::Index>(span.block_of(zero), 0, blocks - 1) % step;
         i < blocks; i += step)
      tics.push_back({std::to_string(span.middle(i) - zero), static_cast<double>(i)});
    return Axis{markup(name), -0.5, static_cast<double>(blocks) - 0.5, tics_of(tics)};
  };
  Panel& panel = out.add(box);
  panel.x = axis("column i_x", map.columns, map.start_column, box.width(), apart);
  panel.y = axis("row i_y", map.rows, 0, box.height(), 22);
  // The fewer digits the tics have, the further they are from the axis title.
  if (map.rows.first + map.rows.count <= 10) panel.y.name_look = "offset 0.2,0";
  return panel;
}

void add_shares(Rows& rows, const FieldMap& map, const CellProbabilities& shares, bool as_text) {
  const CellProbabilities shown = map.blocks_of(shares);
  if (!as_text) return add_values(rows, (100.0 * shown).sqrt());
  for (Eigen::Index r = 0; r < shown.rows(); ++r)
    for (Eigen::Index c = 0; c < shown.cols(); ++c)
      rows.add(c, r, std::sqrt(100.0 * shown(r, c)), short_percent(shown(r, c)));
}

void add_values(Rows& rows, const CellProbabilities& values) {
  for (Eigen::Index r = 0; r < values.rows(); ++r)
    for (Eigen::Index c = 0; c < values.cols(); ++c) rows.add(c, r, values(r, c));
}

std::vector<std::size_t> gates_in(const FieldMap& map, Eigen::Index row, Eigen::Index column,
                                  const lattice::FieldParams& field) {
  std::vector<std::size_t> gates;
  for (Eigen::Index i = 0; i < map.rows.block; ++i)
    for (Eigen::Index j = 0; j < map.columns.block; ++j) {
      const Eigen::Index y = map.rows.first + row * map.rows.block + i,
                         x = map.columns.first + column * map.columns.block + j;
      if (y >= 0 && y < field.rows && x >= 0 && x < field.columns)
        gates.push_back(static_cast<std::size_t>(y * field.columns + x));
    }
  return gates;
}

bool numbers_fit(const FieldMap& map, const Box& box) {
  return box.width() >= 26.0 * static_cast<double>(map.columns.blocks()) &&
         box.height() >= 15.0 * static_cast<double>(map.rows.blocks());
}

namespace {

constexpr Eigen::Index kMostDrawn = 101;  // gates or blocks, each way

/// The layout of a picture, px.
struct Plan {
  static constexpr double kLeft = 58, kMap = 270, kSmall = 108, kSmallLeft = 384;
  double top, map_width, map_height, legend_height;
  bool with_exits;
  std::size_t endings;

  Plan(const FieldMap& map, double from_top, double legend, bool exits, std::size_t bars)
      : top(from_top + 42), legend_height(legend), with_exits(exits), endings(bars) {
    const auto columns = static_cast<double>(map.columns.blocks()),
               rows = static_cast<double>(map.rows.blocks());
    // Gates are squares, unless a side would become too long or too short.
    const double cell = std::min(kMap / columns, 300.0 / rows);
    map_width = std::max(0.3 * kMap, cell * columns);
    map_height = std::max(120.0, cell * rows);
  }
  [[nodiscard]] Box map() const { return {kLeft, kLeft + map_width, top, top + map_height}; }
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

/// The large map with numbers in its cells.
void add_large_map(Panels& out, const FieldPicture& p, const FieldMap& map, const Plan& plan,
                   const Rows& rows, const RootScale& scale, const TypeMarks& types) {
  Panel& panel = add_map(out, map, plan.map());
  if (const std::string rest = elsewhere_text(map, p.final_gates); !rest.empty())
    panel.say("elsewhere" + rest.substr(rest.rfind(':')), Plan::kSmallLeft - 24, plan.top - 30,
              kSmallFont);
  panel.say(p.title, 8, plan.top - 30);
  std::string blocks;
  if (map.rows.block > 1 || map.columns.block > 1)
    blocks = fmt::format(", blocks of {} x {} gates", map.columns.block, map.rows.block);
  panel.say("final gate, % of bodies" + blocks, Plan::kLeft, plan.top - 12);
  add_colours(panel, scale, panel.box.beside(10));
  panel.draw_cells(rows);
  if (numbers_fit(map, panel.box)) panel.draw_numbers(std::sqrt(scale.most()));
  types.add_legend(panel, plan.legend(), types.draw_on(out, panel, map, rows.name().substr(1)));
}

/// A small map without numbers, with the same colours.
void add_small_map(Panels& out, const std::string& title, const FieldMap& map, const Box& box,
                   const Rows& rows, const RootScale& scale) {
  Panel& panel = add_map(out, map, box);
  for (Axis* axis : {&panel.x, &panel.y}) *axis = {"", axis->low, axis->high, kNoTics};
  panel.border = 15;
  panel.say(title, box.left, box.top - 10, kSmallFont);
  panel.colours = {0, std::sqrt(scale.most())};
  panel.draw_cells(rows);
}

/// Bars of the endings with their intervals, and of what the endings leave out; `went back` only in
/// fields where bodies can go back.
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
    throw std::invalid_argument(
        fmt::format("a figure shows 1 to {} starts, these are {}", kMostPictures, pictures.size()));
  std::vector<FieldMap> maps;
  std::vector<Plan> plans;
  double height = 0.0, most = 0.0;
  for (const FieldPicture& p : pictures) {
    maps.emplace_back(p.final_gates, shown.field.start_column(), kMostDrawn, kMostDrawn);
    plans.emplace_back(maps.back(), height, types.legend_height(), p.exits.has_value(),
                       bars_of(p.endings, shown).size());
    height = plans.back().end();
    most = std::max(most, maps.back().blocks_of(p.final_gates).maxCoeff());
  }
  const RootScale scale(100.0 * most);
  Panels out;
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const FieldPicture& p = pictures[i];
    const Plan& plan = plans[i];
    const std::string tag = std::to_string(i);
    const auto block = [&](const char* name, const CellProbabilities& shares) -> Rows& {
      Rows& rows = out.data(name + tag);
      add_shares(rows, maps[i], shares, true);
      return rows;
    };
    const Rows &all = block("$all", p.final_gates), &trapped = block("$trapped", p.trapped),
               &departed = block("$left", p.departed);
    add_large_map(out, p, maps[i], plan, all, scale, types);
    add_small_map(out, "trapped, % of all", maps[i], plan.small(0), trapped, scale);
    add_small_map(out, "departed, % of all", maps[i], plan.small(1), departed, scale);
    add_share_bars(out, plan.bars(), "$endings" + tag, bars_of(p.endings, shown)).y.tics +=
        " mirror offset 0,0";
    if (p.exits) add_exits(out, *p.exits, shown, plan.exits(), tag);
  }
  return out.figure(static_cast<int>(std::ceil(height)));
}

}  // namespace gatewalk::cli
