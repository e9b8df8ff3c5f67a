// SPDX-License-Identifier: MIT
#pragma once
/// Which numbers of a field an experiment speaks for: their posterior, given how its trials ended.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "dynamics/base/work.h"
#include "dynamics/cells/health.h"
#include "lattice/study/fit_data.h"
#include "lattice/study/variance_shares.h"

namespace gatewalk::lattice {

struct FitOptions {
  std::int64_t trials = 400'000;  // through the field, all points together
  std::uint64_t seed = 1;
};
inline constexpr int kMostFitted = 6;
/// Fewer trials than this make no posterior of so many numbers.
[[nodiscard]] std::int64_t least_trials_of_fit(int numbers);

/// Trials that ended in one of several gates or ways, which are counted together: as many
/// neighbours of one ending as have a hundredth of all trials at the points or more. Of passages
/// the same: those that begin by one face, and end alike.
struct OutcomeGroup {
  std::int64_t observed = 0;
  double expected = 0.0;              // of as many trials, mean over the posterior
  std::array<double, 2> interval{};   // 95 % of experiments like it have
  std::vector<std::size_t> outcomes;  // FittedOutcomes, in order
};

struct FittedNumber {
  double mean = 0.0, sd = 0.0, median = 0.0;
  std::array<double, 2> interval{};  // 95 %
  double best = 0.0;                 // of the draw with the greatest likelihood
  double by_runs = 0.0;              // share of the variance that more trials would take away
  bool told = false;                 // the data say more than the range does
  std::array<bool, 2> goes_on{};     // likely values lie at the range's low and high end
};

/// Numbers as coordinates of the ranges' unit cube, 0 their low ends.
struct Fit {
  Eigen::MatrixXd draws;            // (draws x numbers), from the posterior
  Eigen::VectorXd log_likelihoods;  // (draws), of the observed counts, by the best chances
  Eigen::Index best = 0;            // draw where it is greatest
  std::vector<Eigen::Index> walks;  // by draw: which of the independent walks it is from
  std::vector<FittedNumber> numbers;
  Eigen::MatrixXd correlation;  // (numbers x numbers)
  FittedOutcomes outcomes;
  std::vector<OutcomeGroup> groups;
  Eigen::MatrixXd predicted;  // (draws x groups), an experiment like it at each draw
  double p = 1.0;             // of experiments like it so many are further from what is expected
  double misfit = 0.0;        // by how much a log likelihood may be off between the points
  int rounds = 0, degree = 0;
  std::int64_t points = 0, trials = 0, observed = 0;
  std::int64_t parts = 1;    // of the ranges, each with polynomials of its own
  double volume = 1.0;       // of the ranges, where the last round's points lie
  double mixing = 1.0;       // Gelman and Rubin's R of the worst number
  double near_bounds = 0.0;  // share of the draws at the edge of where the points lie
  double outside = 0.0;      // of the posterior where earlier rounds cut off, by points there
  std::int64_t never = 0;    // observed trials that ended as none at these points did
  dynamics::Health health;
  double seconds = 0.0;
  static constexpr double kPermittedMisfit = 0.5, kPermittedOutside = 0.01;
  [[nodiscard]] bool settled() const;
};

/// The posterior of numbers that may be anywhere in their ranges alike. Chances of outcomes come
/// from trials, or passages, at points of the ranges, as a smooth function between them
/// (OutcomeModel); points of the next round lie where the likelihood of this one is not small; its
/// own uncertainty is counted. `data` is of the fields at these points. Throws
/// std::invalid_argument for another number of numbers, and for too few trials, also for as many as
/// were observed.
[[nodiscard]] Fit fit(int numbers, const ProblemAt& problem_at, const FitData& data,
                      const FitOptions& options, const dynamics::Work& work = {});

}  // namespace gatewalk::lattice
