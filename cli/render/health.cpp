// SPDX-License-Identifier: MIT
#include "cli/render/health.h"

#include "cli/render/json.h"
#include "cli/render/json_value.h"
#include "cli/render/quantity.h"
#include "cli/render/text.h"

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
  const auto of_runs = [&](std::int64_t n) {
    return std::to_string(n) + " of " + std::to_string(h.runs) + " gate runs";
  };
  std::string text = "the method showed faults:";
  if (h.penetrating > 0)
    text += " the disc sank into a beam in " + of_runs(h.penetrating) + " (worst " +
            quantity(h.worst_penetration, "m") + ");";
  if (h.creating_energy > 0)
    text += " energy appeared from nothing in " + of_runs(h.creating_energy) + " (worst " +
            quantity(h.worst_energy_created, "J") + ");";
  if (h.fast > 0)
    text += " disc or beam moved over half a radius in one step in " + of_runs(h.fast) +
            ", hits may have been missed: take a smaller run.step_s;";
  if (h.unstable > 0)
    text += " the step is longer than the method's stability bound for these beams in " +
            of_runs(h.unstable) + ": take a smaller run.step_s or another run.method;";
  if (h.outcomes_off())
    text += " a better method gives other outcomes for at least " + percent(h.outcome_error, 1.0) +
            " of " + std::to_string(h.checked_trials) +
            " trials that were run again: take a smaller run.step_s, or run.method = \"auto\";";
  if (h.undefined_contacts > 0)
    text += " " + std::to_string(h.undefined_contacts) +
            " steps overlapped a joint, for which it has no formula;";
  if (h.piled_up())
    text += " hits piled up and were forced to end in " + std::to_string(h.forced_holds) + " of " +
            std::to_string(h.steps) + " steps;";
  if (h.broken > 0) text += " " + std::to_string(h.broken) + " runs stopped being finite numbers;";
  text.back() = '.';
  return text;
}

}  // namespace gatewalk::cli
