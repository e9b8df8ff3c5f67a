// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "cli/fields/text.h"
#include "cli/paper/claims.h"
#include "cli/paper/studies.h"
#include "dynamics/disc/landscape.h"

namespace gatewalk::cli {
namespace {

Measured landscape_sides(const Findings& /*f*/) {
  dynamics::GateParams p;
  p.beams.stiffness_left = 500;
  p.beams.stiffness_right = 250;
  double left = 0, right = 0;
  for (double y = 20; y <= 60; y += 0.5) {
    left = std::max(left, dynamics::beam_energy(p, -5, y));
    right = std::max(right, dynamics::beam_energy(p, 5, y));
  }
  return {holds_or_differs(right < left), {{"left", left}, {"right", right}}};
}

Measured basin(const Findings& f) {
  const dynamics::GridPasses& grid = f.fig5_symmetric.fine;
  const double y = grid.from_basin.way.front()[1];
  return {holds_or_differs(!grid.downhill() && y > 20 && y < dynamics::GateParams{}.beams.joint_y),
          {{"ours", grid.downhill() ? "no basin" : "its floor is at y = " + fixed(y, 1) + " m"}}};
}

Measured escape(const Findings& f) {
  const PaperPoint& p = fig8_at(f, 50, 8, 0);
  const Share still = p.traversed_share(), shaken = fig8_at(f, 50, 8, 40).traversed_share();
  const bool helped = rises(still, shaken),
             enough = std::min(still.whole, shaken.whole) >= kEnoughTrials;
  return {verdict_of(falls(still, shaken) || (enough && (!helped || still.low > 0.5)),
                     enough && helped && still.high < 0.5),
          {{"still", 100 * still.value},
           {"shaken", shaken},
           {"trapped", 100 * share_of(p[dynamics::Outcome::trapped], p.trials).value}}};
}

Measured steep(const Findings& f) {
  const bool downhill = f.steep.fine.downhill();
  const Share share = f.steep.measured.traversed_share();
  // "Always" means 100 of the paper's 100 trials, or all trials if there are more.
  Verdict verdict = downhill ? against(kPaperTrials, share) : Verdict::differs;
  if (verdict == Verdict::reproduced && share.part < share.whole) verdict = Verdict::agrees;
  return {verdict,
          {{"basin", downhill ? "no basin" : "a basin"},
           {"share", share},
           {"at_9", 100 * fig8_at(f, 50, 9, 0).traversed_share().value}}};
}

/// Counts moments of runs within the beams' reach.
struct Moments {
  std::int64_t looked = 0;
  std::int64_t below = 0;      // moments more than 0.5 J below the landscape
  std::int64_t explained = 0;  // of `below`: not below the landscape of one beam alone

