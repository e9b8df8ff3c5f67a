// SPDX-License-Identifier: MIT
#include "dynamics/disc/study/work_precision.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

#include "dynamics/disc/runs.h"

namespace gatewalk::dynamics {
namespace {

constexpr double kSamePlace = 1e-9;        // of R: nearer positions differ by rounding only
constexpr double kChances = 2.0;           // an error stands out above this multiple of chance
constexpr double kTimedSeconds = 0.1;      // timed trials take this long at the usual setting
constexpr std::int64_t kLeastTimed = 500;  // least number of timed trials of slower settings
constexpr double kLookUp = 0.2;            // s, between two progress reports during timing

double per_run(std::int64_t n, const Health& h) {
  return h.runs > 0 ? static_cast<double>(n) / static_cast<double>(h.runs)
                    : std::numeric_limits<double>::quiet_NaN();
}

/// Time of trials 0 .. n - 1 on this thread; of fewer trials, at least `least`, once these take
/// kTimedSeconds.
struct Timed {
  std::int64_t trials = 0;
  double seconds = 0.0;
};

/// Makes the study.
class Charting {
 public:
  Charting(const GateParams& p, const BodyState& start, const WorkPrecisionOptions& options,
           const Work& work)
      : start_(start), options_(options), work_(work), space_(table3_space(p)) {
    chart_.label = options.label;
    chart_.params = p;
    chart_.trials = options.trials;
  }

  WorkPrecision made() {
    const TrialEnds reference = run_reference();
    bool other_charted = false;
    for (const std::string& method : options_.methods)
      for (const Setting& setting : chart_settings(method, chart_.params)) {
        chart_.points.push_back(point_of(setting, reference));
        const ChartPoint& point = chart_.points.back();
        if (!point.ran() || !(setting == chart_.reference.other_method)) continue;
        chart_.reference.other = point.errors;
        other_charted = true;
      }
    if (!other_charted)
      chart_.reference.other = point_of(chart_.reference.other_method, reference).errors;
    time_settings();
    return std::move(chart_);
  }

 private:
  TrialEnds run(const Setting& s) const {
    const GateParams p = s.applied_to(chart_.params);
    (void)make_method(p);  // refuses the scene before any work
    TrialEnds ends;
    work_.in_pieces(chart_.label + ", " + s.name(), chart_.trials, [&](TrialRange range) {
      add_trial_ends(ends, p, start_, options_.seed, range);
    });
    return ends;
  }

  [[nodiscard]] Errors errors_of(const TrialEnds& run, const TrialEnds& reference) const {
    return {outcome_error(run.trials, reference.trials),
            column_error(run.trials, reference.trials, space_),
            strong_error(chart_.params, run.trials, reference.trials)};
  }

  TrialEnds run_reference() {
    Reference& r = chart_.reference;
    r.setting = reference_setting(chart_.params);
    r.second = second_reference_setting(chart_.params);
    r.other_method = chart_settings("stable", chart_.params).back();
    TrialEnds ends = run(r.setting);
    r.verdict = ends.verdict();
    r.evaluations_per_trial = per_run(ends.health.evaluations, ends.health);
    for (const TrialEnd& end : ends.trials) ++r.outcomes[static_cast<std::size_t>(end.outcome)];
    r.own = errors_of(run(r.second), ends);
    return ends;
  }

  ChartPoint point_of(const Setting& setting, const TrialEnds& reference) const {
    ChartPoint point;
    point.setting = setting;
    try {
      const TrialEnds ends = run(setting);
      point.verdict = ends.verdict();
      point.health = ends.health;
      point.out_of_work = ends.out_of_work;
      point.errors = errors_of(ends, reference);
    } catch (const InvalidParameter& e) {
      point.refusal = e.what();
      point.errors.outcomes.total_variation = std::numeric_limits<double>::quiet_NaN();
    }
    return point;
  }

  Timed time_trials(const Setting& s, std::int64_t n, std::int64_t least,
                    const std::function<void()>& look_up) const {
    const GateParams p = s.applied_to(chart_.params);
    const auto method = make_method(p);
    Timed timed;
    double next_look = kLookUp;
    const Stopwatch watch;
    carry_out(
        p, *method,
        [&](RunSlot& slot, const GateRun*) {
          timed.seconds = watch.seconds();
          const bool enough = timed.seconds >= kTimedSeconds && timed.trials >= least;
          if (timed.trials == n || enough) return false;
          if (timed.seconds >= next_look) {
            look_up();
            next_look = timed.seconds + kLookUp;
          }
          slot.start = start_;
          slot.force = gate_force(p, options_.seed, timed.trials++);
          return true;
        },
        kMostWork);
    return timed;
  }

