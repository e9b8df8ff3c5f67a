#include "lattice/study/rare.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "lattice/study/trials.h"
#include "tests/support/long.h"
#include "tests/support/threads.h"

namespace gatewalk::lattice {
namespace {

using dynamics::Crossing;

/// The paper's field: some 4 % of the bodies enter row 3.
Scene fast_scene() {
  Scene scene;
  scene.gate.forces.propulsion = 7.0;
  scene.gate.forces.random = 50.0;
  scene.gate.run.method = "moreau";
  scene.gate.run.step = 0.02;
  return scene;
}

double equal_worth(int, int, const Crossing&) { return 1.0; }

/// Has nothing to do with where bodies get: it doubles to the right, and jumps with the speed.
double wrong_worth(int column, int row, const Crossing& entry) {
  return std::exp2(column % 3 - row + (std::fmod(std::abs(entry.vx), 2.0) > 1.0 ? 2.0 : 0.0));
}

/// The share of full trials that enter the row.
RowChance direct(const Scene& scene, int row, std::int64_t trials) {
  Scene deep = scene;
  deep.field.rows = row;
  deep.field.max_gates = 0;
  const FieldTally tally = field_trials(deep, trials, 77);
  const double p =
      static_cast<double>(tally.endings[static_cast<std::size_t>(markov::Ending::far_edge)]) /
      static_cast<double>(trials);
  return {p, std::sqrt((1.0 - p) / p / static_cast<double>(trials))};
}

void expect_agree(const RowChance& a, const RowChance& b, double sigmas) {
  EXPECT_LT(std::abs(std::log(a.probability / b.probability)),
            sigmas * std::hypot(a.relative_standard_error, b.relative_standard_error))
      << a.probability << " and " << b.probability;
}

TEST(Splitting, WithoutValuesIsPlainTrials) {
  const Scene scene = fast_scene();
  const Splitting s = split(scene, 1.0, equal_worth, {.row = 2, .accuracy = 0.02});
  for (const RowChance& c : s.rows) {
    const double n = static_cast<double>(s.trials);
    EXPECT_NEAR(c.probability * n, std::round(c.probability * n), 1e-6);  // nobody was split
    EXPECT_NEAR(c.relative_standard_error, std::sqrt((1 / c.probability - 1) / (n - 1)), 1e-12);
  }
  expect_agree(s.rows[1], direct(scene, 2, 40'000), 4.0);
}

TEST(Splitting, IsUnbiasedWhateverTheValues) {
  const Scene scene = fast_scene();
  const Splitting s = split(scene, 1.0, wrong_worth,
                            {.row = 3, .accuracy = 0.04, .most_runs = 3'000'000, .seed = 5});
  expect_agree(s.rows[2], direct(scene, 3, 40'000), 4.0);
}

TEST(Splitting, IsTheSameOnAnyNumberOfThreads) {
  const Scene scene = fast_scene();
  const SplittingOptions few{.row = 3, .accuracy = 0.1};
  const auto one = test::on_threads(1, [&] { return split(scene, 1.0, wrong_worth, few); }),
             four = test::on_threads(4, [&] { return split(scene, 1.0, wrong_worth, few); });
  EXPECT_EQ(one.trials, four.trials);
  for (std::size_t r = 0; r < one.rows.size(); ++r)
    EXPECT_EQ(one.rows[r].probability, four.rows[r].probability);
}

TEST(Splitting, RefusesWhatMakesNoSense) {
  const Scene scene = fast_scene();
  EXPECT_THROW((void)split(scene, 1.0, equal_worth, {.row = 0}), std::invalid_argument);
  EXPECT_THROW((void)split(scene, 0.0, equal_worth, {.row = 1}), std::invalid_argument);
  const auto zero = [](int, int, const Crossing&) { return 0.0; };
  EXPECT_THROW((void)split(scene, 1.0, zero, {.row = 2}), std::invalid_argument);
}

TEST(RareEvent, AgreesWithDirectTrials) {
  const Scene scene = fast_scene();
  const RareEvent e = rare_event(scene, {.row = 5, .accuracy = 0.05});
  const RowChance d = direct(scene, 5, 100'000);
  EXPECT_LT(d.probability, 0.05);
  EXPECT_TRUE(e.splitting.reached);
  expect_agree(e.splitting.rows[4], d, 4.0);
  EXPECT_NEAR(e.chain[4] / d.probability, 1.0, 0.4);
}

// 95 % intervals hold in 93 to 97 % of 1000 repeats; in the usual 40 at least 34 times.
TEST(Splitting, IntervalsHoldAsOftenAsTheySay) {
  const Scene scene = fast_scene();
  const auto by_row = [](int, int row, const Crossing&) { return std::pow(2.4, row); };
  const RowChance truth = direct(scene, 6, test::usual_or_full(200'000, 4'000'000));
  const int repeats = test::usual_or_full(40, 1000);
  int holds = 0;
  for (int i = 0; i < repeats; ++i) {
    const Splitting s = split(
        scene, 1.0, by_row, {.row = 6, .accuracy = 0.2, .seed = static_cast<std::uint64_t>(i) + 1});
    const auto [low, high] = s.rows[5].interval_95();
    holds += low <= truth.probability && truth.probability <= high;
  }
  RecordProperty("holds", holds);
  EXPECT_GE(holds, test::usual_or_full(34, 930));
  EXPECT_LE(holds, test::usual_or_full(40, 970));
}

}  // namespace
}  // namespace gatewalk::lattice
