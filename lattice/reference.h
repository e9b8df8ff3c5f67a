#pragma once
/// The reference: the full dynamics of a body through the field, gate by gate, written plainly;
/// with or without memory and neighbours (field.fidelity).

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "dynamics/disc/disc_section.h"
#include "dynamics/disc/ensemble.h"
#include "dynamics/disc/trace.h"
#include "lattice/field.h"
#include "lattice/passage_table.h"
#include "markov/walk.h"

namespace gatewalk::lattice {

/// Counts of trials through the field. Tallies add in any order.
struct FieldTally {
  markov::CellCounts final_gates;  // (rows x columns), last gate inside the field
  std::int64_t trials = 0;
  dynamics::TrialSet held;  // which
  std::int64_t trapped = 0;
  std::int64_t left_field = 0;
  std::int64_t cut_off = 0;  // max_gates gates visited, would have gone on
  std::int64_t broken = 0;   // a run in it stopped being finite
  /// The same by markov::Ending, of which no trial is `unsampled`; the four edges: left_field.
  std::array<std::int64_t, markov::kEndings> endings{};
  markov::CellCounts trapped_gates,
      departed_gates;  // of final_gates: trapped there; left the field from there
  std::array<std::int64_t, dynamics::kBoundaries>
      entries{};  // crossings between gates, by boundary
  std::array<std::int64_t, dynamics::kBoundaries> clamped{};  // of these, outside every bin
  dynamics::Health health;                                    // over all gate runs

  explicit FieldTally(const FieldParams& f)
      : final_gates(markov::CellCounts::Zero(f.rows, f.columns)),
        trapped_gates(final_gates),
        departed_gates(final_gates) {}
  /// Throws std::invalid_argument, and changes nothing, when a trial would be counted twice.
  FieldTally& operator+=(const FieldTally& other);
};

/// What each trial did, in the order of their numbers.
struct FieldTrials {
  std::vector<std::int32_t> final_gates{};               // row * columns + column
  std::vector<std::optional<markov::Ending>> endings{};  // none: a run stopped being finite
  std::vector<dynamics::Costs> costs{};                  // of all its runs together
  bool keep_passages = false;
  PassageTable passages{};             // of all trials, if kept, ...
  std::vector<std::int64_t> passed{};  // ... and how many of them each trial and those before
                                       // it have
  /// Passages of trial number `at` in this order, from the first gate on.
  [[nodiscard]] PassageTable::Rows of_trial(std::size_t at) const {
    return passages.rows(static_cast<std::size_t>(at == 0 ? 0 : passed[at - 1]),
                         static_cast<std::size_t>(passed[at]));
  }
  /// Those into gates that trials then ran through, in their order.
  [[nodiscard]] std::vector<dynamics::Entry> entries() const;
};

/// What becomes of the draw in force when a body enters the next gate: it is held for the rest of
/// its time, as in the model, or dropped, and the next one of the same sequence drawn: a force
/// without memory from gate to gate.
enum class HeldForce : std::uint8_t { goes_on, drawn_anew };

/// The number that names a start in its trials' streams: other starts, other noise. From the start
/// in the scene's own units (Scale), so that a rescaled scene has the same noise.
[[nodiscard]] std::uint64_t stream_row(const dynamics::GateParams& p,
                                       const dynamics::BodyState& start);

/// Runs trials `range` through the field. field.fidelity says what a gate is: fresh, with beams at
/// rest, whenever the body enters (active), or one of many that go on and act beyond their bounds
/// (remember, all; field_stepper.h). The random force goes on from gate to gate; its stream is
/// {seed, stream_row(p, start), trial} whatever the fidelity, p the gate that trials start in.
/// `held` says what goes on of the draw in force.
/// run.time_limit_s counts from the entry into a gate. `space` only counts what the chain would
/// have clamped. What each trial did is appended to `each`, if given. Trials in gates of one type
/// are run together, in lanes where the method has them. On all threads of the current TBB arena,
/// same result for any number of them. Throws InvalidParameter, also for gates of several types
/// with another fidelity than `active`.
[[nodiscard]] FieldTally run_field(const FieldGates& gates, const FieldParams& field,
                                   const dynamics::BodyState& start,
                                   const dynamics::StateSpace& space, std::uint64_t seed,
                                   dynamics::TrialRange range, FieldTrials* each = nullptr,
                                   HeldForce held = HeldForce::goes_on);

/// The same with a start of its own for each trial, (range.count) of them.
[[nodiscard]] FieldTally run_field(const FieldGates& gates, const FieldParams& field,
                                   const std::vector<dynamics::BodyState>& starts,
                                   const dynamics::StateSpace& space, std::uint64_t seed,
                                   dynamics::TrialRange range, FieldTrials* each = nullptr);

/// A trial through the field in full.
struct FieldTrace {
  struct Visit {
    int column = 0, row = 0;
    dynamics::GateTrace
        trace;  // in the gate's own frame and time, work and losses from its entry on
  };
  std::vector<Visit> visits;
  std::optional<markov::Ending> ending;  // none: a run stopped being finite
};

/// Trial number `trial` of run_field, the same to the last bit. Throws InvalidParameter, also for
/// another fidelity than `active`, and TraceTooLong when all visits together have more samples.
[[nodiscard]] FieldTrace trace_field(
    const FieldGates& gates, const FieldParams& field, const dynamics::BodyState& start,
    std::uint64_t seed, std::int64_t trial,
    std::size_t most_samples = std::numeric_limits<std::size_t>::max());

}  // namespace gatewalk::lattice
