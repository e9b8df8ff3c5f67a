// SPDX-License-Identifier: MIT
#pragma once
/// The probability that walks end in a given way, from every state of every cell (for leaving over
/// the far edge: the committor), with or without a limit of cells; and the probability to enter
/// every row, from one start.

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "markov/chain.h"

namespace gatewalk::markov {

/// The probability that a walk without a limit of cells has the given ending.
struct Committor {
  int columns = 0, rows = 0, inputs = 0;
  std::vector<double> values;  // (rows x columns x inputs)

  [[nodiscard]] double operator()(std::int64_t column, std::int64_t row, std::int64_t input) const {
    return values[static_cast<std::size_t>((row * columns + column) * inputs + input)];
  }
};

/// The relative tolerance to which rows of a field are solved.
inline constexpr double kRowTolerance = 1e-12;

/// Computes the committor of an ending. Rows are solved from the far edge on, each by sweeps to
/// both sides until no value changes by more than `tolerance` of itself (or, in vector registers
/// for a row of cells of one type that walks soon leave, to that tolerance of each value). If moves
/// lead to a row below, sweeps cover all rows, until also at most `tolerance` of the walks from any
/// state are under way. The elimination of first_passages (first_passage.h) replaces these sweeps
/// if states are few, and any sweeps if 10^5 do not suffice.
///
/// Nothing is subtracted, so the relative accuracy holds for values of any size. A walk into an
/// unsampled row ends as `unsampled`. Walks that can never end have no ending: probability 0.
/// Throws std::invalid_argument for fields of another size than the chain's, and as first_passages
/// does.
[[nodiscard]] Committor committor(const FieldChain& chain, const Field& field,
                                  Ending ending = Ending::far_edge,
                                  double tolerance = kRowTolerance);

/// The probability that a walk with a limit of cells has the given ending, from every state and for
/// every number of draws made.
class EndingChance {
 public:
  /// Computes the probabilities on all threads of the current TBB arena. max_cells 0: no limit, as
  /// committor(), to `tolerance`. `from` (with a limit only): computes only cells and draws that
  /// walks from its cell can reach, in less time and memory; elsewhere the probability is NaN.
  /// Memory: max_cells x rows x columns x inputs numbers; throws std::invalid_argument above 4 GiB.
  EndingChance(const FieldChain& chain, const Field& field, Ending ending, int max_cells,
               double tolerance = kRowTolerance, const std::optional<Start>& from = {});

  /// The probability from a cell (row * columns + column) and state in which the walk makes its
  /// `draw`-th draw, counted from 1; beyond the last draw the walk is cut off. Without a limit,
  /// `draw` is ignored.
  [[nodiscard]] double operator()(int draw, std::int64_t cell, std::int64_t input) const {
    const std::int64_t layer = max_cells_ == 0 ? 0 : draw - 1;
    if (layer >= layers_) return ending_ == Ending::cut_off ? 1.0 : 0.0;
    const std::int64_t begin = begin_[static_cast<std::size_t>(layer * cells_ + cell)];
    return begin < 0 ? std::numeric_limits<double>::quiet_NaN()
                     : values_[static_cast<std::size_t>(begin + input)];
  }
  [[nodiscard]] Ending ending() const { return ending_; }

 private:
  Ending ending_;
  int max_cells_;
  std::int64_t cells_, inputs_, layers_;
  std::vector<std::int64_t> begin_;  // (layers x cells) index into `values_`; -1: not reachable
  std::vector<double> values_;       // by input
};

/// The probability that a walk from `start` without a limit of cells enters rows start.row + 1,
/// ..., field.rows; the last one is to leave over the far edge. Computed row by row from the start
/// with the sweeps and the accuracy of committor(). Throws as committor, and std::invalid_argument
/// for moves that skip a row.
[[nodiscard]] std::vector<double> row_chances(const FieldChain& chain, const Field& field,
                                              const Start& start);

}  // namespace gatewalk::markov
