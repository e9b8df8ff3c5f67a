// SPDX-License-Identifier: MIT
#pragma once
/// Places and velocities along tracks: polynomials of second degree, each fitted by least squares
/// to the frames about one (Savitzky and Golay, 1964), and what the fits say of the tracks' noise.

#include <cstddef>
#include <optional>
#include <vector>

#include "lattice/recorded/tracks.h"

namespace gatewalk::lattice {

/// Frames begin to end - 1 of a track, without a gap or jump between.
struct TrackPiece {
  const Track* track;
  std::size_t begin, end;
  [[nodiscard]] std::size_t size() const { return end - begin; }
};

inline constexpr int kLeastWindow = 5, kMostWindow = 101;  // frames, odd

/// The path of a piece, by frame. At its ends the fits are those of the first and last window.
struct SmoothPath {
  std::vector<double> time;           // s
  std::vector<double> x, y, vx, vy;   // m, m/s
  std::vector<double> velocity_gain;  // s^-2: variance of a velocity over that of a measured place
};
/// `window` frames per fit, at most the piece's own, of which there are kLeastWindow at least.
[[nodiscard]] SmoothPath smoothed(const TrackPiece& piece, int window);

/// How much less a fitted place scatters than a measured one, amid a window of equal steps:
/// variance over variance.
[[nodiscard]] double place_gain(int window);

struct TrackNoise {
  double place = 0.0;     // m, standard deviation of each of x and y, from the residuals of the
                          // shortest fits; taken to be independent from frame to frame
  int window = 0;         // frames per fit
  double velocity = 0.0;  // m/s, what that makes of each velocity amid a window
  double velocity_bias = 0.0;  // m/s, root mean square of what the fits smooth away of one
};
/// Without a window the one whose velocities have the least mean square error, noise and bias
/// together: what fits of longer and longer windows leave tells it. `interval` is from frame to
/// frame (s). Throws std::invalid_argument when no piece is as long as the shortest fit.
[[nodiscard]] TrackNoise noise_of(const std::vector<TrackPiece>& pieces, double interval,
                                  std::optional<int> window);

}  // namespace gatewalk::lattice
