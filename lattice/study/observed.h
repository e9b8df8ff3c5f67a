// SPDX-License-Identifier: MIT
#pragma once
/// Counts of an experiment, and their comparison with the model.

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

/// The counts of an experiment from one start.
struct Observed {
  SeenEndings seen;
  std::array<bool, markov::kEndings> listed{};  // endings in the experiment's table
  /// One trial, in tables with a line and a time per trial.
  struct Timed {
    std::size_t ending = 0;  // markov::Ending
    std::int64_t gate = -1;  // row * columns + column, if lines have gates
    double seconds = 0.0;    // until the body left the field; 0: it did not
  };
  std::vector<Timed> timed{};
  /// By Ending (rows x columns), if lines of trials have both; else empty.
  std::array<CellCounts, markov::kEndings> gates_by_ending{};
  std::int64_t went_back =
      0;  // trials that went back; `seen` excludes them, because the model has no such ending
  std::vector<std::string> remarks{};  // how files were read that are not plain CSV
};

/// Reads the tables of an experiment (lattice/text/table.h). A table has a line per trial, or
/// counts of final gates (gate_x, gate_y, count; missing gates have none), or counts of endings
/// (ending, count); both kinds of counts may be given in two files. The line of a trial has trial
/// and ending, or gate_x and gate_y of the final gate (i_x and i_y), or all four; with endings also
/// time_s, which may be empty if the body did not leave the field. Files with the same columns are
/// added up, as recordings of one experiment. Endings have either name of kEndingNames, or "went
/// back". Throws std::invalid_argument naming file, line and column for anything else, no trial at
/// all, a file given twice, and different totals of gates and endings.
[[nodiscard]] Observed read_observed(const std::vector<std::string>& paths,
                                     const FieldParams& field);

/// The smallest differences from a model that an experiment detects with probability `goal.power`,
/// if all statistics are tested together at level `goal.level`.
struct LeastDifferences {
  PowerGoal goal;
  /// Total variation of the kind hardest_to_see(); nullopt: not even the largest of that kind is
  /// detected, or nothing was counted.
  std::optional<double> final_gates{}, endings{};
  std::array<SmallestDifference, markov::kEndings> by_ending{};
};

/// An experiment compared with the full dynamics and with the chain.
struct ObservedComparison {
  SeenEndings seen;
  EndingShares endings{std::array<double, markov::kEndings>{}};  // if endings were counted
  std::optional<Comparison> dynamics_gates{}, chain_gates{};     // if gates were counted
  JointTest against_dynamics, against_chain;
  LeastDifferences least;  // from the chain's prediction, taken as exact
};

/// Compares an experiment with dynamics and chain. `max_gates`: of the model; `replicates` and
/// `runs`: see joint_test(). Throws std::invalid_argument as joint_test(), and if a trial was cut
/// off without a limit of gates.
[[nodiscard]] ObservedComparison compare_observed(
    const SeenEndings& seen, int max_gates, const FieldTally& dynamics,
    const markov::FinalDistribution& chain,
    const std::vector<markov::FinalDistribution>& replicates, std::int64_t runs,
    std::int64_t null_draws, std::uint64_t seed);

}  // namespace gatewalk::lattice
