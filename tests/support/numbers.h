// SPDX-License-Identifier: MIT
#pragma once
/// Numbers for several tests: round-off, and reproducible test data.

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace gatewalk::test {

constexpr double kEps = std::numeric_limits<double>::epsilon();
constexpr double kPi = 3.14159265358979323846;

/// SplitMix64 with the draws that tests need. Only for test data: no result depends on its quality.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : state_(seed) {}
  std::uint64_t word() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return z ^ (z >> 31);
  }
  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(word() >> 11) * 0x1p-53);
  }
  double log_uniform(double low, double high) {
    return std::exp(uniform(std::log(low), std::log(high)));
  }
  bool coin() { return word() >> 63 != 0; }
  double sign() { return coin() ? 1.0 : -1.0; }
  int below(int n) { return static_cast<int>(word() % static_cast<std::uint64_t>(n)); }

 private:
  std::uint64_t state_;
};

/// True for equal bits: distinguishes 0 from -0; a NaN equals itself.
inline bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

}  // namespace gatewalk::test
