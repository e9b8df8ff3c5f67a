#include <algorithm>
#include <cmath>

#include "cli/paper/figures.h"
#include "cli/paper/studies.h"
#include "cli/render/csv.h"
#include "cli/render/figure.h"
#include "cli/render/json.h"
#include "cli/render/provenance.h"
#include "cli/render/text.h"
#include "cli/terminal/gnuplot.h"
#include "cli/terminal/output.h"
#include "cli/web/html.h"

namespace gatewalk::cli {

namespace {

/// Every n-th moment and the last one.
Json thinned(const std::vector<double>& values, std::size_t n, double unit) {
  Json out = Json::array();
  for (std::size_t i = 0; i < values.size(); i += n) out.push_back(rounded(values[i], unit));
  if ((values.size() - 1) % n != 0) out.push_back(rounded(values.back(), unit));
  return out;
}

/// How far a run sinks below the landscape (J).
double depth_of(const TracedRun& run) {
  double depth = 0.0;
  for (std::size_t i = 0; i < run.t.size(); ++i)
    depth = std::fmax(depth, run.landscape[i] - run.potential[i]);
  return depth;
}

}  // namespace

Section fig6(const Findings& f) {
  // The run that sinks deepest below the landscape.
  const TracedRun& run = *std::max_element(
      f.fig6.runs.begin(), f.fig6.runs.end(),
      [](const TracedRun& a, const TracedRun& b) { return depth_of(a) < depth_of(b); });
  Csv csv("time_s,x_m,y_m,potential_J,landscape_J,landscape_right_beam_J");
  Json right = Json::array();
  std::string rows;
  for (std::size_t i = 0; i < run.t.size(); ++i) {
    const double one = run.landscape[i] - run.landscape_left[i];
    right.push_back(rounded(one, 0.01));
    csv.row(run.t[i], run.x[i], run.y[i], run.potential[i], run.landscape[i], one);
    rows += line_of({run.t[i], run.x[i], run.y[i], run.potential[i], run.landscape[i], one});
  }
  write_text_atomically("fig6.csv", csv.text());
  constexpr double kHigh = 650.0;  // J: 9 N lift the start above kCeiling
  const auto p = gate_of("scenes/single_gate.toml", {set(kPropulsion, 9), set(kRandom, 10)});
  const Json both = surface_of(p, true), alone = surface_of(p, true, {false, true});
  draw("fig6", 1200, 800,
       data_block("$run", rows) + data_block("$both", blocks_of(both, kHigh)) +
           data_block("$alone", blocks_of(alone, kHigh)) + kSequential + kSurfaceLook +
           filled(R"(
set cbrange [0:{{high}}]
set zrange [0:{{high}}]
set multiplot
set view 50,320
set size 0.5,0.58
set origin 0,0.42
set title 'B  over the landscape of both beams'
splot $both using 1:2:3 with pm3d, $run using 2:3:4 with lines lw 3 lc rgb '#d55e00'
set origin 0.5,0.42
set title 'C  over that of the right beam alone'
splot $alone using 1:2:3 with pm3d, $run using 2:3:4 with lines lw 3 lc rgb '#d55e00'
reset
set size 1,0.42
set origin 0,0
set key top right
set grid
set xlabel 'time (s)'
set ylabel 'energy (J)'
plot $run using 1:5 with lines lw 2 lc rgb '#999999' title 'landscape, both beams', \
     $run using 1:6 with lines lw 2 dt 2 lc rgb '#0072b2' title 'landscape, right beam alone', \
     $run using 1:4 with lines lw 2 lc rgb '#d55e00' title 'potential energy of the system'
unset multiplot
)",
                  {{"high", digits(kHigh)}}));
  Json surfaces = Json::array({both, alone});
  surfaces[0]["title"] = "landscape of both beams";
  surfaces[1]["title"] = "landscape of the right beam alone";
  return {"fig6",
          "Fig. 6: a trajectory that dives through the landscape",
          {"A body that pushes past the right beam (" + run.label +
           "). The landscape assumes that both beams are deflected; once the left one has let go, "
           "the system's energy is below it, here by up to " +
           fixed(depth_of(run), 0) +
           " J. With the landscape of the right beam alone that is gone or less (dashed)."},
          "Energies against time: the system's potential energy follows the landscape of both "
          "beams, then falls below it while it stays above that of the right beam alone.",
          {"fig6"},
          "penetration",
          {{"t", thinned(run.t, 1, 1e-3)},
           {"potential", thinned(run.potential, 1, 0.01)},
           {"landscape", thinned(run.landscape, 1, 0.01)},
           {"landscape_right", right},
           {"x", thinned(run.x, 1, 0.01)},
           {"y", thinned(run.y, 1, 0.01)},
           {"surfaces", surfaces},
           {"ceiling", kHigh}}};
}

