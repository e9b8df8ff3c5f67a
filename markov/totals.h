// SPDX-License-Identifier: MIT
#pragma once
/// What walks add up on their way: durations, works. A semi-Markov chain: each draw takes a random
/// time that depends on the state and on what is drawn.

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "markov/chain.h"
#include "markov/committor.h"
#include "markov/predict.h"

namespace gatewalk::markov {

/// One quantity that draws add to a walk's total: its mean and mean square for each nonzero of a
/// chain's matrix, in their order.
struct Reward {
  std::vector<double> mean, square;
};
/// The quantities of a field's chains: [chain][quantity].
using Rewards = std::vector<std::vector<Reward>>;

/// Mean and variance of a total over some of the walks.
struct Moments {
  double share = 0.0;              // of all walks
  double sum = 0.0, square = 0.0;  // of the total and of its square, over all walks
  [[nodiscard]] double mean() const {
    return share > 0.0 ? sum / share : std::numeric_limits<double>::quiet_NaN();
  }
  [[nodiscard]] double sd() const;
};

struct WalkTotals {
  std::array<double, kEndings> endings{};
  double remainder = 0.0;                 // still walking when the sum was stopped
  CellProbabilities visits;               // (rows x columns) expected draws in each cell
  std::array<Moments, kEndings> draws{};  // how many, by ending
  std::vector<std::array<Moments, kEndings>> totals{};  // by quantity and ending
  /// Walks drawn for the moments of `draws` and `totals`, which are exact where this is 0; the
  /// means of all walks together are exact in any case.
  std::int64_t drawn_walks = 0;

  /// Of all walks together.
  [[nodiscard]] static Moments all(const std::array<Moments, kEndings>& by_ending);
};

/// Told of all states that walks pass: `share` of the walks make their `draw`-th draw, from 1, in
/// this cell (row * columns + column) and state.
using EachState = std::function<void(int draw, std::int64_t cell, int input, double share)>;

/// Without limit of cells: which walks are followed no further (`remainder`).
struct WalkTolerance {
  double all = 1e-12;                    // that share of all walks ...
  const EndingChance* chance = nullptr;  // ... but of those that end so ...
  double of_target = 1e-9;               // ... only that share of them
  /// In large fields, of the visits in a row.
  double of_row = kRowTolerance;
  /// Fields with so many cells, times nonzeros of a cell's chain, are large: a second or two.
  double large = 1e7;
};

/// First and second moments, exact: propagated with the shares of the walks. With a limit of cells
/// step by step, as Solver::steps does; without, row by row, the draws of a walk are not told
/// apart (`each` is told of draw 1), and a row is left after 10^5 sweeps at the latest. Where moves
/// lead to a row below, step by step until no more than `tolerance.all` of the walks are on their
/// way, or 10^5 steps are done. Where walks circle so long that more are left, and states are few
/// (1000), all is found by elimination. In large fields without limit, whose rows are
/// of one type each, visits, endings and the means of all walks are exact to `tolerance.of_row` of
/// each row, the other moments those of walks drawn with `seed`: 2^16 of all, and, where
/// `tolerance.chance` is of fewer than 2^12 of these, so many of those that end so. Without rewards
/// no walks are drawn, and the moments of `draws` are not a number. Throws std::invalid_argument
/// when rewards do not belong to the chain, and as validate().
[[nodiscard]] WalkTotals walk_totals(const FieldChain& chain, const Field& field,
                                     const Start& start, int max_cells, const Rewards& rewards = {},
                                     const EachState& each = {},
                                     const WalkTolerance& tolerance = {}, std::uint64_t seed = 0);

/// How a walk ended, and its total of the first quantity.
struct TimedWalk {
  Ending ending = Ending::trapped;
  double total = 0.0;
};
/// Walks 0 .. count - 1: outputs as Walker draws them, and with each a value of the first quantity
/// that is gamma distributed with the moments of its nonzero, so that totals have the mean and the
/// variance of walk_totals. On all threads of the current TBB arena, the same for any number.
[[nodiscard]] std::vector<TimedWalk> timed_walks(const FieldChain& chain, const Field& field,
                                                 const Start& start, int max_cells,
                                                 const Rewards& rewards, std::int64_t count,
                                                 std::uint64_t seed);

}  // namespace gatewalk::markov
