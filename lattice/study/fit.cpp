// SPDX-License-Identifier: MIT
#include "lattice/study/fit.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <memory>
#include <numeric>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

#include "dynamics/base/kept_pieces.h"
#include "dynamics/base/points.h"
#include "lattice/statistics/draws.h"
#include "lattice/statistics/ensemble.h"
#include "lattice/statistics/outcome_tree.h"
#include "lattice/statistics/quantiles.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// per round; twice as many in the whole ranges, with several parts, and in the last round
constexpr Index kPoints = 128;
constexpr int kRounds = 13;                    // at most, before the last one
constexpr int kParts = 16;                     // of the trials: one per round, the rest in the last
constexpr int kLooks = 3;                      // most rounds that check what was cut off
constexpr std::int64_t kLeastTrials = 12'288;  // per number
constexpr std::int64_t kOfEachObserved = 3;    // trials of a round, per observed one
constexpr std::int64_t kFirstTrial = std::int64_t{1} << 51;  // numbers that no other trials have
constexpr std::int64_t kFewestAlone = 50;  // trials of a group that is the last of its ending
constexpr int kMostDegree = 4;
constexpr Index kWalkers = 32;   // per walk
constexpr Index kWalks = 16;     // each with its own coefficients
constexpr Index kCloud = 2048;   // pairs of points without trials, for a single number
constexpr int kCloudSteps = 20;  // steps that spread copied points
constexpr int kSteps = 400, kFirstSteps = 200, kEvery = 50;
constexpr int kBoundsOfEach = 8;    // coefficients of a bound besides the best ones
constexpr Index kMostNarrowed = 8;  // a round keeps at least one point in this number
constexpr double kOutside = 1e-4;   // of the posterior, which a round's points may leave out

/// The outcomes of all trials at some points, point by point. -1: a run broke.
struct PointOutcomes {
  std::vector<double> points;
  std::vector<std::int32_t> outcomes;
  Health health;
};
template <class Archive>
void each_part(Archive& archive, PointOutcomes& p) {
  archive(p.points, p.outcomes, p.health);
}

class Fitter {
 public:
  Fitter(int numbers, const ProblemAt& problem_at, const FitData& data, const FitOptions& options,
         const Work& work)
      : numbers_(numbers), problem_at_(problem_at), data_(data), options_(options), work_(work) {
    fit_.outcomes = data.outcomes;
    fit_.observed = std::accumulate(data.seen.begin(), data.seen.end(), std::int64_t{0});
  }

  [[nodiscard]] Fit carry_out() {
    const Stopwatch watch;
    run(even_points(4 * kPoints), 1);
    cloud_ = even_points(2 * (kCloud / numbers_)).transpose();
    for (fit_.rounds = 1;; ++fit_.rounds) {
      learn();
      // If half of the points stay, another round would hardly help.
      const bool is_near = narrow() > 0.5 && fit_.misfit <= Fit::kPermittedMisfit;
      if ((is_near || fit_.rounds + kLooks >= kRounds) && look_outside()) break;
      if (fit_.rounds >= kRounds) break;
      run(new_points(fit_.parts > 1 ? 2 * kPoints : kPoints), 1);
    }
    run(new_points(2 * kPoints), 0);
    learn();
    draw();
    summarise();
    const VectorXd best = fit_.draws.row(fit_.best).transpose();
    if (const Problem problem = problem_at_({best.begin(), best.end()}); problem.check)
      problem.check(fit_.health.runs / 10, options_.seed, fit_.health, work_);
    fit_.seconds = watch.seconds();
    return std::move(fit_);
  }

 private:
  /// Consecutive groups whose total number is given by the experiment: trials, or passages that
  /// begin alike.
  struct Given {
    Index first = 0, count = 0;
  };
  /// The log likelihood of the observations under a model.
  struct Likelihood {
    std::shared_ptr<const OutcomeTree> model;
    std::vector<Given> given;
    VectorXd observed;  // (groups)

