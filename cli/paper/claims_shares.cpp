// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "cli/fields/text.h"
#include "cli/paper/claims.h"
#include "cli/paper/studies.h"

namespace gatewalk::cli {
namespace {

using AxisValues = std::vector<double>;
const AxisValues kDampings{50, 10}, kForces{4, 5, 6, 7, 8, 9}, kPaperRandom{0, 10, 20, 30, 40},
    kWideRandom{0, 10, 20, 30, 40, 50, 60};
// The axes of Table II; the left beam's stiffness is the third.
const AxisValues kForcesOf12{7, 8}, kRandomOf12{10, 20, 30, 40, 50, 60};

/// The share at each place on an axis.
template <class Of>
std::vector<Share> along(const AxisValues& axis, Of of_place) {
  std::vector<Share> shares;
  for (const double x : axis) shares.push_back(of_place(x));
  return shares;
}
std::vector<Share> over_random(const Findings& f, double damping, double force,
                               const AxisValues& axis) {
  return along(axis,
               [&](double random) { return fig8_at(f, damping, force, random).traversed_share(); });
}

// ---- Fig. 8

Measured rises_with_propulsion(const Findings& f) {
  Trend trend;
  for (const double damping : kDampings)
    for (const double random : {10, 20, 30, 40})
      trend.add(kForces, along(kForces, [&](double force) {
                  return fig8_at(f, damping, force, random).traversed_share();
                }));
  return measured(trend, {{"low", fig8_at(f, 50, 4, 20).traversed_share()},
                          {"high", fig8_at(f, 50, 9, 20).traversed_share()}});
}

/// Shares along the random force, and the place of the highest.
struct Peak {
  std::vector<Share> s;
  std::ptrdiff_t at =
      std::max_element(s.begin(), s.end(),
                       [](const Share& a, const Share& b) { return a.value < b.value; }) -
      s.begin();

