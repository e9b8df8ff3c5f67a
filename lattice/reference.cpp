#include "lattice/reference.h"

#include <tbb/parallel_for.h>

#include <bit>
#include <optional>
#include <string>

#include "dynamics/runs.h"
#include "lattice/field_stepper.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;

/// One trial's part of the tally.
struct Trial {
  std::optional<markov::Ending> ending;  // none: a run stopped being finite
  std::int32_t column = 0, row = 0;
  int gates = 0;  // visited
  std::array<std::int32_t, kBoundaries> entries{}, clamped{};
  Health health;
  std::vector<Crossing> crossings;
};

/// Takes the result of a trial's run through one gate. The crossing into the next gate; none when
/// the trial ends here.
std::optional<Crossing> follow(Trial& t, const GateParams& p, const FieldParams& field,
                               const StateSpace& space, const GateRun& run, bool keep_crossings) {
  t.health.add(p, run);
  ++t.gates;
  if (run.ending == Ending::broken || run.ending == Ending::trapped) {
    if (run.ending == Ending::trapped) t.ending = markov::Ending::trapped;
    return {};
  }
  const Crossing crossing = crossing_of(p, run.ending, run.exit);
  const Move move = move_into(crossing.boundary);
  if (!field.contains(t.column + move.di_x, t.row + move.di_y)) {
    t.ending =
        markov::edge_before({field.columns, field.rows}, t.column + move.di_x, t.row + move.di_y);
    return {};
  }
  if (t.gates == field.max_gates) {
    t.ending = markov::Ending::cut_off;
    return {};
  }
  if (keep_crossings) t.crossings.push_back(crossing);
  ++t.entries[static_cast<int>(crossing.boundary)];
  t.clamped[static_cast<int>(crossing.boundary)] += space.index_of(crossing).clamped;
  t.column += move.di_x;
  t.row += move.di_y;
  return crossing;
}

RandomForce field_force(const GateParams& p, const BodyState& start, std::uint64_t seed,
                        std::int64_t trial) {
  const Stream stream{seed, stream_row(p, start), static_cast<std::uint64_t>(trial)};
  return {p.forces, Random(Purpose::field, stream)};
}

}  // namespace

std::uint64_t stream_row(const GateParams& p, const BodyState& b) {
  // From the bits of the state; the random generator serves as the hash.
  const Scale scale = scale_of(p);
  const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x + 0.0); };  // -0 is 0
  const r123::Philox4x64::ctr_type state = {{bits(b.x / scale.length), bits(b.y / scale.length),
                                             bits(b.vx / scale.speed()),
                                             bits(b.vy / scale.speed())}};
  return r123::Philox4x64()(state, {{0, 0}})[0] >> 8;  // the top byte of a key is its purpose
}

FieldTally& FieldTally::operator+=(const FieldTally& o) {
  final_gates += o.final_gates;
  trials += o.trials;
  trapped += o.trapped;
  left_field += o.left_field;
  cut_off += o.cut_off;
  broken += o.broken;
  for (std::size_t e = 0; e < endings.size(); ++e) endings[e] += o.endings[e];
  trapped_gates += o.trapped_gates;
  departed_gates += o.departed_gates;
  for (int b = 0; b < kBoundaries; ++b) {
    entries[b] += o.entries[b];
    clamped[b] += o.clamped[b];
  }
  health += o.health;
  final_gate_of_trial.insert(final_gate_of_trial.end(), o.final_gate_of_trial.begin(),
                             o.final_gate_of_trial.end());
  crossings.insert(crossings.end(), o.crossings.begin(), o.crossings.end());
  return *this;
}

FieldTally run_field(const GateParams& p, const FieldParams& field, const BodyState& start,
                     const StateSpace& space, std::uint64_t seed, TrialRange range,
                     bool keep_crossings) {
  const auto method = make_method(p);
  validate(p, field);
  std::vector<Trial> trials(range.count);
  for (Trial& t : trials) t.column = field.start_column();
  const auto force_of = [&](std::int64_t i) {
    return field_force(p, start, seed, range.first + i);
  };
  if (field.fidelity == Fidelity::active) {
    carry_out_trials(
        p, *method, range.count,
        [&](RunSlot& slot) {
          slot.start = start;
          slot.force = force_of(slot.trial);
        },
        [&](RunSlot& slot, const GateRun& run) {
          if (!follow(trials[slot.trial], p, field, space, run, keep_crossings)) return false;
          slot.start = shifted_into_next(p, run.ending, run.exit);
          return true;
        });
  } else {
    tbb::parallel_for(std::int64_t{0}, range.count, [&](std::int64_t i) {
      RandomForce force = force_of(i);
      Crowd crowd(p, field, start);
      for (GateRun run = crowd.run_gate(force);
           follow(trials[i], p, field, space, run, keep_crossings); run = crowd.run_gate(force))
        crowd.go_on(run.ending);
    });
  }

  FieldTally tally(field);
  tally.trials = range.count;
  tally.final_gate_of_trial.reserve(trials.size());
  for (const Trial& t : trials) {
    ++tally.final_gates(t.row, t.column);
    tally.final_gate_of_trial.push_back(t.row * field.columns + t.column);
    const bool trapped = t.ending == markov::Ending::trapped,
               cut_off = t.ending == markov::Ending::cut_off;
    const bool departed = t.ending && !trapped && !cut_off;
    tally.trapped_gates(t.row, t.column) += trapped;
    tally.departed_gates(t.row, t.column) += departed;
    if (t.ending) ++tally.endings[static_cast<std::size_t>(*t.ending)];
    tally.trapped += trapped;
    tally.left_field += departed;
    tally.cut_off += cut_off;
    tally.broken += !t.ending;
    for (int b = 0; b < kBoundaries; ++b) {
      tally.entries[b] += t.entries[b];
      tally.clamped[b] += t.clamped[b];
    }
    tally.health += t.health;
    tally.crossings.insert(tally.crossings.end(), t.crossings.begin(), t.crossings.end());
  }
  return tally;
}

FieldTrace trace_field(const GateParams& p, const FieldParams& field, const BodyState& start,
                       std::uint64_t seed, std::int64_t trial, std::size_t most_samples) {
  if (field.fidelity != Fidelity::active)
    throw InvalidParameter("field.fidelity",
                           "field.fidelity = \"" + std::string(name_of(field.fidelity)) +
                               "\" is not permitted: only \"active\" can be traced");
  const auto method = make_method(p);
  validate(p, field);
  const StateSpace space = StateSpace::paper(p);  // `follow` counts with it; nobody asks here
  Trial t;
  t.column = field.start_column();
  RandomForce force = field_force(p, start, seed, trial);
  FieldTrace trace;
  for (BodyState from = start;;) {
    trace.visits.push_back({t.column, t.row, trace_gate(p, *method, from, force, most_samples)});
    most_samples -= trace.visits.back().trace.samples.size();
    const GateRun& run = trace.visits.back().trace.run;
    if (!follow(t, p, field, space, run, false)) break;
    from = shifted_into_next(p, run.ending, run.exit);
  }
  trace.ending = t.ending;
  return trace;
}

}  // namespace gatewalk::lattice
