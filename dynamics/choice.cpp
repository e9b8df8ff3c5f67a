#include "dynamics/choice.h"

#include <algorithm>
#include <optional>

namespace gatewalk::dynamics {
namespace {

constexpr std::int64_t kPilotTrials = 4000;  // standard error 0.001 when 1 trial in 250 changes
constexpr std::int64_t kCountTrials = 200;   // enough to count the work of a trial

struct Candidate {
  std::string_view method;
  double microseconds;  // per evaluation, measured on scenes/field.toml: only ratios matter
};
constexpr Candidate kCandidates[] = {{"stable", 0.05}, {"moreau", 0.05}, {"event", 0.13}};

TrialEnds pilot(const GateParams& p, std::span<const BodyState> starts, std::uint64_t seed,
                std::int64_t trials) {
  TrialEnds ends;
  const auto n = static_cast<std::int64_t>(starts.size());
  for (std::int64_t i = 0; i < n; ++i)
    add_trial_ends(ends, p, starts[static_cast<std::size_t>(i)], seed,
                   {trials * i / n, trials * (i + 1) / n - trials * i / n});
  return ends;
}

}  // namespace

Choice choose_method(const GateParams& p, std::span<const BodyState> starts, std::uint64_t seed) {
  Choice choice;
  choice.trials = kPilotTrials;
  std::vector<Choice::Tried> candidates;
  std::optional<InvalidParameter> refusal;
  for (const Candidate& c : kCandidates) {
    for (const Setting& setting : chart_settings(c.method, p)) {
      try {
        const TrialEnds ends = pilot(setting.applied_to(p), starts, seed, kCountTrials);
        const double evaluations =
            static_cast<double>(ends.health.evaluations) / static_cast<double>(kCountTrials);
        candidates.push_back({setting, c.microseconds * evaluations, {}, ends.verdict(), false});
      } catch (const InvalidParameter& e) {
        refusal = e;  // this method does not take the scene, another may
      }
    }
  }
  if (candidates.empty()) throw *refusal;
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const auto& a, const auto& b) { return a.work < b.work; });

  GateParams exact = p;
  exact.run.event_tolerance = 1e-5;
  exact.run.method = "event";
  std::optional<TrialEnds> reference;
  try {
    reference = pilot(exact, starts, seed, kPilotTrials);
  } catch (const InvalidParameter&) {
    // Beams too fast for `event`: the shortest step of `stable` has to do.
    exact.run.method = "stable";
    exact.run.step = 1.0 / (50.0 * p.forces.random_rate);
    reference = pilot(exact, starts, seed, kPilotTrials);
  }
  for (Choice::Tried& tried : candidates) {
    if (tried.verdict != Verdict::fine) continue;
    const TrialEnds ends = pilot(tried.setting.applied_to(p), starts, seed, kPilotTrials);
    tried.error = outcome_error(ends.trials, reference->trials);
    tried.verdict = ends.verdict();
    tried.fits = tried.verdict == Verdict::fine &&
                 tried.error.total_variation + tried.error.standard_error <= p.run.tolerance;
    choice.tried.push_back(tried);
    if (tried.fits) {
      choice.params = tried.setting.applied_to(p);
      choice.met = true;
      return choice;
    }
  }
  choice.params = exact;
  return choice;
}

}  // namespace gatewalk::dynamics
