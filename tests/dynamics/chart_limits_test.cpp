// SPDX-License-Identifier: MIT
#include "dynamics/disc/study/limits.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "dynamics/disc/methods/paper.h"
#include "dynamics/disc/methods/penalty.h"
#include "tests/support/numbers.h"

namespace gatewalk::dynamics {
namespace {

using test::kEps;

/// The paper's gate; the disc comes from 10 m below the beams at 15 m/s.
LimitScene gate() {
  LimitScene scene{.gate = {}, .start = {0.0, 10.0, 0.0, 15.0}, .options = {.trials = 8}};
  scene.gate.forces.propulsion = 8.0;
  scene.gate.forces.random = 20.0;
  scene.gate.run.time_limit = 3.0;
  return scene;
}

/// The paper's gate with the disc at the beams already, at the given speed.
LimitScene at_the_beams(double speed) {
  LimitScene scene = gate();
  scene.start = {0.0, scene.gate.beams.joint_y - scene.gate.body.radius, 0.0, speed};
  return scene;
}

Verdict at(LimitNumber number, std::string_view method, double x, double y,
           const LimitScene& scene = gate()) {
  return run_point(scene_at(scene, number, method, x, y), 1).verdict;
}

const LimitMap& map_of(const std::vector<LimitMap>& maps, LimitNumber number,
                       std::string_view method) {
  return *std::find_if(maps.begin(), maps.end(),
                       [&](const LimitMap& m) { return m.number == number && m.method == method; });
}

/// A map whose range of the number contains every border.
LimitMap wide_map(LimitNumber number, std::string_view method) {
  LimitMap map = map_of(limit_maps(gate()), number, method);
  const double own = map.y.values[map.y.from];
  map.y.values = {1e-9 * own, own, 1e9 * own};
  return map;
}

// ---- Maps ----

TEST(LimitMaps, EveryMethodHasEveryNumber) {
  const auto methods = chart_methods();
  for (const bool quick : {true, false}) {
    LimitScene scene = gate();
    scene.options.quick = quick;
    const auto maps = limit_maps(scene);
    ASSERT_EQ(maps.size(), limit_numbers().size() * methods.size());
    for (std::size_t i = 0; i < maps.size(); ++i) {
      EXPECT_EQ(maps[i].number, limit_numbers()[i / methods.size()].number);
      EXPECT_EQ(maps[i].method, methods[i % methods.size()]);
      for (const MapAxis* axis : {&maps[i].x, &maps[i].y}) {
        ASSERT_GE(axis->values.size(), 3u) << axis->name << ' ' << maps[i].method;
        EXPECT_TRUE(std::is_sorted(axis->values.begin(), axis->values.end())) << axis->name;
        EXPECT_EQ(std::adjacent_find(axis->values.begin(), axis->values.end()), axis->values.end());
      }
    }
  }
}

TEST(LimitMaps, LeaveOutWhatTheSceneHasNot) {
  LimitScene scene = gate();
  scene.gate.beams.damping = scene.gate.forces.random = 0.0;
  scene.start.vy = 0.0;
  std::set<LimitNumber> numbers;
  for (const LimitMap& map : limit_maps(scene)) numbers.insert(map.number);
  EXPECT_EQ(numbers,
            (std::set{LimitNumber::stiffness, LimitNumber::beam_mass, LimitNumber::restitution,
                      LimitNumber::impulse_threshold, LimitNumber::lever, LimitNumber::graze}));
}

TEST(LimitMaps, SpanFactorsAroundTheScene) {
  LimitScene scene = gate();
  scene.gate.contact.restitution = 0.33;
  scene.gate.beams.stiffness_right = 300.0;
  const auto maps = limit_maps(scene);
  const MapAxis stiffness = map_of(maps, LimitNumber::stiffness, "stable").y;
  EXPECT_EQ(stiffness.values[*stiffness.own], 400.0);
  EXPECT_NEAR(stiffness.values.front(), 4.0, 1e-12);
  EXPECT_NEAR(stiffness.values.back(), 4e4, 1e-8);
  // Both beams by one factor.
  const PointScene soft = scene_at(scene, LimitNumber::stiffness, "stable", 0.02, 40.0);
  EXPECT_NEAR(soft.gate.beams.stiffness_left, 40.0, 40 * kEps);
  EXPECT_NEAR(soft.gate.beams.stiffness_right, 30.0, 40 * kEps);
  const MapAxis restitution = map_of(maps, LimitNumber::restitution, "paper").y;
  EXPECT_EQ(restitution.values[*restitution.own], 0.33);
  EXPECT_EQ(restitution.values.front(), 0.0);
  EXPECT_EQ(restitution.values.back(), 1.0);
  const MapAxis lever = map_of(maps, LimitNumber::lever, "paper").y;
  EXPECT_FALSE(lever.own);
  EXPECT_NEAR(lever.values.back(), 0.1, 1e-12);
}

// From a quarter of the scene's step to a whole hold of the random force, 0.02 s.
TEST(LimitMaps, StepsFitIntoAHold) {
  LimitScene scene = gate();
  const auto ends = [](const MapAxis& a) { return std::pair(a.values.front(), a.values.back()); };
  const auto x_of = [&](std::string_view method) {
    return map_of(limit_maps(scene), LimitNumber::stiffness, method).x;
  };
  EXPECT_EQ(ends(x_of("paper")), std::pair(0.001, 0.02));
  EXPECT_EQ(x_of("paper").values[*x_of("paper").own], 0.004);
  EXPECT_EQ(ends(x_of("stable")), std::pair(0.005, 0.02));
  scene.gate.run.step = 0.01;
  scene.options.own_step = true;
  for (const char* method : {"paper", "stable", "moreau", "penalty"}) {
    EXPECT_EQ(ends(x_of(method)), std::pair(0.0025, 0.02)) << method;
    EXPECT_EQ(x_of(method).values[*x_of(method).own], 0.01) << method;
  }
  const MapAxis tolerance = x_of("event");
  EXPECT_EQ(tolerance.values[*tolerance.own], scene.gate.run.event_tolerance);
  EXPECT_LE(tolerance.values.back(), 0.1 * scene.gate.body.radius * (1.0 + 1e-9));
}

// ---- Points ----

TEST(LimitPoint, CanBeRepeated) {
  const PointScene point = scene_at(gate(), LimitNumber::stiffness, "stable", 0.004, 400.0);
  const MapPoint a = run_point(point, 1), b = run_point(point, 1);
  EXPECT_EQ(a.health.runs, 8);
  EXPECT_EQ(a.health.impacts, b.health.impacts);
  EXPECT_GT(a.health.impacts, 8);  // the disc does meet the beams
  EXPECT_NE(a.health.worst_speed, run_point(point, 2).health.worst_speed);
}

// A point runs the trials that `gate` runs, so both report the same.
TEST(LimitPoint, OfTheSceneItselfIsWhatGateReports) {
  LimitScene scene = gate();
  scene.options.trials = 40;
  for (const LimitMap& map : limit_maps(scene)) {
    if (map.number != LimitNumber::stiffness) continue;
    const double x = map.x.values[*map.x.own], y = map.y.values[*map.y.own];
    const MapPoint point = run_point(scene_at(scene, map.number, map.method, x, y), 7);
    GateParams p = scene.gate;
    p.run.method = map.method;
    p.run.step = default_step(p);
    const Health h = run_gate_trials(p, scene.start, 7, {0, 40}).health;
    for (const HealthNumber& n : kHealthNumbers) {
      if (n.count != nullptr)
        EXPECT_EQ(point.health.*n.count, h.*n.count) << map.method << ' ' << n.key;
      else
        EXPECT_EQ(point.health.*n.largest, h.*n.largest) << map.method << ' ' << n.key;
    }
    EXPECT_EQ(point.verdict == Verdict::fine, h.clean()) << map.method;
  }
}

// The disc bounces back if the beams do not give way: compared with runs of soft beams, all
// outcomes differ.
TEST(LimitPoint, OutcomesAreHeldAgainstTheReference) {
  LimitScene scene = gate();
  scene.options.trials = 40;
  const auto ends_of = [&](double stiffness) {
    const PointScene point = scene_at(scene, LimitNumber::stiffness, "event", 1e-5, stiffness);
    TrialEnds ends;
    add_trial_ends(ends, point.gate, scene.start, 1, {0, 40});
    return ends.trials;
  };
  const PointScene point = scene_at(scene, LimitNumber::stiffness, "stable", 0.02, 4e4);
  EXPECT_EQ(run_point(point, 1, ends_of(4e4)).verdict, Verdict::fine);
  const MapPoint off = run_point(point, 1, ends_of(4.0));
  EXPECT_EQ(off.verdict, Verdict::outcomes);
  EXPECT_GT(off.health.outcome_error, 0.3);
  EXPECT_EQ(off.health.checked_trials, 40);
}

// `paper` is stable up to the stiffness d/h. With steps c, 2c, 4c and stiffnesses of 1.5 and 3
// times d/4c, whose bounds in those units are 4, 2 and 1, by hand:
//          c     2c    4c
//   3      in    out   out
//   1.5    in    in    out
LimitMap small_map() {
  const double c = 0.001, unit = GateParams{}.beams.damping / (4 * c);
  LimitMap map;
  map.method = "paper";
  map.x.values = {c, 2 * c, 4 * c};
  map.y.values = {1.5 * unit, 3 * unit};
  return map;
}

TEST(RunMaps, PutEveryPointInItsPlace) {
  const FinishedMap done = run_maps(gate(), {small_map()}).front();
  ASSERT_EQ(done.points.size(), 6u);
  ASSERT_EQ(done.seconds.size(), 6u);
  for (const auto& [ix, iy] : {std::pair{2u, 0u}, {1u, 1u}, {2u, 1u}})
    EXPECT_EQ(done.at(ix, iy).verdict, Verdict::beyond_bound) << ix << ' ' << iy;
  EXPECT_EQ(done.count(Verdict::beyond_bound), 3);
  // The point itself, of that seed.
  const auto& map = done.map;
  const PointScene point =
      scene_at(gate(), map.number, map.method, map.x.values[0], map.y.values[1]);
  EXPECT_EQ(done.at(0, 1).health.worst_speed, run_point(point, 1).health.worst_speed);
  for (const double seconds : done.seconds) EXPECT_GT(seconds, 0.0);
}

TEST(RunMaps, CanBeStopped) {
  struct Enough {};
  std::int64_t told = 0;
  const Work work{[&](std::string_view what, std::int64_t done, std::int64_t total) {
    if (what == "limits, references") return;
    EXPECT_EQ(what, "limits, points");
    EXPECT_EQ(total, 6);
    ++told;
    if (done > 0) throw Enough{};
  }};
  EXPECT_THROW((void)run_maps(gate(), {small_map()}, work), Enough);
  EXPECT_EQ(told, 2);  // before the first point, and after it
}

// In each row, a step is beyond the bound exactly if it exceeds the bound of the row's beams, to
// within a cell.
TEST(RunMaps, FindTheBoundsWithinACell) {
  LimitScene scene = gate();
  scene.options.trials = 1;
  std::vector<LimitMap> maps;
  for (const LimitMap& map : limit_maps(scene))
    if (map.method == "paper" || map.method == "penalty")
      if (map.number <= LimitNumber::beam_mass) maps.push_back(map);
  ASSERT_EQ(maps.size(), 6u);
  int beyond = 0;
  for (const FinishedMap& done : run_maps(scene, maps))
    for (std::size_t iy = 0; iy < done.map.y.values.size(); ++iy)
      for (std::size_t ix = 0; ix < done.map.x.values.size(); ++ix) {
        const double x = done.map.x.values[ix], y = done.map.y.values[iy];
        const GateParams p = scene_at(scene, done.map.number, done.map.method, x, y).gate;
        const bool is_paper = done.map.method == "paper";
        const bool is_beyond = x > (is_paper ? euler_bound(p) : penalty_bound(p));
        const Health& h = done.at(ix, iy).health;
        EXPECT_EQ(is_paper ? h.unstable > 0 : done.at(ix, iy).verdict == Verdict::refused,
                  is_beyond)
            << done.map.method << ' ' << x << ' ' << y;
        beyond += is_beyond;
      }
  EXPECT_GT(beyond, 30);
}

// ---- Distance from the scene to the faults ----

constexpr Verdict kOk = Verdict::fine;

FinishedMap finished(std::string_view method, const std::vector<std::vector<Verdict>>& rows) {
  FinishedMap done;
  done.map.method = method;
  done.map.x = {
      .name = "step", .unit = "s", .label = "", .values = {1, 2, 4, 8}, .own = 1, .from = 1};
  done.map.y = {
      .name = "stiffness", .unit = "", .label = "", .values = {10, 30, 60}, .own = 1, .from = 1};
  for (const auto& row : rows)
    for (const Verdict v : row) done.points.push_back({.verdict = v, .health = {}});
  return done;
}

TEST(LimitsOf, TellTheNearestFaultsAndWhatHelps) {
  using enum Verdict;
  const std::vector<std::vector<Verdict>> faultless(3, std::vector<Verdict>(4, kOk));
  // Soft beams in the first row, the scene in the middle row; its step is the second one.
  const std::vector<FinishedMap> maps{
      finished(
          "paper",
          {{kOk, energy, energy, kOk}, {energy, energy, beyond_bound, kOk}, {kOk, kOk, kOk, kOk}}),
      finished("stable", faultless),
      finished(
          "moreau",
          {{penetration, energy, kOk, kOk}, {kOk, kOk, kOk, outcomes}, {kOk, too_fast, kOk, kOk}}),
      finished("penalty",
               {{kOk, kOk, kOk, kOk}, {kOk, kOk, refused, refused}, {kOk, kOk, kOk, kOk}}),
      finished("event", faultless)};
  const auto found = limits_of(gate(), maps);
  ASSERT_EQ(found.size(), 5u);

  const MethodLimits& paper = found[0];
  EXPECT_EQ(paper.verdict, energy);
  EXPECT_EQ(paper.limits[0].fault_at, 2.0);
  EXPECT_FALSE(paper.limits[0].fine_to);
  ASSERT_TRUE(paper.limits[0].remedy);  // no finer step is fine here
  EXPECT_EQ(paper.limits[0].remedy->key, "");
  EXPECT_EQ(paper.limits[0].remedy->method, "stable");

  const MethodLimits& stable = found[1];
  EXPECT_EQ(stable.verdict, kOk);
  EXPECT_EQ(stable.nearest(), nullptr);
  EXPECT_FALSE(stable.limits[0].fault_at);

  const MethodLimits& moreau = found[2];
  ASSERT_EQ(moreau.limits.size(), 2u);
  EXPECT_EQ(moreau.limits[0].fault_at, 8.0);
  EXPECT_EQ(moreau.limits[0].fine_to, 4.0);
  EXPECT_EQ(moreau.limits[0].verdict, outcomes);
  EXPECT_EQ(*moreau.limits[0].factor(), 4.0);
  EXPECT_EQ(moreau.limits[0].remedy->key, "run.step_s");
  EXPECT_EQ(moreau.limits[0].remedy->value, 4.0);
  // Twice the stiffness is nearer than a third of it; there a finer step helps.
  EXPECT_EQ(moreau.limits[1].fault_at, 60.0);
  EXPECT_EQ(moreau.limits[1].verdict, too_fast);
  EXPECT_EQ(moreau.limits[1].remedy->value, 1.0);
  EXPECT_EQ(moreau.nearest(), &moreau.limits[1]);

  EXPECT_EQ(found[3].limits[0].verdict, refused);
  EXPECT_EQ(found[3].limits[0].remedy->value, 2.0);
  EXPECT_EQ(found[3].nearest(), &found[3].limits[0]);
}

// No method is fine at its own step, but one is at a finer step.
TEST(LimitsOf, AnotherMethodMayHelpAtAFinerStep) {
  using enum Verdict;
  const std::vector<std::vector<Verdict>> faulty(3, std::vector<Verdict>(4, energy));
  std::vector<FinishedMap> maps;
  for (const char* method : {"paper", "stable", "moreau", "penalty", "event"})
    maps.push_back(finished(method, faulty));
  EXPECT_FALSE(limits_of(gate(), maps)[0].limits[0].remedy);
  maps[2] = finished("moreau", std::vector<std::vector<Verdict>>(3, {kOk, energy, kOk, kOk}));
  const auto remedy = limits_of(gate(), maps)[0].limits[0].remedy;
  ASSERT_TRUE(remedy);
  EXPECT_EQ(remedy->method, "moreau");
  EXPECT_EQ(remedy->key, "run.step_s");
  EXPECT_EQ(remedy->value, 1.0);
}

// Every value of the scene is a value of the map, beside the regular ones.
TEST(LimitMaps, HaveTheScenesOwnToleranceHoweverFarOff) {
  for (const double tolerance : {1e-20, 1.0, 5.0, 1e5}) {
    LimitScene scene = gate();
    scene.gate.run.event_tolerance = tolerance;
    for (const LimitMap& map : limit_maps(scene)) {
      EXPECT_TRUE(std::is_sorted(map.x.values.begin(), map.x.values.end()));
      if (map.method != "event") continue;
      ASSERT_TRUE(map.x.own);
      EXPECT_EQ(map.x.values[*map.x.own], tolerance);
    }
  }
}

TEST(Signs, AreNumbersOfTheStatus) {
  for (std::size_t v = 0; v < kVerdictNames.size(); ++v) {
    const Sign& sign = kSigns[v];
    EXPECT_EQ(sign.words.empty(), v == 0) << kVerdictNames[v];
    if (sign.key.empty()) continue;
    EXPECT_TRUE(std::any_of(kHealthNumbers.begin(), kHealthNumbers.end(),
                            [&](const HealthNumber& n) { return n.key == sign.key; }))
        << sign.key;
  }
}

// ---- Borders that are known ----

// With explicit Euler a swinging beam grows if h > d/k. Both sides of the border, 1 % away.
TEST(Limits, PaperBreaksBeyondItsStiffnessBound) {
  for (const double h : {0.001, 0.002, 0.004}) {
    const double border = GateParams{}.beams.damping / h;
    EXPECT_EQ(at(LimitNumber::stiffness, "paper", h, 1.01 * border), Verdict::beyond_bound) << h;
    EXPECT_LT(at(LimitNumber::stiffness, "paper", h, 0.99 * border), Verdict::beyond_bound) << h;
  }
}

// With explicit Euler a creeping beam grows if h > about 2 I/d; a swinging beam also if the damping
// is too small.
TEST(Limits, PaperBreaksBeyondBothDampingBounds) {
  const double inertia = GateParams{}.beams.inertia(), k = GateParams{}.beams.stiffness_left;
  for (const double h : {0.001, 0.004}) {
    const double high = 2.0 * inertia / h + 0.5 * k * h, low = k * h;
    EXPECT_EQ(at(LimitNumber::damping, "paper", h, 1.01 * high), Verdict::beyond_bound) << h;
    EXPECT_LT(at(LimitNumber::damping, "paper", h, 0.99 * high), Verdict::beyond_bound) << h;
    EXPECT_LT(at(LimitNumber::damping, "paper", h, 1.01 * low), Verdict::beyond_bound) << h;
    EXPECT_EQ(at(LimitNumber::damping, "paper", h, 0.99 * low), Verdict::beyond_bound) << h;
  }
}

// Well beyond the bound, energy appears by orders of magnitude.
TEST(Limits, BeyondTheBoundEnergyAppears) {
  const auto created = [](double stiffness) {
    return run_point(scene_at(gate(), LimitNumber::stiffness, "paper", 0.001, stiffness), 1)
        .health.worst_energy_created;
  };
  EXPECT_LT(created(1e3), 100.0);
  EXPECT_GT(created(1e6), 1e4);
}

// `stable` refuses when a step would need more than 1024 pieces of half a radian or e-fold.
TEST(Limits, StableRefusesBeyond1024Pieces) {
  const double inertia = GateParams{}.beams.inertia();
  for (const double h : {0.004, 0.02}) {
    const double stiffness = inertia * (512.0 / h) * (512.0 / h), damping = 512.0 * inertia / h;
    EXPECT_EQ(at(LimitNumber::stiffness, "stable", h, 1.01 * stiffness), Verdict::refused) << h;
    EXPECT_NE(at(LimitNumber::stiffness, "stable", h, 0.99 * stiffness), Verdict::refused) << h;
    EXPECT_EQ(at(LimitNumber::damping, "stable", h, 1.01 * damping), Verdict::refused) << h;
    EXPECT_NE(at(LimitNumber::damping, "stable", h, 0.99 * damping), Verdict::refused) << h;
  }
}

// A matrix's largest eigenvalue modulus, 2 x 2: semi-implicit Euler's step of a free beam,
// omega+ = omega - h (k theta + d omega)/I, theta+ = theta + h omega+.
double growth(const GateParams& p, double h) {
  const double a = h * p.beams.stiffness_left / p.beams.inertia();
  const double b = h * p.beams.damping / p.beams.inertia();
  const double half_trace = 0.5 * (2.0 - h * a - b), determinant = 1.0 - b;
  const double under = half_trace * half_trace - determinant;
  return under < 0.0 ? std::sqrt(determinant) : std::abs(half_trace) + std::sqrt(under);
}

TEST(SemiImplicitBound, IsWhereFreeBeamsBeginToGrow) {
  for (const double k : {1.0, 400.0, 1e6}) {
    for (const double d : {0.0, 50.0, 1e4}) {
      GateParams p;
      p.beams.stiffness_left = p.beams.stiffness_right = k;
      p.beams.damping = d;
      const double bound = semi_implicit_bound(p);
      EXPECT_GT(growth(p, 1.001 * bound), 1.0) << k << ' ' << d;
      // Without damping the multipliers lie on the unit circle.
      EXPECT_LE(growth(p, 0.999 * bound), 1.0 + 4 * kEps) << k << ' ' << d;
    }
  }
}

// An undamped beam's frequency is sqrt(k/I): four times as stiff, or a quarter of the mass, half
// the step.
TEST(SemiImplicitBound, GoesWithTheRootOfTheStiffness) {
  GateParams p;
  p.beams.damping = 0.0;
  const double bound = semi_implicit_bound(p);
  EXPECT_NEAR(bound, 2.0 * std::sqrt(p.beams.inertia() / p.beams.stiffness_left), 4 * kEps * bound);
  GateParams stiff = p, light = p;
  stiff.beams.stiffness_left = stiff.beams.stiffness_right = 4.0 * p.beams.stiffness_left;
  light.beams.mass *= 0.25;
  EXPECT_NEAR(semi_implicit_bound(stiff), 0.5 * bound, 4 * kEps * bound);
  EXPECT_NEAR(semi_implicit_bound(light), 0.5 * bound, 4 * kEps * bound);
}

// The lines of the figures follow their formulas. A line has points inside its map.
TEST(Borders, OfPaperAreItsEulerBound) {
  const Beams beams = GateParams{}.beams;
  const double inertia = beams.inertia();
  for (const LimitNumber number : {LimitNumber::stiffness, LimitNumber::damping}) {
    const LimitMap map = wide_map(number, "paper");
    const auto lines = borders(gate(), map);
    ASSERT_EQ(lines.size(), number == LimitNumber::stiffness ? 1u : 2u);  // d/k and, above, 2 I/d
    for (const Border& line : lines) EXPECT_GT(line.x.size(), 20u);
    std::vector<double> steps = lines.front().x, values = lines.front().y;
    steps.insert(steps.end(), lines.back().x.begin(), lines.back().x.end());
    values.insert(values.end(), lines.back().y.begin(), lines.back().y.end());
    for (std::size_t i = 0; i < steps.size(); ++i) {
      const double h = steps[i], y = values[i];
      const double k = number == LimitNumber::stiffness ? y : beams.stiffness_left;
      const double d = number == LimitNumber::damping ? y : beams.damping;
      // Swinging: h = d/k. Creeping: 4 I/h^2 - 2 d/h + k = 0, with rounding amplified by the root's
      // difference of nearly equal numbers by d^2 / (4 k I) < 1e6 here.
      const double off = d * d < 4.0 * k * inertia ? h * k / d - 1.0
                                                   : (4.0 * inertia / h + k * h) / (2.0 * d) - 1.0;
      EXPECT_NEAR(off, 0.0, 1e-9) << h << ' ' << y;
    }
  }
}

TEST(Borders, OfPenaltyAreTheSemiImplicitBound) {
  for (const LimitNumber number : {LimitNumber::stiffness, LimitNumber::damping}) {
    const auto lines = borders(gate(), wide_map(number, "penalty"));
    ASSERT_EQ(lines.size(), 2u);
    const Border& line = lines.front();
    EXPECT_GT(line.x.size(), 20u);
    const Beams beams = GateParams{}.beams;
    for (std::size_t i = 0; i < line.x.size(); ++i) {
      const double h = line.x[i], y = line.y[i];
      const double k = number == LimitNumber::stiffness ? y : beams.stiffness_left;
      const double d = number == LimitNumber::damping ? y : beams.damping;
      // Few rounding errors, because no nearly equal numbers are subtracted.
      EXPECT_NEAR((h * h * k + 2.0 * h * d) / beams.inertia(), 4.0, 40 * kEps) << h;
    }
  }
}

TEST(Borders, OfStableAreWhereItRefuses) {
  const auto lines = borders(gate(), wide_map(LimitNumber::stiffness, "stable"));
  ASSERT_EQ(lines.size(), 1u);
  const double inertia = GateParams{}.beams.inertia();
  for (std::size_t i = 0; i < lines[0].x.size(); ++i) {
    const double h = lines[0].x[i];
    // The search stops at a thousandth.
    EXPECT_NEAR(lines[0].y[i] / (inertia * (512.0 / h) * (512.0 / h)), 1.0, 2e-3);
  }
  EXPECT_TRUE(borders(gate(), wide_map(LimitNumber::lever, "stable")).empty());
}

// For small y, a graze at R (1 - y) overlaps for the time R sqrt(8 y) / v: on the line, as long as
// a step.
TEST(Borders, OfGrazesAreOverlapsOfAStep) {
  const LimitScene scene = at_the_beams(10.0);
  for (const LimitMap& map : limit_maps(scene)) {
    if (map.number != LimitNumber::graze) continue;
    const auto lines = borders(scene, map);
    ASSERT_EQ(lines.size(), map.method == "event" ? 0u : 1u) << map.method;
    for (const Border& line : lines)
      for (std::size_t i = 0; i < line.x.size(); ++i)
        EXPECT_NEAR(10.0 * std::sqrt(8.0 * line.y[i]) / 10.0 / line.x[i], 1.0,
                    0.3 * line.y[i] + 1e-9);
  }
}

// ---- Borders that were measured ----

// `stable` holds from soft to rigid, creeping to undamped, at any restitution and threshold.
TEST(Limits, StableHoldsInTheInterior) {
  for (const double h : {0.001, 0.02})
    for (const double k : {1e1, 1e4, 1e8})
      EXPECT_EQ(at(LimitNumber::stiffness, "stable", h, k), Verdict::fine) << h << ' ' << k;
  for (const double d : {0.0, 1e3, 1e5})
    EXPECT_EQ(at(LimitNumber::damping, "stable", 0.004, d), Verdict::fine) << d;
  for (const double e : {0.0, 0.8, 1.0})
    for (const double threshold : {1e-4, 1.0}) {
      LimitScene scene = gate();
      scene.gate.contact.impulse_threshold = threshold;
      EXPECT_EQ(at(LimitNumber::restitution, "stable", 0.02, e, scene), Verdict::fine)
          << e << ' ' << threshold;
    }
}

TEST(Limits, StableHoldsAtTheJoint) {
  for (const double r : {1e-9, 1e-6, 1e-3, 1.0})
    for (const double speed : {0.1, 10.0})
      EXPECT_EQ(at(LimitNumber::lever, "stable", 0.02, r / 25.0, at_the_beams(speed)),
                Verdict::fine)
          << r << ' ' << speed;
}

// `paper` creates energy or sinks wherever its constraint acts, also far from any stability bound.
TEST(Limits, PaperFailsAtItsOwnSetting) {
  const Verdict v = at(LimitNumber::stiffness, "paper", 0.004, 400.0);
  EXPECT_GE(v, Verdict::energy);
  EXPECT_LT(v, Verdict::beyond_bound);
}

// There is never a hit above R. Below R, a hit is missed the sooner, the shorter the overlap (R
// sqrt(8 delta) / v) is compared with the step: 89 ms at delta 1e-3 and 10 m/s, 28 ms at 1e-4, 0.09
// ms at 1e-9.
TEST(Limits, GrazingHitsAreMissedWhenShorterThanAStep) {
  const LimitScene scene = at_the_beams(10.0);
  for (const auto& [method, step] : {std::pair("paper", 0.004), {"stable", 0.02}}) {
    for (const double beside : {1e-3, 1e-9, 1e-15})
      EXPECT_EQ(at(LimitNumber::graze, method, step, -beside, scene), Verdict::fine)
          << method << beside;
    EXPECT_EQ(at(LimitNumber::graze, method, step, 1e-3, scene), Verdict::fine) << method;
  }
  EXPECT_EQ(at(LimitNumber::graze, "stable", 0.02, 1e-4, scene), Verdict::fine);
  EXPECT_EQ(at(LimitNumber::graze, "stable", 0.02, 1e-9, scene), Verdict::missed_hit);
}

}  // namespace
}  // namespace gatewalk::dynamics
