// SPDX-License-Identifier: MIT
#pragma once
/// Trials of the full dynamics through a field, of a scene or of cells that another program carries
/// out.

#include <optional>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/render/choice.h"
#include "cli/render/field_runs.h"
#include "lattice/exits.h"
#include "lattice/field_costs.h"
#include "lattice/scene/recording.h"

namespace gatewalk::cli {

/// Trials through the field, and what they are of.
struct FieldRun {
  ShownField shown;
  dynamics::Entry start;
  Json made_by;
  lattice::FieldCosts costs;
  lattice::ExitCounts exits;
  std::optional<RunScene> scene{};  // of gates
  lattice::FieldTally tally;
  ActionMethods may_do{};  // under a policy
};
/// The scene's gates, in which bodies do what the file of --policy says, and what they may do.
struct PolicyGates {
  lattice::ChosenGates gates;
  ActionMethods may_do;
};
[[nodiscard]] PolicyGates policy_gates(const Options& options, const lattice::Scene& scene);
/// As --trials says; writes the tables of --passages and --cell-file.
[[nodiscard]] FieldRun field_run(const Options& options);

}  // namespace gatewalk::cli
