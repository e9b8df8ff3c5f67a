// SPDX-License-Identifier: MIT
#pragma once
/// Randomised quasi-Monte Carlo: points that fill the unit cube more evenly than random points do,
/// each uniformly distributed (L'Ecuyer 2018, "Randomized quasi-Monte Carlo: an introduction for
/// practitioners").

#include <array>
#include <cstddef>
#include <cstdint>

#include "dynamics/base/random.h"

namespace gatewalk::dynamics {

/// Sobol's sequence (direction numbers of Joe and Kuo 2008), scrambled by a random lower triangular
/// matrix over the bits and a digital shift (Matoušek 1998). The variance is that of Owen's nested
/// scrambling. Points of one scramble depend on each other; points of two scrambles are
/// independent.
class ScrambledPoints {
 public:
  /// Draws a scramble.
  explicit ScrambledPoints(Random& random);
  /// The point with this number, below 2^32. Any 2^k points whose numbers begin at a multiple of
  /// 2^k fill the cube evenly.
  [[nodiscard]] Point operator()(std::uint32_t number) const;

 private:
  static constexpr std::size_t kBits = 32;
  std::array<std::array<std::uint32_t, kBits>, kPointDimensions> directions_;
  std::array<std::uint64_t, kPointDimensions> shift_;
};

/// Maps a uniform point to standard normals by Box-Muller; the bits are the same on any machine.
[[nodiscard]] std::array<double, kPointDimensions> normals_of(const Point& point);

}  // namespace gatewalk::dynamics
