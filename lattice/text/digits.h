// SPDX-License-Identifier: MIT
#pragma once
/// Numbers as text, with the shortest digits that read back the same, and text as numbers. Both are
/// independent of the locale.

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

namespace gatewalk::lattice {

/// The shortest digits that read back the same: "0.2", "7", "1e-05".
[[nodiscard]] inline std::string shortest(double x) {
  std::array<char, 32> buffer{};
  return {buffer.data(), std::to_chars(buffer.data(), buffer.data() + buffer.size(), x).ptr};
}

/// At most six digits, for people: "0.02", "0.333333".
[[nodiscard]] inline std::string rounded(double x) {
  std::array<char, 32> buffer{};
  return {buffer.data(), std::to_chars(buffer.data(), buffer.data() + buffer.size(), x,
                                       std::chars_format::general, 6)
                             .ptr};
}

/// Shortest digits that are never taken for a whole number: "7.0", "-0.0".
[[nodiscard]] inline std::string toml_float(double x) {
  const std::string digits = shortest(x);
  return digits.find_first_of(".en") == digits.npos ? digits + ".0" : digits;  // n: nan, inf
}

/// `text` without its leading blanks.
[[nodiscard]] inline std::string_view behind_blanks(std::string_view text) {
  return text.substr(std::min(text.find_first_not_of(" \t\n\v\f\r"), text.size()));
}

/// Takes the number at the beginning of `text`, after blanks, and removes it from `text`; nullopt
/// if there is none that a double can hold. Accepts a plus sign, unlike std::from_chars.
[[nodiscard]] inline std::optional<double> take_number(std::string_view& text) {
  std::string_view rest = behind_blanks(text);
  if (rest.starts_with('+')) rest.remove_prefix(rest.starts_with("+-") ? 0 : 1);
  double x = 0.0;
  const auto read = std::from_chars(rest.data(), rest.data() + rest.size(), x);
  if (read.ec != std::errc()) return {};
  text.remove_prefix(static_cast<std::size_t>(read.ptr - text.data()));
  return x;
}

/// True if `text` begins with `mark`, after blanks; then removes both from `text`.
[[nodiscard]] inline bool take_mark(std::string_view& text, char mark) {
  const std::string_view rest = behind_blanks(text);
  if (!rest.starts_with(mark)) return false;
  text = rest.substr(1);
  return true;
}

/// The number that `text` begins with; `text` must be known to begin with one.
[[nodiscard]] inline double number_of(std::string_view text) { return take_number(text).value(); }

}  // namespace gatewalk::lattice
