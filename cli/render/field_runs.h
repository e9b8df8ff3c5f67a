#pragma once
/// Runs of the full dynamics and walks of the chain through the field, as JSON and as tables.

#include <cstdint>
#include <optional>
#include <string>

#include "cli/render/json_fwd.h"
#include "lattice/gate_chain.h"
#include "lattice/reference.h"
#include "lattice/scene/settle.h"

namespace gatewalk::cli {

/// Without "made_by".
[[nodiscard]] Json to_json(const lattice::FieldTally& tally, const lattice::Scene& scene,
                           const std::optional<lattice::Settled>& settled);
[[nodiscard]] std::string table_of(const lattice::FieldTally& tally, const lattice::Scene& scene,
                                   const std::optional<lattice::Settled>& settled);

/// How walks through the field went that started in `start`. Without "matrix_status", "made_by".
[[nodiscard]] Json to_json(const markov::WalkTally& tally, const lattice::ChainStart& start,
                           const dynamics::StateSpace& space, const lattice::Scene& scene);
[[nodiscard]] std::string table_of(const markov::WalkTally& tally, const lattice::ChainStart& start,
                                   const dynamics::StateSpace& space, const lattice::Scene& scene);

}  // namespace gatewalk::cli
