#include "markov/sweep.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cstring>
#include <stdexcept>

#include "chains.h"

namespace gatewalk::markov {
namespace {

using test::Entry;
using test::kBottomCentre;
using test::kNineByNine;
using test::lattice_counts;
using test::lattice_exits;
using test::matrix;

void expect_near(const FinalDistribution& a, const FinalDistribution& b, double bound) {
  EXPECT_LE((a.final_cells - b.final_cells).abs().maxCoeff(), bound);
  EXPECT_NEAR(a.trapped, b.trapped, bound);
  EXPECT_NEAR(a.left_field, b.left_field, bound);
  EXPECT_NEAR(a.cut_off, b.cut_off, bound);
  EXPECT_NEAR(a.unsampled, b.unsampled, bound);
}

void expect_whole(const FinalDistribution& d) {
  EXPECT_NEAR(d.final_cells.sum() + d.remainder, 1.0, 1e-12);
  EXPECT_NEAR(d.trapped + d.left_field + d.cut_off + d.unsampled + d.remainder, 1.0, 1e-12);
  EXPECT_GE(d.final_cells.minCoeff(), 0.0);
}

/// Exits of the paper's kind: left, right and up only.
std::vector<Exit> never_down() {
  auto exits = lattice_exits();
  for (Exit& exit : exits)
    if (exit.di_y < 0) exit.di_y = 1;
  return exits;
}

/// Moves of several cells at once, down too.
std::vector<Exit> leaps() {
  auto exits = lattice_exits();
  for (std::size_t j = 0; j + 1 < exits.size(); ++j) {
    exits[j].di_x = static_cast<int>(j % 7) - 3;
    exits[j].di_y = static_cast<int>(j % 5) - 2;
  }
  return exits;
}

Chain with_gaps(std::uint64_t seed, std::vector<Exit> exits) {
  Counts counts = lattice_counts(seed);
  for (const int row : {3, 40, 60}) test::empty_row(counts, row);
  return Chain::from_counts(counts, std::move(exits));
}

TEST(Sweep, PropagatesAsThePlainReference) {
  const std::vector<std::pair<Field, Start>> places{
      {kNineByNine, kBottomCentre}, {{1, 1}, {0, 0, 5}}, {{3, 5}, {2, 4, 80}},
      {{20, 2}, {0, 1, 30}},        {{2, 20}, {1, 7, 0}}, {{64, 64}, {63, 63, 9}}};
  for (const auto& exits : {lattice_exits(), never_down(), leaps()}) {
    for (const std::uint64_t seed : {1, 2}) {
      const Chain chain = with_gaps(seed, exits);
      const Sweeper sweeper(chain);
      for (const auto& [field, start] : places) {
        for (const int limit : {1, 2, 3, 13, 0}) {
          SCOPED_TRACE(std::to_string(field.columns) + " x " + std::to_string(field.rows) +
                       ", limit " + std::to_string(limit));
          const auto plain = propagate(chain, field, start, limit);
          const auto fast = sweeper.propagate(field, start, limit);
          expect_near(plain, fast, 1e-14);
          expect_whole(fast);
          EXPECT_EQ(plain.steps, fast.steps);
          EXPECT_NEAR(plain.mean_steps, fast.mean_steps, 1e-12);
          EXPECT_NEAR(plain.remainder, fast.remainder, 1e-15);
        }
      }
    }
  }
}

TEST(Sweep, StartInARowThatWasNeverSampled) {
  const Chain chain = with_gaps(1, never_down());
  const Sweeper sweeper(chain);
  const Start start{4, 2, 40};
  for (const auto& d : {sweeper.propagate(kNineByNine, start, 13), sweeper.march(kNineByNine, start)}) {
    EXPECT_EQ(d.unsampled, 1.0);
    EXPECT_EQ(d.final_cells(2, 4), 1.0);
    EXPECT_EQ(d.steps, 0);
  }
}

// Two other routes to the same: step by step until nothing is left, and one factorisation.
TEST(Sweep, MarchIsTheLimitOfPropagation) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Chain chain = with_gaps(seed, never_down());
    const Sweeper sweeper(chain);
    ASSERT_TRUE(sweeper.can_march());
    for (const auto& [field, start] : std::vector<std::pair<Field, Start>>{
             {kNineByNine, kBottomCentre}, {{9, 9}, {0, 8, 3 + 1}}, {{1, 30}, {0, 0, 2}}, {{40, 3}, {39, 1, 7}}}) {
      const auto d = sweeper.march(field, start);
      expect_whole(d);
      EXPECT_LE(d.remainder, 1e-12);
      expect_near(d, propagate(chain, field, start, 0), 1e-12);
      const auto solved = solve_absorption(chain, field, start);
      expect_near(d, solved, 1e-12);
      EXPECT_NEAR(d.mean_steps, solved.mean_steps, 1e-10);
    }
  }
}

