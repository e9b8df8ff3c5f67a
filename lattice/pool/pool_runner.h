// SPDX-License-Identifier: MIT
#pragma once
/// Runs trials, adds them to a pool, and counts them.

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "dynamics/base/work.h"
#include "lattice/field/problem.h"
#include "lattice/field/rqmc_trials.h"
#include "lattice/pool/run_pool.h"
#include "lattice/statistics/group_spread.h"

namespace gatewalk::lattice {

/// A range of entries through one face, from which starts are drawn.
using StartRange = dynamics::StateRange;

/// Runs trials for a pool, up to a limit of gate runs.
class PoolRunner {
 public:
  static constexpr std::int64_t kLeastTrials = 2 * kTrialGroups;  // per call

  /// Trials get numbers that no other command uses with this seed. About `most_runs` gate runs are
  /// made, except that each call makes its minimum.
  PoolRunner(const Problem& problem, std::uint64_t seed, std::int64_t most_runs,
             const dynamics::Work& work);

  /// Least number of full trials per call whose noise comes from evenly spread points in all gates
  /// (rqmc_trials.h); `count` is then rounded up to arrays of equal size. In smaller calls, points
  /// set the noise of the first passages from a start only. Cells must permit it
  /// (Cell::lays_noise).
  static constexpr std::int64_t kLeastEven = 4096;

  /// Runs full trials from the start; runs through its first gate only; or full trials from
  /// anywhere in a range. At least kLeastTrials are run. Throws std::runtime_error if a run broke.
  void run_full(OwnRuns& s, std::int64_t count);
  void run_first(OwnRuns& s, std::int64_t count);
  void run_scattered(RangeRuns& s, const StartRange& starts, std::int64_t count);
  /// Start number `i`, drawn uniformly from the range.
  [[nodiscard]] dynamics::Entry drawn(const StartRange& starts, std::int64_t i) const;

  [[nodiscard]] std::int64_t runs_left() const { return most_runs_ - gate_runs; }
  [[nodiscard]] bool may_go_on() const { return runs_left() > 0; }
  /// Mean number of gate runs per full trial so far.
  [[nodiscard]] double gates_per_trial() const {
    return trials_ > 0 ? static_cast<double>(trial_runs_) / static_cast<double>(trials_) : 1.0;
  }
  [[nodiscard]] double seconds_per_gate_run() const {
    return seconds / static_cast<double>(std::max<std::int64_t>(1, gate_runs));
  }
  /// Runs a sample again by a better method (Problem::check).
  void finish();

  std::int64_t gate_runs = 0;
  double seconds = 0.0;
  dynamics::Health health;
  /// Most trials per array at once; larger calls run in several batches, to limit memory.
  std::int64_t most_of_array = std::int64_t{1} << 14;

 private:
  /// A kind of trials.
  struct Begun {
    const char* what;
    bool through_field;
    std::int64_t numbers;  // added to a trial's number to name the trial's stream
    std::function<dynamics::Entry(std::int64_t i)> start;
    bool alike;  // all trials have the same start
  };
  void run(const Begun& begun, std::int64_t count, FieldTrials& all);
  void run_plain(const Begun& begun, std::int64_t count, FieldTrials& all);
  void run_even(const Begun& begun, std::int64_t count, FieldTrials& all);
  void count(const Begun& begun, const FieldTally& tally);
  [[nodiscard]] std::optional<FirstPoints> points_of(const Begun& begun) const;

  const Problem& problem_;
  std::uint64_t seed_;
  std::int64_t most_runs_;
  const dynamics::Work& work_;
  bool lays_noise_;
  std::int64_t trials_ = 0, trial_runs_ = 0;  // of full trials
};

}  // namespace gatewalk::lattice
