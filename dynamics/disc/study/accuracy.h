// SPDX-License-Identifier: MIT
#pragma once
/// The error of a method on a scene: its trials compared with those of a reference under the same
/// noise.
///
/// Trial number i has the same random force for every method (common random numbers), so runs are
/// compared one by one. There are two kinds of error:
/// - weak: the error of the distribution of outcomes, as total variation;
/// - strong: the error of single trials. Two hits may be microseconds apart, and their order
///   decides between two ways. A trial that took another way than the reference has parted, and its
///   error counts as infinite.

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dynamics/base/work.h"
#include "dynamics/disc/disc_section.h"
#include "dynamics/disc/study/verdict.h"

namespace gatewalk::dynamics {

struct Stage;  // base/kept_pieces.h

// ---- Settings ----

/// A method with the value of the one key that trades its speed for accuracy.
struct Setting {
  std::string method;
  std::string_view key;  // "run.step_s" or "run.event_tolerance_m"
  double value = 0.0;
  bool usual = false;  // the default of a scene

  [[nodiscard]] GateParams applied_to(GateParams p) const;
  [[nodiscard]] const char* unit() const;  // "s" or "m"
  [[nodiscard]] std::string name() const;  // "stable 0.02 s"
  bool operator==(const Setting&) const = default;
};

/// The methods that have a list of settings, in the order of a chart.
[[nodiscard]] std::span<const std::string_view> chart_methods();

/// The settings of a method, from coarse to fine: steps hold/n, n = 1, 2, 3, 4, 5, 8, 10, 20 for
/// methods with a fixed step (`moreau` also 40); tolerances 0.3 to 1e-4 units of length (Scale) for
/// `event`. Throws std::invalid_argument for another name.
[[nodiscard]] std::vector<Setting> chart_settings(std::string_view method, const GateParams& p);

/// The reference setting: `event` at 1e-7 units of length (Scale).
[[nodiscard]] Setting reference_setting(const GateParams& p);
/// The second reference setting, ten times coarser: its error shows how accurate the first one is.
[[nodiscard]] Setting second_reference_setting(const GateParams& p);

// ---- Trials ----

/// The end of one trial.
struct TrialEnd {
  /// The outcome, for comparison with another run's. Equal deflections (to the last bit) count as
  /// `traversed_right`, because they are not an outcome of their own.
  Outcome outcome = Outcome::broken;
  int column = 0;  // state of the next entry; trapped(); or trapped() + 1: broken
  BodyState exit;
  double seconds = 0.0;
};
[[nodiscard]] TrialEnd end_of(const GateParams& p, const StateSpace& space, const GateRun& run);

struct TrialEnds {
  std::vector<TrialEnd> trials;
  Health health;
  std::int64_t out_of_work = 0;  // runs that reached the limit of work

  [[nodiscard]] Verdict verdict() const;
};

/// The limit of steps or evaluations for one trial: over a hundred times those of the most
/// expensive setting in the paper's scenes.
inline constexpr std::int64_t kMostWork = 50'000'000;

/// The share of runs with a fault above which a setting fails.
inline constexpr double kPermittedFaults = 0.01;

/// Runs the trials of `range` and appends their ends, on all threads of the current TBB arena; the
/// results are the same for any number of threads. Throws InvalidParameter for a scene that cannot
/// be simulated.
void add_trial_ends(TrialEnds& ends, const GateParams& p, const BodyState& start,
                    std::uint64_t seed, TrialRange range, std::int64_t most_work = kMostWork);

// ---- Errors ----

/// The total variation between the outcomes of the same trials by two methods.
struct WeakError {
  double total_variation = 0.0;
  /// Standard error from the spread of the paired differences. It is too small where chance decides
  /// which columns count as too high.
  double standard_error = std::numeric_limits<double>::quiet_NaN();
  /// Expected total variation if the trials that changed columns had done so at random, equally
  /// likely in both directions.
  double chance = 0.0;
  std::int64_t changed = 0;  // trials that ended in another column
};
[[nodiscard]] WeakError outcome_error(std::span<const TrialEnd> run,
                                      std::span<const TrialEnd> reference);
/// The weak error for trials from several starts, one part of the trials each: the mean over the
/// parts, weighted by their trials. Over all trials together, errors of two starts can cancel:
/// moreau at 0.005 s on scenes/field.toml shows 0.004, but 0.013 from one of 9 starts.
[[nodiscard]] WeakError outcome_error(std::span<const TrialEnd> run,
                                      std::span<const TrialEnd> reference,
                                      std::span<const TrialRange> parts);
/// The weak error over the columns of the transition matrix, with one more for broken runs.
[[nodiscard]] WeakError column_error(std::span<const TrialEnd> run,
                                     std::span<const TrialEnd> reference, const StateSpace& space);

/// A pair of trials has parted if its outcomes differ, if it ends further apart than these limits
/// (in units of time and length, see Scale), or if a trial broke.
inline constexpr double kPartedTime = 0.05;
inline constexpr double kPartedLength = 1.0;

/// The strong error: median distances at the exit over the trials that left the gate in at least
/// one of both runs. Parted trials count as infinitely far, so a median grows as more trials part.
/// NaN if half or more have parted.
struct StrongError {
  std::int64_t compared = 0;  // pairs that have not parted
  std::int64_t parted = 0;
  std::int64_t trapped = 0;  // trapped in both runs, so there is no exit to compare
  double position = std::numeric_limits<double>::quiet_NaN();  // m
  double velocity = std::numeric_limits<double>::quiet_NaN();  // m/s
  double time = std::numeric_limits<double>::quiet_NaN();      // s
  double energy = std::numeric_limits<double>::quiet_NaN();    // J, kinetic

