// SPDX-License-Identifier: MIT
#pragma once
/// Optimal policies: which of several chains to draw from in each cell and state, so that walks
/// gain the most. A Markov decision process over a field (Puterman 1994, chapters 4 and 7).

#include <array>
#include <cstdint>
#include <vector>

#include "markov/chain.h"

namespace gatewalk::markov {

/// The gains of a walk, to be maximised. Costs are negative.
struct Gains {
  /// By Ending: the gain of a walk that ends so. A walk that never ends gains nothing.
  std::array<double, kEndings> ending{};
  /// [action][type of cell][input]: mean gain of a draw. Empty: draws gain nothing.
  std::vector<std::vector<std::vector<double>>> draw;
};

/// The uncertainty of each row. The worst case may use any distribution q on the row's outputs with
/// sum (q - p)^2 / p <= deviations^2 / runs, independently for each row: rectangular sets (Iyengar,
/// Robust dynamic programming, Math. Oper. Res. 30, 2005; Nilim and El Ghaoui, Oper. Res. 53, 2005)
/// of chi-square type (Ben-Tal et al., Manag. Sci. 59, 2013). The smallest mean of given values is
/// their mean less `deviations` standard errors, unless a q would be negative.
struct Doubt {
  double deviations = 0.0;  // 0: p is taken as exact
  /// [action][type of cell][input]: number of runs counted in a row; > 0 unless the row is
  /// unsampled.
  std::vector<std::vector<std::vector<double>>> runs{};
};

struct DecideOptions {
  /// Largest number of cells that a walk may visit before it is cut off; 0: no limit.
  int max_cells = 0;
  /// Without a limit: sweeps stop once no value changes by more than this share of itself (if draws
  /// cost: of the largest gain at least), and never below the rounding error of a draw. If
  /// `max_sweeps` sweeps do not suffice, decide() throws std::runtime_error.
  double tolerance = 1e-15;
  int max_sweeps = 1'000'000;
  /// With a doubt, decisions are optimal in the worst case, and values are those of the worst case.
  Doubt doubt{};
};

/// The optimal action for each cell and state, and the expected gain from there on.
struct Decisions {
  Field field;
  int inputs = 0, max_cells = 0;
  /// (max(1, max_cells) x cells x inputs) number of the action; cells as row * columns + column;
  /// with a limit of cells, first by the number of draws already made. Of equally good actions (but
  /// for rounding) the first; without a limit the first that was found.
  std::vector<std::uint16_t> action{};
  std::vector<double> value{};  // (cells x inputs) expected gain before the first draw
  int sweeps = 0;               // sweeps over the field; with a limit, as many as the limit

  [[nodiscard]] std::size_t at(int column, int row, int input, int draws = 0) const {
    const auto cell = static_cast<std::size_t>(row) * static_cast<std::size_t>(field.columns) +
                      static_cast<std::size_t>(column);
    const std::size_t cells =
        static_cast<std::size_t>(field.columns) * static_cast<std::size_t>(field.rows);
    return (static_cast<std::size_t>(max_cells > 0 ? draws : 0) * cells + cell) *
               static_cast<std::size_t>(inputs) +
           static_cast<std::size_t>(input);
  }
};

/// Finds the optimal policy. actions[a] is the field's chain under action a; all have the same
/// inputs, but outputs may differ.
///
/// With a limit of cells: backward induction, exact but for rounding; decisions know how many draws
/// are left. Without: value iteration, row by row from the far end, then all rows together; a value
/// is too small by at most some `tolerance` times the draws of a walk. An action is replaced only
/// by one that is better by more than rounding, so that policies do not circle for ever where all
/// actions are equally good. Memory: the values, with a border as wide as moves reach, twice with a
/// limit; 10 bytes for each cell and state, and with a limit 2 more for each draw.
///
/// With doubt, each draw has the worst row for the value of going on: with a limit rows may differ
/// by draw, without one they are the same for ever. Gains of draws and of unsampled rows are exact.
///
/// Throws std::invalid_argument if actions, field, gains and doubt do not fit together. Without a
/// limit it also throws unless all endings gain at least 0 and either Gains::draw is empty or,
/// without doubt, every draw costs something: otherwise circling for ever might be the best, or the
/// worst.
[[nodiscard]] Decisions decide(const std::vector<FieldChain>& actions, const Field& field,
                               const Gains& gains, const DecideOptions& options = {});

/// The chain of walks under a policy: of decisions that do not depend on the number of draws, or
/// those after `draws` draws. Throws std::invalid_argument unless the decisions fit the actions.
[[nodiscard]] FieldChain decided(const std::vector<FieldChain>& actions, const Decisions& decisions,
                                 int draws = 0);

}  // namespace gatewalk::markov
