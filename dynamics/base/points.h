// SPDX-License-Identifier: MIT
#pragma once
/// Points that fill a unit cube more evenly than random ones do, each of them uniform: randomised
/// quasi-Monte Carlo (L'Ecuyer 2018, "Randomized quasi-Monte Carlo: an introduction for
/// practitioners").

#include <array>
#include <cstddef>
#include <cstdint>

#include "dynamics/base/random.h"

namespace gatewalk::dynamics {

/// Sobol's sequence (direction numbers of Joe and Kuo 2008), scrambled by
/// a random lower triangular matrix over its bits and a digital shift (Matoušek 1998), which has
/// the variance of Owen's nested scrambling. Points of one scramble depend on each other, those of
/// two do not.
class ScrambledPoints {
 public:
  /// The scramble is drawn.
  explicit ScrambledPoints(Random& random);
  /// Any 2^k points whose numbers begin at a multiple of 2^k fill the cube evenly. Numbers: below
  /// 2^32.
  [[nodiscard]] Point operator()(std::uint32_t number) const;

 private:
  static constexpr std::size_t kBits = 32;
  std::array<std::array<std::uint32_t, kBits>, kPointDimensions> directions_;
  std::array<std::uint64_t, kPointDimensions> shift_;
};

/// Standard normals, by Box and Muller, as the point is uniform; the same bits everywhere.
[[nodiscard]] std::array<double, kPointDimensions> normals_of(const Point& point);

}  // namespace gatewalk::dynamics
