// SPDX-License-Identifier: MIT
#include "lattice/statistics/matrix_noise.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "dynamics/base/random.h"
#include "dynamics/base/share.h"
#include "lattice/statistics/draws.h"
#include "lattice/statistics/share_95.h"
#include "markov/predict.h"
#include "markov/totals.h"

namespace gatewalk::lattice {

using markov::FinalDistribution;

std::int64_t CountedField::runs_at(const markov::Start& start) const {
  const auto type = static_cast<std::size_t>(chains.type_of(start.column, start.row));
  const std::int64_t runs = counts[type].row(start.input).sum();
  return images.empty() ? runs : runs / images[type][static_cast<std::size_t>(start.input)];
}

namespace {

/// A negligible share of walks without an end.
constexpr double kHardlyAny = 1e-6;

/// A resampled row sums to this many steps, except for rounding.
constexpr double kSteps = 0x1p52;
/// The concentration of a single run.
constexpr double kLeastConcentration = 0.5;

/// Limit of sums for a resampled matrix that is too large to be solved.
constexpr int kMostSums = 100'000;

bool equals_row_before(const markov::Counts& counts, int row) {
  const int* const begin = counts.outerIndexPtr() + row;
  const auto same = [&](const auto* values) {
    return std::equal(values + begin[0], values + begin[1], values + begin[-1], values + begin[0]);
  };
  return row > 0 && same(counts.innerIndexPtr()) && same(counts.valuePtr());
}

/// The largest share of walks that a single row may send elsewhere if all its runs had one outcome:
/// the walks that pass the row, times the probability of an outcome that as many runs miss
/// (Jeffreys), for each cell in which walks draw from the row. A return to a cell and state is not
/// another draw. With many such rows, resampling already accounts for the error; a single row that
/// most walks pass needs this bound.
double hidden_share(const CountedField& gates, const markov::Start& start,
                    const markov::Field& field, int max_cells) {
  const auto& chains = gates.chains.chains();
  // By matrix and row; 0: several outcomes were seen.
  std::vector<std::vector<double>> missed(chains.size());
  bool any = false, leads_back = false;
  for (std::size_t m = 0; m < chains.size(); ++m) {
    missed[m].assign(static_cast<std::size_t>(gates.counts[m].rows()), 0.0);
    for (int row = 0; row < gates.counts[m].rows(); ++row) {
      const auto at = static_cast<std::size_t>(row);
      if (gates.counts[m].row(row).nonZeros() != 1) continue;
      const std::int64_t each = gates.images.empty() ? 1 : gates.images[m][at];
      const std::int64_t runs = gates.counts[m].row(row).sum() / each;
      missed[m][at] = dynamics::interval_of_share(0.0, static_cast<double>(runs))[1];
      any = true;
    }
    for (const markov::Exit& exit : chains[m].exits()) leads_back |= exit.di_y < 0;
  }
  if (!any) return 0.0;
  constexpr int kMoves = 1000;  // later moves are returns, or of hardly any walk
  if (max_cells == 0 && leads_back) max_cells = kMoves;
  std::map<std::tuple<std::size_t, int, std::int64_t>, double> draws;  // by matrix, row, cell
  (void)markov::walk_totals(gates.chains, field, start, max_cells, {},
                            [&](int, std::int64_t cell, int input, double share) {
                              const auto m = static_cast<std::size_t>(
                                  gates.chains.type_of(cell % field.columns, cell / field.columns));
                              if (missed[m][static_cast<std::size_t>(input)] > 0.0)
                                draws[{m, input, cell}] += share;
                            },
                            {.all = 1e-6});
  struct Walks {
    double pass = 0.0, draws = 0.0;  // share in the cell with most draws; sum over cells
  };
  std::map<std::pair<std::size_t, int>, Walks> walks;
  for (const auto& [at, share] : draws) {
    Walks& w = walks[{std::get<0>(at), std::get<1>(at)}];
    w.pass = std::max(w.pass, std::min(1.0, share));
    w.draws += std::min(1.0, share);
  }
  double most = 0.0;
  for (const auto& [row, w] : walks) {
    const double kept = 1.0 - missed[row.first][static_cast<std::size_t>(row.second)];
    most = std::max(most, w.pass * (1.0 - std::pow(kept, w.draws / w.pass)));
  }
  return most;
}

}  // namespace

Evidence CountedField::evidence_at(const markov::Start& start, const markov::Field& field,
                                   int max_cells) const {
  Evidence from{static_cast<double>(runs_at(start)), 0.0,
                hidden_share(*this, start, field, max_cells)};
  for (std::size_t type = 0; type < counts.size(); ++type)
    for (int row = 0; row < counts[type].rows(); ++row) {
      if (small_rows && equals_row_before(counts[type], row)) continue;
      const std::int64_t each = images.empty() ? 1 : images[type][static_cast<std::size_t>(row)];
      from.gate_runs += static_cast<double>(counts[type].row(row).sum() / each);
    }
  return from;
}

markov::Counts resampled(const markov::Counts& counts, std::uint64_t seed, std::uint64_t replicate,
                         bool small_rows, const std::vector<std::int64_t>& images) {
  using Entry = markov::Counts::InnerIterator;
  std::vector<Eigen::Triplet<std::int64_t>> drawn;
  std::vector<double> weights;
  int first = 0;  // first of the rows that are the same runs
  for (int row = 0; row < counts.rows(); ++row) {
    if (!small_rows || !equals_row_before(counts, row)) first = row;
    const auto all = static_cast<double>(counts.row(row).sum()),
               each = images.empty() ? 1.0
                                     : static_cast<double>(images[static_cast<std::size_t>(row)]),
               concentration = std::max(all / each - 1.0, kLeastConcentration);
    dynamics::Random random(dynamics::Purpose::resampling,
                            {seed, static_cast<std::uint64_t>(first), replicate});
    weights.clear();
    double sum = 0.0;
    for (Entry entry(counts, row); entry; ++entry) {
      weights.push_back(gamma(concentration * static_cast<double>(entry.value()) / all, random));
      sum += weights.back();
    }
    auto w = weights.begin();
    for (Entry entry(counts, row); entry; ++entry, ++w)
      drawn.emplace_back(row, entry.col(),
                         std::max<std::int64_t>(1, std::llround(*w / sum * kSteps)));
  }
  markov::Counts result(counts.rows(), counts.cols());
  result.setFromTriplets(drawn.begin(), drawn.end());
  return result;
}

LeftOut& LeftOut::operator+=(const LeftOut& other) {
  matrices += other.matrices;
  of += other.of;
  if (!other.why.empty()) why = other.why;
  return *this;
}

Replicates replicate_predictions(const CountedField& gates, const markov::Field& field,
                                 const std::vector<markov::Start>& starts, int max_cells,
                                 std::uint64_t seed, std::int64_t first, std::int64_t count,
                                 const std::vector<FinalDistribution>& own) {
  const bool directly = std::any_of(own.begin(), own.end(),
                                    [](const FinalDistribution& f) { return f.operations > 0.0; });
  std::vector<std::vector<FinalDistribution>> found(static_cast<std::size_t>(count));
  std::vector<std::string> why(found.size());
  tbb::parallel_for(std::int64_t{0}, count, [&](std::int64_t k) {
    std::vector<markov::Chain> chains;
    for (std::size_t m = 0; m < gates.counts.size(); ++m) {
      // Other matrices of the same replicate use other streams.
      const std::uint64_t replicate =
          static_cast<std::uint64_t>(first + k) + (std::uint64_t{m} << 32);
      chains.push_back(markov::Chain::from_counts(
          resampled(gates.counts[m], seed, replicate, gates.small_rows,
                    gates.images.empty() ? std::vector<std::int64_t>{} : gates.images[m]),
          gates.chains.chains()[m].exits()));
    }
    const markov::Predictor predictor(gates.chains.with(std::move(chains)));
    const auto i = static_cast<std::size_t>(k);
    markov::PredictOptions how{.max_cells = max_cells, .max_steps = kMostSums};
    if (directly) how.solver = markov::PredictOptions::Solver::direct;
    try {
      found[i] = predictor.predict_all(field, starts, how);
      for (std::size_t s = 0; s < starts.size(); ++s)
        if (found[i][s].remainder > kHardlyAny &&
            !(s < own.size() && own[s].remainder > kHardlyAny))
          throw std::runtime_error(
              "walks circle (almost) for ever, in too many states to be solved");
    } catch (const std::runtime_error& e) {
      why[i] = e.what();
      found[i].clear();
    }
  });
  Replicates all{std::vector<std::vector<FinalDistribution>>(starts.size()), {0, count}};
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (!why[i].empty()) all.left_out += {1, 0, why[i]};
    for (std::size_t s = 0; s < found[i].size(); ++s)
      all.predictions[s].push_back(std::move(found[i][s]));
  }
  return all;
}

