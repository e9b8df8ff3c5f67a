#include <algorithm>
#include <cmath>

#include "cli/paper/studies.h"
#include "cli/render/report.h"
#include "dynamics/landscape.h"

namespace gatewalk::cli {
namespace {

struct Claim {
  const char* id;
  const char* where;
  std::string claim, paper, ours;
  std::string verdict;
  std::string why;
  const char* see;
};

std::string number(double x, int digits = 0) { return fixed(x, digits); }
std::string of(std::int64_t part, std::int64_t whole) {
  return std::to_string(part) + " of " + std::to_string(whole);
}

const std::vector<double> kForces{4, 5, 6, 7, 8, 9}, kPaperRandom{0, 10, 20, 30, 40};
constexpr double kWidestRandom = 60;

Share fig8_at(const Findings& f, double damping, double force, double random) {
  return traversed_at(f["fig8"], {{kDamping, damping}, {kPropulsion, force}, {kRandom, random}});
}
At fig12_cell(double damping, double force, double random, double k_left) {
  return {{kDamping, damping}, {kPropulsion, force}, {kRandom, random}, {kLeftStiffness, k_left}};
}
std::vector<double> stiffnesses() {
  std::vector<double> k;
  for (double x = 100; x <= 500; x += 50) k.push_back(x);
  return k;
}

// ---- Fig. 8

Claim rises_with_propulsion(const Findings& f) {
  Trend trend;
  for (const double damping : {50.0, 10.0})
    for (const double random : {10.0, 20.0, 30.0, 40.0}) {
      std::vector<Share> s;
      for (const double force : kForces) s.push_back(fig8_at(f, damping, force, random));
      trend.add(kForces, s);
    }
  std::string why = "Up from end to end in " + of(trend.up, trend.series) +
                    " series (Rm 10 to 40 N, d = 50 and 10).";
  if (trend.falling > 0)
    why += " Not step by step: " + of(trend.falling, trend.steps) +
           " steps of 1 N fall beyond chance, by up to " + number(100 * trend.largest_fall, 1) +
           " points (from " + number(trend.at) + " N); 100 trials a point would show " +
           std::to_string(trend.seen) + " of these.";
  return {"rises_with_propulsion",
          "Abstract, Sec. III-A, Fig. 8",
          "Traversal probability rises monotonically with the propulsive force.",
          "rises",
          percent_text(fig8_at(f, 50, 4, 20)) + " at 4 N, " + percent_text(fig8_at(f, 50, 9, 20)) +
              " at 9 N (Rm 20 N)",
          trend.verdict(),
          why,
          "fig8"};
}

/// Where traversal is highest over the random force, up to `most`.
struct Peak {
  Share first, top, last;
  double at = 0.0;
  bool above_20 = false,
       seen_above_20 = false;  // higher than at 20 N beyond chance; the paper would see that
  [[nodiscard]] bool up() const { return rises(first, top); }
  [[nodiscard]] bool down() const { return falls(top, last); }
};
Peak peak_of(const Findings& f, double damping, double force, double most) {
  Peak p;
  p.first = fig8_at(f, damping, force, 0);
  p.last = fig8_at(f, damping, force, most);
  const Share twenty = fig8_at(f, damping, force, 20);
  for (double random = 0; random <= most; random += 10) {
    const Share s = fig8_at(f, damping, force, random);
    if (random > 0 && s.value <= p.top.value) continue;
    p.top = s;
    p.at = random;
  }
  p.above_20 = rises(twenty, p.top);
  p.seen_above_20 = p.above_20 && seen_with_100(twenty, p.top);
  return p;
}

Claim rises_then_falls(const Findings& f) {
  int up = 0, both = 0, on_the_grid = 0, only_down = 0, series = 0;
  Peak shown;
  double shown_force = 0, shown_damping = 0;
  for (const double damping : {50.0, 10.0})
    for (const double force : kForces) {
      const Peak p = peak_of(f, damping, force, kWidestRandom),
                 narrow = peak_of(f, damping, force, 40);
      ++series;
      up += p.up();
      both += p.up() && p.down();
      on_the_grid += narrow.up() && narrow.down();
      only_down += !p.up() && p.down();
      const bool better = p.up() && (shown_force == 0 || (p.down() && !shown.down()) ||
                                     (p.down() == shown.down() && p.top.value > shown.top.value));
      if (!better) continue;
      shown = p;
      shown_force = force;
      shown_damping = damping;
    }
  return {"rises_then_falls",
          "Abstract, Sec. III-A, Fig. 8",
          "With random force, traversal first rises, then falls.",
          "rises, then falls",
          shown_force == 0
              ? "rises nowhere beyond chance"
              : percent_text(shown.first) + ", " + percent_text(shown.top) + " at Rm " +
                    number(shown.at) + " N, " + percent_text(shown.last) + " at 60 N (" +
                    number(shown_force) + " N, d = " + number(shown_damping) + ")",
          2 * both > up && up > 0                       ? kReproduced
          : both > 0 || shown.top.whole < kEnoughTrials ? kWithinNoise
                                                        : kDiffers,
          "It rises beyond chance at " + of(up, series) +
              " pairs of propulsion and damping and falls again up to 60 N at " +
              std::to_string(both) + " of these (" + std::to_string(on_the_grid) +
              " up to the paper's 40 N): the fall is slow. At " + of(only_down, series) +
              " pairs, where propulsion alone is enough, the random force only hinders.",
          "fig8"};
}

Claim peak_at_20(const Findings& f) {
  std::string where;
  int rising = 0, above = 0, seen = 0;
  double least = 1e9, most = 0;
  std::int64_t trials = 0;
  for (const double damping : {50.0, 10.0})
    for (const double force : kForces) {
      const Peak p = peak_of(f, damping, force, 40);
      trials = p.top.whole;
      if (!p.up()) continue;
      ++rising;
      above += p.above_20;
      seen += p.seen_above_20;
      least = std::min(least, p.at);
      most = std::max(most, p.at);
      where += (where.empty() ? "" : ", ") + number(p.at);
    }
  return {"peak_at_20",
          "Sec. III-A, Fig. 8",
          "The best random force is 20 N: more of it lowers traversal.",
          "20 N",
          rising == 0     ? "rises nowhere beyond chance"
          : least == most ? number(least) + " N"
                          : number(least) + " to " + number(most) + " N",
          trials >= kEnoughTrials && more_than_chance(seen, rising) ? kDiffers
          : above == 0 && rising > 0 && trials >= kEnoughTrials     ? kReproduced
                                                                    : kWithinNoise,
          "Of 0 to 40 N, highest at " + where +
              " N where it rises at all (d = 50, then 10; F_prop from 4 N up). Higher than at 20 N "
              "beyond chance in " +
              of(above, rising) + " of these; 100 trials a point would show " +
              std::to_string(seen) + ".",
          "fig8"};
}

Claim exits_grow(const Findings& f) {
  Trend trend;
  for (const double damping : {50.0, 10.0})
    for (const double force : kForces) {
      std::vector<Share> s;
      for (const double random : kPaperRandom) {
        const Json& p =
            point_at(f["fig8"], {{kDamping, damping}, {kPropulsion, force}, {kRandom, random}});
        s.push_back(share_of(
            p.at("exited_left").get<std::int64_t>() + p.at("exited_right").get<std::int64_t>(),
            p.at("trials")));
      }
      trend.add(kPaperRandom, s);
    }
  std::int64_t early = 0;
  const Json& runs = f["exits"].at("runs");
  for (const Json& run : runs) early += run.at("hits") == 0;
  const Share before = share_of(early, static_cast<std::int64_t>(runs.size()));
  return {"exits_grow",
          "Sec. III-A",
          "More random force makes more trials leave through the sides, before they arrive at the "
          "beams.",
          "more exits, before the beams",
          "exits rise; " + percent_text(before) + " of them before contact",
          before.high < 0.5  ? kDiffers
          : before.low > 0.5 ? trend.verdict()
                             : kWithinNoise,
          "Exits rise from end to end in " + of(trend.up, trend.series) + " series." +
              (before.high < 0.5
                   ? " But at 8 N and Rm 40 N most of those who leave have touched a beam before."
                   : ""),
          "fig8"};
}

Claim escape(const Findings& f) {
  const Share still = fig8_at(f, 50, 8, 0), shaken = fig8_at(f, 50, 8, 40);
  const Json& p = point_at(f["fig8"], {{kDamping, 50}, {kPropulsion, 8}, {kRandom, 0}});
  return {
      "escape",
      "Sec. II-C",
      "With too little propulsion the body is trapped in the basin; the random force helps it out.",
      "trapped; helped out",
      number(100 * still.value) + " % traverse without, " + percent_text(shaken) + " with Rm 40 N",
      rises(still, shaken)   ? kReproduced
      : falls(still, shaken) ? kDiffers
                             : kWithinNoise,
      "8 N, d = 50. Without random force all runs are the same one: " +
          number(100 * p.at("trapped").get<double>() / p.at("trials").get<double>()) +
          " % are trapped.",
      "fig8"};
}

// ---- Figs. 9 and 12

Claim softer_side(const Findings& f) {
  int softer = 0, stiffer = 0, seen = 0, cells = 0;
  std::string worst;
  double most = 0.0;
  for (const double damping : {50.0, 10.0})
    for (const double force : {7.0, 8.0})
      for (double random = 10; random <= 60; random += 10)
        for (const double k : stiffnesses()) {
          if (k == 500) continue;
          const At at = fig12_cell(damping, force, random, k);
          const Share right = right_at(f["fig12"], at);
          if (right.whole == 0) continue;
          ++cells;
          softer += right.high < 0.5;
          if (right.low <= 0.5) continue;
          ++stiffer;
          const double successes =
              static_cast<double>(kPaperTrials) * traversed_at(f["fig12"], at).value;
          seen += (right.value - 0.5) * (right.value - 0.5) > 4.0 * 0.25 / std::max(1.0, successes);
          if (right.value <= most || right.whole < 20) continue;
          most = right.value;
          worst = percent_text(right) + " right at k_L = " + number(k) + ", " + number(force) +
                  " N, Rm " + number(random) + " N, d = " + number(damping);
        }
  const bool enough = f["fig12"].at("points")[0].at("trials").get<std::int64_t>() >= kEnoughTrials;
  std::string why =
      "Beyond chance, of the cells of Table II with unequal beams in which anybody gets through.";
  if (stiffer > 0)
    why += " The exceptions are nearly equal beams that few get past" +
           (worst.empty() ? "" : ", such as " + worst) + "; 100 trials a cell would show " +
           std::to_string(seen) + " of them.";
  return {
      "softer_side",
      "Abstract, Sec. III-B",
      "With unequal beams, traversal is more likely towards the side of the less stiff beam.",
      "towards the softer side",
      "softer side in " + of(softer, cells) + " cells, stiffer side in " + std::to_string(stiffer),
      (enough && more_than_chance(seen, cells)) || stiffer > softer       ? kDiffers
      : !enough || more_than_chance(stiffer, cells) || 2 * softer < cells ? kWithinNoise
                                                                          : kReproduced,
      why,
      "fig12"};
}

Claim thirteen_and_eight(const Findings& f) {
  const Json& point = point_at(f["tried_method"], {{"run.method", "stable"}, {kDamping, 50}});
  const Share left = share_of(point.at("traversed_left"), point.at("trials")),
              right = share_of(point.at("traversed_right"), point.at("trials"));
  const Json& passes = f["barrier_500"].at("passes");
  constexpr double kPrinted = 0.21;
  Share most;
  int settings = 0;
  for (const char* study : {"tried_method", "tried_step", "tried_restitution", "tried_rate",
                            "tried_start", "tried_random"})
    for (const Json& p : f[study].at("points")) {
      const Share s = share_of(p.at("traversed"), p.at("trials"));
      ++settings;
      if (most.whole == 0 || s.value > most.value) most = s;
    }
  std::string enough;
  for (const Json& p : f["tried_propulsion"].at("points")) {
    const Share s = share_of(p.at("traversed"), p.at("trials"));
    if (s.value < kPrinted || !enough.empty()) continue;
    enough = " It takes " + p.at("at").at(kPropulsion).dump() +
             " N (d = " + p.at("at").at(kDamping).dump() + ") instead of 7 N.";
  }
  const auto worse = [](const std::string& a, const std::string& b) {
    return a == kDiffers || b == kDiffers           ? kDiffers
           : a == kWithinNoise || b == kWithinNoise ? kWithinNoise
                                                    : kReproduced;
  };
  return {
      "thirteen_and_eight",
      "Sec. III-B, Fig. 9A",
      "k_L = k_R = 500, F_prop = 7 N, Rm = 10 N: 13 % traverse left, 8 % right.",
      "13 % and 8 %",
      percent_text(left) + " and " + percent_text(right),
      worse(against(13, left), against(8, right)),
      "The lowest way through lies " + number(passes.back().at("above_start_J").get<double>(), 1) +
          " J above the start (" + number(passes.front().at("above_start_J").get<double>(), 1) +
          " J on the paper's grid of 0.5 m), which is at rest, and " +
          number(passes.back().at("from_basin").at("barrier_J").get<double>()) +
          " J above the basin on the way. " + std::to_string(settings) +
          " settings tried (methods, the paper's Euler scheme with its drifting constraint among "
          "them; steps, dampings, restitutions, rates of the random force, starting speeds, "
          "random forces) give at most " +
          percent_text(most) + " together." + enough,
      "thirteen_eight"};
}

Claim alike(const Findings& f) {
  const Json& point = point_at(f["tried_method"], {{"run.method", "stable"}, {kDamping, 50}});
  const Share right =
      share_of(point.at("traversed_right"), point.at("traversed_left").get<std::int64_t>() +
                                                point.at("traversed_right").get<std::int64_t>());
  return {"alike",
          "Sec. III-B, Fig. 9A",
          "With equal beams, traversal is rare and similarly probable on both sides.",
          "similar",
          percent_text(right) + " of the traversals on the right",
          right.low > 0.5 || right.high < 0.5 ? kDiffers
          : right.whole >= 20                 ? kReproduced
                                              : kWithinNoise,
          "Of " + std::to_string(right.whole) + " that traverse.",
          "fig9"};
}

Claim percentage(const Findings& f, const char* id, const char* where, double k_left,
                 double damping, std::int64_t printed) {
  const Json& p = point_at(f["fig12"], fig12_cell(damping, 7, 10, k_left));
  const Share ours = share_of(p.at("traversed_left"), p.at("trials"));
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
        for (const double k : stiffnesses()) {
          const At at = fig12_cell(damping, force, random, k);
          const Share s = right_at(f["fig12"], at);
          if (s.whole < 10)
            continue;  // where hardly anybody gets through there is no share to speak of
          told.push_back(s);
          where.push_back(k);
          counted.push_back(traversed_at(f["fig12"], at).value);
        }
        if (told.size() >= 2) trend.add(where, told, counted);
      }
  const double random = strong ? 50 : 20;
  const Share soft = right_at(f["fig12"], fig12_cell(50, 8, random, 100)),
              hard = right_at(f["fig12"], fig12_cell(50, 8, random, 500));
  std::string why = "Lower at the soft end than at the stiff end beyond chance in " +
                    of(trend.up, trend.series) +
                    " settings of propulsion, random force and damping, higher in " +
                    std::to_string(trend.down) + ".";
  if (trend.falling > 0)
    why += " " + of(trend.falling, trend.steps) + " steps of 50 go the other way, by up to " +
           number(100 * trend.largest_fall, 1) + " points (from " + number(trend.at) +
           "): at 7 N the share on the right is highest between 350 and 450. 100 trials a cell "
           "would show " +
           std::to_string(trend.seen) + " of these steps.";
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
  int up = 0, down = 0, seen = 0, cells = 0;
  double softest = 1e9;
  std::int64_t trials = 0;
  for (const double damping : {50.0, 10.0})
    for (const double k : stiffnesses())
      for (double random = 10; random <= 60; random += 10) {
        const Share seven = traversed_at(f["fig12"], fig12_cell(damping, 7, random, k)),
                    eight = traversed_at(f["fig12"], fig12_cell(damping, 8, random, k));
        ++cells;
        trials = seven.whole;
        up += rises(seven, eight);
        if (!falls(seven, eight)) continue;
        ++down;
        softest = std::min(softest, k);
        seen += seen_with_100(seven, eight);
      }
  std::string why = "Cells in which 8 N differ from 7 N beyond chance, d = 50 and 10.";
  if (down > 0)
    why += " Lower only from k_L = " + number(softest) + " on; 100 trials a cell would show " +
           of(seen, down) + ".";
  return {"fig12_propulsion",
          "Sec. III-B, Fig. 12",
          "Unequal beams: traversal rises with the propulsive force.",
          "rises from 7 to 8 N",
          "higher in " + of(up, cells) + " cells, lower in " + std::to_string(down),
          (trials >= kEnoughTrials && more_than_chance(seen, cells)) || down > up ? kDiffers
          : down == 0 && 2 * up > cells && trials >= kEnoughTrials                ? kReproduced
                                                                                  : kWithinNoise,
          why,
          "fig12"};
}

// ---- Landscape

Claim accord(const Findings& f) {
  Trend trend;
  std::string shown;
  for (const double damping : {50.0, 10.0}) {
    std::vector<std::pair<double, Share>> points;  // height, share that does not traverse
    for (const double k : stiffnesses()) {
      const auto found = f.data.find("barrier_" + number(k));
      if (found == f.data.end()) continue;
      const Json& pass = found->second.at("passes").back().at("from_basin");
      const double height = pass.at("way_m").size() == 1 ? 0.0 : pass.at("barrier_J").get<double>();
      const Share s = traversed_at(f["fig12"], fig12_cell(damping, 7, 10, k));
      points.emplace_back(height, share_of(s.whole - s.part, s.whole));
      if (damping == 10 && (k == 100 || k == 300 || k == 500))
        shown += (shown.empty() ? "" : ", ") + percent_text(s) + " at " + number(height) + " J";
    }
    std::stable_sort(points.begin(), points.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<double> axis;
    std::vector<Share> held_back;
    for (const auto& [height, share] : points) {
      axis.push_back(height);
      held_back.push_back(share);
    }
    trend.add(axis, held_back);
  }
  return {"accord",
          "Abstract, Sec. IV",
          "The observations accord with the potential energy landscape: a lower barrier, more "
          "traversal.",
          "in accord",
          shown,
          trend.verdict(),
          "Traversal against the height of the lowest way above the basin before it, k_L = 100 to "
          "500, 7 N, Rm 10 N (d = 10 shown; d = 50 as well). " +
              (trend.falling > 0
                   ? of(trend.falling, trend.steps) + " steps go the other way beyond chance, by " +
                         number(100 * trend.largest_fall, 1) + " points at most. "
                   : std::string()) +
              "The height alone does not tell: damping matters as much.",
          "barriers"};
}

Claim landscape_sides(const Findings&) {
  dynamics::GateParams p;
  p.beams.stiffness_left = 500;
  p.beams.stiffness_right = 250;
  double left = 0, right = 0;
  for (double y = 20; y <= 60; y += 0.5) {
    left = std::max(left, dynamics::beam_energy(p, -5, y));
    right = std::max(right, dynamics::beam_energy(p, 5, y));
  }
  return {"landscape_sides",
          "Sec. II-C, Fig. 5",
          "Two barriers that overlap in the middle; with unequal beams the softer side's is lower.",
          "lower on the softer side",
          number(left) + " J on the left, " + number(right) + " J on the right",
          right < left ? kReproduced : kDiffers,
          "k_L = 500, k_R = 250: the highest elastic energy on the way 5 m left and right of the "
          "middle.",
          "fig5"};
}

Claim basin(const Findings& f) {
  const auto basin =
      f["fig5_symmetric"].at("passes").back().at("basin_m").get<std::vector<double>>();
  const dynamics::GateParams p;
  return {"basin",
          "Sec. II-C, Fig. 5D",
          "With a modest propulsion a basin lies in front of the beams, around y = 20 m.",
          "around 20 m",
          "its floor is at y = " + number(basin[1], 1) + " m",
          basin[1] > 20 && basin[1] < p.beams.joint_y ? kReproduced : kDiffers,
          "F_prop = 7 N, k = 400. The disc touches the beams from y = 20 m on and has not passed "
          "their line, y = 30 m, there.",
          "fig5"};
}

Claim steep(const Findings& f) {
  const Json& s = f["steep"];
  const bool downhill = s.at("passes").back().at("from_basin").at("way_m").size() == 1;
  const Share share = share_of(s.at("measured").at("traversed"), s.at("measured").at("trials"));
  return {"steep",
          "Sec. II-C",
          "With enough propulsion the basin disappears and the body always traverses.",
          "always",
          std::string(downhill ? "no basin, " : "a basin, ") + percent_text(share) + " at 20 N",
          !downhill || share.high < 0.99                              ? kDiffers
          : share.part == share.whole && share.whole >= kEnoughTrials ? kReproduced
                                                                      : kWithinNoise,
          "k = 400, Rm 10 N, d = 50. At 9 N, without random force, " +
              number(100 * fig8_at(f, 50, 9, 0).value) + " % do already.",
          "fig5"};
}

Claim above_landscape(const Findings& f) {
  std::int64_t looked = 0, below = 0, explained = 0, shown = 0, shown_below = 0;
  for (const char* study : {"fig9_300", "fig6"})
    for (const Json& run : f[study].at("runs"))
      for (std::size_t i = 0; i < run.at("t").size(); ++i) {
        const Json &land = run.at("landscape_J")[i], &left = run.at("landscape_left_J")[i],
                   &right = run.at("landscape_right_J")[i];
        if (!land.is_number() || (left == 0.0 && right == 0.0)) continue;
        ++looked;
        const double potential = run.at("potential_J")[i], height = land;
        const bool is_below = potential < height - 0.5;
        below += is_below;
        if (study == std::string("fig9_300")) {
          ++shown;
          shown_below += is_below;
        }
        if (!is_below) continue;
        // Without the beam that is least deflected, measured by what the landscape assumes of it.
        const double missing_left = left.get<double>() - run.at("elastic_left_J")[i].get<double>(),
                     missing_right =
                         right.get<double>() - run.at("elastic_right_J")[i].get<double>();
        explained +=
            potential > height - (missing_left > missing_right ? left : right).get<double>() - 0.5;
      }
  const Share above = share_of(looked - below, looked), artifact = share_of(explained, below);
  return {"above_landscape",
          "Sec. II-C, Fig. 6",
          "The system's potential energy is typically above the landscape; where it is below, a "
          "beam has let go of the body.",
          "typically above",
          "above for " + number(100 * above.value) + " % of the time",
          above.value > 0.5 && artifact.value > 0.95 ? kReproduced : kDiffers,
          "Traversals with k_L = 300 (" +
              number(100 * (1 - static_cast<double>(shown_below) / static_cast<double>(shown))) +
              " %) and of Fig. 6, moments within the beams' reach, above or less than 0.5 J below. "
              "Of the others " +
              number(100 * artifact.value) +
              " % are above the landscape without the beam that is less deflected than it assumes.",
          "fig6"};
}

// ---- Secs. II-A, II-B

Claim many_hits(const Findings& f) {
  double hits = 0;
  const Json& runs = f["fig9_300"].at("runs");
  for (const Json& run : runs) hits += run.at("hits").get<double>();
  const double mean = hits / static_cast<double>(runs.size());
  return {"many_hits",
          "Sec. II-A",
          "With CoR = 0.8 traversal still occurs after a large number of collisions.",
          "a large number",
          number(mean) + " hits on average",
          mean >= 10 ? kReproduced : kDiffers,
          "In " + std::to_string(runs.size()) +
              " traversals with k_L = 300, k_R = 500, d = 10; ten would count as many.",
          "fig9"};
}

Claim inertia() {
  const double i = dynamics::Beams{}.inertia();
  return {"inertia",
          "Sec. II-A",
          "A beam's moment of inertia about its joint is 20.83 kg m^2.",
          "20.83 kg m^2",
          number(i, 2) + " kg m^2",
          std::abs(i - 20.83) < 0.005 ? kReproduced : kDiffers,
          "m L^2 / 3, a uniform rod.",
          "fig5"};
}

Claim euler_step(const Findings& f) {
  const auto left = [&](const char* method) {
    const Json& p = point_at(f["paper_method"], {{"run.method", method}, {kDamping, 10}});
    return share_of(p.at("traversed_left"), p.at("trials"));
  };
  const Share paper = left("paper"), event = left("event");
  const bool apart = rises(paper, event) || falls(paper, event), seen = seen_with_100(paper, event);
  const Json& health =
      point_at(f["paper_method"], {{"run.method", "paper"}, {kDamping, 10}}).at("status");
  return {"euler_step",
          "Sec. II-B",
          "Euler's method with a step of 0.004 s is accurate enough.",
          "good accuracy",
          percent_text(paper) + " traverse left; reference " + percent_text(event),
          apart && seen                                 ? kDiffers
          : !apart && paper.whole >= 10 * kEnoughTrials ? kReproduced
                                                        : kWithinNoise,
          "k_L = 300, d = 10, against the event-driven reference. Its constraints act on "
          "accelerations and drift: bodies sink into beams by up to " +
              number(health.at("worst_penetration_m").get<double>(), 1) + " m." +
              (seen ? "" : " 100 trials do not show what that changes in the outcomes."),
          "thirteen_eight"};
}

Claim run_time(const Findings& f) {
  const double seconds = seconds_per(f["field_paper_method"], "dynamics", "trials");
  return {"run_time",
          "Sec. II-B",
          "A trial takes 5 to 20 minutes on a lab workstation.",
          "5 to 20 min",
          number(1e3 * seconds, 2) + " ms",
          seconds >= 300 && seconds <= 1200 ? kReproduced : kDiffers,
          "A whole trial through the field by the same Euler scheme, several gates long. Compiled "
          "code; the paper used MATLAB.",
          "speed"};
}

// ---- Sec. III-C

Claim table4_row(const Findings& f, std::size_t i, const char* id) {
  const Json &start = f["field"].at("starts")[i], &a = start.at("at_100_trials"),
             &paper = start.at("paper");
  struct Reading {
    double corrcoef, corrcoef_sd, rmse, rmse_sd, zc, zr;
    [[nodiscard]] bool fits() const { return std::abs(zc) <= 2 && std::abs(zr) <= 2; }
    [[nodiscard]] std::string text() const {
      return number(corrcoef, 3) + " (" + number(corrcoef_sd, 3) + ") / " + number(rmse, 2) + " (" +
             number(rmse_sd, 2) + ")";
    }
  };
  const auto reading = [&](const std::string& name) {
    const auto get = [&](const std::string& what, const char* which) {
      return a.at(name + what).at(which).template get<double>();
    };
    Reading r{get("_corrcoef", "mean"),
              get("_corrcoef", "sd"),
              get("_rmse_per_100", "mean"),
              get("_rmse_per_100", "sd"),
              0,
              0};
    r.zc = (paper.at("corrcoef").get<double>() - r.corrcoef) / r.corrcoef_sd;
    r.zr = (paper.at("rmse_per_100").get<double>() - r.rmse) / r.rmse_sd;
    return r;
  };
  const Reading exact = reading("exact"), walks = reading("walks");
  const bool enough = a.at("repeats").get<int>() >= 50;
  const auto floor = [&](const char* key, int digits) {
    return number(a.at(key).get<double>(), digits);
  };
  std::string why =
      "Mean (sd) of 100 trials against the exact chain; by chance alone a perfect chain gives " +
      floor("exact_corrcoef_floor", 3) + " / " + floor("exact_rmse_per_100_floor", 2) +
      ". Against 100 walks, as the paper's text says: " + walks.text() + ", chance " +
      floor("walks_corrcoef_floor", 3) + " / " + floor("walks_rmse_per_100_floor", 2) + ".";
  if (exact.fits() != walks.fits())
    why +=
        exact.fits()
            ? " The printed pair fits only the first: it is better than two samples of 100 can be."
            : " The printed pair fits only the second.";
  if (!exact.fits() && !walks.fits())
    why += " The printed pair is " + number(std::abs(exact.zc), 1) + " and " +
           number(std::abs(exact.zr), 1) + " standard deviations from the first.";
  // A start on an edge of its bin is a start at random in one of two bins.
  const auto bins = dynamics::StateSpace::paper({}).bins()[0];
  const auto on_edge = [&](const std::vector<double>& edges, const char* key) {
    return std::find(edges.begin(), edges.end(), start.at("start").at(key).get<double>()) !=
           edges.end();
  };
  if (on_edge(bins.d, "d_m") || on_edge(bins.vx, "vx_m_per_s") || on_edge(bins.vy, "vy_m_per_s"))
    why += " This start lies on an edge of its bin.";
  return {id,
          "Sec. III-C, Table IV",
          "Chain and dynamics, " + start_label(start) + ".",
          number(paper.at("corrcoef").get<double>(), 3) + " / " +
              number(paper.at("rmse_per_100").get<double>(), 3),
          exact.text(),
          !exact.fits() && !walks.fits()           ? kDiffers
          : exact.fits() && walks.fits() && enough ? kReproduced
                                                   : kWithinNoise,
          why,
          "table4"};
}

Claim accuracy(const Findings& f) {
  double least = 1e9, most = 0;
  int within = 0, visible = 0, starts = 0;
  for (const Json& s : f["field"].at("starts")) {
    const Json &all = s.at("exact"), &matrix = all.at("total_variation_of_matrix_sampling"),
               &a = s.at("at_100_trials");
    const double rmse = all.at("rmse_per_100"), chance = all.at("total_variation_floor_95");
    const double sampling = matrix.at("mean").get<double>() + 2 * matrix.at("sd").get<double>();
    least = std::min(least, rmse);
    most = std::max(most, rmse);
    ++starts;
    within += all.at("total_variation").get<double>() <= std::hypot(chance, sampling);
    visible += a.at("exact_rmse_per_100").at("mean").get<double>() -
                   a.at("exact_rmse_per_100_floor").get<double>() >
               2 * a.at("exact_rmse_per_100").at("sd").get<double>();
  }
  return {
      "accuracy",
      "Abstract, Sec. III-C",
      "The chain predicts the final gates with high accuracy; the error is around 1 of 100 trials.",
      "RMSE about 1",
      "RMSE " + number(least, 2) + " to " + number(most, 2),
      within == starts ? kReproduced
      : visible > 0    ? kDiffers
                       : kWithinNoise,
      "All " + f["field"].at("trials").dump() + " trials a start, trials per 100. At " +
          of(within, starts) +
          " starts the difference is no more than chance in trials and matrix makes; at " +
          std::to_string(visible) +
          " it would show in 100 trials. With 100 trials a perfect chain would have an RMSE of "
          "about 1 as well.",
      "fig11"};
}

Claim speed(const Findings& f) {
  const double dynamics = seconds_per(f["field"], "dynamics", "trials"),
               walk = seconds_per(f["field"], "walks", "walks"),
               euler = seconds_per(f["field_paper_method"], "dynamics", "trials"),
               ratio = dynamics / walk;
  return {
      "speed",
      "Abstract, Sec. III-C",
      "The chain saves computing time by a factor of 10^5: 10 s instead of 100 h for 100 trials.",
      "10^5",
      number(ratio),
      ratio >= 36000 ? kReproduced : kDiffers,
      "A trial against a walk. The paper's own times make 36 000. Here 100 trials take " +
          number(1e3 * 100 * dynamics, 1) + " ms (" + number(1e3 * 100 * euler, 1) +
          " ms by the paper's Euler scheme) instead of 100 h, 100 walks " +
          number(1e6 * 100 * walk, 1) + " us instead of 10 s: the dynamics has become " +
          number(std::log10(360000.0 / (100 * dynamics)), 1) + " powers of ten faster, the walks " +
          number(std::log10(10.0 / (100 * walk)), 1) + ".",
      "speed"};
}

std::string shares_at(const Findings& f, const char* key) {
  std::string text;
  for (const char* random : {"10", "20", "40"})
    text +=
        (text.empty() ? "" : ", ") +
        number(100 * f[std::string("field_random_") + random].at("crossings").at(key).get<double>(),
               1);
  return text + " % at Rm 10, 20, 40 N";
}

Claim side_entries(const Findings& f) {
  const double ours = f["field"].at("crossings").at("RT_and_LT_share");
  return {"side_entries",
          "Sec. III-C",
          "Fewer than 4 % of the inputs come through RT or LT.",
          "< 4 %",
          number(100 * ours, 1) + " %",
          ours < 0.04 ? kReproduced : kDiffers,
          "At 7 N, Rm 50 N; " + shares_at(f, "RT_and_LT_share") +
              ". The paper does not print the field's forces; no pair for which Table IV fits "
              "gives so few (results/field_scan).",
          "crossings"};
}

Claim side_entries_free() {
  const dynamics::GateParams p = gate_of("scenes/field.toml");
  std::int64_t entries = 0, touching = 0;
  for (std::int64_t trial = 0; trial < 200; ++trial) {
    const auto trace = lattice::trace_field(p, {}, {0, 0, 0, 15}, 1, trial);
    for (std::size_t i = 1; i < trace.visits.size(); ++i) {
      const auto &from = trace.visits[i - 1], &to = trace.visits[i];
      if (to.row != from.row || to.trace.samples.front().state.body.y <= p.beams.joint_y) continue;
      ++entries;
      const auto& samples = to.trace.samples;
      touching += std::any_of(samples.begin(), samples.end(), [](const dynamics::TraceSample& s) {
        return s.contact[0] != dynamics::ContactMode::free ||
               s.contact[1] != dynamics::ContactMode::free;
      });
    }
  }
  const Share share = share_of(touching, entries);
  return {"side_entries_free",
          "Sec. III-C",
          "Bodies that come through RT or LT are not involved with the beams of that gate.",
          "none",
          percent_text(share) + " touch a beam",
          share.low > 0.05    ? kDiffers
          : share.high < 0.05 ? kReproduced
                              : kWithinNoise,
          of(touching, entries) +
              " such visits in 200 trials of scenes/field.toml (gatewalk trace --field). One state "
              "each for RT and LT is enough.",
          "crossings"};
}

Claim velocities(const Findings& f) {
  const double ours = f["field"].at("crossings").at("clamped_share");
  return {"velocities",
          "Sec. III-C, Table III",
          "With damping and drag the velocity stays in the range of Table III.",
          "in the tested range",
          number(100 * ours, 1) + " % of the crossings outside",
          ours < 0.05 ? kReproduced : kDiffers,
          "Outside Table III's bins, by velocity or place, at 7 N, Rm 50 N; " +
              shares_at(f, "clamped_share") +
              ". They are put into the nearest bin, and counted; one in twenty would pass here.",
          "crossings"};
}

Claim drag(const Findings& f) {
  const auto crossings = [&](const char* study) {
    const Json& c = f[study].at("crossings");
    const auto n = c.at("between_gates").get<std::int64_t>();
    return share_of(std::llround(c.at("clamped_share").get<double>() * static_cast<double>(n)), n);
  };
  const Share with = crossings("field"), without = crossings("field_no_drag");
  return {"drag",
          "Sec. III-C",
          "Without drag and with less damping the velocity leaves the range that the chain covers.",
          "leaves it",
          percent_text(without) + " outside; with them " + percent_text(with),
          rises(with, without)   ? kReproduced
          : falls(with, without) ? kDiffers
                                 : kWithinNoise,
          "D = 0 and d = 10 against D = 0.06 and d = 50; 7 N, Rm 50 N.",
          "crossings"};
}

Claim states() {
  const auto space = dynamics::StateSpace::paper({});
  return {"states",
          "Sec. III-C, Table III",
          "87 input and 88 output states.",
          "87 x 88",
          std::to_string(space.size()) + " x " + std::to_string(space.trapped() + 1),
          space.size() == 87 ? kReproduced : kDiffers,
          "EN 25, RD 30, LD 30, RT 1, LT 1; and trapped.",
          "crossings"};
}

Claim thirteen_steps(const Findings& f) {
  double most = 0;
  for (const Json& s : f["field"].at("starts"))
    most = std::max(most, s.at("fates").at("dynamics").at("cut_off").get<double>());
  const lattice::FieldParams field;
  const int needed = field.rows + field.columns / 2;
  return {"thirteen_steps",
          "Sec. III-C",
          "At most 13 steps, to reach the furthest gate.",
          "13",
          std::to_string(needed) + " gates to the furthest corner",
          needed == field.max_gates ? kReproduced : kDiffers,
          "The first one included. Up to " + number(100 * most, 1) +
              " % of the trials are still on their way after 13, because they also go sideways; "
              "field.max_gates = 0 lifts the limit.",
          "fig11"};
}

}  // namespace

Json claims_of(const Findings& f) {
  const std::vector<Claim> claims{
      rises_with_propulsion(f),
      rises_then_falls(f),
      peak_at_20(f),
      exits_grow(f),
      softer_side(f),
      accord(f),
      thirteen_and_eight(f),
      alike(f),
      percentage(f, "fifty_two_50", "Sec. III-B, Fig. 9B", 300, 50, 52),
      percentage(f, "fifty_two_10", "Sec. III-B, Fig. 9B", 300, 10, 52),
      percentage(f, "ninety_eight_50", "Sec. III-B, Fig. 9C", 100, 50, 98),
      percentage(f, "ninety_eight_10", "Sec. III-B, Fig. 9C", 100, 10, 98),
      right_share_falls(f, false),
      right_share_falls(f, true),
      fig12_propulsion(f),
      accuracy(f),
      table4_row(f, 0, "table4_1"),
      table4_row(f, 1, "table4_2"),
      table4_row(f, 2, "table4_3"),
      table4_row(f, 3, "table4_4"),
      speed(f),
      side_entries(f),
      side_entries_free(),
      velocities(f),
      drag(f),
      states(),
      thirteen_steps(f),
      landscape_sides(f),
      basin(f),
      escape(f),
      steep(f),
      above_landscape(f),
      many_hits(f),
      euler_step(f),
      run_time(f),
      inertia()};
  Json list = Json::array();
  for (const Claim& c : claims)
    list.push_back({{"id", c.id},
                    {"where", c.where},
                    {"claim", c.claim},
                    {"paper", c.paper},
                    {"ours", c.ours},
                    {"verdict", c.verdict},
                    {"why", c.why},
                    {"see", c.see}});
  return list;
}

}  // namespace gatewalk::cli
