// SPDX-License-Identifier: MIT
#pragma once
/// The prediction for each start from the gate runs of full trials, with error bars: the answer of
/// the chain, or the shares of the start's own trials where these are more precise.

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
  /// Most new gate runs; the first few of each start are always made. (The default takes some GB.)
  std::int64_t most_runs = 20'000'000;
  /// Number of first runs of a start that the pool does not know. If given, no other runs are
  /// added.
  std::optional<std::int64_t> first_runs{};
  /// Number of full trials of all starts together, or from anywhere in a range. If given, exactly
  /// these are run, whatever the accuracy.
  std::optional<std::int64_t> trials{};
  int per_leaf = dynamics::kEntriesPerLeaf;
  std::uint64_t seed = 1;

  /// Simulation stops after about this number of gate runs.
  [[nodiscard]] std::int64_t limit() const {
    return trials ? std::numeric_limits<std::int64_t>::max() : most_runs;
  }
};

/// The prediction for one start.
struct StartAnswer {
  dynamics::Entry start{};
  bool as_seen = false;             // not one start: all first entries of the pool's trials
  markov::FinalDistribution final;  // the answer
  bool from_trials = false;         // the answer is the shares of the start's own full trials
  Error95 error;
  /// Total variation: the error bar that the kernel alone would give (infinitely many first runs).
  /// Where Monte Carlo walks give the answer: the whole error bar.
  double kernel_error_95 = 0.0;
  /// Share of first runs that enter the second gate where no run of the pool did (missing_mass).
  /// The chain's error bars include this share on top; error.corrcoef is then NaN.
  double unseen = 0.0;
  double trials_error_95 = 1.0;  // total variation, of the shares of the start's own trials
  EndingShares endings{std::array<double, markov::kEndings>{}};
  FieldExits exits{};
  std::array<CellProbabilities, 2> gates_95;  // lower and upper bounds
  std::int64_t trials = 0, first_runs = 0;    // full trials; runs through the first gate
  /// Time that direct simulation would take for the same error bar; NaN if no runs were made to
  /// measure the speed.
  double direct_seconds = 0.0;
};

/// A test of the chain against the full trials in the manner of Hausman (1978). If the chain is
/// right, the chain is the better estimate of the same shares from the same runs, and the
/// difference varies less than the trials' own shares. The p-value takes the variance of
/// independent draws from the chain's answer (JointTest: final gates and endings), so it errs on
/// the large side.
struct HausmanCheck {
  static constexpr double kLevel = 0.01;

  std::int64_t trials = 0;
  double total_variation = 0.0;         // between the final gates of trials and chain
  double chance_total_variation = 0.0;  // mean over the draws
  double p = 1.0;

  [[nodiscard]] bool differs() const { return p <= kLevel; }
};

/// What a chain of pooled runs assumes.
enum class Assumption : std::uint8_t {
  mirror,       // in symmetric cells: the mirror image of a run is a run too
  states,       // bodies of one state are alike
  face_before,  // the face by which a body entered the cell before does not matter
  quarters,     // cells of one type are alike near and far, on the left and on the right
  cells,        // and in all cells
};
inline constexpr std::array kAssumptions{Assumption::mirror, Assumption::states,
                                         Assumption::face_before, Assumption::quarters,
                                         Assumption::cells};

/// The final gates of the chain against those of a relaxed chain: a chain of the same runs without
/// one assumption.
struct AssumptionCheck {
  static constexpr double kLevel = 0.01;

  Assumption assumption = Assumption::states;
  double total_variation = 0.0;
  double chance_95 = 0.0;  // 95 % of the differences by chance and bias are at most this
  double p = 1.0;
  double p_adjusted = 1.0;  // for all assumptions together (Holm)

  [[nodiscard]] bool is_wrong() const { return p_adjusted <= kLevel; }
};
/// The assumption that is wrong; of several, the one whose relaxed chain differs most, relative to
/// chance: dropping one assumption also shows part of the others' errors. Null if none is wrong.
[[nodiscard]] const AssumptionCheck* wrong_assumption(const std::vector<AssumptionCheck>& checks);

struct PooledPrediction {
  std::vector<StartAnswer> starts;
  bool reached = true;  // every answer has the accuracy that was asked for
  /// Compares the chain with the full trials of all starts whose answer is the chain's; empty if
  /// Monte Carlo walks gave the answers.
  std::optional<HausmanCheck> hausman_check{};
  /// Of the chain, in the mean over all starts whose answer is the chain's; empty as hausman_check.
  std::vector<AssumptionCheck> assumptions{};
  std::int64_t gate_runs = 0;  // new runs
  int states = 0;
  std::int64_t nonzeros = 0;
  double seconds = 0.0;      // everything: runs, chains and error bars
  double run_seconds = 0.0;  // the runs only
  dynamics::Health health;
};

}  // namespace gatewalk::lattice