std::int64_t affordable_replicates(const markov::Field& field, int max_cells, std::int64_t nonzeros,
                                   std::int64_t most) {
  // Measured for a matrix of 300 nonzeros: about 40 ns per cell without a limit, and per cell and
  // step with one.
  constexpr double kCellSteps = 1e8, kNonzeros = 300.0;
  const double steps = std::max(1, max_cells);
  const double cells =
      std::min(static_cast<double>(field.columns) * field.rows,
               max_cells > 0 ? 2.0 * steps * steps : std::numeric_limits<double>::infinity());
  const double replicates = std::min(
      static_cast<double>(most),
      kCellSteps / (cells * steps * std::max(1.0, static_cast<double>(nonzeros) / kNonzeros)));
  return replicates < kLeastReplicates ? 0 : static_cast<std::int64_t>(replicates);
}

std::int64_t affordable_replicates(const CountedField& gates, const markov::Field& field,
                                   int max_cells, std::int64_t most) {
  // Without a limit, rows with several types and chains of many states are solved by sums instead
  // of elimination; this is a typical number of sums.
  constexpr int kSteps = 100, kManyStates = 1000;
  if (max_cells == 0 && (!gates.chains.has_uniform_rows() || gates.chains.inputs() > kManyStates))
    max_cells = kSteps;
  std::int64_t nonzeros = 0;
  for (const markov::Counts& c : gates.counts)
    nonzeros = std::max<std::int64_t>(nonzeros, c.nonZeros());
  return affordable_replicates(field, max_cells, nonzeros, most);
}

