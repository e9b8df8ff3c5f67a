// SPDX-License-Identifier: MIT
#include "cli/render/text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace gatewalk::cli {

std::string fixed(double x, int digits) {
  if (!std::isfinite(x)) return "-";
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, "%.*f", digits, x);
  const std::string text = buffer;
  const bool is_zero = text.find_first_not_of("-0.") == std::string::npos;
  return is_zero && text.front() == '-' ? text.substr(1) : text;
}

std::string percent(double part, double whole, int digits) {
  return fixed(whole > 0.0 ? 100.0 * part / whole : std::nan(""), digits) + " %";
}

std::string p_text(double p) { return p < 0.001 ? "<0.001" : fixed(p, 3); }

std::string p_words(double p) {
  return p < 0.001 ? "p < 0.001" : "p = " + fixed(p, p < 0.1 ? 3 : 2);
}

std::string digits(double x) {
  std::array<char, 32> buffer;
  std::snprintf(buffer.data(), buffer.size(), "%.7g", x);
  return buffer.data();
}

std::string padded(const std::string& text, int width) {
  const auto wanted = static_cast<std::size_t>(std::abs(width));
  // A character of UTF-8 is as wide as its first byte alone.
  const auto size = static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
  if (size >= wanted) return text;
  const std::string space(wanted - size, ' ');
  return width > 0 ? space + text : text + space;
}

}  // namespace gatewalk::cli
