// SPDX-License-Identifier: MIT
#pragma once
/// JSON of what is described, keys in the order of the description; json_value.h reads JSON.

#include <string>
#include <string_view>

#include "cli/fields/fields.h"

namespace gatewalk::cli {

/// JSON as text; bytes that are no UTF-8 (names of files) become U+FFFD. `indent` -1: on one line.
[[nodiscard]] std::string json_text(const Description& describe, int indent = 2);

/// A number with the fewest digits that give it back, and a text in quotation marks, as JSON writes
/// them.
[[nodiscard]] std::string json_number(double x);
[[nodiscard]] std::string json_string(std::string_view text);

/// Of the JSON that commands write; a key that goes, or changes its meaning, makes another one.
inline constexpr int kFormatVersion = 2;
void describe_version(Fields& out);
/// The result with "format_version" as its first key.
[[nodiscard]] Description with_format_version(Description result);
/// The same as the text of a file.
[[nodiscard]] std::string result_json(const Description& result, int indent = 2);

}  // namespace gatewalk::cli
