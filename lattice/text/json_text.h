// SPDX-License-Identifier: MIT
#pragma once
/// Reads JSON that the program itself wrote, as far as the library needs it.

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

/// Takes the JSON value at the beginning of `rest`, as text, and removes it from `rest`. Throws
/// std::invalid_argument if there is no value, or only its beginning.
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

/// Calls take(rest) for each element between the marks. Throws std::invalid_argument for text of
/// another form.
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

/// The elements of a JSON array, each as text.
[[nodiscard]] inline std::vector<std::string_view> json_elements(std::string_view text) {
  std::vector<std::string_view> all;
  each_in_json(text, '[', ']', [&](std::string_view& rest) { all.push_back(take_json(rest)); });
  return all;
}

/// The content of a JSON text without escaped characters. Throws std::invalid_argument for any
/// other.
[[nodiscard]] inline std::string json_text(std::string_view text) {
  if (text.size() < 2 || !text.starts_with('"') || text.find('\\') != text.npos)
    throw std::invalid_argument("is no plain text");
  return std::string(text.substr(1, text.size() - 2));
}

/// The number in `text`; NaN for null. Throws std::invalid_argument for any other text.
[[nodiscard]] inline double json_number(std::string_view text) {
  if (text == "null") return std::numeric_limits<double>::quiet_NaN();
  const auto number = take_number(text);
  if (!number || !text.empty()) throw std::invalid_argument("is no number");
  return *number;
}

/// The values of an object, each as text.
class JsonObject {
 public:
  /// Throws std::invalid_argument if `text` is no object. `text` must outlive the JsonObject.
  explicit JsonObject(std::string_view text) {
    each_in_json(text, '{', '}', [&](std::string_view& rest) {
      std::string key = json_text(take_json(rest));
      if (!take_mark(rest, ':')) throw std::invalid_argument("has a key without a value");
      values_[std::move(key)] = take_json(rest);
    });
  }
  [[nodiscard]] bool has(std::string_view key) const { return values_.contains(key); }
  /// The value of a key. Throws std::invalid_argument if the key is missing.
  [[nodiscard]] std::string_view at(std::string_view key) const {
    const auto found = values_.find(key);
    if (found == values_.end()) throw std::invalid_argument("has no " + std::string(key));
    return found->second;
  }
  /// The number behind a key; NaN for null.
  [[nodiscard]] double number(std::string_view key) const { return json_number(at(key)); }
  /// The count behind a key. Throws std::invalid_argument for all but whole numbers from 0 up.
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