    [[nodiscard]] double operator()(const OutcomeTree::Coefficients& coefficients,
                                    const VectorXd& point) const {
      VectorXd logs;
      model->log_chances(coefficients, point, logs);
      return of(logs);
    }
    [[nodiscard]] double of(const VectorXd& logs) const {
      double sum = observed.dot(logs);
      if (given.size() > 1)
        for (const Given& g : given) {
          const auto among = logs.segment(g.first, g.count).array();
          const double most = among.maxCoeff();
          sum -= observed.segment(g.first, g.count).sum() *
                 (most + std::log((among - most).exp().sum()));
        }
      return sum;
    }
  };
  /// The region where the likelihood of a round's model is not small, for any of these
  /// coefficients.
  struct Bound {
    Likelihood likelihood;
    // With the greatest log likelihood of each.
    std::vector<std::pair<OutcomeTree::Coefficients, double>> greatest;
    double below = HUGE_VAL;  // a point is outside if the log likelihood falls further than this

    /// How much further the log likelihood may fall at this point.
    [[nodiscard]] double margin(const VectorXd& point) const {
      double most = -HUGE_VAL;
      for (const auto& [coefficients, top] : greatest)
        most = std::max(most, likelihood(coefficients, point) - top + below);
      return most;
    }
    [[nodiscard]] bool holds(const VectorXd& point) const {
      return std::any_of(greatest.begin(), greatest.end(), [&](const auto& of) {
        return likelihood(of.first, point) >= of.second - below;
      });
    }
  };
  [[nodiscard]] bool inside(const VectorXd& point) const { return is_inside(bounds_, point); }
  [[nodiscard]] static bool is_inside(const std::vector<Bound>& bounds, const VectorXd& point) {
    if ((point.array() < 0.0).any() || (point.array() > 1.0).any()) return false;
    return std::all_of(bounds.begin(), bounds.end(),
                       [&](const Bound& b) { return b.holds(point); });
  }
  [[nodiscard]] Random random(std::uint64_t what) const {
    return {Purpose::fit, {options_.seed, what, static_cast<std::uint64_t>(fit_.rounds)}};
  }

  /// Evenly spread points in the whole ranges.
  [[nodiscard]] MatrixXd even_points(Index count) const {
    Random chance = random(0);
    const ScrambledPoints points(chance);
    MatrixXd all(count, numbers_);
    for (Index i = 0; i < count; ++i) {
      const Point at = points(static_cast<std::uint32_t>(i));
      for (Index k = 0; k < numbers_; ++k) all(i, k) = at[static_cast<std::size_t>(k)];
    }
    return all;
  }
  /// Of the evenly spread points outside the bounds, those whose nearest points' trials, taken
  /// together, explain the observations best. Maxima between points have such neighbours.
  [[nodiscard]] MatrixXd points_outside(const std::vector<Bound>& bounds) const {
    std::vector<Index> all(static_cast<std::size_t>(points_.rows()));
    std::iota(all.begin(), all.end(), Index{0});
    const MatrixXd counts = counts_of(all);
    const VectorXd shares = counts.colwise().sum().transpose() / counts.sum();
    const MatrixXd even = even_points(kMostNarrowed * 2 * kPoints);
    std::vector<std::pair<double, Index>> found;
    const auto nearest = static_cast<std::size_t>(numbers_ + 2);
    std::vector<std::pair<double, Index>> near(static_cast<std::size_t>(points_.rows()));
    for (Index i = 0; i < even.rows(); ++i) {
      if (is_inside(bounds, even.row(i).transpose())) continue;
      for (Index p = 0; p < points_.rows(); ++p)
        near[static_cast<std::size_t>(p)] = {(points_.row(p) - even.row(i)).squaredNorm(), p};
      std::partial_sort(near.begin(), near.begin() + nearest, near.end());
      VectorXd together = shares;
      for (std::size_t n = 0; n < nearest; ++n) together += counts.row(near[n].second).transpose();
      found.emplace_back(-likelihood_.of((together / together.sum()).array().log()), i);
    }
    std::sort(found.begin(), found.end());
    MatrixXd best(std::min<Index>(2 * kPoints, std::ssize(found)), numbers_);
    for (Index i = 0; i < best.rows(); ++i)
      best.row(i) = even.row(found[static_cast<std::size_t>(i)].second);
    return best;
  }
  /// Points that are uniform where all bounds hold: the first ones of the cloud. (A few Sobol
  /// points are evenly spread only if they are consecutive.)
  [[nodiscard]] MatrixXd new_points(Index count) const {
    return cloud_.leftCols(count).transpose();
  }

