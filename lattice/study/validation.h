// SPDX-License-Identifier: MIT
#pragma once
/// Validation: the chain against the full dynamics, start by start.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "dynamics/base/work.h"
#include "lattice/field/field_trials.h"
#include "lattice/field/gate_chain.h"
#include "lattice/field/problem.h"
#include "lattice/statistics/compare.h"
#include "lattice/statistics/ending_shares.h"
#include "markov/predict.h"
#include "markov/walk.h"

namespace gatewalk::lattice {

// Results of further studies, which only some commands show.
struct ForceMemory;
struct MemoryStudy;
struct ObservedComparison;

/// Mean and standard deviation of the finite numbers added.
struct MeanAndSd {
  double sum = 0.0, squares = 0.0;
  std::int64_t n = 0;
  void add(double x) {
    if (!std::isfinite(x)) return;
    sum += x;
    squares += x * x;
    ++n;
  }
  [[nodiscard]] double mean() const { return n > 0 ? sum / static_cast<double>(n) : std::nan(""); }
  [[nodiscard]] double sd() const {
    if (n < 2) return std::nan("");
    const double m = mean();
    return std::sqrt(
        std::max(0.0, (squares - static_cast<double>(n) * m * m) / static_cast<double>(n - 1)));
  }
};

/// The paper's comparison, repeated: 100 trials against 100 walks, for each block of 100 trials.
struct PaperSized {
  MeanAndSd exact_corrcoef, exact_rmse, walks_corrcoef, walks_rmse;
  double exact_products = 0.0;  // sum of corrcoef * rmse over the blocks

  /// Correlation, over the blocks, of the exact chain's corrcoef with its RMSE.
  [[nodiscard]] double exact_correlation() const {
    const auto n = static_cast<double>(exact_corrcoef.n);
    return (exact_products - n * exact_corrcoef.mean() * exact_rmse.mean()) /
           ((n - 1) * exact_corrcoef.sd() * exact_rmse.sd());
  }
};

/// The finding of one start's comparison.
enum class Finding {
  within_trials,             // sampling error of the trials explains the difference (95 % level)
  within_trials_and_matrix,  // sampling error of trials and matrix explains it
  own_error,                 // neither explains it: the chain itself is off (bins, memory)
};
/// `differs`: verdict of the JointTest of trials and matrix. `total_variation`: of the trials'
/// final gates from the exact chain's. `floor_95`: 95 % of samples drawn from that chain are at
/// most this far.
[[nodiscard]] Finding finding_of(bool differs, double total_variation, double floor_95);

struct ValidationOptions {
  std::int64_t trials = 100;            // of the full dynamics, per start
  std::optional<std::int64_t> walks{};  // per start; default: the number of trials
  /// Draws behind each p-value; default: 999 to 9999, by the size of the work.
  std::optional<std::int64_t> null_draws{};
  std::uint64_t seed = 1;
  /// Also runs the trials with the random force drawn anew at each crossing (ForceMemory).
  bool force_memory = false;
  /// Counts of an experiment to compare with both chain and dynamics; only with a single start.
  std::optional<SeenEndings> observed{};
};

/// All results of one start. Trials, walks and p-values belong to the options' seed.
struct StartValidation {
  dynamics::Entry start{};
  ChainStart chain_start{};
  FieldTally dynamics;
  markov::WalkTally walks{};
  markov::FinalDistribution exact{};
  /// The dynamics' final gates against walks, and against the exact chain.
  Comparison walks_against{}, exact_against{};
  PaperSized paper_sized{};
  /// Noise floors of 100 trials, against the exact chain and against 100 walks.
  NoiseFloor floor_100_exact{}, floor_100_walks{};
  JointTest joint_test{};
  std::int64_t resampled = 0;  // number of resampled matrices
  /// Mean and sd of the total variation of the resampled matrices' predictions from `exact`.
  double matrix_noise_mean = 0.0, matrix_noise_sd = 0.0;
  EndingShares dynamics_endings, walks_endings, exact_endings;
  FieldExits dynamics_exits{}, exact_exits{};
  double dynamics_seconds = 0.0, walks_seconds = 0.0, exact_seconds = 0.0;
  std::shared_ptr<const ForceMemory> force{};            // only if asked for
  std::shared_ptr<const ObservedComparison> observed{};  // only with an experiment

  [[nodiscard]] Finding finding() const {
    return finding_of(joint_test.differs(), exact_against.total_variation,
                      exact_against.floor_total_variation_95);
  }
};

/// The results of validate_chain().
struct Validation {
  std::int64_t trials = 0, walks = 0;  // per start
  std::vector<StartValidation> starts;
  dynamics::Health health;  // of the matrix's runs and the trials
  /// Moves between gates in all trials; those with an entry outside all bins.
  std::int64_t entries = 0, clamped = 0;
  FaceCounts entries_by{};  // moves, by face
  std::size_t threads = 0;
  LeftOut left_out{};
  std::shared_ptr<const MemoryStudy> memory{};  // of the first kMostRemembered trials of each start
  /// True if the chain lacks memory that matters: a body's earlier gates, its step or its row help
  /// to predict what comes next (level 5 % for all these questions together).
  [[nodiscard]] bool remembers() const;
};

inline constexpr std::int64_t kMostRemembered = 100'000;

/// Compares the chain with the full dynamics from each start; `matrices` has one matrix per cell
/// type. Throws std::invalid_argument for fields of more than 100 000 gates, for an experiment with
/// several starts, and as chain_start and run_field do.
[[nodiscard]] Validation validate_chain(const Problem& problem,
                                        const std::vector<dynamics::Transitions>& matrices,
                                        const std::vector<dynamics::Entry>& starts,
                                        const ValidationOptions& options,
                                        const dynamics::Work& work = {});

}  // namespace gatewalk::lattice
