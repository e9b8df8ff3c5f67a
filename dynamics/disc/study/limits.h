// SPDX-License-Identifier: MIT
#pragma once
/// Where each method fails near a scene: maps of faults over a method's step and one number of the
/// scene, and the distance of the scene from the nearest faults.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dynamics/base/work.h"
#include "dynamics/disc/study/accuracy.h"

namespace gatewalk::dynamics {

/// The number of the scene that a map varies beside the step. `lever` and `graze` place the body so
/// that its first contact is near a joint, or that a tip only grazes it.
enum class LimitNumber : std::uint8_t {
  stiffness,  // both beams by one factor; the value is that of the stiffer beam
  damping,
  beam_mass,
  random_force,
  speed,  // speed of the start; both velocities change by one factor
  restitution,
  impulse_threshold,
  lever,  // distance of the first contact from the left joint / beam length
  graze,  // closest approach to the left tip: R (1 - graze), without forces
};

struct LimitNumberInfo {
  LimitNumber number;
  std::string_view name;   // "stiffness"
  std::string_view words;  // "mass of a beam"
  std::string_view unit;   // "N m/rad"; "1" for a pure number
  std::string_view label;  // label of an axis: "stiffness (N m/rad)"
};
/// The table of all numbers, in the order of LimitNumber.
[[nodiscard]] std::span<const LimitNumberInfo> limit_numbers();

struct LimitOptions {
  bool quick = false;         // coarser maps
  std::int64_t trials = 100;  // trials of a point; 1 if nothing is random
  bool own_step = false;      // keep the scene's run.step; else each method has its default
  std::uint64_t seed = 1;
};

/// An axis of a map. Method `event` has a tolerance where other methods have a step.
struct MapAxis {
  std::string_view name, unit, label;
  std::vector<double> values;  // ascending
  bool logarithmic = true;
  std::optional<std::size_t> own{};  // index of the scene's own value
  std::size_t from = 0;  // index where the search for faults begins: own, or the mildest value
};

struct LimitMap {
  LimitNumber number = LimitNumber::stiffness;
  std::string method;
  MapAxis x, y;  // x: step or tolerance; y: the number of the scene
};

/// One point of a map.
struct MapPoint {
  Verdict verdict = Verdict::refused;
  Health health;
  std::int64_t out_of_work = 0;  // trials that reached the limit of work
};

/// A scene whose limits are charted, with the options.
struct LimitScene {
  GateParams gate;
  BodyState start;
  LimitOptions options;
};

/// The maps of a scene: for every number that the scene has (not the damping of undamped beams, nor
/// the speed of a start at rest), one map for each method of chart_methods(), in that order.
[[nodiscard]] std::vector<LimitMap> limit_maps(const LimitScene& scene);

/// The trials of one point: the gate and the starts. The random force of a trial depends on its
/// number, so it is the same at every point.
struct PointScene {
  GateParams gate;
  std::vector<BodyState> starts;  // trials are divided evenly over the starts
  std::int64_t trials = 1;
  std::optional<bool> must_hit{};  // whether the body must be deflected; none: unknown
};
[[nodiscard]] PointScene scene_at(const LimitScene& scene, LimitNumber number,
                                  std::string_view method, double x, double y);

/// Runs a point. The verdict is the worst fault of any trial, as `gate` reports it. Unless
/// `reference` is empty, outcomes are compared with it: the same trials by a better method.
[[nodiscard]] MapPoint run_point(const PointScene& point, std::uint64_t seed,
                                 std::span<const TrialEnd> reference = {});

/// A map with the results of all its points.
struct FinishedMap {
  LimitMap map;
  std::vector<MapPoint> points;  // (y x x): row after row
  std::vector<double> seconds;   // time of each point

  [[nodiscard]] const MapPoint& at(std::size_t ix, std::size_t iy) const {
    return points[iy * map.x.values.size() + ix];
  }
  /// The number of points with this verdict.
  [[nodiscard]] std::int64_t count(Verdict v) const;
};

/// Runs every point of the maps on all threads of the current TBB arena. The results, apart from
/// the seconds, are the same for any number of threads.
[[nodiscard]] std::vector<FinishedMap> run_maps(const LimitScene& scene, std::vector<LimitMap> maps,
                                                const Work& work = {});

// ---- Distance from the scene to the faults ----

/// A remedy for a fault: another step (or tolerance), another method, or both.
struct Remedy {
  std::string key{};  // "run.step_s", "run.event_tolerance_m"; empty: the default
  double value = 0.0;
  std::string method{};  // empty: the same method
};

/// The nearest fault of a method along one axis, with all else as in the scene. For first contacts
/// near a joint and for grazes, the search begins at the mildest value.
struct Limit {
  MapAxis axis;                      // "step", "stiffness", ...
  std::optional<double> fine_to{};   // last value without a fault; none: the first has one
  std::optional<double> fault_at{};  // nearest value with a fault; none: no fault in the map
  Verdict verdict = Verdict::fine;   // at fault_at
  std::optional<Remedy> remedy{};

  /// fault_at as a multiple of the scene's value; none if either is missing.
  [[nodiscard]] std::optional<double> factor() const;
};

struct MethodLimits {
  std::string method;
  Setting own;                         // the setting in this scene
  Verdict verdict = Verdict::refused;  // verdict on the scene itself
  Health health;
  std::vector<Limit> limits;  // one for each axis; the step first

  /// The limit whose factor is nearest to 1; null if no limit has a factor.
  [[nodiscard]] const Limit* nearest() const;
};
/// The limits of each method, from the maps of run_maps.
[[nodiscard]] std::vector<MethodLimits> limits_of(const LimitScene& scene,
                                                  std::span<const FinishedMap> maps);

// ---- Borders known in closed form ----

/// The longest step (s) for which semi-implicit Euler is stable for a free beam: h^2 k/I + 2 h d/I
/// = 4.
[[nodiscard]] double semi_implicit_bound(const GateParams& p);

/// A border in a map, drawn as a line through points (x, y).
struct Border {
  std::string label;
  std::vector<double> x, y;
};
/// The borders in a map: the stability bounds of free beams for `paper` and `penalty`; where a
/// method begins to refuse; how deep a graze must be for its overlap to last a step.
[[nodiscard]] std::vector<Border> borders(const LimitScene& scene, const LimitMap& map);

}  // namespace gatewalk::dynamics
