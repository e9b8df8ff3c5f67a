// SPDX-License-Identifier: MIT
#include "dynamics/disc/random_force.h"

#include <cmath>
#include <numbers>
#include <numeric>

namespace gatewalk::dynamics {
namespace {

/// The slowest cosine modes over kSlowBlocks numbers, orthonormal, slowest first.
using Modes = std::array<std::array<double, kSlowBlocks>, kPointDimensions>;

Modes slowest_modes() {
  constexpr auto kBlocks = static_cast<double>(kSlowBlocks);
  Modes modes;
  for (std::size_t m = 0; m < kPointDimensions; ++m)
    for (std::size_t b = 0; b < kSlowBlocks; ++b)
      modes[m][b] = std::sqrt((m == 0 ? 1.0 : 2.0) / kBlocks) *
                    std::cos(std::numbers::pi * static_cast<double>(m) *
                             (static_cast<double>(b) + 0.5) / kBlocks);
  return modes;
}

}  // namespace

void RandomForce::lay(const Point& point, int block) {
  static const Modes modes = slowest_modes();
  random_.normals(slow_);
  const auto wanted = normals_of(point);
  std::array<double, kPointDimensions> more;
  for (std::size_t m = 0; m < kPointDimensions; ++m)
    more[m] = wanted[m] - std::inner_product(slow_.begin(), slow_.end(), modes[m].begin(), 0.0);
  for (std::size_t m = 0; m < kPointDimensions; ++m)
    for (std::size_t b = 0; b < kSlowBlocks; ++b) slow_[b] += more[m] * modes[m][b];
  block_ = static_cast<std::size_t>(block);
  next_block_ = 0;
  used_ = normals_.size();
}

void RandomForce::draw() {
  random_.normals(normals_);
  used_ = 0;
  const double root = std::sqrt(static_cast<double>(block_));
  for (std::size_t at = 0; at < normals_.size() && next_block_ < kSlowBlocks; at += block_) {
    const auto begin = normals_.begin() + static_cast<std::ptrdiff_t>(at);
    const double sum = std::accumulate(begin, begin + static_cast<std::ptrdiff_t>(block_), 0.0);
    const double more = slow_[next_block_++] / root - sum / static_cast<double>(block_);
    for (std::size_t i = at; i < at + block_; ++i) normals_[i] += more;
  }
}

}  // namespace gatewalk::dynamics
