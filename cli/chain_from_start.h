// SPDX-License-Identifier: MIT
#pragma once
/// The chain of a matrix and the state in which bodies start: walks draw from it, export writes it.

#include "cli/render/start.h"
#include "cli/source_options.h"
#include "markov/chain.h"

namespace gatewalk::cli {

struct StartedChain {
  markov::FieldChain chain;
  markov::Start start;
  std::optional<ShownState> state;  // in which bodies start; of recorded runs a row of their own
  bool clean;                       // the runs behind it
  dynamics::StateSpace space;       // of the chain's states; a start of its own is behind them
};

/// Of a matrix: of a scene, in which the start becomes a state (trials are added for one that it
/// does not know, which is said), or of recorded runs. Throws UsageError.
[[nodiscard]] StartedChain chain_from_start(const Options& options, lattice::Source& s);

}  // namespace gatewalk::cli
