// SPDX-License-Identifier: MIT
#pragma once
/// Ranges of trials by number, and long work that reports its progress and can be stopped.

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

class KeptPieces;  // KeptPieces and Ranks belong to the program and are not installed
class Ranks;

/// The trials numbered first, first + 1, ..., first + count - 1. The number names a trial, so any
/// split over calls, threads or machines gives the same trials.
struct TrialRange {
  std::int64_t first = 0;
  std::int64_t count = 0;
};

/// A set of trial numbers, kept as ranges that neither touch nor overlap. Sums over trial sets can
/// be added in any order, and no trial is counted twice.
class TrialSet {
 public:
  TrialSet() = default;
  explicit TrialSet(TrialRange range) { add(range); }

  /// Adds trials. Throws std::invalid_argument naming a trial that the set holds already; the set
  /// is then unchanged.
  void add(TrialRange range);
  void add(const TrialSet& other);

  [[nodiscard]] std::int64_t count() const;
  [[nodiscard]] const std::map<std::int64_t, std::int64_t>& ranges() const { return ends_; }
  friend bool operator==(const TrialSet&, const TrialSet&) = default;

  /// Writes the set to an archive or reads the set from one (see bytes.h). Reading throws
  /// std::runtime_error for ranges that no set can have.
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
  std::map<std::int64_t, std::int64_t> ends_;  // first trial -> one past the last trial
};

/// How the caller of long work follows and stops the work. `told` receives progress; by default
/// nobody is told. The program also sets `kept`, which stores finished pieces, and `ranks`, the
/// processes that share the work.
struct Work {
  /// Called before each piece and at the end: `done` of `total` items of `what` are finished. The
  /// function may throw to stop the work.
  std::function<void(std::string_view what, std::int64_t done, std::int64_t total)> told;
  KeptPieces* kept = nullptr;
  Ranks* ranks = nullptr;

  /// Calls run(range) for consecutive ranges that together cover [0, total) exactly once. A range
  /// takes about 0.3 s and holds at least `together` items. The ranges depend on the machine's
  /// speed, so results must not depend on how [0, total) is cut.
  void in_pieces(std::string_view what, std::int64_t total,
                 const std::function<void(TrialRange)>& run, std::int64_t together = 1) const;

  /// Whether this run does only its part of a run that is divided over machines. A part has only
  /// some of the trials, and therefore no result.
  [[nodiscard]] bool is_part() const;
  /// Call this where all trials are needed from here on: it ends a run that is only a part, by the
  /// exception of KeptPieces::end_part, and does nothing in a whole run.
  void end_part() const;

  /// The work of part `index` of `count` equal parts. Progress of the part is reported under the
  /// name `what`, as a share of the whole.
  [[nodiscard]] Work part(std::string what, std::size_t index, std::size_t count) const;
  /// The work of a part of any size: from `from` to `from + size` of `total`. Progress of the part
  /// is reported under the name `what`, as a share of the whole.
  [[nodiscard]] Work part(std::string what, double from, double size, std::int64_t total) const;

  void tell(std::string_view what, std::int64_t done, std::int64_t total) const {
    if (told) told(what, done, total);
  }
};

/// A clock that counts the seconds since its construction.
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