  /// Runs trials at points: `parts` parts of all trials; 0: the remaining trials.
  void run(const MatrixXd& points, int parts) {
    const std::int64_t each =
        (parts > 0 ? parts * options_.trials / kParts : options_.trials - fit_.trials) /
        std::max(points.rows(), kPoints);
    const std::string name =
        "points of round " + std::to_string(fit_.rounds + 1) + (parts > 0 ? "" : ", the last");
    const Index before = points_.rows();
    points_.conservativeResize(before + points.rows(), numbers_);
    points_.bottomRows(points.rows()) = points;
    in_kept_pieces(
        work_, {name, {0, points.rows()}}, PointOutcomes{},
        [&](TrialRange range) { return outcomes_at(points, range, each); },
        [&](const PointOutcomes& done) { take(done, each); });
    fit_.trials += each * points.rows();
  }

  [[nodiscard]] PointOutcomes outcomes_at(const MatrixXd& points, TrialRange range,
                                          std::int64_t each) const {
    const auto count = static_cast<std::size_t>(range.count);
    const auto trials = static_cast<std::size_t>(each);
    PointOutcomes all{{}, std::vector<std::int32_t>(count * trials), {}};
    for (std::int64_t i = range.first; i < range.first + range.count; ++i)
      all.points.insert(all.points.end(), points.row(i).begin(), points.row(i).end());
    std::vector<Health> health(count);
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
      const std::int64_t number = range.first + static_cast<std::int64_t>(i);
      const VectorXd point = points.row(number).transpose();
      health[i] = data_.run(problem_at_({point.begin(), point.end()}), options_.seed,
                            {kFirstTrial + fit_.trials + number * each, each},
                            std::span(all.outcomes).subspan(i * trials, trials));
    });
    for (const Health& h : health) all.health += h;
    return all;
  }
  /// The points of later rounds depend on earlier ones through logarithms, which other machines may
  /// round differently. Kept results of other points are not mixed with those asked for here.
  void take(const PointOutcomes& done, std::int64_t each) {
    const auto trials = static_cast<std::size_t>(each);
    const std::size_t count = done.outcomes.size() / trials, first = ends_.size();
    bool same = done.outcomes.size() == count * trials &&
                done.points.size() == count * static_cast<std::size_t>(numbers_) &&
                first + count <= static_cast<std::size_t>(points_.rows());
    for (std::size_t i = 0; same && i < done.points.size(); ++i)
      same = done.points[i] == points_(static_cast<Index>(first) + static_cast<Index>(i) / numbers_,
                                       static_cast<Index>(i) % numbers_);
    for (const std::int32_t o : done.outcomes)
      same = same && o >= -1 && o < static_cast<std::int32_t>(data_.order.size());
    if (!same)
      throw std::runtime_error(
          "fit: kept pieces are of other points than this run's, as another kind of machine may "
          "make them: begin without them");
    for (std::size_t i = 0; i < count; ++i) {
      const auto begin = done.outcomes.begin() + static_cast<std::ptrdiff_t>(i * trials);
      std::copy_if(begin, begin + each, std::back_inserter(ended_), [](auto o) { return o >= 0; });
      ends_.push_back(ended_.size());
    }
    fit_.health += done.health;
  }

  /// Calls count(outcome) for the trials of a point.
  template <class Count>
  void each_outcome(Index point, const Count& count) const {
    for (std::size_t i = point == 0 ? 0 : ends_[static_cast<std::size_t>(point) - 1];
         i < ends_[static_cast<std::size_t>(point)]; ++i)
      count(static_cast<std::size_t>(ended_[i]));
  }

  /// Fits the best model to the points where all bounds hold.
  void learn() {
    std::vector<Index> at;
    for (Index i = 0; i < points_.rows(); ++i)
      if (inside(points_.row(i).transpose())) at.push_back(i);
    used_ = points_(at, Eigen::all);
    std::vector<std::int64_t> all(data_.order.size(), 0);
    for (const Index point : at) each_outcome(point, [&](std::size_t outcome) { ++all[outcome]; });
    group(all);
    const Index groups = std::ssize(fit_.groups);
    group_of_.assign(data_.order.size(), 0);
    observed_ = VectorXd::Zero(groups);
    for (Index g = 0; g < groups; ++g) {
      const OutcomeGroup& group = fit_.groups[static_cast<std::size_t>(g)];
      observed_[g] = static_cast<double>(group.observed);
      for (const std::size_t outcome : group.outcomes) group_of_[outcome] = g;
    }
    const OutcomeCounts seen{used_, counts_of(at)};
    const double observed = static_cast<double>(fit_.observed);
    model_ = std::make_shared<const OutcomeTree>(
        seen, OutcomeTreeOptions{
                  .most_degree = kMostDegree,
                  .most_parameters = 2.0 * kMostParameters,
                  .lack_of_fit = Fit::kPermittedMisfit * Fit::kPermittedMisfit / (2.0 * observed)});
    likelihood_ = {model_, given_groups(), observed_};
    fit_.degree = model_->degree();
    fit_.points = used_.rows();
    fit_.misfit = std::sqrt(2.0 * observed * model_->lack_of_fit());
    fit_.parts = model_->leaves();
  }

  /// Counts by group at some points (points x groups).
  [[nodiscard]] MatrixXd counts_of(const std::vector<Index>& points) const {
    MatrixXd counts = MatrixXd::Zero(std::ssize(points), observed_.size());
    for (Index i = 0; i < counts.rows(); ++i)
      each_outcome(points[static_cast<std::size_t>(i)],
                   [&](std::size_t outcome) { counts(i, group_of_[outcome]) += 1.0; });
    return counts;
  }

  /// Merges neighbouring outcomes until they are enough. Trials of different endings are merged
  /// only if an ending has too few to learn from.
  void group(const std::vector<std::int64_t>& all) {
    const std::int64_t trials = std::accumulate(all.begin(), all.end(), std::int64_t{0});
    const double share =
        least_share(numbers_, static_cast<double>(trials), static_cast<double>(fit_.observed));
    const auto enough = std::max(
        kFewestAlone, static_cast<std::int64_t>(std::ceil(share * static_cast<double>(trials))));
    const std::size_t of_ending = fit_.outcomes.together();
    std::int64_t size = 0;   // trials of the last group
    std::size_t ending = 0;  // ending of the last group
    fit_.groups.clear();
    fit_.never = 0;
    const auto once = static_cast<double>(std::count(all.begin(), all.end(), 1));
    never_share_ =
        std::min(1.0, (once + 2.0 * std::sqrt(once) + 3.0) / static_cast<double>(trials));
    // An ending that the experiment showed keeps its own group.
    const auto is_enough = [&](bool whole_ending) {
      if (!whole_ending) return size >= enough;
      return size >= kFewestAlone || (size > 0 && fit_.groups.back().observed > 0);
    };
    for (const std::size_t outcome : data_.order) {
      if (all[outcome] == 0 && data_.seen[outcome] == 0) continue;
      if (all[outcome] == 0) fit_.never += data_.seen[outcome];
      if (fit_.groups.empty() || is_enough(outcome / of_ending != ending)) {
        fit_.groups.emplace_back();
        size = 0;
      }
      ending = outcome / of_ending;
      fit_.groups.back().outcomes.push_back(outcome);
      fit_.groups.back().observed += data_.seen[outcome];
      size += all[outcome];
    }
    if (fit_.groups.size() > 1 && !is_enough(true)) {
      const OutcomeGroup last = std::move(fit_.groups.back());
      fit_.groups.pop_back();
      OutcomeGroup& into = fit_.groups.back();
      into.outcomes.insert(into.outcomes.end(), last.outcomes.begin(), last.outcomes.end());
      into.observed += last.observed;
    }
    if (fit_.groups.size() < 2)
      throw std::invalid_argument(
          "fit: nearly all trials end alike anywhere in the ranges: how they end tells nothing");
  }

  [[nodiscard]] std::vector<Given> given_groups() const {
    std::vector<Given> given;
    const auto begins = [&](std::size_t outcome) {
      return fit_.outcomes.is_of_passages() ? outcome / fit_.outcomes.together() : 0;
    };
    for (std::size_t g = 0; g < fit_.groups.size(); ++g) {
      const bool goes_on = g > 0 && begins(fit_.groups[g - 1].outcomes.back()) ==
                                        begins(fit_.groups[g].outcomes.front());
      if (!goes_on) given.push_back({static_cast<Index>(g), 0});
      ++given.back().count;
    }
    return given;
  }

  /// An ensemble that starts at walkers drawn from the cloud by this likelihood. Each maximum gets
  /// its right share of walkers, although none walks from one to another.
  [[nodiscard]] Ensemble walk_of(const OutcomeTree::Coefficients& coefficients,
                                 Random& chance) const {
    const Index cloud = cloud_.cols();
    VectorXd sums(cloud);
    for (Index i = 0; i < cloud; ++i) sums[i] = likelihood_(coefficients, cloud_.col(i));
    sums = (sums.array() - sums.maxCoeff()).exp();
    std::partial_sum(sums.begin(), sums.end(), sums.begin());
    MatrixXd from(numbers_, kWalkers);
    const double first = chance.uniform();
    std::vector<Index> order(kWalkers);
    std::iota(order.begin(), order.end(), Index{0});
    for (Index i = kWalkers; i > 1; --i)
      std::swap(order[static_cast<std::size_t>(i - 1)],
                order[chance.below(static_cast<std::uint64_t>(i))]);
    for (Index i = 0; i < kWalkers; ++i) {
      const double at = (static_cast<double>(i) + first) / kWalkers * sums[cloud - 1];
      const Index place = std::lower_bound(sums.begin(), sums.end(), at) - sums.begin();
      from.col(order[static_cast<std::size_t>(i)]) = cloud_.col(std::min(place, cloud - 1));
    }
    return {[this, coefficients](const VectorXd& at) {
              return inside(at) ? likelihood_(coefficients, at) : -HUGE_VAL;
            },
            std::move(from)};
  }

  /// Adds a bound. Returns the share of the points inside.
  [[nodiscard]] double narrow() {
    Random chance = random(2);
    Bound bound{likelihood_, {{model_->best(), -HUGE_VAL}}};
    for (int k = 0; k < kBoundsOfEach; ++k)
      bound.greatest.emplace_back(model_->drawn(chance), -HUGE_VAL);
    std::vector<double> falls;  // by the best coefficients
    for (auto& [coefficients, top] : bound.greatest)
      for (Index i = 0; i < used_.rows(); ++i) {
        const double log = likelihood_(coefficients, used_.row(i).transpose());
        top = std::max(top, log);
        if (&top == &bound.greatest.front().second) falls.push_back(-log);
      }
    double below =
        2.0 * fit_.misfit + 0.5 * chi_squared_exceeded(static_cast<double>(numbers_), kOutside);
    // At least this number of points is kept: a later round detects errors far from the maximum.
    std::sort(falls.begin(), falls.end());
    below = std::max(below, bound.greatest.front().second +
                                falls[static_cast<std::size_t>(used_.rows() / kMostNarrowed)]);
    bounds_.push_back(std::move(bound));
    shrink(bounds_.back(), below, chance);
    Index in = 0;
    for (Index i = 0; i < used_.rows(); ++i) in += inside(used_.row(i).transpose());
    return static_cast<double>(in) / static_cast<double>(used_.rows());
  }
  /// Moves the cloud to where the last bound holds, in steps that keep enough of its points.
  void shrink(Bound& bound, double below, Random& chance) {
    const Index cloud = cloud_.cols();
    VectorXd falls(cloud);
    while (bound.below > below) {
      MatrixXd logs(cloud, std::ssize(bound.greatest));
      for (Index c = 0; c < logs.cols(); ++c) {
        auto& [coefficients, top] = bound.greatest[static_cast<std::size_t>(c)];
        for (Index i = 0; i < cloud; ++i)
          logs(i, c) = bound.likelihood(coefficients, cloud_.col(i));
        top = std::max(top, logs.col(c).maxCoeff());
        logs.col(c).array() -= top;
      }
      falls = -logs.rowwise().maxCoeff();
      std::vector<double> sorted(falls.begin(), falls.end());
      std::nth_element(sorted.begin(), sorted.begin() + cloud / kMostNarrowed, sorted.end());
      bound.below = std::max(below, sorted[cloud / kMostNarrowed]);
      std::vector<Index> in;
      for (Index i = 0; i < cloud; ++i)
        if (falls[i] <= bound.below) in.push_back(i);
      fit_.volume *= static_cast<double>(in.size()) / static_cast<double>(cloud);
      if (std::ssize(in) == cloud) continue;
      for (Index i = 0; std::ssize(in) < cloud; ++i) in.push_back(in[static_cast<std::size_t>(i)]);
      Ensemble walk([this](const VectorXd& at) { return inside(at) ? 0.0 : -HUGE_VAL; },
                    MatrixXd(cloud_(Eigen::all, in)));
      for (int step = 0; step < kCloudSteps; ++step) walk.step(chance);
      cloud_ = walk.walkers();
    }
  }

  /// Checks whether the posterior, by all points, reaches into the region that earlier rounds cut
  /// off. New points lie anywhere in that region at first, then where the posterior seems to lie.
  /// If it does, the bounds are made anew.
  [[nodiscard]] bool look_outside() {
    const std::vector<Bound> bounds = bounds_;
    const MatrixXd within = cloud_;
    const double volume = fit_.volume;
    MatrixXd outside = points_outside(bounds);
    for (int look = 0; look < kLooks && fit_.rounds < kRounds; ++look) {
      if (outside.rows() > 0) run(outside, 1);
      ++fit_.rounds;
      bounds_.clear();
      cloud_ = even_points(2 * (kCloud / numbers_)).transpose();
      fit_.volume = 1.0;
      learn();
      (void)narrow();
      const Index cloud = cloud_.cols();
      VectorXd weights(cloud), out(cloud);
      std::vector<Index> these;
      for (Index i = 0; i < cloud; ++i) {
        weights[i] = likelihood_(model_->best(), cloud_.col(i));
        out[i] = is_inside(bounds, cloud_.col(i)) ? 0.0 : 1.0;
        if (out[i] > 0.0) these.push_back(i);
      }
      weights = (weights.array() - weights.maxCoeff()).exp();
      fit_.outside = weights.dot(out) / weights.sum();
      if (fit_.outside <= Fit::kPermittedOutside && look == 0 && fit_.parts > 1) {
        outside = points_outside(bounds);  // a narrow maximum may lie between parts: once more
        continue;
      }
      if (fit_.outside <= Fit::kPermittedOutside) {
        bounds_ = bounds;
        cloud_ = within;
        fit_.volume = volume;
        return true;
      }
      outside.resize(std::min<Index>(2 * kPoints, std::ssize(these)), numbers_);
      for (Index i = 0; i < outside.rows(); ++i)
        outside.row(i) = cloud_.col(these[static_cast<std::size_t>(i)]).transpose();
    }
    return false;
  }

  /// Draws from the posterior, each walk with its own drawn coefficients.
  void draw() {
    std::vector<MatrixXd> walked(static_cast<std::size_t>(kWalks));
    coefficients_.resize(walked.size());
    tbb::parallel_for(std::size_t{0}, walked.size(), [&](std::size_t w) {
      Random chance = random(3 + w);
      coefficients_[w] = model_->drawn(chance);
      Ensemble walk = walk_of(coefficients_[w], chance);
      const Index walkers = walk.walkers().cols();
      MatrixXd& all = walked[w];
      all.resize(numbers_, walkers * (kSteps / kEvery));
      for (int step = 1; step <= kFirstSteps + kSteps; ++step) {
        walk.step(chance);
        if (step <= kFirstSteps || step % kEvery != 0) continue;
        const Index at = walkers * ((step - kFirstSteps) / kEvery - 1);
        all.middleCols(at, walkers) = walk.walkers();
      }
    });
    const Index of_each = walked[0].cols();
    fit_.draws.resize(of_each * kWalks, numbers_);
    fit_.log_likelihoods.resize(of_each * kWalks);
    for (Index w = 0; w < kWalks; ++w) {
      fit_.draws.middleRows(w * of_each, of_each) = walked[static_cast<std::size_t>(w)].transpose();
      fit_.walks.insert(fit_.walks.end(), static_cast<std::size_t>(of_each), w);
    }
    for (Index i = 0; i < fit_.draws.rows(); ++i)
      fit_.log_likelihoods[i] = likelihood_(model_->best(), fit_.draws.row(i).transpose());
    fit_.log_likelihoods.maxCoeff(&fit_.best);
  }

  void summarise() {
    const Index draws = fit_.draws.rows();
    const Eigen::RowVectorXd mean = fit_.draws.colwise().mean();
    const MatrixXd from_mean = fit_.draws.rowwise() - mean;
    const MatrixXd covariance = over_rows(from_mean, from_mean) / static_cast<double>(draws - 1);
    const VectorXd sd = covariance.diagonal().cwiseSqrt();
    const VectorXd by_sd = (sd.array() > 0.0).select(sd.cwiseInverse(), 0.0);
    fit_.correlation = by_sd.asDiagonal() * covariance * by_sd.asDiagonal();
    fit_.correlation.diagonal().setOnes();
    Index near = 0;
    for (Index i = 0; i < draws; ++i)
      near += std::any_of(bounds_.begin(), bounds_.end(), [&](const Bound& b) {
        return b.margin(fit_.draws.row(i).transpose()) < 1.0;
      });
    fit_.near_bounds = static_cast<double>(near) / static_cast<double>(draws);
    for (Index k = 0; k < numbers_; ++k) {
      std::vector<double> sorted(fit_.draws.col(k).begin(), fit_.draws.col(k).end());
      std::sort(sorted.begin(), sorted.end());
      const auto at = [&](double share) {
        return sorted[static_cast<std::size_t>(share * static_cast<double>(draws - 1))];
      };
      FittedNumber number{.mean = mean[k], .sd = sd[k], .median = at(0.5)};
      number.interval = {at(0.025), at(0.975)};
      number.best = fit_.draws(fit_.best, k);
      double from_flat = 0.0;  // Kolmogorov distance of the posterior from the uniform prior
      for (std::size_t i = 0; i < sorted.size(); ++i)
        from_flat = std::max(
            from_flat, std::abs(sorted[i] - static_cast<double>(i) / static_cast<double>(draws)));
      // Sampling error of the trials may give the log likelihood a slope. If the slope moves the
      // mean of uniform draws by x, the distance is 1.5 x.
      walks_of(k, number);
      constexpr double kHardlyMore = 0.15, kByChance = 2.0 * 1.5;
      number.told = from_flat > kHardlyMore + kByChance * number.sd * std::sqrt(number.by_runs);
      constexpr double kEdge = 0.02, kOften = 0.05;  // uniform draws: 0.02 of all
      const auto often = [&](auto count) {
        return number.told && static_cast<double>(count) > kOften * static_cast<double>(draws);
      };
      number.goes_on = {
          often(std::lower_bound(sorted.begin(), sorted.end(), kEdge) - sorted.begin()),
          often(sorted.end() - std::upper_bound(sorted.begin(), sorted.end(), 1.0 - kEdge))};
      fit_.numbers.push_back(number);
    }
    predict();
  }

  /// Variance between walks, beyond what their finite length explains, comes from their
  /// coefficients.
  void walks_of(Index k, FittedNumber& number) {
    const Index of_each = fit_.draws.rows() / kWalks, half = of_each / 2;
    VectorXd means(kWalks), differences(kWalks);
    double within = 0.0;
    for (Index w = 0; w < kWalks; ++w) {
      const auto all = fit_.draws.col(k).segment(w * of_each, of_each);
      means[w] = all.mean();
      differences[w] = all.head(half).mean() - all.tail(half).mean();
      within +=
          (all.array() - means[w]).square().sum() / static_cast<double>((of_each - 1) * kWalks);
    }
    const double by_length = differences.squaredNorm() / static_cast<double>(4 * kWalks);
    const double between = (means.array() - means.mean()).square().sum() / (kWalks - 1.0);
    if (number.sd > 0.0)
      number.by_runs = std::clamp((between - by_length) / (number.sd * number.sd), 0.0, 1.0);
    // Gelman and Rubin's R, from the halves of the walks.
    if (within > 0.0)
      fit_.mixing = std::max(fit_.mixing, std::sqrt(1.0 + 2.0 * by_length / within));
  }

  /// Simulates an experiment like this one at each draw. Outcomes that no simulated trial had are a
  /// further group of each experiment, although the model counts them with their neighbours.
  void predict() {
    const Index draws = fit_.draws.rows(), groups = observed_.size();
    fit_.predicted.resize(draws, groups);
    Random chance = random(2 + kWalks + 1), of_never = random(2 + kWalks + 2);
    const double never = static_cast<double>(fit_.observed) * never_share_;
    VectorXd logs, mean = VectorXd::Zero(groups);
    std::vector<std::int64_t> counts(static_cast<std::size_t>(groups));
    Index further = 0;
    const std::vector<Given>& given = likelihood_.given;
    for (Index i = 0; i < draws; ++i) {
      const auto walk = static_cast<std::size_t>(fit_.walks[static_cast<std::size_t>(i)]);
      model_->log_chances(coefficients_[walk], fit_.draws.row(i).transpose(), logs);
      VectorXd chances = logs.array().exp();
      for (const Given& g : given) {
        auto among = chances.segment(g.first, g.count);
        if (given.size() > 1) among /= among.sum();
        const auto first = static_cast<std::size_t>(g.first),
                   count = static_cast<std::size_t>(g.count);
        const auto observed = static_cast<std::int64_t>(observed_.segment(g.first, g.count).sum());
        multinomial(observed, {among.data(), count}, std::span(counts).subspan(first, count),
                    chance);
        among *= static_cast<double>(observed);
      }
      for (Index g = 0; g < groups; ++g)
        fit_.predicted(i, g) = static_cast<double>(counts[static_cast<std::size_t>(g)]);
      const VectorXd expected = chances.cwiseMax(std::numeric_limits<double>::min());
      const auto distance = [&](const VectorXd& n, std::int64_t of_never_seen) {
        const double more = static_cast<double>(of_never_seen) - never;
        return (n - expected).cwiseAbs2().cwiseQuotient(expected).sum() + more * more / never;
      };
      std::array<std::int64_t, 2> split{};
      multinomial(fit_.observed, std::array{never_share_, 1.0 - never_share_}, split, of_never);
      if (distance(fit_.predicted.row(i).transpose(), split[0]) >= distance(observed_, fit_.never))
        ++further;
      mean += expected / static_cast<double>(draws);
    }
    fit_.p = static_cast<double>(further) / static_cast<double>(draws);
    for (Index g = 0; g < groups; ++g) {
      OutcomeGroup& group = fit_.groups[static_cast<std::size_t>(g)];
      group.expected = mean[g];
      std::vector<double> sorted(fit_.predicted.col(g).begin(), fit_.predicted.col(g).end());
      std::sort(sorted.begin(), sorted.end());
      group.interval = {sorted[static_cast<std::size_t>(draws / 40)],
                        sorted[static_cast<std::size_t>(draws - 1 - draws / 40)]};
    }
  }

  int numbers_;
  const ProblemAt& problem_at_;
  const FitData& data_;
  const FitOptions& options_;
  const Work& work_;
  MatrixXd points_;                  // (points x numbers) all points
  std::vector<std::int32_t> ended_;  // outcomes of all trials, point by point
  std::vector<std::size_t> ends_;    // by point: end of its outcomes in ended_
  std::vector<Bound> bounds_;
  MatrixXd used_;                // points of the model
  VectorXd observed_;            // (groups)
  std::vector<Index> group_of_;  // by outcome
  // Upper end of a 95 % interval, about, for the share of trials with an outcome that no trial of
  // the model had: the missing mass of Good and Turing, 3 / trials if no outcome occurred once.
  double never_share_ = 1.0;
  Likelihood likelihood_;  // of the observations, under the model
  std::shared_ptr<const OutcomeTree> model_;
  MatrixXd cloud_;  // (numbers x points) uniform where all bounds hold
  std::vector<OutcomeTree::Coefficients> coefficients_;  // by walk
  Fit fit_;
};

}  // namespace

