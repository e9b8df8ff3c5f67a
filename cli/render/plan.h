// SPDX-License-Identifier: MIT
#pragma once
/// The best actions of a body as a result, as a table and as a picture.

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
  std::vector<std::optional<lattice::Settled>> methods;  // that were chosen for these
  lattice::Plan plan;
  double seconds = 0.0;
  std::optional<lattice::ThriftOptions> thrift{};
  Provenance made_by{};
};
void describe(Fields& out, const PlannedField& p);
/// The first screen, and what --details adds to it.
[[nodiscard]] std::string answer_text(const PlannedField& p);
[[nodiscard]] std::string details_text(const PlannedField& p);
/// Which action is taken most in each cell, and how often bodies cross.
[[nodiscard]] Figure figure_of(const PlannedField& p);

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
