// SPDX-License-Identifier: MIT
#pragma once
/// Chains that several tests walk on.

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "markov/decide.h"
#include "markov/predict.h"

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

/// Exits of the paper's kind: left, right and up only.
inline std::vector<Exit> never_down() {
  auto exits = lattice_exits();
  for (Exit& exit : exits)
    if (exit.di_y < 0) exit.di_y = 1;
  return exits;
}

/// Moves of several cells at once, down too.
inline std::vector<Exit> leaps() {
  auto exits = lattice_exits();
  for (std::size_t j = 0; j + 1 < exits.size(); ++j) {
    exits[j].di_x = static_cast<int>(j % 7) - 3;
    exits[j].di_y = static_cast<int>(j % 5) - 2;
  }
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

/// Five states, one a boundary: entered from below (0), by a move to the left (1, 3) or to the
/// right (2, 4). The last output is trapped.
inline std::vector<Exit> boundary_exits() {
  return {{0, 0, 1}, {1, -1, 0}, {2, 1, 0}, {3, -1, 0}, {4, 1, 0}, {}};
}
/// The same with moves down in state 3.
inline std::vector<Exit> boundary_exits_down() {
  auto exits = boundary_exits();
  exits[3] = {3, 0, -1};
  return exits;
}
inline Counts boundary_counts(std::uint64_t seed) {
  Words words(seed);
  Counts counts(5, 6);
  for (int row = 0; row < 5; ++row)
    for (int column = 0; column < 6; ++column) counts.insert(row, column) = 1 + words.below(20);
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

/// The same endings, in all and cell by cell, within `bound` each.
inline void expect_same_endings(const FinalDistribution& a, const FinalDistribution& b,
                                double bound) {
  for (std::size_t e = 0; e < kEndings; ++e)
    EXPECT_NEAR(a.endings[e], b.endings[e], bound) << "ending " << e;
  EXPECT_LE((trapped_cells(a) - trapped_cells(b)).abs().maxCoeff(), bound);
  EXPECT_LE((departed_cells(a) - departed_cells(b)).abs().maxCoeff(), bound);
}

/// Endings add up to the numbers that were there before them, and so do the cells'.
inline void expect_endings_add_up(const FinalDistribution& d) {
  constexpr double kFewEps = 1e-14;
  const auto of = [&](Ending e) { return d.endings[static_cast<std::size_t>(e)]; };
  EXPECT_EQ(of(Ending::trapped), d.trapped);
  EXPECT_EQ(of(Ending::cut_off), d.cut_off);
  EXPECT_EQ(of(Ending::unsampled), d.unsampled);
  double left = 0.0;
  for (const Ending edge : kEdges) left += of(edge);
  EXPECT_NEAR(left, d.left_field, kFewEps);
  EXPECT_NEAR(trapped_cells(d).sum(), d.trapped, kFewEps);
  EXPECT_NEAR(departed_cells(d).sum(), d.left_field, kFewEps);
  std::int64_t before = -1;
  for (const CellEndings& c : d.mixed_cells) {
    EXPECT_GT(c.cell, before);
    before = c.cell;
    double mass = 0.0;
    for (const double part : c.by_ending) mass += part;
    EXPECT_NEAR(mass, d.final_cells.data()[c.cell], kFewEps);
  }
}

/// The rule of a step as walk.h words it: no boxes, no sparse rows, and digits to spare.
inline FinalDistribution propagate_plainly(const Chain& chain, const Field& field,
                                           const Start& start, int max_cells) {
  using State = std::array<int, 3>;          // column, row, input
  const Eigen::MatrixXd p = chain.matrix();  // (n_in x n_out)
  long double draws = 0;
  std::map<std::array<int, 2>, std::array<long double, kEndings>> final_cells;  // by Ending
  const auto end = [&](Ending why, int column, int row, long double mass) {
    final_cells[{row, column}][static_cast<std::size_t>(why)] += mass;
  };
  std::map<State, long double> walking = {{{start.column, start.row, start.input}, 1.0L}};
  for (int visited = 1; !walking.empty(); ++visited) {
    std::map<State, long double> next;
    for (const auto& [state, mass] : walking) {
      const auto [column, row, input] = state;
      if (p.row(input).sum() == 0.0) {
        end(Ending::unsampled, column, row, mass);
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
        if (exit.next_input == Exit::kTrapped)
          end(Ending::trapped, column, row, m);
        else if (!is_inside)
          end(r >= field.rows ? Ending::far_edge
              : r < 0         ? Ending::near_edge
              : c < 0         ? Ending::left_edge
                              : Ending::right_edge,
              column, row, m);
        else if (visited == max_cells)
          end(Ending::cut_off, column, row, m);
        else
          next[{c, r, exit.next_input}] += m;
      }
    }
    walking = std::move(next);
  }
  FinalDistribution d;
  d.final_cells = CellProbabilities::Zero(field.rows, field.columns);
  std::array<long double, kEndings> all{};
  for (const auto& [cell, parts] : final_cells) {
    CellEndings here{std::int64_t{cell[0]} * field.columns + cell[1], {}};
    long double mass = 0;
    for (std::size_t e = 0; e < kEndings; ++e) {
      here.by_ending[e] = static_cast<double>(parts[e]);
      all[e] += parts[e];
      mass += parts[e];
    }
    d.final_cells(cell[0], cell[1]) = static_cast<double>(mass);
    if (mass > parts[0]) d.mixed_cells.push_back(here);
  }
  for (std::size_t e = 0; e < kEndings; ++e) d.endings[e] = static_cast<double>(all[e]);
  d.trapped = d.endings[static_cast<std::size_t>(Ending::trapped)];
  d.cut_off = d.endings[static_cast<std::size_t>(Ending::cut_off)];
  d.unsampled = d.endings[static_cast<std::size_t>(Ending::unsampled)];
  for (const Ending edge : kEdges) d.left_field += d.endings[static_cast<std::size_t>(edge)];
  d.mean_steps = static_cast<double>(draws);
  return d;
}

inline constexpr auto kFar = static_cast<std::size_t>(Ending::far_edge);

/// A walk gains 1 by crossing.
inline Gains crossing() {
  Gains gains;
  gains.ending[kFar] = 1.0;
  return gains;
}

/// Two states, entered from below or from a side; outputs: ahead, right, left, back, trapped.
inline std::vector<Exit> few_exits() { return {{0, 0, 1}, {1, 1, 0}, {1, -1, 0}, {0, 0, -1}, {}}; }
inline Chain few(const std::vector<Entry>& entries) {
  return Chain::from_probabilities(matrix(2, 5, entries), few_exits());
}
/// Without the ways back and left nobody comes to a cell again.
inline Chain random_chain(Words& words, bool comes_back = true) {
  std::vector<Entry> entries;
  for (int input = 0; input < 2; ++input) {
    const int parts[] = {1 + words.below(9), words.below(9), comes_back ? words.below(9) : 0,
                         comes_back ? words.below(3) : 0, 1 + words.below(3)};
    int all = 0;
    for (const int part : parts) all += part;
    for (int output = 0; output < 5; ++output)
      if (parts[output] > 0)
        entries.push_back({input, output, static_cast<double>(parts[output]) / all});
  }
  return few(entries);
}

}  // namespace gatewalk::markov::test
