// SPDX-License-Identifier: MIT
#pragma once
/// Tables as CSV (RFC 4180).

#include <cmath>
#include <concepts>
#include <string>

#include "cli/fields/fields.h"
#include "cli/fields/text.h"

namespace gatewalk::cli {

/// A field: in quotation marks where it needs them.
[[nodiscard]] std::string csv_text(const std::string& text);

/// A table line by line: numbers with seven digits, what is no number empty, whole numbers whole.
class Csv {
 public:
  explicit Csv(const std::string& header) : text_(header + "\n") {}

  template <class... T>
  void row(const T&... value) {
    std::string line;
    bool first = true;
    ((line += (first ? "" : ",") + field(value), first = false), ...);
    text_ += line + "\n";
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  static std::string field(double x) { return std::isnan(x) ? "" : digits(x); }
  template <std::integral T>
  static std::string field(T x) {
    return std::to_string(x);
  }
  static std::string field(const std::string& s) { return csv_text(s); }
  static std::string field(const char* s) { return csv_text(s); }
  std::string text_;
};

/// CSV with a line for each number of the result: quantity,i,j,value,low_95,high_95. The quantity
/// is the way of keys to it ("endings.crossed"; items of lists by their key or name, else by their
/// number from 0), i and j where in a list (row and column of a table) it stands, from 0, and
/// low_95 and high_95 its 95 % interval. Yes is 1, no 0; null and what is no finite number is
/// empty; words are left out, and so is made_by.
[[nodiscard]] std::string table_of_numbers(const Description& describe);

}  // namespace gatewalk::cli
