// SPDX-License-Identifier: MIT
#include "cli/render/figure.h"

#include <fmt/core.h>

#include <cmath>

#include "cli/fields/text.h"

namespace gatewalk::cli {

std::string Sheet::margins(const Box& box) const {
  const auto side = [](const char* name, double share) {
    return fmt::format("set {}margin at screen {}\n", name, digits(share));
  };
  return side("l", box.left / kWidth) + side("r", box.right / kWidth) +
         side("t", 1.0 - box.top / height) + side("b", 1.0 - box.bottom / height);
}

std::string Sheet::at(double left, double top) const {
  return digits(left / kWidth) + "," + digits(1.0 - top / height);
}

std::string RootScale::tics() const {
  std::string list = "'0' 0";
  double last = 0.0;
  const double gap = 0.17 * std::sqrt(most_);
  for (double decade = std::pow(10.0, std::floor(std::log10(most_)) - 1.0); decade <= most_;
       decade *= 10.0)
    for (const double x : {1.0, 2.0, 5.0}) {
      const double root = std::sqrt(x * decade);
      if (x * decade > most_ || root - last < gap) continue;
      list += fmt::format(", '{}' {}", digits(x * decade), digits(root));
      last = root;
    }
  return list;
}

std::string ink(double most) {
  return fmt::format("($3 > {} ? 0x000000 : 0xffffff)", digits(0.6 * most));
}

std::string literal(std::string_view text) {
  std::string out = "'";  // gnuplot takes text in single quotes as it stands
  for (const char c : text) {
    if (c == '\'') out += c;  // doubled
    out += c == '\n' ? ' ' : c;
  }
  return out + "' noenhanced";
}

std::string data_block(std::string_view name, const std::string& rows) {
  return fmt::format("{} << EOD\n{}EOD\n", name, rows);
}

std::string tics_1_2_5(double low, double high, double length) {
  const double decades = std::log10(high / low);
  const bool all = length > 3.0 * 40.0 * decades;
  const int apart = static_cast<int>(std::ceil(40.0 * decades / length));
  std::string list;
  for (int n = static_cast<int>(std::floor(std::log10(low))); std::pow(10.0, n) <= high; ++n)
    for (const int digit : {1, 2, 5}) {
      const std::string at = digits(digit * std::pow(10.0, n)),
                        shown = n >= 4 && digit == 1 ? fmt::format("10^{{{}}}", n) : at;
      const bool has_number = all || (digit == 1 && n % apart == 0);
      list += fmt::format("{}{}' {}{}", list.empty() ? "'" : ", '", has_number ? shown : "", at,
                          has_number ? "" : " 1");
    }
  return list;
}

double tic_step(double span, double parts) {
  const double wanted = span / parts, power = std::pow(10.0, std::floor(std::log10(wanted)));
  double best = power;
  for (const double k : {2.0, 5.0, 10.0})
    if (std::abs(k * power - wanted) < std::abs(best - wanted)) best = k * power;
  return best;
}

std::string short_number(double x) {
  const double decade = std::pow(10.0, std::floor(std::log10(x)));
  return digits(std::floor(x / decade) * decade);
}

}  // namespace gatewalk::cli
