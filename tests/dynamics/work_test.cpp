// SPDX-License-Identifier: MIT
#include "dynamics/base/work.h"
#include "dynamics/base/kept_pieces.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace gatewalk::dynamics {
namespace {

TEST(PieceSize, AimsAtAThirdOfASecond) {
  PieceSize batch;
  for (int i = 0; i < 20; ++i) batch.measured(batch.get(), static_cast<double>(batch.get()) * 1e-5);
  EXPECT_EQ(batch.get(), 30000);  // 0.3 s of 10 us each
  batch.measured(batch.get(), static_cast<double>(batch.get()) * 1e-3);
  EXPECT_EQ(batch.get(), 300);  // shrinks at once
  batch.measured(batch.get(), static_cast<double>(batch.get()) * 1e-5);
  EXPECT_EQ(batch.get(), 1200);  // grows fourfold at most
}

TEST(PieceSize, IsAMultipleOfTheLeast) {
  PieceSize batch(8);
  batch.measured(8, 8 * 1e-2);  // 0.3 s of 10 ms each: 30
  EXPECT_EQ(batch.get(), 24);
}

TEST(PieceSize, NeverFallsBelowOneNorOverflows) {
  PieceSize batch;
  batch.measured(1, 1e6);
  EXPECT_EQ(batch.get(), 1);
  for (int i = 0; i < 100; ++i) batch.measured(batch.get(), 0.0);  // a clock that does not move
  EXPECT_GT(batch.get(), 1'000'000);
  EXPECT_LT(batch.get(), std::numeric_limits<std::int64_t>::max() / 4);
}

TEST(Work, PiecesCoverAllOnceAndAreTold) {
  std::vector<std::int64_t> told;
  const Work work{[&](std::string_view what, std::int64_t done, std::int64_t total) {
    EXPECT_EQ(what, "runs");
    EXPECT_EQ(total, 1000);
    told.push_back(done);
  }};
  std::int64_t next = 0;
  work.in_pieces("runs", 1000, [&](TrialRange range) {
    EXPECT_EQ(range.first, next);
    EXPECT_EQ(told.back(), next);
    next += range.count;
  });
  EXPECT_EQ(next, 1000);
  EXPECT_EQ(told.back(), 1000);
}

TEST(Work, PiecesGrowWhereTheyTakeNoTime) {
  int pieces = 0;
  Work{}.in_pieces("runs", 1'000'000'000, [&](TrialRange) {
    if (++pieces > 1000) throw std::runtime_error("too many");
  });
  EXPECT_LT(pieces, 100);
}

TEST(Work, NobodyNeedsToWatch) {
  int calls = 0;
  Work{}.in_pieces("runs", 0, [&](TrialRange) { ++calls; });
  EXPECT_EQ(calls, 0);
}

TEST(Work, StopsBetweenPiecesWhenToldThrows) {
  const Work work{[](std::string_view, std::int64_t done, std::int64_t) {
    if (done >= 5) throw std::runtime_error("enough");
  }};
  std::int64_t done = 0;
  EXPECT_THROW(
      work.in_pieces("runs", 1'000'000'000'000, [&](TrialRange range) { done += range.count; }),
      std::runtime_error);
  EXPECT_GE(done, 5);
  EXPECT_LT(done, 1'000'000'000'000);
}

TEST(Work, PartsAreToldAsTheirShareOfTheWhole) {
  std::vector<std::int64_t> told;
  const Work whole{[&](std::string_view what, std::int64_t done, std::int64_t total) {
    EXPECT_EQ(what, "sweep");
    EXPECT_EQ(total, 4000);
    told.push_back(done);
  }};
  whole.part("sweep", 1, 4).tell("runs", 30, 60);
  whole.part("sweep", 3, 4).tell("runs", 60, 60);
  whole.part("sweep", 2, 4).part("inner", 1, 2).tell("runs", 1, 2);
  whole.part("sweep", 1000.0, 500.0, 4000).tell("runs", 1, 5);
  EXPECT_EQ(told, (std::vector<std::int64_t>{1500, 4000, 2750, 1100}));
  Work{}.part("sweep", 0, 1).tell("runs", 0, 1);  // without a receiver
}

}  // namespace
}  // namespace gatewalk::dynamics
