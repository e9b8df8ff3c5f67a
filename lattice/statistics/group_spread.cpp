// SPDX-License-Identifier: MIT
#include "lattice/statistics/group_spread.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "dynamics/base/random.h"
#include "dynamics/base/share.h"

namespace gatewalk::lattice {
namespace {

using dynamics::Random;

/// Number of draws behind a quantile; fewer for large fields.
int draws_for(Eigen::Index numbers) {
  return static_cast<int>(
      std::clamp<Eigen::Index>(40'000'000 / std::max<Eigen::Index>(1, numbers), 60, 400));
}

double quantile(std::vector<double> values, double level) {
  const auto at =
      values.begin() +
      static_cast<std::ptrdiff_t>(std::ceil(level * static_cast<double>(values.size()))) - 1;
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// Error bounds from errors that are drawn.
Error95 error_of_draws(int draws, const CellProbabilities& p,
                       const std::function<CellProbabilities(int)>& draw) {
  std::vector<double> distances, correlations, rmses;
  for (int k = 0; k < draws; ++k) {
    const CellProbabilities other = draw(k);
    distances.push_back(total_variation(other, p));
    const double correlation = corrcoef(other, p);
    if (std::isfinite(correlation)) correlations.push_back(-correlation);
    rmses.push_back(rmse_per_100(other, p));
  }
  const double least =
      correlations.size() == distances.size() ? -quantile(correlations, 0.95) : std::nan("");
  return {quantile(distances, 0.95), least, quantile(rmses, 0.95)};
}

/// The largest share that this number of trials misses completely with probability 5 %.
double unseen_95(std::int64_t trials) {
  return 1.0 - std::pow(0.05, 1.0 / static_cast<double>(std::max<std::int64_t>(1, trials)));
}

/// Raises error bounds by a share that no trial may have shown. A share that moves from one gate to
/// another makes the largest RMSE, and turns the shares' deviation from their mean by the largest
/// angle.
void count_unseen(Error95& e, const CellProbabilities& p, std::int64_t trials) {
  const double unseen = unseen_95(trials), gates = static_cast<double>(p.size());
  const double rmse = 100.0 * unseen * std::sqrt(2.0 / gates);
  e.total_variation = std::max(e.total_variation, unseen);
  e.rmse_per_100 = std::max(e.rmse_per_100, rmse);
  const double spread = rmse_per_100(p, CellProbabilities::Constant(p.rows(), p.cols(), p.mean()));
  e.corrcoef = rmse < spread
                   ? std::min(e.corrcoef, std::sqrt((1.0 - rmse / spread) * (1.0 + rmse / spread)))
                   : std::nan("");
}

// Second words of the streams: "group", "assume".
constexpr std::uint64_t kGroupDraws = 0x67726f7570, kDifferenceDraws = 0x617373756d65;

/// 97.5 % quantile of Student's t with kTrialGroups - 1 = 7 degrees of freedom.
constexpr double kQuantile = 2.3646;
static_assert(kTrialGroups == 8);

struct Spread {
  double mean = 0.0, error = 0.0;  // the standard error of the mean
};
Spread spread_of(const std::vector<double>& groups) {
  const auto n = static_cast<double>(groups.size());
  double mean = 0.0, squares = 0.0;
  for (const double g : groups) mean += g / n;
  for (const double g : groups) squares += (g - mean) * (g - mean);
  return {mean, std::sqrt(squares / (n * (n - 1.0)))};
}

/// Half the interval of a share up to 1/2, relative to the share; 0 if no group has any.
double relative_half_width(double whole, const std::vector<double>& groups, double bias_left) {
  const Spread plain = spread_of(groups);
  if (!(plain.mean > 0.0)) return 0.0;
  std::vector<double> roots;
  for (const double g : groups) roots.push_back(std::sqrt(std::max(0.0, g)));
  // Small shares are skewed: eight of them often look more alike than they are. Their square roots
  // show the spread.
  const Spread root = spread_of(roots);
  const double error = std::max(plain.error / plain.mean, 2.0 * root.error / root.mean);
  const double bias = std::abs(plain.mean - whole) / std::max(plain.mean, whole);
  return kQuantile * error + bias_left * bias;
}

/// The effective number of independent errors among the errors of all gates. A sum of squares of
/// normal errors with covariance C varies as one of r = (tr C)^2 / tr C^2 independent errors
/// (Satterthwaite). With few groups, many errors look like fewer.
struct IndependentErrors {
  double in_groups = 1.0;  // r of the groups' covariance
  double in_truth = 1.0;   // r of the true covariance, estimated

  /// `deviations`: (gates x groups), from the mean of the groups.
  explicit IndependentErrors(const Eigen::MatrixXd& deviations) {
    const double n = static_cast<double>(deviations.cols()) - 1.0;
    double trace = 0.0, squares = 0.0;
    for (Eigen::Index a = 0; a < deviations.cols(); ++a)
      for (Eigen::Index b = 0; b < deviations.cols(); ++b) {
        const double product = (deviations.col(a).array() * deviations.col(b).array()).sum() / n;
        squares += product * product;
        if (a == b) trace += product;
      }
    if (!(trace > 0.0)) return;
    constexpr double kMost = 1000.0;  // practically infinitely many
    in_groups = trace * trace / squares;
    // The groups' covariance S has E (tr S)^2 = (tr C)^2 + 2 tr C^2 / n and
    // E tr S^2 = (1 + 1 / n) tr C^2 + (tr C)^2 / n; solved for C.
    const double by = n / ((n - 1.0) * (n + 2.0)), of_truth = by * (n * squares - trace * trace),
                 trace_of_truth = by * ((n + 1.0) * trace * trace - 2.0 * squares);
    in_truth = of_truth > 0.0 ? std::clamp(trace_of_truth / of_truth, 1.0, kMost) : kMost;
  }
};

/// A chi-squared draw by the approximation of Wilson and Hilferty, good to a few per cent from 7
/// degrees of freedom on.
double chi_squared(double freedom, Random& random) {
  const double part = 2.0 / (9.0 * freedom);
  const double root = 1.0 - part + std::sqrt(part) * random.normal();
  return freedom * std::max(1e-3, root * root * root);
}

/// Weights of the groups' deviations for one drawn error, in units of their standard error.
std::vector<double> drawn_weights(const IndependentErrors& independent, std::size_t groups,
                                  Random& random) {
  std::vector<double> weights;
  double mean = 0.0, squares = 0.0;
  for (std::size_t g = 0; g < groups; ++g) {
    weights.push_back(random.normal());
    mean += weights.back() / static_cast<double>(groups);
  }
  for (double& w : weights) {
    w -= mean;
    squares += w * w;
  }
  const double n = static_cast<double>(groups) - 1.0;
  // On a sphere, the sum of squares has the relative variance (1 + 2 / in_groups) / (1 + 2 / n) -
  // 1. The rest up to 2 / in_truth is drawn, and so is the factor by which the groups may show too
  // little.
  const double more =
      (1.0 + 2.0 / independent.in_truth) * (1.0 + 2.0 / n) / (1.0 + 2.0 / independent.in_groups) -
      1.0;
  const double size = more > 1e-3 ? chi_squared(2.0 / more, random) * more / 2.0 : 1.0;
  const double freedom = n * independent.in_truth;
  const double times = std::sqrt(n / squares * size * freedom / chi_squared(freedom, random));
  for (double& w : weights) w *= times;
  return weights;
}

Mean95 without_interval(double whole) {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  return {whole, {kUnknown, kUnknown}};
}

}  // namespace

// The states of a group are eight times as large as those of the whole prediction, which itself has
// a bias of the same kind. The factor extrapolates from the groups' offset to the whole's bias: a
// bias that grows with the power 0.4 of the states' size gives 1 / (8^0.4 - 1) = 0.77. (The power
// is 2/3 where outcomes vary smoothly with the entry, less where they jump.)
double bias_left(int coordinates) {
  if (coordinates <= 3) return kBiasLeft;
  return 1.0 / (std::pow(1.0 + 1.0 / kBiasLeft, 3.0 / coordinates) - 1.0);
}

Mean95 mean_95(double whole, const std::vector<double>& groups) {
  if (!groups.empty()) {
    const double half =
        half_width_95(groups) + kBiasLeft * std::abs(spread_of(groups).mean - whole);
    if (half > kShareRounding * std::abs(whole)) return {whole, {whole - half, whole + half}};
  }
  return without_interval(whole);
}

Mean95OfRuns mean_95(double whole, const std::vector<double>& groups, const RunsBehind& runs) {
  if (groups.empty()) return {without_interval(whole)};
  const auto few = [&](double n, const char* where, double least) {
    const auto whole_number = [](double x) { return std::to_string(static_cast<long>(x)); };
    return Mean95OfRuns{without_interval(whole), whole_number(n) +
                                                     (n >= 1.0 && n < 2.0 ? " run" : " runs") +
                                                     where + ", fewer than " + whole_number(least)};
  };
  const double in_group = *std::min_element(runs.groups.begin(), runs.groups.end());
  if (runs.all < kLeastRunsOfMean) return few(runs.all, "", kLeastRunsOfMean);
  if (in_group < kLeastRunsOfGroup)
    return few(in_group, " in a group of the trials", kLeastRunsOfGroup);
  Mean95OfRuns mean{mean_95(whole, groups)};
  if (std::isnan(mean.interval[0]) && !std::isnan(whole))
    mean.why_none = "it is the same in all eight groups of trials";
  return mean;
}

double half_width_95(const std::vector<double>& groups) {
  return kQuantile * spread_of(groups).error;
}

std::array<double, 2> share_95(double whole, const std::vector<double>& groups,
                               const Evidence& from, double besides) {
  if (whole > 0.5) {
    std::vector<double> others;
    for (const double g : groups) others.push_back(1.0 - g);
    const auto [low, high] = share_95(1.0 - whole, others, from, besides);
    return {1.0 - high, 1.0 - low};
  }
  if (whole <= kShareRounding) return dynamics::interval_of_share(0.0, from.trials);
  const double error =
      std::hypot(relative_half_width(whole, groups, from.bias_left), besides / whole) /
      dynamics::kNormal95;
  const double like = error > 0.0 ? (1.0 - whole) / (whole * error * error) : from.trials;
  return dynamics::interval_of_share(whole, std::min(like, from.gate_runs));
}

namespace {

std::array<double, 2> interval_of_drawn(std::vector<double> drawn, double share,
                                        const Evidence& from) {
  std::sort(drawn.begin(), drawn.end());
  const std::size_t beyond = (drawn.size() + 1) / 40;  // 2.5 % on each side
  const std::size_t at = beyond > 0 ? beyond - 1 : 0;
  std::array<double, 2> middle{drawn[at], drawn[drawn.size() - 1 - at]};
  if (middle[1] - middle[0] <= kShareRounding)
    return dynamics::interval_of_share(share, from.trials);
  const bool possible = share > 0.0 && share < 1.0;
  if (possible && !(middle[0] < share && share < middle[1])) {
    double squares = 0.0;
    for (const double d : drawn) squares += (d - share) * (d - share);
    const double like = share * (1.0 - share) * static_cast<double>(drawn.size()) / squares;
    middle = dynamics::interval_of_share(share, like);
  }
  if (!(from.gate_runs > 0.0) || !possible) return middle;
  const auto [low, high] = dynamics::interval_of_share(share, from.gate_runs);
  return {std::min(middle[0], low), std::max(middle[1], high)};
}

}  // namespace

std::array<double, 2> resampled_95(std::vector<double> drawn, double own, const Evidence& from) {
  const double share = std::clamp(own, 0.0, 1.0);
  const auto [low, high] = interval_of_drawn(std::move(drawn), share, from);
  return {std::max(0.0, std::min(low, share - from.hidden)),
          std::min(1.0, std::max(high, share + from.hidden))};
}

std::array<double, 2> with_unfinished(const std::array<double, 2>& interval, double share,
                                      double unfinished, double rounding) {
  constexpr double kNotShown = 1e-9;
  if (!(unfinished + rounding > kNotShown)) return interval;
  const auto [low, high] = std::isnan(interval[0]) ? std::array{share, share} : interval;
  return {std::max(0.0, low - rounding), std::min(1.0, high + unfinished + rounding)};
}

Evidence evidence_of(const markov::FinalDistribution& whole, std::int64_t trials) {
  const auto n = static_cast<double>(trials);
  return {n, n * std::max(1.0, whole.mean_steps)};
}

GroupSpread::GroupSpread(const markov::FinalDistribution& whole,
                         const std::vector<markov::FinalDistribution>& groups, int coordinates)
    : whole_(whole), groups_(groups), bias_left_(bias_left(coordinates)) {
  if (groups.size() < 2) throw std::invalid_argument("group spread: needs two groups at least");
  for (const auto& g : groups)
    if (g.final_cells.rows() != whole.final_cells.rows() ||
        g.final_cells.cols() != whole.final_cells.cols())
      throw std::invalid_argument("group spread: predictions of different fields");
}

Error95 GroupSpread::error(std::int64_t trials, std::uint64_t seed) const {
  const auto n = static_cast<double>(groups_.size());
  CellProbabilities mean =
      CellProbabilities::Zero(whole_.final_cells.rows(), whole_.final_cells.cols());
  for (const auto& g : groups_) mean += g.final_cells / n;
  const CellProbabilities biased = whole_.final_cells + bias_left_ * (mean - whole_.final_cells);
  const double scale = 1.0 / std::sqrt(n * (n - 1.0));
  Eigen::MatrixXd deviations(mean.size(), std::ssize(groups_));
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    const CellProbabilities deviation = groups_[g].final_cells - mean;
    deviations.col(static_cast<Eigen::Index>(g)) =
        Eigen::Map<const Eigen::VectorXd>(deviation.data(), deviation.size());
  }
  const IndependentErrors independent(deviations);
  Error95 e =
      error_of_draws(draws_for(mean.size() * std::ssize(groups_)), whole_.final_cells, [&](int k) {
        Random random(dynamics::Purpose::resampling,
                      {seed, kGroupDraws, static_cast<std::uint64_t>(k)});
        CellProbabilities drawn = biased;
        const std::vector<double> weights = drawn_weights(independent, groups_.size(), random);
        for (std::size_t g = 0; g < groups_.size(); ++g)
          drawn += scale * weights[g] * (groups_[g].final_cells - mean);
        return drawn;
      });
  count_unseen(e, whole_.final_cells, trials);
  e.total_variation = std::min(1.0, e.total_variation + whole_.unsampled() + whole_.remainder);
  return e;
}

namespace {

/// The interval of value(prediction), by share_95.
template <class Value>
std::array<double, 2> interval_of(const markov::FinalDistribution& whole,
                                  const std::vector<markov::FinalDistribution>& groups,
                                  std::int64_t trials, double bias_left, Value value) {
  std::vector<double> values;
  for (const auto& g : groups) values.push_back(value(g));
  Evidence from = evidence_of(whole, trials);
  from.bias_left = bias_left;
  return share_95(value(whole), values, from);
}

}  // namespace

std::array<CellProbabilities, 2> GroupSpread::gates_95(std::int64_t trials) const {
  std::array<CellProbabilities, 2> range{whole_.final_cells, whole_.final_cells};
  // Computed once: in a large field most gates have a share of 0.
  const auto never = dynamics::interval_of_share(0.0, static_cast<double>(trials));
  for (Eigen::Index i = 0; i < whole_.final_cells.size(); ++i) {
    const auto share = [i](const markov::FinalDistribution& d) { return d.final_cells.data()[i]; };
    const auto interval = share(whole_) <= kShareRounding
                              ? never
                              : interval_of(whole_, groups_, trials, bias_left_, share);
    for (std::size_t side = 0; side < 2; ++side) range[side].data()[i] = interval[side];
  }
  return range;
}

EndingShares GroupSpread::endings_95(std::int64_t trials) const {
  EndingShares shares(whole_.endings);
  for (std::size_t e = 0; e < markov::kEndings; ++e)
    shares.interval[e] =
        interval_of(whole_, groups_, trials, bias_left_,
                    [e](const markov::FinalDistribution& d) { return d.endings[e]; });
  return shares;
}

GroupDifference group_difference(const GroupedMaps& first, const GroupedMaps& second,
                                 int coordinates, std::uint64_t seed, std::uint64_t number) {
  const auto n = std::ssize(second.groups);
  const CellProbabilities difference = second.whole - first.whole;
  // Most gates of a large field are out of reach.
  CellProbabilities seen = first.whole.max(second.whole);
  for (std::size_t g = 0; g < second.groups.size(); ++g)
    seen = seen.max(first.groups[g]).max(second.groups[g]);
  std::vector<Eigen::Index> reached;
  for (Eigen::Index i = 0; i < seen.size(); ++i)
    if (seen.data()[i] > 0.0) reached.push_back(i);
  const auto at = [&](const CellProbabilities& map) {
    Eigen::VectorXd values(std::ssize(reached));
    for (Eigen::Index i = 0; i < values.size(); ++i)
      values[i] = map.data()[reached[static_cast<std::size_t>(i)]];
    return values;
  };
  const Eigen::VectorXd whole = at(difference);
  Eigen::MatrixXd firsts(whole.size(), n), seconds(whole.size(), n);
  for (Eigen::Index g = 0; g < n; ++g) {
    firsts.col(g) = at(first.groups[static_cast<std::size_t>(g)]);
    seconds.col(g) = at(second.groups[static_cast<std::size_t>(g)]);
  }
  const double scale = 1.0 / std::sqrt(static_cast<double>(n) * static_cast<double>(n - 1));
  Eigen::MatrixXd deviations = seconds - firsts;
  const Eigen::VectorXd mean = deviations.rowwise().mean();
  deviations.colwise() -= mean;
  const auto tv = [](const auto& d) { return 0.5 * d.template lpNorm<1>(); };

  GroupDifference d{.total_variation = tv(whole)};
  if (d.total_variation <= kShareRounding) return d;
  // With up to three coordinates both predictions have most of their bias in common. (Without any
  // allowance, 1 % of right chains had p below 0.01 too.)
  const double part = coordinates <= 3 ? 0.5 : 1.0;
  const double bias = part * bias_left(coordinates) *
                      std::min(tv(seconds.rowwise().mean() - at(second.whole)), tv(mean - whole));
  // A difference that is small beside the first prediction's own sampling error does not matter,
  // even where the groups show it exactly. Bodies about which one prediction knows nothing may end
  // anywhere.
  constexpr double kSmall = 0.25;
  firsts.colwise() -= firsts.rowwise().mean().eval();
  const double own = 0.5 * scale * firsts.rowwise().norm().sum();
  const double allowed =
      std::max(bias, kSmall * own) + std::abs(second.unsampled - first.unsampled);
  const Eigen::VectorXd biased =
      whole * (allowed < d.total_variation ? allowed / d.total_variation : 1.0);
  const IndependentErrors independent(deviations);
  constexpr double kMostProducts = 4e8;
  const int draws = static_cast<int>(
      std::clamp(kMostProducts / static_cast<double>(std::max<Eigen::Index>(1, deviations.size())),
                 999.0, 1999.0));
  const bool any = deviations.squaredNorm() > 0.0;
  std::vector<double> drawn;
  int as_large = 1;
  for (int k = 0; k < draws; ++k) {
    Random random(dynamics::Purpose::resampling,
                  {seed, kDifferenceDraws + number, static_cast<std::uint64_t>(k)});
    Eigen::VectorXd one = biased;
    if (any) {
      const std::vector<double> weights =
          drawn_weights(independent, static_cast<std::size_t>(n), random);
      one += scale * deviations * Eigen::Map<const Eigen::VectorXd>(weights.data(), n);
    }
    drawn.push_back(tv(one));
    as_large += drawn.back() >= d.total_variation;
  }
  d.chance_95 = quantile(std::move(drawn), 0.95);
  d.p = static_cast<double>(as_large) / (draws + 1);
  return d;
}

Error95 error_of_shares(const CellCounts& counts, std::uint64_t seed) {
  const CellProbabilities p = shares(counts);
  const std::int64_t trials = counts.sum();
  Error95 e = error_of_draws(draws_for(p.size()), p, [&](int k) {
    return shares(sampled(p, trials, seed ^ kGroupDraws, static_cast<std::uint64_t>(k)));
  });
  count_unseen(e, p, trials);
  return e;
}

}  // namespace gatewalk::lattice
