// SPDX-License-Identifier: MIT
#pragma once
/// The walks from a start without limit of cells, as equations: (cell, input) pairs that are
/// reached, and what each passes on. For the solvers that go pair by pair.

#include <cstdint>
#include <optional>
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

/// Whether a field has few enough pairs of a cell and an input to be solved pair by pair.
[[nodiscard]] bool fits_pair_by_pair(const FieldChain& chain, const Field& field);

struct ExpectedDraws {
  std::vector<double> by_state;
  double endless = 0.0;     // share of the walks that can never end; their draws are not counted
  double operations = 0.0;  // products
};
/// Of walks that begin in the first state, block by block. None where it would take more than
/// `most_operations`.
[[nodiscard]] std::optional<ExpectedDraws> expected_draws(Transient& t, double most_operations);

}  // namespace gatewalk::markov
