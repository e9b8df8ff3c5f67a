// SPDX-License-Identifier: MIT
#pragma once
/// Numbers as text, with the shortest digits that read back the same.

#include <array>
#include <charconv>
#include <string>

namespace gatewalk::lattice {

/// "0.2", "7", "1e-05"
[[nodiscard]] inline std::string shortest(double x) {
  std::array<char, 32> buffer{};
  return {buffer.data(), std::to_chars(buffer.data(), buffer.data() + buffer.size(), x).ptr};
}

/// The same, but never to be taken for a whole number: "7.0", "-0.0".
[[nodiscard]] inline std::string toml_float(double x) {
  const std::string digits = shortest(x);
  return digits.find_first_of(".en") == digits.npos ? digits + ".0" : digits;  // n: nan, inf
}

}  // namespace gatewalk::lattice
