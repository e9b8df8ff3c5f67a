// SPDX-License-Identifier: MIT
#pragma once
/// A field's chain written down state by state, for programs that know no fields (PRISM, Storm,
/// anything that reads a sparse matrix).

#include <array>
#include <cstdint>
#include <vector>

#include "markov/chain.h"

namespace gatewalk::markov {

/// Discrete time. State 0 is the start; behind all transient states there is one for each Ending,
/// which is never left: state ends() + e for ending number e.
struct ExplicitChain {
  /// A walk has drawn `draws` times (0 where cells are not limited) and enters cell (column, row)
  /// in this input state.
  struct State {
    std::int32_t column, row, input, draws;
  };
  std::vector<State> states;         // transient, in the order in which walks reach them
  std::vector<std::int64_t> first;   // (size() + 1): where a state's transitions begin
  std::vector<std::int64_t> target;  // (transitions), ascending within a state
  std::vector<double> probability;   // (transitions), those of one target added up

  [[nodiscard]] std::int64_t ends() const { return std::ssize(states); }
  [[nodiscard]] std::int64_t size() const { return ends() + static_cast<std::int64_t>(kEndings); }
};

/// Of all states that walks from the start reach. With a limit of cells the number of draws is part
/// of the state: as many times more states. Throws as validate(), and std::invalid_argument where
/// there are more than `most` states.
[[nodiscard]] ExplicitChain explicit_chain(const FieldChain& chain, const Field& field,
                                           const Start& start, int max_cells,
                                           std::int64_t most = 100'000'000);

}  // namespace gatewalk::markov
