// SPDX-License-Identifier: MIT
#pragma once
/// Exact predictions from matrices, with what the sampling of the matrices leaves open.

#include <cstdint>
#include <string>
#include <vector>

#include "dynamics/base/work.h"
#include "lattice/field/exits.h"
#include "lattice/field/gate_chain.h"
#include "lattice/statistics/ending_shares.h"
#include "lattice/statistics/matrix_noise.h"

namespace gatewalk::lattice {

struct StartPrediction {
  ChainStart start{};
  markov::FinalDistribution final{};
  EndingShares shares;  // with 95 % intervals where there are replicates
  FieldExits exits{};   // the same
  /// Predictions from resampled matrices, and their total variation from this one (NaN without).
  std::int64_t replicates = 0;
  double mean_total_variation = 0.0, total_variation_95 = 0.0;
};

struct Prediction {
  std::vector<StartPrediction> starts;
  double seconds = 0.0;  // of the predictions alone
  LeftOut left_out{};
};

/// One prediction per start. `how.max_cells` is the field's max_gates. Replicates are 200, up to
/// 999 where they take a fraction of a second, none where kLeastReplicates would take too long or
/// too many are left out. Throws as markov::predict.
[[nodiscard]] Prediction predict(const CountedField& gates, const FieldParams& field,
                                 const std::vector<ChainStart>& starts, markov::PredictOptions how,
                                 std::uint64_t seed, const dynamics::Work& work = {});

}  // namespace gatewalk::lattice
