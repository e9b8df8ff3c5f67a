// SPDX-License-Identifier: MIT
#include "lattice/scene/study/sweep.h"
#include "lattice/scene/toml_file.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace gatewalk::lattice {
namespace {

using Values = std::vector<std::string>;

Values values_of(const std::string& values) {
  return sweep_axes({}, {"forces.propulsion_N=" + values}).front().values;
}

TEST(SweepAxes, FromStepTo) {
  EXPECT_EQ(values_of("4:1:6"), (Values{"4", "5", "6"}));
  EXPECT_EQ(values_of("4:6"), (Values{"4", "5", "6"}));
  EXPECT_EQ(values_of("0:0.1:0.3"), (Values{"0", "0.1", "0.2", "0.3"}));
  EXPECT_EQ(values_of("3:-1.5:0"), (Values{"3", "1.5", "0"}));
  EXPECT_EQ(values_of("4:3:9"), (Values{"4", "7"}));  // the end need not be reached
  EXPECT_EQ(values_of("stable,paper"), (Values{"stable", "paper"}));
}

TEST(SweepAxes, GivenOnesReplaceTheScenes) {
  const std::vector<Variation> own{{"forces.propulsion_N", "4,5", "x.toml:1"},
                                   {"forces.random_N", "0,10", "x.toml:2"}};
  const auto axes = sweep_axes(own, {"forces.random_N=7", "body.mass_kg=2,3"});
  ASSERT_EQ(axes.size(), 3u);
  EXPECT_EQ(axes[0].values, (Values{"4", "5"}));
  EXPECT_EQ(axes[1].values, (Values{"7"}));
  EXPECT_EQ(axes[2].key, "body.mass_kg");
}

TEST(SweepAxes, RefusesWhatMakesNoGrid) {
  for (const char* values : {"4:0:9", "9:1:4", "4:x:9", "1:2:3:4", "4,,5", "0:1e-6:1"})
    EXPECT_THROW((void)values_of(values), SceneError) << values;
  EXPECT_THROW((void)sweep_axes({}, {"forces.random_N"}), SceneError);
  EXPECT_THROW((void)sweep_axes({}, {"forces.nothing=1"}), SceneError);
  EXPECT_THROW((void)sweep_axes({}, {"body.mass_kg=1", "body.mass_kg=2"}), SceneError);
  EXPECT_THROW((void)sweep_axes({}, {"body.mass_kg=1:1000", "body.radius_m=1:0.01:10"}),
               SceneError);
  EXPECT_THROW((void)sweep_axes({}, {}), std::invalid_argument);
}

TEST(Sweep, RunsTheGateAtEveryPointUnderTheSameNoise) {
  const SweepPlan plan{
      TomlFile("forces.random_N = 20\n[sweep]\n\"forces.propulsion_N\" = \"6,8\"", "x.toml"),
      {"beams.damping_Nms_per_rad=10"},
      sweep_axes({}, {"forces.propulsion_N=6,8", "start.x_m=-1,0,1"})};
  std::vector<SweepPoint> points = sweep_points(plan);
  ASSERT_EQ(points.size(), 6u);
  EXPECT_EQ(points[1].values, (Values{"6", "0"}));  // the last axis runs fastest
  EXPECT_EQ(points[3].values, (Values{"8", "-1"}));
  std::int64_t most = 0;
  run_sweep(points, {0, 30}, 9, {[&](std::string_view what, std::int64_t done, std::int64_t total) {
              EXPECT_EQ(what, "sweep");
              EXPECT_EQ(total, 6000);
              most = std::max(most, done);
            }});
  EXPECT_EQ(most, 6000);
  for (const SweepPoint& p : points) {
    const auto alone = dynamics::run_gate_trials(p.scene.gate, p.scene.start, 9, {0, 30});
    EXPECT_EQ(p.tally.counts, alone.counts);
    EXPECT_EQ(p.scene.gate.forces.random, 20.0);
    EXPECT_EQ(p.scene.gate.beams.damping, 10.0);
    EXPECT_EQ(p.scene.gate.forces.propulsion, std::stod(p.values[0]));
    EXPECT_EQ(p.scene.start.x, std::stod(p.values[1]));
    EXPECT_FALSE(p.settled);
  }
}

}  // namespace
}  // namespace gatewalk::lattice
