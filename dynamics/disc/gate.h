// SPDX-License-Identifier: MIT
#pragma once
/// One run through one gate: simulation until the body leaves, with a record of the run.

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

/// How a run ends; a traversal also names a beam. `broken`: the state stopped being finite, which
/// only a fault of the method causes, or the run was cut short.
enum class Outcome : std::uint8_t {
  traversed_left,   // the left beam had the larger deflection (Sec. III-B)
  traversed_right,  // the right beam had the larger deflection
  traversed_even,   // both deflections are equal to the last bit
  exited_left,
  exited_right,
  trapped,
  broken,  // not finite, or cut short
};
/// The name of an outcome in files and in words.
struct OutcomeName {
  Outcome outcome;
  std::string_view key, words;
};
/// The names of all outcomes, in the order of Outcome, which tallies, files and tables use.
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
/// Whether the body traversed the gate, by either beam.
[[nodiscard]] constexpr bool is_traversed(Outcome outcome) {
  return outcome <= Outcome::traversed_even;
}

struct GateRun {
  Outcome outcome = Outcome::broken;
  BodyState exit;                                   // state at the end, in this gate's frame
  double seconds = 0.0;                             // simulated time
  double forward = 0.0;                             // m, progress along y
  double propulsion_work = 0.0, random_work = 0.0;  // J, work of the two forces
  /// Energy (J) lost to hits, dampers and drag or left in the beams: the work of both forces less
  /// the energy that the body has gained.
  double lost = 0.0;
  bool out_of_work = false;  // stopped at the limit most_work
  Watch watch;               // record of the run: largest deflections, faults, evaluations
};

/// Computes forward, propulsion_work and lost of a run from its start, its exit and random_work.
void settle_energy(const GateParams& p, const BodyState& start, GateRun& run);

/// Adds a run and its numerical faults to `health`.
void add_run(Health& health, const GateParams& p, const GateRun& run);

/// The costs of a run.
enum class Cost : std::uint8_t { seconds, forward, propulsion_work, random_work, lost };
/// A cost's name in files (with its unit), its unit, and its name in words.
struct CostName {
  std::string_view key, unit, words;
};
/// The names of all costs, in the order of Cost.
inline constexpr std::array kCostNames{
    CostName{"time_s", "s", "duration"},
    CostName{"forward_m", "m", "way forward"},
    CostName{"work_J", "J", "work of the propulsion"},
    CostName{"random_work_J", "J", "work of the random force"},
    CostName{"lost_J", "J", "energy lost: to hits, dampers and drag, and left in the beams"},
};
inline constexpr std::size_t kCosts = kCostNames.size();
static_assert(kCosts <= kMostCosts);
/// The costs of a run, in the order of Cost.
[[nodiscard]] inline Costs costs_of(const GateRun& run) {
  return {run.seconds, run.forward, run.propulsion_work, run.random_work, run.lost};
}

/// The outcome of a run that stopped in this state; a body still inside is trapped.
[[nodiscard]] Outcome outcome_of(const GateParams& p, const GateState& s, const Watch& watch);

/// Simulates one gate from `start`, with both beams at rest, until the body is beyond traverse_y or
/// a side, or time_limit is over. There is no exit at the bottom: the propulsion brings the body
/// back.
///
/// A run that takes more than `most_work` steps or evaluations is cut short, for studies of methods
/// that may become very slow; the limit is checked once per draw of the random force. `follow` is
/// called after every step of the method.
[[nodiscard]] GateRun run_gate(const GateParams& p, const Method& method, const BodyState& start,
                               RandomForce& force,
                               std::int64_t most_work = std::numeric_limits<std::int64_t>::max(),
                               EnergyLedger::Follow follow = {});

}  // namespace gatewalk::dynamics
