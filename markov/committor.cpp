#include "markov/committor.h"

#include <algorithm>
#include <cmath>
#include <numeric>
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

std::vector<Moves> moves_by_type(const FieldChain& chain) {
  std::vector<Moves> moves;
  for (const Chain& c : chain.chains()) {
    for (const Exit& exit : c.exits())
      if (exit.di_y < 0) throw std::invalid_argument("committor: a move leads to a row below");
    moves.emplace_back(c);
  }
  return moves;
}

[[noreturn]] void refuse_circles(int row) {
  throw std::runtime_error("committor: row " + std::to_string(row) +
                           " of the field does not settle in " + std::to_string(kMostSweeps) +
                           " sweeps: walks circle in it");
}

class Rows {
 public:
  Rows(const FieldChain& chain, const Field& field)
      : chain_(chain),
        field_(field),
        moves_(moves_by_type(chain)),
        all_{field.columns, field.rows, chain.inputs(), {}},
        from_above_(static_cast<std::size_t>(field.columns) *
                    static_cast<std::size_t>(chain.inputs())) {
    all_.values.resize(from_above_.size() * static_cast<std::size_t>(field.rows));
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
    refuse_circles(row);
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
  return Rows(chain, field).solve();
}

std::vector<double> row_chances(const FieldChain& chain, const Field& field, const Start& start) {
  validate(chain, field, start, 0);
  const std::vector<Moves> moves = moves_by_type(chain);
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
    for (int sweep = 0; left > kTolerance * up; ++sweep) {
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
