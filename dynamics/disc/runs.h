// SPDX-License-Identifier: MIT
#pragma once
/// Gate runs by the thousand, whatever asks for them. A trial is one run, or several of which each
/// depends on how the last one ended (gate after gate through the field).

#include <cstdint>
#include <functional>
#include <limits>

#include "dynamics/disc/gate.h"

namespace gatewalk::dynamics {

/// What is run: from where, under which force. `trial` is whose run it is.
struct RunSlot {
  std::int64_t trial = -1;
  BodyState start;
  RandomForce force;
};

/// Called with a slot and what became of its last run (null before the first): the owner takes the
/// result, puts the next run into the slot and returns true, or returns false: there are no more
/// for this slot. Slots are asked in any order.
using NextRun = std::function<bool(RunSlot& slot, const GateRun* ended)>;

inline constexpr std::int64_t kAnyWork = std::numeric_limits<std::int64_t>::max();

/// Carries out runs on this thread until `next` has no more, each as run_gate does. Method `stable`
/// takes hundreds at a time (stable_lanes.h), each in a slot of its own, but not more than
/// `at_once`; `moreau` several (lanes.h), unless a run could take more than `most_work`; all others
/// one after the other. What becomes of a run depends on its slot alone.
void carry_out(const GateParams& p, const Method& method, const NextRun& next,
               std::int64_t most_work = kAnyWork, std::int64_t at_once = kAnyWork);

/// Puts the first run of a trial into the slot.
using BeginTrial = std::function<void(RunSlot& slot)>;
/// Takes the result of a run; true when another run of the same trial is in the slot now.
using TakeRun = std::function<bool(RunSlot& slot, const GateRun& run)>;

/// Carries out all runs of trials 0 .. count - 1 on all threads of the current TBB arena. Both
/// functions are called by several threads at once, for different trials.
void carry_out_trials(const GateParams& p, const Method& method, std::int64_t count,
                      const BeginTrial& begin, const TakeRun& take,
                      std::int64_t most_work = kAnyWork);

}  // namespace gatewalk::dynamics
