// SPDX-License-Identifier: MIT
#pragma once
/// Trials of the full dynamics through a field, of a scene or of cells that another program carries
/// out.

#include "cli/command.h"
#include "cli/render/field_runs.h"
#include "lattice/scene/recording.h"

namespace gatewalk::cli {

/// The scene's gates, in which bodies do what the file of --policy says, and what they may do.
struct PolicyGates {
  lattice::ChosenGates gates;
  ActionMethods may_do;
};
[[nodiscard]] PolicyGates policy_gates(const Options& options, const lattice::Scene& scene);
/// As --trials says; writes the tables of --passages and --cell-file.
[[nodiscard]] FieldRun field_run(const Options& options);

}  // namespace gatewalk::cli
