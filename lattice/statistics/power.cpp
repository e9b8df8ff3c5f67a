// SPDX-License-Identifier: MIT
#include "lattice/statistics/power.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "dynamics/base/random.h"
#include "lattice/statistics/gate_statistics.h"
#include "lattice/statistics/multiple_tests.h"

namespace gatewalk::lattice {
namespace {

using dynamics::Purpose;
using dynamics::Random;

void require_share(double share) {
  if (!(share >= 0.0 && share <= 1.0))
    throw std::invalid_argument("power: a share must lie in [0, 1]");
}

/// Binomial distribution of n trials with success probability p.
class Binomial {
 public:
  Binomial(std::int64_t n, double p) : n_(n), binomial_(static_cast<double>(n), p) {}
  [[nodiscard]] double at_most(std::int64_t k) const {
    if (k < 0) return 0.0;
    return k >= n_ ? 1.0 : boost::math::cdf(binomial_, static_cast<double>(k));
  }
  [[nodiscard]] double at_least(std::int64_t k) const {
    if (k <= 0) return 1.0;
    return k > n_
               ? 0.0
               : boost::math::cdf(boost::math::complement(binomial_, static_cast<double>(k - 1)));
  }

 private:
  std::int64_t n_;
  boost::math::binomial_distribution<> binomial_;
};

/// The smallest number in low, ..., high for which `holds`, which must stay true from there; high +
/// 1: none.
template <class Holds>
std::int64_t first_of(std::int64_t low, std::int64_t high, Holds holds) {
  ++high;
  while (low < high) {
    const std::int64_t middle = low + (high - low) / 2;
    if (holds(middle))
      high = middle;
    else
      low = middle + 1;
  }
  return low;
}

/// The range in which a binomial has nearly all its probability, and the probabilities there. What
/// lies outside is less than 1e-17 in all.
struct Likely {
  std::int64_t first = 0;
  std::vector<double> chance;
  [[nodiscard]] std::int64_t last() const { return first + std::ssize(chance) - 1; }
};
/// From the likeliest count outwards, each probability by its ratio to the one before.
Likely likely(std::int64_t n, double p) {
  constexpr double kSigmas = 9.0;
  const double mean = static_cast<double>(n) * p;
  const double width = kSigmas * std::sqrt(mean * (1.0 - p)) + 40.0;  // Poisson's tails are longer
  Likely l;
  l.first = std::max<std::int64_t>(0, static_cast<std::int64_t>(mean - width));
  const auto last = std::min(n, static_cast<std::int64_t>(mean + width));
  const auto mode = std::min(last, static_cast<std::int64_t>(mean + p));
  l.chance.resize(static_cast<std::size_t>(last - l.first + 1));
  const auto chance = [&](std::int64_t k) -> double& {
    return l.chance[static_cast<std::size_t>(k - l.first)];
  };
  chance(mode) = 1.0;
  const double up = p / (1.0 - p), down = (1.0 - p) / p;
  for (std::int64_t k = mode; k < last; ++k)
    chance(k + 1) = chance(k) * (static_cast<double>(n - k) / static_cast<double>(k + 1) * up);
  for (std::int64_t k = mode; k > l.first; --k)
    chance(k - 1) = chance(k) * (static_cast<double>(k) / static_cast<double>(n - k + 1) * down);
  const double sum = std::accumulate(l.chance.begin(), l.chance.end(), 0.0);
  for (double& c : l.chance) c /= sum;
  return l;
}

/// Sums of likely probabilities, from either end, where the small ones lie.
class Tails {
 public:
  explicit Tails(const Likely& l) : first_(l.first), below_(l.chance), above_(l.chance) {
    std::partial_sum(below_.begin(), below_.end(), below_.begin());
    std::partial_sum(above_.rbegin(), above_.rend(), above_.rbegin());
  }
  [[nodiscard]] double at_most(std::int64_t k) const {
    if (k < first_) return 0.0;
    return k - first_ < std::ssize(below_) ? below_[static_cast<std::size_t>(k - first_)] : 1.0;
  }
  [[nodiscard]] double at_least(std::int64_t k) const {
    if (k <= first_) return 1.0;
    return k - first_ < std::ssize(above_) ? above_[static_cast<std::size_t>(k - first_)] : 0.0;
  }

