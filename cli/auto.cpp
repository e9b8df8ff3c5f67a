#include "cli/auto.h"

#include "cli/report.h"

namespace gatewalk::cli {
namespace {

/// The scene's start, and the middles of eight bins spread over the state space.
std::vector<dynamics::BodyState> starts_of(const Scene& scene, RunsFrom from) {
  std::vector<dynamics::BodyState> starts{scene.start};
  if (from == RunsFrom::start) return starts;
  const auto space = dynamics::StateSpace::paper(scene.gate);
  for (int i = 0; i < 8; ++i) {
    const dynamics::Cell c = space.cell(i * (space.size() - 1) / 7);
    const auto middle = [](const std::array<double, 2>& edges) { return 0.5 * (edges[0] + edges[1]); };
    starts.push_back(dynamics::entry_state(
        scene.gate, {c.boundary, middle(c.d), middle(c.vx), middle(c.vy)}));
  }
  return starts;
}

}  // namespace

Json settle_method(const Options& options, Scene& scene, RunsFrom from) {
  if (scene.gate.run.method != "auto") return nullptr;
  const double tolerance = scene.gate.run.tolerance;
  const auto starts = starts_of(scene, from);
  const dynamics::Choice choice = dynamics::choose_method(scene.gate, starts, options.seed());
  scene.gate = choice.params;

  Json settled;
  settled["asked"] = "auto";
  settled["tolerance"] = tolerance;
  settled["method"] = scene.gate.run.method;
  settled["step_s"] = scene.gate.run.step;
  settled["event_tolerance_m"] = scene.gate.run.event_tolerance;
  settled["met"] = choice.met;
  settled["pilot_trials"] = choice.trials;
  settled["tried"] = Json::array();
  for (const auto& t : choice.tried)
    settled["tried"].push_back({{"method", t.setting.method},
                                {"key", t.setting.key},
                                {"value", t.setting.value},
                                {"verdict", dynamics::name_of(t.verdict)},
                                {"outcome_total_variation", t.error.total_variation},
                                {"standard_error", t.error.standard_error},
                                {"work_per_trial", t.work}});
  if (!choice.met)
    warn("run.method \"auto\": no setting was shown to keep the outcomes within run.tolerance = " +
         fixed(tolerance, 4) + "; took " + scene.gate.run.method + " at its finest");
  return settled;
}

std::string method_line(const Json& settled) {
  if (settled.is_null()) return "";
  const bool event = settled["method"] == "event";
  std::string text = "method " + settled["method"].get<std::string>() +
                     (event ? ", run.event_tolerance_m = " + settled["event_tolerance_m"].dump()
                            : ", run.step_s = " + settled["step_s"].dump()) +
                     ": chosen on " + settled["pilot_trials"].dump() + " pilot trials";
  if (settled["met"].get<bool>()) {
    const Json& last = settled["tried"].back();
    text += ", outcomes off by " + fixed(last["outcome_total_variation"].get<double>(), 4) +
            " (total variation, s.e. " + fixed(last["standard_error"].get<double>(), 4) + ")";
  }
  return text + "\n";
}

}  // namespace gatewalk::cli
