// SPDX-License-Identifier: MIT
#pragma once
/// Full dynamics of a disc through a field of gates, with what only gates have: a start inside a
/// gate, beams that move on behind the body (field.fidelity), and a trace of every step.

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "dynamics/disc/disc_section.h"
#include "dynamics/disc/trace.h"
#include "lattice/field/field_trials.h"
#include "lattice/gates/gates.h"

namespace gatewalk::lattice {

/// Runs trials through a field of gates, from a start that may lie inside the first gate.
/// field.fidelity says which gates move: only a fresh gate with beams at rest (active), or many
/// gates that act beyond their bounds (remember, all; field_stepper.h). The random force continues
/// from gate to gate. Its stream is {seed, stream_row(p, start), trial} for every fidelity, with p
/// the gate that trials start in. run.time_limit_s counts from the entry into a gate. Throws
/// InvalidParameter, also for gates of several types with a fidelity other than `active`.
[[nodiscard]] FieldTally run_field(const FieldGates& gates, const FieldParams& field,
                                   const dynamics::BodyState& start, std::uint64_t seed,
                                   dynamics::TrialRange range, FieldTrials* each = nullptr,
                                   const dynamics::StateSpace* space = nullptr,
                                   Memory memory = Memory::kept);

/// One trial through the field, with the trace of every gate visited.
struct FieldTrace {
  struct Visit {
    int column = 0, row = 0, type = 0;  // of the gate, type: index into the field's types
    dynamics::GateTrace
        trace;  // in the gate's own frame and time; work and losses count from the entry
  };
  std::vector<Visit> visits;
  std::optional<markov::Ending> ending;  // none: a run became non-finite
};

/// The trace of trial number `trial` of run_field, equal to the last bit; with a `choice` of gate
/// types, of chosen_trials from this start. Throws InvalidParameter, also for a fidelity other than
/// `active`, and TraceTooLong if all visits together have more than `most_samples` samples.
[[nodiscard]] FieldTrace trace_field(
    const FieldGates& gates, const FieldParams& field, const dynamics::BodyState& start,
    std::uint64_t seed, std::int64_t trial,
    std::size_t most_samples = std::numeric_limits<std::size_t>::max(),
    const CellChoice& choice = {});

}  // namespace gatewalk::lattice
