// SPDX-License-Identifier: MIT
#pragma once
/// What run.method = "auto" chose, as JSON and in words.

#include <optional>
#include <string>
#include <vector>

#include "cli/fields/fields.h"
#include "cli/fields/json_fwd.h"
#include "lattice/scene/settle.h"

namespace gatewalk::cli {

/// The key "method", of results whose scene leaves the method to the program.
void describe_method(Fields& out, const std::optional<lattice::Settled>& settled);
/// The attribute of files with its keys.
[[nodiscard]] std::string attribute_of(const lattice::Settled& settled);
/// Its inverse. Throws nlohmann::json::exception and std::invalid_argument for what is none.
[[nodiscard]] lattice::Settled settled_from(const Json& json);
/// What is wrong with a choice, in a sentence; empty if nothing.
[[nodiscard]] std::string complaint(const lattice::Settled& settled);
/// "Time stepping: method stable, run.step_s = 0.02, chosen with ...", two lines; empty for none.
[[nodiscard]] std::string method_line(const std::optional<lattice::Settled>& settled);

/// What a body may do, and the methods that were chosen for it.
struct ActionMethods {
  std::vector<std::string> actions;
  std::vector<std::optional<lattice::Settled>> methods;
};
/// The key "methods": of the actions for which one was chosen; null: of none.
void describe_methods(Fields& out, const ActionMethods& all);
/// A line for each of these.
[[nodiscard]] std::string method_lines(const ActionMethods& all);

}  // namespace gatewalk::cli
