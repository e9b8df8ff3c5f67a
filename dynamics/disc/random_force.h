// SPDX-License-Identifier: MIT
#pragma once
/// The lateral random force of Eq. (1): F_rand = Rm N(0,1), drawn at 50 Hz and held in between.

#include "dynamics/base/random.h"
#include "dynamics/disc/params.h"

namespace gatewalk::dynamics {

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
      if (used_ == normals_.size()) {
        random_.normals(normals_);
        used_ = 0;
      }
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
  }
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
};

}  // namespace gatewalk::dynamics
