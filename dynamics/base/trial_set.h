// SPDX-License-Identifier: MIT
#pragma once
/// Which trials a tally holds.

#include <cstdint>
#include <limits>
#include <map>
#include <stdexcept>
#include <vector>

namespace gatewalk::dynamics {

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

  /// As a piece is kept (base/bytes.h).
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

}  // namespace gatewalk::dynamics