  void look_at(const TracedRun& run) {
    for (std::size_t i = 0; i < run.t.size(); ++i) {
      const double height = run.landscape[i], left = run.landscape_left[i],
                   right = run.landscape_right[i];
      if (std::isnan(height) || (left == 0.0 && right == 0.0)) continue;
      ++looked;
      if (!(run.potential[i] < height - 0.5)) continue;
      ++below;
      // Leaves out the beam that lags most behind the deflection that the landscape assumes.
      const bool left_missing = left - run.elastic_left[i] > right - run.elastic_right[i];
      explained += run.potential[i] > height - (left_missing ? left : right) - 0.5;
    }
  }
  [[nodiscard]] double above() const { return 1 - share_of(below, looked).value; }
};

Measured above_landscape(const Findings& f) {
  Moments softer;
  for (const TracedRun& run : f.fig9_300.runs) softer.look_at(run);
  Moments all = softer;
  for (const TracedRun& run : f.fig6.runs) all.look_at(run);
  const Share above = share_of(all.looked - all.below, all.looked),
              artifact = share_of(all.explained, all.below);
  return {holds_or_differs(above.value > 0.5 && artifact.value > 0.95),
          {{"above", 100 * above.value},
           {"softer", 100 * softer.above()},
           {"explained", 100 * artifact.value}}};
}

Measured many_hits(const Findings& f) {
  double hits = 0;
  for (const TracedRun& run : f.fig9_300.runs) hits += static_cast<double>(run.hits);
  const auto runs = f.fig9_300.runs.size();
  const double mean = hits / static_cast<double>(runs);
  return {holds_or_differs(mean >= 10), {{"mean", mean}, {"runs", runs}}};
}

Measured euler_step(const Findings& f) {
  const PaperPoint &by_paper = f.paper_method.at({{"run.method", "paper"}, {kDamping, 10}}),
                   &by_event = f.paper_method.at({{"run.method", "event"}, {kDamping, 10}});
  const Share paper = by_paper.left_share(), event = by_event.left_share();
  const bool apart = rises(paper, event) || falls(paper, event), seen = seen_with_100(paper, event);
  return {verdict_of(apart && seen, !apart && paper.whole >= 10 * kEnoughTrials, apart),
          {{"paper", paper},
           {"event", event},
           {"depth", by_paper.health.worst_penetration},
           {"unseen_by", when(!seen, kPaperTrials)}}};
}

Measured run_time(const Findings& f) {
  const double seconds = f.field_paper_method.seconds_per_trial();
  return {holds_or_differs(seconds >= 300 && seconds <= 1200), {{"ms", 1e3 * seconds}}};
}

Measured inertia(const Findings& /*f*/) {
  const double i = dynamics::Beams{}.inertia();
  return {holds_or_differs(std::abs(i - 20.83) < 0.005), {{"inertia", i}}};
}

}  // namespace

std::vector<ClaimRow> claims_on_one_run() {
  return {
      {{"landscape_sides", "Sec. II-C, Fig. 5", "fig5"},
       "Two barriers that overlap in the middle; with unequal beams the softer side's is lower.",
       {"lower on the softer side", "{left} J on the left, {right} J on the right",
        landscape_sides},
       {"k_L = 500, k_R = 250: the highest elastic energy on the way 5 m left and right of the "
        "middle."}},
      {{"basin", "Sec. II-C, Fig. 5D", "fig5"},
       "With a modest propulsion a basin lies in front of the beams, around y = 20 m.",
       {"around 20 m", "{ours}", basin},
       {"F_prop = 7 N, k = 400. The disc touches the beams from y = 20 m on and has not passed "
        "their line, y = 30 m, there."}},
      {{"escape", "Sec. II-C", "fig8"},
       "With too little propulsion the body is trapped in the basin; the random force helps it "
       "out.",
       {"trapped; helped out", "{still} % traverse without, {shaken} with Rm 40 N", escape},
       {"8 N, d = 50. Without random force all runs are the same one: {trapped} % are trapped."}},
      {{"steep", "Sec. II-C", "fig5"},
       "With enough propulsion the basin disappears and the body always traverses.",
       {"always", "{basin}, {share} at 20 N", steep},
       {"k = 400, Rm 10 N, d = 50. At 9 N, without random force, {at_9} % do already."}},
      {{"above_landscape", "Sec. II-C, Fig. 6", "fig6"},
       "The system's potential energy is typically above the landscape; where it is below, a beam "
       "has let go of the body.",
       {"typically above", "above for {above} % of the time", above_landscape},
       {"Traversals with k_L = 300 ({softer} %) and of Fig. 6, moments within the beams' reach, "
        "above or less than 0.5 J below. Of the others {explained} % are above the landscape "
        "without the beam that is less deflected than it assumes."}},
      {{"many_hits", "Sec. II-A", "fig9"},
       "With CoR = 0.8 traversal still occurs after a large number of collisions.",
       {"a large number", "{mean} hits on average", many_hits},
       {"In {runs} traversals with k_L = 300, k_R = 500, d = 10; ten would count as many."}},
      {{"euler_step", "Sec. II-B", "thirteen_eight"},
       "Euler's method with a step of 0.004 s is accurate enough.",
       {"good accuracy", "{paper} traverse left; reference {event}", euler_step},
       {"k_L = 300, d = 10, against the event-driven reference. Its constraints act on "
        "accelerations and drift: bodies sink into beams by up to {depth:1} m.",
        "{unseen_by} trials do not show what that changes in the outcomes."}},
      {{"run_time", "Sec. II-B", "speed"},
       "A trial takes 5 to 20 minutes on a lab workstation.",
       {"5 to 20 min", "{ms:2} ms", run_time},
       {"A whole trial through the field by the same Euler scheme, several gates long. Compiled "
        "code; the paper used MATLAB."}},
      {{"inertia", "Sec. II-A", "fig5"},
       "A beam's moment of inertia about its joint is 20.83 kg m^2.",
       {"20.83 kg m^2", "{inertia:2} kg m^2", inertia},
       {"m L^2 / 3, a uniform rod."}}};
}

}  // namespace gatewalk::cli
