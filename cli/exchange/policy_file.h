// SPDX-License-Identifier: MIT
#pragma once
/// A policy, which says what a body does in each gate, as a JSON file. `gatewalk plan` writes it,
/// `gatewalk lattice` runs it.

#include <cstddef>
#include <string>

#include "dynamics/cells/section.h"
#include "lattice/field/field_params.h"
#include "lattice/scene/cell_file.h"
#include "lattice/scene/scene.h"
#include "lattice/study/plan.h"

namespace gatewalk::cli {

/// The scene or cells for which a policy is made, without the start, on which a policy does not
/// depend.
struct PolicyField {
  std::string kind;  // "scene" or "cell", the text's key in the file
  std::string text;
  dynamics::Section section;  // of entries
  lattice::FieldParams field;
  std::size_t actions = 0;
  std::string source;  // file name for messages
};
[[nodiscard]] PolicyField policy_field(const lattice::Scene& scene);
/// `told`: a line for each action with the program's description of its cell under this action.
[[nodiscard]] PolicyField policy_field(const lattice::CellFile& cells, const std::string& told);

/// Throws std::runtime_error for more actions or gates than a policy file can hold.
void require_file_for(const PolicyField& made_for);
/// The text of a policy file: the scene or cells with their actions, the trees of entries, and a
/// letter for the action in each state. Gates stand by row and column; with a limit of gates, also
/// by the number of gates passed. Throws std::runtime_error if the policy is too large for a file.
[[nodiscard]] std::string policy_text(const lattice::Policy& policy, const PolicyField& made_for);

/// Reads a policy file. Throws markov::BadFile for a damaged file, and for a policy that was made
/// for a scene or cells that differ in more than the start.
[[nodiscard]] lattice::Policy read_policy(const std::string& path, const PolicyField& made_for);

}  // namespace gatewalk::cli
