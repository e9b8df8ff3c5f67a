#include "markov/walk.h"

#include <Random123/philox.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>

#include "chains.h"

namespace gatewalk::markov {
namespace {

using test::kBottomCentre;
using test::kNineByNine;
using test::lattice_counts;
using test::lattice_exits;
using test::matrix;

constexpr std::uint64_t kLastWord = std::numeric_limits<std::uint64_t>::max();

bool same(const WalkTally& a, const WalkTally& b) {
  return (a.final_cells == b.final_cells).all() && a.walks == b.walks && a.trapped == b.trapped &&
         a.left_field == b.left_field && a.cut_off == b.cut_off && a.unsampled == b.unsampled &&
         a.steps == b.steps;
}

// How many of the 2^64 words draw each output. A slot shows one output, then perhaps another.
std::map<int, long double> words_per_output(const Walker& walker, int row, int slots) {
  __extension__ using Wide = unsigned __int128;
  const auto first_of = [slots](int slot) {
    const Wide n = static_cast<Wide>(slots);
    return ((static_cast<Wide>(slot) << 64) + n - 1) / n;
  };
  std::map<int, long double> words;
  for (int slot = 0; slot < slots; ++slot) {
    const auto first = static_cast<std::uint64_t>(first_of(slot));
    const auto last = static_cast<std::uint64_t>(first_of(slot + 1) - 1);
    const int here = walker.draw(row, first);
    const int other = walker.draw(row, last);
    std::uint64_t below = first, above = last;  // draw(below) == here
    while (here != other && above - below > 1) {
      const std::uint64_t middle = below + (above - below) / 2;
      const int drawn = walker.draw(row, middle);
      EXPECT_TRUE(drawn == here || drawn == other);
      (drawn == here ? below : above) = middle;
    }
    const std::uint64_t last_here = here == other ? last : below;
    words[here] += static_cast<long double>(last_here - first) + 1;
    words[other] += static_cast<long double>(last - last_here);
  }
  return words;
}

TEST(Walker, EveryProbabilityIsMetToAFewWordsOf2To64) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Chain chain = Chain::from_counts(lattice_counts(seed), lattice_exits());
    const Walker walker(chain);
    for (int row = 0; row < chain.inputs(); ++row) {
      const auto slots = static_cast<int>(chain.matrix().row(row).nonZeros());
      auto words = words_per_output(walker, row, slots);
      long double sum = 0;
      double largest = 0;
      for (Probabilities::InnerIterator it(chain.matrix(), row); it; ++it) {
        sum += it.value();
        largest = std::max(largest, it.value());
      }
      for (Probabilities::InnerIterator it(chain.matrix(), row); it; ++it) {
        const long double expected = std::ldexp(static_cast<long double>(it.value()), 64);
        // Two words for each slot an output shares; the largest takes the row's own rounding.
        const long double bound =
            2.0L * slots + (it.value() == largest ? std::ldexp(std::abs(1 - sum), 64) : 0.0L);
        EXPECT_LE(std::abs(words[static_cast<int>(it.col())] - expected), bound);
        words.erase(static_cast<int>(it.col()));
      }
      // No word draws an output of probability zero.
      for (const auto& [output, count] : words) EXPECT_EQ(count, 0) << output;
    }
  }
}

TEST(Walker, TheExtremeWordsAreValid) {
  // 1/2 and 1/2: both slots are always kept.
  const Walker even(Chain::from_probabilities(
      matrix(1, 3, {{0, 0, 0.5}, {0, 2, 0.5}}), {{0, 0, 0}, {0, 0, 0}, {}}));
  EXPECT_EQ(even.draw(0, 0), 0);
  EXPECT_EQ(even.draw(0, kLastWord / 2), 0);
  EXPECT_EQ(even.draw(0, kLastWord / 2 + 1), 2);
  EXPECT_EQ(even.draw(0, kLastWord), 2);
  // A single output owns every word.
  const Walker sure(Chain::from_probabilities(matrix(1, 3, {{0, 1, 1.0}}), {{}, {}, {}}));
  EXPECT_EQ(sure.draw(0, 0), 1);
  EXPECT_EQ(sure.draw(0, kLastWord), 1);
}

TEST(Walker, KeepsAnEntryTooSmallForA64BitWord) {
  const Chain chain =
      Chain::from_probabilities(matrix(1, 2, {{0, 0, 1.0}, {0, 1, 1e-300}}), {{0, 0, 0}, {}});
  auto words = words_per_output(Walker(chain), 0, 2);
  EXPECT_LE(words[1], 1.0L);
  EXPECT_EQ(words[0] + words[1], std::ldexp(1.0L, 64));
}

