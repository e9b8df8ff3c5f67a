// SPDX-License-Identifier: MIT
#pragma once
/// Which of several chains to draw from, cell by cell and state by state, so that walks end as well
/// as they can: a Markov decision process over a field (Puterman 1994, chapters 4 and 7).

#include <array>
#include <cstdint>
#include <vector>

#include "markov/chain.h"

namespace gatewalk::markov {

/// What a walk gains, the more the better. Costs are negative.
struct Gains {
  std::array<double, kEndings> ending{};  // once, by Ending; a walk that never ends gains nothing
  /// [action][type of cell][input]: the mean of a draw. Empty: draws gain nothing.
  std::vector<std::vector<std::vector<double>>> draw;
};

/// How far each row may be from what was counted in it. Nature may draw from any q on the row's
/// outputs with sum (q - p)^2 / p <= deviations^2 / runs, each row for itself: rectangular sets
/// (Iyengar, Robust dynamic programming, Math. Oper. Res. 30, 2005; Nilim and El Ghaoui, Oper. Res.
/// 53, 2005) of chi-square (Ben-Tal et al., Manag. Sci. 59, 2013). The least mean of given values
/// is their mean less so many of its standard errors, unless a q would have to be below 0.
struct Doubt {
  double deviations = 0.0;  // 0: none, p is known
  /// [action][type of cell][input]: the runs that a row was counted from; more than 0 unless it is
  /// unsampled.
  std::vector<std::vector<std::vector<double>>> runs{};
};

struct DecideOptions {
  /// Cells a walk may visit before it is cut off; 0: no limit.
  int max_cells = 0;
  /// Without limit: the least share of a value by which a sweep over the field changes it (where
  /// draws cost, of the largest gain at least), and how many sweeps there may be before nothing
  /// does; else std::runtime_error. Not below what rounding makes of a draw.
  double tolerance = 1e-15;
  int max_sweeps = 1'000'000;
  /// Decisions are then the best in the worst case, and values are those of the worst case.
  Doubt doubt{};
};

/// For each cell and state what to draw from, and what that gains from there on.
struct Decisions {
  Field field;
  int inputs = 0, max_cells = 0;
  /// (max(1, max_cells) x cells x inputs), cells as row * columns + column: the number of an
  /// action; with a limit of cells by the number of draws made before. Of several that are as good
  /// but for rounding the first, without limit the first that was found.
  std::vector<std::uint16_t> action{};
  std::vector<double> value{};  // (cells x inputs) before the first draw
  int sweeps = 0;               // of the field; with a limit as many as that

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

/// The best that can be done, and how. actions[a] is the field's chain under action a; all have the
/// same inputs, outputs may differ.
/// With a limit of cells: backward induction, exact but for rounding; decisions know how many draws
/// are left. Without: value iteration, row by row from the far end, then all rows together; a value
/// lacks at most some tolerance times the draws of a walk. There an action is left only for one
/// that is better by more than rounding, so that no decisions circle for ever where all ways look
/// alike. Memory: the values, in a border as wide as moves reach, twice with a limit; 10 bytes for
/// each cell and state, and with a limit 2 more for each draw.
/// In doubt each draw has the worst rows for what it is worth to go on: with a limit they may
/// differ by draw, without they are the same for ever. Gains of draws and of unsampled rows are
/// known. Throws std::invalid_argument where actions, field, gains and doubt cannot belong
/// together; without limit also unless all endings gain at least 0 and Gains::draw is empty or,
/// without doubt, every draw costs something: else to circle for ever may be the best, or the
/// worst.
[[nodiscard]] Decisions decide(const std::vector<FieldChain>& actions, const Field& field,
                               const Gains& gains, const DecideOptions& options = {});

/// The chain of walks that are decided so: of decisions that know no draws, or after so many draws.
/// Throws std::invalid_argument unless they can be of these actions.
[[nodiscard]] FieldChain decided(const std::vector<FieldChain>& actions, const Decisions& decisions,
                                 int draws = 0);

}  // namespace gatewalk::markov
