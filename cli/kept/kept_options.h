// SPDX-License-Identifier: MIT
#pragma once
/// The options of commands that keep their finished pieces of work.

#include <memory>
#include <set>
#include <string>

#include "cli/command.h"
#include "cli/kept/kept_run.h"

namespace gatewalk::cli {

/// Declares --checkpoint, --resume and --max-time, and for commands that can be divided --shard and
/// --part.
void declare_kept(Options& options, bool can_be_divided);
/// Throws UsageError if these options contradict each other.
void check_kept(const Options& options);
/// The run that keeps the command's pieces. Null if there is no file for them, or if the command
/// reads an input that can be read only once (a pipe). `divided` names the stages that parts
/// divide. Throws UsageError if a file cannot serve.
[[nodiscard]] std::unique_ptr<KeptRun> kept_run(const Options& options,
                                                const std::set<std::string>& divided);
/// `work` that keeps its pieces in `kept` (null: nowhere) and shares them among the MPI processes,
/// if there are several.
[[nodiscard]] dynamics::Work kept_work(const Options& options, dynamics::Work work, KeptRun* kept);

}  // namespace gatewalk::cli
