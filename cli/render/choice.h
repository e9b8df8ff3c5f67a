// SPDX-License-Identifier: MIT
#pragma once
/// The method that run.method = "auto" chose, as JSON and in words.

#include <optional>
#include <string>
#include <vector>

#include "cli/fields/fields.h"
#include "cli/fields/json_fwd.h"
#include "lattice/scene/settle.h"

namespace gatewalk::cli {

/// The key "method" of results; null if the scene names its method.
void describe_method(Fields& out, const std::optional<lattice::Settled>& settled);
/// The choice as an attribute of files.
[[nodiscard]] std::string attribute_of(const lattice::Settled& settled);
/// Reads attribute_of(). Throws nlohmann::json::exception and std::invalid_argument for a damaged
/// text.
[[nodiscard]] lattice::Settled settled_from(const Json& json);
/// A sentence if the choice does not meet the tolerance; else empty.
[[nodiscard]] std::string complaint(const lattice::Settled& settled);
/// "Time stepping: method stable, run.step_s = 0.02, chosen with ...", two lines; empty without a
/// choice.
[[nodiscard]] std::string method_line(const std::optional<lattice::Settled>& settled);

/// The actions of a body, with the method chosen for each.
struct ActionMethods {
  std::vector<std::string> actions;
  std::vector<std::optional<lattice::Settled>> methods;
};
/// The key "methods", for actions with a chosen method; null if there are none.
void describe_methods(Fields& out, const ActionMethods& all);
/// method_line() for each action with a chosen method.
[[nodiscard]] std::string method_lines(const ActionMethods& all);

}  // namespace gatewalk::cli
