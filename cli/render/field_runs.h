// SPDX-License-Identifier: MIT
#pragma once
/// Trials of the full dynamics and walks of the chain through a field, as results and as tables.

#include <optional>
#include <string>

#include "cli/fields/fields.h"
#include "cli/render/choice.h"
#include "cli/render/final_gates.h"
#include "cli/render/provenance.h"
#include "cli/render/shown_field.h"
#include "cli/render/start.h"
#include "lattice/field/field_costs.h"
#include "lattice/field/field_trials.h"
#include "lattice/field/gate_chain.h"
#include "lattice/scene/settle.h"

namespace gatewalk::cli {

/// A scene that was run, and the method chosen for it, if it left that open.
struct RunScene {
  lattice::Scene scene;
  std::optional<lattice::Settled> settled{};
};
/// The result of `lattice`: trials through the field, and what they are of.
struct FieldRun {
  ShownField shown;
  dynamics::Entry start{};
  Provenance made_by{};
  lattice::FieldCosts costs;
  std::optional<RunScene> scene{};  // of gates
  lattice::FieldTally tally;
  ActionMethods may_do{};  // under a policy
};
void describe(Fields& out, const FieldRun& run);
/// What the screen shows first, and its details.
[[nodiscard]] std::string answer_text(const FieldRun& run);
[[nodiscard]] std::string details_text(const FieldRun& run);

/// The result of `walk`: how walks of a chain through the field went.
struct WalkResult {
  ShownField shown;
  markov::WalkTally tally{};
  std::optional<ShownState> state{};       // in which walks start; of recorded runs none, but ...
  std::optional<dynamics::Entry> start{};  // ... an entry, or (none) all first ones that were seen
  bool foreign = false;  // the chain was made elsewhere: it has no trials beside it
  std::optional<dynamics::Health> matrix_status{};
  Provenance made_by{};
};
[[nodiscard]] Rest rest_of(const markov::WalkTally& tally);
void describe(Fields& out, const WalkResult& result);
[[nodiscard]] std::string answer_text(const WalkResult& result);
[[nodiscard]] std::string details_text(const WalkResult& result);

}  // namespace gatewalk::cli
