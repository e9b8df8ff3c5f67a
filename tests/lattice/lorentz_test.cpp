// SPDX-License-Identifier: MIT
// A cell that is not a gate: the periodic Lorentz gas.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "dynamics/cells/check_cell.h"
#include "tests/support/lorentz.h"
#include "tests/support/threads.h"

namespace gatewalk::lattice {
namespace {

using namespace lorentz;

constexpr double kGap = 0.2;
constexpr std::int64_t kTrials = 5000;
constexpr int kPassages = 20;

const LorentzCell& cell() {
  static const LorentzCell cell(kGap);
  return cell;
}
dynamics::CellMap map_of(const LorentzCell& cell) {
  return dynamics::CellField::uniform(std::make_shared<LorentzCell>(cell)).map;
}
RunPool some_pool(std::uint64_t seed, std::int64_t trials = kTrials) {
  dynamics::Health health;
  RunPool pool;
  pool.scattered = endless_trials(
      cell(), [](dynamics::Random& random) { return cell().anywhere(random); }, trials, kPassages,
      seed, health);
  EXPECT_EQ(health.runs, trials * kPassages);
  EXPECT_EQ(health.broken, 0);
  return pool;
}
const PooledDiffusion& diffusion() {
  static const PooledDiffusion d = pooled_diffusion(map_of(cell()), some_pool(1), cell().lattice);
  return d;
}
template <class Of>
test::Estimate of_groups(Of of) {
  std::vector<double> all;
  for (const TreeDiffusion& group : diffusion().groups) all.push_back(of(group));
  return test::estimate(all);
}

TEST(Lorentz, GapsWithoutDiffusionAreRefusedWithTheReason) {
  for (const double gap : {0.0, -1.0, 0.3095, 1.0, std::nan("")}) try {
      const LorentzCell refused(gap);
      FAIL() << gap;
    } catch (const std::invalid_argument& e) {
      EXPECT_NE(std::string(e.what()).find("there is no diffusion coefficient"), std::string::npos);
    }
  EXPECT_NO_THROW(LorentzCell(0.3094));
}

TEST(Lorentz, TheCellKeepsWhatCellsPromise) {
  std::vector<dynamics::Entry> starts;
  for (int face = 0; face < 4; ++face) {
    starts.push_back({face, {0.01, 0.1}});
    starts.push_back({face, {-0.09, 0.9}});
  }
  EXPECT_EQ(dynamics::check_cell(cell(), starts), std::vector<std::string>{});
  dynamics::Body body{.entry = {0, {std::nan(""), 0.0}}, .random = {dynamics::Purpose::gate, {}}};
  EXPECT_EQ(cell().pass(body).fate, dynamics::Fate::broken);
}

// Motion is reversible: a body that left with (s, v) at a side enters there with (s, -v), and
// returns.
TEST(Lorentz, PassagesCanBeReversed) {
  const double a = 2.0 + kGap;
  const std::array<lorentz::Point, 3> corners{lorentz::Point(0, 0), lorentz::Point(a, 0),
                                              lorentz::Point(a / 2.0, std::sqrt(3.0) / 2.0 * a)};
  int reversed = 0;
  constexpr int kMany = 1000;
  for (std::uint64_t i = 0; i < kMany; ++i) {
    dynamics::Random random(dynamics::Purpose::gate, {3, 0, i});
    const dynamics::Entry in{0, {kGap * (random.uniform() - 0.5), 2.0 * random.uniform() - 1.0}};
    dynamics::Entry at = in;
    const double there = lorentz::cross(corners, at);
    EXPECT_LE(std::abs(at.at[0]), kGap / 2.0 + 1e-12);
    at.at[1] = -at.at[1];
    const double back = lorentz::cross(corners, at);
    reversed += at.face == in.face && std::abs(there - back) < 1e-3 &&
                std::abs(at.at[0] - in.at[0]) < 1e-3 && std::abs(at.at[1] + in.at[1]) < 1e-3;
  }
  // Round-off grows about tenfold with each hit: after more than ten hits nothing is left.
  EXPECT_GE(reversed, 0.98 * kMany);
}

dynamics::Passage passed(double s, double v) {
  dynamics::Body body{.entry = {0, {s, v}}, .random = {dynamics::Purpose::gate, {}}};
  const dynamics::Passage passage = cell().pass(body);
  EXPECT_EQ(body.entry, passage.next);
  return passage;
}

TEST(Lorentz, PassagesByHand) {
  constexpr double kFewEps = 1e-14;
  // Straight up, back from the disc above, and out through the entry.
  const dynamics::Passage back = passed(0.0, 0.0);
  EXPECT_EQ(back.next.face, 2);
  EXPECT_NEAR(back.next.at[0], 0.0, kFewEps);
  EXPECT_NEAR(back.next.at[1], 0.0, kFewEps);
  EXPECT_NEAR(back.costs[0], 2.0 * (std::sqrt(3.0) / 2.0 * (2.0 + kGap) - 1.0), kFewEps);
  // Past the disc in the corner, at distance 1.19 from its middle on both sides, without a hit.
  const dynamics::Passage past = passed(0.09, -0.5);
  EXPECT_EQ(past.next.face, 1);
  EXPECT_NEAR(past.next.at[0], 0.09, kFewEps);
  EXPECT_NEAR(past.next.at[1], 0.5, kFewEps);
  EXPECT_NEAR(past.costs[0], 1.19, kFewEps);
}

TEST(Lorentz, MeanStaysAreThoseOfTheFreeArea) {
  const test::Triangle triangle = test::triangle(kGap, 200'000, 1);
  EXPECT_NEAR(triangle.stay.mean, test::mean_stay_in_triangle(kGap), 4.0 * triangle.stay.error);
  const test::Estimate stay = of_groups([](const TreeDiffusion& d) { return d.walk.mean_time; });
  EXPECT_NEAR(diffusion().whole.walk.mean_time, test::mean_stay_in_cell(kGap), 5.0 * stay.error);
  // Hops of a / sqrt(3) between triangles.
  EXPECT_NEAR(test::machta_zwanzig(kGap),
              (2.0 + kGap) * (2.0 + kGap) / 3.0 / 4.0 / test::mean_stay_in_triangle(kGap), 1e-14);
}

// From any start, in the long run bodies enter by each gap equally often, anywhere in it, at angles
// with density cos / 2.
TEST(Lorentz, EntriesInTheLongRunAreThoseOfTheInvariantMeasure) {
  static constexpr int kBoxes = 5;
  constexpr std::int64_t kMany = 20'000;
  const auto chi_squared_after = [&](int passages) {
    dynamics::Health health;
    const RangeRuns trials = endless_trials(
        cell(),
        [](dynamics::Random& random) {
          return dynamics::Entry{0, {kGap * 0.2 * random.uniform(), 0.2 * random.uniform()}};
        },
        kMany, passages, 5, health);
    // By gap, place and angle.
    std::array<std::array<std::array<double, kBoxes>, kBoxes>, 4> seen{};
    const auto box_of = [](double part) {
      return std::clamp(static_cast<int>(kBoxes * part), 0, kBoxes - 1);
    };
    for (std::size_t i = 0; i < static_cast<std::size_t>(kMany); ++i) {
      const dynamics::Entry last = trials.each.of_trial(i).back().entry;
      const double angle = std::asin(std::clamp(last.at[1], -1.0, 1.0));
      ++seen[last.face][box_of(last.at[0] / kGap + 0.5)][box_of(angle / std::numbers::pi + 0.5)];
    }
    const auto sine = [](int k) { return std::sin(std::numbers::pi * (1.0 * k / kBoxes - 0.5)); };
    double chi_squared = 0.0;
    for (const auto& face : seen)
      for (const auto& place : face)
        for (int k = 0; k < kBoxes; ++k) {
          const double expected = kMany / (4.0 * kBoxes) * (sine(k + 1) - sine(k)) / 2.0;
          chi_squared += (place[k] - expected) * (place[k] - expected) / expected;
        }
    return chi_squared;
  };
  // 99 degrees of freedom: above 161 once in 10 000 times.
  EXPECT_LE(chi_squared_after(kPassages), 161.0);
  EXPECT_GT(chi_squared_after(1), 1000.0);
}

// The chain keeps the invariant measure within sampling error, which is larger for a group of an
// eighth of the trials.
TEST(Lorentz, TheChainKeepsTheInvariantMeasure) {
  const double whole = test::off_invariant(diffusion().whole, kGap);
  const test::Estimate group =
      of_groups([](const TreeDiffusion& d) { return test::off_invariant(d, kGap); });
  EXPECT_LE(whole, 1.3 * group.mean / std::sqrt(8.0));
  EXPECT_LE(whole, 0.03);
}

// Compared with direct simulation: the difference is within the error bar plus three standard
// errors of direct simulation.
TEST(Lorentz, DiffusionIsThatOfDirectSimulation) {
  const test::Estimate direct = test::direct_diffusion(kGap, 20'000, 10, 20.0, 1);
  const auto& [d, interval] = diffusion().coefficient;
  const double half = 0.5 * (interval[1] - interval[0]);
  EXPECT_NEAR(d, direct.mean, half + 3.0 * direct.error);
  EXPECT_LE(half, 0.04 * d);
  EXPECT_LE(direct.error, 0.005 * direct.mean);
  // A chain without memory, or with one step of memory, differs by more than that.
  EXPECT_GT(direct.mean - test::machta_zwanzig(kGap), 10.0 * direct.error);
  EXPECT_GT(direct.mean - test::one_step(kGap, test::triangle(kGap, 200'000, 2).back.mean),
            10.0 * direct.error);
  // All directions are alike, and there is no drift.
  const Eigen::Matrix2d& tensor = diffusion().whole.walk.tensor;
  EXPECT_NEAR(tensor(0, 0), tensor(1, 1), 0.1 * d);
  EXPECT_NEAR(tensor(0, 1), 0.0, 0.05 * d);
  EXPECT_LE(diffusion().whole.walk.drift.norm(),
            5.0 * std::sqrt(4.0 * d / (kTrials * kPassages * test::mean_stay_in_cell(kGap))));
}

TEST(Lorentz, SameBitsOnAnyThreads) {
  const auto run = [] {
    return pooled_diffusion(map_of(cell()), some_pool(4, 500), cell().lattice);
  };
  const PooledDiffusion one = test::on_threads(1, run), three = test::on_threads(3, run);
  EXPECT_EQ(one.whole.walk.states, three.whole.walk.states);
  EXPECT_EQ(one.whole.walk.tensor, three.whole.walk.tensor);
  EXPECT_EQ(one.coefficient.interval, three.coefficient.interval);
}

}  // namespace
}  // namespace gatewalk::lattice
