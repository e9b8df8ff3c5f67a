// SPDX-License-Identifier: MIT
#pragma once
/// The chain that walks through a field draw from.

#include "cli/render/start.h"
#include "cli/subject.h"
#include "markov/chain.h"

namespace gatewalk::cli {

struct Walked {
  markov::FieldChain chain;
  markov::Start start;
  WalkStart from;
  bool clean;                  // the runs behind it
  dynamics::StateSpace space;  // of the chain's states; a start of its own is behind them
};

/// Of a matrix: of a scene, in which the start becomes a state (trials are added for one that it
/// does not know, which is said), or of recorded runs. Throws UsageError.
[[nodiscard]] Walked walked_chain(const Options& options, Subject& s);

}  // namespace gatewalk::cli