MatrixNoise::MatrixNoise(const FinalDistribution& prediction, const Evidence& from)
    : prediction_(prediction), from_(from) {}

void MatrixNoise::add(const FinalDistribution& replicate) {
  endings_.push_back(replicate.endings);
  distances_.push_back(0.5 * (replicate.final_cells - prediction_.final_cells).abs().sum());
}

std::array<double, 2> MatrixNoise::interval_95(markov::Ending e) const {
  const auto at = static_cast<std::size_t>(e);
  std::vector<double> shares;
  for (const auto& endings : endings_) shares.push_back(endings[at]);
  return resampled_95(std::move(shares), prediction_.endings[at], from_);
}

double MatrixNoise::mean_total_variation() const {
  return std::accumulate(distances_.begin(), distances_.end(), 0.0) /
         static_cast<double>(replicates());
}

double MatrixNoise::sd_total_variation() const {
  const double mean = mean_total_variation();
  double squares = 0.0;
  for (const double d : distances_) squares += (d - mean) * (d - mean);
  return std::sqrt(squares / static_cast<double>(replicates() - 1));
}

double MatrixNoise::total_variation_95() const {
  if (distances_.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::vector<double> sorted = distances_;
  const auto at = sorted.begin() + (95 * replicates() + 99) / 100 - 1;
  std::nth_element(sorted.begin(), at, sorted.end());
  return *at;
}

}  // namespace gatewalk::lattice
