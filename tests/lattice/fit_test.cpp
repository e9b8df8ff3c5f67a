// SPDX-License-Identifier: MIT
#include "lattice/study/fit.h"
#include "lattice/scene/toml_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <boost/math/distributions/beta.hpp>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>
#include <vector>

#include "lattice/field/field_trials.h"
#include "lattice/scene/ranges.h"
#include "lattice/scene/scene_problem.h"
#include "tests/support/lane.h"
#include "tests/support/long.h"
#include "tests/support/threads.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;

constexpr int kLaneRows = 8;

Fit fit_trials(int numbers, const ProblemAt& problem_at, const Observed& observed,
               const FitOptions& options) {
  const Problem middle = problem_at(std::vector<double>(static_cast<std::size_t>(numbers), 0.5));
  return fit(numbers, problem_at, trials_to_fit(observed, middle), options);
}

/// Cells of even rows let bodies through with one probability, cells of odd rows with another.
Problem two_lane(double even, double odd) {
  std::vector<int> types;
  for (int row = 0; row < kLaneRows; ++row) types.push_back(row % 2);
  return test::lane({even, odd}, std::move(types));
}

/// The observed endings and gates of trials in that lane.
Observed experiment(const Problem& problem, std::int64_t trials, std::uint64_t seed) {
  FieldTrials each;
  const FieldTally tally =
      run_field(problem.cells, problem.field, problem.start, seed, {1'000'000'000, trials}, &each);
  Observed o;
  o.seen = {tally.final_cells, tally.endings};
  o.gates_by_ending.fill(CellCounts::Zero(kLaneRows, 1));
  for (std::size_t i = 0; i < each.endings.size(); ++i)
    ++o.gates_by_ending[static_cast<std::size_t>(*each.endings[i])](each.final_gates[i], 0);
  return o;
}

/// How often bodies met cells of even (0) or odd rows, and how often they went on.
std::array<std::int64_t, 2> passes(const Observed& o, int odd) {
  const auto crossed = static_cast<std::size_t>(markov::Ending::far_edge);
  std::int64_t met = 0, went_on = 0, here = o.seen.trials();
  for (int row = 0; row < kLaneRows; ++row) {
    const std::int64_t on =
        here - (o.seen.final_gates(row, 0) - o.gates_by_ending[crossed](row, 0));
    if (row % 2 == odd) {
      met += here;
      went_on += on;
    }
    here = on;
  }
  return {met, went_on};
}

constexpr double kLow = 0.5, kHigh = 0.95;
double chance_at(double point) { return kLow + point * (kHigh - kLow); }

TEST(Fit, IsTheExactPosteriorOfOneNumber) {
  const Observed o = experiment(two_lane(0.8, 0.8), 300, 7);
  const Fit f = fit_trials(
      1, [](const std::vector<double>& x) { return two_lane(chance_at(x[0]), chance_at(x[0])); }, o,
      {.trials = 200'000, .seed = 2});
  EXPECT_TRUE(f.settled()) << f.misfit << " " << f.mixing << " " << f.numbers[0].by_runs;
  const auto even = passes(o, 0), odd = passes(o, 1);
  const double on = static_cast<double>(even[1] + odd[1]),
               off = static_cast<double>(even[0] + odd[0]) - on;
  const boost::math::beta_distribution<> exact(on + 1.0, off + 1.0);
  const double sd = boost::math::standard_deviation(exact);
  EXPECT_NEAR(chance_at(f.numbers[0].mean), boost::math::mean(exact), 0.25 * sd);
  EXPECT_NEAR((kHigh - kLow) * f.numbers[0].sd, sd, 0.1 * sd);
  EXPECT_NEAR(chance_at(f.numbers[0].interval[0]), boost::math::quantile(exact, 0.025), 0.4 * sd);
  EXPECT_NEAR(chance_at(f.numbers[0].interval[1]), boost::math::quantile(exact, 0.975), 0.4 * sd);
  EXPECT_TRUE(f.numbers[0].told);
  EXPECT_EQ(f.observed, 300);
  EXPECT_GT(f.p, 0.01);
  std::int64_t grouped = 0;
  for (const OutcomeGroup& g : f.groups) grouped += g.observed;
  EXPECT_EQ(grouped, 300);
}

// A lane has no sides, so no simulated trial ends there. Nine of 80 trials that did are no chance.
TEST(Fit, IsNotExplainedByWhatNeverHappens) {
  Observed o;
  o.seen.endings[static_cast<std::size_t>(markov::Ending::far_edge)] = 31;
  o.seen.endings[static_cast<std::size_t>(markov::Ending::trapped)] = 49;
  const auto fitted = [&] {
    return fit_trials(
        1, [](const std::vector<double>& x) { return two_lane(chance_at(x[0]), chance_at(x[0])); },
        o, {.trials = 16'384, .seed = 2});
  };
  const Fit possible = fitted();
  EXPECT_EQ(possible.never, 0);
  EXPECT_GT(possible.p, 0.2);
  o.seen.endings[static_cast<std::size_t>(markov::Ending::trapped)] = 40;
  o.seen.endings[static_cast<std::size_t>(markov::Ending::left_edge)] = 9;
  const Fit impossible = fitted();
  EXPECT_EQ(impossible.never, 9);
  EXPECT_LT(impossible.p, 0.001);
}

/// Each passage takes an exponential time.
Problem waiting_lane(double rate) {
  Problem problem = two_lane(0.8, 0.8);
  Section section = problem.map().section;
  section.costs = {{"time_s", "s", "duration"}};
  problem.cells = CellField::uniform(std::make_shared<FunctionCell>(section, [=](Body& body) {
    const Fate fate = body.random.uniform() < 0.8 ? Fate::left : Fate::trapped;
    return Passage{fate, body.entry, {-std::log(body.random.uniform()) / rate}};
  }));
  return problem;
}

// Endings say nothing about the rate; the times of bodies that crossed say everything.
TEST(Fit, TimesTellWhatEndingsDoNot) {
  const Problem truth = waiting_lane(1.1);
  FieldTrials each;
  const FieldTally tally =
      run_field(truth.cells, truth.field, truth.start, 9, {1'000'000'000, 300}, &each);
  Observed o;
  o.seen = {{}, tally.endings};
  double sum = 0.0, crossed = 0.0;
  for (std::size_t i = 0; i < each.endings.size(); ++i) {
    const bool crosses = each.endings[i] == markov::Ending::far_edge;
    o.timed.push_back(
        {static_cast<std::size_t>(*each.endings[i]), -1, crosses ? each.costs[i][0] : 0.0});
    sum += crosses ? each.costs[i][0] : 0.0;
    crossed += crosses;
  }
  const auto problem_at = [](const std::vector<double>& x) {
    return waiting_lane(0.5 + 1.5 * x[0]);
  };
  const Fit timed = fit_trials(1, problem_at, o, {.trials = 200'000, .seed = 2});
  EXPECT_EQ(timed.outcomes.times.size(), 7U);
  EXPECT_EQ(timed.observed, 300);
  const double shape = crossed * kLaneRows + 1.0, mean = shape / sum, sd = std::sqrt(shape) / sum;
  EXPECT_NEAR(0.5 + 1.5 * timed.numbers[0].mean, mean, sd);
  EXPECT_NEAR(1.5 * timed.numbers[0].sd, sd, 0.25 * sd);  // the parts of the times lose a little
  EXPECT_TRUE(timed.numbers[0].told);
  o.timed.clear();
  EXPECT_FALSE(fit_trials(1, problem_at, o, {.trials = 200'000, .seed = 2}).numbers[0].told);
}

TEST(Fit, PartsOfTimesLieBetweenThoseThatDiffer) {
  Observed o;
  for (int i = 0; i < 300; ++i) {
    const bool crosses = i < 100;
    const auto ending = crosses ? markov::Ending::far_edge : markov::Ending::trapped;
    o.timed.push_back({static_cast<std::size_t>(ending), -1, !crosses ? 0.0 : i < 30 ? 7.0 : 8.0});
    ++o.seen.endings[static_cast<std::size_t>(ending)];
  }
  const auto problem_at = [](const std::vector<double>& x) { return waiting_lane(0.5 + x[0]); };
  EXPECT_EQ(fit_trials(1, problem_at, o, {.trials = 20'000, .seed = 2}).outcomes.times,
            std::vector<double>{7.5});
}

// By simulation: 60 experiments with rates drawn from the range. With few trials of the model,
// whose sampling error the intervals must include too.
TEST(Fit, IntervalsOfTimesHoldWhatTheyShould) {
  int held = 0;
  constexpr int kExperiments = 60;
  const auto problem_at = [](const std::vector<double>& x) {
    return waiting_lane(0.5 + 1.5 * x[0]);
  };
  for (int i = 0; i < kExperiments; ++i) {
    Random random(Purpose::fit, {5, static_cast<std::uint64_t>(i), 0});
    const double at = random.uniform();
    const Problem truth = problem_at({at});
    FieldTrials each;
    const FieldTally tally =
        run_field(truth.cells, truth.field, truth.start, 9, {1'000'000'000 + 1000 * i, 100}, &each);
    Observed o;
    o.seen = {{}, tally.endings};
    for (std::size_t t = 0; t < each.endings.size(); ++t)
      o.timed.push_back({static_cast<std::size_t>(*each.endings[t]), -1,
                         each.endings[t] == markov::Ending::far_edge ? each.costs[t][0] : 0.0});
    const Fit f = fit_trials(1, problem_at, o, {.trials = 60'000, .seed = 2});
    held += f.numbers[0].interval[0] <= at && at <= f.numbers[0].interval[1];
  }
  // 95 % within sampling error (p > 0.001 by the binomial distribution).
  EXPECT_GE(held, 51);
}

TEST(Fit, TellsTwoNumbersApart) {
  const Observed o = experiment(two_lane(0.7, 0.9), 400, 8);
  const Fit f = fit_trials(
      2, [](const std::vector<double>& x) { return two_lane(chance_at(x[0]), chance_at(x[1])); }, o,
      {.trials = 200'000, .seed = 3});
  EXPECT_TRUE(f.settled()) << f.misfit << " " << f.mixing;
  for (const int k : {0, 1}) {
    const auto [met, on] = passes(o, k);
    const boost::math::beta_distribution<> exact(static_cast<double>(on) + 1.0,
                                                 static_cast<double>(met - on) + 1.0);
    const double sd = boost::math::standard_deviation(exact);
    EXPECT_NEAR(chance_at(f.numbers[static_cast<std::size_t>(k)].mean), boost::math::mean(exact),
                0.3 * sd);
    EXPECT_NEAR((kHigh - kLow) * f.numbers[static_cast<std::size_t>(k)].sd, sd, 0.15 * sd);
  }
  EXPECT_LT(std::abs(f.correlation(0, 1)), 0.15);
}

/// Each passage of these trials, with the entry by which it began.
std::vector<EnteredPassage> passages_of(const Problem& problem, std::int64_t trials,
                                        std::uint64_t seed) {
  FieldTrials each{.keep_passages = true};
  (void)run_field(problem.cells, problem.field, problem.start, seed, {1'000'000'000, trials},
                  &each);
  std::vector<EnteredPassage> all;
  for (std::size_t i = 0; i < each.passed.size(); ++i) {
    Entry from = problem.start;
    for (const CellPassage passage : each.of_trial(i)) {
      all.push_back({from, passage});
      from = passage.entry;
    }
  }
  return all;
}

// Each type has its own posterior from passages; trials tell only where bodies end.
TEST(Fit, PassagesAreTheExactPosteriorOfEachType) {
  const std::vector<EnteredPassage> seen = passages_of(two_lane(0.7, 0.9), 120, 8);
  const auto problem_at = [](const std::vector<double>& x) {
    return two_lane(chance_at(x[0]), chance_at(x[1]));
  };
  const FitData data = passages_to_fit(seen, 2, problem_at, 200'000);
  EXPECT_EQ(data.outcomes.faces.size(), 1U);
  const std::size_t begins = data.outcomes.begins.size();
  EXPECT_GE(begins, 2U);
  EXPECT_LE(begins, 16U);
  EXPECT_EQ(data.inside, 0);
  const Fit f = fit(2, problem_at, data, {.trials = 200'000, .seed = 3});
  EXPECT_TRUE(f.settled()) << f.misfit << " " << f.mixing;
  EXPECT_EQ(f.observed, std::ssize(seen));
  EXPECT_GT(f.p, 0.01);
  for (const int type : {0, 1}) {
    double met = 0.0, on = 0.0, predicted_met = 0.0;
    for (const EnteredPassage& p : seen)
      if (p.passage.type == type) {
        met += 1.0;
        on += p.passage.fate == Fate::left;
      }
    const boost::math::beta_distribution<> exact(on + 1.0, met - on + 1.0);
    const double sd = boost::math::standard_deviation(exact);
    const FittedNumber& number = f.numbers[static_cast<std::size_t>(type)];
    EXPECT_NEAR(chance_at(number.mean), boost::math::mean(exact), 0.25 * sd);
    EXPECT_NEAR((kHigh - kLow) * number.sd, sd, 0.1 * sd);
    // A simulated experiment has as many passages through this type.
    for (Eigen::Index g = 0; g < std::ssize(f.groups); ++g)
      if (data.outcomes.begins[f.groups[static_cast<std::size_t>(g)].outcomes.front() / 2]
              .starts_with(problem_at({0.5, 0.5}).types[static_cast<std::size_t>(type)] + ":"))
        predicted_met += f.predicted(0, g);
    EXPECT_EQ(predicted_met, met);
  }
  EXPECT_LT(std::abs(f.correlation(0, 1)), 0.15);
}

TEST(Fit, TimesOfPassagesTellWhatTheirEndsDoNot) {
  const std::vector<EnteredPassage> seen = passages_of(waiting_lane(1.1), 60, 9);
  double sum = 0.0, left = 0.0;
  for (const EnteredPassage& p : seen)
    if (p.passage.fate == Fate::left) {
      sum += p.passage.costs[0];
      left += 1.0;
    }
  const auto problem_at = [](const std::vector<double>& x) {
    return waiting_lane(0.5 + 1.5 * x[0]);
  };
  const FitData data = passages_to_fit(seen, 1, problem_at, 200'000);
  EXPECT_EQ(data.outcomes.times.size(), 7U);
  const Fit f = fit(1, problem_at, data, {.trials = 200'000, .seed = 2});
  const double mean = (left + 1.0) / sum, sd = std::sqrt(left + 1.0) / sum;
  EXPECT_NEAR(0.5 + 1.5 * f.numbers[0].mean, mean, sd);  // only quantiles of the times are known
  EXPECT_NEAR(1.5 * f.numbers[0].sd, sd, 0.2 * sd);
}

// With many observations of a number without any effect, the fit does not take sampling error of
// the trials for an effect.
TEST(Fit, MuchThatWasSeenTellsNothingOfWhatChangesNothing) {
  const std::vector<EnteredPassage> seen = passages_of(waiting_lane(1.1), 300, 9);
  const ProblemAt at = [](const std::vector<double>&) { return waiting_lane(1.1); };
  constexpr std::int64_t kTrials = 150'000;
  const FitData data = passages_to_fit(seen, 1, at, kTrials);
  int told = 0;
  double sd = 0.0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const Fit f = fit(1, at, data, {.trials = kTrials, .seed = seed});
    told += f.numbers[0].told && f.settled();
    sd += f.numbers[0].sd / 6.0;
  }
  EXPECT_EQ(told, 0);
  EXPECT_NEAR(sd, 1.0 / std::sqrt(12.0), 0.02);
}

TEST(Fit, PassagesMayStandInAnyOrder) {
  std::vector<EnteredPassage> seen = passages_of(two_lane(0.7, 0.9), 60, 8);
  const ProblemAt at = [](const std::vector<double>& x) {
    return two_lane(chance_at(x[0]), chance_at(x[1]));
  };
  const auto draws = [&] {
    return fit(2, at, passages_to_fit(seen, 2, at, 50'000), {.trials = 50'000, .seed = 1}).draws;
  };
  const Eigen::MatrixXd in_order = draws();
  std::reverse(seen.begin(), seen.end());
  EXPECT_EQ(draws(), in_order);
}

// By simulation: 60 experiments with rates drawn from the range. With few trials of the model,
// whose sampling error the intervals must include too.
TEST(Fit, IntervalsOfPassagesHoldWhatTheyShould) {
  int held = 0;
  constexpr int kExperiments = 60;
  const auto problem_at = [](const std::vector<double>& x) {
    return waiting_lane(0.5 + 1.5 * x[0]);
  };
  for (int i = 0; i < kExperiments; ++i) {
    Random random(Purpose::fit, {6, static_cast<std::uint64_t>(i), 0});
    const double at = random.uniform();
    const auto seen = passages_of(problem_at({at}), 40, 100 + static_cast<std::uint64_t>(i));
    const FitData data = passages_to_fit(seen, 1, problem_at, 15'000);
    const Fit f = fit(1, problem_at, data, {.trials = 15'000, .seed = 2});
    held += f.numbers[0].interval[0] <= at && at <= f.numbers[0].interval[1];
  }
  EXPECT_GE(held, 51);  // 95 % within sampling error (p > 0.001 by the binomial distribution)
}

TEST(Fit, PassagesThatWereLostAreLeftOut) {
  std::vector<EnteredPassage> seen = passages_of(two_lane(0.7, 0.9), 20, 8);
  const ProblemAt at = [](const std::vector<double>& x) { return two_lane(x[0], x[0]); };
  const FitData all = passages_to_fit(seen, 1, at, 20'000);
  seen.push_back({{}, {Fate::broken, 0, {}, {}}});
  EXPECT_EQ(passages_to_fit(seen, 1, at, 20'000).seen, all.seen);
  EXPECT_THROW((void)passages_to_fit({seen.back()}, 1, at, 20'000), std::invalid_argument);
}

TEST(Fit, SaysWhatTheDataCannotTell) {
  const Observed o = experiment(two_lane(0.8, 0.8), 300, 9);
  const Fit f = fit_trials(
      2, [](const std::vector<double>& x) { return two_lane(chance_at(x[0]), chance_at(x[0])); }, o,
      {.trials = 200'000, .seed = 4});
  EXPECT_TRUE(f.numbers[0].told);
  EXPECT_FALSE(f.numbers[1].told);  // this number changes nothing
  // Only the product of the two numbers has an effect.
  const Fit product = fit_trials(2,
                                 [](const std::vector<double>& x) {
                                   const double both = chance_at(x[0]) * (0.8 + 0.4 * x[1]) / 1.2;
                                   return two_lane(both, both);
                                 },
                                 o, {.trials = 200'000, .seed = 5});
  EXPECT_LT(product.correlation(0, 1), -0.9);
}

TEST(Fit, SeesThatNoNumberFits) {
  const Observed o = experiment(two_lane(0.95, 0.5), 400, 10);
  const Fit f = fit_trials(
      1, [](const std::vector<double>& x) { return two_lane(chance_at(x[0]), chance_at(x[0])); }, o,
      {.trials = 100'000, .seed = 6});
  EXPECT_LT(f.p, 0.001);
  const Observed above = experiment(two_lane(0.98, 0.98), 400, 11);
  const Fit edge = fit_trials(
      1, [](const std::vector<double>& x) { return two_lane(chance_at(x[0]), chance_at(x[0])); },
      above, {.trials = 100'000, .seed = 6});
  EXPECT_TRUE(edge.numbers[0].goes_on[1]);
  EXPECT_FALSE(edge.numbers[0].goes_on[0]);
}

TEST(Fit, CountsWhatNoBodyOfTheModelDoes) {
  Observed o = experiment(two_lane(0.8, 0.8), 300, 14);
  o.gates_by_ending[static_cast<std::size_t>(markov::Ending::left_edge)](2, 0) = 5;
  const Fit f = fit_trials(
      1, [](const std::vector<double>& x) { return two_lane(chance_at(x[0]), chance_at(x[0])); }, o,
      {.trials = 50'000, .seed = 7});
  EXPECT_EQ(f.never, 5);
  EXPECT_EQ(f.observed, 305);
}

TEST(Fit, RanksOfTheTruthAreUniform) {  // simulation-based calibration (Talts et al. 2018)
  constexpr int kExperiments = 40, kBins = 5;
  std::array<std::array<int, kBins>, 2> ranks{};
  for (int e = 0; e < kExperiments; ++e) {
    Random random(Purpose::fit, {99, 0, static_cast<std::uint64_t>(e)});
    const std::vector<double> truth{random.uniform(), random.uniform()};
    const Observed o = experiment(two_lane(chance_at(truth[0]), chance_at(truth[1])), 60, 1000 + e);
    const Fit f = fit_trials(
        2, [](const std::vector<double>& x) { return two_lane(chance_at(x[0]), chance_at(x[1])); },
        o, {.trials = 25'000, .seed = static_cast<std::uint64_t>(e)});
    for (const std::size_t k : {0U, 1U}) {
      const double below =
          static_cast<double>(
              (f.draws.col(static_cast<Eigen::Index>(k)).array() < truth[k]).count()) /
          static_cast<double>(f.draws.rows());
      ++ranks[k][static_cast<std::size_t>(std::min(kBins - 1.0, kBins * below))];
    }
  }
  for (const auto& of_number : ranks) {
    double chi_squared = 0.0;
    for (const int n : of_number)
      chi_squared += std::pow(n - kExperiments / kBins, 2.0) / (double(kExperiments) / kBins);
    EXPECT_LT(chi_squared, 18.5);  // p = 0.001 with four degrees of freedom
  }
}

/// The posterior's shares of equal parts of the range of one number, by Simpson's rule.
template <class LogLikelihood>
std::vector<double> shares_of(const LogLikelihood& log_likelihood, int parts) {
  constexpr int kSteps = 2000;  // per part
  std::vector<double> shares(static_cast<std::size_t>(parts));
  const double most = log_likelihood(0.8);
  for (int i = 0; i < parts; ++i)
    for (int step = 0; step <= kSteps; ++step) {
      const double x = (i + static_cast<double>(step) / kSteps) / parts,
                   weight = step == 0 || step == kSteps ? 1.0
                            : step % 2 == 1             ? 4.0
                                                        : 2.0;
      shares[static_cast<std::size_t>(i)] += weight * std::exp(log_likelihood(x) - most);
    }
  const double all = std::accumulate(shares.begin(), shares.end(), 0.0);
  for (double& share : shares) share /= all;
  return shares;
}

// The probability goes up and down over the range, so that five values explain the counts equally
// well. Where it is steeper, the maximum is narrower.
TEST(Fit, KeepsEachHillOfOneNumber) {
  const auto chance = [](double x) { return 0.72 + 0.2 * std::sin(20.0 * x * x - 1.0); };
  const auto problem_at = [&](const std::vector<double>& x) {
    return two_lane(chance(x[0]), chance(x[0]));
  };
  const Observed o = experiment(two_lane(0.75, 0.75), 100, 21);
  const auto even = passes(o, 0), odd = passes(o, 1);
  const double on = static_cast<double>(even[1] + odd[1]),
               off = static_cast<double>(even[0] + odd[0]) - on;
  constexpr int kTenths = 10;
  const std::vector<double> exact = shares_of(
      [&](double x) { return on * std::log(chance(x)) + off * std::log(1.0 - chance(x)); },
      kTenths);
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const Fit f = fit_trials(1, problem_at, o, {.trials = 100'000, .seed = seed});
    EXPECT_LE(f.outside, Fit::kPermittedOutside) << seed;
    for (int tenth = 0; tenth < kTenths; ++tenth) {
      const auto place = (kTenths * f.draws.array()).floor();
      const double share = (place == tenth).cast<double>().mean();
      EXPECT_NEAR(share, exact[static_cast<std::size_t>(tenth)], 0.1) << tenth;
    }
  }
}

// The field is its own mirror image, and as many bodies leave left as right: soft beams on the left
// explain the data as well as soft beams on the right. On a grid of 4 Nm/rad with 4000 trials per
// point, 95 % of either number lie in [298, 406]; the maxima are at (306, 399) and (399, 306).
// Each seed must find both hills, so 4 seeds show a fit that finds one of them; the full test
// has 12.
TEST(Fit, AFieldThatIsItsMirrorImageHasBothHills) {
  const RangedScene scene(
      TomlFile("forces = { propulsion_N = 7.0, random_N = 4.0 }\n"
               "run = { method = \"moreau\" }\n"
               "field = { columns = 1, rows = 2, max_gates = 0 }\n"
               "start = { x_m = 0.0, vy_m_per_s = 14.0 }\n",
               "mirrored.toml"),
      {}, {"beams.stiffness_left_Nm_per_rad=50:900", "beams.stiffness_right_Nm_per_rad=50:900"},
      "free");
  Observed o;
  o.seen.endings[static_cast<std::size_t>(markov::Ending::far_edge)] = 30;
  o.seen.endings[static_cast<std::size_t>(markov::Ending::left_edge)] = 20;
  o.seen.endings[static_cast<std::size_t>(markov::Ending::right_edge)] = 20;
  o.seen.endings[static_cast<std::size_t>(markov::Ending::trapped)] = 10;
  int same = 0;
  const int seeds = test::usual_or_full(4, 12);
  for (std::uint64_t seed = 1; seed <= static_cast<std::uint64_t>(seeds); ++seed) {
    const Fit f =
        fit_trials(2, [&](const std::vector<double>& x) { return problem_of(scene.at(x)); }, o,
                   {.trials = 40'000, .seed = seed});
    double apart = 0.0;
    for (const std::size_t end : {0U, 1U}) {
      const std::array<double, 2> ends{scene.ranges()[0].at(f.numbers[0].interval[end]),
                                       scene.ranges()[1].at(f.numbers[1].interval[end])};
      apart = std::max(apart, std::abs(ends[0] - ends[1]));
    }
    for (const std::size_t k : {0U, 1U}) {
      EXPECT_LT(scene.ranges()[k].at(f.numbers[k].interval[0]), 306.0) << seed << " " << k;
      EXPECT_GT(scene.ranges()[k].at(f.numbers[k].interval[1]), 399.0) << seed << " " << k;
    }
    same += apart < 20.0;
  }
  EXPECT_GE(same,
            test::usual_or_full(2, 4));  // with so few trials, the others are wider on one side
}

TEST(Fit, IsTheSameOnOneThread) {
  const Observed o = experiment(two_lane(0.7, 0.8), 100, 12);
  const auto one_fit = [&] {
    return fit_trials(
        2, [](const std::vector<double>& x) { return two_lane(chance_at(x[0]), chance_at(x[1])); },
        o, {.trials = 25'000, .seed = 1});
  };
  const Fit many = one_fit();
  const Fit one = test::on_threads(1, one_fit);
  EXPECT_EQ(many.draws, one.draws);
  EXPECT_EQ(many.predicted, one.predicted);
}

TEST(Fit, RefusesWhatItCannotUse) {
  const ProblemAt at = [](const std::vector<double>& x) { return two_lane(x[0], x[0]); };
  Observed o = experiment(two_lane(0.7, 0.8), 100, 13);
  const FitData data = trials_to_fit(o, at({0.5}));
  EXPECT_THROW((void)fit(0, at, data, {}), std::invalid_argument);
  EXPECT_THROW((void)fit(7, at, data, {}), std::invalid_argument);
  EXPECT_THROW((void)fit_trials(1, at, o, {.trials = 100}), std::invalid_argument);
  EXPECT_THROW((void)fit_trials(1, at, {}, {}), std::invalid_argument);
  o.gates_by_ending = {};  // which gates and endings belong together is unknown
  EXPECT_THROW((void)fit_trials(1, at, o, {}), std::invalid_argument);
  o.seen.endings = {};
  o.seen.final_gates = CellCounts::Zero(3, 1);
  EXPECT_THROW((void)fit_trials(1, at, o, {}), std::invalid_argument);
}

}  // namespace
}  // namespace gatewalk::lattice
