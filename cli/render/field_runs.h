// SPDX-License-Identifier: MIT
#pragma once
/// Runs of the full dynamics and walks of the chain through the field, as JSON and as tables.

#include <cstdint>
#include <optional>
#include <string>

#include "cli/render/final_gates.h"
#include "cli/render/json.h"
#include "cli/render/shown_field.h"
#include "lattice/gate_chain.h"
#include "lattice/reference.h"
#include "lattice/scene/settle.h"

namespace gatewalk::cli {

/// A scene that was run, and the method chosen for it, if it left that open.
struct RunScene {
  lattice::Scene scene;
  std::optional<lattice::Settled> settled{};
};
/// Without "made_by".
[[nodiscard]] Json to_json(const lattice::FieldTally& tally, const ShownField& shown,
                           const std::optional<RunScene>& scene);
[[nodiscard]] std::string table_of(const lattice::FieldTally& tally, const ShownField& shown,
                                   const std::optional<RunScene>& scene);

/// How walks through the field went, and the state in which they started, in JSON and in words.
struct ShownWalks {
  const markov::WalkTally& tally;
  Json start_state;
  std::string start;
  bool foreign = false;  // of a chain that was made elsewhere, which has no trials beside it
};
[[nodiscard]] Rest rest_of(const markov::WalkTally& tally);
/// Without "matrix_status", "made_by".
[[nodiscard]] Json to_json(const ShownWalks& walks, const ShownField& shown);
[[nodiscard]] std::string table_of(const ShownWalks& walks, const ShownField& shown);

}  // namespace gatewalk::cli
