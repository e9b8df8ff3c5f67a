// SPDX-License-Identifier: MIT
#include "cli/render/choice.h"

#include "cli/render/json.h"
#include "cli/render/text.h"

namespace gatewalk::cli {
namespace {

std::string setting_text(const dynamics::RunParams& run) {
  return "method " + run.method +
         (run.method == "event" ? ", run.event_tolerance_m = " + Json(run.event_tolerance).dump()
                                : ", run.step_s = " + Json(run.step).dump());
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
           setting_text(settled.choice.params.run);
  if (!settled.choice.met)
    return "run.method \"auto\": no setting was shown to keep the outcomes within run.tolerance "
           "= " +
           Json(settled.tolerance).dump() +
           "; took the one they were compared with: " + setting_text(settled.choice.params.run);
  return {};
}

std::string method_line(const std::optional<lattice::Settled>& settled) {
  if (!settled) return "";
  const dynamics::Choice& choice = settled->choice;
  std::string text = setting_text(choice.params.run) + ": chosen on " +
                     std::to_string(choice.trials) + " pilot trials";
  if (choice.met) {
    const auto& last = choice.tried.back();
    text += ", outcomes off by " + fixed(last.error.total_variation, 4) + " +- " +
            fixed(last.uncertainty, 4) + " (total variation)";
  } else {
    text += ", not shown to meet run.tolerance";
  }
  return text + "\n";
}

Json to_json(const ActionMethods& all) {
  Json json;
  for (std::size_t a = 0; a < all.actions.size(); ++a)
    if (all.methods[a])
      json.push_back({{"action", all.actions[a]}, {"method", to_json(*all.methods[a])}});
  return json;
}

std::string method_lines(const ActionMethods& all) {
  std::string text;
  for (std::size_t a = 0; a < all.actions.size(); ++a)
    if (all.methods[a]) text += all.actions[a] + ": " + method_line(all.methods[a]);
  return text;
}

}  // namespace gatewalk::cli
