// SPDX-License-Identifier: MIT
#pragma once
/// Keys in other units: "body.radius_cm" for "body.radius_m".

#include <optional>
#include <string>
#include <string_view>

namespace gatewalk::lattice {

/// The unit of a given value, relative to the key's own unit.
struct KeyUnit {
  int power = 0;      // value in the key's own unit = given value times 10^power
  std::string shown;  // "cm", "mN m/rad"; empty for a pure number
};

/// The unit of `given`, which spells `key` as it is, or with another prefix of its unit: k, c
/// (lengths and speeds), m, u, n, or none. nullopt if `given` is no spelling of `key`.
[[nodiscard]] std::optional<KeyUnit> unit_of(std::string_view given, std::string_view key);

/// A value in `unit`, converted to the key's own unit: the shortest decimal number that reads as x,
/// with another exponent. So 6.1 cm is 0.061 m to the last bit. A number given with more than 15
/// digits is rounded twice.
[[nodiscard]] double in_own_unit(double x, const KeyUnit& unit);
/// A value in the key's own unit, converted to `unit`.
[[nodiscard]] double in_given_unit(double x, const KeyUnit& unit);

/// "_km, _m, _cm, _mm, _um or _nm" if `given` is `key` with an unknown unit; else empty.
[[nodiscard]] std::string units_instead(std::string_view given, std::string_view key);

/// The key of a scene that `given` spells in any unit: "body.radius_m" for "body.radius_cm"
/// (scene.cpp has the table of keys). Throws SceneError for an unknown key; `origin` begins the
/// message.
[[nodiscard]] std::string known_key(const std::string& given, const std::string& origin);

}  // namespace gatewalk::lattice
