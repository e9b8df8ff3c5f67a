#include "cli/render/gate_runs.h"

#include "cli/render/json.h"
#include "cli/render/text.h"
#include "dynamics/share.h"

namespace gatewalk::cli {

using dynamics::Outcome;

Json to_json(const dynamics::GateTally& tally) {
  Json json;
  json["trials"] = tally.trials;
  json["traversed"] = tally.traversed();
  json["traversed_left"] = tally[Outcome::traversed_left];
  json["traversed_right"] = tally[Outcome::traversed_right];
  json["traversed_even"] = tally[Outcome::traversed_even];
  json["exited_left"] = tally[Outcome::exited_left];
  json["exited_right"] = tally[Outcome::exited_right];
  json["trapped"] = tally[Outcome::trapped];
  json["not_finite"] = tally[Outcome::broken];
  const auto interval = [&](std::int64_t n) { return dynamics::share_interval(n, tally.trials); };
  json["intervals_95"] = {{"traversed", interval(tally.traversed())},
                          {"traversed_left", interval(tally[Outcome::traversed_left])},
                          {"traversed_right", interval(tally[Outcome::traversed_right])},
                          {"exited_left", interval(tally[Outcome::exited_left])},
                          {"exited_right", interval(tally[Outcome::exited_right])},
                          {"trapped", interval(tally[Outcome::trapped])}};
  return json;
}

std::string table_of(const dynamics::GateTally& tally) {
  const auto line = [&](const char* name, std::int64_t n) {
    const auto [low, high] = dynamics::share_interval(n, tally.trials);
    return padded(name, -18) + padded(std::to_string(n), 10) +
           padded(percent(static_cast<double>(n), static_cast<double>(tally.trials), 2), 11) +
           "   [" + fixed(100.0 * low, 2) + ", " + fixed(100.0 * high, 2) + "]\n";
  };
  std::string table = padded("trials", -18) + padded(std::to_string(tally.trials), 10) +
                      "   share     95 % interval\n" + line("traversed", tally.traversed()) +
                      line("  left beam", tally[Outcome::traversed_left]) +
                      line("  right beam", tally[Outcome::traversed_right]);
  if (tally[Outcome::traversed_even] > 0)
    table += line("  both evenly", tally[Outcome::traversed_even]);
  table += line("exited left", tally[Outcome::exited_left]) +
           line("exited right", tally[Outcome::exited_right]) +
           line("trapped", tally[Outcome::trapped]);
  if (tally[Outcome::broken] > 0) table += line("not finite", tally[Outcome::broken]);
  return table;
}

}  // namespace gatewalk::cli
