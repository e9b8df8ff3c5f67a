// SPDX-License-Identifier: MIT
#include "markov/design.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "markov/predict.h"
#include "tests/markov/chains.h"
#include "tests/support/propagation.h"

namespace gatewalk::markov {
namespace {

using test::crossing;
using test::kFar;
using test::random_chain;

FieldChain random_field(test::Words& words, const Field& field, int types) {
  std::vector<Chain> chains;
  for (int t = 0; t < types; ++t) chains.push_back(random_chain(words));
  std::vector<int> map;
  for (int c = 0; c < field.columns * field.rows; ++c) map.push_back(words.below(types));
  return FieldChain::by_cell(std::move(chains), field.columns, std::move(map));
}

double crosses(const FieldChain& chain, const Field& field, const Start& start, int max_cells,
               const std::vector<int>& map) {
  return test::propagate(FieldChain::by_cell(chain.chains(), field.columns, map), field, start,
                         {.max_cells = max_cells})
      .endings[kFar];
}

std::vector<int> own_map(const FieldChain& chain, const Field& field) {
  std::vector<int> map;
  for (int row = 0; row < field.rows; ++row)
    for (int column = 0; column < field.columns; ++column)
      map.push_back(chain.type_of(column, row));
  return map;
}

/// The best of all maps that differ in at most `changes` cells from `cell` on.
double best_of_all(const FieldChain& chain, const Field& field, const Start& start, int max_cells,
                   std::vector<int>& map, std::size_t cell, int changes, double sign) {
  double best = sign * crosses(chain, field, start, max_cells, map);
  if (changes == 0) return best;
  for (std::size_t c = cell; c < map.size(); ++c) {
    const int own = map[c];
    for (int type = 0; type < static_cast<int>(chain.chains().size()); ++type) {
      if (type == own) continue;
      map[c] = type;
      best = std::max(best,
                      best_of_all(chain, field, start, max_cells, map, c + 1, changes - 1, sign));
    }
    map[c] = own;
  }
  return best;
}

std::vector<std::vector<int>> random_maps(test::Words& words, const std::vector<int>& own,
                                          int types, int changes, int number) {
  std::vector<std::vector<int>> maps(static_cast<std::size_t>(number), own);
  for (std::vector<int>& map : maps)
    for (int i = 0; i < changes; ++i)
      map[static_cast<std::size_t>(words.below(static_cast<int>(map.size())))] = words.below(types);
  return maps;
}

void expect_best(const Field& field, int types, int changes, int max_cells, std::uint64_t seed) {
  test::Words words(seed);
  const FieldChain chain = random_field(words, field, types);
  const Start start{field.columns / 2, 0, 0};
  const std::vector<int> own = own_map(chain, field);
  for (const bool least : {false, true}) {
    const double sign = least ? -1.0 : 1.0;
    std::vector<int> map = own;
    const double best = best_of_all(chain, field, start, max_cells, map, 0, changes, sign);
    DesignOptions options;
    options.max_cells = max_cells;
    options.least = least;
    options.most_changes = changes;
    options.from = random_maps(words, own, types, changes, 8);
    const Designs found = design(chain, field, start, crossing(), options);
    ASSERT_FALSE(found.optima.empty());
    EXPECT_NEAR(sign * found.optima[0].gain, best, 1e-11) << "seed " << seed << ", sign " << sign;
    int searches = 0;
    for (const FieldDesign& d : found.optima) {
      searches += d.searches;
      EXPECT_LE(sign * d.gain, sign * found.optima[0].gain);
      EXPECT_NEAR(d.gain, crosses(chain, field, start, max_cells, d.type_of_cell), 1e-11);
      int differ = 0;
      for (std::size_t c = 0; c < own.size(); ++c) differ += d.type_of_cell[c] != own[c];
      EXPECT_LE(differ, changes);
    }
    EXPECT_EQ(searches, 9);
    EXPECT_NEAR(found.before, crosses(chain, field, start, max_cells, own), 1e-11);
  }
}

TEST(Design, IsTheBestOfAllMapsOfASmallField) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    expect_best({3, 3}, 2, 1 + static_cast<int>(seed % 4), 0, seed);
    expect_best({3, 3}, 3, 2, 5, seed);
  }
}

TEST(Design, IsTheBestOfAllMapsOfSixteenCells) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    expect_best({4, 4}, 2, 3, 0, 100 + seed);
    expect_best({4, 4}, 2, 3, 6, 200 + seed);
    expect_best({4, 4}, 3, 2, 0, 300 + seed);
  }
}

