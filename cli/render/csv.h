// SPDX-License-Identifier: MIT
#pragma once
/// Tables as CSV (RFC 4180).

#include <cmath>
#include <concepts>
#include <string>

#include "cli/render/text.h"

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

}  // namespace gatewalk::cli
