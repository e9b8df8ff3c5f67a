// SPDX-License-Identifier: MIT
#pragma once
/// Does one half of the bodies predict the other? Of runs that cannot be made again: the chain of
/// one half against what the other half did, and the other way round.

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
  std::optional<std::int64_t> null_draws{};  // behind the p-values; 999 to 1999, by the work
  std::uint64_t seed = 1;                    // of the halves, and of the draws
  int per_leaf = dynamics::kEntriesPerLeaf;
};

/// How far the trials that are predicted were seen.
struct Watched {
  std::int64_t trials = 0;  // compared: one passage of each is known at least
  std::int64_t to_end = 0;  // of them: seen until they end in the field
  std::int64_t unwatched = 0, lost = 0, other_type = 0;  // or until nobody looked, they were lost,
                                                         // or their cell is not the field's there
  std::int64_t left_out = 0;  // trials of which no passage can be compared
};

/// One half as it was seen, against the chain of the other half. Trials begin in the field's start
/// cell as they were seen to begin, wherever that was. Where a trial was not seen to its end, the
/// chain goes on from the last entry seen, so that nothing differs there: only what was seen can.
/// If the chain is right both have the same mean, wherever watching ended, as long as that was
/// decided by what had been seen until then.
struct Fold {
  std::int64_t bodies = 0, chain_bodies = 0;
  int states = 0;  // of the chain
  Watched watched;
  CellProbabilities seen_gates;                               // final gates
  EndingShares seen{std::array<double, markov::kEndings>{}};  // intervals: chance in its bodies
  markov::FinalDistribution chain;  // from the same starts; without its mixed_cells
  EndingShares chain_endings{std::array<double, markov::kEndings>{}};
  Error95 chain_error;

  double corrcoef = 0.0, rmse_per_100 = 0.0;  // of the final gates, seen against chain
  /// What chance in the bodies of both halves makes of them: means; and 95 % have no more.
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
  std::array<Fold, 2> folds;  // the second half as seen, the first half's chain; and back
  double p = 1.0;             // of both folds and all statistics together
  std::int64_t null_draws = 0;

  [[nodiscard]] bool differs() const { return p <= Fold::kLevel; }
};

/// Bodies are dealt out into two halves at random. Such halves are alike whatever the chain is
/// worth, so dealing them out again would test nothing. Instead each body's part in the difference
/// changes its sign or not, at random (Rademacher weights, as in wild bootstraps of clusters). A
/// body's part in the half as seen is what its trials did less what a chain says of them; in the
/// other one, how the difference changes with its weight in the chain. Both by the chain of all
/// bodies. Trials of one body stay together; bodies beyond kMostParts a half share a sign with
/// others. Throws std::invalid_argument for pools of fewer than 2 kLeastBodies bodies, for halves
/// without a passage that the field could have, and where cells times states are too many.
inline constexpr int kMostParts = 100;
[[nodiscard]] CrossValidation cross_validate(const Problem& problem, const RunPool& pool,
                                             const CrossValidationOptions& options,
                                             const dynamics::Work& work = {});

}  // namespace gatewalk::lattice
