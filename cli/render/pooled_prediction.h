#pragma once
/// Predictions as accurate as was asked for, as JSON and as tables.

#include <string>
#include <vector>

#include "cli/render/json_fwd.h"
#include "lattice/pool/pooled_prediction.h"
#include "lattice/scene/scene.h"

namespace gatewalk::cli {

/// Of the scene's start (`given` false: its keys stand alone), or of given ones (in "starts").
/// Without "made_by".
[[nodiscard]] Json to_json(const lattice::PooledPrediction& prediction, const lattice::Scene& scene,
                           double accuracy, bool given);
[[nodiscard]] std::string table_of(const lattice::PooledPrediction& prediction,
                                   const lattice::Scene& scene, bool given);

}  // namespace gatewalk::cli
