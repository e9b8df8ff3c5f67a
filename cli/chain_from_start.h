// SPDX-License-Identifier: MIT
#pragma once
/// The chain of a matrix together with the state in which bodies start, as walk and export need it.

#include "cli/render/start.h"
#include "cli/source_options.h"
#include "markov/chain.h"

namespace gatewalk::cli {

struct StartedChain {
  markov::FieldChain chain;
  markov::Start start;
  std::optional<ShownState> state;  // the state in which bodies start; none for recorded runs
  bool clean;                       // whether the runs behind the chain showed no faults
  dynamics::StateSpace space;       // states of the chain; a recorded start has a row after them
};

/// The chain of a matrix of a scene, of recorded runs or of an import. For a start that a scene's
/// matrix lacks, gate runs are simulated and added, and a remark says so. Throws UsageError.
[[nodiscard]] StartedChain chain_from_start(const Options& options, lattice::Source& s);

}  // namespace gatewalk::cli
