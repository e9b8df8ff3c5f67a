#include <algorithm>
#include <cmath>

#include "cli/paper/figures.h"
#include "cli/paper/studies.h"
#include "cli/render/csv.h"
#include "cli/render/figure.h"
#include "cli/render/provenance.h"
#include "cli/render/text.h"
#include "cli/terminal/gnuplot.h"
#include "cli/terminal/output.h"
#include "cli/web/html.h"

namespace gatewalk::cli {

Section fig5() {
  const auto equal = gate_of("scenes/single_gate.toml", {set(kPropulsion, 7)});
  const auto unequal =
      gate_of("scenes/single_gate.toml",
              {set(kPropulsion, 7), set(kLeftStiffness, 500), set(kRightStiffness, 250)});
  Json panels = Json::array();
  const auto add = [&](const char* name, const char* title, const Json& surface) {
    Json panel{{"name", name}, {"title", title}};
    panel.update(surface);
    panels.push_back(std::move(panel));
  };
  add("A", "elastic energy, k_L = k_R = 400", surface_of(equal, false));
  panels.push_back(panels[0]);
  panels[1]["name"] = "B";
  panels[1]["title"] = "the same from above";
  add("C", "elastic energy, k_L = 500, k_R = 250", surface_of(unequal, false));
  add("D", "with a propulsion of 7 N, k = 400", surface_of(equal, true));
  Csv csv("panel,x_m,y_m,energy_J");
  std::string script;
  for (const Json& p : panels) {
    const std::string name = p["name"];
    if (name == "B") continue;  // A's numbers
    script += data_block("$" + name, blocks_of(p));
    for (std::size_t i = 0; i < p["y"].size(); ++i)
      for (std::size_t j = 0; j < p["x"].size(); ++j)
        csv.row(name, p["x"][j].get<double>(), p["y"][i].get<double>(),
                p["z"][i][j].is_null() ? std::nan("") : p["z"][i][j].get<double>());
  }
  write_text_atomically("fig5.csv", csv.text());
  draw("fig5", 1100, 900,
       script + kSequential + kSurfaceLook +
           filled(R"(
set cbrange [0:{{ceiling}}]
set zrange [0:{{ceiling}}]
set multiplot layout 2,2
set view 55,335
set title 'A  elastic energy, k_L = k_R = 400 N m/rad'
splot $A every 2:2 using 1:2:3 with pm3d
set title 'B  the same from above'
plot $A using 1:2:3 with image pixels
set title 'C  k_L = 500, k_R = 250'
splot $C every 2:2 using 1:2:3 with pm3d
set title 'D  with the propulsion, F_{prop} = 7 N, k = 400'
splot $D every 2:2 using 1:2:3 with pm3d
unset multiplot
)",
                  {{"ceiling", digits(kCeiling)}}));
  return {
      "fig5",
      "Fig. 5: the potential energy landscape",
      {"Eqs. (14) and (15): what it costs to stand somewhere in the gate with both beams deflected "
       "forward. A: two barriers that overlap in the middle. "
       "C: a softer right beam has the lower one. D: a propulsion tilts it all, and a basin "
       "appears in front of the beams.",
       "Energies above 500 J, beside the joints, are cut off in the picture. Where the disc would "
       "cover a joint no angle of the beam is possible; that is drawn as the ceiling or left out. "
       "The propulsion's energy is zero at y = 65 m, where a single gate counts as traversed; the "
       "paper puts the zero at 60 m, which shifts all energies by 5 m times the propulsion."},
      "Four panels: elastic energy over the gate as a surface and from above with two ridges "
      "rising towards the joints; the same with unequal beams; with propulsion, tilted towards the "
      "far side.",
      {"fig5_symmetric", "fig5_asymmetric"},
      "landscapes",
      {{"panels", panels}, {"ceiling", kCeiling}}};
}

Section barriers(const Findings& f) {
  Csv csv("k_left_Nm_per_rad,damping_Nms_per_rad,above_start_J,above_basin_J,traversed,low,high");
  Json rows = Json::array();
  std::string lines[2];
  for (const auto& [k, landscape] : f.barriers) {
    const auto& [start, basin, downhill, place] = landscape.fine;
    for (const int damping : {10, 50}) {
      const Share s =
          f.fig12.at({{kDamping, damping}, {kPropulsion, 7}, {kRandom, 10}, {kLeftStiffness, k}})
              .traversed_share();
      const double none = std::nan("");
      csv.row(k, damping, downhill ? none : start, downhill ? none : basin, s.value, s.low, s.high);
      rows.push_back({{"k_left", k},
                      {"damping", damping},
                      {"above_start_J", downhill ? Json(nullptr) : Json(start)},
                      {"above_basin_J", basin},
                      {"traversed", s.value},
                      {"low", s.low},
                      {"high", s.high}});
      lines[damping == 10] +=
          std::to_string(k) + " " + line_of({basin, 100 * s.value, 100 * s.low, 100 * s.high});
    }
  }
  write_text_atomically("barriers.csv", csv.text());
  draw("barriers", 800, 480, data_block("$d50", lines[0]) + data_block("$d10", lines[1]) + R"(
set xlabel 'highest point of the lowest way through, above the basin before it (J; 0: no basin)'
set ylabel 'traversed (%)'
set yrange [-3:103]
set offsets graph 0.05, graph 0.05, 0, 0
set grid
set key top right
set title 'Who gets over the barrier: F_{prop} = 7 N, Rm = 10 N, k_R = 500, k_L = 100 to 500 N m/rad'
plot $d10 using 2:3:4:5 with yerrorlines pt 7 ps 0.7 lc rgb '#d55e00' title 'd = 10', \
     $d50 using 2:3:4:5 with yerrorlines pt 5 ps 0.7 lc rgb '#0072b2' title 'd = 50', \
     $d10 using 2:3:(sprintf('k_L %d', $1)) with labels offset 0,1 font ',9' notitle
)");
  return {"barriers",
          "Barriers and who passes them",
          {"Of all ways through the gate, the lowest one's highest point is the barrier (minimax "
           "path on a grid of 0.05 m); its height above the basin before it is what a body that "
           "has settled there must climb. Zero: no basin, downhill to the far side.",
           "Height is not all: the same barrier lets more through where beams are damped less. And "
           "the height above the start says little: with k_L = 450 the lowest way lies below the "
           "start, yet hardly anybody traverses, because hits and dampers take the energy."},
          "Traversal against the barrier's height above the basin: from nearly all without a basin "
          "to nearly none at 170 J.",
          {"barrier_100", "barrier_300", "barrier_500", "fig12"},
          "barriers",
          {{"rows", rows}}};
}
}  // namespace gatewalk::cli
