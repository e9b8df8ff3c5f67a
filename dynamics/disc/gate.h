// SPDX-License-Identifier: MIT
#pragma once
/// One run of one gate: flow until an exit, and what was seen on the way.

#include <array>
#include <cstdint>
#include <limits>
#include <string_view>

#include "dynamics/cells/health.h"
#include "dynamics/cells/section.h"
#include "dynamics/disc/contact.h"
#include "dynamics/disc/methods/method.h"
#include "dynamics/disc/random_force.h"

namespace gatewalk::dynamics {

/// How a run ends, and for one that traversed by which beam. `broken`: the state stopped being
/// finite numbers, which only a fault of the method makes, or the run was cut short.
enum class Outcome : std::uint8_t {
  traversed_left,   // the left beam had the larger deflection (Sec. III-B)
  traversed_right,  // the right beam had
  traversed_even,   // both deflected equally, to the last bit
  exited_left,
  exited_right,
  trapped,
  broken,  // not finite, or cut short
};
/// Its name in files and in words.
struct OutcomeName {
  Outcome outcome;
  std::string_view key, words;
};
/// All of them, in the order of Outcome, which is that of tallies, files and tables.
inline constexpr std::array kOutcomeNames{
    OutcomeName{Outcome::traversed_left, "traversed_left", "traversed left"},
    OutcomeName{Outcome::traversed_right, "traversed_right", "traversed right"},
    OutcomeName{Outcome::traversed_even, "traversed_even", "traversed evenly"},
    OutcomeName{Outcome::exited_left, "exited_left", "exited left"},
    OutcomeName{Outcome::exited_right, "exited_right", "exited right"},
    OutcomeName{Outcome::trapped, "trapped", "trapped"},
    OutcomeName{Outcome::broken, "not_finite", "not finite"},
};
inline constexpr std::size_t kOutcomes = kOutcomeNames.size();
[[nodiscard]] constexpr std::string_view name_of(Outcome outcome) {
  return kOutcomeNames[static_cast<std::size_t>(outcome)].words;
}
/// By whichever beam.
[[nodiscard]] constexpr bool is_traversed(Outcome outcome) {
  return outcome <= Outcome::traversed_even;
}

struct GateRun {
  Outcome outcome = Outcome::broken;
  BodyState exit;                                   // state at the end, in this gate's frame
  double seconds = 0.0;                             // simulated time
  double forward = 0.0;                             // m, from its start
  double propulsion_work = 0.0, random_work = 0.0;  // J, of the two forces
  double lost = 0.0;  // J: their work, less what the body has gained: to hits, dampers and drag,
                      // and what is left in the beams
  bool out_of_work = false;  // stopped because it took more work than was granted
  Watch watch;               // largest deflections, faults, work done
};

/// Fills in forward, propulsion_work and lost, from where the run began, its exit and random_work.
void settle_energy(const GateParams& p, const BodyState& start, GateRun& run);

/// Counts a run, and what went wrong in it.
void add_run(Health& health, const GateParams& p, const GateRun& run);

/// What a run takes.
enum class Cost : std::uint8_t { seconds, forward, propulsion_work, random_work, lost };
/// Its name in files, with the unit, and in words.
struct CostName {
  std::string_view key, unit, words;
};
/// All of them, in the order of Cost.
inline constexpr std::array kCostNames{
    CostName{"time_s", "s", "duration"},
    CostName{"forward_m", "m", "way forward"},
    CostName{"work_J", "J", "work of the propulsion"},
    CostName{"random_work_J", "J", "work of the random force"},
    CostName{"lost_J", "J", "energy lost: to hits, dampers and drag, and left in the beams"},
};
inline constexpr std::size_t kCosts = kCostNames.size();
static_assert(kCosts <= kMostCosts);
/// By Cost.
[[nodiscard]] inline Costs costs_of(const GateRun& run) {
  return {run.seconds, run.forward, run.propulsion_work, run.random_work, run.lost};
}

/// How a run has ended that stopped in this state; still inside is trapped.
[[nodiscard]] Outcome outcome_of(const GateParams& p, const GateState& s, const Watch& watch);

/// Runs one gate from `start` with both beams at rest, until the body is beyond traverse_y, beyond
/// a side, or time_limit is over. There is no exit at the bottom: propulsion brings the body back.
/// A run that takes more than `most_work` steps or evaluations is cut short: for studies of methods
/// that may crawl. It is looked at once per draw of the random force.
/// `follow` is told of every step of the method.
[[nodiscard]] GateRun run_gate(const GateParams& p, const Method& method, const BodyState& start,
                               RandomForce& force,
                               std::int64_t most_work = std::numeric_limits<std::int64_t>::max(),
                               EnergyLedger::Follow follow = {});

}  // namespace gatewalk::dynamics
