// SPDX-License-Identifier: MIT
#pragma once
/// JSON by name only, for headers: nlohmann's own is long to compile.

#include <nlohmann/json_fwd.hpp>

namespace gatewalk::cli {

using Json = nlohmann::ordered_json;

}  // namespace gatewalk::cli
