// SPDX-License-Identifier: MIT
#pragma once
/// The figures of the report, and the sections of its page about them.

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

/// A section of the page before its figure is drawn: a figure and its numbers, or a film.
struct Section {
  const char* id;
  std::string heading;
  std::vector<std::string> text;
  std::string alt;                   // what the figure shows, in words
  std::vector<std::string> studies;  // names of the studies behind the data
  std::string csv;                   // content of ID.csv
  Figure figure;                     // drawn as ID.svg and ID.pdf
  Json film = nullptr;               // null: none
};

/// Draws the figures into the current folder (fig8.svg, fig8.pdf, fig8.csv, ...) and returns the
/// sections of the page about them. `commands` are the commands of the studies by name. Throws
/// Interrupted after a signal.
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

// ---- Shared by several figures (figures_common.cpp)

/// An empty figure whose axes look as in all of the paper's figures.
[[nodiscard]] Panels paper_panels();

/// The text with symbols as the paper prints them: F_prop, k_L, d = 50.
[[nodiscard]] Caption as_printed(const std::string& text);

/// Adds a panel with titles of its axes, which gnuplot itself would drop if too wide. Without a y
/// title the y axis has no numbers. `room`: distance from the panel to the middle of the y title.
Panel& add_panel(Panels& out, const Box& box, const std::string& x, const std::string& y,
                 double room = 48.0);

/// The position of a share (0 to 1) on an axis with a square-root scale, and the tics of such an
/// axis in %.
[[nodiscard]] inline double root_percent(double share) { return std::sqrt(100.0 * share); }
[[nodiscard]] std::string root_tics(const std::vector<double>& percents, bool numbers = true);

/// gnuplot's style for grid lines.
inline constexpr char kGrid[] = " lc rgb '#888888' lt 1 dt 3 lw 0.5";

/// A landscape from above with contour lines every `step` (J). Energies above the ceiling, beside
/// the joints, are drawn as the ceiling. Places where the disc would cover a joint are grey.
struct EnergyMap {
  std::string name;  // gnuplot's name of the data, "$A"
  double ceiling, step;

  static constexpr double kWidth = 175, kHeight = 227.5;  // px, for 50 m and 65 m
  /// Half the spacing of the paper's grid, m.
  static constexpr double kSpacing = 0.25;
  /// Adds the data of the map and of its contour lines; `energy` is the part of the landscape to
  /// draw.
  Rows& add_data(Panels& out, const dynamics::Landscape& l, const Eigen::ArrayXXd& energy) const;
  /// Adds the panel with its upper left corner at (left, top), and titles of its axes.
  Panel& add(Panels& out, const Rows& rows, double left, double top, const std::string& x,
             const std::string& y) const;
  /// Adds a colour bar to the right of a map whose upper left corner is at (left, top).
  void add_bar(Panel& panel, double left, double top) const;
};
/// Draws a trajectory over a map: a line with a dark edge.
void draw_track(Panel& panel, const Rows& rows, const std::string& columns, double width,
                const char* colour);

/// Series of shares, drawn as dots with 95 % bars in groups of rows. Each row is a value of a
/// setting.
struct Series {
  std::string name;
  const char* colour;
  int marker;
};
struct RateRow {
  std::string label;
  std::vector<Share> shares;  // of each series; NaN: none
};
struct RateGroup {
  std::string name;
  std::vector<RateRow> rows;
  double mark = std::nan("");  // the value that the paper gives
  std::string mark_label;
};
[[nodiscard]] Figure rates(const std::vector<std::string>& head, const std::vector<Series>& series,
                           const std::vector<RateGroup>& groups, const std::string& axis);
/// An axis of rows from top to bottom, labelled as given; group names are bold.
[[nodiscard]] Axis row_axis(const std::vector<std::string>& labels);
[[nodiscard]] inline std::string bold(const std::string& text) { return "{/:Bold " + text + "}"; }

}  // namespace gatewalk::cli
