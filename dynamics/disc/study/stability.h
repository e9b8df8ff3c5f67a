// SPDX-License-Identifier: MIT
#pragma once
/// Where each method breaks: maps over two numbers of the scene, every point a few short trials,
/// judged by the worst that they showed.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dynamics/base/work.h"
#include "dynamics/disc/study/verdict.h"

namespace gatewalk::dynamics {

/// The default gate (k = 400 N m/rad, d = 50 N m s/rad), F = 8 N, Rm = 20 N; the disc comes from
/// 10 m below the beams at 15 m/s, unless the map says otherwise. 3 s a trial. Where the map does
/// not vary it, the step is the default for `stable` and kPaperStep for the others; the tolerance
/// of `event` is the default.
enum class MapKind : std::uint8_t {
  step_stiffness,  // both beams equally stiff
  step_damping,
  restitution_threshold,  // the threshold is an impulse in N s
  lever_speed,            // first contact at this distance from the joint, at this speed, at once
  grazing_speed,          // past a tip, closest approach R (1 + delta), at this speed; no forces
};
inline constexpr int kMapKinds = 5;

/// One axis of a map. The method `event` has a tolerance where the others have a step.
struct MapAxis {
  std::string_view name;       // "stiffness_Nm_per_rad", for files
  std::string_view label;      // "stiffness (N m/rad)", for people
  std::vector<double> values;  // ascending, but grazing's
  bool logarithmic = true;     // a first value 0 stands below the others
};

struct StabilityMap {
  MapKind kind = MapKind::step_stiffness;
  std::string_view name;  // "step_stiffness"
  std::string_view title;
  std::string method;
  MapAxis x, y;
};

/// The map of one kind for one method. `quick` takes about every third value.
[[nodiscard]] StabilityMap stability_map(MapKind kind, std::string_view method, bool quick);

/// One point of a map.
struct MapPoint {
  Verdict verdict = Verdict::refused;
  Health health;
  std::int64_t out_of_work = 0;  // trials that took more than kMostWorkPerPoint between them
};

/// Trials of a point, and the steps or evaluations granted to all of them together: below 1 s of
/// work. What takes more is stuck.
inline constexpr int kTrialsPerPoint = 8;
inline constexpr std::int64_t kMostWorkPerPoint = 2'000'000;

/// Runs the point (x, y) of a map. Trial numbers name the random force: the same at every point.
[[nodiscard]] MapPoint run_point(MapKind kind, std::string_view method, double x, double y,
                                 std::uint64_t seed);

/// A map with all its points run.
struct FinishedMap {
  StabilityMap map;
  std::vector<MapPoint> points;  // (y x x): row after row
  std::vector<double> seconds;   // that each point took

  [[nodiscard]] const MapPoint& at(std::size_t ix, std::size_t iy) const {
    return points[iy * map.x.values.size() + ix];
  }
  /// Points of this verdict.
  [[nodiscard]] std::int64_t count(Verdict v) const;
};

/// Runs every point of the map, on all threads of the current TBB arena; the same for any number of
/// them, but for the seconds.
[[nodiscard]] FinishedMap run_map(const StabilityMap& map, std::uint64_t seed,
                                  const Work& work = {});

struct StabilityOptions {
  bool quick = false;  // coarser maps
  std::uint64_t seed = 1;
};
/// Every kind of map, and of each kind one for every method of chart_methods(), in that order.
[[nodiscard]] std::vector<StabilityMap> stability_maps(bool quick);
/// Runs them all.
[[nodiscard]] std::vector<FinishedMap> run_maps(const StabilityOptions& options,
                                                const Work& work = {});

// ---- Borders known without running anything ----

/// Longest step (s) with which semi-implicit Euler does not blow up a free beam:
/// h^2 k/I + 2 h d/I = 4.
[[nodiscard]] double semi_implicit_bound(const GateParams& p);

/// A border as points (x, y) of a map, drawn as a line.
struct Border {
  std::string label;
  std::vector<double> x, y;
};
/// Of the maps over the step: the stability bounds of free beams for `paper` and `penalty`, and for
/// every method where it begins to refuse.
[[nodiscard]] std::vector<Border> borders(const StabilityMap& map);

}  // namespace gatewalk::dynamics
