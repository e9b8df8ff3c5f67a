// SPDX-License-Identifier: MIT
#include "lattice/pool/run_pool.h"

#include <algorithm>

namespace gatewalk::lattice {

using namespace dynamics;

std::size_t RunPool::place_of(const Entry& start) const {
  const auto own = std::find_if(starts.begin(), starts.end(),
                                [&](const OwnRuns& s) { return s.start == start; });
  return static_cast<std::size_t>(own - starts.begin());
}

std::int64_t RunPool::gate_runs() const {
  std::int64_t runs = std::ssize(scattered.each.passages);
  for (const OwnRuns& s : starts) runs += s.gate_runs();
  return runs;
}

std::int64_t RunPool::trials() const {
  std::int64_t trials = std::ssize(scattered.starts);
  for (const OwnRuns& s : starts) trials += std::ssize(s.full.passed);
  return trials;
}

FirstRow RunPool::first_row(const std::optional<Entry>& start) const {
  if (!start) return {};
  const std::size_t own = place_of(*start);
  return own < starts.size() ? FirstRow(&starts[own]) : FirstRow(*start);
}

std::int64_t RunPool::bodies() const {
  const std::vector<std::int32_t>& made = scattered.each.bodies;
  if (made.empty()) return trials();
  return trials() - std::ssize(made) + 1 + *std::max_element(made.begin(), made.end());
}

}  // namespace gatewalk::lattice
