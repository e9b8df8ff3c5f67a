// SPDX-License-Identifier: MIT
#pragma once
/// Reads JSON that the program wrote itself, as far as the library needs it.

#include <charconv>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "lattice/text/digits.h"

namespace gatewalk::lattice {

/// The text of the value that `rest` begins with, taken off it. Throws std::invalid_argument where
/// there is none, or only its beginning.
[[nodiscard]] inline std::string_view take_json(std::string_view& rest) {
  rest = behind_blanks(rest);
  std::size_t at = 0;
  int depth = 0;
  bool in_text = false;
  for (; at < rest.size(); ++at) {
    const char c = rest[at];
    if (in_text) {
      if (c == '\\') ++at;
      in_text = c != '"';
    } else if (c == '"') {
      in_text = true;
    } else if (c == '{' || c == '[') {
      ++depth;
    } else if (depth == 0 && (c == ',' || c == ':' || c == '}' || c == ']')) {
      break;
    } else if (c == '}' || c == ']') {
      --depth;
    }
  }
  if (in_text || depth > 0 || at == 0 || at > rest.size())
    throw std::invalid_argument("is no JSON");
  const std::string_view value = rest.substr(0, rest.find_last_not_of(" \t\n\r", at - 1) + 1);
  rest.remove_prefix(at);
  return value;
}

/// Calls take(rest) for each element between the marks. Throws std::invalid_argument for what is
/// not of that form.
template <class Take>
void each_in_json(std::string_view text, char open, char close, Take take) {
  if (!take_mark(text, open)) throw std::invalid_argument("is of another kind");
  if (!take_mark(text, close)) {
    do take(text);
    while (take_mark(text, ','));
    if (!take_mark(text, close)) throw std::invalid_argument("does not end");
  }
  if (!behind_blanks(text).empty()) throw std::invalid_argument("has more behind it");
}

/// Of an array, by place.
[[nodiscard]] inline std::vector<std::string_view> json_elements(std::string_view text) {
  std::vector<std::string_view> all;
  each_in_json(text, '[', ']', [&](std::string_view& rest) { all.push_back(take_json(rest)); });
  return all;
}

/// A text without characters that JSON would write otherwise.
[[nodiscard]] inline std::string json_text(std::string_view text) {
  if (text.size() < 2 || !text.starts_with('"') || text.find('\\') != text.npos)
    throw std::invalid_argument("is no plain text");
  return std::string(text.substr(1, text.size() - 2));
}

/// NaN for null.
[[nodiscard]] inline double json_number(std::string_view text) {
  if (text == "null") return std::numeric_limits<double>::quiet_NaN();
  const auto number = take_number(text);
  if (!number || !text.empty()) throw std::invalid_argument("is no number");
  return *number;
}

/// The values of an object, each as text.
class JsonObject {
 public:
  /// Throws std::invalid_argument for text that is no object. The text must outlive it.
  explicit JsonObject(std::string_view text) {
    each_in_json(text, '{', '}', [&](std::string_view& rest) {
      std::string key = json_text(take_json(rest));
      if (!take_mark(rest, ':')) throw std::invalid_argument("has a key without a value");
      values_[std::move(key)] = take_json(rest);
    });
  }
  [[nodiscard]] bool has(std::string_view key) const { return values_.contains(key); }
  /// Throws std::invalid_argument where there is none.
  [[nodiscard]] std::string_view at(std::string_view key) const {
    const auto found = values_.find(key);
    if (found == values_.end()) throw std::invalid_argument("has no " + std::string(key));
    return found->second;
  }
  /// NaN for null.
  [[nodiscard]] double number(std::string_view key) const { return json_number(at(key)); }
  /// Throws std::invalid_argument for all but whole numbers from 0 on.
  template <class Integer>
  [[nodiscard]] Integer count(std::string_view key) const {
    const std::string_view text = at(key);
    Integer count{};
    const auto read = std::from_chars(text.data(), text.data() + text.size(), count);
    if (read.ec != std::errc() || read.ptr != text.data() + text.size() || count < 0)
      throw std::invalid_argument(std::string(key) + " is no count");
    return count;
  }

 private:
  std::map<std::string, std::string_view, std::less<>> values_;
};

}  // namespace gatewalk::lattice
