// SPDX-License-Identifier: MIT
#include "lattice/statistics/independence.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/non_central_chi_squared.hpp>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "dynamics/base/random.h"
#include "lattice/statistics/draws.h"
#include "lattice/statistics/quantiles.h"
#include "markov/dense.h"

namespace gatewalk::lattice {
namespace {

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kPooled = 0, kStrongest = 1, kStateByState = 2, kStatistics = 3;
/// Differences with a smaller variance, of fewer than about five counts, are too rough to be the
/// strongest.
constexpr double kLeastVariance = 5.0;

/// The informative runs, state by state.
struct Strata {
  int labels = 0, outcomes = 0;
  std::vector<std::int32_t> label, outcome, cluster;  // (runs)
  std::vector<std::size_t> ends;                      // (states) index after the last run of each
  /// (states x labels x outcomes) expected under permutation; without clusters
  std::vector<double> expected;

  [[nodiscard]] int cells() const { return labels * outcomes; }
  [[nodiscard]] std::size_t begin(std::size_t s) const { return s == 0 ? 0 : ends[s - 1]; }
  [[nodiscard]] double size(std::size_t s) const { return static_cast<double>(ends[s] - begin(s)); }
};

/// How often each number occurs in [begin, end).
Eigen::VectorXd tally(const std::vector<std::int32_t>& numbers, std::size_t begin, std::size_t end,
                      int count) {
  Eigen::VectorXd n = Eigen::VectorXd::Zero(count);
  for (std::size_t i = begin; i < end; ++i) n[numbers[i]] += 1.0;
  return n;
}

Strata strata_of(std::span<const LabelledRun> runs, const IndependenceOptions& options) {
  Strata strata{options.labels, options.outcomes, {}, {}, {}, {}, {}};
  std::vector<LabelledRun> sorted(runs.begin(), runs.end());
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const LabelledRun& a, const LabelledRun& b) { return a.state < b.state; });
  for (const LabelledRun& r : sorted) {
    if (r.state < 0 || r.label < 0 || r.outcome < 0)
      throw std::invalid_argument("independence: states, labels and outcomes count from 0");
    if (options.clusters > 0 && (r.cluster < 0 || r.cluster >= options.clusters))
      throw std::invalid_argument("independence: there is no such cluster");
    strata.labels = std::max(strata.labels, r.label + 1);
    strata.outcomes = std::max(strata.outcomes, r.outcome + 1);
    if (options.clusters == 0 &&
        (std::max(strata.labels, strata.outcomes) > 64 || strata.cells() > 64))
      throw std::invalid_argument("independence: more than 64 labels times outcomes");
  }
  for (auto from = sorted.begin(); from != sorted.end();) {
    const auto to = std::find_if(from, sorted.end(),
                                 [&](const LabelledRun& r) { return r.state != from->state; });
    const bool tells =
        std::any_of(from, to, [&](const LabelledRun& r) { return r.label != from->label; }) &&
        std::any_of(from, to, [&](const LabelledRun& r) { return r.outcome != from->outcome; });
    for (auto r = from; tells && r != to; ++r) {
      strata.label.push_back(r->label);
      strata.outcome.push_back(r->outcome);
      strata.cluster.push_back(r->cluster);
    }
    if (tells) strata.ends.push_back(strata.label.size());
    from = to;
  }
  for (std::size_t s = 0; options.clusters == 0 && s < strata.ends.size(); ++s) {
    const auto l = tally(strata.label, strata.begin(s), strata.ends[s], strata.labels);
    const auto o = tally(strata.outcome, strata.begin(s), strata.ends[s], strata.outcomes);
    for (int i = 0; i < strata.labels; ++i)
      for (int j = 0; j < strata.outcomes; ++j)
        strata.expected.push_back(l[i] * o[j] / strata.size(s));
  }
  return strata;
}

/// The null distribution of the pooled differences.
struct Pooled {
  Eigen::MatrixXd covariance;  // (cells x cells)
  Eigen::VectorXd deviation;   // (cells) 0: too few counts
  Eigen::MatrixXd whitening;   // (degrees x cells) makes differences standard normal
  Eigen::MatrixXd planted;     // (labels x outcomes) effect of a memory of total variation 1

