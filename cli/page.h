// SPDX-License-Identifier: MIT
#pragma once
/// The interactive page that --page writes: the results of predict and analyze for all starts.

#include <optional>
#include <vector>

#include "cli/render/answer_page.h"
#include "cli/source_options.h"
#include "lattice/study/prediction.h"

namespace gatewalk::cli {

/// Declares --page.
TextOption add_page(Options& options);
/// Throws UsageError, before any work, for a source that cannot have a page.
void check_page(const TextOption& page, const lattice::Source& s);

/// A copy of the runs in a file of trees, for write_page. To be called before the command adds runs
/// to the pool. Returns nullopt without --page, and for a source that is no file of trees.
[[nodiscard]] std::optional<lattice::RunPool> runs_of_file(const TextOption& page,
                                                           const lattice::Source& s);

/// Every predicted start with its answer, for write_page.
[[nodiscard]] std::vector<PageAnswer> page_answers(const lattice::PooledPrediction& prediction);
[[nodiscard]] std::vector<PageAnswer> page_answers(const lattice::Prediction& prediction,
                                                   const lattice::Source& s);

/// Writes the page if --page asks for it. The states of starts are those of the file, if there is
/// one, else those of the chain behind the answer. `analysis` is gatewalk analyze's result; null:
/// it is computed here. Throws std::runtime_error if the page would exceed 2 MB even without its
/// optional parts.
void write_page(const Options& options, const TextOption& file, const lattice::Source& s,
                const std::optional<lattice::RunPool>& of_file,
                const std::vector<PageAnswer>& starts, const AnalysedField* analysis = nullptr);

}  // namespace gatewalk::cli
