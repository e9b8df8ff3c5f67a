// SPDX-License-Identifier: MIT
#include "lattice/scene/units.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "lattice/text/digits.h"

namespace gatewalk::lattice {
namespace {

/// How keys end with their unit, without its prefix, and how messages show the unit.
struct UnitName {
  std::string_view prefix, written, shown;
};
// Longer units before those that they end in.
constexpr std::array<UnitName, 10> kUnitNames{{{"", "Nms_per_rad", "N m s/rad"},
                                               {"", "Nm_per_rad", "N m/rad"},
                                               {"", "Ns_per_m", "N s/m"},
                                               {"", "m_per_s", "m/s"},
                                               {"k", "g", "g"},
                                               {"", "Hz", "Hz"},
                                               {"", "Ns", "N s"},
                                               {"", "N", "N"},
                                               {"", "m", "m"},
                                               {"", "s", "s"}}};

struct UnitPrefix {
  std::string_view written, shown;
  int power;
};
constexpr std::array<UnitPrefix, 6> kUnitPrefixes{
    {{"k", "k", 3}, {"", "", 0}, {"c", "c", -2}, {"m", "m", -3}, {"u", "µ", -6}, {"n", "n", -9}}};

std::string unit_text(std::string_view a, std::string_view b, std::string_view c) {
  std::string text(a);
  text += b;
  text += c;
  return text;
}

/// A key split into its stem and its unit.
struct UnitEnd {
  std::string_view stem;
  const UnitName* name;
};
std::optional<UnitEnd> unit_end(std::string_view key) {
  for (const UnitName& name : kUnitNames) {
    std::string_view stem = key;
    const auto cut = [&](std::string_view end) {
      const bool has = stem.ends_with(end);
      if (has) stem.remove_suffix(end.size());
      return has;
    };
    if (cut(name.written) && cut(name.prefix) && cut("_")) return UnitEnd{stem, &name};
  }
  return {};
}

bool takes(const UnitName& name, const UnitPrefix& prefix) {
  return prefix.written != "c" || name.written.starts_with('m');
}

int power_of(std::string_view prefix) {
  return std::find_if(kUnitPrefixes.begin(), kUnitPrefixes.end(),
                      [&](const UnitPrefix& p) { return p.written == prefix; })
      ->power;
}

double with_exponent(double x, int power) {
  if (power == 0 || !std::isfinite(x)) return x;
  const std::string digits = shortest(x);
  const std::size_t e = digits.find('e');
  const int exponent = e == digits.npos ? 0 : std::atoi(digits.c_str() + e + 1);
  const std::string scaled = digits.substr(0, e) + "e" + std::to_string(exponent + power);
  std::string_view text = scaled;
  const double beyond = power > 0 ? std::numeric_limits<double>::infinity() : 0.0;
  return take_number(text).value_or(std::copysign(beyond, x));
}

}  // namespace

std::optional<KeyUnit> unit_of(std::string_view given, std::string_view key) {
  const auto end = unit_end(key);
  if (!end) return given == key ? std::optional(KeyUnit{}) : std::nullopt;
  if (!given.starts_with(end->stem)) return {};
  const UnitName& name = *end->name;
  for (const UnitPrefix& prefix : kUnitPrefixes)
    if (takes(name, prefix) &&
        given.substr(end->stem.size()) == unit_text("_", prefix.written, name.written))
      return KeyUnit{prefix.power - power_of(name.prefix), unit_text(prefix.shown, name.shown, "")};
  return {};
}

double in_own_unit(double x, const KeyUnit& unit) { return with_exponent(x, unit.power); }
double in_given_unit(double x, const KeyUnit& unit) { return with_exponent(x, -unit.power); }

std::string units_instead(std::string_view given, std::string_view key) {
  const auto end = unit_end(key);
  if (!end || !given.starts_with(unit_text(end->stem, "_", ""))) return "";
  std::string_view unit = given.substr(end->stem.size() + 1);
  if (const std::size_t per = unit.find("_per_"); per != unit.npos) unit = unit.substr(0, per);
  if (!std::all_of(unit.begin(), unit.end(), [](unsigned char c) { return std::isalpha(c) != 0; }))
    return "";
  std::string all;
  for (const UnitPrefix& prefix : kUnitPrefixes) {
    if (!takes(*end->name, prefix)) continue;
    if (!all.empty()) all += prefix.written == "n" ? " or " : ", ";
    all += unit_text("_", prefix.written, end->name->written);
  }
  return all;
}

}  // namespace gatewalk::lattice