  [[nodiscard]] int degrees() const { return static_cast<int>(whitening.rows()); }
  [[nodiscard]] double noncentrality() const {  // of that memory
    return (whitening * flat(planted)).squaredNorm();
  }
  static Eigen::VectorXd flat(const Eigen::MatrixXd& m) {
    const Eigen::MatrixXd t = m.transpose();  // row by row
    return Eigen::Map<const Eigen::VectorXd>(t.data(), t.size());
  }
};

/// +1/2 or -1/2 for each label: splits the labels into halves with runs as equal as possible.
Eigen::VectorXd halves_of(const Eigen::VectorXd& label_runs) {
  std::vector<int> order(static_cast<std::size_t>(label_runs.size()));
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return label_runs[a] > label_runs[b]; });
  Eigen::VectorXd side = Eigen::VectorXd::Zero(label_runs.size());
  double balance = 0.0;
  for (const int l : order) {
    side[l] = balance > 0.0 ? -0.5 : 0.5;
    balance += side[l] * label_runs[l];
  }
  return side;
}

/// Whitening matrix V^(-1/2) on the space where V has any variance. Works on correlations, so that
/// rare counts are not taken for zero.
Eigen::MatrixXd whitening_of(const Eigen::MatrixXd& v) {
  const Eigen::VectorXd scale =
      v.diagonal().unaryExpr([](double x) { return x > 0.0 ? 1.0 / std::sqrt(x) : 0.0; });
  const auto [values, vectors] =
      markov::symmetric_eigen(scale.asDiagonal() * v * scale.asDiagonal());
  constexpr double kNone = 1e-9;  // rounding leaves about 1e-14 of a correlation
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < v.rows(); ++i)
    if (values[i] > kNone) kept.push_back(i);
  Eigen::MatrixXd w(static_cast<Eigen::Index>(kept.size()), v.rows());
  for (std::size_t i = 0; i < kept.size(); ++i)
    w.row(static_cast<Eigen::Index>(i)) =
        vectors.col(kept[i]).cwiseProduct(scale).transpose() / std::sqrt(values[kept[i]]);
  return w;
}

Pooled pooled_of(const Strata& strata) {
  const int cells = strata.cells(), outcomes = strata.outcomes;
  Pooled pooled{Eigen::MatrixXd::Zero(cells, cells), {}, {}, {}};
  const auto all = strata.label.size();
  const Eigen::VectorXd side = halves_of(tally(strata.label, 0, all, strata.labels));
  Eigen::VectorXd shifted = Eigen::VectorXd::Zero(strata.labels);  // runs, by label
  for (std::size_t s = 0; s < strata.ends.size(); ++s) {
    const double n = strata.size(s);
    const auto l = tally(strata.label, strata.begin(s), strata.ends[s], strata.labels);
    const auto o = tally(strata.outcome, strata.begin(s), strata.ends[s], outcomes);
    // Covariance of the counts of a table with these margins: Cov = (n diag(l) - l l') x (n diag(o)
    // - o o') / (n^2 (n - 1)).
    const Eigen::MatrixXd of_labels = (n * Eigen::MatrixXd(l.asDiagonal()) - l * l.transpose()) / n;
    const Eigen::MatrixXd of_outcomes =
        (n * Eigen::MatrixXd(o.asDiagonal()) - o * o.transpose()) / (n * (n - 1.0));
    for (int i = 0; i < strata.labels; ++i)
      for (int k = 0; k < strata.labels; ++k)
        pooled.covariance.block(i * outcomes, k * outcomes, outcomes, outcomes) +=
            of_labels(i, k) * of_outcomes;
    shifted += of_labels * side;
  }
  pooled.whitening = whitening_of(pooled.covariance);
  pooled.deviation = pooled.covariance.diagonal().unaryExpr(
      [](double x) { return x < kLeastVariance ? 0.0 : std::sqrt(x); });

  Eigen::VectorXd common = tally(strata.outcome, 0, all, outcomes), direction = 0.0 * common;
  Eigen::Index first = 0, second = 0;
  common.maxCoeff(&first);
  common[first] = -1.0;
  common.maxCoeff(&second);
  direction[first] = 1.0;
  direction[second] = -1.0;
  pooled.planted = shifted * direction.transpose();
  return pooled;
}

struct PooledDifferences {
  Eigen::VectorXd pooled;  // (cells)
  double squares = 0.0;    // state by state, relative to its runs
};

