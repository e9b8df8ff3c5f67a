// SPDX-License-Identifier: MIT
#include "lattice/recorded/local_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace gatewalk::lattice {
namespace {

/// Parabolas x and y over time, three coefficients each, in u = (time - middle) / half.
struct Quadratic {
  double middle, half;      // s
  Eigen::Matrix3d inverse;  // inverse of the matrix of the normal equations
  Eigen::Vector3d x, y;

  [[nodiscard]] Eigen::Vector3d powers(double time) const {
    const double u = (time - middle) / half;
    return {1.0, u, u * u};
  }
  [[nodiscard]] Eigen::Vector3d slopes(double time) const {
    return {0.0, 1.0 / half, 2.0 * (time - middle) / (half * half)};
  }
};

Quadratic fitted(const Track& track, std::size_t begin, std::size_t count) {
  Quadratic q;
  const double first = track.time[begin], last = track.time[begin + count - 1];
  q.middle = 0.5 * (first + last);
  q.half = 0.5 * (last - first);
  std::array<double, 5> moments{};
  Eigen::Vector3d right_x = Eigen::Vector3d::Zero(), right_y = right_x;
  for (std::size_t i = begin; i < begin + count; ++i) {
    const double u = (track.time[i] - q.middle) / q.half;
    double power = 1.0;
    for (std::size_t k = 0; k < moments.size(); ++k, power *= u) moments[k] += power;
    const Eigen::Vector3d powers{1.0, u, u * u};
    right_x += track.x[i] * powers;
    right_y += track.y[i] * powers;
  }
  Eigen::Matrix3d normal;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) normal(r, c) = moments[static_cast<std::size_t>(r + c)];
  q.inverse = normal.inverse();
  q.x = q.inverse * right_x;
  q.y = q.inverse * right_y;
  return q;
}

/// Mean squares of the residuals of parabolas fitted to all windows of one length, over x and y.
struct Left {
  double all = 0.0;    // m^2, per degree of freedom
  double cubic = 0.0;  // m^2: the part along u^3, a unit vector orthogonal to parabolas
};
/// True for a body at rest, or one that the tracker has lost: its places show no noise.
bool is_one_place(const Track& track, std::size_t begin, std::size_t count) {
  for (std::size_t i = begin + 1; i < begin + count; ++i)
    if (track.x[i] != track.x[begin] || track.y[i] != track.y[begin]) return false;
  return true;
}

/// Residuals of enough windows, evenly chosen among all; nullopt if no piece is as long as
/// `window`.
std::optional<Left> left_by_fits(const std::vector<TrackPiece>& pieces, std::size_t window) {
  constexpr std::size_t kEnough = 10'000;
  std::size_t all = 0;
  for (const TrackPiece& p : pieces) all += p.size() >= window ? p.size() - window + 1 : 0;
  if (all == 0) return {};
  const std::size_t stride = (all + kEnough - 1) / kEnough;
  Left sum;
  std::size_t number = 0, used = 0;
  for (const TrackPiece& p : pieces)
    for (std::size_t at = p.begin; at + window <= p.end; ++at) {
      if (number++ % stride != 0 || is_one_place(*p.track, at, window)) continue;
      ++used;
      const Quadratic q = fitted(*p.track, at, window);
      Eigen::Vector3d cubes = Eigen::Vector3d::Zero();
      for (std::size_t i = at; i < at + window; ++i) {
        const Eigen::Vector3d powers = q.powers(p.track->time[i]);
        cubes += powers[1] * powers[2] * powers;
      }
      const Eigen::Vector3d parabola = q.inverse * cubes;  // the nearest one to u^3
      double x_along = 0.0, y_along = 0.0, length = 0.0;
      for (std::size_t i = at; i < at + window; ++i) {
        const Eigen::Vector3d powers = q.powers(p.track->time[i]);
        const double dx = p.track->x[i] - q.x.dot(powers), dy = p.track->y[i] - q.y.dot(powers);
        const double cubic = powers[1] * powers[2] - parabola.dot(powers);
        sum.all += dx * dx + dy * dy;
        x_along += dx * cubic;
        y_along += dy * cubic;
        length += cubic * cubic;
      }
      sum.cubic += (x_along * x_along + y_along * y_along) / length;
    }
  if (used == 0) return Left{};
  const double both = 2.0 * static_cast<double>(used);
  return Left{sum.all / (both * static_cast<double>(window - 3)), sum.cubic / both};
}

