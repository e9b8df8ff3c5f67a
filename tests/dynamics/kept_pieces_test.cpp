// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "dynamics/base/bytes.h"
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

/// Keeps pieces in memory; has some already.
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

// Whatever was kept before, each item is taken once, in its order, and only what is missing is run.
TEST(KeptPieces, OnlyWhatIsMissingIsRun) {
  InMemory kept;
  kept.keep({5, 2}, bytes_of(std::vector<std::int64_t>{5, 6}));
  kept.keep({9, 3}, bytes_of(std::vector<std::int64_t>{9, 10, 11}));
  Work work;
  work.kept = &kept;
  using Numbers = std::vector<std::int64_t>;
  Numbers run, taken;
  const auto carry_out = [&] {
    work.in_kept_pieces(
        {"numbers", {3, 12}}, Numbers{},
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

}  // namespace
}  // namespace gatewalk::dynamics
