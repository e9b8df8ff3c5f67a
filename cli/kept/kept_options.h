// SPDX-License-Identifier: MIT
#pragma once
/// The options of commands whose finished pieces are kept.

#include <memory>
#include <set>
#include <string>

#include "cli/command.h"
#include "cli/kept/kept_run.h"

namespace gatewalk::cli {

/// --checkpoint, --resume, --max-time; --shard and --part.
void declare_kept(Options& options, bool can_be_divided);
/// Throws UsageError where they do not go together.
void check_kept(const Options& options);
/// None where there is no file to keep pieces in, and where the run reads what can be read only
/// once (a pipe). `divided`: names of the stages that parts divide. Throws UsageError where a file
/// cannot serve.
[[nodiscard]] std::unique_ptr<KeptRun> kept_run(const Options& options,
                                                const std::set<std::string>& divided);
/// `work` with its pieces kept, if there is somebody, and shared with other processes, if there are
/// any.
[[nodiscard]] dynamics::Work kept_work(const Options& options, dynamics::Work work, KeptRun* kept);

}  // namespace gatewalk::cli
