// SPDX-License-Identifier: MIT
#pragma once
/// The path of a body that was measured with noise, frame by frame: the Kalman smoother (Rauch,
/// Tung and Striebel, 1965) of a body whose velocity along each axis is an Ornstein-Uhlenbeck
/// process, as in correlated random walks of animals (Johnson et al., 2008), and paths drawn by
/// their probability given all measured places.

#include <cstddef>
#include <vector>

#include "dynamics/base/random.h"
#include "lattice/recorded/tracks.h"

namespace gatewalk::lattice {

/// Frames begin to end - 1 of a track, without a gap or jump in between.
struct TrackPiece {
  const Track* track;
  std::size_t begin, end;
  [[nodiscard]] std::size_t size() const { return end - begin; }
};

/// The number of frames that a piece must have.
inline constexpr std::size_t kLeastFrames = 5;

/// The noise of measured places, how fast bodies move, and how fast their velocities change.
struct TrackNoise {
  /// m, standard deviation of each of x and y; assumed independent from frame to frame
  double place = 0.0;
  double acceleration = 0.0;  // m^2/s^3, spectral density of the accelerations along each axis
  double square_speed = 0.0;  // m^2/s^2, variance of the velocity along each axis
};
/// Estimates noise and accelerations by maximum likelihood from stretches of tracks: the median of
/// the noise, and the mean of the accelerations without the largest twentieth, so that outliers of
/// a tracker do not count. The variance of velocities is the mean over these stretches. Throws
/// std::invalid_argument without pieces.
[[nodiscard]] TrackNoise noise_of(const std::vector<TrackPiece>& pieces);

/// A path by frame.
struct SmoothPath {
  std::vector<double> time;          // s
  std::vector<double> x, y, vx, vy;  // m, m/s
  /// m^2 and m^2/s^2, of each axis: what the measured places leave open
  std::vector<double> place_variance, velocity_variance;
  std::vector<double> acceleration;  // m^2/s^3, as TrackNoise, in the step to each frame
  double square_speed = 0.0;         // m^2/s^2, as TrackNoise
  double rate = 0.0;                 // 1/s, at which velocities are forgotten
};
/// The expected path of a piece. Accelerations are estimated anew along the piece, by the
/// expectation-maximisation algorithm with steps that are averaged over neighbours, so that a body
/// may rest and run.
[[nodiscard]] SmoothPath smoothed(const TrackPiece& piece, const TrackNoise& noise);
/// A path drawn by its probability given the measured places; `expected`: smoothed(piece, noise).
/// On average, drawn paths cross a border as often as the body does, where the expected path
/// crosses it too seldom.
[[nodiscard]] SmoothPath drawn_path(const TrackPiece& piece, const TrackNoise& noise,
                                    const SmoothPath& expected, dynamics::Random& random);

}  // namespace gatewalk::lattice
