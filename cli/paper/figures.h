// SPDX-License-Identifier: MIT
#pragma once
/// The figures of the report and the sections of its page about them.

#include <Eigen/Core>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "cli/paper/findings.h"
#include "cli/paper/report.h"
#include "cli/render/panel.h"
#include "dynamics/disc/landscape.h"

namespace gatewalk::cli {

/// A section of the page before it is drawn: a figure and its numbers, or a film.
struct Section {
  const char* id;
  std::string heading;
  std::vector<std::string> text;
  std::string alt;                   // what is seen, in words
  std::vector<std::string> studies;  // whose commands gave the data, or those of claims about it
  std::string csv;                   // ID.csv
  Figure figure;                     // ID.svg, ID.pdf
  Json film = nullptr;               // null: none
};

/// Draws the figures into the current folder (fig8.svg, fig8.pdf, fig8.csv, ...) and returns the
/// sections of the page about them; `commands` are the studies' by their names. Throws Interrupted
/// after a signal.
[[nodiscard]] std::vector<Report::Section> sections_of(
    const Findings& f, const std::map<std::string, std::string>& commands);

// ---- One by one

// Landscapes and trajectories (figures_landscape.cpp, figures_trajectories.cpp)
[[nodiscard]] Section fig5();
[[nodiscard]] Section barriers(const Findings& f);
[[nodiscard]] Section fig6(const Findings& f);
[[nodiscard]] Section fig9(const Findings& f);
// Shares of trials (figures_shares.cpp)
[[nodiscard]] Section fig8(const Findings& f);
[[nodiscard]] Section fig12(const Findings& f);
[[nodiscard]] Section thirteen_eight(const Findings& f);
// The field (figures_field.cpp)
[[nodiscard]] Section fig11(const Findings& f);
[[nodiscard]] Section table4(const Findings& f);
[[nodiscard]] Section crossings(const Findings& f);
[[nodiscard]] Section speed(const Findings& f);
[[nodiscard]] Section replay(const Findings& f);

// ---- What several of them need (figures_common.cpp)

/// No panels yet, with axes as all of the paper's figures have them.
[[nodiscard]] Panels paper_panels();

/// Text with the paper's symbols as they are printed: F_prop, k_L, d = 50.
[[nodiscard]] Caption as_printed(const std::string& text);

/// A panel with the names of its axes (gnuplot drops those of its own that it finds too wide);
/// without a y its tics have no numbers. `room`: from the panel to the middle of its name.
Panel& add_panel(Panels& out, const Box& box, const std::string& x, const std::string& y,
                 double room = 48.0);

/// A share or percentage where a root scale has it; and the tics of such an axis, in %.
[[nodiscard]] inline double root_percent(double share) { return std::sqrt(100.0 * share); }
[[nodiscard]] std::string root_tics(const std::vector<double>& percents, bool numbers = true);

/// How lines of a grid look.
inline constexpr char kGrid[] = " lc rgb '#888888' lt 1 dt 3 lw 0.5";

/// A landscape from above with lines of equal energy (J), `step` apart; what is higher than the
/// ceiling, beside the joints, is drawn as that; grey where the disc would cover a joint.
struct EnergyMap {
  std::string name;  // "$A"
  double ceiling, step;

  static constexpr double kWidth = 175, kHeight = 227.5;  // px, of 50 m and 65 m
  /// Half of the paper's grid's, m.
  static constexpr double kSpacing = 0.25;
  /// Its data, and those of its lines; `energy`: what of the landscape is drawn.
  Rows& add_data(Panels& out, const dynamics::Landscape& l, const Eigen::ArrayXXd& energy) const;
  /// Its panel with its upper left corner there, and names of its axes.
  Panel& add(Panels& out, const Rows& rows, double left, double top, const std::string& x,
             const std::string& y) const;
  /// A bar of its colours, right of a map with its upper left corner there.
  void add_bar(Panel& panel, double left, double top) const;
};
/// A way over such a map: a line with a dark edge.
void draw_track(Panel& panel, const Rows& rows, const std::string& columns, double width,
                const char* colour);

/// Dots with 95 % bars in rows, the rows in groups: shares that vary with one setting at a time.
struct Series {
  std::string name;
  const char* colour;
  int marker;
};
struct RateRow {
  std::string label;
  std::vector<Share> shares;  // of each series; not a number: none
};
struct RateGroup {
  std::string name;
  std::vector<RateRow> rows;
  double mark = std::nan("");  // what the paper says of them
  std::string mark_label;
};
[[nodiscard]] Figure rates(const std::vector<std::string>& head, const std::vector<Series>& series,
                           const std::vector<RateGroup>& groups, const std::string& axis);
/// An axis of rows from above: labels as they are; of a group its name, bold.
[[nodiscard]] Axis row_axis(const std::vector<std::string>& labels);
[[nodiscard]] inline std::string bold(const std::string& text) { return "{/:Bold " + text + "}"; }

}  // namespace gatewalk::cli
