// SPDX-License-Identifier: MIT
#pragma once
/// Predictions of where bodies end, from a matrix as it is or as accurate as was asked for, as
/// results and as tables.

#include <optional>
#include <string>
#include <vector>

#include "cli/fields/fields.h"
#include "cli/render/pooled_prediction.h"
#include "cli/render/provenance.h"
#include "cli/render/shown_field.h"
#include "cli/render/start.h"
#include "lattice/study/prediction.h"

namespace gatewalk::cli {

/// Rows of gates that have another matrix.
struct OtherRows {
  int first = 0, last = 0;  // i_y
  std::string matrix{};     // its path
  std::optional<dynamics::Health> status{};
  std::string scene{};  // as TOML
};
/// What a matrix says as it is.
struct MatrixPrediction {
  lattice::Prediction prediction{};
  std::string path{};                // of the matrix
  int matrix_states = 0;             // the number of its states
  std::vector<ShownState> states{};  // in which bodies start, by start
  std::string solver{};
  std::optional<dynamics::Health> status{};  // of the matrix
  std::vector<OtherRows> rows{};
  bool probabilities = false;  // the matrix was given so, not counted
  bool foreign = false;        // a chain that was made elsewhere, which has no trials beside it
};

/// The result of `predict`: of one of two kinds.
struct PredictResult {
  ShownField shown;
  std::vector<std::optional<dynamics::Entry>>
      given{};  // starts that were asked for; none: the scene's own
  std::optional<MatrixPrediction> of_matrix{};
  std::optional<RunsPrediction> of_runs{};
  Provenance made_by{};
};
void describe(Fields& out, const PredictResult& result);
/// What the screen shows first, and its details.
[[nodiscard]] std::string answer_text(const PredictResult& result);
[[nodiscard]] std::string details_text(const PredictResult& result);

/// Empty if none is.
[[nodiscard]] std::string text_of(const lattice::LeftOut& left_out);

}  // namespace gatewalk::cli