// All cells may change, each between two of four types: the best of all 512 maps.
TEST(Design, CellsStayOfTheirKind) {
  const Field field{3, 3};
  const Start start{1, 0, 0};
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    test::Words words(400 + seed);
    const FieldChain chain = random_field(words, field, 4);
    const std::vector<int> own = own_map(chain, field);
    DesignOptions options;
    options.max_cells = seed % 2 == 0 ? 5 : 0;
    options.most_changes = 9;
    options.kind_of_type = {7, 3, 7, 3};
    double best = 0.0;
    std::vector<std::vector<int>> maps;
    for (int number = 0; number < 512; ++number) {
      std::vector<int> map = own;
      for (std::size_t c = 0; c < 9; ++c) map[c] = own[c] % 2 + 2 * (number >> c & 1);
      best = std::max(best, crosses(chain, field, start, options.max_cells, map));
      if (number % 32 == 0) maps.push_back(std::move(map));
    }
    options.from = maps;
    const Designs found = design(chain, field, start, crossing(), options);
    EXPECT_NEAR(found.optima[0].gain, best, 1e-11) << seed;
    for (const FieldDesign& d : found.optima)
      for (std::size_t c = 0; c < 9; ++c) EXPECT_EQ(d.type_of_cell[c] % 2, own[c] % 2);
    options.from = {own};
    options.from[0][4] = 1 - own[4] % 2;
    EXPECT_THROW((void)design(chain, field, start, crossing(), options), std::invalid_argument);
    options.from.clear();
    options.kind_of_type = {0, 1};
    EXPECT_THROW((void)design(chain, field, start, crossing(), options), std::invalid_argument);
  }
}

// If walks never return to a cell, the effect of a single change is linear.
TEST(Design, TheGradientIsExactWhereNobodyComesBack) {
  test::Words words(11);
  const Field field{4, 4};
  std::vector<Chain> chains;
  for (int t = 0; t < 3; ++t) chains.push_back(random_chain(words, false));
  std::vector<int> own;
  for (int c = 0; c < 16; ++c) own.push_back(words.below(3));
  const FieldChain chain = FieldChain::by_cell(chains, 4, own);
  const Start start{1, 0, 1};
  for (const int max_cells : {0, 5}) {
    DesignOptions options;
    options.max_cells = max_cells;
    const Designs found = design(chain, field, start, crossing(), options);
    for (std::size_t cell = 0; cell < own.size(); ++cell)
      for (int type = 0; type < 3; ++type) {
        std::vector<int> map = own;
        map[cell] = type;
        EXPECT_NEAR(found.gradient[cell * 3 + static_cast<std::size_t>(type)],
                    crosses(chain, field, start, max_cells, map) - found.before, 1e-12)
            << cell << ' ' << type;
      }
  }
}

TEST(Design, OnlyWhatCellsMayBecome) {
  test::Words words(12);
  const Field field{3, 3};
  const FieldChain chain = random_field(words, field, 3);
  const Start start{1, 0, 0};
  DesignOptions options;
  options.most_changes = 9;
  options.become = {1};
  const std::vector<int> own = own_map(chain, field);
  for (const FieldDesign& d : design(chain, field, start, crossing(), options).optima)
    for (std::size_t c = 0; c < own.size(); ++c)
      EXPECT_TRUE(d.type_of_cell[c] == own[c] || d.type_of_cell[c] == 1);
  const auto refused = [&](auto change) {
    DesignOptions wrong;
    change(wrong);
    EXPECT_THROW((void)design(chain, field, start, crossing(), wrong), std::invalid_argument);
  };
  refused([](DesignOptions& o) { o.most_changes = 0; });
  refused([](DesignOptions& o) { o.most_changes = 10; });
  refused([](DesignOptions& o) { o.become = {3}; });
  refused([](DesignOptions& o) { o.from = {{0, 0}}; });
  refused([&](DesignOptions& o) {
    o.from = {own};
    for (int& type : o.from[0]) type = (type + 1) % 3;  // nine changes
  });
  Gains draws = crossing();
  draws.draw = {{{-1.0, -1.0}}};
  EXPECT_THROW((void)design(chain, field, start, draws, {}), std::invalid_argument);
}

}  // namespace
}  // namespace gatewalk::markov
