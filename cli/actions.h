// SPDX-License-Identifier: MIT
#pragma once
/// What bodies may do in a field: tables [actions] of a scene, or of a file of cells that a program
/// carries out.

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

/// In the order of their names.
struct Actions {
  std::vector<lattice::Scene> scenes{};                    // of gates: while each is taken
  std::vector<lattice::Action> actions{};                  // with problems of these, from a start
  std::vector<std::optional<lattice::Settled>> methods{};  // where a scene leaves them to a pilot
  PolicyField made_for{};

  [[nodiscard]] std::vector<std::string> names() const;
};
/// Throws UsageError for fewer than two.
[[nodiscard]] Actions actions_of(const Options& options, const lattice::Scene& scene,
                                 const dynamics::Entry& start);
/// Of a scene, or of cells of a program, from its start. Throws UsageError also for numbers that
/// the program does not have, or does not permit.
[[nodiscard]] Actions actions_of(const Options& options, const lattice::Source& s);

/// Of the field's policies, before there are any: as of a PolicyField.
void require_file_for(const lattice::Source& s);

}  // namespace gatewalk::cli
