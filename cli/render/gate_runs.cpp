// SPDX-License-Identifier: MIT
#include "cli/render/gate_runs.h"

#include <fmt/core.h>

#include "cli/fields/text.h"
#include "cli/fields/text_table.h"
#include "cli/render/choice.h"
#include "cli/render/health.h"
#include "cli/render/panel.h"
#include "dynamics/base/share.h"

namespace gatewalk::cli {

using dynamics::Outcome;

void describe(Fields& out, const dynamics::GateTally& tally) {
  out.count({"trials", "1", "number of runs of the gate"}, tally.trials);
  const auto counted = [&](const Field& field, std::int64_t n) {
    out.counted(field, n, static_cast<double>(tally.trials),
                dynamics::share_interval(n, tally.trials));
  };
  counted({"traversed", "1",
           "runs in which the body traversed the gate: traversed left, right and even together"},
          tally.traversed());
  for (const auto& [outcome, key, words] : dynamics::kOutcomeNames) {
    const std::string meaning = "number of runs with the outcome: " + std::string(words);
    const Field field(key, "1", meaning);
    if (outcome != Outcome::traversed_even && outcome != Outcome::broken)
      counted(field, tally[outcome]);
    else
      out.count(field, tally[outcome]);
  }
}

void describe(Fields& out, const GateResult& result) {
  describe(out, result.tally);
  describe_method(out, result.method);
  describe_status(out, result.tally.health);
  describe_made_by(out, result.made_by);
}

std::string table_of(const dynamics::GateTally& tally) {
  TextTable table({{"runs", -18},
                   {std::to_string(tally.trials), 10},
                   {"share   ", 11, 2, "%"},
                   {"95 % interval", 0, 0, "", "  "}});
  const auto line = [&](std::string_view name, std::int64_t n) {
    const auto [low, high] = dynamics::share_interval(n, tally.trials);
    table.row({name, n, 100.0 * static_cast<double>(n) / static_cast<double>(tally.trials),
               fmt::format(" [{}, {}]", fixed(100.0 * low, 2), fixed(100.0 * high, 2))});
  };
  line("traversed", tally.traversed());
  line("  left beam", tally[Outcome::traversed_left]);
  line("  right beam", tally[Outcome::traversed_right]);
  if (tally[Outcome::traversed_even] > 0) line("  both evenly", tally[Outcome::traversed_even]);
  for (const auto& [outcome, key, words] : dynamics::kOutcomeNames)
    if (outcome > Outcome::traversed_even && (outcome != Outcome::broken || tally[outcome] > 0))
      line(words, tally[outcome]);
  return table.text();
}

Figure figure_of(const dynamics::GateTally& tally) {
  std::vector<ShareBar> bars;
  const auto add = [&](const std::string& name, std::int64_t n) {
    bars.push_back({name, static_cast<double>(n) / static_cast<double>(tally.trials),
                    dynamics::share_interval(n, tally.trials)});
  };
  add("traversed", tally.traversed());
  for (const auto& [outcome, key, words] : dynamics::kOutcomeNames)
    if (tally[outcome] > 0 || (outcome != Outcome::traversed_even && outcome != Outcome::broken))
      add(std::string(words), tally[outcome]);
  const Box box{135, 320, 36, 36 + height_of_bars(bars.size())};
  Panels out("unset key\n");
  add_share_bars(out, box, "$outcomes", bars)
      .say(fmt::format("one gate, {} trials, 95 % intervals", tally.trials), 8, 18);
  return out.figure(static_cast<int>(box.bottom + 10));
}

}  // namespace gatewalk::cli
