#pragma once
/// The states of a chain and how well they resolve a scene, as JSON and in words.

#include "cli/command.h"
#include "lattice/scene/bins.h"

namespace gatewalk::cli {

[[nodiscard]] Json to_json(const lattice::States& states);
/// A line of a table about a state space as to_json describes it; empty for null.
[[nodiscard]] std::string states_line(const Json& states);
/// Warns when the states resolve too little of what was seen, and of faults in a pilot that rows
/// start from.
void warn_if_poor(const lattice::States& states);

/// lattice::states_of for a command: warns when auto takes Table III's place.
[[nodiscard]] lattice::States states_of(const Options& options, const lattice::Scene& scene,
                                        const lattice::BinsChoice& choice,
                                        const std::vector<dynamics::BodyState>& starts);

}  // namespace gatewalk::cli
