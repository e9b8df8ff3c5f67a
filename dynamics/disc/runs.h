// SPDX-License-Identifier: MIT
#pragma once
/// Many gate runs, for any purpose. A trial is one run, or a sequence of runs that each depend on
/// the last one (gate after gate through the field).

#include <cstdint>
#include <functional>
#include <limits>

#include "dynamics/disc/gate.h"

namespace gatewalk::dynamics {

/// A run to be carried out: its trial, its start and its random force.
struct RunSlot {
  std::int64_t trial = -1;
  BodyState start;
  RandomForce force;
};

/// A source of runs. It is called with a slot and the result of the slot's last run (null before
/// the first). The function stores the result and either puts the next run into the slot and
/// returns true, or returns false: the slot gets no more runs. Slots may be called in any order.
using NextRun = std::function<bool(RunSlot& slot, const GateRun* ended)>;

inline constexpr std::int64_t kAnyWork = std::numeric_limits<std::int64_t>::max();

/// Carries out runs on this thread until `next` returns false, each as run_gate does. Method
/// `stable` runs hundreds at a time (stable_lanes.h), each in its own slot, at most `at_once`.
/// Method `moreau` runs several (lanes.h), unless a run could take more than `most_work`. Other
/// methods run one after the other. The result of a run depends on its slot alone.
void carry_out(const GateParams& p, const Method& method, const NextRun& next,
               std::int64_t most_work = kAnyWork, std::int64_t at_once = kAnyWork);

/// Puts the first run of trial slot.trial into the slot.
using BeginTrial = std::function<void(RunSlot& slot)>;
/// Receives the result of a run. Returns true if the slot now holds another run of the same trial.
using TakeRun = std::function<bool(RunSlot& slot, const GateRun& run)>;

/// Carries out all runs of trials 0 .. count - 1 on all threads of the current TBB arena. Several
/// threads call both functions at once, for different trials.
void carry_out_trials(const GateParams& p, const Method& method, std::int64_t count,
                      const BeginTrial& begin, const TakeRun& take,
                      std::int64_t most_work = kAnyWork);

}  // namespace gatewalk::dynamics
