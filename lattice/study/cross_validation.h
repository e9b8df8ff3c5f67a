// SPDX-License-Identifier: MIT
#pragma once
/// Cross-validation of chains from recorded runs: the chain of one half of the bodies predicts the
/// other half, and the other way round.

#include <array>
#include <cstdint>
#include <optional>

#include "dynamics/base/work.h"
#include "dynamics/cells/tree_space.h"
#include "lattice/field/problem.h"
#include "lattice/pool/run_pool.h"
#include "lattice/statistics/ending_shares.h"
#include "lattice/statistics/group_spread.h"
#include "lattice/statistics/multiple_tests.h"
#include "markov/predict.h"

namespace gatewalk::lattice {

struct CrossValidationOptions {
  /// Behind the p-values; 999 to 1999, by the size of the work.
  std::optional<std::int64_t> null_draws{};
  std::uint64_t seed = 1;  // of the split, and of the draws
  int per_leaf = dynamics::kEntriesPerLeaf;
};

/// How far the predicted trials were observed.
struct Watched {
  std::int64_t trials = 0;  // compared trials: at least one passage is known
  std::int64_t to_end = 0;  // trials seen until they end in the field
  /// Trials seen until nobody looked, until they were lost, or until their cell is not the field's.
  std::int64_t unwatched = 0, lost = 0, other_type = 0;
  std::int64_t left_out = 0;  // trials without a passage that can be compared
};

/// One half of the bodies as observed, against the chain of the other half. Trials begin in the
/// field's start cell with their observed entries. A trial that was not seen to its end continues
/// by the chain from its last entry, so that only observed passages can differ. If the chain is
/// right, both have the same mean, provided that the end of observation depended only on what had
/// been seen until then.
struct Fold {
  std::int64_t bodies = 0, chain_bodies = 0;
  int states = 0;  // of the chain
  Watched watched;
  CellProbabilities seen_gates;  // final gates
  /// Intervals: sampling error over its bodies.
  EndingShares seen{std::array<double, markov::kEndings>{}};
  markov::FinalDistribution chain;  // from the same starts; without mixed_cells
  EndingShares chain_endings{std::array<double, markov::kEndings>{}};
  Error95 chain_error;

  double corrcoef = 0.0, rmse_per_100 = 0.0;  // of the final gates, seen against chain
  /// Of corrcoef and RMSE: the mean under sampling error of the bodies of both halves. Of the total
  /// variation: mean and 95 % quantile.
  double chance_corrcoef = 0.0, chance_rmse_per_100 = 0.0;
  double chance_total_variation = 0.0, chance_total_variation_95 = 0.0;
  std::array<double, markov::kEndings> chance_95{};  // of the difference of an ending's shares
  MultipleTests::Test total_variation;               // of the final gates
  std::array<MultipleTests::Test, markov::kEndings> endings;  // |difference of the shares|

  [[nodiscard]] bool differs(markov::Ending e) const {
    return endings[static_cast<std::size_t>(e)].p_adjusted <= kLevel;
  }
  static constexpr double kLevel = 0.05;
};

struct CrossValidation {
  std::array<Fold, 2> folds;  // observed second half with the first half's chain; and the reverse
  double p = 1.0;             // overall: both folds and all statistics
  std::int64_t null_draws = 0;

  [[nodiscard]] bool differs() const { return p <= Fold::kLevel; }
};

/// Splits the bodies into two random halves, each with all trials of its bodies, and tests each
/// half against the other's chain. Random halves are alike even if the chain is wrong, so permuting
/// bodies would test nothing. The null is instead a wild cluster bootstrap: each body's
/// contribution to the difference is multiplied by +1 or -1 (Rademacher weights). In the observed
/// half, the contribution is what the body's trials did minus the chain's prediction. In the other
/// half, it is the change of the difference with the body's weight in the chain. Both use the chain
/// of all bodies. Bodies beyond kMostParts per half share signs. Throws std::invalid_argument for
/// pools of fewer than 2 kLeastBodies bodies, for halves without a passage that the field could
/// have, and if cells times states are too many.
inline constexpr int kMostParts = 100;
[[nodiscard]] CrossValidation cross_validate(const Problem& problem, const RunPool& pool,
                                             const CrossValidationOptions& options,
                                             const dynamics::Work& work = {});

}  // namespace gatewalk::lattice
