// SPDX-License-Identifier: MIT
#pragma once
/// Trials by their numbers, and long work that somebody may watch and stop.

#include <chrono>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace gatewalk::dynamics {

class KeptPieces;  // of this program alone, as is Ranks
class Ranks;

/// Trials first, first + 1, ... first + count - 1. A trial is named by its number, so any split
/// over calls, threads or machines gives the same trials.
struct TrialRange {
  std::int64_t first = 0;
  std::int64_t count = 0;
};

/// Trials by their numbers, as ranges that neither touch nor overlap: sums over them add in any
/// order, and no trial twice.
class TrialSet {
 public:
  TrialSet() = default;
  explicit TrialSet(TrialRange range) { add(range); }

  /// Throw std::invalid_argument naming a trial that is held already, and change nothing then.
  void add(TrialRange range);
  void add(const TrialSet& other);

  [[nodiscard]] std::int64_t count() const;
  [[nodiscard]] const std::map<std::int64_t, std::int64_t>& ranges() const { return ends_; }
  friend bool operator==(const TrialSet&, const TrialSet&) = default;

  /// As a piece of long work is kept.
  template <class Archive>
  friend void each_part(Archive& archive, TrialSet& set) {
    std::vector<TrialRange> ranges;
    for (const auto& [first, end] : set.ends_) ranges.push_back({first, end - first});
    archive(ranges);
    if constexpr (Archive::reads)
      for (const TrialRange& range : ranges) {
        if (range.first < 0 || range.count < 0 ||
            range.first > std::numeric_limits<std::int64_t>::max() - range.count)
          throw std::runtime_error("a kept piece has trials that there are not");
        set.add(range);
      }
  }

 private:
  std::map<std::int64_t, std::int64_t> ends_;  // first -> one past the last
};

/// Whoever starts long work says here who is told how far it is; this program also who keeps what
/// is done, and which processes share it. Nobody by default.
struct Work {
  /// Told before each piece, and when all is done: `done` of `total` of what. May throw to stop.
  std::function<void(std::string_view what, std::int64_t done, std::int64_t total)> told;
  KeptPieces* kept = nullptr;
  Ranks* ranks = nullptr;

  /// Calls run(range) for consecutive ranges that cover [0, total) exactly once, each
  /// some 0.3 s long, of `together` at least. The ranges depend on the machine's speed, so results
  /// must not depend on how [0, total) is cut.
  void in_pieces(std::string_view what, std::int64_t total,
                 const std::function<void(TrialRange)>& run, std::int64_t together = 1) const;

  /// A part of a run knows some of its trials only, and has no result.
  [[nodiscard]] bool is_part() const;
  /// Where all trials are needed from here on: ends a part.
  void end_part() const;

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
