// SPDX-License-Identifier: MIT
#pragma once
/// Numbers and words of tables.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace gatewalk::cli {

inline constexpr std::size_t kScreenColumns = 100;  // no table is wider

/// Fixed-point text of x with `digits` decimals; "-" for a value that is not a number.
/// Never "-0.00".
[[nodiscard]] std::string fixed(double x, int digits);
/// "12.3 %"
[[nodiscard]] std::string percent(double part, double whole, int digits = 1);
/// "1.20 s [1.10, 1.30]": a number with its limits; without them (NaN) the number alone.
[[nodiscard]] std::string with_limits(double x, const std::array<double, 2>& limits, int decimals,
                                      std::string_view unit = {});
/// A p-value with 3 decimals, or "<0.001".
[[nodiscard]] std::string p_text(double p);
/// "p = 0.034", "p = 0.34", "p < 0.001"
[[nodiscard]] std::string p_words(double p);
/// Seven digits: for files and figures. Or as many, without zeros at the end.
[[nodiscard]] std::string digits(double x, int significant = 7);
/// "6.9e-04" of one decimal.
[[nodiscard]] std::string scientific(double x, int decimals);
/// Lines of at most kScreenColumns characters, each ended: the text is broken at blanks, and lines
/// after the first begin with `indent`. A longer word stays whole.
[[nodiscard]] std::string wrapped(std::string_view text, std::string_view indent = {});
/// "1 gap", "12 gaps"
[[nodiscard]] std::string counted(std::int64_t n, std::string_view one, std::string_view many);

}  // namespace gatewalk::cli
