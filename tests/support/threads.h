// SPDX-License-Identifier: MIT
#pragma once
/// Runs work on a given number of threads, even if the machine has fewer.

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

namespace gatewalk::test {

template <class Work>
auto on_threads(int n, Work work) {
  const tbb::global_control allow(tbb::global_control::max_allowed_parallelism, n);
  tbb::task_arena arena(n);
  return arena.execute(work);
}

}  // namespace gatewalk::test
