// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include <cmath>

#include "cli/fields/csv.h"
#include "cli/fields/text.h"
#include "cli/paper/figures.h"
#include "cli/paper/studies.h"

namespace gatewalk::cli {

Section fig5() {
  const auto landscape_of = [](const std::vector<std::string>& settings) {
    return dynamics::landscape(gate_of("scenes/single_gate.toml", settings), 0.0,
                               EnergyMap::kSpacing);
  };
  const dynamics::Landscape equal = landscape_of({set(kPropulsion, 7)});
  const dynamics::Landscape unequal =
      landscape_of({set(kPropulsion, 7), set(kLeftStiffness, 500), set(kRightStiffness, 250)});
  struct ShownMap {
    const char *letter, *what, *settings;
    const dynamics::Landscape& landscape;
    const Eigen::ArrayXXd& energy;
    double left, top;
    const char* colour;  // of its section's curve
  };
  constexpr double kLeft = 58, kRight = 258, kUpper = 50, kLower = 352;
  const ShownMap panels[] = {{"A", "A, B  elastic energy", "k_L = k_R = 400 N m/rad", equal,
                              equal.elastic, kLeft, kUpper, kFirstColour},
                             {"C", "C  elastic energy", "k_L = 500, k_R = 250 N m/rad", unequal,
                              unequal.elastic, kRight, kUpper, kSecondColour},
                             {"D", "D  with the propulsion", "F_prop = 7 N, k_L = k_R = 400", equal,
                              equal.total, kLeft, kLower, kThirdColour}};
  constexpr double kCeiling = 500.0;  // J
  constexpr std::size_t kStep = 4;    // the CSV has every fourth point of the picture
  constexpr int kHigh = 662;
  Csv csv("panel,x_m,y_m,energy_J");
  Panels out = paper_panels();
  const Box box{kRight, kRight + EnergyMap::kWidth, kLower, kLower + EnergyMap::kHeight};
  Panel sections(box);
  for (const ShownMap& p : panels) {
    const EnergyMap map{std::string("$") + p.letter, kCeiling, 50.0};
    const Rows& rows = map.add_data(out, p.landscape, p.energy);
    Rows& section = out.data(map.name + "_middle");
    const auto middle = static_cast<Eigen::Index>(p.landscape.x.size() / 2);
    for (std::size_t i = 0; i < p.landscape.y.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      section.add(p.energy(row, middle), p.landscape.y[i]);
      for (std::size_t j = 0; i % kStep == 0 && j < p.landscape.x.size(); j += kStep) {
        const double e = p.energy(row, static_cast<Eigen::Index>(j));
        csv.row(p.letter, p.landscape.x[j], p.landscape.y[i],
                std::isfinite(e) ? std::round(10.0 * e) / 10.0 : std::nan(""));
      }
    }
    out.say(as_printed(p.what), p.left, p.top - 28, kSmallFont);
    out.say(as_printed(p.settings), p.left, p.top - 11, kSmallFont);
    Panel& panel = map.add(out, rows, p.left, p.top, p.top == kLower ? "x (m)" : "",
                           p.left == kLeft ? "y (m)" : "");
    if (&p == panels) map.add_bar(panel, kRight, p.top);
    sections.draw(section, "1:2", "lines", {p.colour, 2}, p.letter);
  }
  Panel& along = add_panel(out, box, "energy (J)", "");
  along.layers = sections.layers;
  along.say(as_printed("sections along x = 0"), box.left, box.top - 11, kSmallFont);
  along.say(as_printed("lines of equal energy: every 50 J; grey: the disc would cover a joint"), 8,
            kHigh - 14, kSmallFont);
  along.tics_font = kSmallFont;
  along.x = {"", -15, 500, "100"};
  along.y = {"", 0, 65, "20", "", false};
  along.grid = kGrid;
  along.key = {"left top Left reverse samplen 1.5", box.right + 10, box.top};
  return {
      "fig5",
      "Fig. 5: the potential energy landscape",
      {"Eqs. (14) and (15): what it costs to stand somewhere in the gate with both beams deflected "
       "forward. A and B, one map here: two barriers that overlap in the middle. C: a softer right "
       "beam has the lower one. D: a propulsion tilts it all, and a basin appears in front of the "
       "beams. The fourth panel shows the three along the middle of the gate.",
       "Energies above 500 J, beside the joints, are cut off in the picture. Where the disc would "
       "cover a joint no angle of the beam is possible: grey. The propulsion's energy is zero at y "
       "= 65 m, where a single gate counts as traversed; the paper puts the zero at 60 m, which "
       "shifts all energies by 5 m times the propulsion. The maps are computed with this page, as "
       "gatewalk landscape does, every 0.25 m; the commands give the passes, the basin and its "
       "end."},
      "Three maps of the energy over the gate with lines of equal energy: elastic, two ridges that "
      "rise towards the joints; with a softer right beam, lower on its side; with propulsion, high "
      "before the beams and falling towards the far side. Beside them the three along x = 0: from "
      "zero up to about 330 J and sharply down, or with the propulsion from 455 J to a basin and "
      "over the barrier.",
      {"fig5_symmetric", "fig5_asymmetric", "steep"},
      csv.text(),
      out.figure(kHigh)};
}

Section barriers(const Findings& f) {
  Csv csv("k_left_Nm_per_rad,damping_Nms_per_rad,above_start_J,above_basin_J,traversed,low,high");
  Panels out = paper_panels();
  Rows &heights = out.data("$heights"), &none = out.data("$none");
  Rows* const shares[] = {&out.data("$d50"), &out.data("$d10")};
  std::string below_start;
  std::vector<std::string> studies;
  double trials = 0.0;
  for (const auto& [k, landscape] : f.barriers) {
    const double start = landscape.fine.above_start(), basin = landscape.fine.from_basin.barrier();
    const bool downhill = landscape.fine.downhill();
    (downhill ? none : heights).add(k, basin, start);
    for (const int damping : {10, 50}) {
      const Share s = fig12_at(f, damping, 7, 10, k).traversed_share();
      const double nan = std::nan("");
      csv.row(k, damping, downhill ? nan : start, downhill ? nan : basin, s.value, s.low, s.high);
      shares[damping == 10]->add(k, root_percent(s.value), root_percent(s.low),
                                 root_percent(s.high));
      trials = static_cast<double>(s.whole);
      if (damping == 10 && !downhill && start < 0.0 && s.value < 0.05)
        below_start = fmt::format(
            " And the height above the start says little: with k_L = {} the lowest way lies below "
            "the start, yet only {} traverse at d = 10, because hits and dampers take the energy.",
            k, percent_text(s));
    }
    studies.push_back(fmt::format("barrier_{}", k));
  }
  studies.emplace_back("fig12");
  const std::string foot = none.empty() ? "" : ", with a cross at the foot where there is no basin";
  if (none.empty()) none.add("NaN NaN NaN");
  const Box above{78, 488, 96, 286}, below{78, 488, 346, 536};
  const auto key = [&](double middle, const char* how) {
    return Legend{fmt::format("left center {} Left reverse samplen 2.5", how), above.left, middle};
  };
  out.say(as_printed("F_prop = 7 N, Rm = 10 N, k_R = 500 N m/rad"), 8, 18);
  Panel& upper = add_panel(out, above, "", "barrier (J)", 64);
  upper.x = {"", 75, 525, "100,50", "", false};
  upper.y = {"", -212, 220, "100"};
  upper.key = key(64, "maxcols 1");
  upper.draw(heights, "1:2", "linespoints", {kInk, 1.5, 7, 0.8}, "above the basin");
  upper.layers.push_back({"''", "1:3", "linespoints", {kInk, 1.5, 6, 0.8, 2}, "above the start"});
  upper.draw(none, "1:(-200)", "points", {.colour = kInk, .mark = 2, .size = 0.8}, "no basin");
  Panel& lower = add_panel(out, below, "k_L (N m/rad)", "traversed (%, root scale)", 64);
  lower.say(as_printed("d in N m s/rad"), 330, 314, kSmallFont);
  lower.say(as_printed("95 % intervals, n = " + digits(trials)), 330, 330, kSmallFont);
  lower.x = {"", 75, 525, "100,50"};
  lower.y = {"", -0.3, 10.3, root_tics({0, 1, 5, 20, 50, 100})};
  lower.key = key(322, "maxrows 1");
  lower.draw(*shares[0], "1:2:3:4", "yerrorlines", {kFirstColour, 1.5, 7, 0.7},
             as_printed("d = 50"));
  lower.draw(*shares[1], "1:2:3:4", "yerrorlines", {kSecondColour, 1.5, 5, 0.7},
             as_printed("d = 10"));
  for (Panel* panel : {&upper, &lower}) panel->grid = std::string("ytics") + kGrid;
  return {
      "barriers",
      "Barriers and who passes them",
      {"Of all ways through the gate, the lowest one's highest point is the barrier (minimax "
       "path on a grid of 0.05 m); its height above the basin before it is what a body that "
       "has settled there must climb. Without a basin it is downhill to the far side.",
       "Height is not all: the same barrier lets more through where beams are damped less." +
           below_start,
       "Where there is no basin neither height is drawn: a cross at the foot of the frame stands "
       "for it."},
      fmt::format("Above, over the stiffness of the left beam, the height of the barrier above the "
                  "basin and above the start{}. Below, the shares that traverse with 95 % bars, a "
                  "curve for each damping.",
                  foot),
      studies,
      csv.text(),
      out.figure(594)};
}

}  // namespace gatewalk::cli
