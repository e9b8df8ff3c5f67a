// SPDX-License-Identifier: MIT
#include "lattice/text/csv.h"

#include <algorithm>
#include <array>

#include "lattice/text/toml_text.h"

namespace gatewalk::lattice {

namespace {

bool is_space(char c, char separator) { return c == ' ' || (c == '\t' && separator != '\t'); }

}  // namespace

LineState split_fields(std::string_view line, char separator, std::vector<std::string_view>& fields,
                       std::string& unquoted) {
  fields.clear();
  unquoted.clear();
  unquoted.reserve(line.size());  // no reallocation, so that fields stay where they are
  const char *at = line.data(), *const end = at + line.size();
  const auto skip_spaces = [&] {
    while (at < end && is_space(*at, separator)) ++at;
  };
  for (;; ++at) {
    skip_spaces();
    if (at < end && *at == '"') {
      const std::size_t begin = unquoted.size();
      for (++at;; ++at) {
        if (at == end) return LineState::open;
        if (*at == '"' && (at + 1 == end || at[1] != '"')) break;
        if (*at == '"') ++at;  // two quotation marks stand for one
        unquoted += *at;
      }
      ++at;
      skip_spaces();
      if (at < end && *at != separator) return LineState::wrong;
      fields.push_back(std::string_view(unquoted).substr(begin));
    } else {
      const char* const from = at;
      while (at < end && *at != separator) ++at;
      const char* to = at;
      while (to > from && is_space(to[-1], separator)) --to;
      fields.emplace_back(from, static_cast<std::size_t>(to - from));
    }
    if (at == end) return LineState::fields;
  }
}

std::optional<std::vector<std::string>> csv_fields(std::string_view line, char separator) {
  std::vector<std::string_view> fields;
  std::string unquoted;
  if (split_fields(line, separator, fields, unquoted) != LineState::fields) return {};
  return std::vector<std::string>(fields.begin(), fields.end());
}

char separator_in(std::string_view line) {
  return *std::max_element(kSeparators.begin(), kSeparators.end(), [&](char a, char b) {
    return std::count(line.begin(), line.end(), a) < std::count(line.begin(), line.end(), b);
  });
}

bool says_nothing(std::string_view field) {
  constexpr std::array<std::string_view, 28> kWords{
      "",         "na",       "n/a",     "nan",     "-nan",    "nan(ind)", "-nan(ind)",
      "none",     "null",     "missing", "-",       "<na>",    "#n/a",     "#na",
      "#n/a n/a", "#num!",    "#ref!",   "#value!", "#div/0!", "1.#ind",   "-1.#ind",
      "1.#qnan",  "-1.#qnan", "#nv",     "#wert!",  "#zahl!",  "#name?",   "#null!"};
  const std::string word = in_small_letters(field);
  return std::find(kWords.begin(), kWords.end(), word) != kWords.end();
}

bool has_no_fields(std::string_view line) {
  const std::size_t first = line.find_first_not_of(" \t");
  if (first == line.npos) return true;
  return line[first] == '#' &&
         !says_nothing(line.substr(first, line.find_first_of(",;\t", first) - first));
}

}  // namespace gatewalk::lattice
