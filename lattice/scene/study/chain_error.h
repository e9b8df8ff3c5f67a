// SPDX-License-Identifier: MIT
#pragma once
/// The chain's error against its cost: matrices of coarser and finer bins and of few or many trials
/// a row, and trees, against the full dynamics, beside direct simulation at the same cost. All
/// seconds are CPU time of one thread.

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

/// One space of states, and one way to start the trials of its rows.
struct ChainCurve {
  double factor = 1.0;  // bins per axis, as a multiple of the usual ones
  dynamics::StateSpace space;
  bool visited = false;                // charted beside a curve of uniform starts
  dynamics::Entries entries{};         // where rows start, as bodies were seen to enter; empty:
                                       // uniform
  std::vector<std::int64_t> trials{};  // per row, those within the limit
  double pilot_seconds = 0.0;          // of the full trials that saw the entries
  double seconds_per_run = 0.0;

  /// Of one trial of every row.
  [[nodiscard]] double seconds_per_trial() const {
    return seconds_per_run * static_cast<double>(dynamics::runs_per_trial(space));
  }
};

/// One way to make a matrix, bins and trials per row, and what matrices made so say.
struct ChainPoint : ChainAnswers {
  std::size_t curve = 0;
  std::int64_t trials = 0;     // per row
  double build_seconds = 0.0;  // one matrix, with the trials that saw where its rows start

  /// One matrix and one prediction.
  [[nodiscard]] double seconds(std::size_t start) const {
    return build_seconds + answers[start].exact_seconds;
  }
  [[nodiscard]] double error(std::size_t start) const {
    return answers[start].exact.total_variation;
  }
};

/// Direct simulation with n trials, drawn from the truth; errors as_against_exact(n).
struct DirectSimulation {
  std::int64_t trials = 0;
  double seconds = 0.0;
  FinalGateError drawn;    // mean over many draws
  FinalGateError formula;  // expected_total_variation and the noise floor
};

/// Predictions of one start by trees, each with trials of its own, to an accuracy asked for; means
/// over kTreePredictions.
struct TreePoint {
  double accuracy = 0.0, gate_runs = 0.0, states = 0.0;
  double seconds = 0.0;  // of runs, chain and error bar
  FinalGateError error;
  double error_95 = 0.0;  // what they said: total variation
};

// ---- The chart ----

/// What trees are asked for, as far as the limit of runs allows, and how often.
inline constexpr std::array<double, 4> kTreeAccuracies{0.1, 0.05, 0.02, 0.01};
inline constexpr std::int64_t kTreePredictions = 4;

/// Trials per row that are charted, as far as the limit of runs allows.
inline constexpr std::array<std::int64_t, 10> kChainTrials{10,  20,   50,   100,  200,
                                                           500, 1000, 2000, 5000, 10'000};

struct ChainErrorOptions {
  std::vector<dynamics::Entry> starts;
  std::vector<double> factors{0.5, 1.0, 2.0,
                              4.0};     // bins per axis, as a multiple of the usual ones
  std::int64_t truth_trials = 100'000;  // of the full dynamics, per start
  std::int64_t runs_limit = 1'000'000;  // gate runs that one matrix or tree may take
  /// Full trials per start whose entries rows start from, on curves of their own. Rows of bins that
  /// are made from what is seen always start so; without a number, from kPilotTrials.
  std::optional<std::int64_t> visited{};
  std::uint64_t seed = 1;
};

/// What is to be charted.
struct ChainErrorPlan {
  ChainErrorOptions options;
  BinsChoice bins{};
  std::int64_t pilot_trials = 0;  // per start; 0: none
  std::vector<ChainCurve> curves{};
  dynamics::Health health{};  // of the pilot that bins were made from

  /// Not a single matrix within the limit of runs.
  [[nodiscard]] bool empty() const;
};
/// Curves by their factor, those of uniform starts first. Runs the pilot that bins are made from,
/// if they are. Throws std::invalid_argument for a start inside the gate and for a factor that
/// makes no state or too many; InvalidParameter as dynamics::table3_space.
[[nodiscard]] ChainErrorPlan plan_chain_error(const Scene& scene, const ChainErrorOptions& options,
                                              const dynamics::Work& work = {});

/// A plan carried out. Its health is that of all runs.
struct ChainErrorChart : ChainErrorPlan {
  std::vector<FieldTruth> truths{};                     // by start
  std::vector<ChainPoint> points{};                     // by curve, then trials
  std::vector<std::vector<TreePoint>> trees{};          // by start, then accuracy
  std::vector<std::vector<DirectSimulation>> direct{};  // by start
};
/// All but the times is the same on any number of threads. Throws std::invalid_argument for an
/// empty plan, and std::runtime_error when a run broke.
[[nodiscard]] ChainErrorChart chart_chain_error(const Scene& scene, ChainErrorPlan plan,
                                                const dynamics::Work& work = {});

// ---- What it comes to ----

/// Points this near to the smallest error, as a multiple of it, are as good.
inline constexpr double kNearBest = 1.5;

/// For one start; points by their place in the chart. The chain is the one of uniform starts (or of
/// bins that are made from what is seen).
struct ChainSummary {
  static constexpr double kNever = std::numeric_limits<double>::infinity();
  std::size_t best = 0;           // smallest error
  std::size_t cheapest = 0;       // cheapest within kNearBest of it
  double pays_from = kNever;      // s, the first cost at which no direct simulation is as good
  double pays_until = 0.0;        // s, from here on direct simulation is better than any point
  double starts_to_pay = kNever;  // predictions for which `cheapest` costs less than direct
                                  // simulation
  std::optional<std::size_t> best_visited{};  // smallest error with rows started as bodies enter
};
[[nodiscard]] ChainSummary summary_of(const ChainErrorChart& chart, std::size_t start);

}  // namespace gatewalk::lattice
