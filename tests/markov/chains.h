// SPDX-License-Identifier: MIT
#pragma once
/// Chains that several tests share.

#include <gtest/gtest.h>

#include <cstdint>
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

/// A chain of the paper's shape without physics: 87 inputs, 88 outputs, the last of which is
/// trapped; moves up (25 outputs), right (30), left (30) and down (2); about 12 outputs per row.
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

/// Exits as in the paper: left, right and up only.
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

/// Five states, one per boundary: entered from below (0), by a move to the left (1, 3) or to the
/// right (2, 4). The last output is trapped.
inline std::vector<Exit> boundary_exits() {
  return {{0, 0, 1}, {1, -1, 0}, {2, 1, 0}, {3, -1, 0}, {4, 1, 0}, {}};
}
/// The five states with moves down in state 3.
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

/// Two states that go to each other with probability 1 - escape, so I - Q has the condition number
/// 2/escape.
inline Chain nearly_closed(double escape) {
  return Chain::from_probabilities(
      matrix(2, 3, {{0, 1, 1 - escape}, {0, 2, escape}, {1, 0, 1 - escape}, {1, 2, escape}}),
      {{0, -1, 0}, {1, 1, 0}, {}});
}

inline constexpr Field kNineByNine{9, 9};
inline constexpr Start kBottomCentre{4, 0, 12};

/// Expects equal endings, in total and in each cell, within `bound` each.
inline void expect_same_endings(const FinalDistribution& a, const FinalDistribution& b,
                                double bound) {
  for (std::size_t e = 0; e < kEndings; ++e)
    EXPECT_NEAR(a.endings[e], b.endings[e], bound) << "ending " << e;
  EXPECT_LE((trapped_cells(a) - trapped_cells(b)).abs().maxCoeff(), bound);
  EXPECT_LE((departed_cells(a) - departed_cells(b)).abs().maxCoeff(), bound);
}

/// Expects the cells' endings to add up to those of the field, and to the cells' numbers.
inline void expect_endings_add_up(const FinalDistribution& d) {
  constexpr double kFewEps = 1e-14;
  EXPECT_NEAR(trapped_cells(d).sum(), d.trapped(), kFewEps);
  EXPECT_NEAR(departed_cells(d).sum(), d.left_field(), kFewEps);
  std::int64_t before = -1;
  for (const auto& c : d.mixed_cells) {
    EXPECT_GT(c.cell, before);
    before = c.cell;
    double mass = 0.0;
    for (const double part : c.by_ending) mass += part;
    EXPECT_NEAR(mass, d.final_cells.data()[c.cell], kFewEps);
  }
}

inline constexpr auto kFar = static_cast<std::size_t>(Ending::far_edge);

/// Gains of 1 for crossing.
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
/// Without moves back and to the left no walk returns to a cell.
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
