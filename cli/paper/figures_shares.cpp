// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "cli/fields/csv.h"
#include "cli/fields/text.h"
#include "cli/paper/figures.h"
#include "cli/paper/studies.h"
#include "cli/render/final_gates.h"

namespace gatewalk::cli {

namespace {

/// A percentage in a cell of a map; "0" for none.
std::string short_share(double share) { return share == 0.0 ? "0" : short_percent(share); }

}  // namespace

Section fig8(const Findings& f) {
  Csv csv("damping_Nms_per_rad,propulsion_N,random_N,trials,traversed,low,high,exited,trapped");
  const RootScale scale(100.0);
  constexpr double kLeft = 58, kRight = 242, kWide = 168, kTop = 62, kTall = 154;
  constexpr double kSmall = 94, kGap = 14, kDeep = 100, kUnder = 316, kNext = 152;
  Panels out = paper_panels();
  const std::string trials = digits(static_cast<double>(f.fig8.points[0].trials));
  std::map<int, std::vector<const Rows*>> curves;  // by damping
  out.say(as_printed("traversed, %; k_L = k_R = 400 N m/rad, n = " + trials), 8, 18);
  for (const int damping : {50, 10}) {
    const std::string name = fmt::format("$d{}", damping);
    Rows map(name);
    for (int random = 0; random <= 60; random += 10) {
      Rows& curve = out.data(fmt::format("{}_{}", name, random));
      curves[damping].push_back(&curve);
      for (int force = 4; force <= 9; ++force) {
        const PaperPoint& p = fig8_at(f, damping, force, random);
        const Share s = p.traversed_share();
        const auto n = static_cast<double>(p.trials);
        csv.row(damping, force, random, n, s.value, s.low, s.high,
                static_cast<double>(p.exited()) / n,
                static_cast<double>(p[dynamics::Outcome::trapped]) / n);
        map.add(force, random, root_percent(s.value), short_share(s.value));
        // Without a random force all trials are the same run.
        curve.add(force, root_percent(s.value), root_percent(random == 0 ? s.value : s.low),
                  root_percent(random == 0 ? s.value : s.high));
      }
    }
    const bool first = damping == 50;
    const double left = first ? kLeft : kRight;
    Panel& panel = add_panel(out, {left, left + kWide, kTop, kTop + kTall}, "F_prop (N)",
                             first ? "Rm (N)" : "");
    panel.say(as_printed(first ? "d = 50 N m s/rad, as printed" : "d = 10 N m s/rad"), left,
              kTop - 12, kSmallFont);
    panel.tics_font = kSmallFont;
    panel.x = {"", 3.5, 9.5, "1"};
    panel.y = {"", -5, 65, "10", "", first};
    panel.colours = {0, std::sqrt(scale.most())};
    if (first) {
      add_colours(panel, scale, {kRight + kWide + 12, kRight + kWide + 24, kTop, kTop + kTall});
      panel.colours->tics = root_tics({0, 1, 5, 20, 50, 100}) + " font ',12' offset -0.8,0";
    }
    panel.draw_cells(out.data(map), 0.5, 5);
    panel.draw_numbers(std::sqrt(scale.most()));
  }
  for (int i = 0; i <= 6; ++i) {
    const int column = i % 4, row = i / 4;
    const double left = kLeft + column * (kSmall + kGap), top = kUnder + row * kNext;
    Panel& panel =
        add_panel(out, {left, left + kSmall, top, top + kDeep}, i >= 3 ? "F_prop (N)" : "", "");
    panel.say(as_printed(fmt::format("Rm = {} N", 10 * i)), left + 4, top - 10, kSmallFont);
    panel.tics_font = kSmallFont;
    panel.x = {"", 3.7, 9.3, "1"};
    panel.y = {"", -0.4, 10.4, root_tics({0, 2, 10, 30, 60, 100}, column == 0), "", false};
    panel.grid = std::string("ytics") + kGrid;
    panel.more = "set bars 0.5\n";
    if (i == 0) {
      const double beside = kLeft + 3 * (kSmall + kGap), under = kUnder + kNext;
      panel.texts.push_back({"traversed (%, root scale)", 10, kUnder + 0.5 * (kNext + kDeep), kFont,
                             "center rotate by 90"});
      panel.key = {"left top Left reverse samplen 2", beside, under + 6};
      panel.say(as_printed("95 % intervals"), beside, under + 68, kSmallFont);
      panel.say(as_printed("n = " + trials), beside, under + 86, kSmallFont);
    }
    panel.draw(*curves[50][static_cast<std::size_t>(i)], "1:2:3:4", "yerrorlines",
               {kFirstColour, 1.2, 7, 0.5}, as_printed("d = 50"));
    panel.draw(*curves[10][static_cast<std::size_t>(i)], "1:2:3:4", "yerrorlines",
               {kSecondColour, 1.2, 5, 0.5}, as_printed("d = 10"));
  }
  return {
      "fig8",
      "Fig. 8: traversal of equal beams",
      {fmt::format(
           "k = 400 N m/rad, from rest, {} trials a point (paper: 100), Table I's grid and two "
           "more rows of random force. Where propulsion alone is enough everybody gets through and "
           "random force only hinders; below that a few do, and only with random force. At Rm = 0 "
           "all trials are the same run, so those shares are 0 or 1 without an interval.",
           trials),
       "Below that threshold traversal need not rise step by step with the propulsion: see the "
       "claims. Colours and the axes of the curves show the square root of the share, so that "
       "small ones can be told apart."},
      "Two maps of the share traversed over propulsion and random force with a number in each "
      "cell, one for each damping; below, the same as curves over the propulsion, a panel for "
      "each random force: near zero below 8 or 9 newton of propulsion, near one above it "
      "without random force, falling with random force there.",
      {"fig8", "exits"},
      csv.text(),
      out.figure(626)};
}

Section fig12(const Findings& f) {
  constexpr std::int64_t kFew = 10;  // traversals; below this number no share is shown
  int grey = 0;                      // cells with fewer traversals
  Csv csv(
      "damping_Nms_per_rad,propulsion_N,random_N,k_left_Nm_per_rad,trials,successes,right,low,"
      "high");
  constexpr double kLeft = 68, kRight = 256, kWide = 172, kTop = 62, kNext = 232, kTall = 180;
  const int height = static_cast<int>(kTop + kNext + kTall + 86);
  const std::vector<double> stiffnesses = f.fig12.values(kLeftStiffness);
  const double half = 0.5 * (stiffnesses.at(1) - stiffnesses[0]);  // half a cell
  Panels out = paper_panels();
  out.say(as_printed("past the right beam, % of the traversed; k_R = 500 N m/rad"), 8, 18);
  out.say(as_printed(fmt::format(
              "grey, (3): too few for a share; of {} trials 3 traversed; d in N m s/rad",
              f.fig12.points[0].trials)),
          8, height - 14, kSmallFont);
  for (const int damping : {50, 10})
    for (const int force : {7, 8}) {
      const std::string name = fmt::format("$d{}f{}", damping, force);
      Rows &shares = out.data(name), &few = out.data(name + "_few");
      for (const double k : stiffnesses)
        for (int random = 10; random <= 60; random += 10) {
          const PaperPoint& cell = fig12_at(f, damping, force, random, k);
          const Share s = cell.right_share();
          csv.row(damping, force, random, k, static_cast<double>(cell.trials),
                  static_cast<double>(s.whole), s.value, s.low, s.high);
          grey += s.whole < kFew;
          if (s.whole < kFew)
            few.add(random, k, fmt::format("({})", s.whole));
          else
            shares.add(random, k, 100.0 * s.value, short_share(s.value));
        }
      if (shares.empty()) shares.add("NaN NaN NaN NaN");
      if (few.empty()) few.add("NaN NaN NaN");
      const bool first = force == 7, upper = damping == 50;
      const double left = first ? kLeft : kRight, top = upper ? kTop : kTop + kNext;
      Panel& panel = add_panel(out, {left, left + kWide, top, top + kTall}, upper ? "" : "Rm (N)",
                               first ? "k_L (N m/rad)" : "", 54);
      panel.say(as_printed(fmt::format("F_prop = {} N, d = {}", force, damping)), left, top - 14,
                kSmallFont);
      panel.tics_font = kSmallFont;
      panel.border = 15;
      panel.x = {"", 5, 65, "10"};
      panel.y = {"", stiffnesses.front() - half, stiffnesses.back() + half, "100", "", first};
      panel.colours = {.low = 0, .high = 100, .palette = kDiverging};
      if (first && upper) {
        panel.colours->bar = {kRight + kWide + 12, kRight + kWide + 24, kTop, kTop + kTall};
        panel.colours->tics = "25 font ',12' offset -0.8,0";
      }
      panel.draw_cells(shares, 5, half);
      panel.draw_again("1:2:4:($3 < 20 || $3 > 80 ? 0xffffff : 0x000000)",
                       "labels tc rgb variable font ',12'");
      panel.draw(few, fmt::format("1:2:(5):({})", digits(half)), kBars, {"#a8a8a8"});
      panel.draw_again("1:2:3", "labels tc rgb '#000000' font ',12'");
    }
  return {"fig12",
          "Fig. 12: right trials of all successful ones",
          {fmt::format("Of those that traverse, the share that pushed more past the right beam: "
                       "blue, past the left one; white, both alike; red, past the right one. A "
                       "softer left beam draws the body to the left. The paper's A is 7 N, its B 8 "
                       "N. {} trials a cell. Where fewer than 10 get through there is no share to "
                       "speak of: those cells are grey and say, in parentheses, how many do.",
                       f.fig12.points[0].trials)},
          fmt::format("Four maps of the share of right traversals over left stiffness and random "
                      "force, a number in each cell: from blue, none on the right, over white, one "
                      "half, to red, all. In {} of {} cells, grey, a small number in parentheses.",
                      grey, f.fig12.points.size()),
          {"fig12"},
          csv.text(),
          out.figure(height)};
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
    for (const PaperPoint& p : study.points) {
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
  return {"thirteen_eight",
          "The 13 % and 8 % of Fig. 9A",
          {fmt::format(
               "With k_L = k_R = 500 the paper sees 21 of 100 bodies traverse. Here hardly any "
               "does. The landscape's argument: on the paper's grid of 0.5 m the lowest way "
               "through rises {} J above the start, on one of 0.05 m {} J; a body that has come to "
               "rest in the basin must climb {} J. The start is at rest, so only the work of the "
               "random force could lift it, and hits and dampers take what it gives.",
               fixed(landscape.coarse.above_start(), 1), fixed(landscape.fine.above_start(), 1),
               fixed(landscape.fine.from_basin.barrier(), 0)),
           fmt::format("Tried, {} settings: four methods, the paper's own Euler scheme among them, "
                       "whose drifting constraints create energy; that at five steps; other "
                       "dampings, restitutions, rates of the random force, starting speeds, random "
                       "forces, and more propulsion. The rows show which makes as many traverse. "
                       "The printed parameters do not give these two numbers in this model.",
                       settings)},
          "Dots with 95 % bars of the share traversed for many settings in seven groups, a colour "
          "for each damping, and a dashed line at the paper's 21 %, which only the largest "
          "propulsions reach.",
          {"tried_method", "tried_step", "tried_restitution", "tried_rate", "tried_start",
           "tried_random", "tried_propulsion", "paper_method", "barrier_500"},
          csv.text(),
          rates({"k_L = k_R = 500 N m/rad; unless said F_prop = 7 N, Rm = 10 N",
                 fmt::format("95 % intervals, n = {}; d in N m s/rad",
                             digits(static_cast<double>(f.tried_method.points[0].trials)))},
                series, groups, "traversed (%, root scale)")};
}
}  // namespace gatewalk::cli
