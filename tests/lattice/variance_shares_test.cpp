// SPDX-License-Identifier: MIT
#include "lattice/study/variance_shares.h"
#include "lattice/scene/toml_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <stdexcept>

#include "lattice/scene/ranges.h"
#include "tests/support/threads.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;

/// One cell, which a body leaves ahead with this probability.
Problem one_cell(double chance) {
  Section section;
  section.faces = {{"S", 0, 1, 0, 0, "from below", {}}};
  section.coordinates = {{"x", "x", "1", "place", 1.0}};
  Problem problem;
  problem.cells =
      CellField::uniform(std::make_shared<FunctionCell>(section, [=](Body& body) -> Passage {
        return {body.random.uniform() < chance ? Fate::left : Fate::trapped, body.entry};
      }));
  problem.field = {1, 1, 0};
  problem.start = {0, {0.5}};
  return problem;
}
Problem plane(const std::vector<double>& at) { return one_cell(0.1 + 0.5 * at[0] + 0.25 * at[1]); }
Problem product(const std::vector<double>& at) { return one_cell(at[0] * at[1]); }

bool holds(const Mean95& m, double truth) {
  return m.interval[0] <= truth && truth <= m.interval[1];
}

TEST(VarianceShares, AreThoseOfTheChance) {
  const auto found = variance_shares(2, plane, markov::Ending::far_edge, {.trials = 400'000});
  const SobolIndices& i = found.indices;
  EXPECT_LE(found.trials, 400'000);
  EXPECT_GT(found.trials, 200'000);
  EXPECT_NEAR(i.mean.mean, 0.475, 0.01);
  EXPECT_NEAR(i.variance.mean, 0.3125 / 12.0, 0.002);
  EXPECT_NEAR(i.noise, (0.475 * 0.525 - 0.3125 / 12.0) / 16.0, 5e-4);  // for 16 trials
  EXPECT_NEAR(i.first[0].mean, 0.8, 0.03);
  EXPECT_NEAR(i.first[1].mean, 0.2, 0.03);
  EXPECT_NEAR(i.total[0].mean, 0.8, 0.03);
  EXPECT_NEAR(i.total[1].mean, 0.2, 0.03);
}

// x y: variance 7/144, of which each number makes 3/7 alone, and 4/7 with the other.
TEST(VarianceShares, IntervalsHold) {
  int inside = 0, of = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const SobolIndices i =
        variance_shares(2, product, markov::Ending::far_edge, {.trials = 30'000, .seed = seed})
            .indices;
    for (const std::size_t k : {0, 1})
      inside += holds(i.first[k], 3.0 / 7.0) + holds(i.total[k], 4.0 / 7.0);
    inside += holds(i.mean, 0.25) + holds(i.variance, 7.0 / 144.0);
    of += 6;
  }
  EXPECT_GE(inside, of * 92 / 100);
}

TEST(VarianceShares, AreTheSameOnAnyNumberOfThreadsAndInAnyPieces) {
  const auto shares = [](int threads, const Work& work) {
    return test::on_threads(threads, [&] {
      return variance_shares(2, plane, markov::Ending::far_edge, {.trials = 20'000}, work)
          .indices.total[0]
          .mean;
    });
  };
  Work slow;
  slow.told = [](auto&&...) {};
  EXPECT_EQ(shares(1, {}), shares(4, slow));
}

TEST(VarianceShares, RefuseTooFewTrials) {
  EXPECT_THROW(variance_shares(2, plane, markov::Ending::far_edge,
                               {.trials = least_trials_of_shares(2) - 1}),
               std::invalid_argument);
  EXPECT_NO_THROW(
      variance_shares(2, plane, markov::Ending::far_edge, {.trials = least_trials_of_shares(2)}));
}

RangedScene ranged(const std::vector<std::string>& ranges,
                   const std::vector<std::string>& overrides = {}) {
  return {TomlFile("body.mass_kg = 2.0\n", "a.toml"), overrides, ranges, "--over"};
}
std::string refusal_of_ranges(const std::vector<std::string>& ranges,
                              const std::vector<std::string>& overrides = {}) {
  try {
    (void)ranged(ranges, overrides);
  } catch (const SceneError& e) {
    return e.what();
  }
  return "accepted";
}

TEST(RangedScene, IsTheSceneWithTheNumbersOfThePoint) {
  const RangedScene scene = ranged({"forces.propulsion_N=4:8", "body.radius_cm=150:250"});
  EXPECT_EQ(scene.at({0.0, 0.0}).gate.forces.propulsion, 4.0);
  EXPECT_EQ(scene.at({1.0, 0.0}).gate.forces.propulsion, 8.0);
  EXPECT_EQ(scene.at({0.25, 0.5}).gate.forces.propulsion, 5.0);
  EXPECT_EQ(scene.at({0.25, 0.5}).gate.body.radius, 2.0);
  EXPECT_EQ(scene.at({0.25, 0.5}).gate.body.mass, 2.0);
}

TEST(RangedScene, RefusesWhatIsNoRange) {
  for (const char* text : {"forces.propulsion_N", "forces.propulsion_N=4",
                           "forces.propulsion_N=4:", "forces.propulsion_N=8:4",
                           "forces.propulsion_N=4:x", "forces.propulsion_N=4:inf", ":", "=:"})
    EXPECT_EQ(
        refusal_of_ranges({text}),
        std::string("--over ") + text + ": must be KEY=LOW:HIGH, two numbers, the low one first");
  EXPECT_NE(refusal_of_ranges({"forces.push=4:8"}).find("--over forces.push=4:8: "),
            std::string::npos);
  EXPECT_NE(
      refusal_of_ranges({"body.radius_m=1:2", "body.radius_cm=100:200"}).find("is varied already"),
      std::string::npos);
  EXPECT_NE(refusal_of_ranges({"body.mass_kg=1:2"}, {"body.mass_kg=3"})
                .find("--set body.mass_kg=3 has no"),
            std::string::npos);
  // Outside the permitted range; between two whole numbers.
  EXPECT_TRUE(refusal_of_ranges({"body.mass_kg=-1:2"}).starts_with("--over body.mass_kg=-1:2: "));
  EXPECT_TRUE(refusal_of_ranges({"field.rows=3:9"}).starts_with("--over field.rows=3:9: "));
}

}  // namespace
}  // namespace gatewalk::lattice
