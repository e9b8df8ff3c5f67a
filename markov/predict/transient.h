// SPDX-License-Identifier: MIT
#pragma once
/// The equations of walks from a start without a limit of cells: the reached (cell, input) pairs
/// and what each passes on. For solvers that go pair by pair.

#include <cstdint>
#include <optional>
#include <vector>

#include "markov/predict.h"
#include "markov/predict/block_elimination.h"

namespace gatewalk::markov {

struct Transient : PassedOn {
  /// Makes the equations. The start's row must be sampled.
  Transient(const FieldChain& chain, const Field& field, const Start& start);

  std::vector<std::int64_t> states;  // cell * n_in + input, in the order in which walks reach them

  /// The final distribution of walks with these expected draws in each state, without remainder and
  /// rounding.
  [[nodiscard]] FinalDistribution ended(const std::vector<double>& draws, const FieldChain& chain,
                                        const Field& field) const;
};

/// Whether a field has few enough (cell, input) pairs to be solved pair by pair.
[[nodiscard]] bool fits_pair_by_pair(const FieldChain& chain, const Field& field);

struct ExpectedDraws {
  std::vector<double> by_state;
  double endless = 0.0;     // share of walks that can never end; their draws are not counted
  double operations = 0.0;  // number of products
};
/// The expected draws of walks that begin in the first state, block by block. Returns nullopt if
/// more than `most_operations` products are needed.
[[nodiscard]] std::optional<ExpectedDraws> expected_draws(Transient& t, double most_operations);

}  // namespace gatewalk::markov
