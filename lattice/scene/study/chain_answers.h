// SPDX-License-Identifier: MIT
#pragma once
/// What transition matrices of one kind say about the final gates, against the full dynamics. All
/// seconds are CPU time of one thread.

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

/// How far shares of the final gates are from the truth's.
struct FinalGateError {
  double total_variation = 0.0, corrcoef = 0.0;
};
[[nodiscard]] FinalGateError error_of(const CellProbabilities& p, const CellProbabilities& truth);
/// Adds one of n errors to their mean.
void add_to_mean(FinalGateError& mean, const FinalGateError& e, double n);

/// Full dynamics from one start: what every error is taken against.
struct FieldTruth {
  dynamics::Entry start{};
  FieldTally tally;
  CellProbabilities p{};  // shares of the final gates
  double seconds_per_trial = 0.0;
  FinalGateError floor{};  // what a perfect prediction would show, by the noise of `p`

  /// Direct simulation's errors are told from the same noisy truth as the chain's are: n trials
  /// against these N. Var = 1/n + 1/N, so compare with m = nN/(n + N) trials against an exact
  /// truth.
  [[nodiscard]] std::int64_t as_against_exact(std::int64_t trials) const;
  /// Of direct simulation for as small an error; infinite if this truth cannot tell.
  [[nodiscard]] double seconds_for(double total_variation) const;
};
/// Throws std::runtime_error when trials broke: they are no truth.
[[nodiscard]] FieldTruth field_truth(const dynamics::Entry& start, FieldTally tally,
                                     double seconds_per_trial);

/// Numbers of walks whose errors stand beside the exact prediction's.
inline constexpr std::array<std::int64_t, 2> kChainWalks{10'000, 1'000'000};
/// Matrices drawn anew, whose predictions show what the sampling of a matrix makes.
inline constexpr std::int64_t kMatricesDrawnAnew = 8;

/// What matrices say about one start; errors are means over them.
struct ChainAnswer {
  FinalGateError exact{};
  double exact_sd = 0.0;  // of the total variation, over the matrices; NaN if there is only one
  std::array<FinalGateError, kChainWalks.size()> walks{};
  double exact_seconds = 0.0;
  std::array<double, kChainWalks.size()> walk_seconds{};
  double sampling = 0.0;       // total variation that the sampling of the matrix alone makes
  double bins = 0.0;           // what is left: states too coarse, memory beyond them
  double never_sampled = 0.0;  // share of the walks that end in a row without trials
};

/// What they say about all starts.
struct ChainAnswers {
  std::int64_t matrices = 0;
  std::int64_t runs = 0;               // of one matrix
  double freezing_seconds = 0.0;       // from its counts to a chain ready to predict
  double clamped_share = 0.0;          // mean over the matrices
  double rows_never_sampled = 0.0;     // mean over the matrices
  std::vector<ChainAnswer> answers{};  // by start
};
/// Asks matrices (1 or more) of the same states and trials per row, each from trials of its own,
/// about the starts of `truths`. The same but for the times on any number of threads.
[[nodiscard]] ChainAnswers ask_matrices(const std::vector<dynamics::Transitions>& matrices,
                                        const FieldParams& field,
                                        const std::vector<FieldTruth>& truths, std::uint64_t seed,
                                        const dynamics::Work& work = {});

/// CPU seconds that `run` takes on one thread: what else the machine does counts little.
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
