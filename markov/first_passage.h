// SPDX-License-Identifier: MIT
#pragma once
/// First passages: how likely walks are to reach cells, states or an ending, from every state of
/// every cell, and how long those that do are on their way.

#include <cstdint>
#include <optional>
#include <vector>

#include "markov/chain.h"
#include "markov/totals.h"

namespace gatewalk::markov {

/// What is to be reached: an ending; else a state, in one cell or in any, or a cell, in any state.
struct PassageTarget {
  std::optional<Ending> ending{};
  std::optional<std::int64_t> cell{};  // row * columns + column
  std::optional<int> input{};

  [[nodiscard]] bool holds(std::int64_t at, int state) const {
    return !ending && cell.value_or(at) == at && input.value_or(state) == state;
  }
};

/// (rows x columns x inputs) each. Means are over the walks that reach the target, until they enter
/// it or have ended so; not a number where none does. A walk in the target has reached it: 1, and 0
/// draws.
struct FirstPassages {
  int columns = 0, rows = 0, inputs = 0;
  std::vector<double> chance;               // the committor
  std::vector<double> never_sampled;        // chance to enter a row never sampled before
  std::vector<double> draws;                // mean
  std::vector<std::vector<double>> totals;  // mean of each quantity of the rewards

  [[nodiscard]] std::size_t at(const Start& s) const {
    return static_cast<std::size_t>((std::int64_t{s.row} * columns + s.column) * inputs + s.input);
  }
};

/// Of walks that start there and may visit so many cells (0: no limit). With a limit by the
/// backward recursion, exact. Without it by elimination of all (cell, state) pairs in the
/// order of solve_directly(): nothing is subtracted, so every number is
/// right to some n roundings of its own size. Larger fields go by sweeps, row by row where no move
/// leads to a row below, until numbers change by no more than 1e-13 of themselves and no more than
/// 1e-13 of the walks are on their way. `rewards`: as of walk_totals, not negative. Throws
/// std::invalid_argument as validate(), for a target that is not in the field, rewards that do not
/// belong to the chain, and above 4 GiB; std::runtime_error where walks circle so long that 10^5
/// sweeps do not do, and elimination takes too much. On all threads of the current TBB arena.
[[nodiscard]] FirstPassages first_passages(const FieldChain& chain, const Field& field,
                                           const PassageTarget& target, int max_cells,
                                           const Rewards& rewards = {});

}  // namespace gatewalk::markov
