// SPDX-License-Identifier: MIT
#pragma once
/// A field's chain listed state by state, for programs that know no fields (PRISM, Storm, anything
/// that reads a sparse matrix).

#include <array>
#include <cstdint>
#include <vector>

#include "markov/chain.h"

namespace gatewalk::markov {

/// A discrete-time chain. State 0 is the start. The transient states are followed by one absorbing
/// state for each Ending: state ends() + e for ending number e.
struct ExplicitChain {
  /// A transient state: a walk has made `draws` draws (0 without a limit of cells) and enters cell
  /// (column, row) in this input state.
  struct State {
    std::int32_t column, row, input, draws;
  };
  std::vector<State> states;         // transient states, in the order in which walks reach them
  std::vector<std::int64_t> first;   // (size() + 1) index of each state's first transition
  std::vector<std::int64_t> target;  // (transitions), ascending within a state
  std::vector<double> probability;   // (transitions), one sum for each target

  [[nodiscard]] std::int64_t ends() const { return std::ssize(states); }
  [[nodiscard]] std::int64_t size() const { return ends() + static_cast<std::int64_t>(kEndings); }
};

/// Lists all states that walks from the start reach. With a limit of cells, the number of draws is
/// part of the state, which multiplies the number of states. Throws as validate(), and
/// std::invalid_argument for more than `most` states.
[[nodiscard]] ExplicitChain explicit_chain(const FieldChain& chain, const Field& field,
                                           const Start& start, int max_cells,
                                           std::int64_t most = 100'000'000);

}  // namespace gatewalk::markov
