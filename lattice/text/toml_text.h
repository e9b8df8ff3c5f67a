// SPDX-License-Identifier: MIT
#pragma once
/// Values of a TOML file, as messages show them.

#include <toml++/toml.h>

#include <string>
#include <string_view>

#include "lattice/text/digits.h"

namespace gatewalk::lattice {

/// `text` with ASCII capitals in lower case, independent of the locale.
[[nodiscard]] inline std::string in_small_letters(std::string_view text) {
  std::string small(text);
  for (char& c : small)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return small;
}

/// True if the file name ends in `ending` (lower case), in upper or lower case.
[[nodiscard]] inline bool has_ending(std::string_view path, std::string_view ending) {
  return in_small_letters(path).ends_with(ending);
}

/// `s` without blanks at both ends.
[[nodiscard]] inline std::string_view trimmed(std::string_view s) {
  constexpr std::string_view kBlank = " \t\r";
  const std::size_t first = s.find_first_not_of(kBlank);
  return first == s.npos ? std::string_view{}
                         : s.substr(first, s.find_last_not_of(kBlank) - first + 1);
}

/// `raw` on one line of a message, without control characters and cut after 60 bytes.
[[nodiscard]] inline std::string printable(std::string_view raw) {
  constexpr std::size_t kLongest = 60;
  std::string shown;
  for (const char c : raw.substr(0, kLongest)) {
    shown += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
  }
  if (raw.size() > kLongest) {
    while (!shown.empty() && static_cast<unsigned char>(shown.back()) >= 0x80) shown.pop_back();
    shown += "...";
  }
  return shown;
}

/// True for a name in files: a letter, then letters, digits and _, at most 60 characters.
[[nodiscard]] inline bool is_name(std::string_view name) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  return !name.empty() && name.size() <= 60 && is_letter(name.front()) &&
         std::all_of(name.begin(), name.end(),
                     [&](char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '_'; });
}

/// The value of a key as a message shows it: " = -3", " = \"fast\"", " (an array)".
[[nodiscard]] inline std::string shown_value(const toml::node& node) {
  if (const auto* number = node.as_floating_point()) return " = " + toml_float(number->get());
  if (const auto* whole = node.as_integer()) return " = " + std::to_string(whole->get());
  if (const auto* truth = node.as_boolean()) return truth->get() ? " = true" : " = false";
  if (const auto* string = node.as_string()) return " = \"" + printable(string->get()) + "\"";
  if (node.is_array()) return " (an array)";
  if (node.is_table()) return " (a table)";
  return " (a date or time)";
}

/// The message that two keys of a document give the same quantity, at the line of the later key.
template <class Place>
[[nodiscard]] std::string given_twice(const toml::node& a, const std::string& a_key,
                                      const toml::node& b, const std::string& b_key,
                                      const Place& line_shown) {
  const bool in_order = a.source().begin < b.source().begin;
  const toml::node &first = in_order ? a : b, &second = in_order ? b : a;
  return line_shown(second.source().begin.line) + ": " + (in_order ? b_key : a_key) +
         shown_value(second) + " is the same quantity as " + (in_order ? a_key : b_key) +
         shown_value(first) + " (" + line_shown(first.source().begin.line) + "): give one of them";
}

}  // namespace gatewalk::lattice
