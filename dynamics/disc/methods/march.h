// SPDX-License-Identifier: MIT
#pragma once
/// How fixed-step methods step through a spell of constant force.

#include <algorithm>

#include "dynamics/disc/methods/method.h"

namespace gatewalk::dynamics {

/// Equal steps that fill a duration: of length run.step, or shorter if the duration (the rest of a
/// hold) is not a whole number of these.
struct Spell {
  double duration;  // s
  long steps;
  double step;  // s
  bool usual;   // step == run.step

  Spell(const GateParams& p, double seconds) : duration(seconds) {
    const double wanted = duration / p.run.step;
    steps = std::max<long>(1, std::lround(std::ceil(wanted - 1e-6)));
    usual = std::abs(wanted - static_cast<double>(steps)) < 1e-6;
    step = usual ? p.run.step : duration / static_cast<double>(steps);
  }
};

/// Takes the steps of `spell`, each by `one_step(s)`, and stops when the body leaves the gate or
/// the state is no longer finite. After each step, `stored(s)` returns the energy (J) that the
/// method keeps outside the state. Returns the seconds advanced.
template <class OneStep, class Stored>
double march(const GateParams& p, const Spell& spell, GateState& s, double force_x,
             EnergyLedger& ledger, Watch& watch, OneStep one_step, Stored stored) {
  for (long i = 0; i < spell.steps; ++i) {
    const GateState before = s;
    one_step(s);
    const bool finite = std::isfinite(s.body.vx + s.body.vy);
    const bool left = finite && outside(p, s.body);
    double passed = spell.step;
    if (left) {
      const auto beams = s.beams;
      passed = back_to_exit(p, before, s, spell.step);
      s.beams = mixed(before.beams, beams, passed / spell.step);
    }
    ledger.step(s, force_x, passed, watch, stored(s));
    watch.state(p, s, spell.step);
    if (left || !finite) return static_cast<double>(i) * spell.step + passed;
  }
  return spell.duration;
}

}  // namespace gatewalk::dynamics
