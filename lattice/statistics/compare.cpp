// SPDX-License-Identifier: MIT
#include "lattice/statistics/compare.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include "dynamics/base/random.h"
#include "lattice/statistics/draws.h"
#include "lattice/statistics/gate_statistics.h"
#include "lattice/statistics/log_gamma.h"
#include "lattice/statistics/multiple_tests.h"
#include "markov/predict.h"

namespace gatewalk::lattice {
namespace {

using dynamics::Purpose;
using dynamics::Random;

void require_same_shape(Eigen::Index rows_a, Eigen::Index cols_a, Eigen::Index rows_b,
                        Eigen::Index cols_b) {
  if (rows_a != rows_b || cols_a != cols_b)
    throw std::invalid_argument("compare: the two fields differ in size");
}

/// Fills in p-values and the null's total variation, from `null_draws` calls of draw(k), in any
/// order.
template <class Draw>
void fill_p_values(Comparison& c, const Statistics& seen, std::int64_t null_draws, Draw draw) {
  if (null_draws < 1) throw std::invalid_argument("compare: null_draws must be at least 1");
  std::vector<Statistics> null(null_draws);
  tbb::parallel_for(std::int64_t{0}, null_draws, [&](std::int64_t k) { null[k] = draw(k); });
  // Results that differ only by rounding count as equal.
  const auto p_value = [&](double Statistics::*what) {
    if (std::isnan(seen.*what)) return seen.*what;
    const double bar = seen.*what * (1.0 - 1e-12);
    const auto as_large = std::count_if(null.begin(), null.end(),
                                        [&](const Statistics& s) { return s.*what >= bar; });
    return static_cast<double>(as_large + 1) / static_cast<double>(null_draws + 1);
  };
  c.p_chi_squared = p_value(&Statistics::chi_squared);
  c.p_total_variation = p_value(&Statistics::total_variation);
  c.p_energy = p_value(&Statistics::energy);
  c.null_draws = null_draws;
  std::vector<double> tv;
  for (const Statistics& s : null) tv.push_back(s.total_variation);
  std::tie(c.floor_total_variation, c.floor_total_variation_95) = mean_and_95(tv);
}

/// Two samples and their permutations for the null. Above kMostDealt pooled trials, both samples
/// are drawn from the pooled shares instead.
class TwoSamples {
 public:
  /// `pooled`: counts of both samples together in these places; `shares`: of all; `first` and
  /// `second`: sizes of the samples.
  TwoSamples(const CellCounts& pooled, Eigen::VectorXd shares,
             const std::vector<Eigen::Index>& places, std::int64_t first, std::int64_t second)
      : shares_(std::move(shares)), first_(first), second_(second) {
    if (!are_dealt()) return;
    trials_.reserve(static_cast<std::size_t>(first + second));
    for (std::size_t i = 0; i < places.size(); ++i)
      trials_.insert(trials_.end(), static_cast<std::size_t>(pooled.data()[places[i]]),
                     static_cast<std::int32_t>(i));
  }

  [[nodiscard]] bool are_dealt() const { return first_ + second_ <= kMostDealt; }

  /// One permutation: shares of the first and of the second sample.
  [[nodiscard]] std::pair<Eigen::VectorXd, Eigen::VectorXd> anew(Random& random) const {
    const auto n = static_cast<double>(first_), m = static_cast<double>(second_);
    if (!are_dealt()) {
      Eigen::VectorXd of_first = drawn_shares(shares_, first_, random);
      return {std::move(of_first), drawn_shares(shares_, second_, random)};
    }
    // Deal out the smaller hand only (Fisher-Yates); the rest is the other hand.
    const bool first_is_smaller = first_ <= second_;
    std::vector<std::int32_t> deck = trials_;
    Eigen::VectorXd hand = Eigen::VectorXd::Zero(shares_.size());
    for (std::int64_t i = 0; i < std::min(first_, second_); ++i) {
      const std::int64_t j = i + random.below(first_ + second_ - i);
      std::swap(deck[static_cast<std::size_t>(i)], deck[static_cast<std::size_t>(j)]);
      hand[deck[static_cast<std::size_t>(i)]] += 1.0;
    }
    const Eigen::VectorXd rest = shares_ * static_cast<double>(first_ + second_) - hand;
    return {(first_is_smaller ? hand : rest) / n, (first_is_smaller ? rest : hand) / m};
  }

