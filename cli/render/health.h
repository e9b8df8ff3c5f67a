// SPDX-License-Identifier: MIT
#pragma once
/// Numerical faults of runs, as JSON and in words.

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
/// The key "status"; null if there is no record of faults.
void describe_status(Fields& out, const std::optional<dynamics::Health>& health);
/// The key "status" for results with a verdict, one of kVerdictNames.
[[nodiscard]] Label status_label(std::string_view meaning);
/// The faults as an attribute of files.
[[nodiscard]] std::string attribute_of(const dynamics::Health& health);
/// Reads attribute_of(). Throws nlohmann::json::exception if a count is missing.
[[nodiscard]] dynamics::Health health_from(const Json& j);
/// A sentence if faults were seen; else empty.
[[nodiscard]] std::string complaint(const dynamics::Health& health);
/// A line of the first screen if faults were seen, which complaint() names; else empty.
[[nodiscard]] std::string beware_of(const dynamics::Health& health);

}  // namespace gatewalk::cli
