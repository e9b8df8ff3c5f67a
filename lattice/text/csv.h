// SPDX-License-Identifier: MIT
#pragma once
/// Values between commas (RFC 4180), and words for no value.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gatewalk::lattice {

inline constexpr std::array<char, 3> kSeparators{',', ';', '\t'};

/// What became of a line: its fields, or a quotation mark in it is not closed, or closed within
/// one.
enum class LineState : std::uint8_t { fields, open, wrong };
/// The fields of a line, without the spaces around them; those in quotation marks without these.
/// They lie in `line` and in `unquoted`.
[[nodiscard]] LineState split_fields(std::string_view line, char separator,
                                     std::vector<std::string_view>& fields, std::string& unquoted);
/// The same as text of their own; none where a quotation mark is not closed, or closed within a
/// field.
[[nodiscard]] std::optional<std::vector<std::string>> csv_fields(std::string_view line,
                                                                 char separator = ',');
/// What sets the fields of a line apart: the one of comma, semicolon and tab that is in it most.
[[nodiscard]] char separator_in(std::string_view line);

/// Whether a field says that there is nothing: empty, or what programs write for it, NA, #NA, N/A,
/// #N/A, <NA>, NaN, -NaN, None, null, missing, "-", Excel's errors or Microsoft's 1.#IND, in
/// capitals or not. An animal may be called Nat or Nil.
[[nodiscard]] bool says_nothing(std::string_view field);

/// Whether a line has no fields: it is blank, or a comment, which begins with # but for #N/A.
[[nodiscard]] bool has_no_fields(std::string_view line);

}  // namespace gatewalk::lattice
