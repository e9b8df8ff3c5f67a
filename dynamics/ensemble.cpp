#include "dynamics/ensemble.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <functional>

namespace gatewalk::dynamics {

GateRun run_gate_trial(const GateParams& p, const Method& method, const BodyState& start,
                       std::uint64_t seed, std::int64_t trial, std::int64_t most_work) {
  const Stream stream{seed, 0, static_cast<std::uint64_t>(trial)};
  RandomForce force(p.forces, Random(Purpose::gate, stream));
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
  return *this;
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
  const tbb::blocked_range<std::int64_t> trials(range.first, range.first + range.count);
  return tbb::parallel_reduce(
      trials, GateTally{},
      [&](const tbb::blocked_range<std::int64_t>& part, GateTally tally) {
        for (std::int64_t trial = part.begin(); trial != part.end(); ++trial) {
          const GateRun run = run_gate_trial(p, *method, start, seed, trial);
          ++tally.trials;
          tally.health.add(p, run);
          const double left = run.watch.max_theta[kLeft], right = run.watch.max_theta[kRight];
          switch (run.ending) {
            case Ending::traversed:
              ++(left > right   ? tally.traversed_left
                 : right > left ? tally.traversed_right
                                : tally.traversed_even);
              break;
            case Ending::exited_left: ++tally.exited_left; break;
            case Ending::exited_right: ++tally.exited_right; break;
            case Ending::trapped: ++tally.trapped; break;
            case Ending::broken: ++tally.broken; break;
          }
        }
        return tally;
      },
      [](GateTally a, const GateTally& b) { return a += b; });
}

}  // namespace gatewalk::dynamics
