#pragma once
/// Exact predictions as JSON and as tables.

#include <string>
#include <vector>

#include "cli/render/json_fwd.h"
#include "lattice/scene/row_matrices.h"
#include "lattice/scene/table4.h"
#include "lattice/study/prediction.h"

namespace gatewalk::cli {

/// What was predicted: the field of a matrix, from these starts (none: the scene's own), with rows
/// of other matrices.
struct PredictedField {
  const lattice::SceneMatrix& matrix;
  const std::vector<lattice::PaperStart>& starts;
  const std::vector<lattice::RowMatrix>& other_rows;
};

/// "start d 4 m, vx 5 m/s, vy 10 m/s"
[[nodiscard]] std::string title_of(const lattice::PaperStart& start);

/// Without "made_by".
[[nodiscard]] Json to_json(const lattice::Prediction& prediction, const PredictedField& of,
                           const std::string& solver);
[[nodiscard]] std::string table_of(const lattice::Prediction& prediction, const PredictedField& of);

}  // namespace gatewalk::cli
