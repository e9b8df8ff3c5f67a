// SPDX-License-Identifier: MIT
#pragma once
/// Numbers with readable units, for scenes of any size.

#include <string>

namespace gatewalk::cli {

/// A unit and its size in the unit that it was made from: {1e-3, "mJ"}.
struct Sized {
  double size = 1.0;
  std::string name;
};

/// The unit in which numbers up to `most` (of `unit`, absolute) are short: `unit` itself from 0.01
/// to 9999, else with an SI prefix from a to E. For kg: g, mg, ...; for long times: min, h and d.
/// `unit` itself if none of these fits. `unit` must take a prefix in front: "m", "m/s", "J", "s",
/// "kg".
[[nodiscard]] Sized readable_unit(const std::string& unit, double most);

/// x in its readable unit with at most `significant` digits: "15 m", "-0.42 N", "20.12 mJ",
/// "1.2e-21 J". "-" for non-finite numbers. Only zero is shown as "0".
[[nodiscard]] std::string quantity(double x, const std::string& unit, int significant = 4);

/// One of several numbers that share a unit and decimals. The last digit is the power of ten
/// nearest to `step` (of `unit`, above 0), the smallest difference that matters. A smaller number
/// other than zero reads "<0.1 J" or ">-0.1 J".
[[nodiscard]] std::string reading(double x, const std::string& unit, double step);

/// x rounded to seven digits of its value in `unit`, more than a picture shows. Rounding in a
/// scene's own unit gives the same picture for a scene in other units. Never -0.
[[nodiscard]] double seven_digits(double x, double unit);

/// The step for reading() of numbers up to `most`: `least`, but at most five digits of the largest.
[[nodiscard]] double step_of(double least, double most);

}  // namespace gatewalk::cli