TEST(Walker, RefusesARowItCannotDrawFrom) {
  const Walker walker(
      Chain::from_probabilities(matrix(2, 2, {{0, 1, 1.0}}), {{0, 0, 0}, {}}));
  EXPECT_THROW((void)walker.draw(1, 0), std::invalid_argument);
  EXPECT_THROW((void)walker.draw(-1, 0), std::invalid_argument);
  EXPECT_THROW((void)walker.draw(2, 0), std::invalid_argument);
}

TEST(Walk, FrequenciesPassChiSquare) {
  // From cell 0 one of ten cells, there trapped; p = 1/55 ... 10/55.
  constexpr int kCells = 10;
  constexpr std::int64_t kWalks = 1'000'000;
  Counts counts(2, kCells + 1);
  std::vector<Exit> exits;
  for (int j = 0; j < kCells; ++j) {
    counts.coeffRef(0, j) = j + 1;
    exits.push_back({1, j, 0});
  }
  counts.coeffRef(1, kCells) = 1;
  exits.push_back({});
  const Walker walker(Chain::from_counts(counts, exits));
  const WalkTally tally = walker.walk({kCells, 1}, {0, 0, 0}, 0, 7, {0, kWalks});
  double chi2 = 0;
  for (int j = 0; j < kCells; ++j) {
    const double expected = kWalks * (j + 1) / 55.0;
    const double off = static_cast<double>(tally.final_cells(0, j)) - expected;
    chi2 += off * off / expected;
  }
  EXPECT_LT(chi2, 44.81);  // 9 degrees of freedom, exceeded with probability 1e-6
  EXPECT_GT(chi2, 0.228);   // and undercut with probability 1e-6: not too even to be random
  EXPECT_EQ(tally.trapped, kWalks);
  EXPECT_EQ(tally.steps, 2 * kWalks);
}

