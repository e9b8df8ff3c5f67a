// SPDX-License-Identifier: MIT
#pragma once
/// JSON as a value, for code that reads it; json.h writes JSON. json.cpp defines the functions of
/// both.

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "cli/fields/fields.h"
#include "cli/fields/json_fwd.h"

namespace gatewalk::cli {

/// Parses a text. The value is_discarded() if the text is not JSON.
[[nodiscard]] Json parsed_json(std::string_view text);

/// A described result as a JSON value, to be read or changed.
[[nodiscard]] Json json_of(const Description& describe);

/// The number; NaN for null.
[[nodiscard]] inline double number_in(const Json& json) {
  return json.is_null() ? kUnknown : json.get<double>();
}

/// The value as text, written as json_text writes it.
[[nodiscard]] std::string text_of(const Json& json, int indent = 2);

}  // namespace gatewalk::cli