  [[nodiscard]] const Share& top() const { return s[static_cast<std::size_t>(at)]; }
  [[nodiscard]] double random() const { return kWideRandom[static_cast<std::size_t>(at)]; }
  [[nodiscard]] bool up() const { return rises(s.front(), top()); }
  [[nodiscard]] bool down() const { return falls(top(), s.back()); }
};
constexpr char kNowhere[] = "rises nowhere beyond chance";

Measured rises_then_falls(const Findings& f) {
  RiseThenFall shape, on_the_grid;
  std::optional<Peak> shown;
  std::string ours = kNowhere;
  for (const double damping : kDampings)
    for (const double force : kForces) {
      on_the_grid.add(over_random(f, damping, force, kPaperRandom));
      const Peak p{over_random(f, damping, force, kWideRandom)};
      shape.add(p.s);
      const bool better =
          p.up() && (!shown || (p.down() && !shown->down()) ||
                     (p.down() == shown->down() && p.top().value > shown->top().value));
      if (!better) continue;
      shown = p;
      ours =
          fmt::format("{}, {} at Rm {} N, {} at 60 N ({} N, d = {})", percent_text(p.s.front()),
                      percent_text(p.top()), p.random(), percent_text(p.s.back()), force, damping);
    }
  return {shape.verdict(),
          {{"ours", ours},
           {"up", of(shape.up, shape.series)},
           {"both", shape.both},
           {"both_on_the_grid", on_the_grid.both},
           {"only_down", of(shape.only_down, shape.series)},
           {"contrary", of(shape.contrary, shape.series)},
           {"seen", shape.seen}}};
}

Measured peak_at_20(const Findings& f) {
  std::string where;
  int rising = 0, above = 0, seen = 0;
  double least = 1e9, most = 0;
  for (const double damping : kDampings)
    for (const double force : kForces) {
      const Peak p{over_random(f, damping, force, kPaperRandom)};
      if (!p.up()) continue;
      const Share& at_20 = p.s[2];
      const bool higher = rises(at_20, p.top());
      ++rising;
      above += higher;
      seen += higher && seen_with_100(at_20, p.top());
      least = std::min(least, p.random());
      most = std::max(most, p.random());
      where += (where.empty() ? "" : ", ") + fixed(p.random(), 0);
    }
  const bool enough = f.fig8.points[0].trials >= kEnoughTrials;
  return {verdict_of(enough && (rising == 0 || more_than_chance(seen, rising)),
                     enough && above == 0, enough),
          {{"ours", rising == 0     ? kNowhere
                    : least == most ? fixed(least, 0) + " N"
                                    : fmt::format("{} to {} N", least, most)},
           {"range", when(rising == 0, "0 to 40 N")},
           {"where", when(rising > 0, where)},
           {"above", of(above, rising)},
           {"seen", seen}}};
}

Measured exits_grow(const Findings& f) {
  Trend trend;
  for (const double damping : kDampings)
    for (const double force : kForces)
      trend.add(kPaperRandom, along(kPaperRandom, [&](double random) {
                  const PaperPoint& p = fig8_at(f, damping, force, random);
                  return share_of(p.exited(), p.trials);
                }));
  const auto early = std::count_if(f.exits.runs.begin(), f.exits.runs.end(),
                                   [](const TracedRun& run) { return run.hits == 0; });
  const Share before = share_of(early, std::ssize(f.exits.runs));
  Measured m = measured(trend, {{"before", before}, {"late", when(before.high < 0.5, "8 N")}});
  if (before.low <= 0.5) m.verdict = verdict_of(before.high < 0.5, false);
  return m;
}

// ---- Figs. 9 and 12

/// The point with the equal beams of Fig. 9A.
const PaperPoint& equal_beams(const Findings& f) {
  return f.tried_method.at({{"run.method", "stable"}, {kDamping, 50}});
}

Measured softer_side(const Findings& f) {
  Places cells;
  std::string worst;
  double most = 0.0;
  for (const PaperPoint& cell : f.fig12.points) {
    const Share right = cell.right_share();
    if (cell.number(kLeftStiffness) == 500 || right.whole == 0) continue;
    ++cells.of;
    cells.hold += right.high < 0.5;
    if (right.low <= 0.5) continue;
    ++cells.fail;
    const double successes = static_cast<double>(kPaperTrials) * cell.traversed_share().value,
                 deviation = right.value - 0.5;
    cells.seen += deviation * deviation > 4.0 * 0.25 / std::max(1.0, successes);
    if (right.value <= most || right.whole < 20) continue;
    most = right.value;
    worst = fmt::format(", such as {} right at k_L = {}, {} N, Rm {} N, d = {}",
                        percent_text(right), cell.text(kLeftStiffness), cell.text(kPropulsion),
                        cell.text(kRandom), cell.text(kDamping));
  }
  return {cells.verdict(f.fig12.points[0].trials >= kEnoughTrials),
          {{"ours", cells.of == 0 ? "nobody gets past unequal beams"
                                  : fmt::format("softer side in {} cells, stiffer side in {}",
                                                of(cells.hold, cells.of), cells.fail)},
           {"such_as", worst},
           {"seen", when(cells.fail > 0, cells.seen)}}};
}

Measured accord(const Findings& f) {
  Trend trend;
  std::string shown;
  for (const double damping : kDampings) {
    std::multimap<double, Share> held_back;  // share that does not traverse, by barrier height
    for (const auto& [k, landscape] : f.barriers) {
      const double height = landscape.fine.from_basin.barrier();
      const Share s = fig12_at(f, damping, 7, 10, k).traversed_share();
      held_back.emplace(height, share_of(s.whole - s.part, s.whole));
      if (damping == 10 && (k == 100 || k == 300 || k == 500))
        shown += fmt::format("{}{} at {} J", shown.empty() ? "" : ", ", percent_text(s),
                             fixed(height, 0));
    }
    AxisValues heights;
    std::vector<Share> shares;
    for (const auto& [height, share] : held_back) {
      heights.push_back(height);
      shares.push_back(share);
    }
    trend.add(heights, shares);
  }
  return measured(trend, {{"ours", shown}});
}

Measured thirteen_and_eight(const Findings& f) {
  const PaperPoint& point = equal_beams(f);
  const Share left = point.left_share(),
              right = share_of(point[dynamics::Outcome::traversed_right], point.trials);
  const LandscapeStudy& landscape = f.barriers.at(500);
  Share most;
  std::size_t settings = 0;
  for (const Sweep* study : {&f.tried_method, &f.tried_step, &f.tried_restitution, &f.tried_rate,
                             &f.tried_start, &f.tried_random}) {
    settings += study->points.size();
    for (const PaperPoint& p : study->points)
      if (const Share s = p.traversed_share(); most.whole == 0 || s.value > most.value) most = s;
  }
  constexpr double kPrinted = 0.21;
  std::optional<PaperPoint> enough;
  for (const PaperPoint& p : f.tried_propulsion.points)
    if (!enough && p.traversed_share().value >= kPrinted) enough = p;
  return {std::max(against(13, left), against(8, right)),
          {{"left", left},
           {"right", right},
           {"fine", landscape.fine.above_start()},
           {"coarse", landscape.coarse.above_start()},
           {"basin", landscape.fine.from_basin.barrier()},
           {"settings", settings},
           {"most", most},
           {"force", enough ? enough->text(kPropulsion) : Said()},
           {"damping", enough ? enough->text(kDamping) : Said()}}};
}

Measured alike(const Findings& f) {
  const Share all = equal_beams(f).traversed_share(), right = equal_beams(f).right_share();
  return {rare_and_even(all, right), {{"all", all}, {"right", right}, {"n", right.whole}}};
}

/// Tests that kPrinted % traverse by the left beam, with these beams.
template <int kLeft, int kDampers, int kPrinted>
Measured by_left_beam(const Findings& f) {
  const Share ours = fig12_at(f, kDampers, 7, 10, kLeft).left_share();
  return {against(kPrinted, ours), {{"ours", ours}}};
}

Measured right_share_falls(const Findings& f, const AxisValues& randoms, bool strong) {
  constexpr std::int64_t kLeast = 10;  // with fewer traversals a share says little
  Trend trend;
  for (const double damping : kDampings)
    for (const double force : kForcesOf12)
      for (const double random : randoms) {
        std::vector<Share> told;
        AxisValues where, counted;
        for (const double k : f.fig12.values(kLeftStiffness)) {
          const PaperPoint& cell = fig12_at(f, damping, force, random, k);
          if (cell.right_share().whole < kLeast) continue;
          told.push_back(cell.right_share());
          where.push_back(k);
          counted.push_back(cell.traversed_share().value);
        }
        if (told.size() >= 2) trend.add(where, told, counted);
      }
  return measured(trend,
                  {{"soft", fig12_at(f, 50, 8, randoms[1], 100).right_share()},
                   {"hard", fig12_at(f, 50, 8, randoms[1], 500).right_share()}},
                  strong);
}

Measured fig12_propulsion(const Findings& f) {
  Places cells;
  double softest = 1e9;
  for (const PaperPoint& p : f.fig12.points) {
    if (p.number(kPropulsion) != 7) continue;
    const double k = p.number(kLeftStiffness);
    const Share seven = p.traversed_share(),
                eight = fig12_at(f, p.number(kDamping), 8, p.number(kRandom), k).traversed_share();
    ++cells.of;
    cells.hold += rises(seven, eight);
    if (!falls(seven, eight)) continue;
    ++cells.fail;
    softest = std::min(softest, k);
    cells.seen += seen_with_100(seven, eight);
  }
  return {cells.verdict(f.fig12.points[0].trials >= kEnoughTrials, true),
          {{"hold", of(cells.hold, cells.of)},
           {"fail", cells.fail},
           {"softest", softest},
           {"seen", when(cells.fail > 0, of(cells.seen, cells.fail))}}};
}

const std::vector<const char*> kPrintedDamping{"d as Table I prints it."},
    kSmallerDamping{
        "Sec. III-C says that damping was increased to 50 for the field: a reading "
        "with a smaller one here."},
    kRightShareWhy{
        "Lower at the soft end than at the stiff end beyond chance in {up} settings of "
        "propulsion, random force and damping, higher in {down}.",
        "{falling} steps go the other way, by up to {fall:1} points (from {from}).",
        "Of all falls between two stiffnesses 100 trials a cell would show {seen_of}."};

}  // namespace

std::vector<ClaimRow> claims_on_shares() {
  return {
      {{"rises_with_propulsion", "Abstract, Sec. III-A, Fig. 8", "fig8"},
       "Traversal probability rises monotonically with the propulsive force.",
       {"rises", "{low} at 4 N, {high} at 9 N (Rm 20 N)", rises_with_propulsion},
       {"Up from end to end in {up} series (Rm 10 to 40 N, d = 50 and 10).",
        "Not step by step: {falling} steps of 1 N fall beyond chance, by up to {fall:1} points "
        "(from {from} N).",
        "Of all falls between two forces 100 trials a point would show {seen}."}},
      {{"rises_then_falls", "Abstract, Sec. III-A, Fig. 8", "fig8"},
       "With random force, traversal first rises, then falls.",
       {"rises, then falls", "{ours}", rises_then_falls},
       {"It rises beyond chance at {up} pairs of propulsion and damping and falls again up to 60 N "
        "at {both} of these ({both_on_the_grid} up to the paper's 40 N): the fall is slow. At "
        "{only_down} pairs, where propulsion alone is enough, the random force only hinders. "
        "Another shape than rise and fall: {contrary} pairs; 100 trials a point would show "
        "{seen}."}},
      {{"peak_at_20", "Sec. III-A, Fig. 8", "fig8"},
       "The best random force is 20 N: more of it lowers traversal.",
       {"20 N", "{ours}", peak_at_20},
       {"Of {range} no random force gives more than none beyond chance.",
        "Of 0 to 40 N, highest at {where} N where it rises at all (d = 50, then 10; F_prop from 4 "
        "N up). Higher than at 20 N beyond chance in {above} of these; 100 trials a point would "
        "show {seen}."}},
      {{"exits_grow", "Sec. III-A", "fig8"},
       "More random force makes more trials leave through the sides, before they arrive at the "
       "beams.",
       {"more exits, before the beams", "exits rise; {before} of them before contact", exits_grow},
       {"Exits rise from end to end in {up} series.",
        "But at {late} and Rm 40 N most of those who leave have touched a beam before."}},
      {{"softer_side", "Abstract, Sec. III-B", "fig12"},
       "With unequal beams, traversal is more likely towards the side of the less stiff beam.",
       {"towards the softer side", "{ours}", softer_side},
       {"Beyond chance, of the cells of Table II with unequal beams in which anybody gets through.",
        "The exceptions are nearly equal beams that few get past{such_as}; 100 trials a cell would "
        "show {seen} of them."}},
      {{"accord", "Abstract, Sec. IV", "barriers"},
       "The observations accord with the potential energy landscape: a lower barrier, more "
       "traversal.",
       {"in accord", "{ours}", accord},
       {"Traversal against the height of the lowest way above the basin before it, k_L = 100 to "
        "500, 7 N, Rm 10 N (d = 10 shown; d = 50 as well).",
        "{falling} steps go the other way beyond chance, by {fall:1} points at most.",
        "The height alone does not tell: damping matters as much."}},
      {{"thirteen_and_eight", "Sec. III-B, Fig. 9A", "thirteen_eight"},
       "k_L = k_R = 500, F_prop = 7 N, Rm = 10 N: 13 % traverse left, 8 % right.",
       {"13 % and 8 %", "{left} and {right}", thirteen_and_eight},
       {"The lowest way through lies {fine:1} J above the start ({coarse:1} J on the paper's grid "
        "of 0.5 m), which is at rest, and {basin} J above the basin on the way. {settings} "
        "settings tried (methods, the paper's Euler scheme with its drifting constraint among "
        "them; steps, dampings, restitutions, rates of the random force, starting speeds, random "
        "forces) give at most {most} together.",
        "It takes {force} N (d = {damping}) instead of 7 N."}},
      {{"alike", "Sec. III-B, Fig. 9A", "fig9"},
       "With equal beams, traversal is rare and similarly probable on both sides.",
       {"similar", "{all} traverse, {right} of these on the right", alike},
       {"Of {n} that traverse. Similar is what the paper's 13 and 8 of 100 do not tell from equal: "
        "28 to 72 % on the right."}},
      {{"fifty_two_50", "Sec. III-B, Fig. 9B", "fig9"},
       "k_L = 300, k_R = 500, F_prop = 7 N, Rm = 10 N: 52 % traverse by the left beam (d = 50).",
       {"52 %", "{ours}", by_left_beam<300, 50, 52>},
       kPrintedDamping},
      {{"fifty_two_10", "Sec. III-B, Fig. 9B", "fig9"},
       "k_L = 300, k_R = 500, F_prop = 7 N, Rm = 10 N: 52 % traverse by the left beam (d = 10).",
       {"52 %", "{ours}", by_left_beam<300, 10, 52>},
       kSmallerDamping},
      {{"ninety_eight_50", "Sec. III-B, Fig. 9C", "fig9"},
       "k_L = 100, k_R = 500, F_prop = 7 N, Rm = 10 N: 98 % traverse by the left beam (d = 50).",
       {"98 %", "{ours}", by_left_beam<100, 50, 98>},
       kPrintedDamping},
      {{"ninety_eight_10", "Sec. III-B, Fig. 9C", "fig9"},
       "k_L = 100, k_R = 500, F_prop = 7 N, Rm = 10 N: 98 % traverse by the left beam (d = 10).",
       {"98 %", "{ours}", by_left_beam<100, 10, 98>},
       kSmallerDamping},
      {{"right_share_weak", "Sec. III-B, Fig. 12", "fig12"},
       "Rm < 40 N: the softer the left beam, the fewer traversals on the right.",
       {"falls", "{soft} at k_L = 100, {hard} at 500 (8 N, Rm 20 N, d = 50)",
        [](const Findings& f) {
          return right_share_falls(f, {10, 20, 30}, false);
        }},
       kRightShareWhy},
      {{"right_share_strong", "Sec. III-B, Fig. 12", "fig12"},
       "Rm >= 40 N: the trend is still there, less monotonic.",
       {"the same, less monotonic", "{soft} at k_L = 100, {hard} at 500 (8 N, Rm 50 N, d = 50)",
        [](const Findings& f) {
          return right_share_falls(f, {40, 50, 60}, true);
        }},
       kRightShareWhy},
      {{"fig12_propulsion", "Sec. III-B, Fig. 12", "fig12"},
       "Unequal beams: traversal rises with the propulsive force.",
       {"rises from 7 to 8 N", "higher in {hold} cells, lower in {fail}", fig12_propulsion},
       {"Cells in which 8 N differ from 7 N beyond chance, d = 50 and 10.",
        "Lower only from k_L = {softest} on; 100 trials a cell would show {seen}."}}};
}

}  // namespace gatewalk::cli
