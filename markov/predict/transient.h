// SPDX-License-Identifier: MIT
#pragma once
/// The walks from a start without limit of cells, as equations: (cell, input) pairs that are
/// reached, and what each passes on. For the two solvers that go pair by pair.

#include <cstdint>
#include <vector>

#include "markov/predict.h"

namespace gatewalk::markov {

struct Transient {
  /// The start's row must have been sampled.
  Transient(const FieldChain& chain, const Field& field, const Start& start);

  std::vector<std::int64_t> states;  // cell * n_in + input, in the order they are reached
  // I - Q, transposed, in compressed columns: column s holds what state s passes on, after itself.
  std::vector<std::int64_t> begin{0};
  std::vector<std::int64_t> index;
  std::vector<double> value;
  std::vector<double> ends;  // chance that a draw of s ends the walk

  /// What ends of walks that make so many draws in each state; without remainder and rounding.
  [[nodiscard]] FinalDistribution ended(const std::vector<double>& draws, const FieldChain& chain,
                                        const Field& field) const;
};

}  // namespace gatewalk::markov
