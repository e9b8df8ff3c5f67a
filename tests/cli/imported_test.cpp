// SPDX-License-Identifier: MIT
// Chains from elsewhere: counts that no matrix can hold, the order of states, rows that were
// rounded.
#include "cli/exchange/imported.h"

#include <gtest/gtest.h>

#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <random>
#include <stdexcept>

namespace gatewalk::cli {
namespace {

TEST(Imported, RefusesCountsWhoseSumIsNoCount) {
  constexpr int kStates = 70;
  std::vector<ForeignState> states;
  for (int s = 0; s < kStates; ++s) states.push_back({std::to_string(s), "ahead", 0, 1});
  const auto read = [&](int rows) {
    const std::string path = testing::TempDir() + "imported_counts.csv";
    std::ofstream file(path);
    file << "from,to,count\n";
    for (int from = 0; from < rows; ++from)
      for (int to = 0; to < kStates; ++to) file << from << ',' << to << ",1e15\n";
    file.close();
    return read_foreign(path, states).table.entries.size();
  };
  EXPECT_EQ(read(60), 60U * kStates);                     // 4.2e18 in all
  EXPECT_THROW((void)read(kStates), std::runtime_error);  // 4.9e18 in all; 2^62 is 4.6e18
}

TEST(Imported, ShowsStatesInTheOrderOfTheirTable) {
  const std::vector<ForeignState> states{
      {"up", "ahead", 0, 1}, {"aside", "right", 1, 0}, {"again", "ahead", 0, 1}};
  const lattice::CellFile cells = lattice::parse_cell_file(cell_text(states, 1.0, 1.0), "x.toml");
  const ForeignMatrix matrix{{3, 4, {{0, 1, 5.0}, {1, 2, 4.0}, {2, 3, 1.0}}, true}};
  lattice::MatrixFile file = matrix_file(transitions_of(matrix, states, cells), states, {});
  const dynamics::StateSpace& space = file.transitions.space;
  // The file keeps states of one face together: up, again, aside.
  EXPECT_EQ(file.state_names, (std::vector<std::string>{"up", "again", "aside", "trapped"}));
  EXPECT_EQ(lattice::shown_order(space), (std::vector<int>{0, 2, 1}));
  EXPECT_EQ(lattice::shown_number(space, 1), 2);
  EXPECT_EQ(lattice::shown_number(space, space.trapped()), 3);
  const auto counts = in_order(file.transitions.counts(), lattice::shown_order(space));
  EXPECT_EQ(counts.coeff(0, 1), 5);
  EXPECT_EQ(counts.coeff(1, 2), 4);
  EXPECT_EQ(counts.coeff(2, 3), 1);
  EXPECT_EQ(lattice::named_state(file, "1")->at[0], 1.0);
  EXPECT_EQ(lattice::named_state(file, "aside")->face, lattice::named_state(file, "1")->face);
  // Numbers that are not a permutation of the states are refused.
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const std::vector<double>& wrong :
       {std::vector<double>{0, 0, 1}, {0, 2}, {0, 2, 3}, {-1, 0, 1}, {0, 1.5, 1}, {0, nan, 1}}) {
    file.arrays.front().values = wrong;
    EXPECT_THROW(lattice::name_states(file, file.state_names), std::invalid_argument);
  }
}

TEST(Imported, TakesRowsAsFarOffAsRoundingMakesThem) {
  constexpr int kStates = 40;
  std::vector<ForeignState> states;
  for (int s = 0; s < kStates; ++s) states.push_back({std::to_string(s), "ahead", 0, 1});
  const std::string path = testing::TempDir() + "imported_rounded.csv";
  // A row whose numbers are multiples of the last digit. With seven digits or more, a float's
  // rounding would be larger.
  const auto read = [&](const std::vector<std::int64_t>& units, int digits) {
    std::ofstream file(path);
    file << "from,to,probability\n";
    for (std::size_t to = 0; to < units.size(); ++to) {
      std::array<char, 64> text{};
      std::to_chars(text.data(), text.data() + text.size() - 1,
                    static_cast<double>(units[to]) * std::pow(10.0, -digits),
                    std::chars_format::fixed, digits);
      file << "0," << to << ',' << text.data() << '\n';
    }
    file.close();
    return read_foreign(path, states);
  };
  std::mt19937 random(1);
  int off = 0;
  for (int digits = 3; digits <= 6; ++digits)
    for (const int n : {2, 3, 7, kStates}) {
      std::vector<double> p;
      double sum = 0.0;
      for (int k = 0; k < n; ++k)
        sum += p.emplace_back(1.0 + static_cast<double>(random() % 1000) / 1000.0);
      std::vector<std::int64_t> units;
      std::int64_t total = 0;
      const double one = std::pow(10.0, digits);
      for (const double x : p) total += units.emplace_back(std::llround(x / sum * one));
      off += total != std::llround(one) ? 1 : 0;
      EXPECT_TRUE(read(units, digits).probabilities) << n << " of " << digits << " digits";
      // Rounding can move a sum by half a unit for each number, not by one more.
      units.front() += std::llround(one) - total + n / 2 + 1;
      EXPECT_THROW((void)read(units, digits), std::runtime_error) << n << " of " << digits;
    }
  EXPECT_GE(off, 5);
}

}  // namespace
}  // namespace gatewalk::cli
