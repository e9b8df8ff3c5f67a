#include "lattice/matrix_noise.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "lattice/gate_chain.h"
#include "markov/sweep.h"

namespace gatewalk::lattice {

using markov::FinalDistribution;

std::vector<std::vector<FinalDistribution>> replicate_predictions(
    const FieldMatrices& rows, const markov::Field& field, const std::vector<markov::Start>& starts,
    int max_cells, std::uint64_t seed, std::int64_t first, std::int64_t count) {
  std::vector<std::vector<FinalDistribution>> found(starts.size(),
                                                    std::vector<FinalDistribution>(static_cast<std::size_t>(count)));
  tbb::parallel_for(std::int64_t{0}, count, [&](std::int64_t k) {
    std::vector<markov::Chain> chains;
    for (std::size_t m = 0; m < rows.matrices.size(); ++m) {
      // Another matrix of the same replicate takes another stream.
      const std::uint64_t replicate = static_cast<std::uint64_t>(first + k) + (std::uint64_t{m} << 32);
      chains.push_back(make_chain(resampled(*rows.matrices[m], seed, replicate)));
    }
    const markov::Sweeper sweeper(markov::RowChains(std::move(chains), rows.matrix_of_row));
    std::vector<FinalDistribution> of_starts = sweeper.predict_all(field, starts, max_cells);
    for (std::size_t s = 0; s < starts.size(); ++s)
      found[s][static_cast<std::size_t>(k)] = std::move(of_starts[s]);
  });
  return found;
}

std::int64_t affordable_replicates(const markov::Field& field, int max_cells, std::int64_t most) {
  // Measured: some 40 ns a cell without limit, and a cell and step with one.
  constexpr double kCellSteps = 1e8;
  constexpr std::int64_t kTooFew = 50;
  const double steps = std::max(1, max_cells);
  const double cells = std::min(static_cast<double>(field.columns) * field.rows,
                                max_cells > 0 ? 2.0 * steps * steps : std::numeric_limits<double>::infinity());
  const double replicates = std::min(static_cast<double>(most), kCellSteps / (cells * steps));
  return replicates < kTooFew ? 0 : static_cast<std::int64_t>(replicates);
}

MatrixNoise::MatrixNoise(const FinalDistribution& prediction, std::int64_t runs)
    : prediction_(prediction), runs_(static_cast<double>(runs)) {}

void MatrixNoise::add(const FinalDistribution& replicate) {
  for (std::size_t e = 0; e < markov::kEndings; ++e) {
    const double difference = replicate.endings[e] - prediction_.endings[e];
    squares_[e] += difference * difference;
  }
  distances_.push_back(0.5 * (replicate.final_cells - prediction_.final_cells).abs().sum());
}

double MatrixNoise::sd(markov::Ending e) const {
  return std::sqrt(squares_[static_cast<std::size_t>(e)] / static_cast<double>(replicates()));
}

double MatrixNoise::equivalent_walks(markov::Ending e) const {
  constexpr double kMost = 1e15;
  const double share = prediction_.endings[static_cast<std::size_t>(e)], spread = sd(e);
  const double walks = share * (1.0 - share) / (spread * spread);
  // Rounding alone shows as a spread of some 1e-16.
  return spread > 1e-14 && walks > 0.0 ? std::min(walks, kMost) : runs_;
}

double MatrixNoise::mean_total_variation() const {
  return std::accumulate(distances_.begin(), distances_.end(), 0.0) / static_cast<double>(replicates());
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
