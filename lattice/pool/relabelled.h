// SPDX-License-Identifier: MIT
#pragma once
/// The runs of a pool with other labels of their faces and types.

#include <cstddef>
#include <utility>

#include "lattice/pool/run_pool.h"

namespace gatewalk::lattice {

/// The trials with new labels: label.begin(start) gives the entry of a trial's start, then
/// label.next(passage) each of its passages.
template <class Label>
[[nodiscard]] FieldTrials relabelled(const FieldTrials& trials, const dynamics::Section& section,
                                     Label& label, const auto& start_of) {
  FieldTrials all{.final_gates = {}, .bodies = trials.bodies, .keep_passages = true};
  all.passages.begin(section);
  all.passages.reserve(trials.passages.size());
  all.passed = trials.passed;
  for (std::size_t i = 0; i < trials.passed.size(); ++i) {
    static_cast<void>(label.begin(start_of(i)));  // follows the body from there
    for (const CellPassage passage : trials.of_trial(i))
      all.passages.push_back(label.next(passage));
  }
  return all;
}

template <class Label>
[[nodiscard]] RunPool relabelled(const RunPool& pool, const dynamics::Section& section,
                                 Label label) {
  RunPool all;
  for (const OwnRuns& s : pool.starts) {
    const auto start = [&](std::size_t) { return s.start; };
    all.starts.push_back({.start = label.begin(s.start),
                          .full = relabelled(s.full, section, label, start),
                          .first = relabelled(s.first, section, label, start)});
  }
  for (const dynamics::Entry& start : pool.scattered.starts)
    all.scattered.starts.push_back(label.begin(start));
  all.scattered.each = relabelled(pool.scattered.each, section, label,
                                  [&](std::size_t i) { return pool.scattered.starts[i]; });
  return all;
}

}  // namespace gatewalk::lattice
