// SPDX-License-Identifier: MIT
#include "cli/render/quantity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>

namespace gatewalk::cli {
namespace {

TEST(Quantity, IsPlainWhereThatIsShort) {
  EXPECT_EQ(quantity(15.0, "m"), "15 m");
  EXPECT_EQ(quantity(-0.42, "N"), "-0.42 N");
  EXPECT_EQ(quantity(0.012345, "J"), "0.01235 J");
  EXPECT_EQ(quantity(9999.4, "m/s"), "9999 m/s");
  EXPECT_EQ(quantity(1234.5678, "J", 6), "1234.57 J");
  EXPECT_EQ(quantity(1500.0, "m", 2), "1500 m");
  EXPECT_EQ(quantity(0.0, "J"), "0 J");
  EXPECT_EQ(quantity(std::nan(""), "J"), "-");
  EXPECT_EQ(quantity(std::numeric_limits<double>::infinity(), "J"), "-");
}

TEST(SevenDigits, OfTheUnit) {
  EXPECT_EQ(seven_digits(123.45678, 1.0), 123.4568);
  EXPECT_EQ(seven_digits(-1.0 / 3.0, 1.0), -0.3333333);
  EXPECT_EQ(seven_digits(0.25 / 3.0, 0.25), 0.25 * 0.3333333);
  EXPECT_FALSE(std::signbit(seven_digits(-0.0, 1.0)));
  EXPECT_EQ(seven_digits(std::numeric_limits<double>::infinity(), 4.0),
            std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(seven_digits(std::nan(""), 1.0)));
}

TEST(Quantity, HasAPrefixElse) {
  EXPECT_EQ(quantity(0.0020123, "J"), "2.012 mJ");
  EXPECT_EQ(quantity(-3e-7, "m/s"), "-300 nm/s");
  EXPECT_EQ(quantity(2.5e-6, "s"), "2.5 µs");
  EXPECT_EQ(quantity(9999.7, "N"), "10 kN");
  EXPECT_EQ(quantity(10485760.0, "m"), "10.49 Mm");
  EXPECT_EQ(quantity(0.00025, "kg"), "250 mg");
  EXPECT_EQ(quantity(0.005, "kg"), "5 g");
  EXPECT_EQ(quantity(12'582'912.0, "s"), "145.6 d");
  EXPECT_EQ(quantity(12'000.0, "s"), "3.333 h");
}

TEST(Quantity, HasAnExponentBeyondAllPrefixes) {
  EXPECT_EQ(quantity(1.25e-27, "J"), "1.25e-27 J");
  EXPECT_EQ(quantity(1048576.0, "kg"), "1.049e+06 kg");
  EXPECT_EQ(quantity(3e25, "m"), "3e+25 m");
}

// For numbers of any size, the text is within 0.06 % of the number, and never zero.
TEST(Quantity, NeverLosesANumber) {
  for (int exponent = -40; exponent <= 40; ++exponent)
    for (const double digits : {1.0, 1.2344, 5.5555, 9.9949, 9.9996}) {
      const double x = digits * std::pow(10.0, exponent);
      const std::string text = quantity(x, "J");
      double factor = 1.0;
      const std::string unit = text.substr(text.find(' ') + 1);
      if (unit != "J") {
        factor = 0.0;
        for (int k = -6; k <= 6; ++k)
          for (const double size : {5.0, 20.0})
            if (const Sized s = readable_unit("J", size * std::pow(1000.0, k)); s.name == unit)
              factor = s.size;
      }
      EXPECT_NEAR(std::strtod(text.c_str(), nullptr) * factor, x, 0.6e-3 * x) << text;
      EXPECT_LE(text.size(), 12u) << text;
    }
}

// In the paper's scenes a tenth of a joule matters: plain joules with one decimal.
TEST(Reading, HasOneUnitAndTheSameDecimals) {
  EXPECT_EQ(reading(312.52, "J", 0.1), "312.5 J");
  EXPECT_EQ(reading(20000.0, "J", 0.1), "20000.0 J");
  EXPECT_EQ(reading(-3.25, "N", 0.1), "-3.2 N");
  EXPECT_EQ(reading(4.0, "s", 0.01), "4.00 s");
  EXPECT_EQ(reading(0.02012, "J", 5e-6), "20.12 mJ");
  EXPECT_EQ(reading(0.8, "N", 6.25e-4), "0.800 N");
  EXPECT_EQ(reading(4.72223, "J", step_of(5e-6, 4.7)), "4.7222 J");
  EXPECT_EQ(reading(3124.26, "J", step_of(0.1, 3125.0)), "3124.3 J");
  EXPECT_EQ(reading(1.25e-6, "s", 0.9e-8), "1.25 µs");
  EXPECT_EQ(reading(2.0 * 86400.0, "s", 1e4), "2.0 d");
  EXPECT_EQ(reading(312.5e-30, "J", 0.1e-30), "312.5e-30 J");
}

TEST(Reading, NeverShowsZeroForWhatIsNot) {
  EXPECT_EQ(reading(0.0, "J", 0.1), "0.0 J");
  EXPECT_EQ(reading(-0.0, "J", 0.1), "0.0 J");
  EXPECT_EQ(reading(0.04, "J", 0.1), "<0.1 J");
  EXPECT_EQ(reading(-1e-300, "J", 0.1), ">-0.1 J");
  EXPECT_EQ(reading(1e-9, "J", 5e-6), "<0.01 mJ");
  EXPECT_EQ(reading(0.3, "m", 1.0), "<1 m");
}

}  // namespace
}  // namespace gatewalk::cli
