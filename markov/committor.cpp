#include "markov/committor.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace gatewalk::markov {
namespace {

constexpr double kTolerance = 1e-13;
constexpr int kMostSweeps = 100'000;

class Rows {
 public:
  Rows(const FieldChain& chain, const Field& field)
      : chain_(chain),
        field_(field),
        all_{field.columns, field.rows, chain.inputs(),
             std::vector<double>(static_cast<std::size_t>(field.columns) *
                                 static_cast<std::size_t>(field.rows) *
                                 static_cast<std::size_t>(chain.inputs()))} {}

  Committor solve() && {
    for (int row = field_.rows - 1; row >= 0; --row) solve(row);
    return std::move(all_);
  }

 private:
  /// All states of a cell, from what is known of its neighbours. The largest change.
  double renew(int column, int row) {
    const Chain& chain = chain_.at(column, row);
    double change = 0.0;
    for (int input = 0; input < all_.inputs; ++input) {
      double sum = 0.0;
      for (Probabilities::InnerIterator it(chain.matrix(), input); it; ++it) {
        const Exit& exit = chain.exits()[static_cast<std::size_t>(it.col())];
        if (exit.next_input == Exit::kTrapped) continue;
        const std::int64_t to_column = std::int64_t{column} + exit.di_x,
                           to_row = std::int64_t{row} + exit.di_y;
        if (to_row >= field_.rows)
          sum += it.value();
        else if (to_column >= 0 && to_column < field_.columns)
          sum += it.value() * all_(to_column, to_row, exit.next_input);
      }
      double& value = all_.values[static_cast<std::size_t>(
          (std::int64_t{row} * field_.columns + column) * all_.inputs + input)];
      change = std::max(change, std::abs(sum - value));
      value = sum;
    }
    return change;
  }

  void solve(int row) {
    for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
      double change = 0.0;
      for (int i = 0; i < field_.columns; ++i)
        change = std::max(change, renew(sweep % 2 == 0 ? i : field_.columns - 1 - i, row));
      const auto begin = all_.values.begin() + std::int64_t{row} * field_.columns * all_.inputs;
      const double most =
          *std::max_element(begin, begin + std::int64_t{field_.columns} * all_.inputs);
      if (change <= kTolerance * most) return;
    }
    throw std::runtime_error("committor: row " + std::to_string(row) +
                             " of the field does not settle in " + std::to_string(kMostSweeps) +
                             " sweeps: walks circle in it");
  }

  const FieldChain& chain_;
  const Field field_;
  Committor all_;
};

}  // namespace

Committor committor(const FieldChain& chain, const Field& field) {
  validate(chain, field, {}, 0);
  for (const Chain& c : chain.chains())
    for (const Exit& exit : c.exits())
      if (exit.di_y < 0) throw std::invalid_argument("committor: a move leads to a row below");
  return Rows(chain, field).solve();
}

}  // namespace gatewalk::markov
