#pragma once
/// JSON, keys in the order in which they were written.

#include <nlohmann/json.hpp>
#include <string>

#include "cli/render/json_fwd.h"

namespace gatewalk::cli {

/// JSON as text; bytes that are no UTF-8 (names of files) become U+FFFD. `indent` -1: on one line.
[[nodiscard]] std::string text_of(const Json& json, int indent = 2);

}  // namespace gatewalk::cli
