// SPDX-License-Identifier: MIT
#include "dynamics/disc/study/choice.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "tests/support/numbers.h"
#include "tests/support/scenes.h"
#include "tests/support/threads.h"

namespace gatewalk::dynamics {
namespace {

using test::same_bits;

/// Beams as stiff as walls: coarse settings of every method are inaccurate or faulty, so the
/// tolerance decides. The longer the run, the stronger the effect.
GateParams stiff(double tolerance, double seconds) {
  GateParams p;
  p.beams.stiffness_left = p.beams.stiffness_right = 1e5;
  p.run.time_limit = seconds;
  p.run.method = "auto";
  p.run.tolerance = tolerance;
  return p;
}
constexpr BodyState kIn{0, 0, 0, 15};

Choice choose(const GateParams& p, const BodyState& start = kIn) {
  return choose_method(p, std::span(&start, 1), 1);
}

TrialEnds trials(const GateParams& p, std::uint64_t seed, std::int64_t n) {
  TrialEnds ends;
  add_trial_ends(ends, p, kIn, seed, {0, n});
  return ends;
}

/// Evaluations per trial: the cost of a setting in the method's own units.
double evaluations(const GateParams& p) {
  return static_cast<double>(trials(p, 1, 200).health.evaluations) / 200;
}

/// Checks the promises of the header for a choice that was met.
void expect_in_order(const Choice& c, double tolerance) {
  ASSERT_FALSE(c.tried.empty());
  for (std::size_t i = 0; i < c.tried.size(); ++i) {
    const Choice::Tried& t = c.tried[i];
    SCOPED_TRACE(testing::Message() << t.setting.method << ' ' << t.setting.value);
    if (i > 0) {
      EXPECT_GE(t.work, c.tried[i - 1].work);
    }
    const bool fits =
        t.verdict == Verdict::fine && t.error.total_variation + t.uncertainty <= tolerance;
    EXPECT_EQ(t.fits, fits);
    EXPECT_EQ(t.fits, i + 1 == c.tried.size()) << "the first that fits is the last that is tried";
    EXPECT_EQ(std::isnan(t.error.total_variation), std::isnan(t.uncertainty));
  }
  const GateParams chosen = c.tried.back().setting.applied_to(c.params);
  EXPECT_EQ(chosen.run.method, c.params.run.method);
  EXPECT_EQ(chosen.run.step, c.params.run.step);
  EXPECT_EQ(chosen.run.event_tolerance, c.params.run.event_tolerance);
}

// With other trials than the pilot's and another reference (ten times finer), the promise holds to
// three standard errors of these 2000 trials. A tight tolerance costs more: the setting that
// sufficed for a loose one was tried and rejected.
TEST(Choice, MeetsItsToleranceAndATightOneIsDearer) {
  std::vector<Choice> made;
  for (const double tolerance : {0.02, 0.001}) {
    SCOPED_TRACE(tolerance);
    const Choice c = choose(stiff(tolerance, 3.0));
    ASSERT_TRUE(c.met);
    EXPECT_EQ(c.reference.method, "event");
    EXPECT_EQ(c.reference_verdict, Verdict::fine);
    expect_in_order(c, tolerance);
    GateParams exact = c.reference.applied_to(c.params);
    exact.run.event_tolerance *= 0.1;
    const TrialEnds run = trials(c.params, 77, 2000), reference = trials(exact, 77, 2000);
    EXPECT_EQ(run.verdict(), Verdict::fine);
    const WeakError e = outcome_error(run.trials, reference.trials);
    EXPECT_LE(e.total_variation, tolerance + 3 * std::sqrt(static_cast<double>(e.changed)) / 2000);
    made.push_back(c);
  }
  const Choice::Tried &loose = made[0].tried.back(), &tight = made[1].tried.back();
  EXPECT_GT(tight.work, loose.work);
  bool rejected = false;
  for (const Choice::Tried& t : made[1].tried)
    rejected |= t.setting.method == loose.setting.method &&
                t.setting.value == loose.setting.value && !t.fits && t.verdict == Verdict::fine;
  EXPECT_TRUE(rejected);
}

// If any error is allowed, the choice is the cheapest setting without faults. Within one method
// work is counted in evaluations, so every cheaper setting has faults.
TEST(Choice, TakesTheCheapestThatWorks) {
  GateParams p = stiff(1.0, 2.0);
  p.beams.stiffness_left = p.beams.stiffness_right = 400.0;
  const Choice c = choose(p);
  ASSERT_TRUE(c.met);
  expect_in_order(c, 1.0);
  const double cost = evaluations(c.params);
  EXPECT_GT(cost, 0.0);
  int dearer = 0;
  for (const Setting& s : chart_settings(c.params.run.method, p)) {
    if (evaluations(s.applied_to(p)) < cost) {
      EXPECT_NE(trials(s.applied_to(p), 1, 300).verdict(), Verdict::fine) << s.value;
    } else {
      ++dearer;
    }
  }
  EXPECT_GE(dearer, 2);  // more expensive settings exist
  // Cheaper settings with faults are listed, without an error.
  for (std::size_t i = 0; i + 1 < c.tried.size(); ++i)
    EXPECT_NE(c.tried[i].verdict, Verdict::fine) << c.tried[i].setting.method;
}

TEST(Choice, SameForAnyThreadsAndTwice) {
  const auto on = [](int threads) {
    return test::on_threads(threads, [] { return choose(stiff(0.02, 1.0), {0, 15, 0, 15}); });
  };
  const Choice one = on(1), other = on(3);
  EXPECT_EQ(other.params.run.method, one.params.run.method);
  EXPECT_EQ(other.params.run.step, one.params.run.step);
  EXPECT_EQ(other.params.run.event_tolerance, one.params.run.event_tolerance);
  ASSERT_EQ(other.tried.size(), one.tried.size());
  for (std::size_t i = 0; i < one.tried.size(); ++i) {
    const Choice::Tried &a = other.tried[i], &b = one.tried[i];
    EXPECT_EQ(a.setting.method, b.setting.method);
    EXPECT_EQ(a.setting.value, b.setting.value);
    EXPECT_TRUE(same_bits(a.work, b.work));
    EXPECT_TRUE(same_bits(a.error.total_variation, b.error.total_variation));
    EXPECT_TRUE(same_bits(a.error.standard_error, b.error.standard_error));
    EXPECT_EQ(a.error.changed, b.error.changed);
    EXPECT_EQ(a.verdict, b.verdict);
  }
}

// No change among n trials does not show that nothing changes: 4000 trials cannot prove 1e-4, so
// more are run, and no claim is sharper than their number allows.
TEST(Choice, ClaimsNoMoreThanItsTrialsCanShow) {
  GateParams p = test::free_rods();  // straight out by the side: every method is exact
  p.run.time_limit = 0.1;
  const BodyState out{24.9, 5, 10, 0};
  for (const double tolerance : {0.02, 1e-4}) {
    p.run.tolerance = tolerance;
    const Choice c = choose(p, out);
    ASSERT_TRUE(c.met);
    const Choice::Tried& chosen = c.tried.back();
    EXPECT_EQ(chosen.error.changed, 0);
    EXPECT_EQ(c.trials, tolerance == 1e-4 ? 40'000 : 4000);
    EXPECT_NEAR(chosen.uncertainty, 1.84 / static_cast<double>(c.trials), 1e-18);
    EXPECT_LE(chosen.uncertainty, tolerance);
  }
}

// Two starts share the pilot evenly; the error is the mean of the errors of each start.
TEST(Choice, ErrorIsTheMeanOverTheStarts) {
  const GateParams p = stiff(0.05, 3.0);
  const BodyState starts[] = {{-3, 0, 0, 15}, {3, 0, 0, 15}};
  const Choice c = choose_method(p, starts, 1);
  ASSERT_TRUE(c.met);
  double mean = 0.0;
  for (int i = 0; i < 2; ++i) {
    TrialEnds run, reference;
    add_trial_ends(run, c.params, starts[i], 1, {2000 * i, 2000});
    add_trial_ends(reference, c.reference.applied_to(p), starts[i], 1, {2000 * i, 2000});
    const double alone = outcome_error(run.trials, reference.trials).total_variation;
    EXPECT_GT(alone, 0.0);
    mean += 0.5 * alone;
  }
  EXPECT_NEAR(c.tried.back().error.total_variation, mean, 4 * test::kEps);
}

// Method event cannot run these beams, and the disc is too fast for any step of the others: without
// a reference the choice is refused.
TEST(Choice, SaysWhenTheReferenceItselfIsFaulty) {
  GateParams p;
  p.beams.stiffness_left = p.beams.stiffness_right = 1e11;
  p.run.time_limit = 0.02;
  const BodyState fast{0, 0, 0, 1e10};
  const Choice c = choose(p, fast);
  EXPECT_FALSE(c.met);
  EXPECT_EQ(c.reference.method, "stable");
  EXPECT_EQ(c.reference_verdict, Verdict::too_fast);
  EXPECT_EQ(c.params.run.method, "stable");
  EXPECT_EQ(c.params.run.step, c.reference.value);
  for (const Choice::Tried& t : c.tried) EXPECT_FALSE(t.fits);
}

TEST(Choice, RefusesWhatCannotBe) {
  const auto refused_key = [](const GateParams& p) {
    try {
      (void)choose(p);
    } catch (const InvalidParameter& e) {
      return e.key();
    }
    return std::string();
  };
  GateParams p;
  p.run.tolerance = 0.99e-4;
  EXPECT_EQ(refused_key(p), "run.tolerance");
  p = {};
  p.run.step = 0.003;  // fits no hold; refused although some settings replace it
  EXPECT_EQ(refused_key(p), "run.step_s");
  p = {};
  p.body.mass = -1.0;
  EXPECT_EQ(refused_key(p), "body.mass_kg");
  // Only moreau takes these beams, and no reference can check it.
  p = {};
  p.beams.mass = 1e-6;
  p.beams.stiffness_left = p.beams.stiffness_right = 1e12;
  p.run.time_limit = 1.0;
  EXPECT_EQ(refused_key(p), "run.method");

  p = {};
  EXPECT_THROW((void)choose_method(p, {}, 1), std::invalid_argument);
  for (const BodyState& bad : {BodyState{25.1, 0}, BodyState{0, 61}, BodyState{std::nan(""), 0},
                               BodyState{0, 0, std::numeric_limits<double>::infinity(), 0}}) {
    const BodyState starts[] = {kIn, bad};
    EXPECT_THROW((void)choose_method(p, starts, 1), std::invalid_argument);
  }
}

}  // namespace
}  // namespace gatewalk::dynamics
