// SPDX-License-Identifier: MIT
#pragma once
/// Where each method breaks near the numbers of a scene: maps over a method's step and one number
/// of the scene, and how far the scene is from the nearest faults.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dynamics/base/work.h"
#include "dynamics/disc/study/accuracy.h"

namespace gatewalk::dynamics {

/// What varies beside the step. `lever` and `graze` place the body so that its first contact is
/// near a joint, or a tip only grazes it.
enum class LimitNumber : std::uint8_t {
  stiffness,  // of both beams, by one factor; named by that of the stiffer one
  damping,
  beam_mass,
  random_force,
  speed,  // of the start; velocities change by one factor
  restitution,
  impulse_threshold,
  lever,  // distance of the first contact from the left joint, as a share of the beam
  graze,  // the closest approach to the left tip is R (1 - graze), without forces
};

struct LimitNumberInfo {
  LimitNumber number;
  std::string_view name;   // "stiffness"
  std::string_view words;  // "mass of a beam"
  std::string_view unit;   // "N m/rad"; "1" of a pure number
  std::string_view label;  // of an axis: "stiffness (N m/rad)"
};
/// All of them, in the order of LimitNumber.
[[nodiscard]] std::span<const LimitNumberInfo> limit_numbers();

struct LimitOptions {
  bool quick = false;         // coarser maps
  std::int64_t trials = 100;  // of a point; 1 where nothing is random
  bool own_step = false;      // run.step is the scene's; else each method has its default
  std::uint64_t seed = 1;
};

/// One axis of a map. The method `event` has a tolerance where the others have a step.
struct MapAxis {
  std::string_view name, unit, label;
  std::vector<double> values;  // ascending
  bool logarithmic = true;
  std::optional<std::size_t> own{};  // which of the values is the scene's
  std::size_t from = 0;  // from which the nearest faults are looked for: own, or the mildest value
};

struct LimitMap {
  LimitNumber number = LimitNumber::stiffness;
  std::string method;
  MapAxis x, y;  // step or tolerance; the number
};

/// One point of a map.
struct MapPoint {
  Verdict verdict = Verdict::refused;
  Health health;
  std::int64_t out_of_work = 0;  // trials that took more than was granted
};

/// A scene whose limits are charted, with what is asked.
struct LimitScene {
  GateParams gate;
  BodyState start;
  LimitOptions options;
};

/// The maps of a scene: for every number that it has (not the damping of undamped beams, nor the
/// speed of a start at rest) one for each method of chart_methods(), in that order.
[[nodiscard]] std::vector<LimitMap> limit_maps(const LimitScene& scene);

/// What is run at a point: the gate, and from where. All trials of a point have the random force of
/// their number, the same at every point.
struct PointScene {
  GateParams gate;
  std::vector<BodyState> starts;  // of which the trials are shared out
  std::int64_t trials = 1;
  std::optional<bool> must_hit{};  // whether the body must be deflected, where that is known
};
[[nodiscard]] PointScene scene_at(const LimitScene& scene, LimitNumber number,
                                  std::string_view method, double x, double y);

/// Runs a point. Its verdict is the worst that any trial showed, as `gate` reports it; outcomes are
/// held against those of `reference`, the same trials of a better method, unless it is empty.
[[nodiscard]] MapPoint run_point(const PointScene& point, std::uint64_t seed,
                                 std::span<const TrialEnd> reference = {});

/// A map with all its points run.
struct FinishedMap {
  LimitMap map;
  std::vector<MapPoint> points;  // (y x x): row after row
  std::vector<double> seconds;   // that each point took

  [[nodiscard]] const MapPoint& at(std::size_t ix, std::size_t iy) const {
    return points[iy * map.x.values.size() + ix];
  }
  /// Points of this verdict.
  [[nodiscard]] std::int64_t count(Verdict v) const;
};

/// Runs every point of the maps, on all threads of the current TBB arena; the same for any number
/// of them, but for the seconds.
[[nodiscard]] std::vector<FinishedMap> run_maps(const LimitScene& scene, std::vector<LimitMap> maps,
                                                const Work& work = {});

// ---- How far from the scene ----

/// A way out of a fault: another step (or tolerance), another method, or both.
struct Remedy {
  std::string key{};  // "run.step_s", "run.event_tolerance_m"; empty: the method's own
  double value = 0.0;
  std::string method{};  // empty: the same
};

/// The nearest fault of a method along one axis, with all else as in the scene. First contacts near
/// a joint and grazes are looked at from the mildest on.
struct Limit {
  MapAxis axis;  // "step", "stiffness", ...
  std::optional<double>
      fine_to{};  // the last value without fault on the way; none: the first has one
  std::optional<double> fault_at{};  // none: no fault within the map
  Verdict verdict = Verdict::fine;   // at fault_at
  std::optional<Remedy> remedy{};

  /// fault_at as a multiple of the scene's value; none where either is missing.
  [[nodiscard]] std::optional<double> factor() const;
};

struct MethodLimits {
  std::string method;
  Setting own;                         // in this scene
  Verdict verdict = Verdict::refused;  // of the scene itself
  Health health;
  std::vector<Limit> limits;  // the step first

  /// The one whose factor is nearest to 1; null: none has one.
  [[nodiscard]] const Limit* nearest() const;
};
/// One for each method, of run_maps' result.
[[nodiscard]] std::vector<MethodLimits> limits_of(const LimitScene& scene,
                                                  std::span<const FinishedMap> maps);

// ---- Borders known without running anything ----

/// Longest step (s) with which semi-implicit Euler does not blow up a free beam:
/// h^2 k/I + 2 h d/I = 4.
[[nodiscard]] double semi_implicit_bound(const GateParams& p);

/// A border as points (x, y) of a map, drawn as a line.
struct Border {
  std::string label;
  std::vector<double> x, y;
};
/// The stability bounds of free beams for `paper` and `penalty`; where a method begins to refuse;
/// and how deep a graze must be for its overlap to last a step.
[[nodiscard]] std::vector<Border> borders(const LimitScene& scene, const LimitMap& map);

}  // namespace gatewalk::dynamics
