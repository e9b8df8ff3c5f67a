// SPDX-License-Identifier: MIT

#include <gtest/gtest.h>

#include <algorithm>

#include "dynamics/disc/study/meaning.h"

namespace gatewalk::dynamics {
namespace {

/// A body that creeps through a viscous medium: it passes beams whose resistance is below its
/// propulsion.
GateParams creeping(double resistance_per_push) {
  GateParams p;
  p.forces.random = 0.0;
  p.forces.drag = 7.0;
  p.beams.damping = 1.0;
  p.run.time_limit = 1000.0;
  // The resistance is proportional to the stiffness.
  const double wanted = resistance_per_push * p.forces.propulsion;
  const double factor = wanted / beams_on_the_middle(p).resistance;
  p.beams.stiffness_left *= factor;
  p.beams.stiffness_right *= factor;
  return p;
}
constexpr BodyState kStart{.vy = 1.0};

const Deciding* find(const std::vector<Deciding>& all, std::string_view words) {
  const auto at =
      std::find_if(all.begin(), all.end(), [&](const Deciding& d) { return d.words == words; });
  return at == all.end() ? nullptr : &*at;
}

// Closed form: in the limit of strong drag the threshold is where the largest resistance equals the
// propulsion.
TEST(Deciding, FindsTheStepThatTheLandscapeHas) {
  const auto all = deciding_numbers(creeping(1.0), kStart);
  const Deciding *stiffness = find(all, "the stiffness"), *push = find(all, "the push");
  ASSERT_NE(stiffness, nullptr);
  EXPECT_EQ(stiffness->less, GateFate::crosses);
  EXPECT_EQ(stiffness->more, GateFate::trapped);
  ASSERT_NE(push, nullptr);
  EXPECT_EQ(push->less, GateFate::trapped);
  EXPECT_EQ(push->more, GateFate::crosses);
  // Drag removes the start's speed at once.
  EXPECT_EQ(find(all, "the speed at the start"), nullptr);
}

TEST(Deciding, SaysNothingAwayFromTheStep) {
  EXPECT_TRUE(deciding_numbers(creeping(0.8), kStart).empty());
  EXPECT_TRUE(deciding_numbers(creeping(1.25), kStart).empty());
}

// With strong noise some runs cross and some do not, at 1 % less as at 1 % more.
TEST(Deciding, SaysNothingWhereRunsEndDifferently) {
  EXPECT_TRUE(deciding_numbers(GateParams{}, {.vy = 15.0}).empty());
}

}  // namespace
}  // namespace gatewalk::dynamics
