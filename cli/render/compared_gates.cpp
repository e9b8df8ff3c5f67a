// SPDX-License-Identifier: MIT
#include "cli/render/compared_gates.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "cli/render/field_figure.h"
#include "cli/render/final_gates.h"
#include "cli/render/type_marks.h"

namespace gatewalk::cli {
namespace {

using markov::CellProbabilities;

constexpr double kMapWidth = 130, kMapGap = 16, kMapsLeft = 64, kMapsHead = 46;

}  // namespace

Figure figure_of(const std::vector<ComparedGates>& compared, const std::string& title,
                 const std::string& seen_head, const ShownField& shown, const MorePanels& more) {
  struct Row {
    FieldMap map;  // of all gates that either map reaches
    double top, height;
  };
  std::vector<Row> rows;
  double most = 0.0, largest = 0.0, end = kMapsHead;
  for (const ComparedGates& c : compared) {
    const FieldMap map(0.5 * (c.seen + c.chain), shown.field.start_column(), 60, 60);
    const CellProbabilities seen = map.blocks_of(c.seen), chain = map.blocks_of(c.chain);
    const double height = std::clamp(
        kMapWidth * static_cast<double>(chain.rows()) / static_cast<double>(chain.cols()), 60.0,
        240.0);
    rows.push_back({map, end + 24, height});
    end += 24 + height + 40;
    most = std::max({most, seen.maxCoeff(), chain.maxCoeff()});
    largest = std::max(largest, (seen - chain).abs().maxCoeff());
  }
  if (largest == 0.0) largest = 1e-4;
  end += 26;  // the name of the last row's axis
  const TypeMarks types(shown);
  const double below = end + 62 + types.legend_height(), bound = 100.0 * largest;
  const RootScale scale(100.0 * most);
  const std::string look = " scale 0.5 offset 0,0.4", tic = short_number(0.7 * bound);
  const auto left_of = [](int i) { return kMapsLeft + i * (kMapWidth + kMapGap); };
  const auto bar_of = [&](int first, int last) {
    return Box{left_of(first), left_of(last) + kMapWidth, end + 8, end + 18};
  };
  const std::string names[] = {"$seen", "$chain", "$difference"},
                    heads[] = {seen_head, "chain, %", "difference, points"};
  bool marked = false;
  Panels out;
  out.say(title, 8, 16);
  for (int i = 0; i < 3; ++i) out.say(heads[i], left_of(i), kMapsHead - 4, kSmallFont);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const auto& [map, top, height] = rows[k];
    const bool last = k + 1 == rows.size();
    for (int i = 0; i < 3; ++i) {
      Panel& panel = add_map(out, map, {left_of(i), left_of(i) + kMapWidth, top, top + height}, 34);
      panel.border = 15;
      if (!last) panel.x.name = "";
      if (i > 0) panel.y = {"", panel.y.low, panel.y.high, kNoTics};
      if (i == 0) panel.say(compared[k].summary, 8, top - 10, kSmallFont);
      Rows& data = out.data(names[i] + std::to_string(k));
      if (i < 2)
        add_shares(data, map, i == 0 ? compared[k].seen : compared[k].chain);
      else
        add_values(data,
                   100.0 * (map.blocks_of(compared[k].seen) - map.blocks_of(compared[k].chain)));
      panel.colours = i < 2 ? Colours{0, std::sqrt(scale.most())} : Colours{-bound, bound};
      if (i == 2) panel.colours->palette = kDiverging;
      if (last && i == 1) {
        panel.colours->bar = bar_of(0, 1);
        panel.colours->tics = fmt::format("({}){}", scale.tics(), look);
        panel.say("root scale", left_of(1) - 30, end + 50, kSmallFont);
      }
      if (last && i == 2) {
        panel.colours->bar = bar_of(2, 2);
        panel.colours->tics =
            fmt::format("('-{}' -{}, '0' 0, '+{}' {}){}", tic, tic, tic, tic, look);
      }
      panel.draw_cells(data);
      marked = types.draw_on(out, panel, map, data.name().substr(1)) || marked;
      if (last && i == 2) types.add_legend(panel, end + 60, marked);
    }
  }
  if (more.draw) more.draw(out, below);
  return out.figure(static_cast<int>(below + more.height));
}

}  // namespace gatewalk::cli