TEST(Sweep, MarchCoversRowsThatJumpAcrossOthers) {
  auto exits = never_down();
  for (std::size_t j = 0; j < 10; ++j) exits[j].di_y = 3;
  const Chain chain = Chain::from_counts(lattice_counts(5), exits);
  const Sweeper sweeper(chain);
  const Field field{11, 17};
  expect_near(sweeper.march(field, {5, 1, 3}), solve_absorption(chain, field, {5, 1, 3}), 1e-12);
}

TEST(Sweep, RemainderIsWhatTheToleranceLeaves) {
  const Chain chain = Chain::from_counts(lattice_counts(1), never_down());
  const Sweeper sweeper(chain);
  const auto exact = solve_absorption(chain, kNineByNine, kBottomCentre);
  for (const double tolerance : {1e-2, 1e-4, 1e-8}) {
    const auto d = sweeper.march(kNineByNine, kBottomCentre, tolerance);
    EXPECT_GT(d.remainder, 0.0);
    EXPECT_LE(d.remainder, tolerance * kNineByNine.rows);
    expect_whole(d);
    // Each number is short of the exact one by the remainder at most.
    EXPECT_GE((exact.final_cells - d.final_cells).minCoeff(), -1e-15);
    EXPECT_LE((exact.final_cells - d.final_cells).maxCoeff(), d.remainder + 1e-15);
  }
  const auto all = sweeper.march(kNineByNine, kBottomCentre, 0.0);
  EXPECT_LE(all.remainder, 1e-270);
  expect_near(all, exact, 1e-13);
}

TEST(Sweep, MarchRefusesWhatItCannotDo) {
  const Chain down = Chain::from_counts(lattice_counts(1), lattice_exits());
  EXPECT_FALSE(Sweeper(down).can_march());
  EXPECT_THROW((void)Sweeper(down).march(kNineByNine, kBottomCentre), std::invalid_argument);
  EXPECT_THROW((void)Sweeper(down).propagate(kNineByNine, kBottomCentre, 13, -1.0),
               std::invalid_argument);
  EXPECT_THROW((void)Sweeper(down).propagate({0, 9}, kBottomCentre, 13), std::invalid_argument);
  // Left and right for ever.
  const Chain circle = Chain::from_probabilities(
      matrix(2, 2, {{0, 1, 1.0}, {1, 0, 1.0}}), {{0, 1, 0}, {1, -1, 0}});
  EXPECT_THROW((void)Sweeper(circle).march({2, 1}, {1, 0, 0}, 1e-13, 1000), std::runtime_error);
  const auto still = Sweeper(circle).propagate({2, 1}, {1, 0, 0}, 0, 1e-13, 100);
  EXPECT_EQ(still.remainder, 1.0);
  EXPECT_EQ(still.steps, 100);
}

TEST(Sweep, HasTheSameBitsWithAnyInstructionSet) {
  const Chain chain = with_gaps(4, never_down());
  const Sweeper sweeper(chain);
  const auto same = [](const FinalDistribution& a, const FinalDistribution& b) {
    const auto bytes = sizeof(double) * static_cast<std::size_t>(a.final_cells.size());
    return std::memcmp(a.final_cells.data(), b.final_cells.data(), bytes) == 0 &&
           a.trapped == b.trapped && a.left_field == b.left_field && a.remainder == b.remainder;
  };
  const Field field{13, 7};
  const Start start{6, 0, 11};
  const auto walked = sweeper.propagate(field, start, 13), marched = sweeper.march(field, start);
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    EXPECT_TRUE(same(walked, sweeper.propagate(field, start, 13)));
    EXPECT_TRUE(same(marched, sweeper.march(field, start)));
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
}

}  // namespace
}  // namespace gatewalk::markov
