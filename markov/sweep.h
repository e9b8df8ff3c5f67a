#pragma once
/// Exact distributions fast: the chain applied to whole rows of the field at a time, in vector
/// registers (Google Highway: the instruction set is chosen when the program runs; the same bits with
/// any). The plain references are propagate and solve_absorption (exact.h).

#include "markov/exact.h"

namespace gatewalk::markov {

class Ends;

/// A chain prepared for any field and start: for each input state, where its mass comes from.
class Sweeper {
 public:
  explicit Sweeper(const Chain& chain);
  Sweeper(const Sweeper&) = delete;
  Sweeper& operator=(const Sweeper&) = delete;

  /// The same as propagate(), to rounding. Memory: 2 cells x n_in numbers.
  [[nodiscard]] FinalDistribution propagate(const Field& field, const Start& start, int max_cells,
                                            double tolerance = 1e-13,
                                            int max_steps_without_limit = 1'000'000) const;

  /// Whether march() can be used: no exit leads to a row below.
  [[nodiscard]] bool can_march() const { return lowest_ >= 0; }

  /// Without limit, row by row: what walks within a row is summed until at most `tolerance` of what
  /// ever entered it is left in it (all that is left anywhere: `remainder`), then the next row is
  /// entered. Memory: a few rows x n_in numbers, whatever the number of rows. Throws
  /// std::invalid_argument unless can_march(); std::runtime_error when a row takes more than
  /// `most_sums` sums: walks can circle (almost) for ever.
  [[nodiscard]] FinalDistribution march(const Field& field, const Start& start,
                                        double tolerance = 1e-13, int most_sums = 1'000'000) const;

  /// The quicker of the two: march() for large fields without limit, if it can be used.
  [[nodiscard]] FinalDistribution predict(const Field& field, const Start& start, int max_cells) const;

  struct Source {
    double p;
    int input, di_x, di_y;
  };

 private:
  /// Shares of an input's mass that leave a cell in one direction.
  struct Direction {
    int di_x, di_y;
    std::vector<double> on, unsampled;  // (n_in)
  };

  /// Counts what ends in a cell, from its column of `tally` (one number per ending); the mass that
  /// walks on. `is_last`: whoever would go on is cut off.
  double count_ends(Ends& ends, const Field& field, std::int64_t column, std::int64_t row,
                    bool is_last, const double* tally, std::size_t stride) const;

  Chain chain_;
  std::vector<Source> sources_;  // of input 0, 1, ...
  std::vector<int> begin_;       // (n_in + 1)
  std::vector<double> trapped_;  // (n_in)
  std::vector<Direction> directions_;
  std::vector<const std::vector<double>*> endings_;  // trapped, then on and unsampled by direction
  int widest_ = 0;              // largest |di_x|
  int lowest_ = 0, highest_ = 0;  // di_y
};

}  // namespace gatewalk::markov
