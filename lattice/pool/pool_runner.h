// SPDX-License-Identifier: MIT
#pragma once
/// Runs trials into a pool and keeps count.

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

/// Starts by one face, between these.
using StartRange = dynamics::StateRange;

class PoolRunner {
 public:
  static constexpr std::int64_t kLeastTrials = 2 * kTrialGroups;  // of a call

  /// Trials of the seed that no other command runs; no more are begun than `most_runs` gate runs
  /// would take, about, but for the least of a call.
  PoolRunner(const Problem& problem, std::uint64_t seed, std::int64_t most_runs,
             const dynamics::Work& work);

  /// Noise is laid by points where cells can do that (rqmc_trials.h): that of the first passages
  /// from a start, and in rounds of kLeastEven trials or more that of all. There `count` is rounded
  /// up, for arrays of one size.
  static constexpr std::int64_t kLeastEven = 4096;

  /// Full trials from the start; runs through its first gate only; trials from anywhere in a range.
  /// At least kLeastTrials are run whatever `count`. Throws std::runtime_error when a run broke.
  void run_full(OwnRuns& s, std::int64_t count);
  void run_first(OwnRuns& s, std::int64_t count);
  void run_scattered(RangeRuns& s, const StartRange& starts, std::int64_t count);
  /// Start number `i` in the range.
  [[nodiscard]] dynamics::Entry drawn(const StartRange& starts, std::int64_t i) const;

  [[nodiscard]] std::int64_t runs_left() const { return most_runs_ - gate_runs; }
  [[nodiscard]] bool may_go_on() const { return runs_left() > 0; }
  /// Gate runs of a trial through the field, in the mean of those so far.
  [[nodiscard]] double gates_per_trial() const {
    return trials_ > 0 ? static_cast<double>(trial_runs_) / static_cast<double>(trials_) : 1.0;
  }
  [[nodiscard]] double seconds_per_gate_run() const {
    return seconds / static_cast<double>(std::max<std::int64_t>(1, gate_runs));
  }
  /// Checks a sample by a better method.
  void finish();

  std::int64_t gate_runs = 0;
  double seconds = 0.0;
  dynamics::Health health;
  /// Larger rounds are several, one after the other: not all trials are in memory at once.
  std::int64_t most_of_array = std::int64_t{1} << 14;

 private:
  /// Trials that are begun.
  struct Begun {
    const char* what;
    bool through_field;
    std::int64_t numbers;  // added to a trial's number it names the trial's stream
    std::function<dynamics::Entry(std::int64_t i)> start;
    bool alike;  // the same for all
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
  std::int64_t trials_ = 0, trial_runs_ = 0;  // through the field
};

}  // namespace gatewalk::lattice
