// SPDX-License-Identifier: MIT
#pragma once
/// CPU time of one thread.

#include <tbb/task_arena.h>
#include <time.h>

namespace gatewalk::lattice {

/// CPU seconds that `run` takes on one thread: what else the machine does counts little.
template <class Run>
double one_thread_seconds(const Run& run) {
  const auto cpu_seconds = [] {
    timespec now = {};
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
  };
  tbb::task_arena one(1);
  return one.execute([&] {
    const double before = cpu_seconds();
    run();
    return cpu_seconds() - before;
  });
}

}  // namespace gatewalk::lattice
