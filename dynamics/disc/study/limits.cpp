// SPDX-License-Identifier: MIT
#include "dynamics/disc/study/limits.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "dynamics/disc/methods/paper.h"
#include "dynamics/disc/methods/penalty.h"

namespace gatewalk::dynamics {
namespace {

constexpr std::int64_t kGrazes = 8;    // starts of a graze, at different phases of a step
constexpr double kRounding = 1.5e-14;  // of R: rounding decides whether such a gap is contact
constexpr double kGap = 1e-12;  // of R: initial gap below the beam that is hit near its joint
constexpr int kDecades = 2;     // decades by which numbers vary, down and up
constexpr int kDoublings = 7;   // doublings of the step, upwards
// The limit of steps or evaluations of a trial, and of each of its steps: a trial beyond both is
// stuck.
constexpr std::int64_t kMostWorkOfTrial = 2'000'000;
constexpr double kMostWorkOfStep = 30.0;
constexpr std::int64_t kMostWorkOfReference = 4'000'000;

constexpr std::array<LimitNumberInfo, 9> kNumbers{{
    {LimitNumber::stiffness, "stiffness", "stiffness", "N m/rad", "stiffness (N m/rad)"},
    {LimitNumber::damping, "damping", "damping", "N m s/rad", "damping (N m s/rad)"},
    {LimitNumber::beam_mass, "beam_mass", "mass of a beam", "kg", "mass of a beam (kg)"},
    {LimitNumber::random_force, "random_force", "random force", "N", "random force (N)"},
    {LimitNumber::speed, "speed", "speed of the start", "m/s", "speed of the start (m/s)"},
    {LimitNumber::restitution, "restitution", "restitution", "1", "restitution"},
    {LimitNumber::impulse_threshold, "impulse_threshold", "impulse threshold", "N s",
     "impulse threshold (N s)"},
    {LimitNumber::lever, "lever", "first contact near a joint", "1",
     "distance from joint / beam's length"},
    {LimitNumber::graze, "graze", "grazing a tip", "1", "overlap with the tip / radius"},
}};

double speed_of(const BodyState& s) { return std::hypot(s.vx, s.vy); }

/// The speed at which a body from this start reaches the beams: by the propulsion, limited by the
/// drag. A scene without motion forward gives its own unit of speed.
double approach_speed(const GateParams& p, const BodyState& start) {
  const double way = std::max(0.0, p.beams.joint_y - p.body.radius - start.y);
  const double first = speed_of(start), force = p.forces.propulsion;
  double speed = std::sqrt(first * first + 2.0 * force * way / p.body.mass);
  if (p.forces.drag > 0.0) speed = std::min(speed, std::max(first, force / p.forces.drag));
  return speed > 0.0 ? speed : scale_of(p).speed();
}

/// The scene's own value; 0 if the scene has none, or the value is no place to begin.
double own_of(const LimitScene& scene, LimitNumber number) {
  const GateParams& p = scene.gate;
  switch (number) {
    case LimitNumber::stiffness:
      return std::max(p.beams.stiffness_left, p.beams.stiffness_right);
    case LimitNumber::damping:
      return p.beams.damping;
    case LimitNumber::beam_mass:
      return p.beams.mass;
    case LimitNumber::random_force:
      return p.forces.random;
    case LimitNumber::speed:
      return speed_of(scene.start);
    case LimitNumber::restitution:
      return p.contact.restitution;
    case LimitNumber::impulse_threshold:
      return p.contact.impulse_threshold;
    case LimitNumber::lever:
    case LimitNumber::graze:
      break;
  }
  return 0.0;
}

/// The values 10^low, ..., 10^high times `unit`, `per_decade` values per factor of ten.
std::vector<double> decades(double unit, int low, int high, int per_decade) {
  std::vector<double> values;
  for (int i = low * per_decade; i <= high * per_decade; ++i)
    values.push_back(unit * std::pow(10.0, static_cast<double>(i) / per_decade));
  return values;
}

std::size_t place_of(const std::vector<double>& values, double value) {
  return static_cast<std::size_t>(std::lower_bound(values.begin(), values.end(), value) -
                                  values.begin());
}

MapAxis number_axis(const LimitScene& scene, LimitNumber number) {
  const LimitNumberInfo& info = kNumbers[static_cast<std::size_t>(number)];
  MapAxis axis{info.name, info.unit, info.label, {}};
  const double own = own_of(scene, number);
  const bool quick = scene.options.quick;
  const int per_decade = quick ? 1 : 2;
  if (number == LimitNumber::restitution) {
    axis.logarithmic = false;
    for (int i = 0; i <= (quick ? 5 : 10); ++i) axis.values.push_back(i / (quick ? 5.0 : 10.0));
    if (!std::binary_search(axis.values.begin(), axis.values.end(), own))
      axis.values.insert(
          axis.values.begin() + static_cast<std::ptrdiff_t>(place_of(axis.values, own)), own);
  } else if (number == LimitNumber::lever || number == LimitNumber::graze) {
    axis.values = decades(1.0, -2 * kDecades - 1, -1, per_decade);
    axis.from = axis.values.size() - 1;
    return axis;
  } else {
    axis.values = decades(own, -kDecades, kDecades, per_decade);
    axis.values[axis.values.size() / 2] = own;  // exact to the last bit
  }
  axis.from = place_of(axis.values, own);
  axis.own = axis.from;
  return axis;
}

Setting own_setting(const LimitScene& scene, std::string_view method) {
  GateParams p = scene.gate;
  if (method == "event") return {"event", "run.event_tolerance_m", p.run.event_tolerance};
  p.run.method = method;
  return {p.run.method, "run.step_s", scene.options.own_step ? p.run.step : default_step(p)};
}

/// The axis of steps (or tolerances), from fine to coarse: from a quarter of the scene's step to
/// the longest possible one, a draw of the random force, or to 128 times the scene's step.
MapAxis effort_axis(const LimitScene& scene, std::string_view method) {
  const double own = own_setting(scene, method).value;
  const int per_doubling = scene.options.quick ? 1 : 2;
  MapAxis axis{"step", "s", "step (s)", {}};
  if (method == "event") {
    axis = {"tolerance", "m", "event tolerance (m)", {}};
    axis.values = decades(own, -2, 2, per_doubling);
  } else {
    const double hold = 1.0 / scene.gate.forces.random_rate;
    const auto parts = std::lround(hold / own);
    std::vector<long> all;
    for (int k = 2 * per_doubling;
         k >= -kDoublings * per_doubling && (all.empty() || all.back() > 1); --k) {
      const long n = std::max(1L, std::lround(static_cast<double>(parts) *
                                              std::exp2(static_cast<double>(k) / per_doubling)));
      if (all.empty() || n != all.back()) all.push_back(n);
    }
    for (const long n : all)
      axis.values.push_back(n == parts ? own : hold / static_cast<double>(n));
  }
  // One value is the scene's own, to the last bit.
  auto at = std::lower_bound(axis.values.begin(), axis.values.end(), own * (1.0 - 1e-9));
  if (at != axis.values.end() && *at <= own * (1.0 + 1e-9))
    *at = own;
  else
    at = axis.values.insert(at, own);
  axis.from = static_cast<std::size_t>(at - axis.values.begin());
  axis.own = axis.from;
  return axis;
}

/// A number and its value. The scene itself, and numbers that `event` ignores, share one key.
using ReferenceKey = std::pair<LimitNumber, double>;
ReferenceKey reference_key(const LimitScene& scene, LimitNumber number, double y) {
  const LimitNumber threshold = LimitNumber::impulse_threshold;
  if (number == threshold || y == own_of(scene, number))
    return {threshold, own_of(scene, threshold)};
  return {number, y};
}

/// The reference trials of all methods at this value of the number: `event` at the finest tolerance
/// of a chart, whose error is far below what so few trials show. Empty if these trials are no
/// reference, and for grazes, whose hits are known.
std::vector<TrialEnd> reference_of(const LimitScene& scene, LimitNumber number, double y) {
  if (number == LimitNumber::graze) return {};
  const Setting setting = chart_settings("event", scene.gate).back();
  const PointScene point = scene_at(scene, number, setting.method, setting.value, y);
  TrialEnds ends;
  try {
    add_trial_ends(ends, point.gate, point.starts.front(), scene.options.seed, {0, point.trials},
                   kMostWorkOfReference);
  } catch (const InvalidParameter&) {
    return {};
  }
  if (ends.verdict() != Verdict::fine) return {};
  return std::move(ends.trials);
}

/// The value above which make_method refuses, searched upwards from y.front() by bisection in log
/// y; infinite if it refuses nowhere or everywhere. No method refuses a beam for being too soft or
/// too little damped.
double refused_above(const LimitScene& scene, const LimitMap& map, double x) {
  const auto refused = [&](double log_y) {
    try {
      const PointScene point = scene_at(scene, map.number, map.method, x, std::exp(log_y));
      (void)make_method(point.gate);
      return false;
    } catch (const InvalidParameter&) {
      return true;
    }
  };
  double taken = std::log(map.y.values.front()), not_taken = std::log(map.y.values.back());
  if (refused(taken) || !refused(not_taken)) return std::numeric_limits<double>::infinity();
  while (not_taken - taken > 1e-3) {  // a thousandth, far below the resolution of a figure
    const double middle = 0.5 * (taken + not_taken);
    (refused(middle) ? not_taken : taken) = middle;
  }
  return std::exp(taken);
}

}  // namespace

std::span<const LimitNumberInfo> limit_numbers() { return kNumbers; }

std::vector<LimitMap> limit_maps(const LimitScene& scene) {
  std::vector<LimitMap> maps;
  for (const LimitNumberInfo& info : kNumbers) {
    const bool is_share =
        info.number >= LimitNumber::lever || info.number == LimitNumber::restitution;
    if (!is_share && !(own_of(scene, info.number) > 0.0)) continue;
    for (const auto method : chart_methods())
      maps.push_back({info.number, std::string(method), effort_axis(scene, method),
                      number_axis(scene, info.number)});
  }
  return maps;
}

PointScene scene_at(const LimitScene& scene, LimitNumber number, std::string_view method, double x,
                    double y) {
  PointScene point{scene.gate, {scene.start}, scene.options.trials};
  GateParams& p = point.gate;
  p.run.method = method;
  p.run.step = default_step(p);
  (method == "event" ? p.run.event_tolerance : p.run.step) = x;
  const double speed = approach_speed(p, scene.start);
  BodyState& start = point.starts.front();
  switch (number) {
    case LimitNumber::stiffness: {
      const double factor = y / own_of(scene, number);
      p.beams.stiffness_left *= factor;
      p.beams.stiffness_right *= factor;
      break;
    }
    case LimitNumber::damping:
      p.beams.damping = y;
      break;
    case LimitNumber::beam_mass:
      p.beams.mass = y;
      break;
    case LimitNumber::random_force:
      p.forces.random = y;
      break;
    case LimitNumber::speed: {
      const double factor = y / own_of(scene, number);
      start.vx *= factor;
      start.vy *= factor;
      break;
    }
    case LimitNumber::restitution:
      p.contact.restitution = y;
      break;
    case LimitNumber::impulse_threshold:
      p.contact.impulse_threshold = y;
      break;
    case LimitNumber::lever:
      // The body starts straight below a point of the left beam, so near that neither the lateral
      // force nor the speed along the beam, which keeps the disc inside the gate, moves it before
      // the hit.
      start = {y * p.beams.length - p.beams.joint_x, p.beams.joint_y - (1.0 + kGap) * p.body.radius,
               0.1 * speed, speed};
      break;
    case LimitNumber::graze: {
      // The body moves straight up beside the left tip, 1.5 radii left of the middle; the right tip
      // is far away. Starts differ, so the graze falls at different phases of a step.
      p.forces = {
          .propulsion = 0.0, .random = 0.0, .random_rate = p.forces.random_rate, .drag = 0.0};
      const double radius = p.body.radius, tip = -1.5 * radius;
      p.beams.joint_x = p.beams.length - tip;
      const double in_a_step = speed * p.run.step;
      point.trials = kGrazes;
      point.starts.clear();
      for (std::int64_t i = 0; i < kGrazes; ++i)
        point.starts.push_back(
            {tip + radius * (1.0 - y),
             p.beams.joint_y - 0.5 * radius - in_a_step * static_cast<double>(i) / kGrazes, 0.0,
             speed});
      p.run.time_limit = (2.0 * radius + in_a_step) / speed;  // until the body has passed
      if (std::abs(y) > kRounding) point.must_hit = y > 0.0;
      break;
    }
  }
  if (p.forces.random == 0.0 && point.starts.size() == 1) point.trials = 1;
  return point;
}

MapPoint run_point(const PointScene& point, std::uint64_t seed,
                   std::span<const TrialEnd> reference) {
  const GateParams& p = point.gate;
  MapPoint result;
  TrialEnds ends;
  const double granted = kMostWorkOfStep * p.run.time_limit / p.run.step;
  try {
    for (std::size_t i = 0; i < point.starts.size(); ++i)
      add_trial_ends(ends, p, point.starts[i], seed, share_of(point.trials, i, point.starts.size()),
                     std::max(kMostWorkOfTrial, static_cast<std::int64_t>(granted)));
  } catch (const InvalidParameter&) {
    return result;  // refused
  }
  result.health = ends.health;
  result.out_of_work = ends.out_of_work;
  if (!reference.empty()) {
    const WeakError e = outcome_error(ends.trials, reference);
    result.health.checked_trials = point.trials;
    result.health.outcome_error =
        std::max(0.0, e.total_variation - 2.0 * uncertainty_of(e, point.trials));
  }
  result.verdict = judge(result.health, result.out_of_work, 0.0);
  // Only a hit pushes the body sideways.
  const bool missed =
      point.must_hit && std::any_of(ends.trials.begin(), ends.trials.end(), [&](const TrialEnd& e) {
        return (e.exit.vx != 0.0) != *point.must_hit;
      });
  if (result.verdict == Verdict::fine && missed) result.verdict = Verdict::missed_hit;
  return result;
}

std::int64_t FinishedMap::count(Verdict v) const {
  return std::count_if(points.begin(), points.end(),
                       [v](const MapPoint& p) { return p.verdict == v; });
}

std::vector<FinishedMap> run_maps(const LimitScene& scene, std::vector<LimitMap> maps,
                                  const Work& work) {
  // The references come first, one for each value of each number.
  std::map<ReferenceKey, std::vector<TrialEnd>> references;
  for (const LimitMap& map : maps)
    for (const double y : map.y.values) references[reference_key(scene, map.number, y)];
  std::vector<decltype(references)::value_type*> wanted;
  for (auto& reference : references) wanted.push_back(&reference);
  work.in_pieces("limits, references", static_cast<std::int64_t>(wanted.size()),
                 [&](TrialRange range) {
                   tbb::parallel_for(range.first, range.first + range.count, [&](std::int64_t k) {
                     auto& [key, ends] = *wanted[static_cast<std::size_t>(k)];
                     ends = reference_of(scene, key.first, key.second);
                   });
                 });
  std::vector<FinishedMap> finished;
  std::vector<std::pair<std::size_t, std::size_t>> points;  // index of the map, index of its point
  for (LimitMap& map : maps) {
    const std::size_t n = map.x.values.size() * map.y.values.size();
    for (std::size_t i = 0; i < n; ++i) points.emplace_back(finished.size(), i);
    finished.push_back({std::move(map), std::vector<MapPoint>(n), std::vector<double>(n)});
  }
  work.in_pieces("limits, points", static_cast<std::int64_t>(points.size()), [&](TrialRange range) {
    tbb::parallel_for(range.first, range.first + range.count, [&](std::int64_t k) {
      const auto [which, i] = points[static_cast<std::size_t>(k)];
      FinishedMap& done = finished[which];
      const LimitMap& map = done.map;
      const double x = map.x.values[i % map.x.values.size()];
      const double y = map.y.values[i / map.x.values.size()];
      const Stopwatch watch;
      done.points[i] = run_point(scene_at(scene, map.number, map.method, x, y), scene.options.seed,
                                 references.at(reference_key(scene, map.number, y)));
      done.seconds[i] = watch.seconds();
    });
  });
  return finished;
}

// ---- Distance from the scene to the faults ----

namespace {

/// The distance between two values along an axis.
double distance(const MapAxis& axis, std::size_t from, std::size_t to) {
  const double a = axis.values[from], b = axis.values[to];
  return axis.logarithmic ? std::abs(std::log(b / a)) : std::abs(b - a);
}

/// The nearest fault along an axis whose point i is `at(i)`, searched from axis.from on.
template <class At>
Limit limit_on(const MapAxis& axis, At at) {
  Limit limit{axis};
  std::optional<std::size_t> nearest;
  for (const int step : {1, -1})
    for (auto i = static_cast<std::ptrdiff_t>(axis.from);
         i >= 0 && i < static_cast<std::ptrdiff_t>(axis.values.size()); i += step) {
      const auto k = static_cast<std::size_t>(i);
      if (at(k).verdict == Verdict::fine) continue;
      if (!nearest || distance(axis, axis.from, k) < distance(axis, axis.from, *nearest)) {
        nearest = k;
        limit.fine_to.reset();
        if (k != axis.from) limit.fine_to = axis.values[static_cast<std::size_t>(i - step)];
        limit.fault_at = axis.values[k];
        limit.verdict = at(k).verdict;
      }
      break;
    }
  return limit;
}

const char* key_of(const FinishedMap& map) {
  return map.map.method == "event" ? "run.event_tolerance_m" : "run.step_s";
}

/// The coarsest setting below index `from` without a fault, in a row of the map.
std::optional<double> finer_setting(const FinishedMap& map, std::size_t from, std::size_t iy) {
  for (std::size_t ix = from; ix-- > 0;)
    if (map.at(ix, iy).verdict == Verdict::fine) return map.map.x.values[ix];
  return std::nullopt;
}

/// The remedy for a fault at (ix, iy) of a map: a finer setting; else another method without a
/// fault at its own setting, or else at a finer one. `stable` is tried first.
std::optional<Remedy> remedy_for(const FinishedMap& map, std::size_t ix, std::size_t iy,
                                 std::span<const FinishedMap> of_all_methods) {
  if (const auto finer = finer_setting(map, ix, iy)) return Remedy{key_of(map), *finer};
  std::optional<Remedy> found;
  const auto look = [&](const FinishedMap& m) {
    if (m.map.method == map.map.method || found) return;
    if (m.at(m.map.x.from, iy).verdict == Verdict::fine)
      found = {"", 0.0, m.map.method};
    else if (const auto finer = finer_setting(m, m.map.x.from, iy))
      found = {key_of(m), *finer, m.map.method};
  };
  for (const bool is_stable : {true, false})
    for (const FinishedMap& m : of_all_methods)
      if ((m.map.method == "stable") == is_stable) look(m);
  return found;
}

}  // namespace

std::optional<double> Limit::factor() const {
  if (!axis.own || !fault_at) return std::nullopt;
  return *fault_at / axis.values[*axis.own];
}

const Limit* MethodLimits::nearest() const {
  const Limit* nearest = nullptr;
  const auto far = [](const Limit& l) { return std::abs(std::log(*l.factor())); };
  for (const Limit& limit : limits)
    if (limit.factor() && (!nearest || far(limit) < far(*nearest))) nearest = &limit;
  return nearest;
}

std::vector<MethodLimits> limits_of(const LimitScene& scene, std::span<const FinishedMap> maps) {
  std::vector<MethodLimits> all;
  const std::size_t methods = chart_methods().size();
  for (std::size_t m = 0; m < methods; ++m) {
    const auto own_row = [](const FinishedMap& map) { return map.map.y.from; };
    const FinishedMap& first = maps[m];
    const MapPoint& here = first.at(first.map.x.from, own_row(first));
    MethodLimits found{
        first.map.method, own_setting(scene, first.map.method), here.verdict, here.health, {}};
    const auto add = [&](Limit limit, const FinishedMap& map, std::span<const FinishedMap> beside,
                         bool along_x) {
      if (limit.fault_at) {
        const std::size_t k = place_of((along_x ? map.map.x : map.map.y).values, *limit.fault_at);
        limit.remedy =
            remedy_for(map, along_x ? k : map.map.x.from, along_x ? own_row(map) : k, beside);
      }
      found.limits.push_back(std::move(limit));
    };
    add(limit_on(first.map.x, [&](std::size_t i) { return first.at(i, own_row(first)); }), first,
        maps.first(methods), true);
    for (std::size_t k = m; k < maps.size(); k += methods) {
      const FinishedMap& map = maps[k];
      add(limit_on(map.map.y, [&](std::size_t i) { return map.at(map.map.x.from, i); }), map,
          maps.subspan(k - m, methods), false);
    }
    all.push_back(std::move(found));
  }
  return all;
}

// ---- Borders ----

double semi_implicit_bound(const GateParams& p) {
  const double k = std::max(p.beams.stiffness_left, p.beams.stiffness_right);
  const double a = k / p.beams.inertia(), b = 2.0 * p.beams.damping / p.beams.inertia();
  // Root of a h^2 + b h = 4; infinite for a = b = 0.
  return 8.0 / (b + std::sqrt(b * b + 16.0 * a));
}

std::vector<Border> borders(const LimitScene& scene, const LimitMap& map) {
  const std::vector<double>&x = map.x.values, &y = map.y.values;
  std::vector<Border> found;
  // Adds the points inside the map. A line that leaves the map and returns makes two borders.
  const auto add = [&](const char* label, const std::vector<std::array<double, 2>>& points) {
    Border border{label, {}, {}};
    const auto end = [&] {
      if (border.x.size() > 1) found.push_back(border);
      border = {label, {}, {}};
    };
    for (const auto& [px, py] : points) {
      if (!(px >= x.front() && px <= x.back() && py >= y.front() && py <= y.back())) {
        end();
        continue;
      }
      border.x.push_back(px);
      border.y.push_back(py);
    }
    end();
  };
  constexpr int kPieces = 500;  // pieces from bottom to top
  const auto along_y = [&](const char* label, auto x_of) {
    std::vector<std::array<double, 2>> points;
    for (int i = 0; i <= kPieces; ++i) {
      const double t = static_cast<double>(i) / kPieces;
      const double at = map.y.logarithmic ? y.front() * std::pow(y.back() / y.front(), t)
                                          : y.front() + t * (y.back() - y.front());
      points.push_back({x_of(scene_at(scene, map.number, map.method, x.front(), at)), at});
    }
    add(label, points);
  };
  if (map.number == LimitNumber::graze) {
    if (map.method != "event")
      along_y("overlap lasts a step", [&](const PointScene& point) {
        const BodyState& start = point.starts.front();
        const double gap =
            (start.x + 1.5 * point.gate.body.radius) / point.gate.body.radius;  // 1 - y
        return 2.0 * point.gate.body.radius * std::sqrt(1.0 - gap * gap) / start.vy;
      });
    return found;
  }
  if (map.method == "paper")
    along_y("explicit Euler, free beams",
            [](const PointScene& point) { return euler_bound(point.gate); });
  if (map.method == "penalty")
    along_y("semi-implicit Euler, free beams",
            [](const PointScene& point) { return semi_implicit_bound(point.gate); });
  // Only steps that fit into a hold of the random force are accepted.
  std::vector<std::array<double, 2>> points;
  if (map.y.logarithmic && map.method != "paper")
    for (const double at : x) points.push_back({at, refused_above(scene, map, at)});
  add("refused above", points);
  return found;
}

}  // namespace gatewalk::dynamics
