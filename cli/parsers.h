// SPDX-License-Identifier: MIT
#pragma once
/// Options that one command has, as what the libraries take; what is wrong with it is said.

#include <string>
#include <vector>

#include "cli/command.h"
#include "lattice/pool/lumped_chain.h"
#include "lattice/scene/recording.h"
#include "lattice/scene/row_matrices.h"
#include "markov/predict.h"

namespace gatewalk::cli {

/// Those of --row: rows whose gates are those of another matrix. Throws UsageError.
[[nodiscard]] std::vector<lattice::RowMatrix> other_rows(const Options& options);
/// By the names of --solver. Throws UsageError for any other.
[[nodiscard]] markov::PredictOptions::Solver solver_of(const Options& options);
/// By the names of JSON. Throws UsageError for any other.
[[nodiscard]] markov::Ending target_of(const Options& options);
/// --lump: parts of each coordinate; 1 each without it. Throws UsageError.
[[nodiscard]] lattice::LumpingParts lumping_of(const Options& options,
                                               const dynamics::Section& section);
/// Of this option, or the usual one. Throws UsageError for one outside [low, high].
[[nodiscard]] double number_within(const Options& options, const char* name, double usual,
                                   double low, double high);

/// --methods, else all that are charted. Throws UsageError.
[[nodiscard]] std::vector<std::string> chosen_methods(const Options& options);
/// Of gatewalk trace. Throws UsageError for words that no scene makes sense of.
[[nodiscard]] lattice::RecordingOptions recording_options(const Options& options);

}  // namespace gatewalk::cli
