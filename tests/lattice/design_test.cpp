// SPDX-License-Identifier: MIT
#include "lattice/study/design.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "tests/support/lane.h"
#include "tests/support/threads.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;

constexpr double kFair = 0.6, kGood = 0.9, kBad = 0.3;
const std::vector<int> kOwn{0, 2, 0, 2, 0};

Problem lane() { return test::lane({kFair, kGood, kBad}, kOwn); }

bool holds(const std::array<double, 2>& interval, double value) {
  return interval[0] <= value && value <= interval[1];
}

TEST(FieldDesign, ChangesTheCellsThatHelpMost) {
  const DesignedField best = design_field(lane(), {.most_changes = 2, .accuracy = 0.01, .seed = 4});
  EXPECT_EQ(best.type_of_cell, (std::vector<int>{0, 1, 0, 1, 0}));
  EXPECT_TRUE(best.settled);
  const double before = std::pow(kFair, 3) * kBad * kBad,
               after = std::pow(kFair, 3) * kGood * kGood;
  EXPECT_TRUE(holds(best.crossings.interval_95(), after)) << best.crossings.share();
  EXPECT_TRUE(holds(best.before.interval_95(), before)) << best.before.share();
  EXPECT_TRUE(holds(best.gain.interval_95, after - before)) << best.gain.difference;
  EXPECT_EQ(best.crossings.trials, 9604);
  EXPECT_NEAR(best.by_chain.before, before, 0.01);
  EXPECT_NEAR(best.by_chain.optima[0].gain, after, 0.02);
  // Bodies pass each cell once, so the gradient is the effect of a change.
  ASSERT_EQ(best.by_chain.gradient.size(), 15U);
  EXPECT_NEAR(best.by_chain.gradient[1 * 3 + 1], before * (kGood / kBad - 1.0), 0.02);
  EXPECT_EQ(best.by_chain.gradient[1 * 3 + 2], 0.0);  // the cell already has that type
  EXPECT_NEAR(best.by_chain.gradient[0 * 3 + 2], before * (kBad / kFair - 1.0), 0.01);
}

TEST(FieldDesign, MakesItAsHardAsItCan) {
  const DesignedField best =
      design_field(lane(), {.most_changes = 2, .least = true, .accuracy = 0.01, .seed = 5});
  int bad = 0;
  for (const int type : best.type_of_cell) bad += type == 2;
  EXPECT_EQ(bad, 4);
  EXPECT_LT(best.gain.interval_95[1], 0.0);
}

TEST(FieldDesign, ChangesOnlyWhatItMay) {
  const DesignedField fair =
      design_field(lane(), {.most_changes = 5, .become = {0}, .accuracy = 0.01, .seed = 6});
  EXPECT_EQ(fair.type_of_cell, std::vector<int>(5, 0));
  const DesignedField none =
      design_field(lane(), {.most_changes = 5, .become = {2}, .accuracy = 0.02, .seed = 7});
  EXPECT_EQ(none.type_of_cell, kOwn);
  EXPECT_EQ(none.gain.difference, 0.0);  // it is the same field, so nothing is estimated
  EXPECT_TRUE(std::isnan(none.gain.interval_95[0]));
}

TEST(FieldDesign, IsTheSameOnOneThread) {
  const FieldDesignOptions options{.most_changes = 2, .accuracy = 0.05, .seed = 8};
  const DesignedField many = design_field(lane(), options);
  const DesignedField one = test::on_threads(1, [&] { return design_field(lane(), options); });
  EXPECT_EQ(many.type_of_cell, one.type_of_cell);
  EXPECT_EQ(many.crossings.crossed, one.crossings.crossed);
  EXPECT_EQ(many.by_chain.gradient, one.by_chain.gradient);
  EXPECT_EQ(many.by_chain.before, one.by_chain.before);
}

TEST(FieldDesign, RefusesWhatItCannotDo) {
  EXPECT_THROW((void)design_field(lane(), {.most_changes = 0}), std::invalid_argument);
  EXPECT_THROW((void)design_field(lane(), {.most_changes = 6}), std::invalid_argument);
  EXPECT_THROW((void)design_field(lane(), {.become = {3}}), std::invalid_argument);
  EXPECT_THROW((void)design_field(lane(), {.accuracy = 0.5}), std::invalid_argument);
  Problem uniform = lane();
  uniform.cells = CellField::uniform(uniform.cells.cells[0]);
  EXPECT_THROW((void)design_field(uniform, {}), std::invalid_argument);
}

}  // namespace
}  // namespace gatewalk::lattice
