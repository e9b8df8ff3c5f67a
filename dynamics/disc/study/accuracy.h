// SPDX-License-Identifier: MIT
#pragma once
/// How wrong a method is on a scene: its trials against those of a reference under the same noise.
///
/// Trial number i draws the same random force whatever the method (common random numbers), so runs
/// are compared one by one. Two kinds of error:
/// - weak: how far the distribution of outcomes is off, as total variation;
/// - strong: how far single trials are off. Two hits may be microseconds apart and which comes
/// first
///   decides the branch: a trial that took another one has parted, which counts as infinitely far.

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

/// One method with the one number that trades its speed for its accuracy.
struct Setting {
  std::string method;
  std::string_view key;  // "run.step_s" or "run.event_tolerance_m"
  double value = 0.0;
  bool usual = false;  // what a scene gets that says nothing

  [[nodiscard]] GateParams applied_to(GateParams p) const;
  [[nodiscard]] const char* unit() const;  // "s" or "m"
  [[nodiscard]] std::string name() const;  // "stable 0.02 s"
  bool operator==(const Setting&) const = default;
};

/// Methods that have a list of settings, in the order of a chart.
[[nodiscard]] std::span<const std::string_view> chart_methods();

/// Steps hold/n, n = 1, 2, 3, 4, 5, 8, 10, 20, for the methods with a fixed step, and 40 for
/// `moreau`; tolerances 0.3 to 1e-4 units of length (Scale) for `event`. From coarse to fine.
/// Throws std::invalid_argument for another name.
[[nodiscard]] std::vector<Setting> chart_settings(std::string_view method, const GateParams& p);

/// What everything is compared with, `event` at 1e-7 units of length (Scale), and the same ten
/// times coarser, which shows how far the first can be trusted.
[[nodiscard]] Setting reference_setting(const GateParams& p);
[[nodiscard]] Setting second_reference_setting(const GateParams& p);

// ---- Trials ----

/// What one trial leaves behind.
struct TrialEnd {
  /// Compared with another run's: deflections that are equal to the last bit count as
  /// `traversed_right`, for they are no outcome of its own.
  Outcome outcome = Outcome::broken;
  int column = 0;  // state in which it enters the next gate, trapped() or, broken, trapped() + 1
  BodyState exit;
  double seconds = 0.0;
};
[[nodiscard]] TrialEnd end_of(const GateParams& p, const StateSpace& space, const GateRun& run);

struct TrialEnds {
  std::vector<TrialEnd> trials;
  Health health;
  std::int64_t out_of_work = 0;  // runs that took more than was granted

  [[nodiscard]] Verdict verdict() const;
};

/// Steps or evaluations granted to one trial: over a hundred times what the dearest setting of the
/// paper's scenes takes.
inline constexpr std::int64_t kMostWork = 50'000'000;

/// A fault in this share of the runs makes a setting a failure.
inline constexpr double kPermittedFaults = 0.01;

/// Appends trials `range`, on all threads of the current TBB arena; the same for any number of
/// them. Throws InvalidParameter for a scene that cannot be run.
void add_trial_ends(TrialEnds& ends, const GateParams& p, const BodyState& start,
                    std::uint64_t seed, TrialRange range, std::int64_t most_work = kMostWork);

// ---- Errors ----

/// Total variation between two histograms of the same trials.
struct WeakError {
  double total_variation = 0.0;
  /// Its own standard error, from the spread of the paired differences. Too small where chance
  /// decides which columns count as too high.
  double standard_error = std::numeric_limits<double>::quiet_NaN();
  /// What chance alone would show: the trials that changed columns, each as likely forth as back.
  double chance = 0.0;
  std::int64_t changed = 0;  // trials in another column
};
[[nodiscard]] WeakError outcome_error(std::span<const TrialEnd> run,
                                      std::span<const TrialEnd> reference);
/// For trials of several starts, one part of the trials each: the mean over the parts, weighted by
/// their trials. Of all trials together the errors of two starts can cancel: moreau at 0.005 s on
/// scenes/field.toml shows 0.004, but 0.013 from one of 9 starts.
[[nodiscard]] WeakError outcome_error(std::span<const TrialEnd> run,
                                      std::span<const TrialEnd> reference,
                                      std::span<const TrialRange> parts);
/// Over the columns of the transition matrix, and one for broken runs.
[[nodiscard]] WeakError column_error(std::span<const TrialEnd> run,
                                     std::span<const TrialEnd> reference, const StateSpace& space);

/// A pair of trials has parted when it ends in different ways, more than this apart (in units of
/// time and length, see Scale), or broken.
inline constexpr double kPartedTime = 0.05;
inline constexpr double kPartedLength = 1.0;

/// Distances at the exit: medians over the trials that left the gate in one run or both, parted
/// ones infinitely far, so that a median grows as more of them part. NaN when half or more have
/// parted.
struct StrongError {
  std::int64_t compared = 0;  // have not parted
  std::int64_t parted = 0;
  std::int64_t trapped = 0;  // in both: no exit, nothing to compare
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

/// By what a scene's method is checked: `event` at its default for `stable`, `stable` at its
/// default for the others, each the other where a method does not take the scene; `event` by itself
/// with a tenth of its tolerance (not below rounding), and so any other by itself with half its
/// step if neither takes the scene.
[[nodiscard]] GateParams checking_setting(const GateParams& p);

/// How many of `trials` to check: enough to see a few per cent, but no multiple of the work asked
/// for.
[[nodiscard]] inline std::int64_t check_sample(std::int64_t trials) {
  return std::clamp<std::int64_t>(trials / 5, std::min<std::int64_t>(trials, 100), 1000);
}

/// Runs `trials` trials, shared out evenly over `starts`, with the scene's setting and with the
/// checking one under the same noise, and puts into `health` what of their difference in outcomes
/// chance does not explain: total variation less two standard errors of it. Nothing that a run can
/// show of itself (overlap, energy) sees that a method is wrong for an elastic or undamped scene,
/// and half the step may be as wrong. On all threads of the current TBB arena, the same for any
/// number of them; not by a part of a run. Throws InvalidParameter.
void check_outcomes(Health& health, const GateParams& p, std::span<const BodyState> starts,
                    std::uint64_t seed, std::int64_t trials, const Work& work = {});

/// The trials of a stage from one start, a sample of them (check_sample) checked so. Throws
/// InvalidParameter.
[[nodiscard]] GateTally run_checked_trials(const GateParams& p, const BodyState& start,
                                           std::uint64_t seed, const Stage& stage,
                                           const Work& work = {});

/// The trials of start i among `trials` that are shared out evenly.
[[nodiscard]] TrialRange share_of(std::int64_t trials, std::size_t i, std::size_t starts);
/// One standard error of a total variation of paired trials, from above: a trial that changed moves
/// it by 1/n at most, so all spread it by sqrt(changed)/n at most. (The paired standard error is
/// smaller, and zero where changes happen to cancel.) Where no trial changed, the share that does
/// may be 1.84/n yet: then none of n is seen one time in six, as often as one standard error is
/// exceeded.
[[nodiscard]] double uncertainty_of(const WeakError& e, std::int64_t trials);

/// An error below this many times the reference's own cannot be shown.
inline constexpr double kReferenceMargin = 10.0;

/// What a total variation must reach to be shown: that margin over the reference's own, over what
/// chance makes of its own changes, and over one trial, the least that can be seen.
[[nodiscard]] double weak_limit(const WeakError& own, std::int64_t trials);

}  // namespace gatewalk::dynamics
