#include "cli/auto.h"

#include <algorithm>
#include <optional>
#include <sstream>

#include "cli/bins.h"
#include "cli/render/report.h"
#include "cli/terminal/interrupt.h"
#include "cli/terminal/progress.h"

namespace gatewalk::cli {
namespace {

/// The scene's start, and the middles of eight bins spread over the state space.
std::vector<dynamics::BodyState> pilot_starts(const lattice::Scene& scene, RunsFrom from) {
  std::vector<dynamics::BodyState> starts{scene.start};
  if (from == RunsFrom::start) return starts;
  const auto space = fixed_space(scene);
  for (int i = 0; i < 8; ++i) {
    const dynamics::Cell c = space.cell(i * (space.size() - 1) / 7);
    const auto middle = [](const std::array<double, 2>& edges) {
      return 0.5 * (edges[0] + edges[1]);
    };
    starts.push_back(
        dynamics::entry_state(scene.gate, {c.boundary, middle(c.d), middle(c.vx), middle(c.vy)}));
  }
  return starts;
}

/// Keys that the user gave and the method does not look at.
void warn_unused(const lattice::Scene& scene) {
  const std::string& method = scene.gate.run.method;
  const auto unused = [&](const char* key, bool used, const std::string& why) {
    if (!used && scene.named.contains(key)) warn(std::string(key) + " has no effect: " + why);
  };
  if (!scene.sweep.empty())
    warn("the table [sweep] of " + scene.source + " has no effect here: gatewalk sweep runs it");
  const std::string says = "run.method = \"" + method + "\" ";
  const bool chosen = method == "auto", event = method == "event";
  unused("run.step_s", !chosen && !event, says + (chosen ? "chooses it" : "has no step"));
  unused("run.event_tolerance_m", event, says + (chosen ? "chooses it" : "does not use it"));
}

/// What the scene leaves out and has been given by its own proportions.
void tell_derived(const Options& options, const lattice::Scene& scene) {
  std::string all;
  for (const lattice::KeyInfo& k : lattice::describe(scene)) {
    const bool methods_own = k.key == "run.step_s" || k.key == "run.event_tolerance_m" ||
                             k.key == "contact.impulse_threshold_Ns";
    if (k.source != "derived" || methods_own) continue;
    std::ostringstream value;  // six digits will do; gatewalk scene shows all
    value << std::stod(k.value);
    all += (all.empty() ? "" : ", ") + k.key + " = " + value.str();
  }
  std::string text;
  if (scene.named.empty())
    text = scene.source + " names no key: this is the paper's scene, 1 kg and 10 m in radius";
  else if (!all.empty())
    text = scene.source +
           " leaves out keys, which follow from the others by the paper's proportions: " + all;
  static std::string told;  // a sweep settles many scenes
  if (text.empty() || text == told || !options.talk()) return;
  told = text;
  warn(text);
}

std::string setting_text(const Json& settled) {
  const bool event = settled["method"] == "event";
  return "method " + settled["method"].get<std::string>() +
         (event ? ", run.event_tolerance_m = " + settled["event_tolerance_m"].dump()
                : ", run.step_s = " + settled["step_s"].dump());
}

}  // namespace

Json settle_method(const Options& options, lattice::Scene& scene, RunsFrom from) {
  warn_unused(scene);
  tell_derived(options, scene);
  if (scene.gate.run.method != "auto") return nullptr;
  const double tolerance = scene.gate.run.tolerance;
  const auto starts = pilot_starts(scene, from);
  std::optional<Progress> progress;
  std::string shown;
  const auto report = [&](const dynamics::Setting& s, std::int64_t done, std::int64_t trials) {
    if (interrupted()) throw Interrupted{};
    const std::string label = "run.method \"auto\": pilot of " + std::to_string(trials) +
                              " trials, " + s.method + " " + Json(s.value).dump();
    if (label != shown) progress.emplace(shown = label, trials, options.talk());
    progress->update(done);
  };
  const dynamics::Choice choice =
      dynamics::choose_method(scene.gate, starts, options.seed(), report);
  progress.reset();
  scene.gate = choice.params;

  Json settled;
  settled["asked"] = "auto";
  settled["tolerance"] = tolerance;
  settled["method"] = scene.gate.run.method;
  settled["step_s"] = scene.gate.run.step;
  settled["event_tolerance_m"] = scene.gate.run.event_tolerance;
  settled["met"] = choice.met;
  settled["pilot_trials"] = choice.trials;
  settled["pilot_starts"] = starts.size();
  settled["reference"] = {{"method", choice.reference.method},
                          {"key", choice.reference.key},
                          {"value", choice.reference.value},
                          {"verdict", dynamics::name_of(choice.reference_verdict)}};
  settled["tried"] = Json::array();
  for (const auto& t : choice.tried)
    settled["tried"].push_back({{"method", t.setting.method},
                                {"key", t.setting.key},
                                {"value", t.setting.value},
                                {"verdict", dynamics::name_of(t.verdict)},
                                {"outcome_total_variation", t.error.total_variation},
                                {"uncertainty", t.uncertainty},
                                {"trials_changed", t.error.changed},
                                {"work_per_trial", t.work}});
  if (choice.reference_verdict != dynamics::Verdict::fine)
    warn("run.method \"auto\": the reference itself shows faults (" +
         std::string(dynamics::name_of(choice.reference_verdict)) +
         "), nothing can be compared with it; took it all the same: " + setting_text(settled));
  else if (!choice.met)
    warn("run.method \"auto\": no setting was shown to keep the outcomes within run.tolerance = " +
         Json(tolerance).dump() +
         "; took the one they were compared with: " + setting_text(settled));
  return settled;
}

void check_outcomes(const Options& options, const lattice::Scene& scene, RunsFrom from,
                    std::int64_t trials, dynamics::Health& health) {
  if (interrupted()) throw Interrupted{};
  dynamics::check_outcomes(health, scene.gate, pilot_starts(scene, from), options.seed(),
                           dynamics::check_sample(trials));
}

std::string method_line(const Json& settled) {
  if (settled.is_null()) return "";
  std::string text =
      setting_text(settled) + ": chosen on " + settled["pilot_trials"].dump() + " pilot trials";
  if (settled["met"].get<bool>()) {
    const Json& last = settled["tried"].back();
    text += ", outcomes off by " + fixed(last["outcome_total_variation"].get<double>(), 4) +
            " +- " + fixed(last["uncertainty"].get<double>(), 4) + " (total variation)";
  } else {
    text += ", not shown to meet run.tolerance";
  }
  return text + "\n";
}

}  // namespace gatewalk::cli
