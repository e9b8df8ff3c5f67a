// SPDX-License-Identifier: MIT
#pragma once
/// The lateral random force of Eq. (1): F_rand = Rm N(0,1), drawn at 50 Hz by default and held in
/// between.

#include "dynamics/base/points.h"
#include "dynamics/base/random.h"
#include "dynamics/disc/params.h"

namespace gatewalk::dynamics {

inline constexpr std::size_t kSlowBlocks = std::tuple_size_v<Random::Normals>;

/// The random force on one body. The force continues across gates, because each body has its own
/// clock.
class RandomForce {
 public:
  /// Makes the force; `sign` -1 gives the mirror image of the same sequence.
  RandomForce(const Forces& f, Random random, double sign = 1.0)
      : random_(random), sign_(sign), scale_(sign * f.random), hold_(1.0 / f.random_rate) {}

  /// Enters a gate with other forces: the sequence continues, and the current draw is held on.
  void enter(const Forces& f) {
    scale_ = sign_ * f.random;
    hold_ = 1.0 / f.random_rate;
    value_ = scale_ * normal_;
  }

  /// The current force (N), valid for left() more seconds (> 0). Draws anew once the last draw has
  /// expired.
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
  /// The last draw, in units of the force's standard deviation; 0 before the first.
  [[nodiscard]] double last_draw() const { return sign_ * normal_; }
  void pass(double seconds) { left_ -= seconds; }
  /// Keeps the current draw until its end; later draws come from another sequence.
  void go_on_with(Random random) {
    random_ = random;
    used_ = normals_.size();
    next_block_ = kSlowBlocks;
  }
  /// Keeps the current draw until its end; the point determines the slowest parts of the next
  /// kSlowBlocks * `block` draws (`block`: a power of 2, at most 32). These parts are the slowest
  /// cosine modes (DCT-II) of the block means, one for each number of the point. The rest is
  /// random, so that uniform points give independent standard normals.
  void lay(const Point& point, int block);
  /// Ends the current hold; the next draw of the sequence begins now.
  void drop_hold() { left_ = 0.0; }

 private:
  // Steps add up to a hold within a relative error of 1e-6 (see validate); a smaller rest gets no
  // draw.
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
  // For each block, the prescribed sum of its normals divided by the root of their number.
  std::array<double, kSlowBlocks> slow_{};
  std::size_t next_block_ = kSlowBlocks;
  std::size_t block_ = 1;

  void draw();
};

}  // namespace gatewalk::dynamics