PooledDifferences differences(const Strata& strata, const std::vector<std::int32_t>& outcome) {
  const int cells = strata.cells();
  PooledDifferences d{Eigen::VectorXd::Zero(cells)};
  Eigen::VectorXd table(cells);
  for (std::size_t s = 0; s < strata.ends.size(); ++s) {
    table = -Eigen::Map<const Eigen::VectorXd>(
        &strata.expected[s * static_cast<std::size_t>(cells)], cells);
    for (std::size_t i = strata.begin(s); i < strata.ends[s]; ++i)
      table[strata.label[i] * strata.outcomes + outcome[i]] += 1.0;
    d.pooled += table;
    d.squares += table.squaredNorm() / strata.size(s);
  }
  return d;
}

/// Differences relative to their standard deviations, without those that have none.
struct Sizes {
  double squares = 0.0;  // sum over all
  double largest = 0.0;
  int strongest = -1;  // index of the largest; -1: no difference has a deviation

  Sizes(const Eigen::VectorXd& d, const Eigen::VectorXd& deviation) {
    for (Eigen::Index i = 0; i < d.size(); ++i) {
      if (deviation[i] == 0.0) continue;
      const double size = std::abs(d[i]) / deviation[i];
      squares += size * size;
      if (strongest >= 0 && size <= largest) continue;
      strongest = static_cast<int>(i);
      largest = size;
    }
  }
};

/// The statistics of every draw of the null, and of the observed data in the last row.
std::vector<double> all_statistics(const Strata& strata, const Pooled& pooled,
                                   const IndependenceOptions& options) {
  const auto draws = static_cast<std::size_t>(options.null_draws);
  std::vector<double> all((draws + 1) * kStatistics);
  tbb::parallel_for(std::size_t{0}, draws + 1, [&](std::size_t k) {
    std::vector<std::int32_t> outcome = strata.outcome;
    dynamics::Random random(dynamics::Purpose::memory, {options.seed, options.number, k});
    for (std::size_t s = 0; k < draws && s < strata.ends.size(); ++s)
      for (std::size_t i = strata.begin(s); i + 1 < strata.ends[s]; ++i)
        std::swap(outcome[i], outcome[i + static_cast<std::size_t>(random.below(
                                              static_cast<std::int64_t>(strata.ends[s] - i)))]);
    const PooledDifferences d = differences(strata, outcome);
    double* const row = &all[k * kStatistics];
    row[kPooled] = (pooled.whitening * d.pooled).squaredNorm();
    row[kStrongest] = Sizes(d.pooled, pooled.deviation).largest;
    row[kStateByState] = d.squares;
  });
  return all;
}

/// The noncentrality at which the distribution has this share up to x; 0 if the central one has no
/// more.
double noncentrality_at(int degrees, double x, double share) {
  const boost::math::chi_squared central(degrees);
  if (x <= 0.0 || boost::math::cdf(central, x) <= share) return 0.0;
  return boost::math::non_central_chi_squared::find_non_centrality(degrees, x, share);
}

/// Fills in the size of the memory, and the size that the test would detect.
void measure(Independence& result, const Pooled& pooled, double single_level) {
  const double unit = pooled.noncentrality();
  const auto memory = [&](double noncentrality) {
    return std::sqrt(std::max(0.0, noncentrality) / unit);
  };
  const double q = result.pooled.seen;
  const int degrees = result.degrees;
  result.memory = memory(q - degrees);
  result.memory_low = memory(noncentrality_at(degrees, q, 0.975));
  result.memory_high = memory(noncentrality_at(degrees, q, 0.025));
  result.seen_at_90 = std::numeric_limits<double>::infinity();
  if (single_level <= 0.0) return;
  const double bar = chi_squared_exceeded(degrees, single_level);
  const double least = memory(noncentrality_at(degrees, bar, 0.1));
  if (least <= 1.0) result.seen_at_90 = least;  // no total variation is more
}

/// Fills in label and outcome of the largest difference. `label_runs`: runs of each label.
void name_strongest(Independence& result, const Strata& strata, const Eigen::VectorXd& seen,
                    const Eigen::VectorXd& deviation, const Eigen::VectorXd& label_runs) {
  const int at = Sizes(seen, deviation).strongest;
  if (at < 0) return;
  result.label = at / strata.outcomes;
  result.outcome = at % strata.outcomes;
  result.more = seen[at] / label_runs[result.label];
}

