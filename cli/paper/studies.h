// SPDX-License-Identifier: MIT
#pragma once
/// The studies behind the paper's figures and claims: which commands are run.

#include <functional>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/paper/findings.h"
#include "dynamics/disc/params.h"

namespace gatewalk::cli {

/// A command of this program, as the report prints it. Its result goes to data/NAME.json.
struct Study {
  std::string name;
  int (*run)(const Arguments& arguments) = nullptr;
  std::string command;                 // "sweep"
  std::vector<std::string> arguments;  // without --json and --quiet
  std::int64_t cost = 1;               // expected time in 0.01 s, to estimate the time left
  /// Takes what the report needs from the result. Throws as findings.h; null: takes nothing.
  std::function<void(Findings&, const Json&)> take = nullptr;

  [[nodiscard]] std::string text() const;  // "gatewalk sweep scenes/fig8.toml ..."
};

/// All studies, in the order in which they are run.
[[nodiscard]] std::vector<Study> paper_studies(bool quick);

/// KEY=VALUE for --set; an integer value has no fraction.
[[nodiscard]] std::string set(const char* key, double value);
/// The gate's parameters in a scene that the program carries.
[[nodiscard]] dynamics::GateParams gate_of(const char* scene,
                                           const std::vector<std::string>& overrides = {});
/// Points of the grids of Figs. 8 and 12.
[[nodiscard]] const PaperPoint& fig8_at(const Findings& f, double damping, double force,
                                        double random);
[[nodiscard]] const PaperPoint& fig12_at(const Findings& f, double damping, double force,
                                         double random, double k_left);
inline constexpr char kDamping[] = "beams.damping_Nms_per_rad";
inline constexpr char kPropulsion[] = "forces.propulsion_N";
inline constexpr char kRandom[] = "forces.random_N";
inline constexpr char kLeftStiffness[] = "beams.stiffness_left_Nm_per_rad";
inline constexpr char kRightStiffness[] = "beams.stiffness_right_Nm_per_rad";

}  // namespace gatewalk::cli
