// SPDX-License-Identifier: MIT
#include "dynamics/disc/study/choice.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

namespace gatewalk::dynamics {
namespace {

constexpr std::int64_t kLeastPilot = 4000;  // uncertainty 0.001 if 1 trial in 300 changes
constexpr double kPilotTolerances = 4.0;    // least trials * tolerance; see uncertainty_of
constexpr std::int64_t kCountTrials = 200;  // enough to measure the work of a trial

struct Candidate {
  std::string_view method;
  double microseconds;  // per evaluation, measured on scenes/field.toml; only ratios matter
};
constexpr Candidate kCandidates[] = {{"stable", 0.06}, {"moreau", 0.003}, {"event", 0.13}};

/// The ranges of the trials of each start.
std::vector<TrialRange> shares_of(std::int64_t trials, std::size_t starts) {
  std::vector<TrialRange> parts;
  for (std::size_t i = 0; i < starts; ++i) parts.push_back(share_of(trials, i, starts));
  return parts;
}

/// The common part of all pilots.
struct Pilots {
  const GateParams& p;
  std::span<const BodyState> starts;
  std::uint64_t seed;
  const PilotProgress& progress;

  [[nodiscard]] TrialEnds run(const Setting& setting, std::int64_t trials) const {
    constexpr std::int64_t kBlock = 500;  // trials between two reports
    const GateParams with = setting.applied_to(p);
    TrialEnds ends;
    std::int64_t done = 0;
    for (std::size_t i = 0; i < starts.size(); ++i) {
      const TrialRange all = share_of(trials, i, starts.size());
      for (std::int64_t first = all.first; first < all.first + all.count; first += kBlock) {
        const std::int64_t count = std::min(kBlock, all.first + all.count - first);
        add_trial_ends(ends, with, starts[i], seed, {first, count});
        done += count;
        if (progress) progress(setting, done, trials);
      }
    }
    return ends;
  }
};

/// Runs the pilot with the first of the reference settings that runs the scene without faults.
TrialEnds reference_pilot(const Pilots& pilots, Choice& choice) {
  const Setting settings[] = {{"event", "run.event_tolerance_m", 1e-5 * scale_of(pilots.p).length},
                              {"stable", "run.step_s", 1.0 / (50.0 * pilots.p.forces.random_rate)}};
  std::optional<TrialEnds> ends;
  std::string refusals;
  for (const Setting& setting : settings) {
    try {
      TrialEnds these = pilots.run(setting, choice.trials);
      if (ends && these.verdict() != Verdict::fine) continue;
      ends = std::move(these);
      choice.reference = setting;
      choice.reference_verdict = ends->verdict();
      if (choice.reference_verdict == Verdict::fine) break;
    } catch (const InvalidParameter& e) {
      refusals += std::string("; ") + e.what();
    }
  }
  if (!ends)
    throw InvalidParameter("run.method",
                           "run.method = \"auto\" is not permitted for this scene: no method is "
                           "exact enough to compare the others with" +
                               refusals);
  return std::move(*ends);
}

}  // namespace

Choice choose_method(const GateParams& p, std::span<const BodyState> starts, std::uint64_t seed,
                     const PilotProgress& progress) {
  validate(p);
  if (starts.empty()) throw std::invalid_argument("a method is chosen for one start or more");
  for (const BodyState& b : starts)
    if (!std::isfinite(b.x + b.y + b.vx + b.vy) || outside(p, b))
      throw std::invalid_argument("a start from which a method is chosen must lie inside the gate");

  const Pilots pilots{p, starts, seed, progress};
  Choice choice;
  const double wanted = std::ceil(kPilotTolerances / p.run.tolerance);
  choice.trials = std::max(kLeastPilot, static_cast<std::int64_t>(wanted));
  std::vector<Choice::Tried> candidates;
  std::optional<InvalidParameter> refusal;
  for (const Candidate& c : kCandidates) {
    for (const Setting& setting : chart_settings(c.method, p)) {
      try {
        const TrialEnds ends = pilots.run(setting, kCountTrials);
        Choice::Tried tried;
        tried.setting = setting;
        tried.work = c.microseconds * static_cast<double>(ends.health.evaluations) /
                     static_cast<double>(kCountTrials);
        tried.verdict = ends.verdict();
        candidates.push_back(tried);
      } catch (const InvalidParameter& e) {
        refusal = e;  // another method may take the scene
      }
    }
  }
  if (candidates.empty()) throw *refusal;
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const auto& a, const auto& b) { return a.work < b.work; });

  const TrialEnds reference = reference_pilot(pilots, choice);
  const std::vector<TrialRange> parts = shares_of(choice.trials, starts.size());
  for (Choice::Tried& tried : candidates) {
    if (choice.reference_verdict != Verdict::fine) break;
    if (tried.verdict == Verdict::fine) {
      const TrialEnds ends = pilots.run(tried.setting, choice.trials);
      tried.error = outcome_error(ends.trials, reference.trials, parts);
      tried.uncertainty = uncertainty_of(tried.error, choice.trials);
      tried.verdict = ends.verdict();
      tried.fits = tried.verdict == Verdict::fine &&
                   tried.error.total_variation + tried.uncertainty <= p.run.tolerance;
    }
    choice.tried.push_back(tried);
    if (tried.fits) {
      choice.params = tried.setting.applied_to(p);
      choice.met = true;
      return choice;
    }
  }
  choice.params = choice.reference.applied_to(p);
  return choice;
}

}  // namespace gatewalk::dynamics
