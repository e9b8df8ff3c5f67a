// SPDX-License-Identifier: MIT
#pragma once
/// Compares runs from any source, to the last bit.

#include <gtest/gtest.h>

#include <vector>

#include "dynamics/disc/ensemble.h"
#include "dynamics/disc/runs.h"
#include "tests/support/numbers.h"

namespace gatewalk::test {

/// Runs trials 0 .. n - 1 of run_gate_trial's streams; `carry_out(next)` gets their source.
template <class CarryOut>
std::vector<dynamics::GateRun> trials_by(CarryOut carry_out, const dynamics::GateParams& p,
                                         const dynamics::BodyState& start, int n) {
  std::vector<dynamics::GateRun> runs(n);
  int next = 0;
  carry_out([&](dynamics::RunSlot& slot, const dynamics::GateRun* ended) {
    if (ended != nullptr) runs[slot.trial] = *ended;
    if (next == n) return false;
    slot.trial = next++;
    slot.start = start;
    slot.force = dynamics::gate_force(p, 1, slot.trial);
    return true;
  });
  return runs;
}

/// True for equal bits; NaNs are equal whatever their bits.
inline bool same_number(double a, double b) { return same_bits(a, b) || (a != a && b != b); }

inline void expect_same_bits(const dynamics::GateRun& a, const dynamics::GateRun& b) {
  using dynamics::kLeft, dynamics::kRight;
  EXPECT_EQ(a.outcome, b.outcome);
  EXPECT_TRUE(same_number(a.exit.x, b.exit.x) && same_number(a.exit.y, b.exit.y));
  EXPECT_TRUE(same_number(a.exit.vx, b.exit.vx) && same_number(a.exit.vy, b.exit.vy));
  EXPECT_TRUE(same_number(a.seconds, b.seconds));
  EXPECT_EQ(a.out_of_work, b.out_of_work);
  const dynamics::Watch &v = a.watch, &w = b.watch;
  EXPECT_TRUE(same_number(v.max_theta[kLeft], w.max_theta[kLeft]));
  EXPECT_TRUE(same_number(v.max_theta[kRight], w.max_theta[kRight]));
  EXPECT_TRUE(same_number(v.max_penetration, w.max_penetration));
  EXPECT_TRUE(same_number(v.energy_created, w.energy_created));
  EXPECT_TRUE(same_number(v.max_speed, w.max_speed));
  EXPECT_EQ(v.steps, w.steps);
  EXPECT_EQ(v.evaluations, w.evaluations);
  EXPECT_EQ(v.impacts, w.impacts);
  EXPECT_EQ(v.forced_holds, w.forced_holds);
  EXPECT_EQ(v.fast_steps, w.fast_steps);
}

}  // namespace gatewalk::test
