// SPDX-License-Identifier: MIT
#pragma once
/// The plain reference implementation of all predictions.

#include <array>
#include <cstdint>
#include <vector>

#include "markov/predict.h"

namespace gatewalk::markov::test {

/// P_after = P_before M, Eq. (16), for the shares of walks in every state of every cell, with extra
/// digits. Exact with a limit of cells. Without one, stops when at most the tolerance still walks,
/// or after max_steps.
inline FinalDistribution propagate(const FieldChain& chain, const Field& field, const Start& start,
                                   const PredictOptions& options = {}) {
  validate(chain, field, start, options.max_cells);
  const std::int64_t inputs = chain.inputs(), cells = std::int64_t{field.columns} * field.rows;
  std::vector<long double> before(static_cast<std::size_t>(cells * inputs)), after(before);
  std::vector<std::array<long double, kEndings>> ended(static_cast<std::size_t>(cells));
  long double walking = 0, draws = 0;
  const auto end = [&](Ending why, std::int64_t cell, long double share) {
    ended[static_cast<std::size_t>(cell)][static_cast<std::size_t>(why)] += share;
  };
  const auto enter = [&](std::int64_t column, std::int64_t row, int input, long double share) {
    const std::int64_t cell = row * field.columns + column;
    if (!chain.at(column, row).is_sampled(input)) return end(Ending::unsampled, cell, share);
    after[static_cast<std::size_t>(cell * inputs + input)] += share;
    walking += share;
  };
  enter(start.column, start.row, start.input, 1);
  FinalDistribution d;
  const double tolerance = options.tolerance.value_or(1e-13);
  while (options.max_cells > 0 ? walking > 0 && d.steps < options.max_cells
                               : walking > tolerance && d.steps < options.max_steps) {
    ++d.steps;
    draws += walking;
    walking = 0;
    before.swap(after);
    after.assign(after.size(), 0);
    for (std::int64_t state = 0; state < cells * inputs; ++state) {
      const long double share = before[static_cast<std::size_t>(state)];
      if (share == 0) continue;
      const std::int64_t cell = state / inputs;
      const Chain& here = chain.at(cell % field.columns, cell / field.columns);
      for (Probabilities::InnerIterator m(here.matrix(), state % inputs); m; ++m) {
        const Exit& exit = here.exits()[static_cast<std::size_t>(m.col())];
        std::int64_t column = cell % field.columns, row = cell / field.columns;
        if (const auto why = follow(field, exit, d.steps == options.max_cells, column, row))
          end(*why, cell, share * m.value());
        else
          enter(column, row, exit.next_input, share * m.value());
      }
    }
  }
  d.final_cells = CellProbabilities::Zero(field.rows, field.columns);
  std::array<long double, kEndings> all{};
  for (std::int64_t cell = 0; cell < cells; ++cell) {
    CellEndings<double> here{cell, {}};
    long double sum = 0;
    for (std::size_t e = 0; e < kEndings; ++e) {
      const long double share = ended[static_cast<std::size_t>(cell)][e];
      here.by_ending[e] = static_cast<double>(share);
      all[e] += share;
      sum += share;
    }
    d.final_cells.data()[cell] = static_cast<double>(sum);
    if (sum > ended[static_cast<std::size_t>(cell)].front()) d.mixed_cells.push_back(here);
  }
  for (std::size_t e = 0; e < kEndings; ++e) d.endings[e] = static_cast<double>(all[e]);
  d.remainder = static_cast<double>(walking);
  d.mean_steps = static_cast<double>(draws);
  return d;
}

}  // namespace gatewalk::markov::test
