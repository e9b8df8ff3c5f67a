// SPDX-License-Identifier: MIT
#pragma once
/// Random numbers in named streams. The generator is counter-based, so any stream can be drawn
/// again on its own.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

namespace gatewalk::dynamics {

/// The name of one random sequence. Seed, row and trial give the same numbers on any thread, so any
/// trial can be replayed alone.
struct Stream {
  std::uint64_t seed = 1;
  std::uint64_t row = 0;    // what is simulated: a row of the matrix, or a start
  std::uint64_t trial = 0;  // number of the repeat
};

inline constexpr std::size_t kPointDimensions = 8;
/// A point of the unit cube, each number in (0, 1), that determines the noise of one passage
/// (Cell::lay_noise).
using Point = std::array<double, kPointDimensions>;

/// The experiment that a stream belongs to. Each experiment has a purpose of its own, so no two
/// experiments share random numbers.
enum class Purpose : std::uint64_t {
  gate = 1,
  row = 2,
  field = 3,
  comparison = 4,
  resampling = 5,
  memory = 6,
  terrain = 7,
  rare = 8,
  sensitivity = 9,
  points = 10,
  first_points = 11,
  plan = 12,
  indices = 13,
  design = 14,
  fit = 15,
  track = 16
};

/// A uniform number in (0, 1), both ends excluded: (n + 1/2) 2^-53. The largest n would round to 1
/// and gives 1 - 2^-53.
[[nodiscard]] inline double open_uniform(std::uint64_t word) {
  return std::min((static_cast<double>(word >> 11) + 0.5) * 0x1p-53, 1.0 - 0x1p-53);
}

/// The random numbers of one stream: 64-bit words, uniforms and standard normals (Philox 4x64,
/// Salmon et al. 2011).
class Random {
 public:
  Random(Purpose purpose, const Stream& s)
      : key_{s.seed, (static_cast<std::uint64_t>(purpose) << 56) ^ s.row}, trial_(s.trial) {}

  [[nodiscard]] std::uint64_t word() {
    if (used_ == 4) refill();
    return words_[used_++];
  }
  [[nodiscard]] double uniform() { return open_uniform(word()); }
  /// A random integer in [0, n).
  [[nodiscard]] std::int64_t below(std::int64_t n) {
    __extension__ using Wide = unsigned __int128;
    return static_cast<std::int64_t>((static_cast<Wide>(word()) * static_cast<Wide>(n)) >> 64);
  }

  /// A batch of 32 standard normals, computed in vector registers (Google Highway). The bits are
  /// the same for any instruction set and any C library.
  using Normals = std::array<double, 32>;
  void normals(Normals& out);

  /// One standard normal by Box-Muller in double precision: the plain reference for normals(). Both
  /// functions take the same uniforms in the same order and differ in the last digits.
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
  /// Not inline: code compiled without optimisation would slow down all callers.
  void refill();

  std::array<std::uint64_t, 2> key_;
  std::uint64_t trial_;
  std::uint64_t block_ = 0;
  std::array<std::uint64_t, 4> words_{};
  std::size_t used_ = 4;
  double spare_ = 0.0;
  bool has_spare_ = false;
};

}  // namespace gatewalk::dynamics
