// SPDX-License-Identifier: MIT
#include "markov/committor.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "markov/predict/moves.h"
#include "markov/predict/row_sum.h"

namespace gatewalk::markov {
namespace {

constexpr int kMostSweeps = 100'000;

std::vector<Moves> moves_by_type(const FieldChain& chain, Ending ending) {
  std::vector<Moves> moves;
  for (const Chain& c : chain.chains()) {
    for (const Exit& exit : c.exits())
      if (exit.di_y < 0) throw std::invalid_argument("committor: a move leads to a row below");
    moves.emplace_back(c, ending);
  }
  return moves;
}

[[noreturn]] void refuse_circles(int row) {
  throw std::runtime_error("committor: row " + std::to_string(row) +
                           " of the field does not settle in " + std::to_string(kMostSweeps) +
                           " sweeps: walks circle in it");
}

class CommittorRows {
 public:
  CommittorRows(const FieldChain& chain, const Field& field, Ending ending, double tolerance)
      : chain_(chain),
        field_(field),
        ending_(ending),
        tolerance_(tolerance),
        moves_(moves_by_type(chain, ending)),
        all_{field.columns, field.rows, chain.inputs(), {}},
        from_above_(static_cast<std::size_t>(field.columns) *
                    static_cast<std::size_t>(chain.inputs())) {
    all_.values.resize(from_above_.size() * static_cast<std::size_t>(field.rows));
    if (chain.has_uniform_rows())
      for (const Moves& m : moves_)
        sums_.emplace_back(m.within_row(), RowSum::Sums::led_to, field.columns, chain.inputs());
  }

  Committor solve() && {
    for (int row = field_.rows - 1; row >= 0; --row) {
      look_up(row);
      if (!sums_.empty() && sums_[type_of(0, row)].suits())
        sum(row);
      else
        sweep(row);
    }
    return std::move(all_);
  }

 private:
  [[nodiscard]] double* cell(std::int64_t column, std::int64_t row) {
    return all_.values.data() + (row * field_.columns + column) * all_.inputs;
  }
  [[nodiscard]] std::size_t type_of(int column, int row) const {
    return static_cast<std::size_t>(chain_.type_of(column, row));
  }
  [[nodiscard]] const Moves& moves_of(int column, int row) const {
    return moves_[type_of(column, row)];
  }

  [[nodiscard]] bool within(std::int64_t column) const {
    return column >= 0 && column < field_.columns;
  }
  [[nodiscard]] double ends_beyond(std::int64_t column, std::int64_t row) const {
    return edge_before(field_, column, row) == ending_ ? 1.0 : 0.0;
  }

  /// What ends at once and what the rows above give, of which all is known; and a first guess.
  void look_up(int row) {
    for (int column = 0; column < field_.columns; ++column) {
      const Moves& m = moves_of(column, row);
      double* const sums = from_above_.data() + std::int64_t{column} * all_.inputs;
      for (int input = 0; input < all_.inputs; ++input) {
        double sum = m.ends[static_cast<std::size_t>(input)];
        for (std::size_t i = m.up[input]; i < m.side[input]; ++i) {
          const auto& [p, di_x, di_y, next] = m.entries[i];
          if (within(column + di_x) && row + di_y < field_.rows)
            sum += p * cell(column + di_x, row + di_y)[next];
          else
            sum += p * ends_beyond(column + di_x, row + di_y);
        }
        sums[input] = sum;
        cell(column, row)[input] = sum;
      }
    }
  }

  /// All states of a cell, from those of its neighbours in the row. The largest change, as a part
  /// of the number.
  double renew(int column, int row) {
    const Moves& m = moves_of(column, row);
    const double* const sums = from_above_.data() + std::int64_t{column} * all_.inputs;
    double change = 0.0;
    for (int input = 0; input < all_.inputs; ++input) {
      double sum = sums[input];
      for (std::size_t i = m.side[input]; i < m.up[input + 1]; ++i) {
        const auto& [p, di_x, di_y, next] = m.entries[i];
        sum += p * (within(column + di_x) ? cell(column + di_x, row)[next]
                                          : ends_beyond(column + di_x, row));
      }
      double& value = cell(column, row)[input];
      if (sum > 0.0) change = std::max(change, std::abs(sum - value) / sum);
      value = sum;
    }
    return change;
  }

  /// What moves over the sides end in is known as well.
  void sum(int row) {
    const Moves& m = moves_of(0, row);
    for (int column = 0; column < field_.columns; ++column)
      for (int input = 0; input < all_.inputs && ends_at_a_side(m, column); ++input)
        for (std::size_t i = m.side[input]; i < m.up[input + 1]; ++i)
          if (const auto& [p, di_x, di_y, next] = m.entries[i]; !within(column + di_x))
            cell(column, row)[input] += p * ends_beyond(column + di_x, row);
    sums_[type_of(0, row)].solve(cell(0, row), RowSum::Of::each, tolerance_);
  }
  [[nodiscard]] bool ends_at_a_side(const Moves& m, int column) const {
    return !within(column - m.widest) || !within(column + m.widest);
  }

  void sweep(int row) {
    for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
      double change = 0.0;
      for (int i = 0; i < field_.columns; ++i)
        change = std::max(change, renew(sweep % 2 == 0 ? i : field_.columns - 1 - i, row));
      if (change <= tolerance_) return;
    }
    refuse_circles(row);
  }

