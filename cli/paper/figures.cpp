#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "cli/paper/studies.h"
#include "cli/render/drawing.h"
#include "cli/render/gnuplot.h"
#include "cli/render/report.h"
#include "cli/terminal/interrupt.h"
#include "cli/terminal/output.h"
#include "cli/web/embedded.h"
#include "dynamics/landscape.h"

namespace gatewalk::cli {
namespace {

constexpr double kCeiling =
    500.0;  // J, of drawn landscapes: beside the joints they leave every scale
constexpr double kSpacing = 1.0;  // m, of drawn landscapes

const char kViridis[] =
    "set palette defined (0 '#440154', 1 '#46327e', 2 '#365c8d', 3 '#277f8e', 4 '#1fa187', 5 "
    "'#4ac16d', 6 '#a0da39', 7 '#fde725')\n";

// ---- Files

/// NAME.svg and NAME.pdf from one script.
void draw(const std::string& name, int width, int height, const std::string& script) {
  draw_svg(name + ".svg", width, height, script);
  write_text_atomically(
      name + ".pdf",
      drawn("set terminal pdfcairo size " + digits(width / 100.0) + "," + digits(height / 100.0) +
            " font 'sans,10' background '#ffffff' enhanced\n" + script + "\n"));
}

/// Rows of a CSV file, each value as digits or text.
class Csv {
 public:
  explicit Csv(const std::string& header) : text_(header + "\n") {}
  template <class... T>
  void row(const T&... value) {
    std::string line;
    ((line += (line.empty() ? "" : ",") + field(value)), ...);
    text_ += line + "\n";
  }
  void write(const std::string& name) const { write_text_atomically(name + ".csv", text_); }

