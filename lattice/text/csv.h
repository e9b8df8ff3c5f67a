// SPDX-License-Identifier: MIT
#pragma once
/// Files of values between commas (RFC 4180), as spreadsheets write them.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gatewalk::lattice {

/// The lines of a file without their ends (LF or CRLF) and without a byte-order mark; none, with
/// errno, when it cannot be read.
[[nodiscard]] std::optional<std::vector<std::string>> lines_of(const std::string& path);

/// The fields of a line, without the spaces around them; those in quotation marks without these.
/// None when a quotation mark is not closed, or closed within a field.
[[nodiscard]] std::optional<std::vector<std::string>> csv_fields(std::string_view line);

/// Whether a field says that there is nothing: empty, or what programs write for it, NA, #NA, N/A,
/// #N/A, <NA>, NaN, -NaN, None, null or "-", in capitals or not. An animal may be called Nat or
/// Nil.
[[nodiscard]] bool says_nothing(std::string_view field);

/// Whether a line has no fields: it is blank, or a comment, which begins with # but for #N/A.
[[nodiscard]] bool has_no_fields(std::string_view line);

}  // namespace gatewalk::lattice
