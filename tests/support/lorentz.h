// SPDX-License-Identifier: MIT
#pragma once
/// Known results for the periodic Lorentz gas (tests/library/lorentz_cell.h), and a direct
/// simulation with independent code.

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "dynamics/base/random.h"
#include "results/lorentz/diffusion.h"
#include "tests/library/lorentz_cell.h"

namespace gatewalk::test {

/// Mean stay in a polygon of this free area whose gaps have the total width `open`: pi A / P
/// (Santalo).
inline double mean_stay(double area, double open) { return std::numbers::pi * area / open; }
/// Free area of the triangle between three discs; a cell consists of two triangles.
inline double area_of_triangle(double gap) {
  return std::sqrt(3.0) / 4.0 * (2.0 + gap) * (2.0 + gap) - std::numbers::pi / 2.0;
}
inline double mean_stay_in_triangle(double gap) {
  return mean_stay(area_of_triangle(gap), 3.0 * gap);
}
inline double mean_stay_in_cell(double gap) {
  return mean_stay(2.0 * area_of_triangle(gap), 4.0 * gap);
}

/// Diffusion coefficient of hops between triangles without memory (Machta and Zwanzig, PRL 50:1959,
/// 1983).
inline double machta_zwanzig(double gap) {
  const double a = 2.0 + gap;
  return gap * a * a / (std::numbers::pi * (std::sqrt(3.0) * a * a - 2.0 * std::numbers::pi));
}
/// Diffusion coefficient with one step of memory, for this probability of hopping straight back
/// (Klages and Dellago, J. Stat. Phys. 101:145, 2000; Gilbert and Sanders, PRE 80:041121, 2009).
inline double one_step(double gap, double back) {
  return machta_zwanzig(gap) * 3.0 * (1.0 - back) / (1.0 + 3.0 * back);
}

struct Estimate {
  double mean = 0.0, error = 0.0;  // standard error
};
inline Estimate estimate(const std::vector<double>& samples) {
  const auto n = static_cast<double>(samples.size());
  double mean = 0.0, squares = 0.0;
  for (const double x : samples) mean += x / n;
  for (const double x : samples) squares += (x - mean) * (x - mean);
  return {mean, std::sqrt(squares / (n * (n - 1.0)))};
}

/// Passages through the triangle from entries in the long run: the probability of leaving by the
/// entry, and the mean stay.
struct Triangle {
  Estimate back, stay;
};
inline Triangle triangle(double gap, std::int64_t passages, std::uint64_t seed) {
  const double a = 2.0 + gap;
  const std::array<lorentz::Point, 3> corners{lorentz::Point(0, 0), lorentz::Point(a, 0),
                                              lorentz::Point(a / 2.0, std::sqrt(3.0) / 2.0 * a)};
  std::vector<double> back(static_cast<std::size_t>(passages)), stay(back.size());
  tbb::parallel_for(std::size_t{0}, back.size(), [&](std::size_t i) {
    dynamics::Random random(dynamics::Purpose::gate, {seed, 0, i});
    dynamics::Entry at{0, {gap * (random.uniform() - 0.5), 2.0 * random.uniform() - 1.0}};
    stay[i] = lorentz::cross(corners, at);
    back[i] = at.face == 0;
  });
  return {estimate(back), estimate(stay)};
}

/// Diffusion coefficient from trajectories in the plane, from random places and directions, of
/// `steps` times `step` each. With r(t) the displacement in time t: (<r(2 step)^2> - <r(step)^2>) /
/// (4 step), over all pairs of consecutive steps; memory beyond a step is neglected.
inline Estimate direct_diffusion(double gap, std::int64_t trajectories, int steps, double step,
                                 std::uint64_t seed) {
  const double a = 2.0 + gap;
  const lorentz::Point a1(a, 0.0), a2(a / 2.0, std::sqrt(3.0) / 2.0 * a);
  /// around the disc hit last, which is at the origin; sorted by distance
  std::vector<lorentz::Point> discs;
  for (int i = -4; i <= 4; ++i)
    for (int j = -4; j <= 4; ++j)
      if (const lorentz::Point centre = i * a1 + j * a2; centre.norm() < 3.7 * a)
        discs.push_back(centre);
  std::stable_sort(discs.begin(), discs.end(),
                   [](const auto& c, const auto& d) { return c.squaredNorm() < d.squaredNorm(); });
  std::vector<double> far;
  for (const lorentz::Point& centre : discs) far.push_back(centre.norm());
  std::vector<double> d(static_cast<std::size_t>(trajectories));
  tbb::parallel_for(std::size_t{0}, d.size(), [&](std::size_t trajectory) {
    dynamics::Random random(dynamics::Purpose::gate, {seed, 1, trajectory});
    lorentz::Point x;  // relative to the disc hit last
    const auto is_free = [&] {
      return std::all_of(discs.begin(), discs.end(),
                         [&](const lorentz::Point& c) { return (x - c).squaredNorm() >= 1.0; });
    };
    do {
      x = random.uniform() * a1;
      x += random.uniform() * a2;
    } while (!is_free());
    const double angle = 2.0 * std::numbers::pi * random.uniform();
    lorentz::Point u(std::cos(angle), std::sin(angle)), origin(0.0, 0.0), last = x, before;
    double left = step, squares = 0.0, products = 0.0;
    for (int done = 0; done < steps;) {
      double soonest = INFINITY;
      lorentz::Point hit(0.0, 0.0);
      const double reach = x.norm() + 1.0;  // reaching a disc takes at least far - reach
      for (std::size_t i = 0; i < discs.size() && far[i] - reach < soonest; ++i) {
        const lorentz::Point& c = discs[i];
        const lorentz::Point from = x - c;
        const double b = from.dot(u), root = b * b - from.squaredNorm() + 1.0;
        if (b >= 0.0 || root <= 0.0) continue;
        if (const double t = -b - std::sqrt(root); t < soonest) soonest = t, hit = c;
      }
      for (; soonest >= left && done < steps; left = step) {
        x += left * u;
        soonest -= left;
        const lorentz::Point gone = origin + x - last;
        squares += gone.squaredNorm() / steps;
        if (done > 0) products += gone.dot(before) / (steps - 1);
        before = gone;
        last = origin + x;
        ++done;
      }
      left -= soonest;
      x += soonest * u - hit;
      origin += hit;
      u -= 2.0 * u.dot(x.normalized()) * x.normalized();
    }
    d[trajectory] = (squares + 2.0 * products) / (4.0 * step);
  });
  return estimate(d);
}

/// Deviation from the invariant measure: half the sum of all differences between the shares of
/// draws in 4 x 4 boxes of every face, and 1/64, which an exact chain would give.
inline double off_invariant(const lorentz::TreeDiffusion& chain, double gap) {
  constexpr int kBoxes = 4;
  std::vector<double> boxes(4 * kBoxes * kBoxes, 0.0);
  for (int state = 0; state < chain.space.size(); ++state) {
    const dynamics::StateRange range = chain.space.range(state);
    // The part of a range that is in box k; `from` and `to` are fractions of the whole axis.
    const auto part = [](double from, double to, int k) {
      const double low = std::max(from, static_cast<double>(k) / kBoxes),
                   high = std::min(to, static_cast<double>(k + 1) / kBoxes);
      return std::max(0.0, high - low) / (to - from);
    };
    for (int i = 0; i < kBoxes; ++i)
      for (int j = 0; j < kBoxes; ++j)
        boxes[static_cast<std::size_t>((range.face * kBoxes + i) * kBoxes + j)] +=
            chain.walk.states[static_cast<std::size_t>(state)] *
            part(range.at[0][0] / gap + 0.5, range.at[0][1] / gap + 0.5, i) *
            part((range.at[1][0] + 1.0) / 2.0, (range.at[1][1] + 1.0) / 2.0, j);
  }
  double distance = 0.0;
  for (const double share : boxes)
    distance += 0.5 * std::abs(share - 1.0 / static_cast<double>(boxes.size()));
  return distance;
}

}  // namespace gatewalk::test
