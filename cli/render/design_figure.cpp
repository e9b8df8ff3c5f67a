// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "cli/render/design.h"
#include "cli/render/field_figure.h"
#include "cli/render/final_gates.h"
#include "cli/render/shown_field.h"
#include "cli/render/text.h"
#include "cli/render/type_marks.h"

namespace gatewalk::cli {
Figure figure_of(const DesignedScene& d) {
  const std::vector<double> best = best_changes(d);
  const std::vector<int>&before = d.before.terrain->type_of_cell, &after = d.design.type_of_cell;
  markov::CellProbabilities size(d.before.field.rows, d.before.field.columns);
  for (std::size_t i = 0; i < best.size(); ++i) size.data()[i] = std::abs(best[i]);
  const auto [map, box] = SmallMap(size);
  const ShownField shown(d.after);
  const TypeMarks types(shown);
  const double legend = box.bottom + 52, bars_top = legend + types.legend_height() + 30;

  Panels out;
  Rows &gains = out.data("$gains"), &changed = out.data("$changed");
  double range = 1e-6;
  for (Eigen::Index r = 0; r < map.rows.blocks(); ++r)
    for (Eigen::Index c = 0; c < map.columns.blocks(); ++c) {
      double largest = 0.0;  // in a block of several gates it stands for all
      bool differs = false;
      for (const std::size_t gate : gates_in(map, r, c, d.before.field)) {
        if (std::abs(best[gate]) > std::abs(largest)) largest = best[gate];
        differs = differs || before[gate] != after[gate];
      }
      range = std::max(range, 100.0 * std::abs(largest));
      gains.add(c, r, 100.0 * largest);
      if (differs) changed.add(c, r, 1);
    }
  if (changed.empty()) changed.add(0, 0, "NaN");
  Panel& panel = add_map(out, map, box);
  panel.say("what the best change of a gate alone does, about, in % points", 8, 18);
  panel.colours = {d.options.least ? -range : 0.0, d.options.least ? 0.0 : range, box.beside(),
                   "autofreq scale 0"};
  panel.draw_cells(gains);
  const double cell = std::min(box.width() / static_cast<double>(map.columns.blocks()),
                               box.height() / static_cast<double>(map.rows.blocks()));
  panel.draw(changed, "1:($3 > 0 ? $2 : NaN)", "points",
             {kSecondColour, 2, 4, std::clamp(0.09 * cell, 0.4, 2.4)});
  types.add_legend(panel, legend, types.draw_on(out, panel, map, "design"));

  const std::vector<ShareBar> bars{
      {"as it is", d.design.before.share(), d.design.before.interval_95()},
      {"changed", d.design.crossings.share(), d.design.crossings.interval_95()}};
  const double end = bars_top + height_of_bars(bars.size());
  add_share_bars(out, {130, 330, bars_top, end}, "$crossed", bars)
      .say("crossed, % (framed above: the gates that are changed)", 8, bars_top - 14);
  return out.figure(static_cast<int>(std::ceil(end + 12)));
}

}  // namespace gatewalk::cli