/// Variances of noise and of bias (m^2/s^2) of the velocity in the middle of a window, for these
/// residuals and this variance of places (m^2).
struct VelocityErrors {
  double noise, bias;
};
VelocityErrors velocity_errors(int window, double interval, const Left& left, double variance) {
  // A third derivative j leaves a residual j u^3 / 6 over u in [-h, h], with mean square j^2 h^6
  // (1/7 - 3/25) / 36, and a slope error of j h^2 / 10 in the middle.
  constexpr double kBias = 36.0 / 100.0 / (1.0 / 7.0 - 3.0 / 25.0);
  const double w = window, h2 = 0.25 * (w * w - 1.0) * interval * interval;
  return {3.0 * variance / (w * h2), kBias * std::max(0.0, left.cubic - variance) / (w * h2)};
}

}  // namespace

SmoothPath smoothed(const TrackPiece& piece, int window) {
  const Track& track = *piece.track;
  const std::size_t n = piece.size(), w = std::min(n, static_cast<std::size_t>(window));
  SmoothPath path;
  path.time.assign(track.time.begin() + static_cast<std::ptrdiff_t>(piece.begin),
                   track.time.begin() + static_cast<std::ptrdiff_t>(piece.end));
  for (auto* values : {&path.x, &path.y, &path.vx, &path.vy, &path.velocity_gain})
    values->resize(n);
  std::size_t of = 0;  // where the window of q begins
  Quadratic q = fitted(track, piece.begin + of, w);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t begin = std::min(i - std::min(i, w / 2), n - w);
    if (begin != of) q = fitted(track, piece.begin + begin, w);
    of = begin;
    const Eigen::Vector3d powers = q.powers(path.time[i]), slopes = q.slopes(path.time[i]);
    path.x[i] = q.x.dot(powers);
    path.y[i] = q.y.dot(powers);
    path.vx[i] = q.x.dot(slopes);
    path.vy[i] = q.y.dot(slopes);
    path.velocity_gain[i] = slopes.dot(q.inverse * slopes);
  }
  return path;
}

double place_gain(int window) {
  const double w = window;
  return 3.0 * (3.0 * w * w - 7.0) / (4.0 * w * (w * w - 4.0));
}

TrackNoise noise_of(const std::vector<TrackPiece>& pieces, double interval,
                    std::optional<int> window) {
  const auto shortest = left_by_fits(pieces, kLeastWindow);
  if (!shortest)
    throw std::invalid_argument("no body was seen in " + std::to_string(kLeastWindow) +
                                " frames in a row, without a gap or a jump");
  const double variance = shortest->all;
  // Longer windows would fit only the few bodies that are seen for so long.
  std::size_t frames = 0;
  for (const TrackPiece& p : pieces) frames += p.size();
  const auto most_are_as_long = [&](int w) {
    std::size_t longer = 0;
    for (const TrackPiece& p : pieces)
      longer += p.size() >= static_cast<std::size_t>(w) ? p.size() : 0;
    return 2 * longer >= frames;
  };
  TrackNoise best;
  const auto known = [](const TrackNoise& noise) {
    if (noise.window == 0)
      throw std::invalid_argument(
          "times and places are too near to each other, or too far, to tell velocities");
    return noise;
  };
  double least = std::numeric_limits<double>::infinity();
  const auto try_window = [&](int w, const Left& left) {
    const auto [noise, bias] = velocity_errors(w, interval, left, variance);
    if (!(noise + bias < least)) return;
    least = noise + bias;
    best = {std::sqrt(variance), w, std::sqrt(noise), std::sqrt(bias)};
  };
  if (window) {
    try_window(*window,
               left_by_fits(pieces, static_cast<std::size_t>(*window)).value_or(*shortest));
    return known(best);
  }
  // Each window is longer than the one before by about a seventh. If the residuals far exceed the
  // noise, the paths are neither parabolas nor cubics.
  for (int w = kLeastWindow; w <= kMostWindow; w += 2 * std::max(1, w / 14)) {
    const auto left = left_by_fits(pieces, static_cast<std::size_t>(w));
    if (w > kLeastWindow && (!most_are_as_long(w) || !left || left->all > 2.0 * variance)) break;
    try_window(w, *left);
  }
  return known(best);
}

}  // namespace gatewalk::lattice
