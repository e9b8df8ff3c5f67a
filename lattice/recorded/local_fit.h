// SPDX-License-Identifier: MIT
#pragma once
/// Smooth places and velocities along tracks by local parabolas, each fitted by least squares to
/// the frames around one (Savitzky and Golay, 1964), and the noise of tracks that the fits'
/// residuals show.

#include <cstddef>
#include <optional>
#include <vector>

#include "lattice/recorded/tracks.h"

namespace gatewalk::lattice {

/// Frames begin to end - 1 of a track, without a gap or jump in between.
struct TrackPiece {
  const Track* track;
  std::size_t begin, end;
  [[nodiscard]] std::size_t size() const { return end - begin; }
};

inline constexpr int kLeastWindow = 5, kMostWindow = 101;  // frames, odd

/// The smooth path of a piece, by frame. The first and last frames use the fits of the first and
/// last window.
struct SmoothPath {
  std::vector<double> time;          // s
  std::vector<double> x, y, vx, vy;  // m, m/s
  /// s^-2: variance of a velocity over the variance of a measured place
  std::vector<double> velocity_gain;
};
/// Smooths a piece with `window` frames per fit, or all frames of a shorter piece, which must have
/// at least kLeastWindow.
[[nodiscard]] SmoothPath smoothed(const TrackPiece& piece, int window);

/// Variance of a fitted place over the variance of a measured one, in the middle of a window of
/// equal steps.
[[nodiscard]] double place_gain(int window);

/// The noise of tracks, and of the velocities fitted to them.
struct TrackNoise {
  /// m, standard deviation of each of x and y, from the residuals of the shortest fits; assumed
  /// independent from frame to frame
  double place = 0.0;
  int window = 0;              // frames per fit
  double velocity = 0.0;       // m/s, noise of a velocity in the middle of a window
  double velocity_bias = 0.0;  // m/s, root mean square of the bias of a velocity by smoothing
};
/// Estimates the noise. Without a `window`, chooses the one with the least mean square error of
/// velocities (noise and bias), estimated from the residuals of longer and longer windows.
/// `interval`: from frame to frame, s. Throws std::invalid_argument if no piece is as long as the
/// shortest fit.
[[nodiscard]] TrackNoise noise_of(const std::vector<TrackPiece>& pieces, double interval,
                                  std::optional<int> window);

}  // namespace gatewalk::lattice
