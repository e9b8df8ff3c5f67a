// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "cli/paper/claims.h"
#include "cli/paper/studies.h"

namespace gatewalk::cli {

Claim softer_side(const Findings& f) {
  Places cells;
  std::string worst;
  double most = 0.0;
  for (const double damping : {50.0, 10.0})
    for (const double force : {7.0, 8.0})
      for (double random = 10; random <= 60; random += 10)
        for (const double k : f.fig12.values(kLeftStiffness)) {
          if (k == 500) continue;
          const SweepPoint& cell = fig12_at(f, damping, force, random, k);
          const Share right = cell.right_share();
          if (right.whole == 0) continue;
          ++cells.of;
          cells.hold += right.high < 0.5;
          if (right.low <= 0.5) continue;
          ++cells.fail;
          const double successes = static_cast<double>(kPaperTrials) * cell.traversed_share().value;
          cells.seen +=
              (right.value - 0.5) * (right.value - 0.5) > 4.0 * 0.25 / std::max(1.0, successes);
          if (right.value <= most || right.whole < 20) continue;
          most = right.value;
          worst = percent_text(right) + " right at k_L = " + number(k) + ", " + number(force) +
                  " N, Rm " + number(random) + " N, d = " + number(damping);
        }
  const bool enough = f.fig12.points[0].trials >= kEnoughTrials;
  std::string why =
      "Beyond chance, of the cells of Table II with unequal beams in which anybody gets through.";
  if (cells.fail > 0)
    why += " The exceptions are nearly equal beams that few get past" +
           (worst.empty() ? "" : ", such as " + worst) + "; 100 trials a cell would show " +
           std::to_string(cells.seen) + " of them.";
  return {"softer_side",
          "Abstract, Sec. III-B",
          "With unequal beams, traversal is more likely towards the side of the less stiff beam.",
          "towards the softer side",
          cells.of == 0 ? "nobody gets past unequal beams"
                        : "softer side in " + of(cells.hold, cells.of) +
                              " cells, stiffer side in " + std::to_string(cells.fail),
          cells.verdict(enough),
          why,
          "fig12"};
}

Claim thirteen_and_eight(const Findings& f) {
  const SweepPoint& point = f.tried_method.at({{"run.method", "stable"}, {kDamping, 50}});
  const Share left = share_of(point.traversed_left, point.trials),
              right = share_of(point.traversed_right, point.trials);
  const LandscapeStudy& landscape = f.barriers.at(500);
  constexpr double kPrinted = 0.21;
  Share most;
  int settings = 0;
  for (const Sweep* study : {&f.tried_method, &f.tried_step, &f.tried_restitution, &f.tried_rate,
                             &f.tried_start, &f.tried_random})
    for (const SweepPoint& p : study->points) {
      const Share s = p.traversed_share();
      ++settings;
      if (most.whole == 0 || s.value > most.value) most = s;
    }
  std::string enough;
  for (const SweepPoint& p : f.tried_propulsion.points) {
    if (p.traversed_share().value < kPrinted || !enough.empty()) continue;
    enough = " It takes " + p.at(kPropulsion).text + " N (d = " + p.at(kDamping).text +
             ") instead of 7 N.";
  }
  return {
      "thirteen_and_eight",
      "Sec. III-B, Fig. 9A",
      "k_L = k_R = 500, F_prop = 7 N, Rm = 10 N: 13 % traverse left, 8 % right.",
      "13 % and 8 %",
      percent_text(left) + " and " + percent_text(right),
      std::max(against(13, left), against(8, right)),
      "The lowest way through lies " + number(landscape.fine.above_start, 1) +
          " J above the start (" + number(landscape.coarse.above_start, 1) +
          " J on the paper's grid of 0.5 m), which is at rest, and " +
          number(landscape.fine.above_basin) + " J above the basin on the way. " +
          std::to_string(settings) +
          " settings tried (methods, the paper's Euler scheme with its drifting constraint among "
          "them; steps, dampings, restitutions, rates of the random force, starting speeds, "
          "random forces) give at most " +
          percent_text(most) + " together." + enough,
      "thirteen_eight"};
}

Claim alike(const Findings& f) {
  const SweepPoint& point = f.tried_method.at({{"run.method", "stable"}, {kDamping, 50}});
  const Share right = point.right_share();
  return {"alike",
          "Sec. III-B, Fig. 9A",
          "With equal beams, traversal is rare and similarly probable on both sides.",
          "similar",
          percent_text(point.traversed_share()) + " traverse, " + percent_text(right) +
              " of these on the right",
          rare_and_even(point.traversed_share(), right),
          "Of " + std::to_string(right.whole) +
              " that traverse. Similar is what the paper's 13 and 8 of 100 do not tell from equal: "
              "28 to 72 % on the right.",
          "fig9"};
}

Claim percentage(const Findings& f, const char* id, const char* where, double k_left,
                 double damping, std::int64_t printed) {
  const SweepPoint& p = fig12_at(f, damping, 7, 10, k_left);
  const Share ours = share_of(p.traversed_left, p.trials);
  return {id,
          where,
          "k_L = " + number(k_left) +
              ", k_R = 500, F_prop = 7 N, Rm = 10 N: " + std::to_string(printed) +
              " % traverse by the left beam (d = " + number(damping) + ").",
          std::to_string(printed) + " %",
          percent_text(ours),
          against(printed, ours),
          damping == 50 ? "d as Table I prints it."
                        : "Sec. III-C says that damping was increased to 50 for the field: a "
                          "reading with a smaller one here.",
          "fig9"};
}

Claim right_share_falls(const Findings& f, bool strong) {
  Trend trend;
  for (const double damping : {50.0, 10.0})
    for (const double force : {7.0, 8.0})
      for (const double random :
           strong ? std::vector<double>{40, 50, 60} : std::vector<double>{10, 20, 30}) {
        std::vector<Share> told;
        std::vector<double> where, counted;
        for (const double k : f.fig12.values(kLeftStiffness)) {
          const SweepPoint& cell = fig12_at(f, damping, force, random, k);
          const Share s = cell.right_share();
          if (s.whole < 10)
            continue;  // where hardly anybody gets through there is no share to speak of
          told.push_back(s);
          where.push_back(k);
          counted.push_back(cell.traversed_share().value);
        }
        if (told.size() >= 2) trend.add(where, told, counted);
      }
  const double random = strong ? 50 : 20;
  const Share soft = fig12_at(f, 50, 8, random, 100).right_share(),
              hard = fig12_at(f, 50, 8, random, 500).right_share();
  std::string why = "Lower at the soft end than at the stiff end beyond chance in " +
                    of(trend.up, trend.series) +
                    " settings of propulsion, random force and damping, higher in " +
                    std::to_string(trend.down) + ".";
  if (trend.falling > 0)
    why += " " + of(trend.falling, trend.steps) + " steps go the other way, by up to " +
           number(100 * trend.largest_fall, 1) + " points (from " + number(trend.at) + ").";
  if (trend.lower > 0)
    why += " Of all falls between two stiffnesses 100 trials a cell would show " +
           of(trend.seen, trend.lower) + ".";
  return {strong ? "right_share_strong" : "right_share_weak",
          "Sec. III-B, Fig. 12",
          strong ? "Rm >= 40 N: the trend is still there, less monotonic."
                 : "Rm < 40 N: the softer the left beam, the fewer traversals on the right.",
          strong ? "the same, less monotonic" : "falls",
          percent_text(soft) + " at k_L = 100, " + percent_text(hard) + " at 500 (8 N, Rm " +
              number(random) + " N, d = 50)",
          trend.verdict(strong),
          why,
          "fig12"};
}

Claim fig12_propulsion(const Findings& f) {
  Places cells;
  double softest = 1e9;
  std::int64_t trials = 0;
  for (const double damping : {50.0, 10.0})
    for (const double k : f.fig12.values(kLeftStiffness))
      for (double random = 10; random <= 60; random += 10) {
        const Share seven = fig12_at(f, damping, 7, random, k).traversed_share(),
                    eight = fig12_at(f, damping, 8, random, k).traversed_share();
        ++cells.of;
        trials = seven.whole;
        cells.hold += rises(seven, eight);
        if (!falls(seven, eight)) continue;
        ++cells.fail;
        softest = std::min(softest, k);
        cells.seen += seen_with_100(seven, eight);
      }
  const bool enough = trials >= kEnoughTrials;
  std::string why = "Cells in which 8 N differ from 7 N beyond chance, d = 50 and 10.";
  if (cells.fail > 0)
    why += " Lower only from k_L = " + number(softest) + " on; 100 trials a cell would show " +
           of(cells.seen, cells.fail) + ".";
  return {
      "fig12_propulsion",
      "Sec. III-B, Fig. 12",
      "Unequal beams: traversal rises with the propulsive force.",
      "rises from 7 to 8 N",
      "higher in " + of(cells.hold, cells.of) + " cells, lower in " + std::to_string(cells.fail),
      cells.verdict(enough, true),
      why,
      "fig12"};
}
}  // namespace gatewalk::cli
