// SPDX-License-Identifier: MIT
#pragma once
/// Totals that walks accumulate, such as duration or work, in a semi-Markov chain: each draw takes
/// a random time that depends on the state and on the output drawn.

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
/// The quantities of the chains of a field: [chain][quantity].
using Rewards = std::vector<std::vector<Reward>>;

/// The first two moments of a total over a group of the walks.
struct Moments {
  double share = 0.0;  // share of all walks that are in the group
  /// Means over all walks of the total and of its square, where walks outside the group count as 0.
  double sum = 0.0, square = 0.0;
  [[nodiscard]] double mean() const {
    return share > 0.0 ? sum / share : std::numeric_limits<double>::quiet_NaN();
  }
  [[nodiscard]] double sd() const;
};

struct WalkTotals {
  std::array<double, kEndings> endings{};
  double remainder = 0.0;                 // share of walks still going on when the sum was stopped
  CellProbabilities visits;               // (rows x columns) expected draws in each cell
  std::array<Moments, kEndings> draws{};  // number of draws, by ending
  std::vector<std::array<Moments, kEndings>> totals{};  // by quantity and ending
  /// Number of walks drawn by Monte Carlo for the moments of `draws` and `totals`; 0: these moments
  /// are exact. The means over all walks together are always exact.
  std::int64_t drawn_walks = 0;

  /// The moments over all walks together.
  [[nodiscard]] static Moments all(const std::array<Moments, kEndings>& by_ending);
};

/// Called for all states that walks pass: `share` of the walks make their `draw`-th draw, counted
/// from 1, in this cell (row * columns + column) and state.
using EachState = std::function<void(int draw, std::int64_t cell, int input, double share)>;

/// Without a limit of cells: when the remaining walks are not followed further (`remainder`).
struct WalkTolerance {
  double all = 1e-12;                    // largest share of all walks that may be dropped
  const EndingChance* chance = nullptr;  // if given, `of_target` holds for its ending too
  double of_target = 1e-9;               // largest share of walks with that ending dropped
  /// In large fields: the tolerance of the visits in each row.
  double of_row = kRowTolerance;
  /// A field is large if its cells times the nonzeros of a cell's chain exceed this number: a
  /// second or two of work.
  double large = 1e7;
};

/// Computes first and second moments of totals by propagating them with the shares of walks,
/// exactly. With a limit of cells the propagation goes step by step, as in Solver::steps. Without
/// one it goes row by row; draws are then not distinguished (`each` is called with draw 1), and a
/// row is left after 10^5 sweeps at the latest. If moves lead to a row below, it goes step by step
/// until at most `tolerance.all` of the walks are under way, or for 10^5 steps. If more walks then
/// remain and states are few (1000), elimination computes everything.
///
/// In large fields without a limit, whose rows have one type each, visits, endings and the means of
/// all walks are exact to `tolerance.of_row` of each row. Other moments come from walks drawn with
/// `seed`: 2^16 of all walks, and, if `tolerance.chance` covers fewer than 2^12 of these, as many
/// with that ending. Without rewards no walks are drawn, and the moments of `draws` are NaN.
///
/// Throws std::invalid_argument if rewards do not fit the chain, and as validate() does.
[[nodiscard]] WalkTotals walk_totals(const FieldChain& chain, const Field& field,
                                     const Start& start, int max_cells, const Rewards& rewards = {},
                                     const EachState& each = {},
                                     const WalkTolerance& tolerance = {}, std::uint64_t seed = 0);

/// The ending of a walk and its total of the first quantity.
struct TimedWalk {
  Ending ending = Ending::trapped;
  double total = 0.0;
};
/// Draws walks 0 .. count - 1 as Walker does, and with each output a gamma-distributed value of the
/// first quantity that has the moments of its nonzero. Totals therefore have the mean and the
/// variance of walk_totals. Runs on all threads of the current TBB arena, with the same result for
/// any number.
[[nodiscard]] std::vector<TimedWalk> timed_walks(const FieldChain& chain, const Field& field,
                                                 const Start& start, int max_cells,
                                                 const Rewards& rewards, std::int64_t count,
                                                 std::uint64_t seed);

}  // namespace gatewalk::markov
