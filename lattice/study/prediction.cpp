// SPDX-License-Identifier: MIT
#include "lattice/study/prediction.h"

#include <algorithm>

namespace gatewalk::lattice {
namespace {

/// Predictions from resampled matrices, for one start.
struct Resampled {
  MatrixNoise noise;
  std::vector<ExitShares> exits{};
};

/// The number of replicates: 200, or up to 999 if they take a fraction of a second, so that the
/// ends of intervals hardly depend on the seed. The decision is made per start, so that a start has
/// the same intervals with or without others.
std::int64_t replicates_for(const CountedField& gates, const markov::Field& field,
                            const std::vector<markov::FinalDistribution>& own, int max_cells) {
  constexpr std::int64_t kUsual = 200, kMost = 999, kQuick = 16;
  constexpr double kOperations = 2e10, kQuickly = 3e8;  // of direct solves, about 3 ns each
  double operations = 0.0, most_of_one = 0.0;
  int steps = max_cells;
  for (const markov::FinalDistribution& f : own) {
    operations += f.operations;
    most_of_one = std::max(most_of_one, f.operations);
    steps = std::max(steps, f.steps);
  }
  std::int64_t usual = affordable_replicates(gates, field, max_cells, kUsual),
               most = affordable_replicates(gates, field, steps, kQuick * kMost) / kQuick;
  if (operations > 0.0) {
    usual = std::min(usual, static_cast<std::int64_t>(kOperations / operations));
    most = std::min(most, static_cast<std::int64_t>(kQuickly / most_of_one));
  }
  const std::int64_t replicates = std::max(usual, most);
  return replicates < kLeastReplicates ? 0 : replicates;
}

/// The replicates' spread around the predictions, one per start; empty if too few can be predicted.
std::vector<Resampled> resampled_predictions(const CountedField& gates, const markov::Field& field,
                                             const std::vector<markov::Start>& starts,
                                             Prediction& prediction, int max_cells,
                                             std::uint64_t seed, const dynamics::Work& work) {
  constexpr std::int64_t kTogether = 8;
  std::vector<Resampled> all;
  for (std::size_t k = 0; k < starts.size(); ++k)
    all.push_back(
        {MatrixNoise(prediction.starts[k].final, gates.evidence_at(starts[k], field, max_cells))});
  std::vector<markov::FinalDistribution> own;
  for (const StartPrediction& s : prediction.starts) own.push_back(s.final);
  const std::int64_t replicates = gates.exact ? 0 : replicates_for(gates, field, own, max_cells);
  const auto add = [&](std::int64_t begin) {
    const Replicates some = replicate_predictions(gates, field, starts, max_cells, seed, begin,
                                                  std::min(kTogether, replicates - begin), own);
    prediction.left_out += some.left_out;
    for (std::size_t k = 0; k < starts.size(); ++k)
      for (const markov::FinalDistribution& f : some.predictions[k]) {
        all[k].noise.add(f);
        all[k].exits.push_back(exit_shares(f));
      }
  };
  work.in_pieces("resampled matrices", (replicates + kTogether - 1) / kTogether,
                 [&](dynamics::TrialRange batches) {
                   for (std::int64_t i = 0; i < batches.count; ++i)
                     add((batches.first + i) * kTogether);
                 });
  if (prediction.left_out.too_many()) all.clear();
  return all;
}

}  // namespace

Prediction predict(const CountedField& gates, const FieldParams& field_params,
                   const std::vector<ChainStart>& starts, markov::PredictOptions how,
                   std::uint64_t seed, const dynamics::Work& work) {
  const markov::Field field{field_params.columns, field_params.rows};
  how.max_cells = field_params.max_gates;
  std::vector<markov::Start> places;
  for (const ChainStart& s : starts) places.push_back(s.start);

  Prediction result;
  const dynamics::Stopwatch watch;
  std::vector<markov::FinalDistribution> found = markov::predict(gates.chains, field, places, how);
  result.seconds = watch.seconds();
  for (std::size_t k = 0; k < starts.size(); ++k) {
    EndingShares shares(found[k].endings);
    result.starts.push_back({starts[k], std::move(found[k]), shares, {}});
  }
  const std::vector<Resampled> resampled =
      resampled_predictions(gates, field, places, result, how.max_cells, seed, work);
  for (std::size_t k = 0; k < starts.size(); ++k) {
    StartPrediction& s = result.starts[k];
    const Resampled none{MatrixNoise(s.final, {})};
    const Resampled& of_start = resampled.empty() ? none : resampled[k];
    const MatrixNoise& spread = of_start.noise;
    s.shares = EndingShares(s.final, spread, how.max_cells);
    s.exits = within_sides(
        with_unfinished(exits_of(exit_shares(s.final), of_start.exits, spread.from()), s.final),
        s.shares);
    s.replicates = spread.replicates();
    s.mean_total_variation = spread.mean_total_variation();
    s.total_variation_95 = spread.total_variation_95();
  }
  return result;
}

}  // namespace gatewalk::lattice
