// SPDX-License-Identifier: MIT
#pragma once
/// Exact predictions as JSON and as tables.

#include <string>
#include <vector>

#include "cli/render/json_fwd.h"
#include "cli/render/shown_field.h"
#include "cli/render/start.h"
#include "lattice/scene/row_matrices.h"
#include "lattice/study/prediction.h"

namespace gatewalk::cli {

/// What was predicted: the field of a matrix, from these starts (none: the scene's own), with rows
/// of other matrices.
struct PredictedField {
  const lattice::MatrixFile& matrix;
  const ShownField& shown;
  const std::vector<Start>& starts;
  const std::vector<lattice::RowMatrix>& other_rows;
  bool probabilities = false;  // the matrix was given so, not counted
  bool foreign = false;        // a chain that was made elsewhere, which has no trials beside it
};

/// Without "made_by".
[[nodiscard]] Json to_json(const lattice::Prediction& prediction, const PredictedField& of,
                           const std::string& solver);
[[nodiscard]] std::string table_of(const lattice::Prediction& prediction, const PredictedField& of);

/// Empty if none is.
[[nodiscard]] std::string text_of(const lattice::LeftOut& left_out);

}  // namespace gatewalk::cli
