// SPDX-License-Identifier: MIT
#pragma once
/// Fits numbers of a field to an experiment: their posterior distribution, given how the
/// experiment's trials ended.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "dynamics/base/work.h"
#include "dynamics/cells/health.h"
#include "lattice/study/fit_data.h"
#include "lattice/study/variance_shares.h"

namespace gatewalk::lattice {

/// How many trials a fit may run.
struct FitOptions {
  std::int64_t trials = 400'000;  // through the field, all points together
  std::uint64_t seed = 1;
};
inline constexpr int kMostFitted = 6;
/// Least number of trials for a posterior of `numbers` numbers.
[[nodiscard]] std::int64_t least_trials_of_fit(int numbers);

/// Outcomes (gates or ways of ending) that are counted together: neighbours of one ending, until
/// they have at least a hundredth of all trials. For passages: those that begin by one face, and
/// end alike.
struct OutcomeGroup {
  std::int64_t observed = 0;
  double expected = 0.0;              // mean over the posterior, for the same number of trials
  std::array<double, 2> interval{};   // range of 95 % of such experiments
  std::vector<std::size_t> outcomes;  // indices of FittedOutcomes, in order
};

/// The posterior of one number.
struct FittedNumber {
  double mean = 0.0, sd = 0.0, median = 0.0;
  std::array<double, 2> interval{};  // 95 %
  double best = 0.0;                 // of the draw with the greatest likelihood
  double by_runs = 0.0;              // share of the variance that more trials would remove
  bool told = false;                 // the data narrow the range
  std::array<bool, 2> goes_on{};     // likely values reach the low and the high end of the range
};

/// The result of a fit. Numbers are coordinates of the unit cube of their ranges, 0: low end.
struct Fit {
  Eigen::MatrixXd draws;            // (draws x numbers), from the posterior
  Eigen::VectorXd log_likelihoods;  // (draws), of the observed counts, by the best coefficients
  Eigen::Index best = 0;            // draw with the greatest likelihood
  std::vector<Eigen::Index> walks;  // by draw: index of its independent walk
  std::vector<FittedNumber> numbers;
  Eigen::MatrixXd correlation;  // (numbers x numbers)
  FittedOutcomes outcomes;
  std::vector<OutcomeGroup> groups;
  Eigen::MatrixXd predicted;  // (draws x groups), a simulated experiment at each draw
  /// Share of simulated experiments that are further from the expectation than the observed one;
  /// `never` counts as a further group.
  double p = 1.0;
  double misfit = 0.0;  // possible error of a log likelihood between the points
  int rounds = 0, degree = 0;
  std::int64_t points = 0, trials = 0, observed = 0;
  std::int64_t parts = 1;    // parts of the ranges with polynomials of their own
  double volume = 1.0;       // share of the ranges in which the last round's points lie
  double mixing = 1.0;       // Gelman and Rubin's R of the worst number
  double near_bounds = 0.0;  // share of the draws at the edge of the points' region
  double outside = 0.0;      // share of the posterior where earlier rounds cut off, by points there
  std::int64_t never = 0;    // observed trials with an outcome that no trial at these points had
  dynamics::Health health;
  double seconds = 0.0;
  static constexpr double kPermittedMisfit = 0.5, kPermittedOutside = 0.01;
  [[nodiscard]] bool settled() const;
};

/// The posterior of numbers with a uniform prior over their ranges. Outcome probabilities come from
/// trials, or passages, at points of the ranges, with a smooth model between the points
/// (OutcomeModel), whose own uncertainty is included. The points of each round lie where the
/// likelihood of the round before is not small. `data` must belong to the fields at these points.
/// Throws std::invalid_argument for a number of numbers outside 1 to kMostFitted, and for too few
/// trials, also compared with those observed.
[[nodiscard]] Fit fit(int numbers, const ProblemAt& problem_at, const FitData& data,
                      const FitOptions& options, const dynamics::Work& work = {});

}  // namespace gatewalk::lattice
