// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <barrier>
#include <map>
#include <numeric>
#include <string>
#include <thread>
#include <vector>

#include "dynamics/base/bytes.h"
#include "dynamics/base/kept_pieces.h"
#include "dynamics/base/work.h"
#include "dynamics/disc/ensemble.h"

namespace gatewalk::dynamics {
namespace {

GateTally some_tally(TrialRange range) {
  GateTally tally;
  tally.trials = range.count;
  tally.held.add(range);
  tally.counts = {range.first, 2, 3};
  tally.health.worst_speed = 0.5;
  return tally;
}

TEST(KeptPieces, BytesComeBack) {
  GateTally a = some_tally({10, 5});
  a.held.add(TrialRange{40, 2});
  GateTally b;
  read_bytes(bytes_of(a), b);
  EXPECT_EQ(b.trials, a.trials);
  EXPECT_EQ(b.held, a.held);
  EXPECT_EQ(b.counts, a.counts);
  EXPECT_EQ(b.health.worst_speed, 0.5);
}

TEST(KeptPieces, TooFewOrTooManyBytesAreRefused) {
  const std::string bytes = bytes_of(std::vector<double>{1.0, 2.0});
  std::vector<double> into;
  EXPECT_THROW(read_bytes(bytes.substr(0, bytes.size() - 1), into), std::runtime_error);
  EXPECT_THROW(read_bytes(bytes + "x", into), std::runtime_error);
  EXPECT_THROW(read_bytes(bytes.substr(0, 4), into), std::runtime_error);
}

/// A store that keeps pieces in memory and has some already.
class InMemory : public KeptPieces {
 public:
  std::map<std::int64_t, Next> pieces;
  std::vector<std::string> stages;

  void begin(const Stage& stage) override {
    stages.emplace_back(stage.what);
    end_ = stage.items.first + stage.items.count;
  }
  std::optional<Next> next(std::int64_t at) override {
    const auto there = pieces.lower_bound(at);
    if (there != pieces.end() && there->first == at) return there->second;
    const std::int64_t end = there == pieces.end() ? end_ : there->first;
    return Next{{at, end - at}, {}};
  }
  void keep(TrialRange items, std::string bytes) override {
    pieces.emplace(items.first, Next{items, std::move(bytes)});
  }
  [[nodiscard]] bool is_part() const override { return false; }
  [[nodiscard]] bool has_share(const Stage&) const override { return true; }
  void end_part() override {}

 private:
  std::int64_t end_ = 0;
};

// Whatever pieces are kept already, each item is taken once, in order, and only missing items are
// run.
TEST(KeptPieces, OnlyWhatIsMissingIsRun) {
  InMemory kept;
  kept.keep({5, 2}, bytes_of(std::vector<std::int64_t>{5, 6}));
  kept.keep({9, 3}, bytes_of(std::vector<std::int64_t>{9, 10, 11}));
  Work work;
  work.kept = &kept;
  using Numbers = std::vector<std::int64_t>;
  Numbers run, taken;
  const auto carry_out = [&] {
    in_kept_pieces(
        work, {"numbers", {3, 12}}, Numbers{},
        [&](TrialRange range) {
          Numbers piece;
          for (std::int64_t i = 0; i < range.count; ++i) {
            piece.push_back(range.first + i);
            run.push_back(range.first + i);
          }
          return piece;
        },
        [&](const Numbers& piece) { taken.insert(taken.end(), piece.begin(), piece.end()); });
  };
  carry_out();
  EXPECT_EQ(taken, (Numbers{3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14}));
  EXPECT_EQ(run, (Numbers{3, 4, 7, 8, 12, 13, 14}));
  EXPECT_EQ(kept.stages, std::vector<std::string>{"numbers"});
  run.clear();
  taken.clear();
  carry_out();
  EXPECT_EQ(taken.size(), 12u);
  EXPECT_TRUE(run.empty());
}

/// Ranks that are threads instead of processes.
struct Meeting {
  explicit Meeting(int size) : all(static_cast<std::size_t>(size)), here(size) {}
  std::vector<std::string> all;
  std::int64_t of_first = 0;
  std::barrier<> here;
};
class ThreadAsRank : public Ranks {
 public:
  ThreadAsRank(Meeting& meeting, int rank) : meeting_(meeting), rank_(rank) {}
  [[nodiscard]] int rank() const override { return rank_; }
  [[nodiscard]] int size() const override { return static_cast<int>(meeting_.all.size()); }
  [[nodiscard]] std::int64_t of_first(std::int64_t number) override {
    if (rank_ == 0) meeting_.of_first = number;
    meeting_.here.arrive_and_wait();
    const std::int64_t first = meeting_.of_first;
    meeting_.here.arrive_and_wait();
    return first;
  }
  [[nodiscard]] std::vector<std::string> all(const std::string& own) override {
    meeting_.all[static_cast<std::size_t>(rank_)] = own;
    meeting_.here.arrive_and_wait();
    const std::vector<std::string> all = meeting_.all;
    meeting_.here.arrive_and_wait();
    return all;
  }
  void stop_if_asked() override {}

 private:
  Meeting& meeting_;
  int rank_;
};

// Whatever the speed of each rank: every rank takes each item once, in order, and one rank runs it.
TEST(Ranks, EachTakesAllItemsAndRunsItsOwn) {
  for (const int size : {1, 2, 3}) {
    using Numbers = std::vector<std::int64_t>;
    Meeting meeting(size);
    std::vector<Numbers> taken(static_cast<std::size_t>(size)), run(taken);
    std::vector<std::thread> threads;
    for (int rank = 0; rank < size; ++rank)
      threads.emplace_back([&, rank] {
        ThreadAsRank ranks(meeting, rank);
        Work work;
        work.ranks = &ranks;
        const auto at = static_cast<std::size_t>(rank);
        in_kept_pieces(
            work, {"numbers", {7, 1000}}, Numbers{},
            [&](TrialRange range) {
              Numbers piece;
              for (std::int64_t i = 0; i < range.count; ++i) piece.push_back(range.first + i);
              run[at].insert(run[at].end(), piece.begin(), piece.end());
              return piece;
            },
            [&](const Numbers& piece) {
              taken[at].insert(taken[at].end(), piece.begin(), piece.end());
            });
      });
    for (std::thread& thread : threads) thread.join();
    Numbers all(1000), together;
    std::iota(all.begin(), all.end(), 7);
    for (const Numbers& of_rank : taken) EXPECT_EQ(of_rank, all);
    for (const Numbers& of_rank : run)
      together.insert(together.end(), of_rank.begin(), of_rank.end());
    std::sort(together.begin(), together.end());
    EXPECT_EQ(together, all);
  }
}

}  // namespace
}  // namespace gatewalk::dynamics
