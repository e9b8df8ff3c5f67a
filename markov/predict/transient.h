// SPDX-License-Identifier: MIT
#pragma once
/// The walks from a start without limit of cells, as equations: (cell, input) pairs that are
/// reached, and what each passes on. For the two solvers that go pair by pair.

#include <cstdint>
#include <vector>

#include "markov/predict.h"
#include "markov/predict/block_elimination.h"

namespace gatewalk::markov {

struct Transient : PassedOn {
  /// The start's row must have been sampled.
  Transient(const FieldChain& chain, const Field& field, const Start& start);

  std::vector<std::int64_t> states;  // cell * n_in + input, in the order they are reached

  /// What ends of walks that make so many draws in each state; without remainder and rounding.
  [[nodiscard]] FinalDistribution ended(const std::vector<double>& draws, const FieldChain& chain,
                                        const Field& field) const;
};

}  // namespace gatewalk::markov
