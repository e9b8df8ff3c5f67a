// SPDX-License-Identifier: MIT
#include "dynamics/disc/study/stability.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include "dynamics/disc/methods/paper.h"
#include "dynamics/disc/study/accuracy.h"

namespace gatewalk::dynamics {
namespace {

constexpr double kSeconds = 3.0;

/// 10^low, ..., 10^high, `per_decade` values to a factor of ten.
std::vector<double> decades(int low, int high, int per_decade) {
  std::vector<double> values;
  for (int i = low * per_decade; i <= high * per_decade; ++i)
    values.push_back(std::pow(10.0, static_cast<double>(i) / per_decade));
  return values;
}

/// What trades speed for accuracy, from fine to coarse.
MapAxis effort_axis(std::string_view method, bool quick) {
  if (method == "event")
    return {"event_tolerance_m", "event tolerance (m)", decades(-12, -1, quick ? 1 : 2)};
  MapAxis axis{"step_s", "step (s)", {}};
  const double hold = 1.0 / GateParams{}.forces.random_rate;
  const std::vector<int> all{40, 32, 25, 20, 16, 12, 10, 8, 6, 5, 4, 3, 2, 1};
  const std::vector<int> few{40, 20, 10, 5, 3, 1};
  for (const int n : quick ? few : all) axis.values.push_back(hold / n);
  return axis;
}

void set_effort(GateParams& p, std::string_view method, double value) {
  (method == "event" ? p.run.event_tolerance : p.run.step) = value;
}

/// What one trial of a point runs.
struct PointScene {
  GateParams p;
  std::array<BodyState, kTrialsPerPoint> starts;
  int hit_expected = -1;  // -1 unknown, else whether the disc must be deflected
};

PointScene scene_of(MapKind kind, std::string_view method, double x, double y) {
  PointScene scene;
  GateParams& p = scene.p;
  p.run.method = method;
  p.run.step = default_step(p);
  p.run.time_limit = kSeconds;
  p.forces.propulsion = 8.0;
  p.forces.random = 20.0;
  scene.starts.fill({0.0, p.beams.joint_y - p.body.radius - 10.0, 0.0, 15.0});
  switch (kind) {
    case MapKind::step_stiffness:
      set_effort(p, method, x);
      p.beams.stiffness_left = p.beams.stiffness_right = y;
      break;
    case MapKind::step_damping:
      set_effort(p, method, x);
      p.beams.damping = y;
      break;
    case MapKind::restitution_threshold:
      p.contact.restitution = x;
      p.contact.impulse_threshold = y;
      break;
    case MapKind::lever_speed: {
      // Straight below the point of the left beam, so near that neither the lateral force nor the
      // speed along the beam, which keeps the disc inside the gate, moves it before it touches.
      const double gap = 1e-12 * y;
      scene.starts.fill({-p.beams.joint_x + x, p.beams.joint_y - p.body.radius - gap, 0.1 * y, y});
      break;
    }
    case MapKind::grazing_speed: {
      // Straight up beside the left tip, which is at (-15, joint_y); the right one is far away.
      // Small numbers: R (1 + delta) less 15 still tells delta = 1e-15. Starts differ, so that the
      // grazing falls anywhere in a step.
      p.forces = {.propulsion = 0.0, .random = 0.0, .random_rate = 50.0, .drag = 0.0};
      p.beams.joint_x = p.beams.length + 15.0;
      for (int i = 0; i < kTrialsPerPoint; ++i)
        scene.starts[static_cast<std::size_t>(i)] = {
            -15.0 + p.body.radius * (1.0 + x),
            p.beams.joint_y - 0.5 * p.body.radius - y * p.run.step * i / kTrialsPerPoint, 0.0, y};
      p.run.time_limit = std::max(kSeconds, 2.0 * p.body.radius / y);  // until it has passed
      // Methods count gaps of rounding size as contact: 1e-14 R and less may go either way.
      if (std::abs(x) > 1.5e-14) scene.hit_expected = x < 0.0 ? 1 : 0;
      break;
    }
  }
  return scene;
}

/// A first value 0 has no logarithm.
double lowest_positive(const MapAxis& axis) {
  return axis.values.front() > 0.0 ? axis.values.front() : axis.values[1];
}

/// Where make_method begins to refuse, going up from y.front(): bisection in log y; y.back() and
/// more: nowhere. No method refuses a beam for being too soft or too little damped.
double refused_above(MapKind kind, std::string_view method, double x, const MapAxis& y) {
  const auto refused = [&](double log_y) {
    try {
      const PointScene scene = scene_of(kind, method, x, std::exp(log_y));
      (void)make_method(scene.p);
      return false;
    } catch (const InvalidParameter&) {
      return true;
    }
  };
  double taken = std::log(lowest_positive(y)), not_taken = std::log(y.values.back());
  if (refused(taken) || !refused(not_taken)) return std::numeric_limits<double>::infinity();
  while (not_taken - taken > 1e-3) {  // a thousandth: far below what a figure shows
    const double middle = 0.5 * (taken + not_taken);
    (refused(middle) ? not_taken : taken) = middle;
  }
  return std::exp(taken);
}

}  // namespace

StabilityMap stability_map(MapKind kind, std::string_view method, bool quick) {
  StabilityMap map;
  map.kind = kind;
  map.method = method;
  const int fine = quick ? 1 : 2;
  switch (kind) {
    case MapKind::step_stiffness:
      map.name = "step_stiffness";
      map.title = "Step and stiffness";
      map.x = effort_axis(method, quick);
      map.y = {"stiffness_Nm_per_rad", "stiffness (N m/rad)", decades(1, 12, fine)};
      break;
    case MapKind::step_damping:
      map.name = "step_damping";
      map.title = "Step and damping";
      map.x = effort_axis(method, quick);
      map.y = {"damping_Nms_per_rad", "damping (N m s/rad)", decades(0, 6, fine + 1)};
      map.y.values.insert(map.y.values.begin(), 0.0);
      break;
    case MapKind::restitution_threshold:
      map.name = "restitution_threshold";
      map.title = "Restitution and impulse threshold";
      map.x = {"restitution", "restitution", {}, false};
      for (int i = 0; i <= (quick ? 5 : 20); ++i) map.x.values.push_back(i / (quick ? 5.0 : 20.0));
      map.y = {"impulse_threshold_Ns", "impulse threshold (N s)", decades(-4, 0, fine + 1)};
      break;
    case MapKind::lever_speed:
      map.name = "lever_speed";
      map.title = "First contact near the joint";
      map.x = {"lever_m", "distance from the joint (m)", decades(-9, 1, fine)};
      map.y = {"speed_m_per_s", "approach speed (m/s)", decades(-1, 2, quick ? 2 : 4)};
      break;
    case MapKind::grazing_speed:
      map.name = "grazing_speed";
      map.title = "Grazing a tip";
      map.x = {"delta", "closest approach R (1 + delta), delta", {}};
      for (int i = 3; i <= 15; i += quick ? 3 : 1) map.x.values.push_back(-std::pow(10.0, -i));
      for (int i = 15; i >= 3; i -= quick ? 3 : 1) map.x.values.push_back(std::pow(10.0, -i));
      map.y = {"speed_m_per_s", "speed (m/s)", decades(0, 3, quick ? 2 : 4)};
      break;
  }
  return map;
}

MapPoint run_point(MapKind kind, std::string_view method, double x, double y, std::uint64_t seed) {
  const PointScene scene = scene_of(kind, method, x, y);
  MapPoint point;
  std::unique_ptr<Method> stepper;
  try {
    stepper = make_method(scene.p);
  } catch (const InvalidParameter&) {
    return point;  // refused
  }
  bool missed = false;
  for (int trial = 0; trial < kTrialsPerPoint; ++trial) {
    const BodyState& start = scene.starts[static_cast<std::size_t>(trial)];
    const std::int64_t spent = std::max(point.health.steps, point.health.evaluations);
    const GateRun run = run_gate_trial(scene.p, *stepper, start, seed, trial,
                                       std::max<std::int64_t>(0, kMostWorkPerPoint - spent));
    add_run(point.health, scene.p, run);
    point.out_of_work += run.out_of_work;
    // Nothing but a hit pushes it sideways.
    if (scene.hit_expected >= 0) missed |= (run.exit.vx != 0.0) != (scene.hit_expected == 1);
  }
  point.verdict = judge(point.health, point.out_of_work, 0.0);
  if (point.verdict == Verdict::fine && missed) point.verdict = Verdict::missed_hit;
  return point;
}

std::int64_t FinishedMap::count(Verdict v) const {
  return std::count_if(points.begin(), points.end(),
                       [v](const MapPoint& p) { return p.verdict == v; });
}

FinishedMap run_map(const StabilityMap& map, std::uint64_t seed, const Work& work) {
  const std::vector<double>&x = map.x.values, &y = map.y.values;
  FinishedMap done{map, {}, {}};
  done.points.resize(x.size() * y.size());
  done.seconds.resize(done.points.size());
  work.in_pieces(std::string(map.name) + ", " + map.method,
                 static_cast<std::int64_t>(done.points.size()), [&](TrialRange range) {
                   tbb::parallel_for(range.first, range.first + range.count, [&](std::int64_t k) {
                     const auto i = static_cast<std::size_t>(k);
                     const Stopwatch watch;
                     done.points[i] =
                         run_point(map.kind, map.method, x[i % x.size()], y[i / x.size()], seed);
                     done.seconds[i] = watch.seconds();
                   });
                 });
  return done;
}

std::vector<StabilityMap> stability_maps(bool quick) {
  std::vector<StabilityMap> maps;
  for (int kind = 0; kind < kMapKinds; ++kind)
    for (const auto method : chart_methods())
      maps.push_back(stability_map(static_cast<MapKind>(kind), method, quick));
  return maps;
}

std::vector<FinishedMap> run_maps(const StabilityOptions& options, const Work& work) {
  std::vector<FinishedMap> maps;
  for (const StabilityMap& map : stability_maps(options.quick))
    maps.push_back(run_map(map, options.seed, work));
  return maps;
}

double semi_implicit_bound(const GateParams& p) {
  const double k = std::max(p.beams.stiffness_left, p.beams.stiffness_right);
  const double a = k / p.beams.inertia(), b = 2.0 * p.beams.damping / p.beams.inertia();
  return 8.0 / (b + std::sqrt(b * b + 16.0 * a));  // root of a h^2 + b h = 4; inf for a = b = 0
}

std::vector<Border> borders(const StabilityMap& map) {
  if (map.kind != MapKind::step_stiffness && map.kind != MapKind::step_damping) return {};
  const GateParams p;
  const double k = p.beams.stiffness_left, d = p.beams.damping, inertia = p.beams.inertia();
  const bool stiffness = map.kind == MapKind::step_stiffness;
  std::vector<Border> found;
  const auto add = [&](const char* label, const std::vector<double>& at, auto y_of) {
    Border border{label, {}, {}};
    for (const double x : at) {
      const double y = y_of(x);
      if (!(y > 0.0) || !std::isfinite(y)) continue;
      border.x.push_back(x);
      border.y.push_back(y);
    }
    if (!border.x.empty()) found.push_back(std::move(border));
  };
  std::vector<double> steps;  // many, for smooth curves
  constexpr int kPieces = 60;
  const double first = map.x.values.front(), last = map.x.values.back();
  for (int i = 0; i <= kPieces; ++i)
    steps.push_back(first * std::pow(last / first, static_cast<double>(i) / kPieces));
  if (map.method == "paper") {
    if (stiffness) {
      // Swinging beams: h < d/k. (Creeping ones, k <= d^2/4I = 30 N m/rad, take any step up to
      // I/d.)
      add("h = d/k", steps, [&](double h) { return d / h; });
    } else {
      add("h = d/k", steps, [&](double h) { return k * h; });
      // Growth factor -1: 4 I/h^2 - 2 d/h + k = 0.
      add("h = 2 I/d (creeping)", steps, [&](double h) { return 2.0 * inertia / h + 0.5 * k * h; });
    }
  } else if (map.method == "penalty") {
    Border border{"h^2 k/I + 2 h d/I = 4", {}, {}};
    constexpr int kSteps = 500;  // from bottom to top
    const double lowest = lowest_positive(map.y), highest = map.y.values.back();
    for (int i = 0; i <= kSteps; ++i) {
      const double y = lowest * std::pow(highest / lowest, static_cast<double>(i) / kSteps);
      GateParams q;
      (stiffness ? q.beams.stiffness_left : q.beams.damping) = y;
      q.beams.stiffness_right = q.beams.stiffness_left;
      const double h = semi_implicit_bound(q);
      if (h < first || h > last) continue;
      border.x.push_back(h);
      border.y.push_back(y);
    }
    if (!border.x.empty()) found.push_back(std::move(border));
  }
  // Only steps that fit into a hold of the random force are accepted at all.
  add("refused above", map.x.values,
      [&](double x) { return refused_above(map.kind, map.method, x, map.y); });
  return found;
}

}  // namespace gatewalk::dynamics
