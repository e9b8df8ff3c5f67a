// SPDX-License-Identifier: MIT
#include "dynamics/base/trial_set.h"

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <string>
#include <utility>

namespace gatewalk::dynamics {

void TrialSet::add(TrialRange range) {
  if (range.count <= 0) return;
  std::int64_t first = range.first, end = range.first + range.count;
  auto after = ends_.lower_bound(first);
  const bool follows = after != ends_.begin() && std::prev(after)->second > first;
  if (follows || (after != ends_.end() && after->first < end))
    throw std::invalid_argument("trial " +
                                std::to_string(follows ? first : std::max(first, after->first)) +
                                " is in the tally already");
  if (after != ends_.end() && after->first == end) {
    end = after->second;
    after = ends_.erase(after);
  }
  if (after != ends_.begin() && std::prev(after)->second == first)
    std::prev(after)->second = end;
  else
    ends_.emplace(first, end);
}

void TrialSet::add(const TrialSet& other) {
  TrialSet both = *this;
  for (const auto& [first, end] : other.ends_) both.add({first, end - first});
  *this = std::move(both);
}

std::int64_t TrialSet::count() const {
  std::int64_t n = 0;
  for (const auto& [first, end] : ends_) n += end - first;
  return n;
}

}  // namespace gatewalk::dynamics
