// SPDX-License-Identifier: MIT
#pragma once
/// Fields of CSV lines (RFC 4180), and words that stand for a missing value.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gatewalk::lattice {

inline constexpr std::array<char, 3> kSeparators{',', ';', '\t'};

/// What became of a line: split into fields; a quotation mark is still open; or a quotation mark
/// closes within a field.
enum class LineState : std::uint8_t { fields, open, wrong };
/// Splits a line into its fields, without the spaces around them and without quotation marks. The
/// fields point into `line` and `unquoted`.
[[nodiscard]] LineState split_fields(std::string_view line, char separator,
                                     std::vector<std::string_view>& fields, std::string& unquoted);
/// The fields of a line as strings; nullopt if a quotation mark is not closed, or closes within a
/// field.
[[nodiscard]] std::optional<std::vector<std::string>> csv_fields(std::string_view line,
                                                                 char separator = ',');
/// The separator of a line: whichever of comma, semicolon and tab occurs most.
[[nodiscard]] char separator_in(std::string_view line);

/// True if a field stands for a missing value: empty, or NA, #NA, N/A, #N/A, <NA>, NaN, -NaN, None,
/// null, missing, "-", Excel's errors or Microsoft's 1.#IND, in upper or lower case. (An animal may
/// be called Nat or Nil.)
[[nodiscard]] bool says_nothing(std::string_view field);

/// True if a line has no fields: a blank line, or a comment, which begins with # (but not #N/A).
[[nodiscard]] bool has_no_fields(std::string_view line);

}  // namespace gatewalk::lattice
