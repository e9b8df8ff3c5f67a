// SPDX-License-Identifier: MIT
#include "dynamics/disc/runs.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <atomic>

#include "dynamics/disc/lanes.h"
#include "dynamics/disc/stable_lanes.h"

namespace gatewalk::dynamics {

void carry_out(const GateParams& p, const Method& method, const NextRun& next,
               std::int64_t most_work, std::int64_t at_once) {
  const auto* stable = dynamic_cast<const StableMethod*>(&method);
  if (stable != nullptr && lanes_pay_for_stable())
    return carry_out_in_lanes(p, *stable, next, most_work, at_once);
  if (p.run.method == "moreau" && most_evaluations_in_lanes(p) <= static_cast<double>(most_work))
    return carry_out_in_lanes(p, next);
  RunSlot slot{-1, {}, RandomForce(p.forces, Random(Purpose::gate, {}))};
  for (bool more = next(slot, nullptr); more;) {
    const GateRun run = run_gate(p, method, slot.start, slot.force, most_work);
    more = next(slot, &run);
  }
}

void carry_out_trials(const GateParams& p, const Method& method, std::int64_t count,
                      const BeginTrial& begin, const TakeRun& take, std::int64_t most_work) {
  // A free thread takes the next trial, so no lane waits for the end of a block.
  std::atomic<std::int64_t> next_trial{0};
  const NextRun next = [&](RunSlot& slot, const GateRun* ended) {
    if (ended != nullptr && take(slot, *ended)) return true;
    slot.trial = next_trial.fetch_add(1, std::memory_order_relaxed);
    if (slot.trial >= count) return false;
    begin(slot);
    return true;
  };
  const int threads = tbb::this_task_arena::max_concurrency();
  // A thread holds no more than its share.
  const std::int64_t each = (count + threads - 1) / threads;
  tbb::parallel_for(0, threads, [&](int) {
    try {
      carry_out(p, method, next, most_work, each);
    } catch (...) {
      next_trial = count;  // no thread takes another trial
      throw;
    }
  });
}

}  // namespace gatewalk::dynamics