TEST(Walk, IsTheDocumentedStream) {
  r123::Philox4x64 philox;
  const auto known = philox({{0, 0, 0, 0}}, {{0, 0}});  // Random123's known-answer vector
  EXPECT_EQ(known[0], 0x16554d9eca36314cU);
  EXPECT_EQ(known[3], 0x7e68b68aec7ba23bU);

  Counts counts = lattice_counts(3);
  test::empty_row(counts, 40);
  const Chain chain = Chain::from_counts(counts, lattice_exits());
  const Walker walker(chain);
  constexpr std::uint64_t kSeed = 2024;
  for (const int max_cells : {1, 2, 3, 13}) {
    const WalkRange range{1'000'000'007, 2000};
    std::vector<std::int32_t> final_cell;
    const WalkTally tally =
        walker.walk(kNineByNine, kBottomCentre, max_cells, kSeed, range, &final_cell);
    WalkTally replay;
    replay.final_cells = CellCounts::Zero(9, 9);
    replay.walks = range.count;
    for (std::int64_t w = range.first; w < range.first + range.count; ++w) {
      int column = kBottomCentre.column, row = kBottomCentre.row, input = kBottomCentre.input;
      for (int draw = 0;; ++draw) {
        if (!chain.is_sampled(input)) {
          ++replay.unsampled;
          break;
        }
        const auto words = philox({{static_cast<std::uint64_t>(draw / 4),
                                    static_cast<std::uint64_t>(w),
                                    static_cast<std::uint64_t>(kBottomCentre.input), 0}},
                                  {{kSeed, kWalkStream}});
        ++replay.steps;
        const int output = walker.draw(input, words[static_cast<std::size_t>(draw % 4)]);
        const Exit exit = chain.exits()[static_cast<std::size_t>(output)];
        const int next_column = column + exit.di_x, next_row = row + exit.di_y;
        if (exit.next_input == Exit::kTrapped) {
          ++replay.trapped;
          break;
        }
        if (next_column < 0 || next_column > 8 || next_row < 0 || next_row > 8) {
          ++replay.left_field;
          break;
        }
        if (draw + 1 == max_cells) {
          ++replay.cut_off;
          break;
        }
        column = next_column;
        row = next_row;
        input = exit.next_input;
      }
      ++replay.final_cells(row, column);
      EXPECT_EQ(final_cell[static_cast<std::size_t>(w - range.first)], row * 9 + column);
    }
    EXPECT_TRUE(same(tally, replay)) << "max_cells " << max_cells;
  }
}

TEST(Walk, SameTallyForAnyThreadsAndAnySplit) {
  const Walker walker(Chain::from_counts(lattice_counts(1), lattice_exits()));
  const auto run = [&](WalkRange range, std::vector<std::int32_t>* cells) {
    return walker.walk(kNineByNine, kBottomCentre, 13, 42, range, cells);
  };
  constexpr std::int64_t kWalks = 100'003;
  std::vector<std::int32_t> cells_alone, cells;
  const WalkTally alone = [&] {
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    return run({0, kWalks}, &cells_alone);
  }();
  EXPECT_EQ(alone.walks, kWalks);
  for (const int threads : {2, 3, 8}) {
    const tbb::global_control allow(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(threads));
    tbb::task_arena arena(threads);
    const WalkTally tally = arena.execute([&] { return run({0, kWalks}, &cells); });
    EXPECT_TRUE(same(tally, alone)) << threads << " threads";
    EXPECT_EQ(cells, cells_alone) << threads << " threads";
  }
  WalkTally parts;
  for (const WalkRange range :
       {WalkRange{50'000, 50'003}, {0, 1}, {1, 0}, {1, 4096}, {4097, 45'903}}) {
    parts += run(range, nullptr);
  }
  EXPECT_TRUE(same(parts, alone));
}

TEST(Walk, SameSeedSameWalksOtherSeedOtherWalks) {
  const Walker walker(Chain::from_counts(lattice_counts(1), lattice_exits()));
  const auto run = [&](std::uint64_t seed) {
    return walker.walk(kNineByNine, kBottomCentre, 13, seed, {0, 10'000});
  };
  EXPECT_TRUE(same(run(1), run(1)));
  EXPECT_FALSE(same(run(1), run(2)));
}

TEST(Walk, GoldenTally) {
  const Walker walker(Chain::from_counts(lattice_counts(1), lattice_exits()));
  const WalkTally tally = walker.walk(kNineByNine, kBottomCentre, 13, 1, {0, 100'000});
  std::uint64_t hash = 0;
  for (const std::int64_t n : tally.final_cells.reshaped<Eigen::RowMajor>()) {
    hash = hash * 0x9e3779b97f4a7c15 + static_cast<std::uint64_t>(n);
  }
  EXPECT_EQ(tally.trapped, 66'503);
  EXPECT_EQ(tally.left_field, 10'605);
  EXPECT_EQ(tally.cut_off, 22'892);
  EXPECT_EQ(tally.steps, 742'039);
  EXPECT_EQ(hash, 10841551127325524228U);
}

TEST(Walk, WithoutLimitIsCutOffAfterAMillionCells) {
  const Walker loop(Chain::from_probabilities(matrix(1, 1, {{0, 0, 1.0}}), {{0, 0, 0}}));
  const WalkTally tally = loop.walk({1, 1}, {0, 0, 0}, 0, 1, {0, 3});
  EXPECT_EQ(tally.cut_off, 3);
  EXPECT_EQ(tally.steps, 3'000'000);
  EXPECT_EQ(tally.final_cells(0, 0), 3);
}

TEST(Walk, AMoveFarBeyondTheFieldLeavesIt) {
  constexpr int kFar = std::numeric_limits<int>::max();
  const Walker walker(Chain::from_probabilities(
      matrix(2, 2, {{0, 0, 1.0}, {1, 1, 1.0}}), {{0, kFar, kFar}, {0, -kFar - 1, 0}}));
  for (const int input : {0, 1}) {
    const WalkTally tally = walker.walk({3, 3}, {2, 2, input}, 0, 1, {0, 5});
    EXPECT_EQ(tally.left_field, 5);
    EXPECT_EQ(tally.final_cells(2, 2), 5);
  }
}

TEST(Walk, RefusesARangeThatIsNone) {
  const Walker walker(Chain::from_probabilities(matrix(1, 1, {{0, 0, 1.0}}), {{}}));
  const auto run = [&](std::int64_t first, std::int64_t count) {
    return walker.walk({1, 1}, {0, 0, 0}, 0, 1, {first, count});
  };
  constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
  EXPECT_THROW((void)run(-1, 1), std::invalid_argument);
  EXPECT_THROW((void)run(0, -1), std::invalid_argument);
  EXPECT_THROW((void)run(kMost, 1), std::invalid_argument);
  EXPECT_EQ(run(kMost - 2, 2).walks, 2);
  EXPECT_EQ(run(0, 0).final_cells.size(), 1);
  EXPECT_THROW((void)walker.walk({1, 1}, {0, 0, 1}, 0, 1, {0, 1}), std::invalid_argument);
}

TEST(Walk, TalliesOfDifferentFieldsAreNotAdded) {
  WalkTally wide, high;
  wide.final_cells = CellCounts::Constant(1, 2, 3);
  high.final_cells = CellCounts::Constant(2, 1, 3);
  EXPECT_THROW(wide += high, std::invalid_argument);
  WalkTally none;
  none += wide;
  none += WalkTally{};
  EXPECT_TRUE(same(none, wide));
}

}  // namespace
}  // namespace gatewalk::markov
