// SPDX-License-Identifier: MIT
#include "dynamics/base/points.h"

#include <bit>

namespace gatewalk::dynamics {
namespace {

constexpr std::size_t kBits = 32;
using Directions = std::array<std::array<std::uint32_t, kBits>, kPointDimensions>;

/// A primitive polynomial over the integers mod 2: its degree, its inner coefficients as binary
/// digits, and the first direction numbers. Values from the second coordinate on: Joe and Kuo 2008,
/// "Constructing Sobol sequences with better two-dimensional projections".
struct Polynomial {
  std::size_t degree;
  std::uint32_t inner;
  std::array<std::uint32_t, 5> first;
};
constexpr std::array<Polynomial, kPointDimensions - 1> kPolynomials{{{1, 0, {1}},
                                                                     {2, 1, {1, 3}},
                                                                     {3, 1, {1, 3, 1}},
                                                                     {3, 2, {1, 1, 1}},
                                                                     {4, 1, {1, 1, 3, 3}},
                                                                     {4, 4, {1, 3, 5, 13}},
                                                                     {5, 2, {1, 1, 5, 5, 17}}}};

Directions sobol_directions() {
  Directions all{};
  for (std::size_t bit = 0; bit < kBits; ++bit) all[0][bit] = std::uint32_t{1} << (kBits - 1 - bit);
  for (std::size_t axis = 1; axis < kPointDimensions; ++axis) {
    const auto& [degree, inner, first] = kPolynomials[axis - 1];
    auto& of = all[axis];
    for (std::size_t bit = 0; bit < kBits; ++bit) {
      if (bit < degree) {
        of[bit] = first[bit] << (kBits - 1 - bit);
        continue;
      }
      of[bit] = of[bit - degree] ^ (of[bit - degree] >> degree);
      for (std::size_t k = 1; k < degree; ++k)
        if ((inner >> (degree - 1 - k) & 1) != 0) of[bit] ^= of[bit - k];
    }
  }
  return all;
}

}  // namespace

ScrambledPoints::ScrambledPoints(Random& random) {
  static const Directions plain = sobol_directions();
  for (std::size_t axis = 0; axis < kPointDimensions; ++axis) {
    std::array<std::uint32_t, kBits> matrix;  // row i: digit i and the larger digits added to it
    for (std::size_t i = 0; i < kBits; ++i) {
      const std::uint32_t own = std::uint32_t{1} << (kBits - 1 - i);
      matrix[i] = own | (static_cast<std::uint32_t>(random.word() >> 32) & ~(own | (own - 1)));
    }
    for (std::size_t bit = 0; bit < kBits; ++bit) {
      std::uint32_t scrambled = 0;
      for (std::size_t i = 0; i < kBits; ++i)
        scrambled |= static_cast<std::uint32_t>(std::popcount(matrix[i] & plain[axis][bit]) & 1)
                     << (kBits - 1 - i);
      directions_[axis][bit] = scrambled;
    }
    shift_[axis] = random.word();
  }
}

Point ScrambledPoints::operator()(std::uint32_t number) const {
  Point point;
  for (std::size_t axis = 0; axis < kPointDimensions; ++axis) {
    std::uint32_t digits = 0;
    for (std::uint32_t left = number; left != 0; left &= left - 1)
      digits ^= directions_[axis][static_cast<std::size_t>(std::countr_zero(left))];
    point[axis] = open_uniform(shift_[axis] ^ (std::uint64_t{digits} << 32));
  }
  return point;
}

}  // namespace gatewalk::dynamics
