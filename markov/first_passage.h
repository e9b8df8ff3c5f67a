// SPDX-License-Identifier: MIT
#pragma once
/// First passages: the probability that walks reach a cell, a state or an ending, from every state
/// of every cell, and the mean draws and totals of walks that reach it.

#include <cstdint>
#include <optional>
#include <vector>

#include "markov/chain.h"
#include "markov/totals.h"

namespace gatewalk::markov {

/// The target of first passages: an ending; or a state, in one cell or in any; or a cell, in any
/// state.
struct PassageTarget {
  std::optional<Ending> ending{};
  std::optional<std::int64_t> cell{};  // row * columns + column
  std::optional<int> input{};

  [[nodiscard]] bool holds(std::int64_t at, int state) const {
    return !ending && cell.value_or(at) == at && input.value_or(state) == state;
  }
};

/// First passages to a target from every state of every cell; each vector is (rows x columns x
/// inputs). Means are over the walks that reach the target, until they reach it; NaN if no walk
/// does. From the target itself the probability is 1 after 0 draws.
struct FirstPassages {
  int columns = 0, rows = 0, inputs = 0;
  std::vector<double> chance;               // probability to reach the target: the committor
  std::vector<double> never_sampled;        // probability to enter an unsampled row before
  std::vector<double> draws;                // mean
  std::vector<std::vector<double>> totals;  // mean total of each quantity of the rewards

  [[nodiscard]] std::size_t at(const Start& s) const {
    return static_cast<std::size_t>((std::int64_t{s.row} * columns + s.column) * inputs + s.input);
  }
};

/// Computes the first passages of walks that may visit `max_cells` cells (0: no limit). With a
/// limit, backward recursion is exact. Without one, all (cell, state) pairs are eliminated in the
/// order of solve_directly(). Nothing is subtracted, so the relative error of every number is about
/// n roundings. Larger fields are solved by sweeps, row by row if no move leads to a row below,
/// until no number changes by more than 1e-13 of itself and at most 1e-13 of the walks are under
/// way.
///
/// `rewards` are those of walk_totals, not negative. Runs on all threads of the current TBB arena.
/// Throws std::invalid_argument as validate() does, for a target outside the field, for rewards
/// that do not fit the chain, and above 4 GiB; std::runtime_error if walks circle so long that 10^5
/// sweeps do not suffice and elimination is too large.
[[nodiscard]] FirstPassages first_passages(const FieldChain& chain, const Field& field,
                                           const PassageTarget& target, int max_cells,
                                           const Rewards& rewards = {});

}  // namespace gatewalk::markov
