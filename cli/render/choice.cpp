// SPDX-License-Identifier: MIT
#include "cli/render/choice.h"

#include <fmt/core.h>

#include <algorithm>
#include <stdexcept>

#include "cli/fields/json.h"
#include "cli/fields/json_value.h"
#include "cli/fields/text.h"

namespace gatewalk::cli {
namespace {

std::string setting_text(const dynamics::RunParams& run) {
  return "method " + run.method +
         (run.method == "event" ? ", run.event_tolerance_m = " + json_number(run.event_tolerance)
                                : ", run.step_s = " + json_number(run.step));
}

/// A setting that was tried: the method, and the value of the key that sets its accuracy.
void describe_setting(Fields& out, const dynamics::Setting& setting, dynamics::Verdict verdict) {
  out.text({"method", "method of the setting, as in run.method"}, setting.method);
  out.text(Label("key", "key of the scene that sets how exact the method is")
               .one_of({"run.step_s", "run.event_tolerance_m"}),
           setting.key);
  out.number({"value", "s or m", "value of this key, in the unit that ends the key's name"},
             setting.value);
  out.text(Label("verdict", "ok, or the worst fault that runs with this setting showed")
               .one_of({dynamics::kVerdictNames.begin(), dynamics::kVerdictNames.end()}),
           dynamics::name_of(verdict));
}

void describe(Fields& out, const lattice::Settled& chosen) {
  const dynamics::Choice& choice = chosen.choice;
  out.text({"asked", "run.method in the scene"}, "auto");
  out.number({"tolerance", "1",
              "total variation of the outcomes that may not be exceeded (run.tolerance)"},
             chosen.tolerance);
  out.text({"method", "run.method that was chosen"}, choice.params.run.method);
  out.number({"step_s", "s", "run.step_s that was chosen"}, choice.params.run.step);
  out.number({"event_tolerance_m", "m", "run.event_tolerance_m that was chosen"},
             choice.params.run.event_tolerance);
  out.flag({"met", "whether the chosen setting was shown to meet the tolerance"}, choice.met);
  out.count({"pilot_trials", "1", "number of trials with which each setting was tried"},
            choice.trials);
  out.count({"pilot_starts", "1", "number of different starts of the pilot trials"},
            chosen.pilot_starts);
  out.object({"reference", "the setting that all others are compared with"},
             [&](Fields& f) { describe_setting(f, choice.reference, choice.reference_verdict); });
  out.list({"tried", "the settings that were tried, in this order"}, choice.tried,
           [](Fields& f, const dynamics::Choice::Tried& t) {
             describe_setting(f, t.setting, t.verdict);
             f.number({"outcome_total_variation", "1",
                       "total variation of the outcomes from those with the reference"},
                      t.error.total_variation);
             f.number({"uncertainty", "1",
                       "upper estimate of the standard error of outcome_total_variation"},
                      t.uncertainty);
             f.count({"trials_changed", "1",
                      "number of trials with another outcome than with the reference"},
                     t.error.changed);
             f.number({"work_per_trial", "us",
                       "expected time of a trial, from its evaluations of the forces"},
                      t.work);
           });
}

dynamics::Setting setting_in(const Json& json) {
  constexpr std::string_view kStep = "run.step_s", kTolerance = "run.event_tolerance_m";
  return {.method = json.at("method"),
          .key = json.at("key") == kStep ? kStep : kTolerance,
          .value = number_in(json.at("value"))};
}

dynamics::Verdict verdict_in(const Json& json) {
  const auto& names = dynamics::kVerdictNames;
  const auto name = std::find(names.begin(), names.end(), json.at("verdict").get<std::string>());
  if (name == names.end()) throw std::invalid_argument("there is no such verdict");
  return static_cast<dynamics::Verdict>(name - names.begin());
}

Label method_label() { return Label("method", "what run.method = \"auto\" chose").shared(); }

}  // namespace

std::string attribute_of(const lattice::Settled& settled) {
  return json_text([&](Fields& out) { describe(out, settled); }, -1);
}

lattice::Settled settled_from(const Json& json) {
  lattice::Settled settled{
      .choice = {}, .tolerance = json.at("tolerance"), .pilot_starts = json.at("pilot_starts")};
  dynamics::Choice& choice = settled.choice;
  choice.reference = setting_in(json.at("reference"));
  choice.reference_verdict = verdict_in(json.at("reference"));
  choice.trials = json.at("pilot_trials");
  choice.met = json.at("met");
  dynamics::RunParams& run = choice.params.run;
  run.method = json.at("method");
  run.step = number_in(json.at("step_s"));
  run.event_tolerance = number_in(json.at("event_tolerance_m"));
  for (const Json& tried : json.at("tried"))
    choice.tried.push_back(
        {.setting = setting_in(tried),
         .work = number_in(tried.at("work_per_trial")),
         .error = {.total_variation = number_in(tried.at("outcome_total_variation")),
                   .changed = tried.at("trials_changed")},
         .uncertainty = number_in(tried.at("uncertainty")),
         .verdict = verdict_in(tried)});
  return settled;
}

void describe_method(Fields& out, const std::optional<lattice::Settled>& settled) {
  out.if_any(method_label(), settled,
             [&](Fields& method, const auto& value) { describe(method, value); });
}

std::string complaint(const lattice::Settled& settled) {
  if (settled.choice.reference_verdict != dynamics::Verdict::fine)
    return fmt::format(
        "run.method \"auto\": even the most accurate setting shows faults ({}); it is used: {}",
        dynamics::name_of(settled.choice.reference_verdict),
        setting_text(settled.choice.params.run));
  if (!settled.choice.met)
    return fmt::format(
        "run.method \"auto\": no faster setting was shown to keep run.tolerance = {}; uses {}",
        json_number(settled.tolerance), setting_text(settled.choice.params.run));
  return {};
}

std::string method_line(const std::optional<lattice::Settled>& settled) {
  if (!settled) return "";
  const dynamics::Choice& choice = settled->choice;
  std::string shown = "They did not show that it meets run.tolerance.";
  if (choice.met) {
    const auto& last = choice.tried.back();
    shown = fmt::format("It changes their outcomes by a total variation of {} +- {}.",
                        fixed(last.error.total_variation, 4), fixed(last.uncertainty, 4));
  }
  return fmt::format("Time stepping: {}, chosen with {} pilot trials.\n{}\n",
                     setting_text(choice.params.run), choice.trials, shown);
}

void describe_methods(Fields& out, const ActionMethods& all) {
  struct Chosen {
    std::string action{};
    lattice::Settled method{};
  };
  std::optional<std::vector<Chosen>> chosen;
  for (std::size_t a = 0; a < all.actions.size(); ++a)
    if (all.methods[a]) {
      if (!chosen) chosen.emplace();
      chosen->push_back({all.actions[a], *all.methods[a]});
    }
  out.list(
      {"methods",
       "what run.method = \"auto\" chose for each action; null: no action has method \"auto\""},
      chosen, [](Fields& f, const Chosen& c) {
        f.text({"action", "name of the action"}, c.action);
        f.object(method_label(), [&](Fields& method) { describe(method, c.method); });
      });
}

std::string method_lines(const ActionMethods& all) {
  std::string text;
  for (std::size_t a = 0; a < all.actions.size(); ++a)
    if (all.methods[a]) text += fmt::format("{}: {}", all.actions[a], method_line(all.methods[a]));
  return text;
}

}  // namespace gatewalk::cli
