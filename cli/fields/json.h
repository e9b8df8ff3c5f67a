// SPDX-License-Identifier: MIT
#pragma once
/// Writes described results as JSON, with keys in the order of the description. json_value.h reads
/// JSON.

#include <string>
#include <string_view>

#include "cli/fields/fields.h"

namespace gatewalk::cli {

/// JSON as text. Bytes that are not UTF-8, as in names of files, become U+FFFD. `indent` -1 writes
/// on one line.
[[nodiscard]] std::string json_text(const Description& describe, int indent = 2);

/// A number with the fewest digits that restore it, or a text in quotation marks, as JSON writes
/// them.
[[nodiscard]] std::string json_number(double x);
[[nodiscard]] std::string json_string(std::string_view text);

/// Version of the JSON that commands write. It changes when a key is removed or changes its
/// meaning.
inline constexpr int kFormatVersion = 2;
void describe_version(Fields& out);
/// The result with "format_version" as its first key.
[[nodiscard]] Description with_format_version(Description result);
/// The result with "format_version", as the text of a file.
[[nodiscard]] std::string result_json(const Description& result, int indent = 2);

}  // namespace gatewalk::cli
