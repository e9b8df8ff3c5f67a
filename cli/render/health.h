// SPDX-License-Identifier: MIT
#pragma once
/// The record of numerical faults, as JSON and in words.

#include <string>

#include "cli/render/json_fwd.h"
#include "dynamics/cells/health.h"

namespace gatewalk::cli {

/// {"clean": bool, counts, worst values}.
[[nodiscard]] Json to_json(const dynamics::Health& health);
/// Its inverse. Throws nlohmann::json::exception when a count is missing.
[[nodiscard]] dynamics::Health health_from(const Json& j);
/// One sentence if something was seen, else empty.
[[nodiscard]] std::string complaint(const dynamics::Health& health);

}  // namespace gatewalk::cli
