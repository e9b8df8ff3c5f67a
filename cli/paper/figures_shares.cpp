// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "cli/paper/figures.h"
#include "cli/paper/studies.h"
#include "cli/render/csv.h"
#include "cli/render/final_gates.h"
#include "cli/render/text.h"

namespace gatewalk::cli {

namespace {

/// Percent for a cell of a map, none as "0".
std::string short_share(double share) { return share == 0.0 ? "0" : short_percent(share); }

}  // namespace

Section fig8(const Findings& f) {
  Csv csv("damping_Nms_per_rad,propulsion_N,random_N,trials,traversed,low,high,exited,trapped");
  const RootScale scale(100.0);
  const Sheet sheet{626};
  constexpr double kLeft = 58, kRight = 242, kWide = 168, kTop = 62, kTall = 154;
  constexpr double kSmall = 94, kGap = 14, kDeep = 100, kUnder = 316, kNext = 152;
  std::string data, panels, curves;
  const std::string trials = digits(static_cast<double>(f.fig8.points[0].trials));
  for (const int damping : {50, 10}) {
    const std::string name = "$d" + std::to_string(damping);
    std::string map;
    for (int random = 0; random <= 60; random += 10) {
      std::string curve;
      for (int force = 4; force <= 9; ++force) {
        const SweepPoint& p =
            f.fig8.at({{kDamping, damping}, {kPropulsion, force}, {kRandom, random}});
        const Share s = p.traversed_share();
        const auto n = static_cast<double>(p.trials);
        csv.row(damping, force, random, n, s.value, s.low, s.high,
                static_cast<double>(p.exited()) / n,
                static_cast<double>(p[dynamics::Outcome::trapped]) / n);
        map += std::to_string(force) + " " + std::to_string(random) + " " +
               digits(root_percent(s.value)) + " " + short_share(s.value) + "\n";
        // Without a random force all trials are the same run.
        curve += line_of({static_cast<double>(force), root_percent(s.value),
                          root_percent(random == 0 ? s.value : s.low),
                          root_percent(random == 0 ? s.value : s.high)});
      }
      data += data_block(name + "_" + std::to_string(random), curve);
    }
    data += data_block(name, map);
    const bool first = damping == 50;
    const double left = first ? kLeft : kRight;
    panels += frame(sheet, {left, left + kWide, kTop, kTop + kTall}, "F_prop (N)",
                    first ? "Rm (N)" : "") +
              words(sheet, first ? "d = 50 N m s/rad, as printed" : "d = 10 N m s/rad", left,
                    kTop - 12, kSmallFont) +
              (first ? scale.colours(
                           sheet, {kRight + kWide + 12, kRight + kWide + 24, kTop, kTop + kTall}) +
                           "set cbtics " + root_tics({0, 1, 5, 20, 50, 100}) + " font ',12'\n"
                     : "unset colorbox\n") +
              "plot " + name + cells(0.5, 5) + ", '' using 1:2:4:" + ink(std::sqrt(scale.most())) +
              " with labels tc rgb variable font ',12'\nunset label\n";
  }
  for (int i = 0; i <= 6; ++i) {
    const int column = i % 4, row = i / 4;
    const double left = kLeft + column * (kSmall + kGap), top = kUnder + row * kNext;
    const std::string random = std::to_string(10 * i);
    curves +=
        frame(sheet, {left, left + kSmall, top, top + kDeep}, i >= 3 ? "F_prop (N)" : "", "") +
        words(sheet, "Rm = " + random + " N", left + 4, top - 10, kSmallFont) + "set ytics " +
        root_tics({0, 2, 10, 30, 60, 100}, column == 0) + "\n";
    if (i == 0)
      curves += "set key at screen " + sheet.at(kLeft + 3 * (kSmall + kGap), kUnder + kNext + 6) +
                " left top Left reverse samplen 2\n" +
                words(sheet, "95 % intervals", kLeft + 3 * (kSmall + kGap), kUnder + kNext + 68,
                      kSmallFont) +
                words(sheet, "n = " + trials, kLeft + 3 * (kSmall + kGap), kUnder + kNext + 86,
                      kSmallFont);
    const auto series = [&](const char* name, const char* colour, const char* marker,
                            const char* title) {
      return std::string(name) + "_" + random + " using 1:2:3:4 with yerrorlines lw 1.2 pt " +
             marker + " ps 0.5 lc rgb '" + colour + "' " +
             (i == 0 ? "title " + quoted(title) : "notitle");
    };
    curves += "plot " + series("$d50", kFirstColour, "7", "d = 50") + ", " +
              series("$d10", kSecondColour, "5", "d = 10") + "\nunset label\nunset key\n";
  }
  return {
      "fig8",
      "Fig. 8: traversal of equal beams",
      {"k = 400 N m/rad, from rest, " + trials +
           " trials a point (paper: 100), Table I's grid and two more rows of random force. "
           "Where propulsion alone is enough everybody gets through and random force only "
           "hinders; below that a few do, and only with random force. At Rm = 0 all trials are "
           "the same run, so those shares are 0 or 1 without an interval.",
       "Below that threshold traversal need not rise step by step with the propulsion: see the "
       "claims. Colours and the axes of the curves show the square root of the share, so that "
       "small ones can be told apart."},
      "Two maps of the share traversed over propulsion and random force with a number in each "
      "cell, one for each damping; below, the same as curves over the propulsion, a panel for "
      "each random force: near zero below 8 or 9 newton of propulsion, near one above it "
      "without random force, falling with random force there.",
      {"fig8", "exits"},
      csv.text(),
      figure_of(sheet, data,
                std::string(kSequential) +
                    words(sheet, "traversed, %; k_L = k_R = 400 N m/rad, n = " + trials, 8, 18) +
                    kSmallTics + "set border 3\nset cbrange " + scale.range() +
                    "\nset xrange [3.5:9.5]\nset yrange [-5:65]\nset xtics 1\nset ytics 10\n" +
                    panels + "set xrange [3.7:9.3]\nset yrange [-0.4:10.4]\nset grid ytics" +
                    kGrid + "\nset bars 0.5\nset label 'traversed (%, root scale)' at screen " +
                    sheet.at(10, kUnder + 0.5 * (kNext + kDeep)) + " center rotate by 90\n" +
                    curves)};
}

Section fig12(const Findings& f) {
  constexpr std::int64_t kFew = 10;  // traversed; of fewer no share is shown
  int grey = 0;                      // cells of so few
  Csv csv(
      "damping_Nms_per_rad,propulsion_N,random_N,k_left_Nm_per_rad,trials,successes,right,low,"
      "high");
  constexpr double kLeft = 68, kRight = 256, kWide = 172, kTop = 62, kNext = 232, kTall = 180;
  const Sheet sheet{static_cast<int>(kTop + kNext + kTall + 86)};
  const Box bar{kRight + kWide + 12, kRight + kWide + 24, kTop, kTop + kTall};
  std::string data, panels;
  const std::vector<double> stiffnesses = f.fig12.values(kLeftStiffness);
  const double half = 0.5 * (stiffnesses.at(1) - stiffnesses[0]);  // of a cell
  for (const int damping : {50, 10})
    for (const int force : {7, 8}) {
      std::string shares, few;
      for (const double k : stiffnesses)
        for (int random = 10; random <= 60; random += 10) {
          const SweepPoint& cell = f.fig12.at(
              {{kDamping, damping}, {kPropulsion, force}, {kRandom, random}, {kLeftStiffness, k}});
          const Share s = cell.right_share();
          csv.row(damping, force, random, k, static_cast<double>(cell.trials),
                  static_cast<double>(s.whole), s.value, s.low, s.high);
          const std::string place = std::to_string(random) + " " + digits(k) + " ";
          grey += s.whole < kFew;
          if (s.whole < kFew)
            few += place + "(" + std::to_string(s.whole) + ")\n";
          else
            shares += place + digits(100.0 * s.value) + " " + short_share(s.value) + "\n";
        }
      const std::string name = "$d" + std::to_string(damping) + "f" + std::to_string(force);
      data += data_block(name, shares.empty() ? "NaN NaN NaN NaN\n" : shares) +
              data_block(name + "_few", few.empty() ? "NaN NaN NaN\n" : few);
      const bool first = force == 7, upper = damping == 50;
      const double left = first ? kLeft : kRight, top = upper ? kTop : kTop + kNext;
      panels +=
          frame(sheet, {left, left + kWide, top, top + kTall}, upper ? "" : "Rm (N)",
                first ? "k_L (N m/rad)" : "", 54) +
          words(sheet, "F_prop = " + std::to_string(force) + " N, d = " + std::to_string(damping),
                left, top - 14, kSmallFont) +
          "plot " + name + cells(5, half) +
          ", '' using 1:2:4:($3 < 20 || $3 > 80 ? 0xffffff : 0x000000) with "
          "labels tc rgb variable font ',12', " +
          name + "_few using 1:2:(5):(" + digits(half) +
          ") with boxxyerror fillstyle solid noborder lc rgb "
          "'#a8a8a8', '' using 1:2:3 with labels tc rgb '#000000' font ',12'\nunset label\n"
          "unset colorbox\n";
    }
  return {
      "fig12",
      "Fig. 12: right trials of all successful ones",
      {"Of those that traverse, the share that pushed more past the right beam: blue, past the "
       "left one; white, both alike; red, past the right one. A softer left beam draws the "
       "body to the left. The paper's A is 7 N, its B 8 N. " +
       std::to_string(f.fig12.points[0].trials) +
       " trials a cell. Where fewer than 10 get through there is no share to speak of: "
       "those cells are grey and say, in parentheses, how many do."},
      "Four maps of the share of right traversals over left stiffness and random force, a number "
      "in each cell: from blue, none on the right, over white, one half, to red, all. In " +
          std::to_string(grey) + " of " + std::to_string(f.fig12.points.size()) +
          " cells, grey, a small number in parentheses.",
      {"fig12"},
      csv.text(),
      figure_of(
          sheet, data,
          std::string(kDiverging) +
              words(sheet, "past the right beam, % of the traversed; k_R = 500 N m/rad", 8, 18) +
              kSmallTics + "set border 15\nset cbrange [0:100]\nset xrange [5:65]\nset yrange [" +
              digits(stiffnesses.front() - half) + ":" + digits(stiffnesses.back() + half) +
              "]\n"
              "set xtics 10\nset ytics 100\nset cbtics 25 font ',12' offset -0.8,0\n"
              "set colorbox user origin screen " +
              sheet.at(bar.left, bar.bottom) + " size screen " + digits(12.0 / Sheet::kWidth) +
              "," + digits(kTall / sheet.height) + "\n" +
              words(sheet,
                    "grey, (3): too few for a share; of " +
                        std::to_string(f.fig12.points[0].trials) +
                        " trials 3 traversed; d in N m s/rad",
                    8, sheet.height - 14, kSmallFont) +
              panels)};
}

Section thirteen_eight(const Findings& f) {
  std::vector<RateGroup> groups;
  int settings = 0;
  const std::vector<Series> series{
      {"d = 50", kFirstColour, 7}, {"d = 10", kSecondColour, 5}, {"d = 0", kThirdColour, 9}};
  const std::vector<double> dampings{50, 10, 0};
  Csv csv("group,setting,damping_Nms_per_rad,traversed,low,high,left,right,trials");
  const auto add = [&](const Sweep& study, const std::string& group, const char* key,
                       const std::string& unit) {
    RateGroup shown{group, {}, 21.0, groups.empty() ? "paper: 13 + 8 %" : ""};
    for (const SweepPoint& p : study.points) {
      const std::string text = p.text(key) + unit;
      const Share s = p.traversed_share();
      const auto n = static_cast<double>(p.trials);
      csv.row(group, text, p.number(kDamping), s.value, s.low, s.high,
              static_cast<double>(p[dynamics::Outcome::traversed_left]) / n,
              static_cast<double>(p[dynamics::Outcome::traversed_right]) / n, n);
      auto row = std::find_if(shown.rows.begin(), shown.rows.end(),
                              [&](const RateRow& r) { return r.label == text; });
      if (row == shown.rows.end())
        row = shown.rows.insert(row, {text, {3, Share{std::nan(""), 0.0, 0.0}}});
      const auto at = std::find(dampings.begin(), dampings.end(), p.number(kDamping));
      row->shares.at(static_cast<std::size_t>(at - dampings.begin())) = s;
      ++settings;
    }
    groups.push_back(std::move(shown));
  };
  add(f.tried_method, "method", "run.method", "");
  add(f.tried_step, "paper's Euler, step", "run.step_s", " s");
  add(f.tried_restitution, "restitution", "contact.restitution", "");
  add(f.tried_rate, "rate of the random force", "forces.random_rate_Hz", " Hz");
  add(f.tried_start, "starting speed", "start.vy_m_per_s", " m/s");
  add(f.tried_random, "random force", kRandom, " N");
  add(f.tried_propulsion, "propulsion", kPropulsion, " N");
  const LandscapeStudy& landscape = f.barriers.at(500);
  return {
      "thirteen_eight",
      "The 13 % and 8 % of Fig. 9A",
      {"With k_L = k_R = 500 the paper sees 21 of 100 bodies traverse. Here hardly any does. "
       "The landscape's argument: on the paper's grid of 0.5 m the lowest way through rises " +
           fixed(landscape.coarse.above_start(), 1) + " J above the start, on one of 0.05 m " +
           fixed(landscape.fine.above_start(), 1) +
           " J; a body that has come to rest in the basin must climb " +
           fixed(landscape.fine.from_basin.barrier(), 0) +
           " J. The start is at rest, so only the work of the random force could lift it, and "
           "hits and dampers take what it gives.",
       "Tried, " + std::to_string(settings) +
           " settings: four methods, the paper's own Euler scheme among them, whose drifting "
           "constraints create energy; that at five steps; other dampings, restitutions, "
           "rates of the random force, starting speeds, random forces, and more propulsion. "
           "The rows show which makes as many traverse. The printed parameters do not give "
           "these two numbers in this model."},
      "Dots with 95 % bars of the share traversed for many settings in seven groups, a colour "
      "for each damping, and a dashed line at the paper's 21 %, which only the largest "
      "propulsions reach.",
      {"tried_method", "tried_step", "tried_restitution", "tried_rate", "tried_start",
       "tried_random", "tried_propulsion", "paper_method", "barrier_500"},
      csv.text(),
      rates({"k_L = k_R = 500 N m/rad; unless said F_prop = 7 N, Rm = 10 N",
             "95 % intervals, n = " + digits(static_cast<double>(f.tried_method.points[0].trials)) +
                 "; d in N m s/rad"},
            series, groups, "traversed (%, root scale)")};
}
}  // namespace gatewalk::cli
