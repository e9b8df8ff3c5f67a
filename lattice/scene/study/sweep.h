// SPDX-License-Identifier: MIT
#pragma once
/// Runs one gate over a grid of scene keys.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/base/work.h"
#include "dynamics/disc/ensemble.h"
#include "lattice/scene/settle.h"
#include "lattice/scene/toml_file.h"

namespace gatewalk::lattice {

/// A varied key, and its values as text, in the form of overrides.
struct SweepAxis {
  std::string key;
  std::vector<std::string> values;
  std::string origin{};  // how a message about this axis begins
};

/// The axes of a sweep: the scene's own variations, extended and replaced by `given`. Each is
/// "KEY=4:1:9" (4, 5, ... 9), "KEY=4:9" (in steps of 1) or "KEY=4,7,9". Throws SceneError for what
/// cannot be read, a key varied twice and more than 100 000 points; std::invalid_argument if
/// nothing is varied.
[[nodiscard]] std::vector<SweepAxis> sweep_axes(const std::vector<Variation>& own,
                                                const std::vector<std::string>& given);

/// One point of the grid.
struct SweepPoint {
  std::vector<std::string> values;  // by axis
  Scene scene;
  std::optional<Settled> settled;  // set if the point's method is "auto"
  dynamics::GateTally tally;
};

/// A scene file, and the axes along which it is varied.
struct SweepPlan {
  TomlFile file;
  std::vector<std::string> overrides;
  std::vector<SweepAxis> axes;
};

/// All combinations of values, the last axis running fastest, not yet run. Throws SceneError for
/// values that a key does not permit.
[[nodiscard]] std::vector<SweepPoint> sweep_points(const SweepPlan& plan);

/// Runs the gate at each point, under the same noise. `settled` is called for each point once its
/// method is chosen, before it is run.
void run_sweep(std::vector<SweepPoint>& points, dynamics::TrialRange trials, std::uint64_t seed,
               const dynamics::Work& work = {},
               const std::function<void(const SweepPoint&)>& settled = {});

}  // namespace gatewalk::lattice
