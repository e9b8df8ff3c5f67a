// SPDX-License-Identifier: MIT
#pragma once
/// The page of an answer, --page: what predict and analyze say, for all starts.

#include <optional>
#include <vector>

#include "cli/render/answer_page.h"
#include "cli/source_options.h"
#include "lattice/study/prediction.h"

namespace gatewalk::cli {

/// Declares --page.
TextOption add_page(Options& options);
/// Throws UsageError, before any work, for what cannot have a page.
void check_page(const TextOption& page, const lattice::Source& s);

/// The runs of a matrix of trees as its file has them, for write_page: to be called before others
/// are added to the pool. None of others, and without --page.
[[nodiscard]] std::optional<lattice::RunPool> runs_of_file(const TextOption& page,
                                                           const lattice::Source& s);

/// Every start that was predicted, with its answer, for write_page.
[[nodiscard]] std::vector<PageAnswer> page_answers(const lattice::PooledPrediction& prediction);
[[nodiscard]] std::vector<PageAnswer> page_answers(const lattice::Prediction& prediction,
                                                   const lattice::Source& s);

/// Writes the page, if it is asked for. Starts' states are those of the file, if there is one, else
/// of the chain that the answer comes from. `analysis`: gatewalk analyze's, made here if it is
/// null. Throws std::runtime_error for what is larger than 2 MB even without what can be left out.
void write_page(const Options& options, const TextOption& file, const lattice::Source& s,
                const std::optional<lattice::RunPool>& of_file,
                const std::vector<PageAnswer>& starts, const AnalysedField* analysis = nullptr);

}  // namespace gatewalk::cli
