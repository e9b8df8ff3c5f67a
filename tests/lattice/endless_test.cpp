// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "results/lorentz/diffusion.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;
using namespace lorentz;

Section square_section() {
  Section section;
  section.faces = {{"S", 0, 1, 0, 0, "from below", {}},
                   {"E", -1, 0, 3, 0, "from the right", {}},
                   {"N", 0, -1, 2, 0, "from above", {}},
                   {"W", 1, 0, 1, 0, "from the left", {}}};
  section.coordinates = {{"s", "s", "1", "place", 1.0}};
  return section;
}

/// A body goes straight on with probability `on`, else through any of the other three sides, at any
/// place.
FunctionCell persistent(double on, double time = 0.0) {
  Section section = square_section();
  if (time > 0.0) section.costs = {{"time_s", "s", "duration"}};
  return {section, [=](Body& body) {
            if (body.random.uniform() >= on)
              body.entry.face = static_cast<int>((body.entry.face + 1 + body.random.below(3)) % 4);
            body.entry.at[0] = body.random.uniform();
            return Passage{Fate::left, body.entry, {time}};
          }};
}
Entry anywhere(Random& random) { return {static_cast<int>(random.below(4)), {random.uniform()}}; }

CellMap map_of(const Cell& cell) { return {cell.section(), {{cell.is_symmetric()}}, 0, {}}; }

TEST(Endless, TrialsGoOnFromCellToCell) {
  const FunctionCell cell = persistent(0.5);
  Health health;
  const RangeRuns trials = endless_trials(cell, anywhere, 50, 6, 3, health);
  EXPECT_EQ(health.runs, 300);
  ASSERT_EQ(trials.starts.size(), 50u);
  for (std::size_t i = 0; i < 50; ++i) {
    ASSERT_EQ(trials.each.of_trial(i).size(), 6u);
    Body body{.entry = {}, .random = {Purpose::field, {3, 0, i}}};
    body.entry = anywhere(body.random);
    EXPECT_EQ(body.entry, trials.starts[i]);
    for (const CellPassage passage : trials.each.of_trial(i))
      EXPECT_EQ(cell.pass(body).next, passage.entry);
  }
  EXPECT_THROW((void)endless_trials(cell, anywhere, 0, 6, 3, health), std::invalid_argument);
  EXPECT_THROW((void)endless_trials(cell, anywhere, 6, 0, 3, health), std::invalid_argument);
}

// D = (1 + c) / (1 - c) / 4 per passage; c = on - (1 - on) / 3 is the mean cosine of two moves.
TEST(Endless, DiffusionOfAPersistentWalk) {
  for (const auto& [on, time] : {std::pair{0.25, 0.0}, {0.7, 0.0}, {0.7, 2.5}}) {
    const FunctionCell cell = persistent(on, time);
    Health health;
    RunPool pool;
    pool.scattered = endless_trials(cell, anywhere, 2000, 20, 1, health);
    const PooledDiffusion d =
        pooled_diffusion(map_of(cell), pool, 2.0 * Eigen::Matrix2d::Identity());
    const double c = on - (1.0 - on) / 3.0;
    const double exact = 4.0 * 0.25 * (1.0 + c) / (1.0 - c) / (time > 0.0 ? time : 1.0);
    EXPECT_LE(d.coefficient.interval[0], exact);
    EXPECT_GE(d.coefficient.interval[1], exact);
    EXPECT_LE(d.coefficient.interval[1] - d.coefficient.interval[0], 0.1 * exact);
    EXPECT_NEAR(d.whole.walk.mean_time, time > 0.0 ? time : 1.0, 1e-11);
  }
}

TEST(Endless, WhereSomeAreTrappedThereIsNoDiffusion) {
  const FunctionCell cell(square_section(), [](Body& body) {
    body.entry.at[0] = body.random.uniform();
    return Passage{body.random.uniform() < 0.01 ? Fate::trapped : Fate::left, body.entry, {}};
  });
  Health health;
  RunPool pool;
  pool.scattered = endless_trials(cell, anywhere, 100, 20, 1, health);
  EXPECT_LT(health.runs, 2000);
  EXPECT_THROW((void)tree_diffusion(map_of(cell), pool, Eigen::Matrix2d::Identity()),
               std::invalid_argument);
}

TEST(Endless, SeveralTypesOfCellsAreRefused) {
  CellMap map = map_of(persistent(0.5));
  map.types.resize(2);
  EXPECT_THROW((void)tree_diffusion(map, {}, Eigen::Matrix2d::Identity()), std::invalid_argument);
}

}  // namespace
}  // namespace gatewalk::lattice
