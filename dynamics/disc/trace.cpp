// SPDX-License-Identifier: MIT
#include "dynamics/disc/trace.h"

#include <string>

namespace gatewalk::dynamics {
namespace {

/// The part of a sample that follows from its state.
TraceSample seen(const GateParams& p, const GateState& s) {
  TraceSample t;
  t.state = s;
  t.energy.body = 0.5 * p.body.mass * (s.body.vx * s.body.vx + s.body.vy * s.body.vy);
  for (const Side side : {kLeft, kRight}) {
    const BeamState& beam = s.beams[side];
    t.energy.beams[side] = 0.5 * p.beams.inertia() * beam.omega * beam.omega;
    t.energy.elastic[side] = 0.5 * p.beams.stiffness(side) * beam.theta * beam.theta;
    const Touch touch = nearest(p, side, s.body, beam.theta);
    t.nearest[side] = touch.kind;
    t.gap[side] = touch.gap;
  }
  return t;
}

}  // namespace

GateTrace trace_gate(const GateParams& p, const Method& method, const BodyState& start,
                     RandomForce& force, std::size_t most_samples) {
  GateTrace trace;
  trace.samples.push_back(seen(p, {start, {}}));
  const double at_start = trace.samples.front().energy.mechanical();
  Watch before;
  const auto follow = [&](const EnergyLedger::Step& step) {
    if (trace.samples.size() >= most_samples)
      throw TraceTooLong("a trace has more than " + std::to_string(most_samples) + " samples");
    const TraceSample& last = trace.samples.back();
    TraceSample t = seen(p, step.state);
    t.time = last.time + step.seconds;
    t.random_force = step.force_x;
    // Newton's law Eq. (2) over the step: the force of the beams is what the known forces leave.
    const BodyState &a = last.state.body, &b = step.state.body;
    if (step.seconds > 0.0) {
      const auto rest = [&](double dv, double known, double way) {
        return (p.body.mass * dv + p.forces.drag * way) / step.seconds - known;
      };
      t.beam_force = {rest(b.vx - a.vx, step.force_x, b.x - a.x),
                      rest(b.vy - a.vy, p.forces.propulsion, b.y - a.y)};
    }
    for (const Side side : {kLeft, kRight}) {
      t.impulse[side] = step.watch.impulse[side] - before.impulse[side];
      // Moreau's impulses act in every step of a lasting contact, which is no hit.
      const bool pushed = t.impulse[side] > 0.0, hits = step.watch.impacts > before.impacts;
      t.contact[side] = step.state.beams[side].held || (pushed && !hits) ? ContactMode::held
                        : pushed                                         ? ContactMode::hit
                                                                         : ContactMode::free;
    }
    t.energy.propulsion_work = step.propulsion_work;
    t.energy.random_work = step.random_work;
    t.energy.hit_loss = step.watch.hit_loss;
    t.energy.lost = at_start + step.propulsion_work + step.random_work - t.energy.mechanical();
    before = step.watch;
    trace.samples.push_back(t);
  };
  trace.run = run_gate(p, method, start, force, std::numeric_limits<std::int64_t>::max(), follow);
  return trace;
}

}  // namespace gatewalk::dynamics
