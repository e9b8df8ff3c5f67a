// SPDX-License-Identifier: MIT
#pragma once
/// Compares whole runs of a scene and of its mirror image, bit for bit.

#include <gtest/gtest.h>

#include "dynamics/disc/gate.h"
#include "tests/support/numbers.h"

namespace gatewalk::test {

/// `same_work`: gaps are evaluated in an order that the mirror image does not change.
inline void expect_mirror_images(const dynamics::GateRun& a, const dynamics::GateRun& b,
                                 bool same_work = true) {
  using dynamics::Outcome;
  const auto flipped = b.outcome == Outcome::traversed_left    ? Outcome::traversed_right
                       : b.outcome == Outcome::traversed_right ? Outcome::traversed_left
                       : b.outcome == Outcome::exited_left     ? Outcome::exited_right
                       : b.outcome == Outcome::exited_right    ? Outcome::exited_left
                                                               : b.outcome;
  ASSERT_EQ(a.outcome, flipped);
  ASSERT_EQ(a.exit.x, -b.exit.x);
  ASSERT_EQ(a.exit.vx, -b.exit.vx);
  ASSERT_TRUE(same_bits(a.exit.y, b.exit.y));
  ASSERT_TRUE(same_bits(a.exit.vy, b.exit.vy));
  ASSERT_TRUE(same_bits(a.seconds, b.seconds));
  for (const dynamics::Side side : {dynamics::kLeft, dynamics::kRight})
    ASSERT_TRUE(same_bits(a.watch.max_theta[side], b.watch.max_theta[1 - side]));
  ASSERT_TRUE(same_bits(a.watch.max_penetration, b.watch.max_penetration));
  ASSERT_TRUE(same_bits(a.watch.energy_created, b.watch.energy_created));
  ASSERT_TRUE(same_bits(a.watch.max_speed, b.watch.max_speed));
  ASSERT_EQ(a.watch.impacts, b.watch.impacts);
  ASSERT_EQ(a.watch.forced_holds, b.watch.forced_holds);
  ASSERT_EQ(a.watch.steps, b.watch.steps);
  if (same_work) {
    ASSERT_EQ(a.watch.evaluations, b.watch.evaluations);
  }
}

}  // namespace gatewalk::test
