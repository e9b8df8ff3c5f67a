#include "dynamics/health.h"

#include <algorithm>

#include "dynamics/gate.h"

namespace gatewalk::dynamics {

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
  for (const HealthNumber& n : kHealthNumbers)
    if (n.count != nullptr)
      this->*n.count += o.*n.count;
    else
      this->*n.largest = std::max(this->*n.largest, o.*n.largest);
  return *this;
}

}  // namespace gatewalk::dynamics
