#pragma once
/// The lateral random force of Eq. (1): F_rand = Rm N(0,1), drawn at 50 Hz and held in between.

#include <Random123/philox.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "dynamics/params.h"

namespace gatewalk::dynamics {

/// Names one random sequence. Counter-based: any trial can be replayed alone, on any thread.
struct Stream {
  std::uint64_t seed = 1;
  std::uint64_t row = 0;    // what is run: a row of the matrix, or a start
  std::uint64_t trial = 0;  // which repeat
};

/// Which experiment a stream belongs to, so that no two experiments share their randomness.
enum class Purpose : std::uint64_t {
  gate = 1,
  row = 2,
  field = 3,
  comparison = 4,
  resampling = 5,
  memory = 6,
  terrain = 7,
  rare = 8,
  sensitivity = 9
};

/// Uniform in (0, 1), both ends excluded: (n + 1/2) 2^-53, the last of which would round to 1.
[[nodiscard]] inline double open_uniform(std::uint64_t word) {
  return std::min((static_cast<double>(word >> 11) + 0.5) * 0x1p-53, 1.0 - 0x1p-53);
}

/// Words, uniforms and standard normals of one stream (Philox 4x64, Salmon et al. 2011).
class Random {
 public:
  Random(Purpose purpose, const Stream& s)
      : key_{{s.seed, (static_cast<std::uint64_t>(purpose) << 56) ^ s.row}}, trial_(s.trial) {}

  [[nodiscard]] std::uint64_t word() {
    if (used_ == 4) {
      words_ = r123::Philox4x64()({{block_++, trial_, 0, 0}}, key_);
      used_ = 0;
    }
    return words_[used_++];
  }
  [[nodiscard]] double uniform() { return open_uniform(word()); }
  /// A whole number in [0, n).
  [[nodiscard]] std::int64_t below(std::int64_t n) {
    __extension__ using Wide = unsigned __int128;
    return static_cast<std::int64_t>((static_cast<Wide>(word()) * static_cast<Wide>(n)) >> 64);
  }

  /// As many standard normals at once as keep the longest registers busy (Google Highway), with the
  /// same bits for any instruction set and any C library.
  using Normals = std::array<double, 32>;
  void normals(Normals& out);

  /// One standard normal, Box-Muller in double; two uniforms give two: the plain reference of
  /// normals(), which takes the same uniforms in the same order and differs in the last digits.
  [[nodiscard]] double normal() {
    if (has_spare_) {
      has_spare_ = false;
      return spare_;
    }
    const double radius = std::sqrt(-2.0 * std::log(uniform()));
    const double angle = 2.0 * std::numbers::pi * uniform();
    spare_ = radius * std::sin(angle);
    has_spare_ = true;
    return radius * std::cos(angle);
  }

 private:
  r123::Philox4x64::key_type key_;
  std::uint64_t trial_;
  std::uint64_t block_ = 0;
  r123::Philox4x64::ctr_type words_{};
  std::size_t used_ = 4;
  double spare_ = 0.0;
  bool has_spare_ = false;
};

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