  /// Times every setting once per round, so that noise of the machine affects all settings alike.
  /// The first round is a warm-up and is dropped.
  void time_settings() {
    const ChartPoint* pace = nullptr;  // `stable` at its default, or any setting that ran
    for (const ChartPoint& point : chart_.points)
      if (point.ran() &&
          (pace == nullptr || (point.setting.usual && point.setting.method == "stable")))
        pace = &point;
    if (pace == nullptr) return;
    const std::string what = chart_.label + ", times";
    const auto settings = static_cast<std::int64_t>(chart_.points.size());
    const std::int64_t total = (options_.rounds + 1) * settings;
    std::int64_t done = 0;
    const auto look_up = [&] { work_.tell(what, done, total); };
    chart_.timed_trials = time_trials(pace->setting, chart_.trials, 1, look_up).trials;
    for (std::int64_t round = 0; round <= options_.rounds; ++round)
      for (ChartPoint& point : chart_.points) {
        look_up();
        if (point.ran()) {
          const Timed timed = time_trials(point.setting, chart_.timed_trials, kLeastTimed, look_up);
          if (round > 0)
            point.microseconds.push_back(1e6 * timed.seconds / static_cast<double>(timed.trials));
        }
        ++done;
      }
    look_up();
  }

  const BodyState& start_;
  const WorkPrecisionOptions& options_;
  const Work& work_;
  const StateSpace space_;
  WorkPrecision chart_;
};

}  // namespace

// ---- One setting ----

double ChartPoint::least_microseconds() const {
  return microseconds.empty() ? std::numeric_limits<double>::quiet_NaN()
                              : *std::min_element(microseconds.begin(), microseconds.end());
}
double ChartPoint::median_microseconds() const {
  if (microseconds.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::vector<double> sorted = microseconds;
  std::sort(sorted.begin(), sorted.end());
  return 0.5 * (sorted[(sorted.size() - 1) / 2] + sorted[sorted.size() / 2]);
}
double ChartPoint::steps_per_trial() const { return per_run(health.steps, health); }
double ChartPoint::evaluations_per_trial() const { return per_run(health.evaluations, health); }

// ---- Limits of what can be shown ----

double WorkPrecision::outcome_limit() const { return weak_limit(reference.own.outcomes, trials); }
double WorkPrecision::column_limit() const { return weak_limit(reference.own.columns, trials); }

double WorkPrecision::strong_limit(double StrongError::*median) const {
  const StrongError& own = reference.own.strong;
  if (std::isfinite(own.*median)) return kReferenceMargin * own.*median;
  return own.parted > 0 ? std::numeric_limits<double>::infinity() : 0.0;
}
double WorkPrecision::position_limit() const {
  return std::max(strong_limit(&StrongError::position), kSamePlace * params.body.radius);
}

double WorkPrecision::outcome_bound(const Errors& e) const {
  return std::max(outcome_limit(), kChances * e.outcomes.chance);
}
double WorkPrecision::column_bound(const Errors& e) const {
  return std::max(column_limit(), kChances * e.columns.chance);
}

const ChartPoint* WorkPrecision::cheapest() const {
  const ChartPoint* best = nullptr;
  for (const ChartPoint& p : points) {
    const double most = std::max(p.errors.outcomes.total_variation, outcome_bound(p.errors));
    if (p.verdict != Verdict::fine || !(most <= params.run.tolerance)) continue;
    if (best == nullptr || p.least_microseconds() < best->least_microseconds()) best = &p;
  }
  return best;
}

// ---- The whole study ----

void require_reference(const GateParams& p) {
  (void)table3_space(p);
  for (const Setting& s : {reference_setting(p), second_reference_setting(p)})
    (void)make_method(s.applied_to(p));
}

WorkPrecision work_precision(const GateParams& p, const BodyState& start,
                             const WorkPrecisionOptions& options, const Work& work) {
  if (options.trials < 1) throw std::invalid_argument("work_precision: no trials");
  return Charting(p, start, options, work).made();
}

}  // namespace gatewalk::dynamics
