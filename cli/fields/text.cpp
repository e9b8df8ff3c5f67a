// SPDX-License-Identifier: MIT
#include "cli/fields/text.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace gatewalk::cli {

std::string fixed(double x, int digits) {
  if (!std::isfinite(x)) return "-";
  std::string text = fmt::format("{:.{}f}", x, digits);
  const bool is_zero = text.find_first_not_of("-0.") == std::string::npos;
  return is_zero && text.front() == '-' ? text.substr(1) : text;
}

std::string percent(double part, double whole, int digits) {
  return fixed(whole > 0.0 ? 100.0 * part / whole : std::nan(""), digits) + " %";
}

std::string with_limits(double x, const std::array<double, 2>& limits, int decimals,
                        std::string_view unit) {
  const auto& [low, high] = limits;
  return fmt::format(
      "{}{}{}", fixed(x, decimals), unit,
      std::isnan(low) ? "" : fmt::format(" [{}, {}]", fixed(low, decimals), fixed(high, decimals)));
}

std::string p_text(double p) { return p < 0.001 ? "<0.001" : fixed(p, 3); }

std::string p_words(double p) {
  return p < 0.001 ? "p < 0.001" : "p = " + fixed(p, p < 0.1 ? 3 : 2);
}

std::string digits(double x, int significant) { return fmt::format("{:.{}g}", x, significant); }

std::string scientific(double x, int decimals) { return fmt::format("{:.{}e}", x, decimals); }

std::string wrapped(std::string_view text, std::string_view indent) {
  const auto columns = [](std::string_view words) {  // counts characters of UTF-8, not bytes
    return static_cast<std::size_t>(
        std::count_if(words.begin(), words.end(), [](char c) { return (c & 0xC0) != 0x80; }));
  };
  std::string lines, line;
  bool is_empty = true;  // apart from the indent
  while (!text.empty()) {
    // Blanks in front of a word stay with it, so that the first line may be indented.
    const std::size_t word = text.find_first_not_of(' ');
    std::size_t end = text.find(' ', std::min(word, text.size()));
    const auto joins = [&](std::size_t at) {  // "80 %" and "p = 0.05" stay on one line
      return text.substr(at + 1).starts_with('%') || text.substr(at + 1).starts_with("= ") ||
             text.substr(at + 1).starts_with("< ") || text.substr(0, at).ends_with(" =") ||
             text.substr(0, at).ends_with(" <");
    };
    while (end != text.npos && joins(end)) end = text.find(' ', end + 1);
    std::string_view next = text.substr(0, end);
    text.remove_prefix(next.size());
    if (!is_empty && columns(line) + columns(next) > kScreenColumns) {
      lines += line + "\n";
      line = indent;
      next.remove_prefix(next.find_first_not_of(' '));
    }
    line += next;
    is_empty = false;
  }
  return lines + line + "\n";
}

std::string counted(std::int64_t n, std::string_view one, std::string_view many) {
  return fmt::format("{} {}", n, n == 1 ? one : many);
}

}  // namespace gatewalk::cli
