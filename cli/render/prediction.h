// SPDX-License-Identifier: MIT
#pragma once
/// Predictions of where bodies end, from a matrix as it is or from runs with an accuracy asked for,
/// as results and tables.

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

/// Rows whose gates have another matrix.
struct OtherRows {
  int first = 0, last = 0;  // i_y
  std::string matrix{};     // path
  std::optional<dynamics::Health> status{};
  std::string scene{};  // as TOML
};
/// A prediction from a matrix as it is.
struct MatrixPrediction {
  lattice::Prediction prediction{};
  std::string path{};                // of the matrix
  int matrix_states = 0;             // the number of its states
  std::vector<ShownState> states{};  // by start, the state in which bodies start
  std::string solver{};
  std::optional<dynamics::Health> status{};  // of the matrix
  std::vector<OtherRows> rows{};
  bool probabilities = false;  // the matrix holds probabilities, not counts
  bool foreign = false;        // an imported chain, without trials to compare with
};

/// The result of `predict`, which has one of two kinds of prediction.
struct PredictResult {
  ShownField shown;
  std::vector<std::optional<dynamics::Entry>> given{};  // starts of --start; none: the scene's own
  std::optional<MatrixPrediction> of_matrix{};
  std::optional<RunsPrediction> of_runs{};
  Provenance made_by{};
};
void describe(Fields& out, const PredictResult& result);
/// What the screen shows first, and its details.
[[nodiscard]] std::string answer_text(const PredictResult& result);
[[nodiscard]] std::string details_text(const PredictResult& result);

/// A line on what was left out; empty if nothing was.
[[nodiscard]] std::string text_of(const lattice::LeftOut& left_out);

}  // namespace gatewalk::cli
