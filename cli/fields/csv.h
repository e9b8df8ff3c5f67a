// SPDX-License-Identifier: MIT
#pragma once
/// Tables as CSV (RFC 4180).

#include <cmath>
#include <concepts>
#include <string>

#include "cli/fields/fields.h"
#include "cli/fields/text.h"

namespace gatewalk::cli {

/// A field of a CSV file, in quotation marks where it needs them.
[[nodiscard]] std::string csv_text(const std::string& text);

/// A CSV table, built line by line. Numbers have seven digits, integers all; NaN is an empty field.
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

/// A CSV table with a line for each number of the result: quantity,i,j,value,low_95,high_95.
/// `quantity` is the path of keys ("endings.crossed"), in which items of lists stand by their key
/// or name, else by their number from 0. i and j are the indices in a list (row and column of a
/// grid), from 0; low_95 and high_95 are the limits of the 95 % interval. True is 1 and false 0;
/// null and non-finite numbers are empty fields. Texts and made_by are left out.
[[nodiscard]] std::string table_of_numbers(const Description& describe);

}  // namespace gatewalk::cli
