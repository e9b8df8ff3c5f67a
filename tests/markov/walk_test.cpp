// SPDX-License-Identifier: MIT
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
#include "markov/predict.h"
#include "tests/support/instruction_sets.h"
#include "tests/support/propagation.h"

namespace gatewalk::markov {
namespace {

using test::empty_row;
using test::kBottomCentre;
using test::kNineByNine;
using test::lattice_counts;
using test::lattice_exits;
using test::matrix;
using test::propagate;

constexpr std::uint64_t kLastWord = std::numeric_limits<std::uint64_t>::max();
constexpr std::uint64_t kLongSeed = 0xfedcba98'76543210;

bool same(const WalkTally& a, const WalkTally& b) {
  return (a.final_cells == b.final_cells).all() && a.walks == b.walks && a.steps == b.steps &&
         a.still_walking == b.still_walking && a.endings == b.endings &&
         a.mixed_cells == b.mixed_cells;
}

struct Walked {
  WalkTally tally;
  std::vector<std::int32_t> final_cells;
  friend bool operator==(const Walked& a, const Walked& b) {
    return same(a.tally, b.tally) && a.final_cells == b.final_cells;
  }
};

Walked in_lanes(const Walker& walker, const Field& field, const Start& start, int max_cells,
                WalkRange range) {
  Walked walked;
  walked.tally = walker.walk(field, start, max_cells, kLongSeed, range, &walked.final_cells);
  return walked;
}

Walked plainly(const Walker& walker, const Field& field, const Start& start, int max_cells,
               WalkRange range) {
  Walked walked;
  walked.tally =
      walker.walk_plainly(field, start, max_cells, kLongSeed, range, &walked.final_cells);
  return walked;
}

/// A chain whose rows 0, 12 (where kBottomCentre starts), 40 and 86 are unsampled.
Chain with_gaps(std::uint64_t seed) {
  Counts counts = lattice_counts(seed);
  for (const int row : {0, 12, 40, 86}) empty_row(counts, row);
  return Chain::from_counts(counts, lattice_exits());
}

/// Moves of up to `reach` cells, in all directions.
Chain leaping(std::uint64_t seed, int reach) {
  auto exits = lattice_exits();
  test::Words words(seed);
  for (std::size_t j = 0; j + 1 < exits.size(); ++j) {
    exits[j].di_x = words.below(2 * reach + 1) - reach;
    exits[j].di_y = words.below(2 * reach + 1) - reach;
  }
  return Chain::from_counts(lattice_counts(seed), exits);
}

/// A chain of very many nonzeros, all but three in the first row: to the right, up or in place.
Chain with_nonzeros(int nonzeros) {
  const int outputs = nonzeros - 3;
  Counts counts(2, outputs);
  counts.reserve(nonzeros);
  for (const auto& [row, entries] : {std::pair{0, outputs}, {1, 3}}) {
    counts.startVec(row);
    for (int j = 0; j < entries; ++j) counts.insertBack(row, j) = 1 + j % 5;
  }
  counts.finalize();
  std::vector<Exit> exits;
  for (int j = 0; j < outputs; ++j) exits.push_back({j % 2, j % 3 == 0, j % 3 == 1});
  return Chain::from_counts(counts, exits);
}

// The number of the 2^64 words that draw each output. A slot gives one output, then perhaps
// another.
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
  // 1/2 and 1/2: both slots keep all words.
  const Walker even(Chain::from_probabilities(matrix(1, 3, {{0, 0, 0.5}, {0, 2, 0.5}}),
                                              {{0, 0, 0}, {0, 0, 0}, {}}));
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
  const Walker walker(Chain::from_probabilities(matrix(2, 2, {{0, 1, 1.0}}), {{0, 0, 0}, {}}));
  EXPECT_THROW((void)walker.draw(1, 0), std::invalid_argument);
  EXPECT_THROW((void)walker.draw(-1, 0), std::invalid_argument);
  EXPECT_THROW((void)walker.draw(2, 0), std::invalid_argument);
}

TEST(Walk, FrequenciesPassChiSquare) {
  // From cell 0 to one of ten cells, trapped there; p = 1/55 ... 10/55.
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
  EXPECT_GT(chi2, 0.228);  // and undercut with probability 1e-6: not too even to be random
  EXPECT_EQ(tally.trapped(), kWalks);
  EXPECT_EQ(tally.steps, 2 * kWalks);
}

TEST(Walk, IsTheDocumentedStream) {
  r123::Philox4x64 philox;
  const auto known = philox({{0, 0, 0, 0}}, {{0, 0}});  // Random123's known-answer vector
  EXPECT_EQ(known[0], 0x16554d9eca36314cU);
  EXPECT_EQ(known[3], 0x7e68b68aec7ba23bU);

  Counts counts = lattice_counts(3);
  empty_row(counts, 40);
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
    std::vector<CellEndings<std::int64_t>> cells(81);
    for (std::int64_t w = range.first; w < range.first + range.count; ++w) {
      int column = kBottomCentre.column, row = kBottomCentre.row, input = kBottomCentre.input;
      Ending why{};
      for (int draw = 0;; ++draw) {
        if (!chain.is_sampled(input)) {
          why = Ending::unsampled;
          break;
        }
        const auto words =
            philox({{static_cast<std::uint64_t>(draw / 4), static_cast<std::uint64_t>(w),
                     static_cast<std::uint64_t>(kBottomCentre.input), 0}},
                   {{kSeed, kWalkStream}});
        ++replay.steps;
        const int output = walker.draw(input, words[static_cast<std::size_t>(draw % 4)]);
        const Exit exit = chain.exits()[static_cast<std::size_t>(output)];
        const int next_column = column + exit.di_x, next_row = row + exit.di_y;
        if (exit.next_input == Exit::kTrapped) {
          why = Ending::trapped;
          break;
        }
        if (next_column < 0 || next_column > 8 || next_row < 0 || next_row > 8) {
          why = next_row > 8      ? Ending::far_edge
                : next_row < 0    ? Ending::near_edge
                : next_column < 0 ? Ending::left_edge
                                  : Ending::right_edge;
          break;
        }
        if (draw + 1 == max_cells) {
          why = Ending::cut_off;
          break;
        }
        column = next_column;
        row = next_row;
        input = exit.next_input;
      }
      ++replay.endings[static_cast<std::size_t>(why)];
      ++replay.final_cells(row, column);
      ++cells[static_cast<std::size_t>(row * 9 + column)][why];
      EXPECT_EQ(final_cell[static_cast<std::size_t>(w - range.first)], row * 9 + column);
    }
    for (std::size_t i = 0; i < cells.size(); ++i) {
      cells[i].cell = static_cast<std::int64_t>(i);
      if (replay.final_cells.data()[i] > cells[i][Ending::trapped])
        replay.mixed_cells.push_back(cells[i]);
    }
    EXPECT_TRUE(same(tally, replay)) << "max_cells " << max_cells;
  }
}

