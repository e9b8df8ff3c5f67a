// SPDX-License-Identifier: MIT
#include "cli/render/quantity.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <vector>

#include "cli/fields/text.h"
#include "lattice/text/digits.h"

namespace gatewalk::cli {
namespace {

/// The units in which a unit's numbers can be shown, from small to large.
std::vector<Sized> sizes_of(const std::string& unit) {
  if (unit == "kg") return {{1e-12, "ng"}, {1e-9, "µg"}, {1e-6, "mg"}, {1e-3, "g"}, {1.0, "kg"}};
  std::vector<Sized> sizes{{1e-18, "a" + unit}, {1e-15, "f" + unit}, {1e-12, "p" + unit},
                           {1e-9, "n" + unit},  {1e-6, "µ" + unit},  {1e-3, "m" + unit},
                           {1.0, unit}};
  if (unit == "s")
    sizes.insert(sizes.end(), {{60.0, "min"}, {3600.0, "h"}, {86400.0, "d"}});
  else
    sizes.insert(sizes.end(), {{1e3, "k" + unit},
                               {1e6, "M" + unit},
                               {1e9, "G" + unit},
                               {1e12, "T" + unit},
                               {1e15, "P" + unit},
                               {1e18, "E" + unit}});
  return sizes;
}

/// The largest unit not above `most`; the unit itself if all are above.
Sized largest_within(const std::string& unit, double most) {
  Sized found{1.0, unit};
  bool any = false;
  for (const Sized& s : sizes_of(unit))
    if (s.size <= most * (1 + 1e-9)) {
      found = s;
      any = true;
    }
  return any ? found : Sized{1.0, unit};
}

constexpr double kShort = 1e4;  // numbers below have at most four digits before the point

}  // namespace

Sized readable_unit(const std::string& unit, double most) {
  if (most == 0.0 || (most >= 0.01 && most < kShort)) return {1.0, unit};
  const Sized found = largest_within(unit, most);
  return most / found.size < kShort ? found : Sized{1.0, unit};
}

std::string quantity(double x, const std::string& unit, int significant) {
  if (!std::isfinite(x)) return "-";
  if (x == 0.0) return "0 " + unit;
  x = lattice::number_of(scientific(x, significant - 1));  // 9999.7 becomes 10 k
  const Sized shown = readable_unit(unit, std::abs(x));
  const double value = x / shown.size, size = std::abs(value);
  if (size < 0.01 || size >= kShort) return digits(value, significant) + " " + shown.name;
  const int before = static_cast<int>(std::floor(std::log10(size) + 1e-9)) + 1;
  std::string text = fixed(value, std::max(0, significant - before));
  if (text.find('.') != text.npos) text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text + " " + shown.name;
}

std::string reading(double x, const std::string& unit, double step) {
  if (!std::isfinite(x)) return "-";
  const double power = std::round(std::log10(step)), last = std::pow(10.0, power),
               typical = 100.0 * last;
  const bool plain = power >= -4.0 && power <= 0.0;
  Sized shown = plain ? Sized{1.0, unit} : largest_within(unit, typical);
  std::string behind = " " + shown.name;
  if (const double size = typical / shown.size;
      !plain && (size < 0.9 || size > 999.0)) {  // no prefix is large or small enough
    const int exponent = 3 * static_cast<int>(std::floor((power + 2.0) / 3.0));
    shown.size = std::pow(10.0, exponent);
    behind = fmt::format("e{} {}", exponent, unit);
  }
  const int decimals = std::max(0, static_cast<int>(std::lround(std::log10(shown.size / last))));
  std::string text = fixed(x / shown.size, decimals);
  if (text.find_first_not_of("-0.") == text.npos) {
    const std::string least = fixed(std::pow(10.0, -decimals), decimals);
    text = x > 0.0 ? "<" + least : x < 0.0 ? ">-" + least : fixed(0.0, decimals);
  }
  return text + behind;
}

double seven_digits(double x, double unit) {
  const double own = x / unit;
  if (!std::isfinite(own)) return own;
  std::array<char, 32> text;
  const char* const end =
      std::to_chars(text.data(), text.data() + text.size(), own, std::chars_format::scientific, 6)
          .ptr;
  double rounded = 0.0;
  std::from_chars(text.data(), end, rounded);
  return (rounded + 0.0) * unit;
}

double step_of(double least, double most) { return std::max(least, 1e-5 * most); }

}  // namespace gatewalk::cli