  [[nodiscard]] double parted_share() const {
    const std::int64_t left = compared + parted;
    return left > 0 ? static_cast<double>(parted) / static_cast<double>(left) : 0.0;
  }
};
[[nodiscard]] StrongError strong_error(const GateParams& p, std::span<const TrialEnd> run,
                                       std::span<const TrialEnd> reference);

// ---- A check by a better method ----

/// The scene with a better method, to check the scene's own. `event` at its default checks
/// `stable`. `stable` at its default checks other methods, or `event` does if `stable` refuses the
/// scene. `event` itself is checked with a tenth of its tolerance (at least 1e-13 radii). A method
/// whose better methods refuse the scene is checked with half its step.
[[nodiscard]] GateParams checking_setting(const GateParams& p);

/// The number of `trials` to check: enough to see an error of a few per cent, without multiplying
/// the work.
[[nodiscard]] inline std::int64_t check_sample(std::int64_t trials) {
  return std::clamp<std::int64_t>(trials / 5, std::min<std::int64_t>(trials, 100), 1000);
}

/// Checks a method's outcomes. Runs `trials` trials, divided evenly over `starts`, with the scene's
/// setting and with the checking setting under the same noise, and writes into `health` the total
/// variation of their outcomes less two standard errors. Faults within a run (overlap, energy) do
/// not show that a method is wrong for an elastic or undamped scene, and half the step may be
/// equally wrong.
///
/// Runs on all threads of the current TBB arena, with the same result for any number of them; a
/// part of a divided run does nothing. Throws InvalidParameter.
void check_outcomes(Health& health, const GateParams& p, std::span<const BodyState> starts,
                    std::uint64_t seed, std::int64_t trials, const Work& work = {});

/// Runs the trials of a stage from one start and checks a sample of them (check_sample,
/// check_outcomes). Throws InvalidParameter.
[[nodiscard]] GateTally run_checked_trials(const GateParams& p, const BodyState& start,
                                           std::uint64_t seed, const Stage& stage,
                                           const Work& work = {});

/// The trials of start i when `trials` are divided evenly over `starts` starts.
[[nodiscard]] TrialRange share_of(std::int64_t trials, std::size_t i, std::size_t starts);
/// An upper bound of one standard error of a paired total variation. A trial that changed moves the
/// total variation by at most 1/n, so the spread is at most sqrt(changed)/n. (The paired standard
/// error is smaller, and zero if changes happen to cancel.) If no trial changed, the bound is
/// 1.84/n: a share this large would show no change in n trials one time in six, as often as one
/// standard error is exceeded.
[[nodiscard]] double uncertainty_of(const WeakError& e, std::int64_t trials);

/// An error can be shown only above this multiple of the reference's own error.
inline constexpr double kReferenceMargin = 10.0;

/// The smallest total variation that can be shown: kReferenceMargin times the largest of the
/// reference's own error, the error that chance makes of its own changes, and one trial.
[[nodiscard]] double weak_limit(const WeakError& own, std::int64_t trials);

}  // namespace gatewalk::dynamics