 private:
  std::int64_t first_;
  std::vector<double> below_, above_;
};

/// Whether p is at most the level. Values that differ only by rounding are equal.
bool is_significant(double p, double level) { return p <= level * (1.0 + 1e-10); }

/// Counts that are significant: up to `low` (-1: none), and from `high` (n + 1: none).
struct Critical {
  std::int64_t low, high;
};
Critical critical_counts(std::int64_t n, double expected, double level) {
  const Tails null(likely(n, expected));
  const double mean = static_cast<double>(n) * expected;
  // Distances that differ only by rounding are equal.
  const double slack = 1e-9 * static_cast<double>(n);
  const auto above = static_cast<std::int64_t>(std::floor(mean)) + 1;
  const auto mirror = [&](std::int64_t k) { return 2.0 * mean - static_cast<double>(k); };
  const std::int64_t high = first_of(above, n, [&](std::int64_t k) {
    const auto other = static_cast<std::int64_t>(std::floor(mirror(k) + slack));
    return is_significant(null.at_least(k) + null.at_most(other), level);
  });
  // `steps` counts down from the mean.
  const auto below = static_cast<std::int64_t>(std::ceil(mean)) - 1;
  const std::int64_t steps = first_of(0, below, [&](std::int64_t s) {
    const std::int64_t k = below - s;
    const auto other = static_cast<std::int64_t>(std::ceil(mirror(k) - slack));
    return is_significant(null.at_most(k) + null.at_least(other), level);
  });
  return {below - steps, high};
}
/// Probability that a count is significant.
double chance_of(const Critical& found, std::int64_t trials, double truth) {
  const Binomial seen(trials, truth);
  return seen.at_most(found.low) + seen.at_least(found.high);
}

/// By the number of successes in two samples of n each, 0, ..., `last` <= n: the largest count of
/// the smaller sample that is significant (-1: none).
std::vector<std::int64_t> significant_counts(std::int64_t n, std::int64_t last, double level) {
  std::vector<std::int64_t> most;
  // The probability that one of the samples has k of `total` successes, and at most k, for the
  // least k that is not yet significant. One further success falls to the same sample with
  // probability (n - k) / (2 n - total), so that k grows by at most one.
  double exactly = 1.0, at_most = 1.0;
  std::int64_t k = 0;
  for (std::int64_t total = 0; total <= last; ++total) {
    if (2 * k < total && is_significant(2.0 * at_most, level)) {
      exactly *= static_cast<double>(n - k) * static_cast<double>(total - k) /
                 (static_cast<double>(k + 1) * static_cast<double>(n - total + k + 1));
      at_most += exactly;
      ++k;
    }
    most.push_back(k - 1);
    const double left = 1.0 / static_cast<double>(2 * n - total);
    at_most -= exactly * static_cast<double>(n - k) * left;
    exactly *= static_cast<double>(n - total + k) * static_cast<double>(total + 1) * left /
               static_cast<double>(total + 1 - k);
  }
  return most;
}

/// The least n for which power(n), and the power of the next `ahead` numbers, is at least `wanted`.
template <class Power, class Ahead>
std::optional<std::int64_t> least_trials(Power power, double wanted, Ahead ahead) {
  std::int64_t high = 1;
  while (power(high) < wanted) {
    if (high == kMostPlanned) return {};
    high = std::min(2 * high, kMostPlanned);
  }
  // Below `low`, a tooth of the sawtooth may reach the goal, but the rising power does not.
  std::int64_t n = high;
  for (std::int64_t low = high / 2; n - low > 1;) {
    const std::int64_t middle = low + (n - low) / 2;
    (power(middle) < wanted ? low : n) = middle;
  }
  for (std::int64_t k = 1; k <= ahead(n); ++k) {
    if (power(n + k) >= wanted) continue;
    n += k + 1;
    k = 0;
    while (power(n) < wanted) ++n;
  }
  return n <= kMostPlanned ? std::optional(n) : std::nullopt;
}

}  // namespace

double power_of_share(std::int64_t trials, double expected, double truth, double level) {
  require_share(expected);
  require_share(truth);
  return chance_of(critical_counts(trials, expected, level), trials, truth);
}

double power_of_two_shares(std::int64_t trials_each, double first, double second, double level) {
  require_share(first);
  require_share(second);
  const Likely a = likely(trials_each, first), b = likely(trials_each, second);
  const Tails seen(b);
  // Of more successes than failures, the failures are counted.
  const std::int64_t least = a.first + b.first, greatest = a.last() + b.last();
  const std::vector<std::int64_t> most = significant_counts(
      trials_each, least > trials_each ? 2 * trials_each - least : std::min(greatest, trials_each),
      level);
  const auto found = [&](std::int64_t x, std::int64_t y) {
    const std::int64_t total = x + y, fewer = std::min(total, 2 * trials_each - total);
    return std::min(x, y) <= most[static_cast<std::size_t>(fewer)] + (total - fewer) / 2;
  };
  // For each x, the counts y that are significant: those up to `low` < x, and from `high` > x.
  // Both grow with x.
  double power = 0.0;
  std::int64_t low = b.first - 1, high = b.first;
  for (std::int64_t x = a.first; x <= a.last(); ++x) {
    while (low + 1 <= b.last() && low + 1 < x && found(x, low + 1)) ++low;
    while (high <= b.last() && !(high > x && found(x, high))) ++high;
    power +=
        a.chance[static_cast<std::size_t>(x - a.first)] * (seen.at_most(low) + seen.at_least(high));
  }
  return power;
}

std::optional<std::int64_t> trials_for_share(double expected, double truth, const PowerGoal& goal) {
  if (expected == truth) return {};
  const double spread = std::max({truth * (1.0 - truth), expected * (1.0 - expected), 1e-4});
  return least_trials(
      [&](std::int64_t n) { return power_of_share(n, expected, truth, goal.level); }, goal.power,
      // About the width of a tooth: the height of a tooth, 1/sqrt(n spread), over the slope of the
      // power.
      [&](std::int64_t n) {
        return 20 + static_cast<std::int64_t>(2.0 * std::sqrt(static_cast<double>(n) / spread));
      });
}

std::optional<std::int64_t> trials_for_two_shares(double first, double second,
                                                  const PowerGoal& goal) {
  if (first == second) return {};
  return least_trials(
      [&](std::int64_t n) { return power_of_two_shares(n, first, second, goal.level); }, goal.power,
      [](std::int64_t) { return 20; });  // totals vary, so the teeth are small
}

SmallestDifference smallest_difference(std::int64_t trials, double expected,
                                       const PowerGoal& goal) {
  require_share(expected);
  const Critical found = critical_counts(trials, expected, goal.level);
  const auto towards = [&](double end) -> std::optional<double> {
    if (chance_of(found, trials, end) < goal.power) return {};
    double unseen = expected, seen = end;
    for (int k = 0; k < 40; ++k) {
      const double middle = 0.5 * (unseen + seen);
      (chance_of(found, trials, middle) < goal.power ? unseen : seen) = middle;
    }
    return std::abs(seen - expected);
  };
  return {towards(1.0), towards(0.0)};
}

// ---- Distributions ----

namespace {

/// As many draws as fit a fixed amount of work: each multiplies with a matrix of gates x gates.
std::int64_t draws_of_power(Eigen::Index outcomes) {
  const std::int64_t gates = std::min<std::int64_t>(outcomes, kMostEnergyGates);
  return std::clamp<std::int64_t>(20'000'000 / (outcomes + gates * gates / 8 + 1), 400, 4000);
}

Outcomes on(const Support& support, const CellProbabilities& prediction) {
  Eigen::VectorXd shares = on_support(prediction, support);
  shares /= shares.sum();
  const Eigen::Index gates = shares.size();
  return {std::move(shares),
          [support](const Eigen::VectorXd& a, const Eigen::VectorXd& b,
                    const Eigen::VectorXd& expected, std::int64_t trials) {
            const Statistics s = statistics(a, b, expected, rare_share(expected, trials), support);
            return std::vector<double>{s.total_variation, s.energy, s.chi_squared};
          },
          draws_of_power(gates)};
}

}  // namespace

Outcomes gate_outcomes(const CellProbabilities& prediction) {
  return on(affordable_support_of(prediction), prediction);
}

std::pair<Outcomes, Eigen::VectorXd> gate_outcomes(const CellProbabilities& first,
                                                   const CellProbabilities& second) {
  const Support support = affordable_support_of(first + second);
  return {on(support, first), on(support, second).shares};
}

Outcomes ending_outcomes(const std::array<double, markov::kEndings>& prediction) {
  Eigen::VectorXd shares(static_cast<Eigen::Index>(prediction.size()));
  std::copy(prediction.begin(), prediction.end(), shares.begin());
  shares /= shares.sum();
  return {
      std::move(shares),
      [](const Eigen::VectorXd& a, const Eigen::VectorXd& b, const Eigen::VectorXd&, std::int64_t) {
        const Eigen::VectorXd apart = (a - b).cwiseAbs();
        return std::vector<double>(apart.begin(), apart.end());
      },
      draws_of_power(static_cast<Eigen::Index>(prediction.size()))};
}

SimulatedTest::SimulatedTest(const Outcomes& expected, std::int64_t trials, double level,
                             std::uint64_t seed, std::optional<double> single_level)
    : outcomes_(expected), trials_(trials), seed_(seed) {
  calibrate(expected.shares, level, single_level);
}

SimulatedTest::SimulatedTest(const Outcomes& first, const Eigen::VectorXd& second,
                             std::int64_t trials_each, double level, std::uint64_t seed)
    : outcomes_(first), second_(second), trials_(trials_each), seed_(seed) {
  calibrate(0.5 * (first.shares + second), level, {});
}

/// Statistics of draws: of one sample from `first` if there is no `second`.
std::vector<SimulatedTest::Row> SimulatedTest::rows(std::uint64_t use, const Eigen::VectorXd& first,
                                                    const Eigen::VectorXd* second) const {
  std::vector<Row> all(static_cast<std::size_t>(outcomes_.draws));
  tbb::parallel_for(std::size_t{0}, all.size(), [&](std::size_t k) {
    Random random(Purpose::comparison, {seed_, use, k});
    const Eigen::VectorXd a = drawn_shares(first, trials_, random);
    if (!second) {
      all[k] = outcomes_.differences(a, outcomes_.shares, outcomes_.shares, trials_);
      return;
    }
    const Eigen::VectorXd b = drawn_shares(*second, trials_, random);
    const Eigen::VectorXd pooled = 0.5 * (a + b);
    // An outcome that neither sample shows makes no difference, and has no sampling noise.
    const Eigen::VectorXd expected =
        (pooled.array() > 0.0).select(pooled, std::numeric_limits<double>::min());
    all[k] = outcomes_.differences(a, b, expected, trials_);
  });
  return all;
}

void SimulatedTest::calibrate(const Eigen::VectorXd& null, double level,
                              std::optional<double> single_level) {
  const std::vector<Row> drawn = rows(kPowerNull, null, second_ ? &null : nullptr);
  const std::size_t statistics = drawn.front().size();
  std::vector<double> all;
  for (const Row& row : drawn) all.insert(all.end(), row.begin(), row.end());
  single_level_ = single_level.value_or(MultipleTests(all, statistics).single_level(level));
  null_.resize(statistics);
  for (std::size_t s = 0; s < statistics; ++s) {
    for (const Row& row : drawn) null_[s].push_back(std::isnan(row[s]) ? -1.0 : row[s]);
    std::sort(null_[s].begin(), null_[s].end());
  }
}

bool SimulatedTest::finds(const Row& row) const {
  for (std::size_t s = 0; s < row.size(); ++s) {
    if (std::isnan(row[s])) continue;
    // Results that differ only by rounding count as equal.
    const auto as_large = null_[s].end() - std::lower_bound(null_[s].begin(), null_[s].end(),
                                                            row[s] - 1e-12 * std::abs(row[s]));
    const double p = static_cast<double>(as_large + 1) / static_cast<double>(null_[s].size() + 1);
    if (p <= single_level_) return true;
  }
  return false;
}

double SimulatedTest::found(const std::vector<Row>& rows) const {
  const auto count =
      std::count_if(rows.begin(), rows.end(), [&](const Row& r) { return finds(r); });
  return static_cast<double>(count) / static_cast<double>(rows.size());
}

double SimulatedTest::power(const Eigen::VectorXd& truth) const {
  return found(rows(kExperiments, truth, nullptr));
}

double SimulatedTest::power() const {
  return found(rows(kExperiments, outcomes_.shares, &second_.value()));
}

namespace {

/// The outcomes of the losing half, and the sum of their shares.
std::pair<std::vector<bool>, double> losing_half(const Eigen::VectorXd& shares) {
  std::vector<Eigen::Index> by_size(static_cast<std::size_t>(shares.size()));
  std::iota(by_size.begin(), by_size.end(), 0);
  std::stable_sort(by_size.begin(), by_size.end(),
                   [&](Eigen::Index a, Eigen::Index b) { return shares[a] > shares[b]; });
  std::vector<bool> loses(by_size.size());
  double losing = 0.0, gaining = 0.0;
  for (const Eigen::Index i : by_size) {
    const bool to_losing = losing <= gaining;
    loses[static_cast<std::size_t>(i)] = to_losing;
    (to_losing ? losing : gaining) += shares[i];
  }
  return {std::move(loses), losing};
}

}  // namespace

std::optional<Eigen::VectorXd> hardest_to_see(const Eigen::VectorXd& shares,
                                              double total_variation) {
  const auto [loses, losing] = losing_half(shares);
  const double gaining = shares.sum() - losing;
  if (!(total_variation <= losing && gaining > 0.0)) return {};
  Eigen::VectorXd other = shares;
  for (Eigen::Index i = 0; i < other.size(); ++i)
    other[i] *= loses[static_cast<std::size_t>(i)] ? 1.0 - total_variation / losing
                                                   : 1.0 + total_variation / gaining;
  return other;
}

namespace {

/// Doubling, then bisection to 1 %: the power is not known better.
template <class Power>
std::optional<std::int64_t> about_least_trials(Power power, double wanted) {
  std::int64_t low = 1, high = 4;
  while (power(high) < wanted) {
    if (high == kMostPlanned) return {};
    low = high;
    high = std::min(2 * high, kMostPlanned);
  }
  while (high - low > 1 && 100 * (high - low) > high) {
    const std::int64_t middle = low + (high - low) / 2;
    (power(middle) < wanted ? low : high) = middle;
  }
  return high;
}

}  // namespace

std::optional<std::int64_t> trials_for_total_variation(const Outcomes& expected,
                                                       double total_variation,
                                                       const PowerGoal& goal, std::uint64_t seed) {
  const auto truth = hardest_to_see(expected.shares, total_variation);
  if (!truth) return {};
  return about_least_trials(
      [&](std::int64_t n) { return SimulatedTest(expected, n, goal.level, seed).power(*truth); },
      goal.power);
}

std::optional<std::int64_t> trials_for_two(const Outcomes& first, const Eigen::VectorXd& second,
                                           const PowerGoal& goal, std::uint64_t seed) {
  if (first.shares == second) return {};
  return about_least_trials(
      [&](std::int64_t n) { return SimulatedTest(first, second, n, goal.level, seed).power(); },
      goal.power);
}

std::optional<double> smallest_total_variation(const Outcomes& expected, std::int64_t trials,
                                               const PowerGoal& goal, std::uint64_t seed,
                                               std::optional<double> single_level) {
  const SimulatedTest test(expected, trials, goal.level, seed, single_level);
  const auto shows = [&](double tv) {
    const auto truth = hardest_to_see(expected.shares, tv);
    return truth && test.power(*truth) >= goal.power;
  };
  double unseen = 0.0, seen = losing_half(expected.shares).second;
  if (!shows(seen)) return {};
  while (seen - unseen > 0.005 * seen) {
    const double middle = 0.5 * (unseen + seen);
    (shows(middle) ? seen : unseen) = middle;
  }
  return seen;
}

}  // namespace gatewalk::lattice
