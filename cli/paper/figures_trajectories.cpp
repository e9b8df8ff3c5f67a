// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "cli/fields/csv.h"
#include "cli/fields/text.h"
#include "cli/paper/figures.h"
#include "cli/paper/studies.h"

namespace gatewalk::cli {

namespace {

/// How far a run sinks below the landscape, at most (J).
double depth_of(const TracedRun& run) {
  double depth = 0.0;
  for (std::size_t i = 0; i < run.t.size(); ++i)
    depth = std::fmax(depth, run.landscape[i] - run.potential[i]);
  return depth;
}

/// Adds a sample of a trajectory's colour, on one of the map's colours, with a label.
void add_sample(Panel& panel, const Sheet& sheet, const char* colour, const std::string& text,
                double left, double middle) {
  const auto line = [&](const char* width, const char* ink) {
    panel.more +=
        fmt::format("set arrow from screen {} to screen {} nohead front lw {} lc rgb '{}'\n",
                    sheet.at(left + 3, middle), sheet.at(left + 33, middle), width, ink);
  };
  panel.more += fmt::format(
      "set object rectangle from screen {} to screen {} fillcolor rgb '#277f8e' fillstyle solid "
      "noborder\n",
      sheet.at(left, middle + 8), sheet.at(left + 36, middle - 8));
  line("3.4", "#000000");
  line("2", colour);
  panel.say(as_printed(text), left + 44, middle, kSmallFont);
}

constexpr char kWay[] = "#ffffff", kOther[] = "#ff9d5c";  // colours of tracks over maps

}  // namespace

Section fig6(const Findings& f) {
  constexpr double kBelow = 1.0;  // J; less does not count as below the landscape
  const auto dives = std::count_if(f.fig6.runs.begin(), f.fig6.runs.end(),
                                   [](const TracedRun& r) { return depth_of(r) > kBelow; });
  // The run that sinks deepest below the landscape.
  const TracedRun& run = *std::max_element(
      f.fig6.runs.begin(), f.fig6.runs.end(),
      [](const TracedRun& a, const TracedRun& b) { return depth_of(a) < depth_of(b); });
  Csv csv("time_s,x_m,y_m,potential_J,landscape_J,landscape_right_beam_J");
  Panels out = paper_panels();
  Rows& rows = out.data("$run");
  for (std::size_t i = 0; i < run.t.size(); ++i) {
    const double one = run.landscape[i] - run.landscape_left[i];
    csv.row(run.t[i], run.x[i], run.y[i], run.potential[i], run.landscape[i], one);
    rows.add(run.t[i], run.x[i], run.y[i], run.potential[i], run.landscape[i], one);
  }
  const auto p = gate_of("scenes/single_gate.toml", {set(kPropulsion, 9), set(kRandom, 10)});
  const auto of_both = dynamics::landscape(p, 0.0, EnergyMap::kSpacing),
             of_right = dynamics::landscape(p, 0.0, EnergyMap::kSpacing, {false, true});
  constexpr double kUpper = 66, kLeft = 58, kRight = 258;
  const double bottom = kUpper + EnergyMap::kHeight;
  const EnergyMap both{"$both", 600.0, 50.0}, alone{"$alone", 600.0, 50.0};
  const Box time{66, 488, bottom + 162, bottom + 342};
  const Sheet sheet{static_cast<int>(time.bottom + 62)};
  out.say(as_printed("F_prop = 9 N, Rm = 10 N, k_L = k_R = 400 N m/rad"), 8, 18);
  out.say(as_printed("B  landscape of both beams"), kLeft, kUpper - 11, kSmallFont);
  out.say(as_printed("C  of the right beam alone"), kRight, kUpper - 11, kSmallFont);
  const Rows &of_both_rows = both.add_data(out, of_both, of_both.total),
             &of_right_rows = alone.add_data(out, of_right, of_right.total);
  const auto add_map = [&](const EnergyMap& map, const Rows& data, double left,
                           int landscape) -> Panel& {
    Panel& panel = map.add(out, data, left, kUpper, "x (m)", left == kLeft ? "y (m)" : "");
    draw_track(panel, rows, "2:3", 1.2, kWay);
    draw_track(panel, rows, fmt::format("2:($4 < ${} - {} ? $3 : NaN)", landscape, digits(kBelow)),
               2.6, kOther);
    return panel;
  };
  both.add_bar(add_map(both, of_both_rows, kLeft, 5), kRight, kUpper);
  Panel& right = add_map(alone, of_right_rows, kRight, 6);
  add_sample(right, sheet, kWay, "the body's way", kLeft, bottom + 66);
  add_sample(right, sheet, kOther, "more than 1 J below the landscape", 210, bottom + 66);
  const double end = run.t.back();
  Panel& energies = add_panel(out, time, "time (s)", "energy (J)", 54);
  energies.tics_font = kSmallFont;
  energies.x = {"", -0.02 * end, 1.02 * end, "1"};
  energies.y = {"", -40, kFree, "100"};
  energies.grid = kGrid;
  energies.key = {"left top Left reverse samplen 3", kLeft, bottom + 86};
  energies.draw(rows, "1:4", "lines", {kThirdColour, 2.5}, "potential energy of the system");
  energies.layers.push_back(
      {"''", "1:5", "lines", {kFirstColour, 1.5}, "landscape of both beams there"});
  energies.layers.push_back({"''",
                             "1:6",
                             "lines",
                             {.colour = kInk, .width = 1.5, .dashes = 2},
                             "landscape of the right beam alone there"});
  return {
      "fig6",
      "Fig. 6: a trajectory that dives through the landscape",
      {fmt::format(
           "A body that pushes past the right beam ({}). The landscape assumes that both beams are "
           "deflected; once the left one has let go, the system's energy is below it, here by up "
           "to {} J. With the landscape of the right beam alone that is gone or less.",
           run.label, fixed(depth_of(run), 0)),
       fmt::format("It is a selection, the one that sinks deepest of {} such runs, of which {} "
                   "sink more than {} J below the landscape at all.",
                   f.fig6.runs.size(), dives, fixed(kBelow, 0)),
       fmt::format("B and C as in the paper, seen from above. The way is orange where the system "
                   "has more than {} J less than the landscape.",
                   fixed(kBelow, 0))},
      "Two maps of the energy with the body's way from below, past the right beam, to the far "
      "side: over that of both beams a part of it is orange, over that of the right beam alone "
      "less or none. Below, energies over time: the system's follows the landscape of both beams, "
      "then falls below it while it stays at or above that of the right beam alone.",
      {"fig6", "fig9_300"},
      csv.text(),
      out.figure(sheet.height)};
}

namespace {

/// A panel of Fig. 9: the study, and its beams.
struct TracedPanel {
  const Trace& study;
  double k_left, damping;
  const char* letter;
  double left, top;  // px
};

}  // namespace

Section fig9(const Findings& f) {
  constexpr double kLeft = 58, kRight = 258, kUpper = 70, kLower = 384;
  const Sheet sheet{static_cast<int>(kLower + EnergyMap::kHeight + 62)};
  Csv csv("panel,k_left_Nm_per_rad,damping_Nms_per_rad,trial,side,time_s,x_m,y_m,potential_J");
  Panels out = paper_panels();
  out.say(as_printed("traversed; F_prop = 7 N, Rm = 10 N, k_R = 500 N m/rad"), 8, 18);
  for (const TracedPanel& traced : {TracedPanel{f.fig9_500, 500, 50, "A", kLeft, kUpper},
                                    TracedPanel{f.fig9_300, 300, 10, "B", kRight, kUpper},
                                    TracedPanel{f.fig9_100, 100, 10, "C", kLeft, kLower}}) {
    const EnergyMap map{std::string("$") + traced.letter, 700.0, 50.0};
    Rows tracks[] = {Rows(map.name + "_left"), Rows(map.name + "_right")};
    std::int64_t count[2] = {0, 0};
    for (const TracedRun& run : traced.study.runs) {
      const bool right = run.ending == "traversed right";
      ++count[right];
      for (std::size_t i = 0; i < run.t.size(); i += 5) {
        csv.row(traced.letter, traced.k_left, traced.damping, static_cast<double>(run.trial),
                right ? "right" : "left", run.t[i], run.x[i], run.y[i], run.potential[i]);
        tracks[right].add(run.x[i], run.y[i]);
      }
      tracks[right].gap();
    }
    const auto l =
        dynamics::landscape(gate_of("scenes/soft_left.toml", {set(kLeftStiffness, traced.k_left)}),
                            0.0, EnergyMap::kSpacing);
    const auto line = [&](const std::string& text, double above) {
      out.say(as_printed(text), traced.left, traced.top - above, kSmallFont);
    };
    line(fmt::format("{}  k_L = {} N m/rad, d = {}", traced.letter, digits(traced.k_left),
                     digits(traced.damping)),
         28);
    line(fmt::format("left {}, right {} of {}", count[0], count[1], traced.study.trials), 11);
    Panel& panel =
        map.add(out, map.add_data(out, l, l.total), traced.left, traced.top,
                traced.top == kLower ? "x (m)" : "", traced.left == kLeft ? "y (m)" : "");
    for (const bool right : {false, true})
      if (!tracks[right].empty())
        draw_track(panel, out.data(tracks[right]), "1:2", 0.5, right ? kOther : kWay);
    if (traced.left == kRight) map.add_bar(panel, kRight, traced.top);
    if (traced.top != kLower) continue;
    add_sample(panel, sheet, kWay, "left beam deflected most", kRight, kLower + 20);
    add_sample(panel, sheet, kOther, "right beam deflected most", kRight, kLower + 46);
    double at = kLower + 76;
    for (const char* text :
         {"Lines of equal energy: every 50 J;", "grey: the disc would cover a joint.",
          "A has the damping of Table I,", "B and C have d = 10 N m s/rad."})
      panel.say(as_printed(text), kRight, at += 18, kSmallFont);
  }
  return {"fig9",
          "Fig. 9: successful trajectories over the landscape",
          {"F_prop = 7 N, Rm = 10 N, k_R = 500 N m/rad. A softer left beam opens a way on its "
           "side. Left and right say which beam was deflected most, as in the paper; beyond its "
           "tip the body often goes to the other side.",
           "The panels differ in damping and trials. A: d = 50, as Table I prints it; so few get "
           "through that many are asked. B and C: 100 trials each, as in the paper, at d = 10 (the "
           "paper sees 52 % and 98 %; see the claims for d = 50). Colour is the landscape's "
           "energy."},
          "Three maps of the landscape with trajectories as lines. A: a handful, white past the "
          "left beam and orange past the right one. B and C: many, nearly all past the left beam.",
          {"fig9_500", "fig9_300", "fig9_100", "fig12", "tried_method"},
          csv.text(),
          out.figure(sheet.height)};
}
}  // namespace gatewalk::cli
