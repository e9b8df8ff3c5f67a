// SPDX-License-Identifier: MIT
#include "lattice/study/variance_shares.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <numeric>
#include <stdexcept>
#include <string>

#include "dynamics/base/kept_pieces.h"
#include "lattice/field/field_trials.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;

constexpr std::int64_t kTrials = 16;    // per answer
constexpr std::int64_t kLeastRows = 4;  // per scramble

std::int64_t trials_of_row(int numbers) { return (numbers + 2) * 2 * kTrials; }

/// Numbers of trials that ended in the target, by point.
struct Answers {
  std::vector<std::int64_t> one, other;
  Health health;
};
template <class Archive>
void each_part(Archive& archive, Answers& a) {
  archive(a.one, a.other, a.health);
}

}  // namespace

std::int64_t least_trials_of_shares(int numbers) {
  return kTrialGroups * kLeastRows * trials_of_row(numbers);
}

VarianceShares variance_shares(int numbers, const ProblemAt& problem_at, markov::Ending target,
                               const VarianceSharesOptions& options, const Work& work) {
  const Stopwatch watch;
  const IndexDesign design(numbers, options.seed);
  if (options.trials < least_trials_of_shares(numbers))
    throw std::invalid_argument("indices of " + std::to_string(numbers) + " numbers need " +
                                std::to_string(least_trials_of_shares(numbers)) + " trials");
  const auto rows = std::bit_floor(
      static_cast<std::uint64_t>(options.trials / (kTrialGroups * trials_of_row(numbers))));
  VarianceShares out;
  out.points = kTrialGroups * static_cast<std::int64_t>(rows) * design.points_of_row();
  out.trials = out.points * 2 * kTrials;
  const auto run = [&](TrialRange points) {
    const auto count = static_cast<std::size_t>(points.count);
    Answers a{std::vector<std::int64_t>(count), std::vector<std::int64_t>(count), {}};
    std::vector<Health> health(count);
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
      const std::int64_t point = points.first + static_cast<std::int64_t>(i);
      const Problem problem = problem_at(design.point(point));
      FieldTrials each;
      health[i] = run_field(problem.cells, problem.field, problem.start, options.seed,
                            {point / design.points_of_row() * 2 * kTrials, 2 * kTrials}, &each)
                      .health;
      const auto half = each.endings.begin() + kTrials;
      a.one[i] = std::count(each.endings.begin(), half, target);
      a.other[i] = std::count(half, each.endings.end(), target);
    });
    for (const Health& h : health) a.health += h;
    return a;
  };
  std::vector<double> one, other;
  in_kept_pieces(work, {"points of the ranges", {0, out.points}}, Answers{}, run,
                 [&](const Answers& a) {
                   for (const auto& answers : {a.one, a.other})
                     out.ended += std::accumulate(answers.begin(), answers.end(), std::int64_t{0});
                   for (const std::int64_t n : a.one)
                     one.push_back(static_cast<double>(n) / kTrials);
                   for (const std::int64_t n : a.other)
                     other.push_back(static_cast<double>(n) / kTrials);
                   out.health += a.health;
                 });
  out.indices = sobol_indices(design, one, other);
  out.seconds = watch.seconds();
  return out;
}

}  // namespace gatewalk::lattice
