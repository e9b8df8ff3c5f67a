// SPDX-License-Identifier: MIT
#pragma once
/// Predictions with an accuracy that was asked for, as results and tables.

#include <optional>
#include <string>

#include "cli/fields/fields.h"
#include "cli/render/recorded.h"
#include "cli/render/shown_field.h"
#include "lattice/pool/pooled_prediction.h"
#include "lattice/recorded/recorded_pool.h"
#include "lattice/scene/settle.h"

namespace gatewalk::cli {

/// Recorded runs, and the bounds that bodies lost from sight imply.
struct RecordedRuns {
  RecordedCounts counts{};
  lattice::LostBounds bounds{};
};
/// A prediction from gate runs.
struct RunsPrediction {
  lattice::PooledPrediction prediction{};
  double accuracy = 0.0;  // asked for
  std::optional<lattice::Settled> method{};
  std::optional<RecordedRuns> recorded{};
};
/// The keys of one start; and those of all starts. `given`: the starts stand in a list.
void describe(Fields& out, const lattice::StartAnswer& answer, const ShownField& shown);
void describe(Fields& out, const RunsPrediction& runs, bool given);
/// The answer for one start; and what all starts share.
[[nodiscard]] std::string answer_text(const lattice::StartAnswer& answer);
[[nodiscard]] std::string answer_text(const RunsPrediction& runs);
/// The details of one start; and what all starts share.
[[nodiscard]] std::string details_text(const lattice::StartAnswer& answer, const ShownField& shown);
[[nodiscard]] std::string details_text(const RunsPrediction& runs);

/// A sentence if the accuracy asked for was not reached; else empty. More runs cannot be added to
/// recorded ones.
[[nodiscard]] std::string not_reached(const lattice::PooledPrediction& prediction, double accuracy,
                                      bool is_recorded);
/// The same as a line of the first screen.
[[nodiscard]] std::string beware_of(const lattice::PooledPrediction& prediction, double accuracy,
                                    bool is_recorded);

/// The key "error_95".
void describe_error(Fields& out, double error_95);
/// The key "own_trials": the comparison of the chain with its own full trials; null without trials.
void describe_hausman_check(Fields& out, const std::optional<lattice::HausmanCheck>& own);
/// A sentence that compares the chain with its own full trials; empty without trials.
[[nodiscard]] std::string hausman_check_text(const std::optional<lattice::HausmanCheck>& own);

}  // namespace gatewalk::cli
