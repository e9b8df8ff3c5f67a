// SPDX-License-Identifier: MIT
#pragma once
/// What a body does in each gate, as a file (JSON): made by `gatewalk plan`, run by `gatewalk
/// lattice`.

#include <cstddef>
#include <string>

#include "dynamics/cells/section.h"
#include "lattice/field/field_params.h"
#include "lattice/scene/cell_file.h"
#include "lattice/scene/scene.h"
#include "lattice/study/plan.h"

namespace gatewalk::cli {

/// What a policy is made for, but the start, on which it does not depend.
struct PolicyField {
  std::string kind;  // "scene" or "cell": what the text is called in the file
  std::string text;
  dynamics::Section section;  // of entries
  lattice::FieldParams field;
  std::size_t actions = 0;
  std::string source;  // for messages
};
[[nodiscard]] PolicyField policy_field(const lattice::Scene& scene);
/// `told`: lines of what the program says of its cell while each action is taken.
[[nodiscard]] PolicyField policy_field(const lattice::CellFile& cells, const std::string& told);

/// Throws std::runtime_error for more actions, or more gates, than a file can hold.
void require_file_for(const PolicyField& made_for);
/// Text of the file: what it is made for, with its actions, the trees of ways to enter, a letter
/// for the action in each state (gates by row and column, with a limit of gates also by how many
/// were passed). Throws std::runtime_error for more than a file can hold.
[[nodiscard]] std::string policy_text(const lattice::Policy& policy, const PolicyField& made_for);

/// Throws markov::BadFile for a file that is damaged, and for one that was made for something that
/// differs in anything but the start.
[[nodiscard]] lattice::Policy read_policy(const std::string& path, const PolicyField& made_for);

}  // namespace gatewalk::cli
