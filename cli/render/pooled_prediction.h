// SPDX-License-Identifier: MIT
#pragma once
/// Predictions as accurate as was asked for, as JSON and as tables.

#include <optional>
#include <string>
#include <vector>

#include "cli/render/fields.h"
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

/// The key "own_trials": what a chain's own full trials say of it; null where there are none.
void describe_own_trials(Fields& out, const std::optional<lattice::OwnTrials>& own);
[[nodiscard]] Json to_json(const std::optional<lattice::OwnTrials>& own);
/// The same as a line; empty where there are none.
[[nodiscard]] std::string own_trials_text(const std::optional<lattice::OwnTrials>& own);

}  // namespace gatewalk::cli
