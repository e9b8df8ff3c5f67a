// SPDX-License-Identifier: MIT
#include "dynamics/disc/ensemble.h"

#include <tbb/enumerable_thread_specific.h>

#include "dynamics/disc/runs.h"

namespace gatewalk::dynamics {

RandomForce gate_force(const GateParams& p, std::uint64_t seed, std::int64_t trial) {
  return {p.forces, Random(Purpose::gate, {seed, 0, static_cast<std::uint64_t>(trial)})};
}

GateRun run_gate_trial(const GateParams& p, const Method& method, const BodyState& start,
                       std::uint64_t seed, std::int64_t trial, std::int64_t most_work) {
  RandomForce force = gate_force(p, seed, trial);
  return run_gate(p, method, start, force, most_work);
}

void GateTally::add(const GateParams& p, const GateRun& run) {
  ++trials;
  ++counts[static_cast<std::size_t>(run.outcome)];
  add_run(health, p, run);
}

GateTally& GateTally::operator+=(const GateTally& o) {
  held.add(o.held);
  trials += o.trials;
  for (std::size_t k = 0; k < counts.size(); ++k) counts[k] += o.counts[k];
  health += o.health;
  return *this;
}

GateTally run_gate_trials(const GateParams& p, const BodyState& start, std::uint64_t seed,
                          TrialRange range) {
  const auto method = make_method(p);
  tbb::enumerable_thread_specific<GateTally> tallies;  // the order does not matter
  carry_out_trials(
      p, *method, range.count,
      [&](RunSlot& slot) {
        slot.start = start;
        slot.force = gate_force(p, seed, range.first + slot.trial);
      },
      [&](RunSlot&, const GateRun& run) {
        tallies.local().add(p, run);
        return false;
      });
  GateTally sum;
  for (const GateTally& part : tallies) sum += part;
  sum.held.add(range);
  return sum;
}

}  // namespace gatewalk::dynamics