  const FieldChain& chain_;
  const Field field_;
  const Ending ending_;
  const double tolerance_;
  std::vector<Moves> moves_;  // by type
  std::vector<RowSum> sums_;  // by type; none where rows are of several
  Committor all_;
  std::vector<double> from_above_;  // (columns x inputs)
};

}  // namespace

Committor committor(const FieldChain& chain, const Field& field, Ending ending, double tolerance) {
  validate(chain, field, {}, 0);
  return CommittorRows(chain, field, ending, tolerance).solve();
}

EndingChance::EndingChance(const FieldChain& chain, const Field& field, Ending ending,
                           int max_cells, double tolerance)
    : ending_(ending),
      max_cells_(max_cells),
      cells_(std::int64_t{field.columns} * field.rows),
      inputs_(chain.inputs()),
      layers_(max_cells == 0 ? 1 : max_cells) {
  validate(chain, field, {}, max_cells);
  if (max_cells == 0) {
    values_ = committor(chain, field, ending, tolerance).values;
    return;
  }
  constexpr double kMostNumbers = 4.0 * (1 << 30) / sizeof(double);
  const double numbers =
      static_cast<double>(layers_) * static_cast<double>(cells_) * static_cast<double>(inputs_);
  if (numbers > kMostNumbers)
    throw std::invalid_argument("the chance of an ending from every state of " +
                                std::to_string(cells_) + " cells, " + std::to_string(layers_) +
                                " draws each, takes more than 4 GiB");
  values_.resize(static_cast<std::size_t>(numbers));
  for (std::int64_t layer = layers_ - 1; layer >= 0; --layer)
    tbb::parallel_for(std::int64_t{0}, cells_, [&](std::int64_t cell) {
      const std::int64_t column = cell % field.columns, row = cell / field.columns;
      const Chain& here = chain.at(column, row);
      double* const out = values_.data() + (layer * cells_ + cell) * inputs_;
      const double* const next = values_.data() + (layer + 1) * cells_ * inputs_;
      for (int input = 0; input < here.inputs(); ++input) {
        double sum = !here.is_sampled(input) && ending == Ending::unsampled ? 1.0 : 0.0;
        for (Probabilities::InnerIterator it(here.matrix(), input); it; ++it) {
          const Exit& exit = here.exits()[static_cast<std::size_t>(it.col())];
          std::int64_t to_column = column, to_row = row;
          const auto ends = follow(field, exit, layer + 1 == layers_, to_column, to_row);
          const double value =
              ends ? (*ends == ending ? 1.0 : 0.0)
                   : next[(to_row * field.columns + to_column) * inputs_ + exit.next_input];
          sum += it.value() * value;
        }
        out[input] = sum;
      }
    });
}

std::vector<double> row_chances(const FieldChain& chain, const Field& field, const Start& start) {
  validate(chain, field, start, 0);
  const std::vector<Moves> moves = moves_by_type(chain, Ending::far_edge);
  for (const Moves& m : moves)
    for (const Moves::Entry& e : m.entries)
      if (e.di_y > 1) throw std::invalid_argument("committor: a move leads over a row");
  const auto inputs = static_cast<std::size_t>(chain.inputs());
  const auto at = [&](int column) { return static_cast<std::size_t>(column) * inputs; };
  // (columns x inputs) of a row: shares of walks that have entered and not gone on yet; of the next
  // row.
  std::vector<double> waiting(at(field.columns), 0.0), above(waiting.size()), here(inputs);
  waiting[at(start.column) + static_cast<std::size_t>(start.input)] = 1.0;
  std::vector<double> chances;
  for (int row = start.row; row < field.rows; ++row) {
    double up = 0.0;
    std::fill(above.begin(), above.end(), 0.0);
    const auto pass_on = [&](int column) {
      const Moves& m = moves[static_cast<std::size_t>(chain.type_of(column, row))];
      const auto begin = waiting.begin() + static_cast<std::ptrdiff_t>(at(column));
      std::copy_n(begin, inputs, here.begin());
      std::fill_n(begin, inputs, 0.0);
      for (std::size_t input = 0; input < inputs; ++input) {
        if (here[input] == 0.0) continue;
        for (std::size_t i = m.up[input]; i < m.up[input + 1]; ++i) {
          const auto& [p, di_x, di_y, next] = m.entries[i];
          const double share = here[input] * p;
          if (di_y > 0) up += share;
          if (column + di_x >= 0 && column + di_x < field.columns)
            (di_y > 0 ? above : waiting)[at(column + di_x) + static_cast<std::size_t>(next)] +=
                share;
        }
      }
    };
    double left = 1.0;
    for (int sweep = 0; left > kRowTolerance * up; ++sweep) {
      if (sweep == kMostSweeps) refuse_circles(row);
      for (int i = 0; i < field.columns; ++i) pass_on(sweep % 2 == 0 ? i : field.columns - 1 - i);
      left = std::accumulate(waiting.begin(), waiting.end(), 0.0);
    }
    chances.push_back(up);
    waiting.swap(above);
  }
  return chances;
}

}  // namespace gatewalk::markov
