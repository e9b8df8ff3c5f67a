#pragma once
/// The figures of the report and the sections of its page about them.

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "cli/paper/findings.h"
#include "dynamics/landscape.h"

namespace gatewalk::cli {

struct Section {
  const char* id;
  std::string heading;
  std::vector<std::string> text;
  std::string alt;
  std::vector<std::string> studies;  // whose commands gave the data
  const char* chart;                 // page.h
  Json data;
  bool drawn = true;  // ID.csv, ID.svg, ID.pdf were written
};

/// Draws the figures into the current folder (fig8.svg, fig8.pdf, fig8.csv, ...) and returns the
/// sections of the page about them; `commands` are the studies' by their names. Throws Interrupted
/// after a signal.
[[nodiscard]] Json sections_of(const Findings& f,
                               const std::map<std::string, std::string>& commands);

// ---- One by one; each writes its CSV, SVG and PDF

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

// ---- What several of them need

/// NAME.svg and NAME.pdf from one script of gnuplot.
void draw(const std::string& name, int width, int height, const std::string& script);

/// Numbers as digits with spaces between them, a line of a table of gnuplot.
[[nodiscard]] std::string line_of(const std::vector<double>& values);

/// The multiple of `unit` next to x, for the page; null for what is no number.
[[nodiscard]] Json rounded(double x, double unit);

/// Energies of drawn landscapes beyond this are cut off: beside the joints they leave every scale.
inline constexpr double kCeiling = 500.0;  // J

/// A landscape as the page draws it: x, y (m) and rows of z (J, null: none).
[[nodiscard]] Json surface_of(const dynamics::GateParams& p, bool with_propulsion,
                              dynamics::BeamsThatPush beams = dynamics::kBothBeams);
/// The surface as blocks that gnuplot's pm3d reads, cut at the ceiling.
[[nodiscard]] std::string blocks_of(const Json& surface, double ceiling = kCeiling);
/// How surfaces are seen.
inline constexpr char kSurfaceLook[] = R"(
unset key
set pm3d scansautomatic
set xyplane 0
set xlabel 'x (m)'
set ylabel 'y (m)'
set xrange [-25:25]
set yrange [0:65]
set xtics 25
set ytics 20
set cblabel 'J'
)";

/// A share with its interval, in a row of the page's chart `rates`.
struct Rate {
  std::string label, group;
  Share share;
};
[[nodiscard]] Json to_json(const std::vector<Rate>& rates);
/// Horizontal dots with 95 % bars, grouped, and a line at the paper's value `mark` (%), up to
/// `most` (%).
void draw_rates(const std::string& name, const std::vector<Rate>& rates, double mark,
                const std::string& mark_label, const std::string& title, double most);
/// Names as tics 0, 1, 2 ... of a y axis.
[[nodiscard]] std::string tics_of(const std::vector<std::string>& names);

}  // namespace gatewalk::cli