namespace {

/// One of Fig. 9's panels: which study, with which beams.
struct Panel {
  const Trace& traced;
  double k_left, damping;
  const char* letter;

  [[nodiscard]] std::string title() const {
    return "k_L = " + digits(k_left) + ", k_R = 500, d = " + digits(damping);
  }
};

/// What gnuplot and the page draw of a panel.
struct DrawnPanel {
  std::string data, plot;
  Json json;
};

DrawnPanel drawn_panel(const Panel& panel, Csv& csv) {
  std::int64_t left = 0, right = 0;
  Json runs = Json::array();
  std::string tracks[2];
  for (const TracedRun& run : panel.traced.runs) {
    const bool to_right = run.ending == "traversed right";
    const std::string side = to_right ? "right" : "left";
    (to_right ? right : left) += 1;
    for (std::size_t i = 0; i < run.t.size(); i += 5) {
      csv.row(panel.letter, panel.k_left, panel.damping, static_cast<double>(run.trial), side,
              run.t[i], run.x[i], run.y[i], run.potential[i]);
      tracks[to_right] += line_of({run.x[i], run.y[i]});
    }
    tracks[to_right] += "\n";
    runs.push_back({{"side", side},
                    {"x", thinned(run.x, 5, 0.01)},
                    {"y", thinned(run.y, 5, 0.01)},
                    {"e", thinned(run.potential, 5, 0.1)}});
  }
  const Json surface =
      surface_of(gate_of("scenes/soft_left.toml", {set(kLeftStiffness, panel.k_left)}), true);
  const auto text = [&](std::int64_t n) {
    return std::to_string(n) + " of " + std::to_string(panel.traced.trials);
  };
  const std::string name = std::string("$") + panel.letter;
  DrawnPanel out;
  out.data = data_block(name, blocks_of(surface)) +
             data_block(name + "left", tracks[0].empty() ? "NaN NaN\n" : tracks[0]) +
             data_block(name + "right", tracks[1].empty() ? "NaN NaN\n" : tracks[1]);
  out.plot = filled(R"(
set title "{{letter}}  {{title}}\nleft {{left}}, right {{right}}"
plot {{name}} using 1:2:3 with image notitle, \
     {{name}}left using 1:2 with lines lw 1 lc rgb '#ffffff' title 'left', \
     {{name}}right using 1:2 with lines lw 1 lc rgb '#ff5050' title 'right'
)",
                    {{"letter", panel.letter},
                     {"title", panel.title()},
                     {"left", text(left)},
                     {"right", text(right)},
                     {"name", name}});
  out.json = {
      {"title", panel.title()}, {"left", text(left)}, {"right", text(right)}, {"runs", runs}};
  out.json.update(surface);
  return out;
}

}  // namespace

Section fig9(const Findings& f) {
  Json panels = Json::array();
  Csv csv("panel,k_left_Nm_per_rad,damping_Nms_per_rad,trial,side,time_s,x_m,y_m,potential_J");
  std::string data, plots;
  for (const Panel& panel : {Panel{f.fig9_500, 500, 50, "A"}, Panel{f.fig9_300, 300, 10, "B"},
                             Panel{f.fig9_100, 100, 10, "C"}}) {
    DrawnPanel out = drawn_panel(panel, csv);
    data += out.data;
    plots += out.plot;
    panels.push_back(std::move(out.json));
  }
  write_text_atomically("fig9.csv", csv.text());
  draw("fig9", 1300, 620,
       data + kSequential +
           filled(R"(
set cbrange [0:{{ceiling}}]
set multiplot layout 1,3
set xrange [-25:25]
set yrange [0:65]
set size ratio -1
set xlabel 'x (m)'
set ylabel 'y (m)'
set xtics 10
set cblabel 'J'
set key bottom left textcolor rgb '#ffffff'
{{plots}}
unset multiplot
)",
                  {{"ceiling", digits(kCeiling)}, {"plots", plots}}));
  return {"fig9",
          "Fig. 9: successful trajectories over the landscape",
          {"F_prop = 7 N, Rm = 10 N, k_R = 500 N m/rad. A softer left beam opens a way on its "
           "side. Left and right say which beam was deflected most, as in the paper; beyond its "
           "tip the body often goes to the other side.",
           "A: d = 50, as Table I prints it; so few get through that many are asked. B and C: 100 "
           "trials each, as in the paper, at d = 10 (the paper sees 52 % and 98 %; see the claims "
           "for d = 50). Height and colour are the landscape's energy."},
          "Three views from above: landscape in colour, trajectories as lines. A: a handful on "
          "both sides. B and C: many, all by the left.",
          {"fig9_500", "fig9_300", "fig9_100"},
          "trajectories",
          {{"panels", panels}, {"ceiling", kCeiling}}};
}
}  // namespace gatewalk::cli
