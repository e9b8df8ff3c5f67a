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
  const SmallMap place(size);
  const FieldMap& map = place.map;
  const Box& box = place.box;
  const double width = place.width(), height = place.height(), columns = place.columns,
               rows = place.rows;
  const ShownField shown(d.after);
  const TypeMarks types(shown);
  const double legend = box.bottom + 52, bars_top = legend + types.legend_height() + 30;
  const std::vector<ShareBar> bars{
      {"as it is", d.design.before.share(), d.design.before.interval_95()},
      {"changed", d.design.crossings.share(), d.design.crossings.interval_95()}};
  const Box bars_box{130, 330, bars_top, bars_top + height_of_bars(bars.size())};
  const Sheet sheet{static_cast<int>(std::ceil(bars_box.bottom + 12))};

  // In a block of several gates the largest stands for all.
  std::string data, changed;
  double most = 0.0;
  for (Eigen::Index r = 0; r < map.rows.blocks(); ++r)
    for (Eigen::Index c = 0; c < map.columns.blocks(); ++c) {
      double largest = 0.0;
      bool differs = false;
      for (Eigen::Index i = 0; i < map.rows.block; ++i)
        for (Eigen::Index j = 0; j < map.columns.block; ++j) {
          const Eigen::Index row = map.rows.first + r * map.rows.block + i,
                             column = map.columns.first + c * map.columns.block + j;
          if (row < 0 || row >= size.rows() || column < 0 || column >= size.cols()) continue;
          const auto at = static_cast<std::size_t>(row * size.cols() + column);
          if (size(row, column) > std::abs(largest)) largest = best[at];
          differs = differs || before[at] != after[at];
        }
      most = std::max(most, std::abs(largest));
      const std::string at_gate = std::to_string(c) + " " + std::to_string(r) + " ";
      data += at_gate + digits(100.0 * largest) + "\n";
      if (differs) changed += at_gate + "1\n";
    }
  const TypeMarks::Drawn marks = types.on(map, width / columns, height / rows, "design");
  const double range = std::max(1e-6, 100.0 * most);
  return {
      Sheet::kWidth, sheet.height,
      "set multiplot\n" + data_block("$gains", data) +
          data_block("$changed", changed.empty() ? "0 0 NaN\n" : changed) + marks.data +
          sheet.margins(box) + kFrame + "set xrange " + range_of(map.columns) + "\nset yrange " +
          range_of(map.rows) + "\nset xtics " + tics_of(map.columns, map.middle_column, width, 30) +
          "\nset ytics " + tics_of(map.rows, 0, height, 22) + "\n" +
          Sheet::map_axes(map.rows.first + map.rows.count) +
          sheet.text("what the best change of a gate alone does, about, in % points", 8, 18) +
          kSequential + "set cbrange " +
          (d.options.least ? "[" + digits(-range) + ":0]" : "[0:" + digits(range) + "]") +
          "\nset cbtics autofreq scale 0\nset colorbox user origin screen " +
          sheet.at(box.right + 12, box.bottom) + " size screen " + digits(10.0 / Sheet::kWidth) +
          "," + digits((box.bottom - box.top) / sheet.height) + "\n" +
          types.legend(sheet, legend, marks.fits) + "plot $gains" + cells() +
          ", $changed using 1:($3 > 0 ? $2 : NaN) with points pt 4 lw 2 ps " +
          digits(std::clamp(0.09 * std::min(width / columns, height / rows), 0.4, 2.4)) +
          " lc rgb '#d55e00' notitle" + marks.plot + "\nunset label\nunset colorbox\n" +
          sheet.text("crossed, % (framed above: the gates that are changed)", 8, bars_top - 14) +
          share_bars(sheet, bars_box, "$crossed", bars) + "unset multiplot\n",
      kFont};
}

}  // namespace gatewalk::cli
