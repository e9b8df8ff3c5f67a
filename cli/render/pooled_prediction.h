// SPDX-License-Identifier: MIT
#pragma once
/// Predictions as accurate as was asked for, as JSON and as tables.

#include <string>
#include <vector>

#include "cli/render/json_fwd.h"
#include "cli/render/shown_field.h"
#include "lattice/pool/pooled_prediction.h"

namespace gatewalk::cli {

/// Of the scene's start (`given` false: its keys stand alone), or of given ones (in "starts").
/// Without "made_by".
[[nodiscard]] Json to_json(const lattice::PooledPrediction& prediction, const ShownField& shown,
                           double accuracy, bool given);
[[nodiscard]] std::string table_of(const lattice::PooledPrediction& prediction,
                                   const ShownField& shown, bool given);

}  // namespace gatewalk::cli
