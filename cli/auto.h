#pragma once
/// run.method = "auto" as the commands use it.

#include "cli/command.h"
#include "dynamics/study/choice.h"

namespace gatewalk::cli {

/// Where a command's gate runs begin: the scene's start, or states all over the state space too.
enum class RunsFrom { start, everywhere };

/// Replaces "auto" in the scene by the method and setting that a pilot chooses. Returns what was
/// tried, for the result; null when the scene names its method. Warns when nothing met the
/// tolerance, and of keys that the user gave though the method does not use them.
[[nodiscard]] Json settle_method(const Options& options, lattice::Scene& scene, RunsFrom from);

/// Runs a sample of `trials` again by a better method, and puts into `health` what that changes:
/// see dynamics::check_outcomes.
void check_outcomes(const Options& options, const lattice::Scene& scene, RunsFrom from,
                    std::int64_t trials, dynamics::Health& health);

/// "method stable, run.step_s = 0.02: chosen by ..." as a line of a table; empty for null.
[[nodiscard]] std::string method_line(const Json& settled);

}  // namespace gatewalk::cli
