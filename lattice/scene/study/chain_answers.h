// SPDX-License-Identifier: MIT
#pragma once
/// Predictions of the final gates by transition matrices of one kind, compared with the full
/// dynamics. All times are CPU seconds of one thread.

#include <tbb/task_arena.h>
#include <time.h>

#include <array>
#include <cstdint>
#include <vector>

#include "dynamics/base/work.h"
#include "dynamics/cells/transitions.h"
#include "lattice/field/field_trials.h"
#include "lattice/scene/table4.h"
#include "lattice/statistics/compare.h"

namespace gatewalk::lattice {

/// Errors of shares of the final gates relative to the truth.
struct FinalGateError {
  double total_variation = 0.0, corrcoef = 0.0;
};
[[nodiscard]] FinalGateError error_of(const CellProbabilities& p, const CellProbabilities& truth);
/// Adds one of n errors to their mean.
void add_to_mean(FinalGateError& mean, const FinalGateError& e, double n);

/// Trials of the full dynamics from one start: the truth for all errors.
struct FieldTruth {
  dynamics::Entry start{};
  FieldTally tally;
  CellProbabilities p{};  // shares of the final gates
  double seconds_per_trial = 0.0;
  /// corrcoef and total variation of a perfect prediction, by the sampling noise of `p`
  FinalGateError floor{};

  /// The number of trials m against an exact truth that have the same error as `trials` = n trials
  /// against this truth of N: m = nN/(n + N), because Var = 1/n + 1/N. Direct simulation is thus
  /// judged by the same noisy truth as the chain.
  [[nodiscard]] std::int64_t as_against_exact(std::int64_t trials) const;
  /// Time of direct simulation with an error of this total variation, s; infinite if this truth is
  /// too noisy to tell.
  [[nodiscard]] double seconds_for(double total_variation) const;
};
/// Makes a truth of a tally. Throws std::runtime_error if trials broke.
[[nodiscard]] FieldTruth field_truth(const dynamics::Entry& start, FieldTally tally,
                                     double seconds_per_trial);

/// Numbers of walks whose errors are listed with the exact prediction's.
inline constexpr std::array<std::int64_t, 2> kChainWalks{10'000, 1'000'000};
/// Number of resampled matrices that show the sampling error of a matrix.
inline constexpr std::int64_t kMatricesDrawnAnew = 8;

/// Predictions of matrices from one start; errors are means over the matrices.
struct ChainAnswer {
  FinalGateError exact{};
  double exact_sd = 0.0;  // of the total variation, over the matrices; NaN for a single matrix
  std::array<FinalGateError, kChainWalks.size()> walks{};
  double exact_seconds = 0.0;
  std::array<double, kChainWalks.size()> walk_seconds{};
  double sampling = 0.0;       // total variation caused by the sampling of the matrix alone
  double bins = 0.0;           // remaining error: coarse states, and memory beyond the states
  double never_sampled = 0.0;  // share of the walks that end in a row without trials
};

/// Predictions of matrices from all starts.
struct ChainAnswers {
  std::int64_t matrices = 0;
  std::int64_t runs = 0;               // of one matrix
  double freezing_seconds = 0.0;       // from the counts of one matrix to a chain ready to predict
  double clamped_share = 0.0;          // mean over the matrices
  double rows_never_sampled = 0.0;     // mean over the matrices
  std::vector<ChainAnswer> answers{};  // by start
};
/// Predicts with matrices (1 or more) of the same states and trials per row, each from its own
/// trials, from the starts of `truths`. Only the times depend on the number of threads.
[[nodiscard]] ChainAnswers ask_matrices(const std::vector<dynamics::Transitions>& matrices,
                                        const FieldParams& field,
                                        const std::vector<FieldTruth>& truths, std::uint64_t seed,
                                        const dynamics::Work& work = {});

/// CPU seconds that `run` takes on one thread, nearly independent of the machine's other work.
template <class Run>
double one_thread_seconds(const Run& run) {
  const auto cpu_seconds = [] {
    timespec now = {};
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
  };
  tbb::task_arena one(1);
  return one.execute([&] {
    const double before = cpu_seconds();
    run();
    return cpu_seconds() - before;
  });
}

}  // namespace gatewalk::lattice
