// SPDX-License-Identifier: MIT
#pragma once
/// What a prediction from the gate runs of full trials says of each start, with its error bars: the
/// chain's answer, or the trials' own shares where these are the more certain.

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "dynamics/cells/health.h"
#include "dynamics/cells/section.h"
#include "dynamics/cells/state_space.h"
#include "lattice/statistics/compare.h"
#include "lattice/statistics/ending_shares.h"
#include "markov/predict.h"

namespace gatewalk::lattice {

struct AccuracyOptions {
  double accuracy = 0.02;  // total variation of the final gates that 95 % of answers keep
  /// New gate runs, but for the first few of each start. (These take some GB.)
  std::int64_t most_runs = 20'000'000;
  /// None are added but these: so many first runs of a start that the pool does not know.
  std::optional<std::int64_t> first_runs{};
  /// Exactly so many full trials of all starts together, or from anywhere in a range, whatever the
  /// accuracy.
  std::optional<std::int64_t> trials{};
  int per_leaf = dynamics::kEntriesPerLeaf;
  std::uint64_t seed = 1;

  /// Gate runs, about, that no more are added from.
  [[nodiscard]] std::int64_t limit() const {
    return trials ? std::numeric_limits<std::int64_t>::max() : most_runs;
  }
};

/// What is said of one start.
struct StartAnswer {
  dynamics::Entry start{};
  bool as_seen = false;             // not one start: all first entries of the pool's trials
  markov::FinalDistribution final;  // the answer
  bool from_trials = false;         // it is the shares of the start's own full trials
  Error95 error;
  double kernel_error_95 = 0.0;  // total variation, of the chain with endlessly many first runs;
                                 // of all where walks make the answer
  double unseen =
      0.0;  // share of first runs that enter the second gate where no run of the pool
            // did (missing_mass): the chain's error bars have it on top, corrcoef then has none
  double trials_error_95 = 1.0;  // total variation, of the trials' own shares
  EndingShares endings{std::array<double, markov::kEndings>{}};
  FieldExits exits{};
  std::array<CellProbabilities, 2> gates_95;  // low, high
  std::int64_t trials = 0, first_runs = 0;    // full ones; those through the first gate
  double direct_seconds = 0.0;  // of direct simulation for the same error bar; NaN where nothing
                                // was run that would tell
};

/// In the manner of Hausman's test (1978): where the chain is right it is the better estimate of
/// the same shares from the same runs, so that the difference varies less than the trials' own
/// shares would. The p-value is that of as many draws from the chain's answer (JointTest: final
/// gates and endings): rather too large than too small.
struct HausmanCheck {
  static constexpr double kLevel = 0.01;

  std::int64_t trials = 0;
  double total_variation = 0.0;         // of the final gates
  double chance_total_variation = 0.0;  // mean over the draws
  double p = 1.0;

  [[nodiscard]] bool differs() const { return p <= kLevel; }
};

struct PooledPrediction {
  std::vector<StartAnswer> starts;
  bool reached = true;  // all answers are as accurate as was asked for
  /// The full trials of all starts whose answer is the chain's, and exact, against the chain.
  std::optional<HausmanCheck> hausman_check{};
  std::int64_t gate_runs = 0;  // made now
  int states = 0;
  std::int64_t nonzeros = 0;
  double seconds = 0.0;      // of all: runs, chains, error bars
  double run_seconds = 0.0;  // of the runs
  dynamics::Health health;
};

}  // namespace gatewalk::lattice
