// SPDX-License-Identifier: MIT
#pragma once
/// JSON, keys in the order in which they were written.

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "cli/render/fields.h"
#include "cli/render/json_fwd.h"

namespace gatewalk::cli {

/// JSON as text; bytes that are no UTF-8 (names of files) become U+FFFD. `indent` -1: on one line.
[[nodiscard]] std::string text_of(const Json& json, int indent = 2);

/// Of a text; one that is_discarded() where it is no JSON.
[[nodiscard]] Json parsed_json(std::string_view text);

/// NaN for null.
[[nodiscard]] inline double number_in(const Json& json) {
  return json.is_null() ? kUnknown : json.get<double>();
}

/// The result that is described.
[[nodiscard]] Json json_of(const Description& describe);

/// A text in quotation marks, as JSON writes it.
[[nodiscard]] std::string json_string(std::string_view text);

/// Of the JSON that commands write; a key that goes, or changes its meaning, makes another one.
inline constexpr int kFormatVersion = 2;
void describe_version(Fields& out);
/// The result with "format_version" as its first key.
[[nodiscard]] Json with_format_version(const Json& result);
/// The same as the text of a file.
[[nodiscard]] std::string json_text(const Json& result, int indent = 2);

}  // namespace gatewalk::cli
