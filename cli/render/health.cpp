// SPDX-License-Identifier: MIT
#include "cli/render/health.h"

#include <fmt/core.h>

#include "cli/fields/json.h"
#include "cli/fields/json_value.h"
#include "cli/fields/text.h"
#include "cli/render/quantity.h"
#include "dynamics/disc/study/verdict.h"

namespace gatewalk::cli {

void describe(Fields& out, const dynamics::Health& h) {
  out.flag({"clean", "whether no fault of the method was seen"}, h.clean());
  for (const dynamics::HealthNumber& n : dynamics::kHealthNumbers)
    if (n.count != nullptr)
      out.count({n.key, n.unit, n.meaning}, h.*n.count);
    else
      out.number({n.key, n.unit, n.meaning}, h.*n.largest);
}

void describe_status(Fields& out, const dynamics::Health& health) {
  out.object(Label("status", "numerical faults of the runs from which the result is made").shared(),
             [&](Fields& status) { describe(status, health); });
}

void describe_status(Fields& out, const std::optional<dynamics::Health>& health) {
  out.maybe(
      Label("status",
            "numerical faults of the runs from which the result is made; null: none are on record")
          .shared(),
      health, [](Fields& status, const dynamics::Health& h) { describe(status, h); });
}

Label status_label(std::string_view meaning) {
  return Label("status", meaning)
      .one_of({dynamics::kVerdictNames.begin(), dynamics::kVerdictNames.end()});
}

std::string attribute_of(const dynamics::Health& health) {
  return json_text([&](Fields& out) { describe(out, health); }, -1);
}

dynamics::Health health_from(const Json& j) {
  dynamics::Health h;
  for (const dynamics::HealthNumber& n : dynamics::kHealthNumbers) {
    if (n.is_recent && !j.contains(n.key)) continue;
    if (n.count != nullptr)
      h.*n.count = j.at(n.key);
    else
      h.*n.largest = j.at(n.key);
  }
  return h;
}

std::string complaint(const dynamics::Health& h) {
  if (h.clean()) return "";
  const auto of_runs = [&](std::int64_t n) { return fmt::format("{} of {} gate runs", n, h.runs); };
  std::string text = "the method showed faults:";
  if (h.penetrating > 0)
    text += fmt::format(" the disc sank into a beam in {} (worst {});", of_runs(h.penetrating),
                        quantity(h.worst_penetration, "m"));
  if (h.creating_energy > 0)
    text += fmt::format(" energy appeared from nothing in {} (worst {});",
                        of_runs(h.creating_energy), quantity(h.worst_energy_created, "J"));
  if (h.fast > 0)
    text += fmt::format(
        " disc or beam moved over half a radius in one step in {}, hits may have been missed: take "
        "a smaller run.step_s;",
        of_runs(h.fast));
  if (h.unstable > 0)
    text += fmt::format(
        " the step is longer than the method's stability bound for these beams in {}: take a "
        "smaller run.step_s or another run.method;",
        of_runs(h.unstable));
  if (h.outcomes_off())
    text += fmt::format(
        " a better method gives other outcomes for at least {} of {} trials that were run again: "
        "take a smaller run.step_s, or run.method = \"auto\";",
        percent(h.outcome_error, 1.0), h.checked_trials);
  if (h.undefined_contacts > 0)
    text += fmt::format(" {} steps overlapped a joint, for which it has no formula;",
                        h.undefined_contacts);
  if (h.piled_up())
    text += fmt::format(" hits piled up and were forced to end in {} of {} steps;", h.forced_holds,
                        h.steps);
  if (h.broken > 0) text += fmt::format(" {} runs stopped being finite numbers;", h.broken);
  text.back() = '.';
  return text;
}

std::string beware_of(const dynamics::Health& health) {
  if (health.clean()) return "";
  return "Beware: the numerical method showed faults in these runs; see the warning, or status in "
         "--json.\n";
}

}  // namespace gatewalk::cli
