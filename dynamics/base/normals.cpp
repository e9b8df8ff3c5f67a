// SPDX-License-Identifier: MIT
#include <Random123/philox.h>

#include <algorithm>

#include "dynamics/base/points.h"
#include "dynamics/base/random.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "dynamics/base/normals.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "dynamics/base/wide-inl.h"

HWY_BEFORE_NAMESPACE();
namespace gatewalk::dynamics {
namespace HWY_NAMESPACE {

/// Box-Muller for n pairs of uniforms; n must be a multiple of 16.
void box_muller(const double* radius, const double* angle, std::size_t n, double* normals) {
  const D d;
  for (std::size_t i = 0; i < n; i += width()) {
    const Wide r = sqrt(-2.0 * log(load(radius + i)));
    const Direction2<Wide> to = direction_of(2.0 * std::numbers::pi * load(angle + i));
    const Wide x = r * to.c, y = r * to.s;
    hn::StoreInterleaved2(x.a, y.a, d, normals + 2 * i);
    hn::StoreInterleaved2(x.b, y.b, d, normals + 2 * i + width());
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace gatewalk::dynamics
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gatewalk::dynamics {
HWY_EXPORT(box_muller);

void Random::refill() {
  const auto drawn = r123::Philox4x64()({{block_++, trial_, 0, 0}}, {{key_[0], key_[1]}});
  // Copied one by one: a copy of all four would wait for each store.
  words_ = {drawn[0], drawn[1], drawn[2], drawn[3]};
  used_ = 0;
}

void Random::normals(Normals& out) {
  constexpr std::size_t kPairs = std::tuple_size_v<Normals> / 2;
  std::array<double, kPairs> radius, angle;
  for (std::size_t i = 0; i < kPairs; ++i) {
    radius[i] = uniform();
    angle[i] = uniform();
  }
  HWY_DYNAMIC_DISPATCH(box_muller)(radius.data(), angle.data(), kPairs, out.data());
}

std::array<double, kPointDimensions> normals_of(const Point& point) {
  constexpr std::size_t kPairs = 16;  // the fewest that box_muller takes
  std::array<double, kPairs> radius, angle;
  radius.fill(0.5);
  angle.fill(0.5);
  for (std::size_t i = 0; 2 * i < kPointDimensions; ++i) {
    radius[i] = point[2 * i];
    angle[i] = point[2 * i + 1];
  }
  std::array<double, 2 * kPairs> all;
  HWY_DYNAMIC_DISPATCH(box_muller)(radius.data(), angle.data(), kPairs, all.data());
  std::array<double, kPointDimensions> normals;
  std::copy_n(all.begin(), kPointDimensions, normals.begin());
  return normals;
}

}  // namespace gatewalk::dynamics
#endif
