// SPDX-License-Identifier: MIT
#pragma once
/// Numbers and words in tables.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace gatewalk::cli {

inline constexpr std::size_t kScreenColumns = 100;  // the largest width of a table

/// Fixed-point text of x with `digits` decimals; "-" for NaN. Never "-0.00".
[[nodiscard]] std::string fixed(double x, int digits);
/// A share in percent: "12.3 %".
[[nodiscard]] std::string percent(double part, double whole, int digits = 1);
/// A number with its limits, "1.20 s [1.10, 1.30]"; the number alone if the limits are NaN.
[[nodiscard]] std::string with_limits(double x, const std::array<double, 2>& limits, int decimals,
                                      std::string_view unit = {});
/// A p-value with 3 decimals, or "<0.001".
[[nodiscard]] std::string p_text(double p);
/// A p-value in words: "p = 0.034", "p = 0.34", "p < 0.001".
[[nodiscard]] std::string p_words(double p);
/// x with this number of significant digits, without trailing zeros. Seven digits suit files and
/// figures.
[[nodiscard]] std::string digits(double x, int significant = 7);
/// Scientific notation: "6.9e-04" for one decimal.
[[nodiscard]] std::string scientific(double x, int decimals);
/// The text in lines of at most kScreenColumns characters, broken at blanks, each with an end of
/// line. Lines after the first begin with `indent`. A longer word stays whole.
[[nodiscard]] std::string wrapped(std::string_view text, std::string_view indent = {});
/// "1 gap", "12 gaps"
[[nodiscard]] std::string counted(std::int64_t n, std::string_view one, std::string_view many);

}  // namespace gatewalk::cli
