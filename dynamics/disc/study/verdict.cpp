// SPDX-License-Identifier: MIT
#include "dynamics/disc/study/verdict.h"

namespace gatewalk::dynamics {

Verdict judge(const Health& h, std::int64_t out_of_work, double permitted) {
  const double runs = permitted * static_cast<double>(h.runs);
  const double steps = static_cast<double>(h.steps);
  const auto over = [](std::int64_t n, double limit) { return static_cast<double>(n) > limit; };
  if (h.broken > 0) return Verdict::not_finite;
  if (out_of_work > 0 || h.piled_up()) return Verdict::stuck;
  if (over(h.unstable, runs)) return Verdict::beyond_bound;
  if (over(h.penetrating, runs)) return Verdict::penetration;
  if (over(h.creating_energy, runs)) return Verdict::energy;
  if (h.outcomes_off()) return Verdict::outcomes;
  if (over(h.fast, runs)) return Verdict::too_fast;
  if (over(h.undefined_contacts, permitted * steps)) return Verdict::no_formula;
  return Verdict::fine;
}

}  // namespace gatewalk::dynamics
