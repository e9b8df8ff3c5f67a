// SPDX-License-Identifier: MIT
#pragma once
/// Trials of the full dynamics and walks of the chain through a field, as results and tables.

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

/// A scene that was run, and the method if it was chosen for the scene.
struct RunScene {
  lattice::Scene scene;
  std::optional<lattice::Settled> settled{};
};
/// The result of `lattice`: trials through the field.
struct FieldRun {
  ShownField shown;
  dynamics::Entry start{};
  Provenance made_by{};
  lattice::FieldCosts costs;
  std::optional<RunScene> scene{};  // for gates
  lattice::FieldTally tally;
  ActionMethods may_do{};  // under a policy
};
void describe(Fields& out, const FieldRun& run);
/// What the screen shows first, and its details.
[[nodiscard]] std::string answer_text(const FieldRun& run);
[[nodiscard]] std::string details_text(const FieldRun& run);

/// The result of `walk`: walks of a chain through the field.
struct WalkResult {
  ShownField shown;
  markov::WalkTally tally{};
  std::optional<ShownState> state{};       // state in which walks start; none for recorded runs
  std::optional<dynamics::Entry> start{};  // for recorded runs: an entry; none: all first entries
  bool foreign = false;                    // an imported chain, without trials to compare with
  std::optional<dynamics::Health> matrix_status{};
  Provenance made_by{};
};
[[nodiscard]] Rest rest_of(const markov::WalkTally& tally);
void describe(Fields& out, const WalkResult& result);
[[nodiscard]] std::string answer_text(const WalkResult& result);
[[nodiscard]] std::string details_text(const WalkResult& result);

}  // namespace gatewalk::cli
