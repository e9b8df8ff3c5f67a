#pragma once
/// How likely walks are to leave a field over its far edge, from every state of every cell; and to
/// enter every row, from one start.

#include <vector>

#include "markov/chain.h"

namespace gatewalk::markov {

/// Chance that a walk without limit of cells leaves over the far edge: the committor.
struct Committor {
  int columns = 0, rows = 0, inputs = 0;
  std::vector<double> values;  // (rows x columns x inputs)

  [[nodiscard]] double operator()(std::int64_t column, std::int64_t row, std::int64_t input) const {
    return values[static_cast<std::size_t>((row * columns + column) * inputs + input)];
  }
};

/// Row by row from the far edge; within a row by sweeps to both sides until no value changes by
/// more than 1e-12 of the row's largest. Relative accuracy is that of sums of positive numbers,
/// however small the values: nothing is subtracted. A row never sampled does not commit. Throws
/// std::invalid_argument for moves to a row below and fields of another size than the chain's,
/// std::runtime_error when 10^5 sweeps do not do.
[[nodiscard]] Committor committor(const FieldChain& chain, const Field& field);

/// Chance that a walk without limit of cells from there enters rows start.row + 1, ..., field.rows;
/// the last is to leave over the far edge. Row by row from the start, by the same sweeps, with the
/// same relative accuracy. Throws as committor, and std::invalid_argument for moves over a row.
[[nodiscard]] std::vector<double> row_chances(const FieldChain& chain, const Field& field,
                                              const Start& start);

}  // namespace gatewalk::markov
