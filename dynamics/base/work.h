#pragma once
/// Long work in pieces that somebody may watch and stop.

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "dynamics/base/trial_set.h"

namespace gatewalk::dynamics {

/// How many items to do before looking up again: about 0.3 s of work, learnt from the pieces so
/// far. Starts with a single item and grows at most fourfold at a time.
class PieceSize {
 public:
  [[nodiscard]] std::int64_t get() const { return size_; }
  void measured(std::int64_t count, double seconds);

 private:
  std::int64_t size_ = 1;
};

/// Whoever starts long work says here who is told how far it is. Nobody by default.
struct Work {
  /// Told before each piece, and when all is done: `done` of `total` of what. May throw to stop.
  std::function<void(std::string_view what, std::int64_t done, std::int64_t total)> told;

  /// Calls run(range) for consecutive ranges that cover [0, total) exactly once, as long as
  /// PieceSize says. The ranges depend on the machine's speed, so results must not depend
  /// on how [0, total) is cut.
  void in_pieces(std::string_view what, std::int64_t total,
                 const std::function<void(TrialRange)>& run) const;

  /// Part number `index` of `count` of equal size, all under one name: what is told of it is told
  /// as that share of the whole.
  [[nodiscard]] Work part(std::string what, std::size_t index, std::size_t count) const;
  /// The same for parts of any size: from `from` to `from + size` of `total`.
  [[nodiscard]] Work part(std::string what, double from, double size, std::int64_t total) const;

  /// Tells it, if there is somebody.
  void tell(std::string_view what, std::int64_t done, std::int64_t total) const {
    if (told) told(what, done, total);
  }
};

/// Seconds since construction.
class Stopwatch {
 public:
  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(Clock::now() - start_).count();
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

}  // namespace gatewalk::dynamics
