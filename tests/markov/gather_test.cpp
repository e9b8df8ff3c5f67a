// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <array>
#include <span>
#include <vector>

#include "markov/predict/stencil.h"
#include "tests/support/instruction_sets.h"

namespace gatewalk::markov {
namespace {

// For one to four cells and for few and many states, equal to the bit to the sums of its terms in
// their order.
TEST(Gather, IsTheSumOfItsTerms) {
  constexpr int kMoves = 3;
  for (const int states : {1, 87, 8192, 8193}) {
    const auto n = static_cast<std::size_t>(states);
    std::vector<GatherTerm> terms;
    std::vector<int> ends{0};
    for (int state = 0; state < states; ++state) {
      for (int k = 0; k < state % 7; ++k)
        terms.push_back({1.0 / (1 + k + state % 11), (state * 31 + k * 977) % states, k % kMoves});
      ends.push_back(static_cast<int>(terms.size()));
    }
    const std::size_t count = terms.size();
    terms.insert(terms.end(), kTermsAhead, {0.0, 0, 0});
    terms.shrink_to_fit();
    std::array<std::vector<double>, kMoves> from;
    for (std::size_t m = 0; m < kMoves; ++m)
      for (std::size_t i = 0; i < n * kLanes; ++i)
        from[m].push_back(1.0 / (1.0 + static_cast<double>(i % 1009)) + static_cast<double>(m));
    gatewalk::test::on_every_instruction_set([&] {
      for (int cells = 1; cells <= kMostGathered; ++cells) {
        std::vector<std::vector<double>> to(static_cast<std::size_t>(cells));
        std::vector<std::array<const double*, kMoves>> of_cell;  // every cell by other moves
        for (int c = 0; c < cells; ++c)
          of_cell.push_back({from[static_cast<std::size_t>(c) % kMoves].data(),
                             from[static_cast<std::size_t>(c + 1) % kMoves].data(),
                             from[static_cast<std::size_t>(c + 2) % kMoves].data()});
        std::vector<GatherCell> some;
        for (std::size_t c = 0; c < to.size(); ++c) {
          to[c].assign(n * kLanes, -1.0);
          some.push_back({of_cell[c].data(), to[c].data()});
        }
        gather({terms.data(), ends.data(), states}, some);
        for (std::size_t c = 0; c < to.size(); ++c) {
          std::vector<double> expected(n * kLanes, 0.0);
          std::size_t state = 0;
          for (std::size_t k = 0; k < count; ++k) {
            while (static_cast<int>(k) >= ends[state + 1]) ++state;
            for (std::size_t lane = 0; lane < kLanes; ++lane)
              expected[state * kLanes + lane] +=
                  terms[k].p * of_cell[c][static_cast<std::size_t>(terms[k].move)]
                                      [static_cast<std::size_t>(terms[k].source) * kLanes + lane];
          }
          EXPECT_EQ(to[c], expected) << cells << " cells of " << states << " states";
        }
      }
    });
  }
}

}  // namespace
}  // namespace gatewalk::markov
