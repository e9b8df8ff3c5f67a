// SPDX-License-Identifier: MIT
#pragma once
/// Numbers with units as people read them, for scenes of any size.

#include <string>

namespace gatewalk::cli {

/// A unit and how much it is in the one it was made from: {1e-3, "mJ"}.
struct Sized {
  double size = 1.0;
  std::string name;
};

/// The unit in which numbers up to `most` (of `unit`, absolute) are short: `unit` itself from 0.01
/// to 9999, else with an SI prefix from a to E; kg become g, mg, ..., long times min, h and d.
/// `unit` itself where none of these fits. `unit` is one that takes a prefix in front: "m", "m/s",
/// "J", "s", "kg".
[[nodiscard]] Sized readable_unit(const std::string& unit, double most);

/// "15 m", "-0.42 N", "20.12 mJ", "1.2e-21 J": x of `unit` with so many significant digits at most,
/// in its readable unit; "-" for what is no number. Only zero is shown as "0".
[[nodiscard]] std::string quantity(double x, const std::string& unit, int significant = 4);

/// One of many numbers that stand side by side or follow each other, all with one unit and the same
/// decimals: what counts is `step` (of `unit`, above 0), and the last digit is the power of ten
/// that is nearest to it. What is not zero and less than that reads "<0.1 J" or ">-0.1 J".
[[nodiscard]] std::string reading(double x, const std::string& unit, double step);

/// x to seven digits of what it is in `unit`, more than a picture shows: rounded in a scene's own
/// unit, a scene in other units has the same picture. Never -0.
[[nodiscard]] double seven_digits(double x, double unit);

/// What counts among numbers up to `most`: `least`, but no more than five digits of the largest.
[[nodiscard]] double step_of(double least, double most);

}  // namespace gatewalk::cli
