#include "cli/render/choice.h"

#include "cli/render/report.h"

namespace gatewalk::cli {
namespace {

std::string setting_text(const Json& settled) {
  const bool event = settled["method"] == "event";
  return "method " + settled["method"].get<std::string>() +
         (event ? ", run.event_tolerance_m = " + settled["event_tolerance_m"].dump()
                : ", run.step_s = " + settled["step_s"].dump());
}

}  // namespace

Json to_json(const lattice::Settled& chosen) {
  const dynamics::Choice& choice = chosen.choice;
  Json settled;
  settled["asked"] = "auto";
  settled["tolerance"] = chosen.tolerance;
  settled["method"] = choice.params.run.method;
  settled["step_s"] = choice.params.run.step;
  settled["event_tolerance_m"] = choice.params.run.event_tolerance;
  settled["met"] = choice.met;
  settled["pilot_trials"] = choice.trials;
  settled["pilot_starts"] = chosen.pilot_starts;
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
  return settled;
}

std::string complaint(const lattice::Settled& settled) {
  if (settled.choice.reference_verdict != dynamics::Verdict::fine)
    return "run.method \"auto\": the reference itself shows faults (" +
           std::string(dynamics::name_of(settled.choice.reference_verdict)) +
           "), nothing can be compared with it; took it all the same: " +
           setting_text(to_json(settled));
  if (!settled.choice.met)
    return "run.method \"auto\": no setting was shown to keep the outcomes within run.tolerance "
           "= " +
           Json(settled.tolerance).dump() +
           "; took the one they were compared with: " + setting_text(to_json(settled));
  return {};
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

Json settle_method(const Options& options, lattice::Scene& scene, lattice::RunsFrom from) {
  for (const std::string& text : lattice::keys_without_effect(scene)) warn(text);
  static std::string told;  // a sweep settles many scenes
  if (const std::string text = lattice::derived_keys(scene);
      !text.empty() && text != told && options.talk())
    warn(told = text);
  const auto settled = lattice::settle_method(scene, from, options.seed(), options.work());
  if (!settled) return nullptr;
  if (const std::string text = complaint(*settled); !text.empty()) warn(text);
  return to_json(*settled);
}

}  // namespace gatewalk::cli