/// Test of independent runs, by permuting outcomes.
void test_by_dealing(Independence& result, const Strata& strata,
                     const IndependenceOptions& options) {
  const Pooled pooled = pooled_of(strata);
  const MultipleTests judged(all_statistics(strata, pooled, options), kStatistics);
  result.pooled = judged.tests[kPooled];
  result.strongest = judged.tests[kStrongest];
  result.state_by_state = judged.tests[kStateByState];
  result.p = judged.p;
  result.degrees = pooled.degrees();
  result.p_chi_squared = boost::math::cdf(
      boost::math::complement(boost::math::chi_squared(result.degrees), result.pooled.seen));
  name_strongest(result, strata, differences(strata, strata.outcome).pooled, pooled.deviation,
                 tally(strata.label, 0, strata.label.size(), strata.labels));
  measure(result, pooled, judged.single_level(options.level));
}

/// Shares of each number in [begin, end).
Eigen::VectorXd shares(const std::vector<std::int32_t>& numbers, std::size_t begin, std::size_t end,
                       int count) {
  Eigen::VectorXd share = Eigen::VectorXd::Zero(count);
  for (std::size_t i = begin; i < end; ++i)
    share[numbers[i]] += 1.0 / static_cast<double>(end - begin);
  return share;
}

/// Test of clustered runs, by random signs of each cluster's sum of differences.
void test_by_signs(Independence& result, const Strata& strata, const IndependenceOptions& options) {
  // (cells x clusters) Observed minus expected counts. `drawn` restores the variance that a state's
  // few runs lose because their own mean is subtracted.
  Eigen::MatrixXd by_cluster = Eigen::MatrixXd::Zero(strata.cells(), options.clusters),
                  drawn = by_cluster;
  Eigen::VectorXd label_runs = Eigen::VectorXd::Zero(strata.labels);
  for (std::size_t s = 0; s < strata.ends.size(); ++s) {
    const double n = strata.size(s);
    const auto l = shares(strata.label, strata.begin(s), strata.ends[s], strata.labels);
    const auto o = shares(strata.outcome, strata.begin(s), strata.ends[s], strata.outcomes);
    label_runs += n * l;
    for (std::size_t r = strata.begin(s); r < strata.ends[s]; ++r)
      for (int i = 0; i < strata.labels; ++i)
        for (int j = 0; j < strata.outcomes; ++j) {
          const double part = ((strata.label[r] == i) - l[i]) * ((strata.outcome[r] == j) - o[j]);
          by_cluster(i * strata.outcomes + j, strata.cluster[r]) += part;
          drawn(i * strata.outcomes + j, strata.cluster[r]) += part * std::sqrt(n / (n - 1.0));
        }
  }
  const Eigen::VectorXd deviation = drawn.rowwise().norm(), seen = by_cluster.rowwise().sum();
  std::vector<double> all;
  const auto add = [&](const Eigen::VectorXd& d) {
    const Sizes sizes(d, deviation);
    all.insert(all.end(), {sizes.squares, sizes.largest});
  };
  for (std::int64_t k = 0; k < options.null_draws; ++k) {
    dynamics::Random random(dynamics::Purpose::memory,
                            {options.seed, options.number, static_cast<std::uint64_t>(k)});
    add(drawn * random_signs(options.clusters, random));
  }
  add(seen);
  const MultipleTests judged(all, 2);
  result.pooled = judged.tests[0];
  result.strongest = judged.tests[1];
  result.p = judged.p;
  name_strongest(result, strata, seen, deviation, label_runs);
}

}  // namespace

Independence test_independence(std::span<const LabelledRun> runs,
                               const IndependenceOptions& options) {
  if (options.null_draws < 1)
    throw std::invalid_argument("independence: null_draws must be at least 1");
  if (!(options.level > 0.0 && options.level < 1.0))
    throw std::invalid_argument("independence: level must lie between 0 and 1");
  const Strata strata = strata_of(runs, options);
  Independence result;
  result.runs = std::ssize(strata.label);
  result.states = std::ssize(strata.ends);
  result.null_draws = options.null_draws;
  result.memory = result.memory_low = result.memory_high = kNoNumber;
  result.seen_at_90 = std::numeric_limits<double>::infinity();
  if (result.states == 0) return result;

  (options.clusters > 0 ? test_by_signs : test_by_dealing)(result, strata, options);
  return result;
}

}  // namespace gatewalk::lattice
