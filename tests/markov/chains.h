#pragma once
/// Chains that several tests walk on.

#include <array>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "markov/exact.h"

namespace gatewalk::markov::test {

/// SplitMix64: test data only, the same everywhere.
class Words {
 public:
  explicit Words(std::uint64_t seed) : state_(seed) {}
  std::uint64_t operator()() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return z ^ (z >> 31);
  }
  int below(int n) { return static_cast<int>((*this)() % static_cast<std::uint64_t>(n)); }

 private:
  std::uint64_t state_;
};

struct Entry {
  int row;
  int column;
  double p;
};

inline Probabilities matrix(int inputs, int outputs, const std::vector<Entry>& entries) {
  Probabilities p(inputs, outputs);
  for (const Entry& e : entries) p.coeffRef(e.row, e.column) = e.p;
  return p;
}

/// The paper's shape, no physics: 87 inputs, 88 outputs of which the last is trapped; moves up
/// (25 outputs), right (30), left (30) and down (2); about 12 outputs a row.
inline std::vector<Exit> lattice_exits() {
  std::vector<Exit> exits;
  for (int j = 0; j < 87; ++j) {
    Exit exit{j, 0, 0};
    if (j < 25) {
      exit.di_y = 1;
    } else if (j < 55) {
      exit.di_x = 1;
    } else if (j < 85) {
      exit.di_x = -1;
    } else {
      exit.di_y = -1;
    }
    exits.push_back(exit);
  }
  exits.push_back({});
  return exits;
}

inline Counts lattice_counts(std::uint64_t seed) {
  Words words(seed);
  Counts counts(87, 88);
  for (int row = 0; row < 87; ++row) {
    for (int k = 0; k < 11; ++k) {
      const int kind = words.below(10);
      const int column = kind < 5   ? words.below(25)
                         : kind < 7 ? 25 + words.below(30)
                         : kind < 9 ? 55 + words.below(30)
                                    : 85 + words.below(2);
      counts.coeffRef(row, column) += 1 + words.below(15);
    }
    counts.coeffRef(row, 87) += 5 + words.below(10);
  }
  return counts;
}

inline void empty_row(Counts& counts, int row) {
  counts.prune([row](Eigen::Index r, Eigen::Index, std::int64_t) { return r != row; });
}

/// Two states that pass to each other with 1 - escape, so I - Q has condition 2/escape.
inline Chain nearly_closed(double escape) {
  return Chain::from_probabilities(
      matrix(2, 3, {{0, 1, 1 - escape}, {0, 2, escape}, {1, 0, 1 - escape}, {1, 2, escape}}),
      {{0, -1, 0}, {1, 1, 0}, {}});
}

inline constexpr Field kNineByNine{9, 9};
inline constexpr Start kBottomCentre{4, 0, 12};

/// The rule of a step as walk.h words it: no boxes, no sparse rows, and digits to spare.
inline FinalDistribution propagate_plainly(const Chain& chain, const Field& field, const Start& start,
                                    int max_cells) {
  using State = std::array<int, 3>;             // column, row, input
  const Eigen::MatrixXd p = chain.matrix();     // (n_in x n_out)
  long double trapped = 0, left_field = 0, cut_off = 0, unsampled = 0, draws = 0;
  std::map<std::array<int, 2>, long double> final_cells;
  std::map<State, long double> walking = {{{start.column, start.row, start.input}, 1.0L}};
  for (int visited = 1; !walking.empty(); ++visited) {
    std::map<State, long double> next;
    for (const auto& [state, mass] : walking) {
      const auto [column, row, input] = state;
      if (p.row(input).sum() == 0.0) {
        unsampled += mass;
        final_cells[{row, column}] += mass;
        continue;
      }
      draws += mass;
      for (int output = 0; output < chain.outputs(); ++output) {
        const long double m = mass * p(input, output);
        if (m == 0) continue;
        const Exit& exit = chain.exits()[static_cast<std::size_t>(output)];
        const int c = column + exit.di_x;
        const int r = row + exit.di_y;
        const bool is_inside = c >= 0 && c < field.columns && r >= 0 && r < field.rows;
        long double* const end = exit.next_input == Exit::kTrapped ? &trapped
                                 : !is_inside                      ? &left_field
                                 : visited == max_cells            ? &cut_off
                                                                   : nullptr;
        if (end) {
          *end += m;
          final_cells[{row, column}] += m;
        } else {
          next[{c, r, exit.next_input}] += m;
        }
      }
    }
    walking = std::move(next);
  }
  FinalDistribution d;
  d.final_cells = CellProbabilities::Zero(field.rows, field.columns);
  for (const auto& [cell, mass] : final_cells) {
    d.final_cells(cell[0], cell[1]) = static_cast<double>(mass);
  }
  d.trapped = static_cast<double>(trapped);
  d.left_field = static_cast<double>(left_field);
  d.cut_off = static_cast<double>(cut_off);
  d.unsampled = static_cast<double>(unsampled);
  d.mean_steps = static_cast<double>(draws);
  return d;
}

}  // namespace gatewalk::markov::test
