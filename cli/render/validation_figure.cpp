// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "cli/render/field_figure.h"
#include "cli/render/figure.h"
#include "cli/render/final_gates.h"
#include "cli/render/start.h"
#include "cli/render/text.h"
#include "cli/render/type_marks.h"
#include "cli/render/validation.h"

namespace gatewalk::cli {
namespace {

using lattice::StartValidation;
using markov::CellProbabilities;

constexpr double kMapWidth = 130, kGap = 16, kLeft = 64, kHead = 46;

std::string rows_of(const CellProbabilities& blocks, bool roots) {
  std::string out;
  for (Eigen::Index r = 0; r < blocks.rows(); ++r)
    for (Eigen::Index c = 0; c < blocks.cols(); ++c) {
      const double percent = 100.0 * blocks(r, c);
      out += std::to_string(c) + " " + std::to_string(r) + " " +
             digits(roots ? std::sqrt(percent) : percent) + "\n";
    }
  return out;
}

std::string summary(const StartValidation& v, const ShownField& shown) {
  return title_of(shown.map.section, v.start) + ": total variation " +
         fixed(v.exact_against.total_variation, 3) +
         " (chance: " + fixed(v.exact_against.floor_total_variation, 3) + ")";
}

}  // namespace

Figure figure_of(const lattice::Validation& v, const ShownField& shown) {
  if (v.starts.empty() || v.starts.size() > kMostValidated)
    throw std::invalid_argument("a figure shows 1 to " + std::to_string(kMostValidated) +
                                " starts, these are " + std::to_string(v.starts.size()));
  std::vector<ComparedGates> compared;
  for (const StartValidation& s : v.starts)
    compared.push_back(
        {summary(s, shown), lattice::shares(s.dynamics.final_gates), s.exact.final_cells});
  return figure_of(compared, "final gates, " + std::to_string(v.trials) + " trials", "dynamics, %",
                   shown, panels_of(v.memory));
}

Figure figure_of(const std::vector<ComparedGates>& compared, const std::string& title,
                 const std::string& seen_head, const ShownField& shown, const MorePanels& more) {
  struct Row {
    FieldMap map;  // of what either of them reaches
    CellProbabilities seen, chain;
    double top, height;
  };
  std::vector<Row> rows;
  double most = 0.0, largest = 0.0, end = kHead;
  for (const ComparedGates& c : compared) {
    const FieldMap map(0.5 * (c.seen + c.chain), 60, 60);
    Row row{map, map.blocks_of(c.seen), map.blocks_of(c.chain), end + 24, 0.0};
    row.height = std::clamp(
        kMapWidth * static_cast<double>(row.chain.rows()) / static_cast<double>(row.chain.cols()),
        60.0, 240.0);
    end = row.top + row.height + 40;
    most = std::max({most, row.seen.maxCoeff(), row.chain.maxCoeff()});
    largest = std::max(largest, (row.seen - row.chain).abs().maxCoeff());
    rows.push_back(std::move(row));
  }
  if (largest == 0.0) largest = 1e-4;
  end += 26;  // the name of the last row's axis
  const TypeMarks types(shown);
  const double below = end + 62 + types.legend_height();
  const Sheet sheet{static_cast<int>(below + more.height)};
  bool marked = false;
  const RootScale scale(100.0 * most);
  const auto left_of = [](int i) { return kLeft + i * (kMapWidth + kGap); };
  std::string out =
      std::string("set multiplot\n") + kFrame + "set border 15\n" + sheet.text(title, 8, 16);
  const std::string heads[] = {seen_head, "chain, %", "difference, points"};
  for (int i = 0; i < 3; ++i) out += sheet.text(heads[i], left_of(i), kHead - 4, kSmallFont);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const Row& row = rows[k];
    const bool last = k + 1 == rows.size();
    const std::string tag = std::to_string(k);
    out += sheet.text(compared[k].summary, 8, row.top - 10, kSmallFont) + kFrame +
           "set border 15\nset xrange " + range_of(row.map.columns) + "\nset yrange " +
           range_of(row.map.rows) + "\nset xtics " +
           tics_of(row.map.columns, row.map.middle_column, kMapWidth, 34) + "\nset ytics " +
           tics_of(row.map.rows, 0, row.height, 22) + "\n" +
           Sheet::map_axes(row.map.rows.first + row.map.rows.count, last);
    const auto panel = [&](int i, const char* name, const std::string& data) {
      const std::string block = name + tag;
      const TypeMarks::Drawn marks =
          types.on(row.map, kMapWidth / static_cast<double>(row.chain.cols()),
                   row.height / static_cast<double>(row.chain.rows()), block.substr(1));
      marked = marked || marks.fits;
      if (last && i == 2) out += types.legend(sheet, end + 60, marked);
      out += data_block(block, data) + marks.data +
             sheet.margins({left_of(i), left_of(i) + kMapWidth, row.top, row.top + row.height}) +
             (i == 1 ? "unset ytics\nunset ylabel\n" : "") + "plot " + block + cells() +
             marks.plot + "\nunset label\n";
    };
    out += kSequential;
    out += "set cbrange " + scale.range() + "\nunset colorbox\n";
    panel(0, "$seen", rows_of(row.seen, true));
    if (last)
      out += "set cbtics (" + scale.tics() + ") scale 0.5 offset 0,0.4\n" +
             bar_below(sheet, left_of(0), left_of(1) + kMapWidth, end + 8) +
             sheet.text("root scale", left_of(1) - 30, end + 50, kSmallFont);
    panel(1, "$chain", rows_of(row.chain, true));
    out += kDiverging;
    const double bound = 100.0 * largest;
    out += "set cbrange [" + digits(-bound) + ":" + digits(bound) + "]\nunset colorbox\n";
    if (last) {
      const std::string tic = short_number(0.7 * bound);
      out += "set cbtics ('-" + tic + "' -" + tic + ", '0' 0, '+" + tic + "' " + tic +
             ") scale 0.5 offset 0,0.4\n" +
             bar_below(sheet, left_of(2), left_of(2) + kMapWidth, end + 8);
    }
    panel(2, "$difference", rows_of(row.seen - row.chain, false));
  }
  if (more.draw) out += more.draw(sheet, below);
  return {Sheet::kWidth, sheet.height, out + "unset multiplot\n", kFont};
}

}  // namespace gatewalk::cli
