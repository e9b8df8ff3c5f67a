// SPDX-License-Identifier: MIT
#include "dynamics/base/work.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "dynamics/disc/ensemble.h"

namespace gatewalk::dynamics {
namespace {

TEST(TrialSet, JoinsRangesInAnyOrder) {
  TrialSet set({10, 5});
  set.add({0, 10});
  set.add({20, 1});
  set.add({15, 5});
  EXPECT_EQ(set, TrialSet({0, 21}));
  EXPECT_EQ(set.ranges().size(), 1u);
  set.add({30, 2});
  set.add({5, 0});  // nothing
  EXPECT_EQ(set.count(), 23);
  EXPECT_EQ(set.ranges().size(), 2u);
}

TEST(TrialSet, HoldsNoTrialTwice) {
  for (const TrialRange range : {TrialRange{0, 11}, {10, 1}, {14, 9}, {0, 99}, {12, 1}}) {
    TrialSet set({10, 5});
    EXPECT_THROW(set.add(range), std::invalid_argument) << range.first;
    EXPECT_EQ(set, TrialSet({10, 5}));
  }
}

TEST(TrialSet, ChangesNothingWhereItRefuses) {
  TrialSet set({10, 5}), others({0, 2});
  others.add({12, 1});
  EXPECT_THROW(set.add(others), std::invalid_argument);
  EXPECT_EQ(set, TrialSet({10, 5}));
}

TEST(GateTally, RefusesATrialItHoldsAlready) {
  const GateParams p;
  GateTally tally = run_gate_trials(p, {.vy = 15.0}, 1, {4, 4});
  tally += run_gate_trials(p, {.vy = 15.0}, 1, {0, 4});
  EXPECT_EQ(tally.held, TrialSet({0, 8}));
  EXPECT_EQ(tally.counts, run_gate_trials(p, {.vy = 15.0}, 1, {0, 8}).counts);
  EXPECT_THROW(tally += run_gate_trials(p, {.vy = 15.0}, 1, {7, 2}), std::invalid_argument);
  EXPECT_EQ(tally.trials, 8);
}

}  // namespace
}  // namespace gatewalk::dynamics
