// SPDX-License-Identifier: MIT
#pragma once
/// The chain against the full dynamics, start by start.

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

// What the commands of this program show besides.
struct ForceMemory;
struct MemoryStudy;
struct ObservedComparison;

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

/// What the paper did: 100 trials of each, over and over, from the trials at hand in blocks of 100.
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

/// What the comparison of one start finds.
enum class Finding {
  within_trials,             // chance in the trials alone makes as much (95 % of the time)
  within_trials_and_matrix,  // chance in the trials and in the sampling of the matrix does
  own_error,                 // more than both: the chain itself is off (bins, memory)
};
/// `differs`: what the one test of trials and matrix says (JointTest); the total variation of the
/// final gates from the exact chain's, and what 95 % of samples of that chain have no more than.
[[nodiscard]] Finding finding_of(bool differs, double total_variation, double floor_95);

struct ValidationOptions {
  std::int64_t trials = 100;            // of the full dynamics, per start
  std::optional<std::int64_t> walks{};  // per start; as many as trials
  /// Behind each p-value; 999 to 9999, by the size of the work.
  std::optional<std::int64_t> null_draws{};
  std::uint64_t seed = 1;
  /// Runs the trials again with the random force drawn anew at crossings (ForceMemory).
  bool force_memory = false;
  /// Counts of an experiment from the start, to hold against both; then there is one start.
  std::optional<SeenEndings> observed{};
};

/// Everything about one start. Trials, walks and p-values belong to the options' seed.
struct StartValidation {
  dynamics::Entry start{};
  ChainStart chain_start{};
  FieldTally dynamics;
  markov::WalkTally walks{};
  markov::FinalDistribution exact{};
  Comparison walks_against{}, exact_against{};  // the dynamics' final gates against these
  PaperSized paper_sized{};
  NoiseFloor floor_100_exact{}, floor_100_walks{};  // of 100 trials, against exact and 100 walks
  JointTest joint_test{};
  std::int64_t resampled = 0;                             // matrices behind the two:
  double matrix_noise_mean = 0.0, matrix_noise_sd = 0.0;  // total variation of their predictions
  EndingShares dynamics_endings, walks_endings, exact_endings;
  FieldExits dynamics_exits{}, exact_exits{};
  double dynamics_seconds = 0.0, walks_seconds = 0.0, exact_seconds = 0.0;
  std::shared_ptr<const ForceMemory> force{};            // if asked for
  std::shared_ptr<const ObservedComparison> observed{};  // if there is an experiment

  [[nodiscard]] Finding finding() const {
    return finding_of(joint_test.differs(), exact_against.total_variation,
                      exact_against.floor_total_variation_95);
  }
};

struct Validation {
  std::int64_t trials = 0, walks = 0;  // per start
  std::vector<StartValidation> starts;
  dynamics::Health health;                // of the matrix's runs and the trials
  std::int64_t entries = 0, clamped = 0;  // between gates, of all trials; outside every bin
  FaceCounts entries_by{};                // of these, by face
  std::size_t threads = 0;
  LeftOut left_out{};
  std::shared_ptr<const MemoryStudy> memory{};  // of the first kMostRemembered trials of each start
  /// Whether the chain forgets what matters: where a body was before, which cell of its walk or
  /// which row it is in tells of what comes next, at a level of 5 % for all questions together.
  [[nodiscard]] bool remembers() const;
};

inline constexpr std::int64_t kMostRemembered = 100'000;

/// Compares the chain of these matrices, one for each type, with the full
/// dynamics from each start. Some 50 predictions of every gate are kept: throws
/// std::invalid_argument for fields of more than 100 000 gates, for an experiment and several
/// starts, and as chain_start and run_field do.
[[nodiscard]] Validation validate_chain(const Problem& problem,
                                        const std::vector<dynamics::Transitions>& matrices,
                                        const std::vector<dynamics::Entry>& starts,
                                        const ValidationOptions& options,
                                        const dynamics::Work& work = {});

}  // namespace gatewalk::lattice
