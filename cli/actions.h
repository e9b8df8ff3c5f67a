// SPDX-License-Identifier: MIT
#pragma once
/// The actions among which a body chooses in a field: tables [actions] of a scene, or of a file of
/// cells that a program simulates.

#include <optional>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/exchange/policy_file.h"
#include "cli/source_options.h"
#include "lattice/scene/scene.h"
#include "lattice/scene/settle.h"
#include "lattice/study/plan.h"

namespace gatewalk::cli {

/// The actions of a field, in the order of their names.
struct Actions {
  std::vector<lattice::Scene> scenes{};                    // of gates: the scene under each
  std::vector<lattice::Action> actions{};                  // each with its cells, map and start
  std::vector<std::optional<lattice::Settled>> methods{};  // if chosen by a pilot
  PolicyField made_for{};

  [[nodiscard]] std::vector<std::string> names() const;
};
/// The actions of a scene of gates, with bodies that start at `start`. Throws UsageError for fewer
/// than two actions.
[[nodiscard]] Actions actions_of(const Options& options, const lattice::Scene& scene,
                                 const dynamics::Entry& start);
/// Throws std::runtime_error if the field, or its number of actions, is too large for a policy
/// file. To be called before any work.
[[nodiscard]] Actions actions_of(const Options& options, const lattice::Source& s);

/// Throws std::runtime_error for a field that is too large for a policy file. Needs no actions, so
/// that it can run before any work.
void require_file_for(const lattice::Source& s);

}  // namespace gatewalk::cli
