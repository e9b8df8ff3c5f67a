// SPDX-License-Identifier: MIT
#pragma once
/// The chain's error against its cost: matrices with coarser and finer bins and with few or many
/// trials per row, and trees, compared with the full dynamics and with direct simulation at the
/// same cost. All times are CPU seconds of one thread.

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "dynamics/base/work.h"
#include "dynamics/cells/transitions.h"
#include "lattice/scene/bins.h"
#include "lattice/scene/scene.h"
#include "lattice/scene/study/chain_answers.h"

namespace gatewalk::lattice {

/// One state space, and one way to choose where the runs of its rows start.
struct ChainCurve {
  double factor = 1.0;  // bins per axis, as a multiple of the usual ones
  dynamics::StateSpace space;
  bool visited = false;  // starts as bodies enter, besides a curve with uniform starts
  /// Where the runs of the rows start, as bodies entered; empty: uniform.
  dynamics::Entries entries{};
  std::vector<std::int64_t> trials{};  // per row, within the limit of runs
  double pilot_seconds = 0.0;          // of the full trials that gave the entries
  double seconds_per_run = 0.0;

  /// Time for one trial of every row, s.
  [[nodiscard]] double seconds_per_trial() const {
    return seconds_per_run * static_cast<double>(dynamics::runs_per_trial(space));
  }
};

/// One kind of matrix, with its bins and trials per row, and the predictions of such matrices.
struct ChainPoint : ChainAnswers {
  std::size_t curve = 0;
  std::int64_t trials = 0;     // per row
  double build_seconds = 0.0;  // one matrix, including the trials that show where rows start

  /// Time of one matrix and one prediction from start number `start`, s.
  [[nodiscard]] double seconds(std::size_t start) const {
    return build_seconds + answers[start].exact_seconds;
  }
  [[nodiscard]] double error(std::size_t start) const {
    return answers[start].exact.total_variation;
  }
};

/// Direct simulation with n trials, drawn from the truth; errors are those of as_against_exact(n).
struct DirectSimulation {
  std::int64_t trials = 0;
  double seconds = 0.0;
  FinalGateError drawn;    // mean over many draws
  FinalGateError formula;  // expected_total_variation and the noise floor
};

/// Predictions from one start by trees, each from its own trials, with an accuracy asked for; means
/// over kTreePredictions predictions.
struct TreePoint {
  double accuracy = 0.0, gate_runs = 0.0, states = 0.0;
  double seconds = 0.0;  // of runs, chain and error bar
  FinalGateError error;
  double error_95 = 0.0;  // the error bar of the predictions: total variation
};

// ---- The chart ----

/// The accuracies asked of trees, within the limit of runs, and the number of predictions for each.
inline constexpr std::array<double, 4> kTreeAccuracies{0.1, 0.05, 0.02, 0.01};
inline constexpr std::int64_t kTreePredictions = 4;

/// Trials per row that are charted, within the limit of runs.
inline constexpr std::array<std::int64_t, 10> kChainTrials{10,  20,   50,   100,  200,
                                                           500, 1000, 2000, 5000, 10'000};

/// What is to be charted.
struct ChainErrorOptions {
  std::vector<dynamics::Entry> starts;
  std::vector<double> factors{0.5, 1.0, 2.0,
                              4.0};     // bins per axis, as a multiple of the usual number
  std::int64_t truth_trials = 100'000;  // of the full dynamics, per start
  std::int64_t runs_limit = 1'000'000;  // most gate runs for one matrix or tree
  /// Full trials per start whose entries give the starts of rows, on additional curves. Bins made
  /// from entries always start so, by default from kPilotTrials.
  std::optional<std::int64_t> visited{};
  std::uint64_t seed = 1;
};

/// The curves to be charted.
struct ChainErrorPlan {
  ChainErrorOptions options;
  BinsChoice bins{};
  std::int64_t pilot_trials = 0;  // per start; 0: no pilot
  std::vector<ChainCurve> curves{};
  dynamics::Health health{};  // of the pilot that bins were made from

  /// True if not a single matrix is within the limit of runs.
  [[nodiscard]] bool empty() const;
};
/// Plans the curves by factor, those with uniform starts first. Runs the pilot if bins are made
/// from one. Throws std::invalid_argument for a start inside the gate, and for a factor that gives
/// no state or too many; InvalidParameter as dynamics::table3_space.
[[nodiscard]] ChainErrorPlan plan_chain_error(const Scene& scene, const ChainErrorOptions& options,
                                              const dynamics::Work& work = {});

/// The results of a plan, with the health of all runs.
struct ChainErrorChart : ChainErrorPlan {
  std::vector<FieldTruth> truths{};                     // by start
  std::vector<ChainPoint> points{};                     // by curve, then trials
  std::vector<std::vector<TreePoint>> trees{};          // by start, then accuracy
  std::vector<std::vector<DirectSimulation>> direct{};  // by start
};
/// Carries out a plan. Only the times depend on the number of threads. Throws std::invalid_argument
/// for an empty plan, and std::runtime_error if a run broke.
[[nodiscard]] ChainErrorChart chart_chain_error(const Scene& scene, ChainErrorPlan plan,
                                                const dynamics::Work& work = {});

// ---- What it comes to ----

/// Points with at most this multiple of the smallest error count as equally good.
inline constexpr double kNearBest = 1.5;

/// Summary for one start; points are indices in the chart. "The chain" is the one with uniform
/// starts (or with bins made from entries).
struct ChainSummary {
  static constexpr double kNever = std::numeric_limits<double>::infinity();
  std::size_t best = 0;       // smallest error
  std::size_t cheapest = 0;   // the cheapest point within kNearBest of the smallest error
  double pays_from = kNever;  // s, the lowest cost at which no direct simulation is as good
  double pays_until = 0.0;    // s, from this cost on direct simulation is better than any point
  /// Number of predictions from which on `cheapest` costs less than direct simulation.
  double starts_to_pay = kNever;
  std::optional<std::size_t> best_visited{};  // smallest error with rows that start as bodies enter
};
[[nodiscard]] ChainSummary summary_of(const ChainErrorChart& chart, std::size_t start);

}  // namespace gatewalk::lattice