 private:
  Eigen::VectorXd shares_;
  std::int64_t first_, second_;
  std::vector<std::int32_t> trials_;  // the place of every pooled trial
};

}  // namespace

CellProbabilities shares(const CellCounts& counts) {
  const std::int64_t total = counts.sum();
  if (total <= 0) throw std::invalid_argument("compare: a sample without trials");
  return counts.cast<double>() / static_cast<double>(total);
}

double corrcoef(const CellProbabilities& a, const CellProbabilities& b) {
  require_same_shape(a.rows(), a.cols(), b.rows(), b.cols());
  const CellProbabilities da = a - a.mean(), db = b - b.mean();
  const double variance = da.square().sum() * db.square().sum();
  return variance > 0.0 ? (da * db).sum() / std::sqrt(variance)
                        : std::numeric_limits<double>::quiet_NaN();
}

double rmse_per_100(const CellProbabilities& a, const CellProbabilities& b) {
  require_same_shape(a.rows(), a.cols(), b.rows(), b.cols());
  return 100.0 * std::sqrt((a - b).square().mean());
}

double total_variation(const CellProbabilities& a, const CellProbabilities& b) {
  require_same_shape(a.rows(), a.cols(), b.rows(), b.cols());
  return 0.5 * (a - b).abs().sum();
}

double energy_distance(const CellProbabilities& a, const CellProbabilities& b) {
  require_same_shape(a.rows(), a.cols(), b.rows(), b.cols());
  const Support s = with_distances(support_of(a + b), a.cols());
  return energy_of(on_support(a, s) - on_support(b, s), s);
}

double concentration(const CellCounts& counts) {
  const auto n = static_cast<double>(counts.sum());
  if (n < 2.0) return std::numeric_limits<double>::quiet_NaN();
  const auto c = counts.cast<double>();
  return (c * (c - 1.0)).sum() / (n * (n - 1.0));
}

NoiseFloor noise_floor(double s, std::int64_t gates, std::int64_t trials,
                       std::int64_t second_trials) {
  const auto n = static_cast<double>(gates);
  const double first = (1.0 - s) / (n * static_cast<double>(trials));
  const double second =
      second_trials > 0 ? (1.0 - s) / (n * static_cast<double>(second_trials)) : 0.0;
  const double signal = (s - 1.0 / n) / n;
  return {signal / std::sqrt((signal + first) * (signal + second)),
          100.0 * std::sqrt(first + second)};
}

// Above this, logarithms of factorials (3e13) leave less than two digits; no study needs as many
// trials.
constexpr std::int64_t kMostTrialsAsked = std::int64_t{1} << 40;

double expected_total_variation(const CellProbabilities& p, std::int64_t trials) {
  if (trials < 1) throw std::invalid_argument("expected_total_variation: needs at least one trial");
  const auto n = static_cast<double>(trials);
  double sum = 0.0;
  for (Eigen::Index i = 0; i < p.size(); ++i) {
    const double share = p.data()[i];
    if (!(share > 0.0 && share < 1.0)) continue;  // a certain count has no variation
    const double m = std::floor(n * share) + 1.0;
    // (1-p) m P(X = m) = n C(n-1, m-1) p^m (1-p)^(n-m+1), with n C(n-1, m-1) = n! / ((m-1)! (n-m)!)
    sum += 2.0 / n *
           std::exp(log_gamma(n + 1.0) - log_gamma(m) - log_gamma(n - m + 1.0) +
                    m * std::log(share) + (n - m + 1.0) * std::log1p(-share));
  }
  return 0.5 * sum;
}

std::int64_t trials_for(const CellProbabilities& p, double total_variation) {
  if (!(total_variation > 0.0))
    throw std::invalid_argument("trials_for: a total variation must be > 0");
  std::int64_t enough = 1;
  while (expected_total_variation(p, enough) > total_variation && enough < kMostTrialsAsked)
    enough *= 2;
  std::int64_t low = enough / 2;  // too few, or 0
  while (enough - low > 1) {
    const std::int64_t middle = low + (enough - low) / 2;
    (expected_total_variation(p, middle) > total_variation ? low : enough) = middle;
  }
  return enough;
}

CellCounts sampled(const CellProbabilities& p, std::int64_t trials, std::uint64_t seed,
                   std::uint64_t replicate) {
  Random random(Purpose::comparison, {seed, kSamples, replicate});
  CellCounts cells(p.rows(), p.cols());
  const auto size = static_cast<std::size_t>(p.size());
  const CellProbabilities weights = p.max(0.0);  // rounding may leave negative shares
  multinomial(trials, {weights.data(), size}, {cells.data(), size}, random);
  return cells;
}

Comparison compare(const CellCounts& sample, const CellCounts& other, std::int64_t null_draws,
                   std::uint64_t seed) {
  require_same_shape(sample.rows(), sample.cols(), other.rows(), other.cols());
  const CellProbabilities a = shares(sample), b = shares(other);
  const std::int64_t n = sample.sum(), m = other.sum();
  Comparison c{corrcoef(a, b), rmse_per_100(a, b), total_variation(a, b), {}, 0, 0, 0, 0, 0, 0};
  const CellCounts pooled_counts = sample + other;
  c.floor = noise_floor(concentration(pooled_counts), sample.size(), n, m);

  const CellProbabilities pooled = shares(pooled_counts);
  const Support support = affordable_support_of(pooled);
  const Eigen::VectorXd expected = on_support(pooled, support);
  const double rare = rare_share(expected, std::min(n, m));
  const Statistics seen =
      statistics(on_support(a, support), on_support(b, support), expected, rare, support);
  const TwoSamples both(pooled_counts, expected, support.gates, n, m);
  fill_p_values(c, seen, null_draws, [&](std::int64_t k) {
    Random random(Purpose::comparison,
                  {seed, both.are_dealt() ? kDeals : kPooledDraws, static_cast<std::uint64_t>(k)});
    const auto [of_a, of_b] = both.anew(random);
    return statistics(of_a, of_b, expected, rare, support);
  });
  return c;
}

Comparison compare_pairs(const std::vector<std::int32_t>& first,
                         const std::vector<std::int32_t>& second, int rows, int columns,
                         std::int64_t null_draws, std::uint64_t seed) {
  if (first.size() != second.size())
    throw std::invalid_argument("compare_pairs: the two samples differ in length");
  const auto counted = [&](const std::vector<std::int32_t>& cells) {
    CellCounts counts = CellCounts::Zero(rows, columns);
    for (const std::int32_t cell : cells) {
      if (cell < 0 || cell >= counts.size())
        throw std::invalid_argument("compare_pairs: no such gate");
      ++counts.data()[cell];
    }
    return counts;
  };
  const CellProbabilities a = shares(counted(first)), b = shares(counted(second));
  Comparison c{corrcoef(a, b), rmse_per_100(a, b), total_variation(a, b), {}, 0, 0, 0, 0, 0, 0};
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  c.floor = {kNone, kNone};

  const CellProbabilities pooled = 0.5 * (a + b);
  const Support support = affordable_support_of(pooled);
  const Eigen::VectorXd expected = on_support(pooled, support);
  const auto n = static_cast<std::int64_t>(first.size());
  const double rare = rare_share(expected, n);
  // The pairs that differ, as places in the support; other pairs are the same after a swap.
  std::vector<std::pair<Eigen::Index, Eigen::Index>> unlike;
  const auto place = [&](std::int32_t cell) {
    return std::lower_bound(support.gates.begin(), support.gates.end(), cell) -
           support.gates.begin();
  };
  for (std::size_t t = 0; t < first.size(); ++t)
    if (first[t] != second[t]) unlike.emplace_back(place(first[t]), place(second[t]));
  const Statistics seen =
      statistics(on_support(a, support), on_support(b, support), expected, rare, support);
  fill_p_values(c, seen, null_draws, [&](std::int64_t k) {
    Random random(Purpose::comparison, {seed, kSwaps, static_cast<std::uint64_t>(k)});
    // Trials of the first sample minus trials of the second.
    Eigen::VectorXd moved = Eigen::VectorXd::Zero(expected.size());
    std::uint64_t coins = 0;
    for (std::size_t i = 0; i < unlike.size(); ++i) {
      if (i % 64 == 0) coins = random.word();
      const double sign = (coins >> (i % 64)) % 2 == 0 ? 1.0 : -1.0;
      moved[unlike[i].first] += sign;
      moved[unlike[i].second] -= sign;
    }
    const Eigen::VectorXd half = moved / (2.0 * static_cast<double>(n));
    return statistics(expected + half, expected - half, expected, rare, support);
  });
  return c;
}

Comparison compare(const CellCounts& sample, const CellProbabilities& exact,
                   std::int64_t null_draws, std::uint64_t seed) {
  require_same_shape(sample.rows(), sample.cols(), exact.rows(), exact.cols());
  const CellProbabilities a = shares(sample);
  const std::int64_t n = sample.sum();
  Comparison c{
      corrcoef(a, exact), rmse_per_100(a, exact), total_variation(a, exact), {}, 0, 0, 0, 0, 0, 0};
  c.floor = noise_floor(exact.square().sum(), sample.size(), n, 0);

  const Support support = affordable_support_of(a + exact);
  const Eigen::VectorXd expected = on_support(exact, support);
  const double rare = rare_share(expected, n);
  const Statistics seen = statistics(on_support(a, support), expected, expected, rare, support);
  fill_p_values(c, seen, null_draws, [&](std::int64_t k) {
    Random random(Purpose::comparison, {seed, kExactDraws, static_cast<std::uint64_t>(k)});
    return statistics(drawn_shares(expected, n, random), expected, expected, rare, support);
  });
  return c;
}

namespace {

/// One possible outcome of a trial.
struct GateEnding {
  Eigen::Index place;  // of the gate in the support
  std::size_t ending;
  double probability;
};

/// All outcomes of a trial of the predicted chain. In gates that are not in mixed_cells, all trials
/// were trapped.
std::vector<GateEnding> outcomes_of(const markov::FinalDistribution& prediction,
                                    const Support& support) {
  std::vector<GateEnding> outcomes;
  const Eigen::VectorXd expected = on_support(prediction.final_cells, support);
  auto mixed = prediction.mixed_cells.begin();
  for (Eigen::Index i = 0; i < expected.size(); ++i) {
    while (mixed != prediction.mixed_cells.end() && mixed->cell < support.gates[i]) ++mixed;
    if (mixed == prediction.mixed_cells.end() || mixed->cell != support.gates[i]) {
      outcomes.push_back(
          {i, static_cast<std::size_t>(markov::Ending::trapped), std::max(0.0, expected[i])});
      continue;
    }
    for (std::size_t e = 0; e < markov::kEndings; ++e)
      if (mixed->by_ending[e] > 0.0) outcomes.push_back({i, e, mixed->by_ending[e]});
  }
  return outcomes;
}

/// By ending: the places on the support where the prediction expects fewer than one of `runs` to
/// end so. If an ending is as rare but has no such place, all places.
std::array<std::vector<Eigen::Index>, markov::kEndings> rare_places(
    const markov::FinalDistribution& prediction, const Support& support, std::int64_t runs) {
  using markov::Ending;
  const Eigen::Index rows = prediction.final_cells.rows(), columns = prediction.final_cells.cols();
  const auto can_end = [&](Ending ending, Eigen::Index gate) {
    if (ending == Ending::far_edge) return gate / columns == rows - 1;
    if (ending == Ending::left_edge) return gate % columns == 0;
    return ending != Ending::right_edge || gate % columns == columns - 1;
  };
  const auto gates = static_cast<Eigen::Index>(support.gates.size());
  std::array<Eigen::VectorXd, markov::kEndings> shows;
  shows.fill(Eigen::VectorXd::Zero(gates));
  for (const GateEnding& o : outcomes_of(prediction, support))
    shows[o.ending][o.place] += o.probability * static_cast<double>(runs);
  std::array<std::vector<Eigen::Index>, markov::kEndings> places;
  for (const Ending ending : {Ending::trapped, Ending::far_edge, Ending::left_edge,
                              Ending::right_edge, Ending::cut_off}) {
    const auto e = static_cast<std::size_t>(ending);
    for (Eigen::Index i = 0; i < gates; ++i)
      if (can_end(ending, support.gates[i]) && shows[e][i] < 1.0) places[e].push_back(i);
    if (!places[e].empty() || shows[e].sum() >= 1.0) continue;
    places[e].resize(support.gates.size());
    std::iota(places[e].begin(), places[e].end(), 0);
  }
  return places;
}

constexpr std::size_t kGateTests = 3;
/// Statistics in the order of JointTest; NaN: not tested.
using Tests = std::array<double, kGateTests + markov::kEndings>;

Tests nothing_asked() {
  Tests t;
  t.fill(std::numeric_limits<double>::quiet_NaN());
  return t;
}

void add_gates(Tests& t, const Statistics& s) {
  t[0] = s.total_variation;
  t[1] = s.energy;
  t[2] = s.chi_squared;
}

template <class Shares>
void add_endings(Tests& t, const Shares& a, const Shares& b) {
  for (std::size_t e = 0; e < markov::kEndings; ++e) t[kGateTests + e] = std::abs(a[e] - b[e]);
}

using Endings = std::array<double, markov::kEndings>;

Endings shares_of(const SeenEndings& seen) {
  Endings shares{};
  for (std::size_t e = 0; e < markov::kEndings; ++e)
    shares[e] = static_cast<double>(seen.endings[e]) / static_cast<double>(seen.trials());
  return shares;
}

/// The verdict on the last row, which has the observed values; the rows before it are draws of the
/// null.
JointTest joint_test_of(const std::vector<Tests>& all) {
  std::vector<double> tv, rows;
  for (std::size_t k = 0; k + 1 < all.size(); ++k) tv.push_back(all[k][0]);
  for (const Tests& t : all) rows.insert(rows.end(), t.begin(), t.end());
  const MultipleTests looked(rows, std::tuple_size_v<Tests>);
  JointTest j;
  j.null_draws = std::ssize(all) - 1;
  std::tie(j.chance_total_variation, j.chance_total_variation_95) = mean_and_95(tv);
  j.p = looked.p;
  j.single_level = looked.single_level(JointTest::kLevel);
  j.total_variation = looked.tests[0];
  j.energy = looked.tests[1];
  j.chi_squared = looked.tests[2];
  std::copy_n(looked.tests.begin() + kGateTests, markov::kEndings, j.endings.begin());
  return j;
}

}  // namespace

std::int64_t SeenEndings::trials() const {
  return has_gates() ? final_gates.sum()
                     : std::accumulate(endings.begin(), endings.end(), std::int64_t{0});
}

bool SeenEndings::has_endings() const {
  return std::any_of(endings.begin(), endings.end(), [](std::int64_t n) { return n > 0; });
}

JointTest joint_test(const SeenEndings& seen, const markov::FinalDistribution& prediction,
                     const std::vector<markov::FinalDistribution>& replicates, std::int64_t runs,
                     std::int64_t null_draws, std::uint64_t seed) {
  const CellProbabilities& base = prediction.final_cells;
  if (seen.has_gates())
    require_same_shape(seen.final_gates.rows(), seen.final_gates.cols(), base.rows(), base.cols());
  if (null_draws < 1 || replicates.empty())
    throw std::invalid_argument("joint_test: needs draws and a resampled matrix at least");
  for (const auto& r : replicates)
    require_same_shape(r.final_cells.rows(), r.final_cells.cols(), base.rows(), base.cols());
  const std::int64_t n = seen.trials();
  if (n < 1) throw std::invalid_argument("joint_test: a sample without trials");
  const CellProbabilities sample =
      seen.has_gates() ? shares(seen.final_gates)
                       : CellProbabilities(CellProbabilities::Zero(base.rows(), base.cols()));
  const auto trials = static_cast<double>(n);

  CellProbabilities reached = sample + base;
  for (const auto& r : replicates) reached += r.final_cells;
  const Support support = affordable_support_of(reached);
  const Eigen::VectorXd expected = on_support(base, support);
  const double rare = rare_share(expected, n);
  std::array<std::vector<Eigen::Index>, markov::kEndings> left_open;
  if (runs > 0) left_open = rare_places(prediction, support, runs);

  const auto tests = [&](const Eigen::VectorXd& gates, const Endings& endings) {
    Tests t = nothing_asked();
    if (seen.has_gates()) add_gates(t, statistics(gates, expected, expected, rare, support));
    if (seen.has_endings()) add_endings(t, endings, prediction.endings);
    return t;
  };
  std::vector<Tests> all(static_cast<std::size_t>(null_draws) +
                         1);  // the null's draws, then the observed values
  all.back() = tests(on_support(sample, support), shares_of(seen));
  tbb::parallel_for(std::int64_t{0}, null_draws, [&](std::int64_t k) {
    Random random(Purpose::comparison, {seed, kJointTests, static_cast<std::uint64_t>(k)});
    std::vector<GateEnding> drawn =
        outcomes_of(replicates[static_cast<std::size_t>(k) % replicates.size()], support);
    for (std::size_t e = 0; e < markov::kEndings; ++e) {
      if (left_open[e].empty()) continue;
      const double share = -std::expm1(std::log(random.uniform()) / static_cast<double>(runs));
      for (const Eigen::Index place : left_open[e])
        drawn.push_back({place, e, share / static_cast<double>(left_open[e].size())});
    }
    std::vector<double> weights;
    for (const GateEnding& o : drawn) weights.push_back(o.probability);
    std::vector<std::int64_t> counts(weights.size());
    multinomial(n, weights, counts, random);
    Eigen::VectorXd gates = Eigen::VectorXd::Zero(expected.size());
    Endings endings{};
    for (std::size_t o = 0; o < drawn.size(); ++o) {
      const double share = static_cast<double>(counts[o]) / trials;
      gates[drawn[o].place] += share;
      endings[drawn[o].ending] += share;
    }
    all[static_cast<std::size_t>(k)] = tests(gates, endings);
  });

  return joint_test_of(all);
}

JointTest joint_test(const SeenEndings& seen, const SeenEndings& other, std::int64_t null_draws,
                     std::uint64_t seed) {
  const bool gates = seen.has_gates() && other.has_gates(),
             endings = seen.has_endings() && other.has_endings();
  const std::int64_t n = seen.trials(), m = other.trials();
  if (null_draws < 1) throw std::invalid_argument("joint_test: needs draws at least");
  if (n < 1 || m < 1 || !(gates || endings))
    throw std::invalid_argument("joint_test: a sample without trials, or nothing in common");
  if (gates)
    require_same_shape(seen.final_gates.rows(), seen.final_gates.cols(), other.final_gates.rows(),
                       other.final_gates.cols());

  const CellCounts pooled_gates =
      gates ? CellCounts(seen.final_gates + other.final_gates) : CellCounts(CellCounts::Zero(1, 1));
  const Support support = affordable_support_of(pooled_gates.cast<double>());
  const Eigen::VectorXd expected =
      on_support(pooled_gates.cast<double>() / static_cast<double>(n + m), support);
  const double rare = gates ? rare_share(expected, std::min(n, m)) : 0.0;
  const TwoSamples both_gates(pooled_gates, expected, support.gates, n, m);

  // The endings, followed by the trials without one (of broken runs).
  CellCounts pooled_endings = CellCounts::Zero(1, markov::kEndings + 1);
  for (std::size_t e = 0; e < markov::kEndings; ++e)
    pooled_endings.data()[e] = seen.endings[e] + other.endings[e];
  pooled_endings(0, markov::kEndings) = n + m - pooled_endings.sum();
  std::vector<Eigen::Index> places(markov::kEndings + 1);
  std::iota(places.begin(), places.end(), 0);
  const TwoSamples both_endings(
      pooled_endings,
      pooled_endings.row(0).transpose().cast<double>().matrix() / static_cast<double>(n + m),
      places, n, m);

  const auto tests = [&](const auto& of_gates, const auto& a, const auto& b) {
    Tests t = nothing_asked();
    if (gates) add_gates(t, statistics(of_gates.first, of_gates.second, expected, rare, support));
    if (endings) add_endings(t, a, b);
    return t;
  };
  std::vector<Tests> all(static_cast<std::size_t>(null_draws) +
                         1);  // the null's draws, then the observed values
  using Pair = std::pair<Eigen::VectorXd, Eigen::VectorXd>;
  all.back() = tests(gates ? Pair{on_support(shares(seen.final_gates), support),
                                  on_support(shares(other.final_gates), support)}
                           : Pair{},
                     shares_of(seen), shares_of(other));
  tbb::parallel_for(std::int64_t{0}, null_draws, [&](std::int64_t k) {
    Random random(Purpose::comparison, {seed, kDealtJudgements, static_cast<std::uint64_t>(k)});
    const Pair of_gates = gates ? both_gates.anew(random) : Pair{};
    const Pair of_endings = endings ? both_endings.anew(random) : Pair{};
    all[static_cast<std::size_t>(k)] = tests(of_gates, of_endings.first, of_endings.second);
  });
  return joint_test_of(all);
}

}  // namespace gatewalk::lattice
