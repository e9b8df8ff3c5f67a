#pragma once
/// What run.method = "auto" chose, as JSON and in words.

#include "cli/command.h"
#include "lattice/scene/settle.h"

namespace gatewalk::cli {

[[nodiscard]] Json to_json(const lattice::Settled& settled);
/// What is wrong with a choice, in a sentence; empty if nothing.
[[nodiscard]] std::string complaint(const lattice::Settled& settled);
/// "method stable, run.step_s = 0.02: chosen by ..." as a line of a table, from the JSON; empty for
/// null.
[[nodiscard]] std::string method_line(const Json& settled);

/// lattice::settle_method for a command: warns of keys without effect, of a choice that did not
/// meet the tolerance, and says what the scene leaves out. The choice as JSON; null when the scene
/// names its method.
[[nodiscard]] Json settle_method(const Options& options, lattice::Scene& scene,
                                 lattice::RunsFrom from);

}  // namespace gatewalk::cli
