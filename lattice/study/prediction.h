// SPDX-License-Identifier: MIT
#pragma once
/// Exact predictions from matrices, with the sampling error of the matrices.

#include <cstdint>
#include <string>
#include <vector>

#include "dynamics/base/work.h"
#include "lattice/field/exits.h"
#include "lattice/field/gate_chain.h"
#include "lattice/statistics/ending_shares.h"
#include "lattice/statistics/matrix_noise.h"

namespace gatewalk::lattice {

/// The prediction for one start.
struct StartPrediction {
  ChainStart start{};
  markov::FinalDistribution final{};
  EndingShares shares;  // with 95 % intervals if there are replicates
  FieldExits exits{};   // with 95 % intervals if there are replicates
  /// Number of resampled matrices, and total variation of their predictions from this one (NaN
  /// without).
  std::int64_t replicates = 0;
  double mean_total_variation = 0.0, total_variation_95 = 0.0;
};

/// Predictions for all starts.
struct Prediction {
  std::vector<StartPrediction> starts;
  double seconds = 0.0;  // of the predictions only
  LeftOut left_out{};
};

/// Predicts from each start. `how.max_cells` is the field's max_gates. Usually 200 matrices are
/// resampled; up to 999 if these take a fraction of a second, none if kLeastReplicates would take
/// too long or too many fail. Throws as markov::predict.
[[nodiscard]] Prediction predict(const CountedField& gates, const FieldParams& field,
                                 const std::vector<ChainStart>& starts, markov::PredictOptions how,
                                 std::uint64_t seed, const dynamics::Work& work = {});

}  // namespace gatewalk::lattice