TEST(Walk, IsThePlainReferenceWalkByWalk) {
  struct Place {
    Field field;
    Start start;
  };
  const Place places[] = {{{1, 1}, {0, 0, 5}},       {kNineByNine, kBottomCentre},
                          {kNineByNine, {8, 8, 40}}, {{400, 1}, {399, 0, 30}},
                          {{1, 400}, {0, 0, 3}},     {{301, 301}, {150, 0, 12}}};
  const Chain chains[] = {Chain::from_counts(lattice_counts(1), lattice_exits()),
                          Chain::from_counts(lattice_counts(2), lattice_exits()), with_gaps(3),
                          leaping(4, 2), leaping(5, 511)};
  for (const Chain& chain : chains) {
    const Walker walker(chain);
    EXPECT_TRUE(walker.walks_in_lanes());
    for (const auto& [field, start] : places) {
      for (const int max_cells : {0, 1, 2, 3, 4, 5, 13}) {
        const WalkRange range{(std::int64_t{1} << 33) + 5, 2500};
        EXPECT_EQ(in_lanes(walker, field, start, max_cells, range),
                  plainly(walker, field, start, max_cells, range))
            << &chain - chains << ": " << field.columns << " x " << field.rows << ", " << max_cells;
      }
    }
  }
}

TEST(Walk, AnyNumberOfWalksFitsIntoRegisters) {
  const Walker walker(with_gaps(2));
  for (const std::int64_t count : {0, 1, 2, 7, 8, 9, 31, 32, 33, 2047, 2048, 2049, 4096, 10'001}) {
    for (const std::int64_t first : {std::int64_t{0}, std::int64_t{1} << 40}) {
      EXPECT_EQ(in_lanes(walker, kNineByNine, {4, 0, 13}, 0, {first, count}),
                plainly(walker, kNineByNine, {4, 0, 13}, 0, {first, count}))
          << count << " from " << first;
    }
  }
}

TEST(Walk, IsTheSameWithAnyInstructionSet) {
  const Walker walker(with_gaps(6));
  const Start start{4, 0, 20};
  const WalkRange range{7, 3001};
  const Walked limited = plainly(walker, kNineByNine, start, 13, range);
  const Walked free = plainly(walker, {33, 33}, start, 0, range);
  gatewalk::test::on_every_instruction_set([&] {
    EXPECT_EQ(in_lanes(walker, kNineByNine, start, 13, range), limited);
    EXPECT_EQ(in_lanes(walker, {33, 33}, start, 0, range), free);
  });
}

TEST(Walk, RowsOfOneEntryAndOfHardlyPossibleOnes) {
  const Walker walker(Chain::from_probabilities(
      matrix(3, 4, {{0, 0, 0.5}, {0, 1, 0.5}, {1, 0, 1.0 - 1e-12}, {1, 2, 1e-12}, {2, 3, 1.0}}),
      {{0, 1, 0}, {1, 0, 1}, {2, -1, 0}, {}}));
  for (int input = 0; input < 3; ++input) {
    EXPECT_EQ(in_lanes(walker, {5, 4}, {2, 1, input}, 0, {0, 5000}),
              plainly(walker, {5, 4}, {2, 1, input}, 0, {0, 5000}));
  }
}

TEST(Walk, TheLowHalfOfAWordCounts) {
  // 1/4 + 1.25 2^-33: within the first of two slots a word must not exceed 0x8000000140000000 less
  // one. This walk's word decides in its low half, and in the carry out of it.
  const double p = 0.25 + 1.25 / 8589934592.0;
  const Walker walker(
      Chain::from_probabilities(matrix(1, 2, {{0, 0, p}, {0, 1, 1 - p}}), {{}, {0, 1, 0}}));
  constexpr std::int64_t kWalk = 4'702'487'437;
  const auto word = r123::Philox4x64{}({{0, kWalk, 0, 0}}, {{99, kWalkStream}})[0];
  EXPECT_EQ(word, 0x40000000c60f51e4U);
  EXPECT_EQ(walker.draw(0, 0x400000009fffffff), 0);
  EXPECT_EQ(walker.draw(0, 0x40000000a0000000), 1);
  gatewalk::test::on_every_instruction_set([&] {
    EXPECT_EQ(walker.walk({1, 1}, {0, 0, 0}, 0, 99, {kWalk, 1}).left_field(), 1);
  });
}

TEST(Walk, NothingSampledAtAll) {
  const Walker walker(Chain::from_probabilities(matrix(2, 2, {}), {{0, 0, 0}, {}}));
  const Walked walked = in_lanes(walker, {3, 2}, {1, 1, 1}, 0, {0, 100});
  EXPECT_EQ(walked, plainly(walker, {3, 2}, {1, 1, 1}, 0, {0, 100}));
  EXPECT_EQ(walked.tally.unsampled(), 100);
  EXPECT_EQ(walked.tally.steps, 0);
  EXPECT_EQ(walked.tally.final_cells(1, 1), 100);
}

TEST(Walk, WhatFitsIntoNoRegisterIsWalkedPlainly) {
  for (const auto& [exit, fits] :
       std::initializer_list<std::pair<Exit, bool>>{{{0, 511, 0}, true},
                                                    {{0, 512, 0}, false},
                                                    {{0, -512, 0}, true},
                                                    {{0, -513, 0}, false},
                                                    {{0, 0, 511}, true},
                                                    {{0, 0, 512}, false},
                                                    {{0, 0, -512}, true},
                                                    {{0, 0, -513}, false}}) {
    const Walker walker(
        Chain::from_probabilities(matrix(1, 2, {{0, 0, 0.5}, {0, 1, 0.5}}), {{0, 0, 0}, exit}));
    EXPECT_EQ(walker.walks_in_lanes(), fits);
    const int columns = exit.di_x == 0 ? 1 : 2000, rows = exit.di_y == 0 ? 1 : 2000;
    const Start start{columns / 2, rows / 2, 0};
    EXPECT_EQ(in_lanes(walker, {columns, rows}, start, 9, {0, 500}),
              plainly(walker, {columns, rows}, start, 9, {0, 500}));
  }
  for (const int nonzeros : {(1 << 21) - 1, 1 << 21}) {
    const Walker walker(with_nonzeros(nonzeros));
    EXPECT_EQ(walker.walks_in_lanes(), nonzeros < 1 << 21);
    EXPECT_EQ(in_lanes(walker, {9, 9}, {0, 0, 0}, 0, {0, 20'000}),
              plainly(walker, {9, 9}, {0, 0, 0}, 0, {0, 20'000}));
  }
}

TEST(Walk, TenMillionWalksPassChiSquareAgainstTheExactDistribution) {
  constexpr std::int64_t kWalks = 10'000'000;
  const Chain chain = Chain::from_counts(lattice_counts(8), lattice_exits());
  const FinalDistribution exact = propagate(chain, kNineByNine, kBottomCentre, {.max_cells = 13});
  const WalkTally tally = Walker(chain).walk(kNineByNine, kBottomCentre, 13, 3, {0, kWalks});
  // Cells of fewer than 20 expected walks count as one.
  double chi2 = 0, rare = 0, rare_expected = 0;
  int cells = 0;
  const auto add = [&](double walks, double expected) {
    chi2 += (walks - expected) * (walks - expected) / expected;
    ++cells;
  };
  for (int row = 0; row < 9; ++row) {
    for (int column = 0; column < 9; ++column) {
      const auto walks = static_cast<double>(tally.final_cells(row, column));
      const double expected = kWalks * exact.final_cells(row, column);
      if (expected >= 20) {
        add(walks, expected);
      } else {
        rare += walks;
        rare_expected += expected;
      }
    }
  }
  if (rare_expected > 0) add(rare, rare_expected);
  EXPECT_GT(cells, 50);
  // Wilson and Hilferty: the cube root of chi2 / n is nearly normal, of variance 2 / (9 n).
  const double n = cells - 1, variance = 2 / (9 * n);
  EXPECT_NEAR(std::cbrt(chi2 / n), 1 - variance, 4 * std::sqrt(variance)) << chi2 << " of " << n;
  for (const auto& [count, p] : {std::pair{tally.trapped(), exact.trapped()},
                                 {tally.left_field(), exact.left_field()},
                                 {tally.cut_off(), exact.cut_off()}}) {
    EXPECT_NEAR(static_cast<double>(count), kWalks * p, 4 * std::sqrt(kWalks * p * (1 - p)));
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
  EXPECT_TRUE(same(alone, walker.walk_plainly(kNineByNine, kBottomCentre, 13, 42, {0, kWalks})));
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
  EXPECT_EQ(tally.trapped(), 66'503);
  EXPECT_EQ(tally.left_field(), 10'605);
  EXPECT_EQ(tally.cut_off(), 22'892);
  EXPECT_EQ(tally.steps, 742'039);
  EXPECT_EQ(hash, 10841551127325524228U);
}

TEST(Walk, WithoutLimitIsFollowedThroughAMillionCells) {
  const Walker loop(Chain::from_probabilities(matrix(1, 1, {{0, 0, 1.0}}), {{0, 0, 0}}));
  WalkTally tally = loop.walk({1, 1}, {0, 0, 0}, 0, 1, {0, 3});
  EXPECT_EQ(tally.still_walking, 3);
  EXPECT_EQ(tally.cut_off(), 0);  // the field has no limit
  EXPECT_EQ(tally.endings, decltype(tally.endings){});
  EXPECT_EQ(loop.walk({1, 1}, {0, 0, 0}, 1000, 1, {0, 3}).cut_off(), 3);
  EXPECT_EQ(loop.walk_plainly({1, 1}, {0, 0, 0}, 0, 1, {0, 1}).still_walking, 1);
  EXPECT_EQ(tally.steps, 3'000'000);
  EXPECT_EQ(tally.final_cells(0, 0), 0);  // they have not ended
  EXPECT_EQ(loop.walk({1, 1}, {0, 0, 0}, 1000, 1, {0, 3}).final_cells(0, 0), 3);
  tally += WalkTally(tally);
  EXPECT_EQ(tally.still_walking, 6);
}

// In the first cell a quarter each: trapped, over the edge, into an unsampled state, and into a
// state that stays. Walks that stay have no final cell; all others have theirs, in lanes and
// plainly.
TEST(Walk, FinalCellsAreThoseOfWalksThatEnded) {
  const Walker walker(Chain::from_probabilities(
      matrix(3, 4, {{0, 0, 0.25}, {0, 1, 0.25}, {0, 2, 0.25}, {0, 3, 0.25}, {1, 3, 1.0}}),
      {{}, {0, 1, 0}, {2, 0, 0}, {1, 0, 0}}));
  ASSERT_TRUE(walker.walks_in_lanes());
  const Walked walked = in_lanes(walker, {1, 1}, {0, 0, 0}, 0, {0, 40});
  EXPECT_EQ(walked, plainly(walker, {1, 1}, {0, 0, 0}, 0, {0, 40}));
  const WalkTally& tally = walked.tally;
  for (const std::int64_t some :
       {tally.trapped(), tally.left_field(), tally.unsampled(), tally.still_walking})
    EXPECT_GT(some, 0);
  EXPECT_EQ(tally.final_cells.sum(), 40 - tally.still_walking);
  EXPECT_EQ(trapped_cells(tally).sum() + departed_cells(tally).sum(),
            tally.trapped() + tally.left_field());
}

TEST(Walk, AMoveFarBeyondTheFieldLeavesIt) {
  constexpr int kFar = std::numeric_limits<int>::max();
  const Walker walker(Chain::from_probabilities(matrix(2, 2, {{0, 0, 1.0}, {1, 1, 1.0}}),
                                                {{0, kFar, kFar}, {0, -kFar - 1, 0}}));
  for (const int input : {0, 1}) {
    const WalkTally tally = walker.walk({3, 3}, {2, 2, input}, 0, 1, {0, 5});
    EXPECT_EQ(tally.left_field(), 5);
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

// ---- Cells of several types ----

TEST(Walker, CellsOfOneTypeAmongSeveralAreWalkedAsAUniformField) {
  const Chain one = with_gaps(3);
  const FieldChain several = FieldChain::by_cell(
      {Chain::from_counts(lattice_counts(4), lattice_exits()), one}, 9, std::vector<int>(81, 1));
  const Start start{4, 0, 20};
  const Walker walker(several);
  EXPECT_FALSE(walker.walks_in_lanes());
  EXPECT_EQ(in_lanes(walker, kNineByNine, start, 13, {0, 5000}),
            plainly(Walker(one), kNineByNine, start, 13, {0, 5000}));
}

TEST(Walker, CellsOfSeveralTypesEndAsExactlyPredicted) {
  std::vector<int> types(81);
  for (std::size_t i = 0; i < types.size(); ++i) types[i] = static_cast<int>(i * i % 3);
  std::vector<Chain> chains{with_gaps(5)};
  for (const std::uint64_t seed : {6, 7})
    chains.push_back(Chain::from_counts(lattice_counts(seed), lattice_exits()));
  const FieldChain field = FieldChain::by_cell(chains, 9, types);
  const Start start{4, 0, 20};
  constexpr std::int64_t kWalks = 200'000;
  const WalkTally walked = Walker(field).walk(kNineByNine, start, 13, 1, {0, kWalks});
  const FinalDistribution exact = propagate(field, kNineByNine, start, {.max_cells = 13});
  for (Eigen::Index i = 0; i < exact.final_cells.size(); ++i) {
    const double p = exact.final_cells.data()[i];
    EXPECT_NEAR(static_cast<double>(walked.final_cells.data()[i]) / kWalks, p,
                5.0 * std::sqrt(p / kWalks) + 1e-12)
        << i;
  }
  EXPECT_THROW((void)Walker(field).walk({3, 3}, {1, 0, 20}, 13, 1, {0, 1}), std::invalid_argument);
}

}  // namespace
}  // namespace gatewalk::markov
