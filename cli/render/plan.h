// SPDX-License-Identifier: MIT
#pragma once
/// The best actions of a body as a result, a table and a figure.

#include <optional>
#include <string>
#include <vector>

#include "cli/fields/fields.h"
#include "cli/render/figure.h"
#include "cli/render/provenance.h"
#include "cli/render/shown_field.h"
#include "lattice/scene/settle.h"
#include "lattice/study/plan.h"

namespace gatewalk::cli {

/// The result of `plan` for a scene with actions.
struct PlannedField {
  ShownField shown;
  std::vector<std::string> actions;
  std::vector<std::optional<lattice::Settled>> methods;  // chosen for the actions
  lattice::Plan plan;
  double seconds = 0.0;
  std::optional<lattice::ThriftOptions> thrift{};
  Provenance made_by{};
};
void describe(Fields& out, const PlannedField& p);
/// The first screen; and what --details adds to it.
[[nodiscard]] std::string answer_text(const PlannedField& p);
[[nodiscard]] std::string details_text(const PlannedField& p);
/// The action taken most in each cell, and how often bodies cross.
[[nodiscard]] Figure figure_of(const PlannedField& p);

/// The index of the cheapest policy on the front that crosses at least as often as --chance asks
/// for; nullopt without --chance, or if none does.
[[nodiscard]] std::optional<std::size_t> cheapest(const PlannedField& p);
/// The policy that cheapest() names, or the plan's own.
[[nodiscard]] const lattice::Policy& chosen_policy(const PlannedField& p);

/// For a cell: the action taken most there (-1 if no body came), its share of the visits, and the
/// visits per trial. most_taken() lists cells with the near row first.
struct MostTaken {
  int action = -1;
  double share = 0.0, visits = 0.0;  // of the visits; per trial
  bool shown = false;                // enough visits to be shown
};
[[nodiscard]] std::vector<MostTaken> most_taken(const PlannedField& p);
/// Whether the plan is shown to cross more often than every single action, or is a single action.
[[nodiscard]] bool gains(const PlannedField& p);
/// The action that crosses most often if it is always taken; the first of equals.
[[nodiscard]] std::size_t best_alone(const lattice::Plan& plan);

}  // namespace gatewalk::cli
