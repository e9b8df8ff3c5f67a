#include "markov/committor.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace gatewalk::markov {
namespace {

constexpr double kTolerance = 1e-12;
constexpr int kMostSweeps = 100'000;

/// A chain's entries by row, those that stay within a row of the field apart from those that leave
/// it upwards.
struct Moves {
  struct Entry {
    double p;
    int di_x, di_y, next;
  };
  std::vector<Entry> entries;
  std::vector<std::size_t> up,
      side;  // (inputs + 1): where those of an input begin; side: behind up

  explicit Moves(const Chain& chain) {
    for (int input = 0; input < chain.inputs(); ++input) {
      for (const bool upwards : {true, false}) {
        (upwards ? up : side).push_back(entries.size());
        for (Probabilities::InnerIterator it(chain.matrix(), input); it; ++it) {
          const Exit& exit = chain.exits()[static_cast<std::size_t>(it.col())];
          if (exit.next_input != Exit::kTrapped && (exit.di_y > 0) == upwards)
            entries.push_back({it.value(), exit.di_x, exit.di_y, exit.next_input});
        }
      }
    }
    up.push_back(entries.size());
  }
};

class Rows {
 public:
  Rows(const FieldChain& chain, const Field& field)
      : chain_(chain),
        field_(field),
        all_{field.columns, field.rows, chain.inputs(), {}},
        from_above_(static_cast<std::size_t>(field.columns) *
                    static_cast<std::size_t>(chain.inputs())) {
    all_.values.resize(from_above_.size() * static_cast<std::size_t>(field.rows));
    for (const Chain& c : chain.chains()) moves_.emplace_back(c);
  }

  Committor solve() && {
    for (int row = field_.rows - 1; row >= 0; --row) {
      look_up(row);
      solve(row);
    }
    return std::move(all_);
  }

 private:
  [[nodiscard]] double* cell(std::int64_t column, std::int64_t row) {
    return all_.values.data() + (row * field_.columns + column) * all_.inputs;
  }
  [[nodiscard]] const Moves& moves_of(int column, int row) const {
    return moves_[static_cast<std::size_t>(chain_.type_of(column, row))];
  }

  /// What the rows above give, of which all is known; and a first guess.
  void look_up(int row) {
    for (int column = 0; column < field_.columns; ++column) {
      const Moves& m = moves_of(column, row);
      double* const sums = from_above_.data() + std::int64_t{column} * all_.inputs;
      for (int input = 0; input < all_.inputs; ++input) {
        double sum = 0.0;
        for (std::size_t i = m.up[input]; i < m.side[input]; ++i) {
          const auto& [p, di_x, di_y, next] = m.entries[i];
          if (row + di_y >= field_.rows)
            sum += p;
          else if (column + di_x >= 0 && column + di_x < field_.columns)
            sum += p * cell(column + di_x, row + di_y)[next];
        }
        sums[input] = sum;
        cell(column, row)[input] = sum;
      }
    }
  }

  /// All states of a cell, from those of its neighbours in the row. The largest change.
  double renew(int column, int row) {
    const Moves& m = moves_of(column, row);
    const double* const sums = from_above_.data() + std::int64_t{column} * all_.inputs;
    double change = 0.0;
    for (int input = 0; input < all_.inputs; ++input) {
      double sum = sums[input];
      for (std::size_t i = m.side[input]; i < m.up[input + 1]; ++i) {
        const auto& [p, di_x, di_y, next] = m.entries[i];
        if (column + di_x >= 0 && column + di_x < field_.columns)
          sum += p * cell(column + di_x, row)[next];
      }
      double& value = cell(column, row)[input];
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
      const double* const begin = cell(0, row);
      const double most = *std::max_element(begin, begin + from_above_.size());
      if (change <= kTolerance * most) return;
    }
    throw std::runtime_error("committor: row " + std::to_string(row) +
                             " of the field does not settle in " + std::to_string(kMostSweeps) +
                             " sweeps: walks circle in it");
  }

  const FieldChain& chain_;
  const Field field_;
  std::vector<Moves> moves_;  // by type
  Committor all_;
  std::vector<double> from_above_;  // (columns x inputs)
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
