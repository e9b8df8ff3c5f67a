// SPDX-License-Identifier: MIT
#pragma once
/// The best actions of a body as a result, as a table and as a picture; and what best starts and
/// designs of fields have in common with them.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/render/fields.h"
#include "cli/render/figure.h"
#include "cli/render/health.h"
#include "cli/render/provenance.h"
#include "cli/render/shown_field.h"
#include "lattice/scene/settle.h"
#include "lattice/study/plan.h"

namespace gatewalk::cli {

/// The result of `plan` for a scene with actions.
struct PlannedField {
  ShownField shown;
  std::vector<std::string> actions;
  std::vector<std::optional<lattice::Settled>> methods;  // that were chosen for these
  lattice::Plan plan;
  double seconds = 0.0;
  std::optional<lattice::ThriftOptions> thrift{};
  Provenance made_by{};
};
void describe(Fields& out, const PlannedField& p);
[[nodiscard]] std::string table_of(const PlannedField& p);
/// Which action is taken most in each cell, and how often bodies cross.
[[nodiscard]] Figure figure_of(const PlannedField& p);

/// The keys "crossed" and "crossed_95".
void describe_crossed(Fields& out, std::string_view meaning, const lattice::Crossings& c);
/// The keys "crossed" to "chain", with which results of `plan` begin.
void describe_chance(Fields& out, const lattice::Crossings& c, double chain);
/// The keys "gain" and "gain_95" (null for what is compared with itself).
void describe_gain(Fields& out, std::string_view meaning, const lattice::Gain& gain);
/// The keys "rounds" to "status" of a Plan, a BestStart or a DesignedField.
template <class Found>
void describe_search(Fields& out, const Found& found, double seconds) {
  out.count({"rounds", "1", "rounds of the search: trials, then a new choice"}, found.rounds);
  out.flag(
      {"settled",
       "whether the last round gained less than half the accuracy, or less than sampling noise"},
      found.settled);
  out.count({"gate_runs", "1", "gate runs of all trials"}, found.gate_runs);
  out.number({"seconds", "s", "wall-clock time of the command's work"}, seconds);
  describe_status(out, found.health);
}

/// "chance to cross: 17.61 [16.87, 18.37] %"
[[nodiscard]] std::string chance_text(const lattice::Crossings& c);
/// " of 1068 trials by which nothing was chosen"
[[nodiscard]] std::string trials_text(const lattice::Crossings& c);
/// "+2.7 [1.4, 3.9]", in percentage points.
[[nodiscard]] std::string gain_text(const lattice::Gain& gain);
/// "200000 gate runs in 2 rounds, "
[[nodiscard]] std::string rounds_text(std::int64_t gate_runs, int rounds);

/// That so few trials crossed that they say little; empty where they are not few.
[[nodiscard]] std::string few_crossings(const lattice::Crossings& c);

/// Number of the policy of the front that takes least of those that cross as often as asked for;
/// none where none does, or no chance was asked for.
[[nodiscard]] std::optional<std::size_t> cheapest(const PlannedField& p);
/// That policy, or the plan's.
[[nodiscard]] const lattice::Policy& chosen_policy(const PlannedField& p);

/// By cell (near row first): the action that is taken most there, and how often a trial takes any;
/// -1 where none ever came.
struct MostTaken {
  int action = -1;
  double share = 0.0, visits = 0.0;  // of the visits; per trial
  bool shown = false;                // so many visits that they say something
};
[[nodiscard]] std::vector<MostTaken> most_taken(const PlannedField& p);
/// Whether the plan is shown to cross more often than any action all the time, or is one.
[[nodiscard]] bool gains(const PlannedField& p);
/// The action that alone crosses most often; the first of several.
[[nodiscard]] std::size_t best_alone(const lattice::Plan& plan);

}  // namespace gatewalk::cli
