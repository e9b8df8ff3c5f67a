#include "dynamics/ensemble.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>

#include "dynamics/runs.h"

namespace gatewalk::dynamics {

RandomForce gate_force(const GateParams& p, std::uint64_t seed, std::int64_t trial) {
  return {p.forces, Random(Purpose::gate, {seed, 0, static_cast<std::uint64_t>(trial)})};
}

GateRun run_gate_trial(const GateParams& p, const Method& method, const BodyState& start,
                       std::uint64_t seed, std::int64_t trial, std::int64_t most_work) {
  RandomForce force = gate_force(p, seed, trial);
  return run_gate(p, method, start, force, most_work);
}

void Health::add(const GateParams& p, const GateRun& run) {
  const Watch& w = run.watch;
  const double energy_scale =
      p.forces.propulsion * p.run.traverse_y + 0.5 * p.body.mass * w.max_speed * w.max_speed;
  ++runs;
  penetrating += w.max_penetration > 0.01 * p.body.radius;
  creating_energy += w.energy_created > 1e-4 * energy_scale;
  fast += w.fast_steps > 0;
  unstable += w.unstable_steps > 0;
  broken += run.ending == Ending::broken;
  undefined_contacts += w.undefined_contacts;
  forced_holds += w.forced_holds;
  impacts += w.impacts;
  steps += w.steps;
  evaluations += w.evaluations;
  worst_penetration = std::max(worst_penetration, w.max_penetration);
  worst_energy_created = std::max(worst_energy_created, w.energy_created);
  worst_speed = std::max(worst_speed, w.max_speed);
}

Health& Health::operator+=(const Health& o) {
  runs += o.runs;
  penetrating += o.penetrating;
  creating_energy += o.creating_energy;
  fast += o.fast;
  unstable += o.unstable;
  broken += o.broken;
  undefined_contacts += o.undefined_contacts;
  forced_holds += o.forced_holds;
  impacts += o.impacts;
  steps += o.steps;
  evaluations += o.evaluations;
  worst_penetration = std::max(worst_penetration, o.worst_penetration);
  worst_energy_created = std::max(worst_energy_created, o.worst_energy_created);
  worst_speed = std::max(worst_speed, o.worst_speed);
  checked_trials += o.checked_trials;
  outcome_error = std::max(outcome_error, o.outcome_error);
  return *this;
}

void GateTally::add(const GateParams& p, const GateRun& run) {
  ++trials;
  health.add(p, run);
  const double left = run.watch.max_theta[kLeft], right = run.watch.max_theta[kRight];
  switch (run.ending) {
    case Ending::traversed:
      ++(left > right ? traversed_left : right > left ? traversed_right : traversed_even);
      break;
    case Ending::exited_left:
      ++exited_left;
      break;
    case Ending::exited_right:
      ++exited_right;
      break;
    case Ending::trapped:
      ++trapped;
      break;
    case Ending::broken:
      ++broken;
      break;
  }
}

GateTally& GateTally::operator+=(const GateTally& o) {
  trials += o.trials;
  traversed_left += o.traversed_left;
  traversed_right += o.traversed_right;
  traversed_even += o.traversed_even;
  exited_left += o.exited_left;
  exited_right += o.exited_right;
  trapped += o.trapped;
  broken += o.broken;
  health += o.health;
  return *this;
}

GateTally run_gate_trials(const GateParams& p, const BodyState& start, std::uint64_t seed,
                          TrialRange range) {
  const auto method = make_method(p);
  tbb::enumerable_thread_specific<GateTally> tallies;  // sums and largest values: any order will do
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
  return sum;
}

}  // namespace gatewalk::dynamics
