#pragma once
/// Chains that several tests walk on.

#include <cstdint>
#include <vector>

#include "markov/chain.h"

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

inline constexpr Field kNineByNine{9, 9};
inline constexpr Start kBottomCentre{4, 0, 12};

}  // namespace gatewalk::markov::test