std::int64_t least_trials_of_fit(int numbers) { return kLeastTrials * numbers; }

bool Fit::settled() const {
  constexpr double kPermittedMixing = 1.05, kPermittedByRuns = 0.2, kPermittedNear = 0.01;
  return misfit <= kPermittedMisfit && outside <= kPermittedOutside && mixing <= kPermittedMixing &&
         near_bounds <= kPermittedNear &&
         std::all_of(numbers.begin(), numbers.end(),
                     [](const FittedNumber& n) { return n.by_runs <= kPermittedByRuns; });
}

Fit fit(int numbers, const ProblemAt& problem_at, const FitData& data, const FitOptions& options,
        const Work& work) {
  if (numbers < 1 || numbers > kMostFitted)
    throw std::invalid_argument("fit: 1 to " + std::to_string(kMostFitted) + " numbers");
  if (options.trials < least_trials_of_fit(numbers))
    throw std::invalid_argument("fit: " + std::to_string(numbers) + " numbers need " +
                                std::to_string(least_trials_of_fit(numbers)) + " trials");
  const std::size_t outcomes = data.outcomes.size();
  if (data.seen.size() != outcomes || data.order.size() != outcomes || !data.run)
    throw std::invalid_argument("fit: data that are not whole");
  const std::int64_t observed =
      std::accumulate(data.seen.begin(), data.seen.end(), std::int64_t{0});
  if (options.trials < kOfEachObserved * kParts * observed)
    throw std::invalid_argument("fit: " + std::to_string(observed) + " observed ones need " +
                                std::to_string(kOfEachObserved * kParts * observed) +
                                " trials or more (--trials)");
  return Fitter(numbers, problem_at, data, options, work).carry_out();
}

}  // namespace gatewalk::lattice
