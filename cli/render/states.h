// SPDX-License-Identifier: MIT
#pragma once
/// The states of a chain and how well they resolve a scene, as JSON and in words.

#include <string>
#include <vector>

#include "cli/render/json_fwd.h"
#include "lattice/pool/tree_chain.h"
#include "lattice/scene/bins.h"

namespace gatewalk::cli {

[[nodiscard]] Json to_json(const lattice::States& states);
[[nodiscard]] Json to_json(const lattice::TreeChain& chain, double accuracy);
/// A line of a table about a state space as to_json describes it; empty for null.
[[nodiscard]] std::string states_line(const Json& states);
/// What is wrong with them, a sentence each: too little of what was seen is resolved, faults in a
/// pilot that rows start from.
[[nodiscard]] std::vector<std::string> complaints(const lattice::States& states);

}  // namespace gatewalk::cli