 private:
  static std::string field(double x) { return std::isnan(x) ? "" : digits(x); }
  static std::string field(const std::string& s) { return csv_text(s); }
  static std::string field(const char* s) { return csv_text(s); }
  std::string text_;
};

Json rounded(double x, double unit) {
  if (!std::isfinite(x)) return nullptr;
  // Through text: a multiple of 0.1 shall be written as one.
  return std::strtod(digits(std::round(x / unit) * unit).c_str(), nullptr);
}
Json or_null(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }
double as_double(const Json& j) { return j.is_number() ? j.get<double>() : std::nan(""); }

struct Section {
  const char* id;
  std::string heading;
  std::vector<std::string> text;
  std::string alt;
  std::vector<std::string> studies;  // whose commands gave the data
  const char* chart;
  Json data;
  bool drawn = true;  // ID.csv, ID.svg, ID.pdf were written
};

// ---- Landscapes

Json surface_of(const dynamics::GateParams& p, bool with_propulsion,
                dynamics::BeamsThatPush beams = dynamics::kBothBeams) {
  const dynamics::Landscape l = dynamics::landscape(p, 0.0, kSpacing, beams);
  const auto& e = with_propulsion ? l.total : l.elastic;
  Json s{{"x", Json::array()}, {"y", Json::array()}, {"z", Json::array()}};
  for (const double x : l.x) s["x"].push_back(rounded(x, 1e-3));
  for (std::size_t i = 0; i < l.y.size(); ++i) {
    s["y"].push_back(rounded(l.y[i], 1e-3));
    Json row = Json::array();
    for (std::size_t j = 0; j < l.x.size(); ++j) row.push_back(rounded(e(i, j), 0.1));
    s["z"].push_back(std::move(row));
  }
  return s;
}

/// The surface as blocks that gnuplot's pm3d reads, cut at the ceiling.
std::string blocks_of(const Json& surface, double ceiling = kCeiling) {
  std::string rows;
  const Json &x = surface["x"], &y = surface["y"], &z = surface["z"];
  for (std::size_t i = 0; i < y.size(); ++i) {
    for (std::size_t j = 0; j < x.size(); ++j) {
      const double e = z[i][j].is_number() ? std::min(z[i][j].get<double>(), ceiling) : ceiling;
      rows += x[j].dump() + " " + y[i].dump() + " " + digits(e) + "\n";
    }
    rows += "\n";
  }
  return rows;
}

const char kSurfaceLook[] =
    "unset key\nset pm3d scansautomatic\nset xyplane 0\nset xlabel 'x (m)'\nset ylabel 'y "
    "(m)'\nset xrange [-25:25]\nset yrange [0:65]\n"
    "set xtics 25\nset ytics 20\nset cblabel 'J'\n";

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
  std::string script = std::string(kViridis) + kSurfaceLook + "set cbrange [0:" + digits(kCeiling) +
                       "]\nset zrange [0:" + digits(kCeiling) + "]\n";
  for (const Json& p : panels) {
    const std::string name = p["name"];
    if (name == "B") continue;  // A's numbers
    script += data_block("$" + name, blocks_of(p));
    for (std::size_t i = 0; i < p["y"].size(); ++i)
      for (std::size_t j = 0; j < p["x"].size(); ++j)
        csv.row(name, as_double(p["x"][j]), as_double(p["y"][i]), as_double(p["z"][i][j]));
  }
  csv.write("fig5");
  script +=
      "set multiplot layout 2,2\nset view 55,335\n"
      "set title 'A  elastic energy, k_L = k_R = 400 N m/rad'\nsplot $A every 2:2 using 1:2:3 with "
      "pm3d\n"
      "set title 'B  the same from above'\nplot $A using 1:2:3 with image pixels\n"
      "set title 'C  k_L = 500, k_R = 250'\nsplot $C every 2:2 using 1:2:3 with pm3d\n"
      "set title 'D  with the propulsion, F_{prop} = 7 N, k = 400'\nsplot $D every 2:2 using 1:2:3 "
      "with pm3d\nunset multiplot\n";
  draw("fig5", 1100, 900, script);
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
  for (int k = 100; k <= 500; k += 50) {
    const auto found = f.data.find("barrier_" + std::to_string(k));
    if (found == f.data.end()) continue;
    const Json& pass = found->second.at("passes").back();
    const bool downhill = pass.at("from_basin").at("way_m").size() == 1;
    const double start = pass.at("above_start_J"),
                 basin =
                     downhill ? std::nan("") : pass.at("from_basin").at("barrier_J").get<double>();
    for (const int damping : {10, 50}) {
      const Share s = traversed_at(
          f["fig12"], {{kDamping, damping}, {kPropulsion, 7}, {kRandom, 10}, {kLeftStiffness, k}});
      csv.row(k, damping, downhill ? std::nan("") : start, basin, s.value, s.low, s.high);
      rows.push_back({{"k_left", k},
                      {"damping", damping},
                      {"above_start_J", downhill ? Json(nullptr) : Json(start)},
                      {"above_basin_J", downhill ? 0.0 : basin},
                      {"traversed", s.value},
                      {"low", s.low},
                      {"high", s.high}});
      lines[damping == 10] += std::to_string(k) + " " + digits(downhill ? 0.0 : basin) + " " +
                              digits(100 * s.value) + " " + digits(100 * s.low) + " " +
                              digits(100 * s.high) + "\n";
    }
  }
  csv.write("barriers");
  draw(
      "barriers", 800, 480,
      data_block("$d50", lines[0]) + data_block("$d10", lines[1]) +
          "set xlabel 'highest point of the lowest way through, above the basin before it (J; 0: "
          "no basin)'\nset ylabel 'traversed (%)'\nset yrange [-3:103]\n"
          "set offsets graph 0.05, graph 0.05, 0, 0\nset grid\nset key top right\nset title 'Who "
          "gets over the barrier: F_{prop} = 7 N, Rm = 10 N, k_R = 500, k_L = 100 to 500 N m/rad'\n"
          "plot $d10 using 2:3:4:5 with yerrorlines pt 7 ps 0.7 lc rgb '#d55e00' title 'd = 10', "
          "$d50 using 2:3:4:5 with yerrorlines pt 5 ps 0.7 lc rgb '#0072b2' title 'd = 50', "
          "$d10 using 2:3:(sprintf('k_L %d', $1)) with labels offset 0,1 font ',9' notitle\n");
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

// ---- Trajectories

/// Every n-th moment and the last one.
Json thinned(const Json& values, std::size_t n, double unit) {
  Json out = Json::array();
  for (std::size_t i = 0; i < values.size(); i += n)
    out.push_back(rounded(as_double(values[i]), unit));
  if ((values.size() - 1) % n != 0) out.push_back(rounded(as_double(values.back()), unit));
  return out;
}

Section fig6(const Findings& f) {
  // The run that sinks deepest below the landscape.
  const Json* deepest = nullptr;
  double depth = 0.0;
  for (const Json& run : f["fig6"].at("runs"))
    for (std::size_t i = 0; i < run.at("t").size(); ++i) {
      const double below =
          as_double(run.at("landscape_J")[i]) - as_double(run.at("potential_J")[i]);
      if (below > depth) {
        depth = below;
        deepest = &run;
      }
    }
  if (deepest == nullptr) deepest = &f["fig6"].at("runs").front();
  const Json& run = *deepest;
  const std::size_t n = run.at("t").size();
  Csv csv("time_s,x_m,y_m,potential_J,landscape_J,landscape_right_beam_J");
  Json right = Json::array();
  std::string rows;
  for (std::size_t i = 0; i < n; ++i) {
    const double one =
        as_double(run.at("landscape_J")[i]) - as_double(run.at("landscape_left_J")[i]);
    right.push_back(rounded(one, 0.01));
    csv.row(as_double(run["t"][i]), as_double(run["x"][i]), as_double(run["y"][i]),
            as_double(run["potential_J"][i]), as_double(run["landscape_J"][i]), one);
    rows += digits(as_double(run["t"][i])) + " " + digits(as_double(run["x"][i])) + " " +
            digits(as_double(run["y"][i])) + " " + digits(as_double(run["potential_J"][i])) + " " +
            digits(as_double(run["landscape_J"][i])) + " " + digits(one) + "\n";
  }
  csv.write("fig6");
  constexpr double kHigh = 650.0;  // J: 9 N lift the start above kCeiling
  const auto p = gate_of("scenes/single_gate.toml", {set(kPropulsion, 9), set(kRandom, 10)});
  const Json both = surface_of(p, true), alone = surface_of(p, true, {false, true});
  draw("fig6", 1200, 800,
       data_block("$run", rows) + data_block("$both", blocks_of(both, kHigh)) +
           data_block("$alone", blocks_of(alone, kHigh)) + kViridis + kSurfaceLook +
           "set cbrange [0:" + digits(kHigh) + "]\nset zrange [0:" + digits(kHigh) +
           "]\nset multiplot\nset view 50,320\n"
           "set size 0.5,0.58\nset origin 0,0.42\nset title 'B  over the landscape of both beams'\n"
           "splot $both using 1:2:3 with pm3d, $run using 2:3:4 with lines lw 3 lc rgb '#d55e00'\n"
           "set origin 0.5,0.42\nset title 'C  over that of the right beam alone'\n"
           "splot $alone using 1:2:3 with pm3d, $run using 2:3:4 with lines lw 3 lc rgb '#d55e00'\n"
           "reset\nset size 1,0.42\nset origin 0,0\nset key top right\nset grid\nset xlabel 'time "
           "(s)'\nset ylabel 'energy (J)'\n"
           "plot $run using 1:5 with lines lw 2 lc rgb '#999999' title 'landscape, both beams', "
           "$run using 1:6 with lines lw 2 dt 2 lc rgb '#0072b2' title 'landscape, right beam "
           "alone', "
           "$run using 1:4 with lines lw 2 lc rgb '#d55e00' title 'potential energy of the "
           "system'\nunset multiplot\n");
  Json surfaces = Json::array({both, alone});
  surfaces[0]["title"] = "landscape of both beams";
  surfaces[1]["title"] = "landscape of the right beam alone";
  return {"fig6",
          "Fig. 6: a trajectory that dives through the landscape",
          {"A body that pushes past the right beam (" + run.at("label").get<std::string>() +
           "). The landscape assumes that both beams are deflected; once the left one has let go, "
           "the system's energy is below it, here by up to " +
           fixed(depth, 0) +
           " J. With the landscape of the right beam alone that is gone or less (dashed)."},
          "Energies against time: the system's potential energy follows the landscape of both "
          "beams, then falls below it while it stays above that of the right beam alone.",
          {"fig6"},
          "penetration",
          {{"t", thinned(run["t"], 1, 1e-3)},
           {"potential", thinned(run["potential_J"], 1, 0.01)},
           {"landscape", thinned(run["landscape_J"], 1, 0.01)},
           {"landscape_right", right},
           {"x", thinned(run["x"], 1, 0.01)},
           {"y", thinned(run["y"], 1, 0.01)},
           {"surfaces", surfaces},
           {"ceiling", kHigh}}};
}

Section fig9(const Findings& f) {
  struct Panel {
    const char* study;
    double k_left, damping;
    const char* letter;
  };
  Json panels = Json::array();
  Csv csv("panel,k_left_Nm_per_rad,damping_Nms_per_rad,trial,side,time_s,x_m,y_m,potential_J");
  std::string script = std::string(kViridis) + "set cbrange [0:" + digits(kCeiling) + "]\n";
  std::string plots;
  for (const Panel& panel : {Panel{"fig9_500", 500, 50, "A"}, Panel{"fig9_300", 300, 10, "B"},
                             Panel{"fig9_100", 100, 10, "C"}}) {
    const Json& traced = f[panel.study];
    std::int64_t left = 0, right = 0;
    Json runs = Json::array();
    std::string tracks[2];
    for (const Json& run : traced.at("runs")) {
      const bool to_right = run.at("ending") == "traversed right";
      (to_right ? right : left) += 1;
      const std::size_t n = run.at("t").size();
      for (std::size_t i = 0; i < n; i += 5) {
        csv.row(panel.letter, panel.k_left, panel.damping, as_double(run["trial"]),
                to_right ? "right" : "left", as_double(run["t"][i]), as_double(run["x"][i]),
                as_double(run["y"][i]), as_double(run["potential_J"][i]));
        tracks[to_right] +=
            digits(as_double(run["x"][i])) + " " + digits(as_double(run["y"][i])) + "\n";
      }
      tracks[to_right] += "\n";
      runs.push_back({{"side", to_right ? "right" : "left"},
                      {"x", thinned(run["x"], 5, 0.01)},
                      {"y", thinned(run["y"], 5, 0.01)},
                      {"e", thinned(run["potential_J"], 5, 0.1)}});
    }
    const auto p = gate_of("scenes/soft_left.toml", {set(kLeftStiffness, panel.k_left)});
    Json surface = surface_of(p, true);
    const std::int64_t trials = traced.at("trials");
    const auto text = [&](std::int64_t n) {
      return std::to_string(n) + " of " + std::to_string(trials);
    };
    const std::string title =
        "k_L = " + digits(panel.k_left) + ", k_R = 500, d = " + digits(panel.damping);
    const std::string name = std::string("$") + panel.letter;
    script += data_block(name, blocks_of(surface)) +
              data_block(name + "left", tracks[0].empty() ? "NaN NaN\n" : tracks[0]) +
              data_block(name + "right", tracks[1].empty() ? "NaN NaN\n" : tracks[1]);
    plots += "set title \"" + std::string(panel.letter) + "  " + title + "\\nleft " + text(left) +
             ", right " + text(right) + "\"\nplot " + name + " using 1:2:3 with image notitle, " +
             name + "left using 1:2 with lines lw 1 lc rgb '#ffffff' title 'left', " + name +
             "right using 1:2 with lines lw 1 lc rgb '#ff5050' title 'right'\n";
    Json out{{"title", title}, {"left", text(left)}, {"right", text(right)}, {"runs", runs}};
    out.update(surface);
    panels.push_back(std::move(out));
  }
  csv.write("fig9");
  script +=
      "set multiplot layout 1,3\nset xrange [-25:25]\nset yrange [0:65]\nset size ratio -1\nset "
      "xlabel 'x (m)'\nset ylabel 'y (m)'\nset xtics 10\nset cblabel 'J'\n"
      "set key bottom left textcolor rgb '#ffffff'\n" +
      plots + "unset multiplot\n";
  draw("fig9", 1300, 620, script);
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

// ---- Shares

Section fig8(const Findings& f) {
  Json rows = Json::array();
  Csv csv("damping_Nms_per_rad,propulsion_N,random_N,trials,traversed,low,high,exited,trapped");
  std::string map[2], series[2];
  for (const int damping : {50, 10}) {
    for (int random = 0; random <= 60; random += 10) {
      for (int force = 4; force <= 9; ++force) {
        const At at{{kDamping, damping}, {kPropulsion, force}, {kRandom, random}};
        const Json& p = point_at(f["fig8"], at);
        const Share s = traversed_at(f["fig8"], at);
        const auto n = static_cast<double>(s.whole);
        const double exited =
                         (p.at("exited_left").get<double>() + p.at("exited_right").get<double>()) /
                         n,
                     trapped = p.at("trapped").get<double>() / n;
        rows.push_back({{"damping", damping},
                        {"propulsion", force},
                        {"random", random},
                        {"traversed", s.value},
                        {"low", s.low},
                        {"high", s.high},
                        {"exited", exited},
                        {"trapped", trapped},
                        {"trials", s.whole}});
        csv.row(damping, force, random, n, s.value, s.low, s.high, exited, trapped);
        map[damping == 10] += std::to_string(force) + " " + std::to_string(random) + " " +
                              digits(100 * s.value) + "\n";
        series[damping == 10] += std::to_string(force) + " " + std::to_string(random) + " " +
                                 digits(100 * s.value) + " " + digits(100 * s.low) + " " +
                                 digits(100 * s.high) + "\n";
      }
      series[damping == 10] += "\n\n";
    }
  }
  csv.write("fig8");
  const auto panel = [&](const char* name, const char* title) {
    return std::string("set title '") + title +
           "'\nset xlabel 'F_{prop} (N)'\nset ylabel 'Rm (N)'\nset xrange [3.5:9.5]\nset yrange "
           "[-5:65]\nset xtics 1\nset ytics 10\nset cbrange [0:100]\nset cblabel 'traversed "
           "(%)'\nunset key\nunset grid\nunset nonlinear y\n"
           "plot $map" +
           name +
           " using 1:2:3 with image pixels, '' using 1:2:(sprintf('%.1f', $3)):($3 > 60 ? 0x000000 "
           ": 0xffffff) with labels tc rgb variable font ',9'\n"
           "set xlabel 'F_{prop} (N)'\nset ylabel 'traversed (%)'\nset yrange [0:100]\nset "
           "nonlinear y via sqrt(y) inverse y*y\nset ytics (0, 1, 2, 5, 10, 20, 50, 100)\nset "
           "grid\nset key top left title 'Rm (N)'\n"
           "plot for [i=0:6] $series" +
           name +
           " index i using ($1 + 0.03 * (i - 3)):3:4:5 with yerrorlines pt 7 ps 0.5 lc i+1 title "
           "sprintf('%d', 10 * i)\n";
  };
  draw("fig8", 1200, 950,
       data_block("$map50", map[0]) + data_block("$map10", map[1]) +
           data_block("$series50", series[0]) + data_block("$series10", series[1]) + kViridis +
           "set multiplot layout 2,2\n" + panel("50", "d = 50, as printed") +
           panel("10", "d = 10") + "unset multiplot\n");
  return {"fig8",
          "Fig. 8: traversal of equal beams",
          {"k = 400 N m/rad, from rest, " +
               std::to_string(f["fig8"].at("points")[0].at("trials").get<std::int64_t>()) +
               " trials a point (paper: 100), Table I's grid and two more columns of random force. "
               "Where propulsion alone is enough everybody gets through and random force only "
               "hinders; below that a few do, and only with random force. At Rm = 0 all trials are "
               "the same run, so those shares are 0 or 1 without an interval.",
           "Below that threshold traversal need not rise step by step with the propulsion: see the "
           "claims."},
          "Heat maps and curves of the traversal probability: near zero below 8 or 9 newton of "
          "propulsion, near one above it without random force, falling with random force there.",
          {"fig8"},
          "outcomes",
          {{"rows", rows}}};
}

Section fig12(const Findings& f) {
  constexpr std::int64_t kFew = 10;  // successes
  Json rows = Json::array();
  Csv csv(
      "damping_Nms_per_rad,propulsion_N,random_N,k_left_Nm_per_rad,trials,successes,right,low,"
      "high");
  std::string script =
                  "set palette gray\nset cbrange [0:0.6]\nunset key\nset xlabel 'Rm (N)'\nset "
                  "ylabel 'k_L (N m/rad)'\nset xrange [5:65]\nset yrange [75:525]\nset xtics "
                  "10\nset ytics 100\nset cblabel 'right of successful'\n",
              plots;
  for (const int damping : {50, 10})
    for (const int force : {7, 8}) {
      std::string map;
      for (int k = 100; k <= 500; k += 50)
        for (int random = 10; random <= 60; random += 10) {
          const At at{
              {kDamping, damping}, {kPropulsion, force}, {kRandom, random}, {kLeftStiffness, k}};
          const Share s = right_at(f["fig12"], at);
          const std::int64_t trials = point_at(f["fig12"], at).at("trials");
          rows.push_back({{"damping", damping},
                          {"propulsion", force},
                          {"random", random},
                          {"k_left", k},
                          {"right", or_null(s.value)},
                          {"low", s.low},
                          {"high", s.high},
                          {"successes", s.whole},
                          {"trials", trials}});
          csv.row(damping, force, random, k, static_cast<double>(trials),
                  static_cast<double>(s.whole), s.value, s.low, s.high);
          map += std::to_string(random) + " " + std::to_string(k) + " " +
                 (s.whole >= kFew ? digits(s.value) : "NaN") + " " + std::to_string(s.whole) + "\n";
        }
      const std::string name = "$d" + std::to_string(damping) + "f" + std::to_string(force);
      script += data_block(name, map);
      plots += "set title '" + std::string(force == 7 ? "A" : "B") +
               "  F_{prop} = " + std::to_string(force) + " N, d = " + std::to_string(damping) +
               "'\nplot " + name + " using 1:2:3 with image pixels, '' using 1:2:($4 < " +
               std::to_string(kFew) + " ? sprintf('of %d', $4) : sprintf('%.2f', $3)):($4 < " +
               std::to_string(kFew) +
               " || $3 > 0.3 ? 0x000000 : 0xffffff) with labels tc rgb variable font ',9'\n";
    }
  csv.write("fig12");
  draw("fig12", 1200, 950, script + "set multiplot layout 2,2\n" + plots + "unset multiplot\n");
  return {"fig12",
          "Fig. 12: right trials of all successful ones",
          {"As in the paper, darker means fewer on the right: a softer left beam draws the body to "
           "the left. " +
           std::to_string(f["fig12"].at("points")[0].at("trials").get<std::int64_t>()) +
           " trials a cell. Where fewer than 10 get through there is no share to speak of: those "
           "cells say how many do."},
          "Four grey maps of the share of right traversals over left stiffness and random force: "
          "dark at the soft end, about one half where both beams are alike.",
          {"fig12"},
          "right_share",
          {{"rows", rows}}};
}

/// Names as tics 0, 1, 2 ... of a y axis.
std::string tics_of(const std::vector<std::string>& names) {
  std::string list;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string quoted = literal(names[i]);
    list +=
        (i ? ", " : "") + quoted.substr(0, quoted.rfind(" noenhanced")) + " " + std::to_string(i);
  }
  return "set ytics (" + list + ") noenhanced";
}

/// Horizontal dots with 95 % bars, grouped, and lines at the paper's values.
void draw_rates(const std::string& name, const Json& rows, double mark,
                const std::string& mark_label, const std::string& title, double most) {
  std::string lines;
  std::vector<std::string> names;
  for (const Json& r : rows) {
    lines += std::to_string(names.size()) + " " + digits(100 * r["value"].get<double>()) + " " +
             digits(100 * r["low"].get<double>()) + " " + digits(100 * r["high"].get<double>()) +
             "\n";
    names.push_back(r["group"].get<std::string>() + ": " + r["label"].get<std::string>());
  }
  const std::size_t i = names.size();
  draw(name, 1000, static_cast<int>(140 + 17 * i),
       data_block("$rates", lines) + "set title '" + title + "' offset 0,1\nset yrange [" +
           std::to_string(i) + ":-1]\n" + tics_of(names) +
           " font ',9'\nset xlabel '%'\nset xrange [-0.01*" + digits(most) + ":" + digits(most) +
           "]\nset grid x\nunset key\nset arrow from " + digits(mark) + ",graph 0 to " +
           digits(mark) + ",graph 1 nohead dt 2 lw 2 lc rgb '#d55e00'\nset label " +
           literal(mark_label) + " at " + digits(mark) +
           ",graph 1.02 center tc rgb '#d55e00'\nset tmargin 5\nplot $rates using 2:1:3:4 with "
           "xerrorbars pt 7 ps 0.6 lc rgb '#0072b2'\n");
}

Section thirteen_eight(const Findings& f) {
  Json rows = Json::array();
  Csv csv("group,setting,damping_Nms_per_rad,traversed,low,high,left,right,trials");
  const auto add = [&](const char* study, const char* group, const char* key, const char* unit) {
    for (const Json& p : f[study].at("points")) {
      const Json& value = p.at("at").at(key);
      const std::string damping = p.at("at").at(kDamping).dump(),
                        text = (value.is_string() ? value.get<std::string>() : value.dump()) + unit;
      const Share s = share_of(p.at("traversed"), p.at("trials"));
      rows.push_back({{"label", text + ", d " + damping},
                      {"group", group},
                      {"value", s.value},
                      {"low", s.low},
                      {"high", s.high}});
      csv.row(group, text, as_double(p.at("at").at(kDamping)), s.value, s.low, s.high,
              p.at("traversed_left").get<double>() / static_cast<double>(s.whole),
              p.at("traversed_right").get<double>() / static_cast<double>(s.whole),
              static_cast<double>(s.whole));
    }
  };
  add("tried_method", "method", "run.method", "");
  add("tried_step", "paper's Euler, step", "run.step_s", " s");
  add("tried_restitution", "restitution", "contact.restitution", "");
  add("tried_rate", "rate of the random force", "forces.random_rate_Hz", " Hz");
  add("tried_start", "starting speed", "start.vy_m_per_s", " m/s");
  add("tried_random", "random force", kRandom, " N");
  add("tried_propulsion", "propulsion", kPropulsion, " N");
  csv.write("thirteen_eight");
  draw_rates("thirteen_eight", rows, 21, "paper: 13 + 8 %",
             "Traversal with k_L = k_R = 500 N m/rad, F_{prop} = 7 N, Rm = 10 N unless said", 100);
  const Json& passes = f["barrier_500"].at("passes");
  const auto text = [&](const Json& pass, const char* what) {
    return fixed(pass.at(what).get<double>(), 1);
  };
  return {"thirteen_eight",
          "The 13 % and 8 % of Fig. 9A",
          {"With k_L = k_R = 500 the paper sees 21 of 100 bodies traverse. Here hardly any does. "
           "The landscape's argument: on the paper's grid of 0.5 m the lowest way through rises " +
               text(passes.front(), "above_start_J") + " J above the start, on one of 0.05 m " +
               text(passes.back(), "above_start_J") +
               " J; a body that has come to rest in the basin must climb " +
               fixed(passes.back().at("from_basin").at("barrier_J").get<double>(), 0) +
               " J. The start is at rest, so only the work of the random force could lift it, and "
               "hits and dampers take what it gives.",
           "Tried, " + std::to_string(rows.size()) +
               " settings: four methods, the paper's own Euler scheme among them, whose drifting "
               "constraints create energy; that at five steps; other dampings, restitutions, "
               "rates of the random force, starting speeds, random forces, and more propulsion. "
               "The rows show which makes as many traverse. The printed parameters do not give "
               "these two numbers in this model."},
          "Dots with 95 % bars of the traversal share for many settings, beside a line at the "
          "paper's 21 %, which only the largest propulsions reach.",
          {"tried_method", "tried_step", "tried_restitution", "tried_rate", "tried_start",
           "tried_random", "tried_propulsion", "paper_method", "barrier_500"},
          "rates",
          {{"rows", rows},
           {"marks", {{{"label", "paper: 13 % + 8 %"}, {"value", 0.21}}}},
           {"unit", "share"}}};
}

// ---- The field

Section fig11(const Findings& f) {
  Json starts = Json::array();
  Csv csv("start,i_x,i_y,dynamics,chain");
  std::string maps[2], pairs;
  double most = 0.0;  // of the first start
  for (const Json& start : f["field"].at("starts")) {
    const Json &counts = start.at("final_gates").at("dynamics"),
               &exact = start.at("final_gates").at("exact");
    const double trials = f["field"].at("trials");
    Json dynamics = Json::array(), chain = Json::array();
    struct Cell {
      double dynamics, chain;
    };
    std::vector<Cell> cells;
    for (std::size_t y = 0; y < counts.size(); ++y) {
      Json dynamics_row = Json::array(), chain_row = Json::array();
      for (std::size_t x = 0; x < counts[y].size(); ++x) {
        const Cell c{counts[y][x].get<double>() / trials, exact[y][x].get<double>()};
        cells.push_back(c);
        dynamics_row.push_back(rounded(c.dynamics, 1e-6));
        chain_row.push_back(rounded(c.chain, 1e-6));
        const double i_x = static_cast<double>(x) - static_cast<double>(counts[y].size() / 2),
                     i_y = static_cast<double>(y);
        csv.row(start_label(start), i_x, i_y, c.dynamics, c.chain);
        if (!starts.empty()) continue;  // the figure shows the first start
        most = std::max({most, c.chain, c.dynamics});
        maps[0] += digits(i_x) + " " + digits(i_y) + " " + digits(100 * c.chain) + "\n";
        maps[1] += digits(i_x) + " " + digits(i_y) + " " + digits(100 * c.dynamics) + "\n";
      }
      dynamics.push_back(std::move(dynamics_row));
      chain.push_back(std::move(chain_row));
    }
    if (starts.empty()) {
      std::sort(cells.begin(), cells.end(),
                [](const Cell& a, const Cell& b) { return a.dynamics > b.dynamics; });
      for (std::size_t i = 0; i < cells.size(); ++i)
        pairs += std::to_string(i + 1) + " " + digits(100 * cells[i].dynamics) + " " +
                 digits(100 * cells[i].chain) + "\n";
    }
    starts.push_back({{"label", start_label(start)},
                      {"dynamics", dynamics},
                      {"chain", chain},
                      {"corrcoef", start.at("exact").at("corrcoef")},
                      {"rmse", start.at("exact").at("rmse_per_100")}});
  }
  csv.write("fig11");
  draw("fig11", 1150, 900,
       data_block("$chain", maps[0]) + data_block("$dynamics", maps[1]) +
           data_block("$pairs", pairs) + kViridis +
           "set multiplot\nset size 0.5,0.56\nset origin 0,0.44\nset size ratio -1\nunset key\nset "
           "xlabel 'i_x'\nset ylabel 'i_y'\nset xrange [-4.5:4.5]\nset yrange [-0.5:8.5]\nset "
           "xtics 1\nset ytics 1\nset cbrange [0:*]\nset cblabel '% of trials'\n"
           "set cbrange [0:" +
           digits(100 * most) +
           "]\nset title 'A  Markov chain (exact)'\nplot $chain using 1:2:3 with image pixels\nset "
           "origin 0.5,0.44\nset title 'full dynamics'\nplot $dynamics using 1:2:3 with image "
           "pixels\n"
           "set origin 0,0\nset size noratio\nset size 1,0.42\nset title 'B  the same gate by "
           "gate, sorted'\nset xlabel 'gates in the order of the dynamics'\nset ylabel '% of "
           "trials'\nset xrange [0:82]\nset yrange [0:*]\nset xtics 10\nset ytics auto\nset key "
           "top right\nset grid y\n"
           "set style fill solid 0.7\nplot $pairs using 1:2 with boxes lc rgb '#9ecae1' title "
           "'full dynamics', $pairs using 1:3 with points pt 7 ps 0.6 lc rgb '#d55e00' title "
           "'chain'\nunset multiplot\n");
  return {"fig11",
          "Fig. 11: where bodies end in the field",
          {"9 x 9 gates, " + f["field"].at("trials").dump() +
           " trials of the full dynamics for each start of Table IV, beside what infinitely many "
           "walks of the 87 x 88 chain would give. The paper prints neither force; 7 N and 50 N "
           "fit its Table IV best (results/field_scan)."},
          "Two maps of nine by nine gates side by side, chain and dynamics, much alike; below, "
          "bars and dots gate by gate.",
          {"field"},
          "final_gates",
          {{"starts", starts}}};
}

Section table4(const Findings& f) {
  Json rows = Json::array();
  Csv csv(
      "start,paper_corrcoef,corrcoef,corrcoef_sd,corrcoef_floor,paper_rmse,rmse,rmse_sd,rmse_floor,"
      "corrcoef_all,rmse_all,total_variation,total_variation_floor");
  std::string lines;
  int i = 0;
  for (const Json& start : f["field"].at("starts")) {
    const Json &a = start.at("at_100_trials"), &all = start.at("exact"), &paper = start.at("paper");
    Json row{{"start", start_label(start)},
             {"paper_corrcoef", paper.at("corrcoef")},
             {"corrcoef", a.at("exact_corrcoef").at("mean")},
             {"corrcoef_sd", a.at("exact_corrcoef").at("sd")},
             {"corrcoef_floor", a.at("exact_corrcoef_floor")},
             {"paper_rmse", paper.at("rmse_per_100")},
             {"rmse", a.at("exact_rmse_per_100").at("mean")},
             {"rmse_sd", a.at("exact_rmse_per_100").at("sd")},
             {"rmse_floor", a.at("exact_rmse_per_100_floor")},
             {"corrcoef_all", all.at("corrcoef")},
             {"rmse_all", all.at("rmse_per_100")},
             {"tv", all.at("total_variation")},
             {"tv_floor", all.at("total_variation_floor")}};
    const auto at = [&](const char* key) { return as_double(row.at(key)); };
    csv.row(start_label(start), at("paper_corrcoef"), at("corrcoef"), at("corrcoef_sd"),
            at("corrcoef_floor"), at("paper_rmse"), at("rmse"), at("rmse_sd"), at("rmse_floor"),
            at("corrcoef_all"), at("rmse_all"), at("tv"), at("tv_floor"));
    lines += std::to_string(++i);
    for (const char* key : {"corrcoef", "corrcoef_sd", "corrcoef_floor", "paper_corrcoef", "rmse",
                            "rmse_sd", "rmse_floor", "paper_rmse"})
      lines += " " + digits(at(key));
    lines += "\n";
    rows.push_back(std::move(row));
  }
  csv.write("table4");
  const auto panel = [](const char* title, int first) {
    const auto column = [&](int k) { return std::to_string(first + k); };
    return std::string("set title '") + title + "'\nplot $rows using ($1-0.12):" + column(0) + ":" +
           column(1) +
           " with yerrorbars pt 7 lc rgb '#0072b2' title 'here, 100 trials, one sd', $rows using "
           "1:" +
           column(2) +
           " with points pt 2 ps 1.2 lw 2 lc rgb '#999999' title 'floor: chance alone', $rows "
           "using ($1+0.12):" +
           column(3) + " with points pt 9 ps 1.2 lc rgb '#d55e00' title 'paper'\n";
  };
  draw("table4", 1000, 460,
       data_block("$rows", lines) +
           "set multiplot layout 1,2\nset xrange [0.5:4.5]\nset xtics ('0, 0, 15' 1, '23, -11, 16' "
           "2, '4, 5, 10' 3, '-17, 13, 12' 4)\nset xlabel 'start: d (m), vx, vy (m/s)'\nset grid "
           "y\nset key bottom left\n" +
           panel("corrcoef", 2) + "set key top left\n" + panel("RMSE, trials per 100", 6) +
           "unset multiplot\n");
  return {"table4",
          "Table IV: prediction against dynamics, beside what chance allows",
          {"With 100 trials of the dynamics even a perfect chain would not reach corrcoef 1 and "
           "RMSE 0: that is the floor. Shown is the exact chain against 100 trials. The paper says "
           "that it compared 100 trials with 100 walks, whose floor is worse (0.75 and 1.5); its "
           "figures lie on the floor of an exact prediction."},
          "Correlation and RMSE of the four starts: here, the floor by chance, and the paper's, "
          "within each other's reach but for the third start.",
          {"field", "field_paper_method"},
          "table4",
          {{"rows", rows}}};
}

Section crossings(const Findings& f) {
  Json rows = Json::array();
  Csv csv("scene,RT_and_LT_share,outside_bins_share,crossings");
  for (const auto& [study, label] :
       {std::pair<const char*, const char*>{"field_random_10", "7 N, Rm 10 N"},
        {"field_random_20", "7 N, Rm 20 N"},
        {"field_random_40", "7 N, Rm 40 N"},
        {"field", "7 N, Rm 50 N (scenes/field.toml)"}}) {
    const Json& c = f[study].at("crossings");
    const auto n = c.at("between_gates").get<double>();
    csv.row(label, as_double(c.at("RT_and_LT_share")), as_double(c.at("clamped_share")), n);
    for (const auto& [key, group] :
         {std::pair<const char*, const char*>{"RT_and_LT_share", "through RT or LT"},
          {"clamped_share", "outside Table III's bins"}}) {
      const Share s = share_of(std::llround(c.at(key).get<double>() * n), std::llround(n));
      rows.push_back({{"label", label},
                      {"group", group},
                      {"value", s.value},
                      {"low", s.low},
                      {"high", s.high}});
    }
  }
  std::stable_sort(rows.begin(), rows.end(), [](const Json& a, const Json& b) {
    return a["group"].get<std::string>() > b["group"].get<std::string>();
  });
  csv.write("crossings");
  draw_rates("crossings", rows, 4, "paper: RT and LT fewer than 4 %", "Crossings between gates",
             45);
  return {"crossings",
          "Crossings between gates: side entries and velocities",
          {"The paper says that fewer than 4 % of the inputs come through the sides above the "
           "joints (RT, LT) and that velocities stay in the range of Table III. Both depend on the "
           "forces, which it does not print."},
          "Shares of crossings through RT or LT and outside the bins of Table III for four random "
          "forces, beside a line at four percent.",
          {"field_random_10", "field_random_20", "field_random_40", "field"},
          "rates",
          {{"rows", rows},
           {"marks", {{{"label", "paper: RT and LT < 4 %"}, {"value", 0.04}}}},
           {"unit", "share"}}};
}

Section speed(const Findings& f) {
  double exact = 0;
  for (const Json& s : f["field"].at("starts"))
    exact += s.at("seconds").at("exact").get<double>() /
             static_cast<double>(f["field"].at("starts").size());
  const std::vector<std::pair<std::string, double>> times{
      {"paper: 100 trials of the dynamics", 360000.0},
      {"paper: 100 walks", 10.0},
      {"here: 100 trials by the paper's Euler scheme",
       100 * seconds_per(f["field_paper_method"], "dynamics", "trials")},
      {"here: 100 trials, method stable", 100 * seconds_per(f["field"], "dynamics", "trials")},
      {"here: the matrix, 87 x 100 gate runs", f["field"].at("matrix").at("seconds").get<double>()},
      {"here: 100 walks", 100 * seconds_per(f["field"], "walks", "walks")},
      {"here: one exact prediction", exact}};
  Json rows = Json::array();
  Csv csv("what,seconds");
  std::string lines;
  std::vector<std::string> names;
  for (const auto& [label, seconds] : times) {
    rows.push_back({{"label", label}, {"seconds", seconds}});
    csv.row(label, seconds);
    lines += std::to_string(names.size()) + " " + digits(seconds) + "\n";
    names.push_back(label);
  }
  csv.write("speed");
  draw("speed", 1000, 360,
       data_block("$t", lines) +
           "set logscale x\nset format x '10^{%T}'\nset xlabel 'seconds'\nset yrange [" +
           std::to_string(names.size()) + ":-1]\n" + tics_of(names) +
           "\nset grid x\nunset key\nplot $t using 2:1 with points pt 7 ps 1.2 lc rgb '#0072b2'\n");
  return {"speed",
          "Time: dynamics against chain",
          {"The paper's factor is 100 h of dynamics over 10 s of walks. The matrix costs more than "
           "the 100 trials of one start, and serves all starts. Measured once on " +
           machine() + ", all cores; tests/bench/run.sh measures with care."},
          "Seconds on a logarithmic axis: the paper's 100 trials 360 000, its walks 10; here "
          "milliseconds and microseconds.",
          {"field", "field_paper_method"},
          "speed",
          {{"rows", rows}}};
}

Section replay(const Findings& f) {
  Json film = f["crossing"];
  for (const char* key : {"recorded", "trials", "status", "made_by"}) film.erase(key);
  for (Json& run : film["runs"])
    for (const char* key : {"trial", "hits", "potential_J", "elastic_left_J", "elastic_right_J",
                            "landscape_J", "landscape_left_J", "landscape_right_J"})
      run.erase(key);
  return {"replay",
          "A body crosses the field",
          {"Three trials through the 9 x 9 field, every step of the method. gatewalk trace records "
           "and plays any other run: --seed, --trial, --replay FILE.html, --video FILE.mp4."},
          "An animation of the disc among the beams with play, pause and a time slider; energies "
          "beside it.",
          {"crossing"},
          "replay",
          {{"film", film}},
          false};
}

}  // namespace

Json sections_of(const Findings& f) {
  Json list = Json::array();
  for (const Section& s : {fig5(), barriers(f), fig6(f), fig8(f), fig9(f), thirteen_eight(f),
                           fig12(f), fig11(f), table4(f), crossings(f), speed(f), replay(f)}) {
    if (interrupted()) throw Interrupted{};
    Json commands = Json::array(), files = Json::array();
    for (const std::string& study : s.studies)
      if (const auto found = f.commands.find(study); found != f.commands.end())
        commands.push_back(found->second);
    if (s.drawn)
      for (const char* end : {".csv", ".svg", ".pdf"}) files.push_back(std::string(s.id) + end);
    list.push_back({{"id", s.id},
                    {"heading", s.heading},
                    {"text", s.text},
                    {"alt", s.alt},
                    {"commands", commands},
                    {"files", files},
                    {"chart", s.chart},
                    {"data", s.data}});
  }
  return list;
}

}  // namespace gatewalk::cli
