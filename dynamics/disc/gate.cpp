// SPDX-License-Identifier: MIT
#include "dynamics/disc/gate.h"

#include <algorithm>
#include <utility>

namespace gatewalk::dynamics {
namespace {

bool finite(const GateState& s) {
  const double sum = s.body.x + s.body.y + s.body.vx + s.body.vy + s.beams[kLeft].theta +
                     s.beams[kLeft].omega + s.beams[kRight].theta + s.beams[kRight].omega;
  return std::isfinite(sum);
}

}  // namespace

void settle_energy(const GateParams& p, const BodyState& start, GateRun& run) {
  const auto kinetic = [&](const BodyState& b) {
    return 0.5 * p.body.mass * (b.vx * b.vx + b.vy * b.vy);
  };
  run.forward = run.exit.y - start.y;
  run.propulsion_work = p.forces.propulsion * run.forward;
  run.lost = run.propulsion_work + run.random_work - (kinetic(run.exit) - kinetic(start));
}

void add_run(Health& health, const GateParams& p, const GateRun& run) {
  const Watch& w = run.watch;
  const double energy_scale =
      p.forces.propulsion * p.run.traverse_y + 0.5 * p.body.mass * w.max_speed * w.max_speed;
  ++health.runs;
  health.penetrating += w.max_penetration > 0.01 * p.body.radius;
  health.creating_energy += w.energy_created > 1e-4 * energy_scale;
  health.fast += w.fast_steps > 0;
  health.unstable += w.unstable_steps > 0;
  health.broken += run.outcome == Outcome::broken && !run.out_of_work;
  health.undefined_contacts += w.undefined_contacts;
  health.forced_holds += w.forced_holds;
  health.impacts += w.impacts;
  health.steps += w.steps;
  health.evaluations += w.evaluations;
  health.worst_penetration = std::max(health.worst_penetration, w.max_penetration);
  health.worst_energy_created = std::max(health.worst_energy_created, w.energy_created);
  health.worst_speed = std::max(health.worst_speed, w.max_speed);
}

Outcome outcome_of(const GateParams& p, const GateState& s, const Watch& watch) {
  if (!finite(s)) return Outcome::broken;
  if (s.body.y > p.run.traverse_y) {
    const double left = watch.max_theta[kLeft], right = watch.max_theta[kRight];
    return left > right   ? Outcome::traversed_left
           : right > left ? Outcome::traversed_right
                          : Outcome::traversed_even;
  }
  if (s.body.x < -p.beams.joint_x) return Outcome::exited_left;
  if (s.body.x > p.beams.joint_x) return Outcome::exited_right;
  return Outcome::trapped;
}

GateRun run_gate(const GateParams& p, const Method& method, const BodyState& start,
                 RandomForce& force, std::int64_t most_work, EnergyLedger::Follow follow) {
  GateState s{start, {}};
  GateRun run;
  EnergyLedger ledger(p, s, std::move(follow));
  const double nearly_over = p.run.time_limit - 1e-6 * p.run.step;
  while (!outside(p, s.body) && run.seconds < nearly_over) {
    run.out_of_work = std::max(run.watch.steps, run.watch.evaluations) > most_work;
    if (run.out_of_work) break;
    const double f = force.value();
    const double spell = std::min(force.left(), p.run.time_limit - run.seconds);
    const double passed = method.advance(s, f, spell, ledger, run.watch);
    force.pass(passed);
    run.seconds += passed;
    if (!finite(s)) break;
  }
  run.exit = s.body;
  if (!run.out_of_work) run.outcome = outcome_of(p, s, run.watch);
  run.random_work = ledger.random_work();
  settle_energy(p, start, run);
  return run;
}

}  // namespace gatewalk::dynamics
