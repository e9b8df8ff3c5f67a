// SPDX-License-Identifier: MIT
#pragma once
/// Counts of an experiment, and the model held against them.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lattice/field/field_params.h"
#include "lattice/field/field_trials.h"
#include "lattice/statistics/compare.h"
#include "lattice/statistics/ending_shares.h"
#include "lattice/statistics/power.h"

namespace gatewalk::lattice {

/// What an experiment has counted of one start.
struct Observed {
  SeenEndings seen;
  std::array<bool, markov::kEndings> listed{};  // endings that its table has
  /// Where lines of trials have times, each of these trials.
  struct Timed {
    std::size_t ending = 0;  // markov::Ending
    std::int64_t gate = -1;  // row * columns + column, where lines have gates
    double seconds = 0.0;    // until it left the field; 0: it did not
  };
  std::vector<Timed> timed{};
  /// By Ending (rows x columns), where lines of trials have both; else empty.
  std::array<CellCounts, markov::kEndings> gates_by_ending{};
  std::int64_t went_back =
      0;  // of these trials, which `seen` leaves out: the model has no such end
  std::vector<std::string> remarks{};  // what was understood of files that are not plain CSV
};

/// Reads what an experiment saw, in tables (lattice/text/table.h): a line per trial (trial
/// and ending, gate_x and gate_y, or all four; i_x and i_y of the final gate as everywhere; with
/// endings also time_s, which may be empty for who did not leave the field), or counts of final
/// gates (gate_x, gate_y, count; gates without a row have none), or of endings (ending, count), or
/// files of each of the counts. Files with the same columns are recordings of one experiment: they
/// are added up. Endings are named as in kEndingNames, in either way, or "went back". Throws
/// std::invalid_argument naming file, line and column for anything else, for no trial at all, for a
/// file given twice, and for final gates and endings of different totals.
[[nodiscard]] Observed read_observed(const std::vector<std::string>& paths,
                                     const FieldParams& field);

/// The least differences from a model that so many trials show in `goal.power` of all experiments,
/// where all are looked at and `goal.level` of experiments may find what is not there.
struct LeastDifferences {
  PowerGoal goal;
  /// Total variation of the kind that is hardest to see; none: of that kind not even the largest
  /// is seen, or nothing was counted.
  std::optional<double> final_gates{}, endings{};
  std::array<SmallestDifference, markov::kEndings> by_ending{};
};

/// An experiment beside the full dynamics and the chain.
struct ObservedComparison {
  SeenEndings seen;
  EndingShares endings{std::array<double, markov::kEndings>{}};  // where they were counted
  std::optional<Comparison> dynamics_gates{}, chain_gates{};     // where gates were counted
  JointTest against_dynamics, against_chain;
  LeastDifferences least;  // from the chain's prediction, taken as exact
};

/// `max_gates` is the model's; `replicates` and `runs` as joint_test() takes them. Throws
/// std::invalid_argument as joint_test(), and where somebody was cut off without a limit of gates.
[[nodiscard]] ObservedComparison compare_observed(
    const SeenEndings& seen, int max_gates, const FieldTally& dynamics,
    const markov::FinalDistribution& chain,
    const std::vector<markov::FinalDistribution>& replicates, std::int64_t runs,
    std::int64_t null_draws, std::uint64_t seed);

}  // namespace gatewalk::lattice
