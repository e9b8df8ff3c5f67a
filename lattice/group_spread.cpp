#include "lattice/group_spread.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

#include "dynamics/random.h"
#include "dynamics/share.h"

namespace gatewalk::lattice {
namespace {

/// Of what states of a group (eight times as large) cost more than the whole one's, the part that
/// the whole one's cost too: as if that cost went with the power 0.4 of their size, 1 / (8^0.4 -
/// 1). (2/3 where outcomes vary smoothly with the entry, less where they jump.) Error bars then
/// hold as often as they should (results/tree).
constexpr double kBiasLeft = 0.75;

/// Draws behind a quantile, fewer for large fields.
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

/// Of errors that are drawn.
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

/// The largest share that so many trials miss altogether 5 times in 100.
double unseen_95(std::int64_t trials) {
  return 1.0 - std::pow(0.05, 1.0 / static_cast<double>(std::max<std::int64_t>(1, trials)));
}

constexpr std::uint64_t kGroupDraws = 0x67726f7570;  // "group", row of their streams

/// Student's t with 7 degrees of freedom, 97.5 %: kTrialGroups - 1 of them.
constexpr double kQuantile = 2.3646;
static_assert(kTrialGroups == 8);

}  // namespace

double half_width_95(double whole, const std::vector<double>& groups) {
  const auto n = static_cast<double>(groups.size());
  double mean = 0.0, squares = 0.0;
  for (const double g : groups) mean += g / n;
  for (const double g : groups) squares += (g - mean) * (g - mean);
  const double error = std::sqrt(squares / (n * (n - 1.0)));
  return std::hypot(kQuantile * error, kBiasLeft * (mean - whole));
}

Mean95 mean_95(double whole, const std::vector<double>& groups) {
  const double half =
      groups.empty() ? std::numeric_limits<double>::quiet_NaN() : half_width_95(whole, groups);
  return {whole, {whole - half, whole + half}};
}

GroupSpread::GroupSpread(const markov::FinalDistribution& whole,
                         const std::vector<markov::FinalDistribution>& groups)
    : whole_(whole), groups_(groups) {
  if (groups.size() < 2) throw std::invalid_argument("group spread: needs two groups at least");
  for (const auto& g : groups)
    if (g.final_cells.rows() != whole.final_cells.rows() ||
        g.final_cells.cols() != whole.final_cells.cols())
      throw std::invalid_argument("group spread: predictions of different fields");
}

template <class Value>
double GroupSpread::half_width(Value value) const {
  std::vector<double> values;
  for (const auto& g : groups_) values.push_back(value(g));
  return half_width_95(value(whole_), values);
}

Error95 GroupSpread::error(std::int64_t trials, std::uint64_t seed) const {
  const auto n = static_cast<double>(groups_.size());
  CellProbabilities mean =
      CellProbabilities::Zero(whole_.final_cells.rows(), whole_.final_cells.cols());
  for (const auto& g : groups_) mean += g.final_cells / n;
  const CellProbabilities biased = whole_.final_cells + kBiasLeft * (mean - whole_.final_cells);
  const double scale = 1.0 / std::sqrt(n * (n - 1.0));
  Error95 e =
      error_of_draws(draws_for(mean.size() * std::ssize(groups_)), whole_.final_cells, [&](int k) {
        dynamics::Random random(dynamics::Purpose::resampling,
                                {seed, kGroupDraws, static_cast<std::uint64_t>(k)});
        CellProbabilities drawn = biased;
        for (const auto& g : groups_) drawn += scale * random.normal() * (g.final_cells - mean);
        return drawn;
      });
  e.total_variation = std::min(
      1.0, std::max(e.total_variation, unseen_95(trials)) + whole_.unsampled + whole_.remainder);
  return e;
}

std::array<CellProbabilities, 2> GroupSpread::gates_95(std::int64_t trials) const {
  std::array<CellProbabilities, 2> range{whole_.final_cells, whole_.final_cells};
  const auto never = dynamics::interval_of_share(0.0, static_cast<double>(trials));
  for (Eigen::Index i = 0; i < whole_.final_cells.size(); ++i) {
    const double p = whole_.final_cells.data()[i];
    const double half =
        half_width([&](const markov::FinalDistribution& d) { return d.final_cells.data()[i]; });
    range[0].data()[i] = std::max(0.0, p - half);
    range[1].data()[i] = std::min(1.0, p + half);
    if (half > 0.0) continue;
    const auto unseen = p == 0.0 ? never
                                 : dynamics::interval_of_share(std::clamp(p, 0.0, 1.0),
                                                               static_cast<double>(trials));
    for (std::size_t side = 0; side < 2; ++side) range[side].data()[i] = unseen[side];
  }
  return range;
}

EndingShares GroupSpread::endings_95(std::int64_t trials) const {
  EndingShares shares(whole_.endings);
  for (std::size_t e = 0; e < markov::kEndings; ++e) {
    const double half =
        half_width([&](const markov::FinalDistribution& d) { return d.endings[e]; });
    const double p = std::clamp(shares.share[e], 0.0, 1.0);
    shares.interval[e] = {std::max(0.0, p - half), std::min(1.0, p + half)};
    if (half == 0.0)
      shares.interval[e] = dynamics::interval_of_share(p, static_cast<double>(trials));
  }
  return shares;
}

Error95 error_of_shares(const CellCounts& counts, std::uint64_t seed) {
  const CellProbabilities p = shares(counts);
  const std::int64_t trials = counts.sum();
  Error95 e = error_of_draws(draws_for(p.size()), p, [&](int k) {
    return shares(sampled(p, trials, seed ^ kGroupDraws, static_cast<std::uint64_t>(k)));
  });
  e.total_variation = std::max(e.total_variation, unseen_95(trials));
  return e;
}

}  // namespace gatewalk::lattice
