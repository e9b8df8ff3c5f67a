// SPDX-License-Identifier: MIT
#pragma once
/// Full dynamics of a disc through a field of gates: what only our gate has of it, a start inside a
/// gate, beams that go on behind the body (field.fidelity), a trial in every step.

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "dynamics/disc/disc_section.h"
#include "dynamics/disc/trace.h"
#include "lattice/field/field_trials.h"
#include "lattice/gates/gates.h"

namespace gatewalk::lattice {

/// As run_field of cells, from a start that may lie inside the first gate. field.fidelity says what
/// a gate is: fresh, with beams at rest, whenever the body enters (active), or one of many that go
/// on and act beyond their bounds (remember, all; field_stepper.h). The random force goes on from
/// gate to gate; its stream is {seed, stream_row(p, start), trial} whatever the fidelity, p the
/// gate that trials start in. run.time_limit_s counts from the entry into a gate. Throws
/// InvalidParameter, also for gates of several types with another fidelity than `active`.
[[nodiscard]] FieldTally run_field(const FieldGates& gates, const FieldParams& field,
                                   const dynamics::BodyState& start, std::uint64_t seed,
                                   dynamics::TrialRange range, FieldTrials* each = nullptr,
                                   const dynamics::StateSpace* space = nullptr,
                                   Memory memory = Memory::kept);

/// A trial through the field in full.
struct FieldTrace {
  struct Visit {
    int column = 0, row = 0, type = 0;  // the gate's, of the field's types
    dynamics::GateTrace
        trace;  // in the gate's own frame and time, work and losses from its entry on
  };
  std::vector<Visit> visits;
  std::optional<markov::Ending> ending;  // none: a run stopped being finite
};

/// Trial number `trial` of run_field, the same to the last bit; with a `choice` of types of gates
/// that of chosen_trials from this start. Throws InvalidParameter, also for another fidelity than
/// `active`, and TraceTooLong when all visits together have more samples.
[[nodiscard]] FieldTrace trace_field(
    const FieldGates& gates, const FieldParams& field, const dynamics::BodyState& start,
    std::uint64_t seed, std::int64_t trial,
    std::size_t most_samples = std::numeric_limits<std::size_t>::max(),
    const CellChoice& choice = {});

}  // namespace gatewalk::lattice
