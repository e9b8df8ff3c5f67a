// SPDX-License-Identifier: MIT
#pragma once
/// The record of numerical faults, as JSON and in words.

#include <optional>
#include <string>
#include <string_view>

#include "cli/fields/fields.h"
#include "cli/fields/json_fwd.h"
#include "dynamics/cells/health.h"

namespace gatewalk::cli {

/// The keys of "status".
void describe(Fields& out, const dynamics::Health& health);
/// The key "status", which most results have.
void describe_status(Fields& out, const dynamics::Health& health);
/// The same of a result whose record of faults may be missing; none: null.
void describe_status(Fields& out, const std::optional<dynamics::Health>& health);
/// The key "status" of what has a verdict, one of kVerdictNames.
[[nodiscard]] Label status_label(std::string_view meaning);
/// The attribute of files with these keys.
[[nodiscard]] std::string attribute_of(const dynamics::Health& health);
/// Its inverse. Throws nlohmann::json::exception when a count is missing.
[[nodiscard]] dynamics::Health health_from(const Json& j);
/// One sentence if something was seen, else empty.
[[nodiscard]] std::string complaint(const dynamics::Health& health);

}  // namespace gatewalk::cli
