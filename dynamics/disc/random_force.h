// SPDX-License-Identifier: MIT
#pragma once
/// The lateral random force of Eq. (1): F_rand = Rm N(0,1), drawn at 50 Hz and held in between.

#include "dynamics/base/points.h"
#include "dynamics/base/random.h"
#include "dynamics/disc/params.h"

namespace gatewalk::dynamics {

inline constexpr std::size_t kSlowBlocks = std::tuple_size_v<Random::Normals>;

/// The held force. It goes on across gates: its clock is the body's, not the gate's.
class RandomForce {
 public:
  /// `sign` -1 gives the mirror image of the same sequence.
  RandomForce(const Forces& f, Random random, double sign = 1.0)
      : random_(random), sign_(sign), scale_(sign * f.random), hold_(1.0 / f.random_rate) {}

  /// From now on in a gate with these forces: the same sequence, the draw in force held on.
  void enter(const Forces& f) {
    scale_ = sign_ * f.random;
    hold_ = 1.0 / f.random_rate;
    value_ = scale_ * normal_;
  }

  /// Force in force now (N), for another left() seconds > 0. Draws when the last one has run out.
  [[nodiscard]] double value() {
    if (left_ <= kSliver * hold_) {
      if (used_ == normals_.size()) draw();
      normal_ = normals_[used_++];
      value_ = scale_ * normal_;
      left_ = hold_;
    }
    return value_;
  }
  [[nodiscard]] double left() const { return left_; }
  void pass(double seconds) { left_ -= seconds; }
  /// The draw in force is held on; those after it are of another sequence.
  void go_on_with(Random random) {
    random_ = random;
    used_ = normals_.size();
    next_block_ = kSlowBlocks;
  }
  /// The draw in force is held on. Of those after it, kSlowBlocks times `block` (a power of 2, at
  /// most 32), the slowest parts are laid by the point: their means over blocks, and of these the
  /// slowest cosine modes (DCT-II), as many as a point has numbers. The rest of them is drawn, so
  /// that by uniform points all are independent standard normals.
  void lay(const Point& point, int block);
  /// Drops the rest of the hold: the next draw of the sequence comes now.
  void drop_hold() { left_ = 0.0; }

 private:
  // Steps may add up to a hold with a relative error of 1e-6 (see validate): no draw for the rest.
  static constexpr double kSliver = 2e-6;
  Random random_;
  double sign_;
  double scale_;
  double hold_;
  double left_ = 0.0;
  double normal_ = 0.0;
  double value_ = 0.0;
  Random::Normals normals_{};
  std::size_t used_ = normals_.size();
  // Laid: of each block's normals the sum over the root of their number.
  std::array<double, kSlowBlocks> slow_{};
  std::size_t next_block_ = kSlowBlocks;
  std::size_t block_ = 1;

  void draw();
};

}  // namespace gatewalk::dynamics
