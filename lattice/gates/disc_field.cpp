// SPDX-License-Identifier: MIT
#include "lattice/gates/disc_field.h"

#include <tbb/parallel_for.h>

#include <string>
#include <utility>

#include "dynamics/disc/disc_cell.h"
#include "lattice/field/running_trial.h"
#include "lattice/gates/field_stepper.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;

Random field_random(const GateParams& p, const BodyState& start, std::uint64_t seed,
                    std::int64_t trial) {
  return {Purpose::field, {seed, stream_row(p, start), static_cast<std::uint64_t>(trial)}};
}

InvalidParameter wrong_fidelity(const FieldParams& field, const std::string& why) {
  return {"field.fidelity", "field.fidelity = \"" + std::string(name_of(field.fidelity)) +
                                "\" is not permitted: " + why};
}

/// Runs trials one by one, each with all its beams.
FieldTally run_with_beams(const GateParams& p, const FieldParams& field, const CellMap& map,
                          const BodyState& start, std::uint64_t seed, TrialRange range,
                          FieldTrials* each, const StateSpace* space, Memory memory) {
  (void)make_method(p);  // throws for parameters that cannot be run
  std::vector<RunningTrial> trials;
  for (std::int64_t i = 0; i < range.count; ++i) trials.emplace_back(field);
  struct Seen {
    Health health;
    std::vector<Entry> entries;
  };
  std::vector<Seen> seen(trials.size());
  const bool keep = each != nullptr && each->keep_passages;
  tbb::parallel_for(std::size_t{0}, trials.size(), [&](std::size_t i) {
    FieldStepper stepper(p, field, start);
    RandomForce force(p.forces,
                      field_random(p, start, seed, range.first + static_cast<std::int64_t>(i)));
    for (;;) {
      const GateRun run = stepper.run_gate(force);
      add_run(seen[i].health, p, run);
      const auto entry = trials[i].follow(map, field, passage_of(p, run), keep);
      if (!entry) return;
      seen[i].entries.push_back(*entry);
      stepper.go_on(run.outcome);
      if (memory == Memory::dropped) force.drop_hold();
    }
  });
  FieldTally tally = tally_of(trials, map, field, range, each);
  for (const Seen& s : seen) {
    tally.health += s.health;
    for (const Entry& entry : s.entries) {
      const auto face = static_cast<std::size_t>(entry.face);
      ++tally.entries[face];
      if (space != nullptr) tally.clamped[face] += space->index_of(entry).clamped;
    }
  }
  return tally;
}

}  // namespace

FieldTally run_field(const FieldGates& gates, const FieldParams& field, const BodyState& start,
                     std::uint64_t seed, TrialRange range, FieldTrials* each,
                     const StateSpace* space, Memory memory) {
  for (const GateParams& p : gates.types()) validate(p, field);
  const CellField cells = gates.cells();
  cells.map.require_fits(field.columns, field.rows);
  if (field.fidelity != Fidelity::active) {
    if (gates.types().size() > 1)
      throw wrong_fidelity(field, "gates of several types are only run with \"active\"");
    return run_with_beams(gates.types().front(), field, cells.map, start, seed, range, each, space,
                          memory);
  }
  const auto& first = static_cast<const DiscCell&>(cells.at(field.start_column(), field.start_row));
  return run_field(
      cells, field,
      [&](std::int64_t i, Body& body) {
        body.entry = entry_of(first.params(), start);
        body.random = field_random(first.params(), start, seed, range.first + i);
        first.begin_at(body, start);
      },
      range, each, space, memory);
}

FieldTrace trace_field(const FieldGates& gates, const FieldParams& field, const BodyState& start,
                       std::uint64_t seed, std::int64_t trial, std::size_t most_samples,
                       const CellChoice& choice) {
  if (field.fidelity != Fidelity::active)
    throw wrong_fidelity(field, "only \"active\" can be traced");
  for (const GateParams& p : gates.types()) validate(p, field);
  const CellMap map = gates.map();
  map.require_fits(field.columns, field.rows);
  RunningTrial t(field);
  const auto type_at = [&](const Entry& entry) {
    return choice ? choice({t.column(), t.row(), t.passed(), trial}, entry)
                  : gates.type_of(t.column(), t.row());
  };
  int type = type_at(entry_of(gates.types().front(), start));
  const GateParams& first = gates.types().at(static_cast<std::size_t>(type));
  RandomForce force(first.forces, field_random(first, start, seed, trial));
  FieldTrace trace;
  for (BodyState from = start;;) {
    const GateParams& p = gates.types().at(static_cast<std::size_t>(type));
    force.enter(p.forces);
    trace.visits.push_back(
        {t.column(), t.row(), type, trace_gate(p, *make_method(p), from, force, most_samples)});
    most_samples -= trace.visits.back().trace.samples.size();
    const GateRun& run = trace.visits.back().trace.run;
    const auto next = t.follow(map, field, passage_of(p, run), false, type);
    if (!next) break;
    type = type_at(*next);
    from = shifted_into_next(p, run.outcome, run.exit);
  }
  trace.ending = t.ending();
  return trace;
}

}  // namespace gatewalk::lattice
