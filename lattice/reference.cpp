#include "lattice/reference.h"

#include <tbb/parallel_for.h>

#include <bit>

#include "lattice/crowd.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;

enum class Fate : std::uint8_t { trapped, left_field, cut_off, broken };

/// One trial's part of the tally.
struct Trial {
  Fate fate = Fate::broken;
  std::int32_t column = 0, row = 0;
  std::array<std::int32_t, kBoundaries> entries{}, clamped{};
  Health health;
  std::vector<Crossing> crossings;
};

/// One trial, gate by gate. `run` runs the body's gate until it leaves, `go_on` puts it into the next.
template <class Run, class GoOn>
Trial run_trial(const GateParams& p, const FieldParams& field, const StateSpace& space,
                bool keep_crossings, Run run_one, GoOn go_on) {
  Trial t;
  t.column = field.start_column();
  for (int gates = 1;; ++gates) {
    const GateRun run = run_one();
    t.health.add(p, run);
    if (run.ending == Ending::broken || run.ending == Ending::trapped) {
      t.fate = run.ending == Ending::broken ? Fate::broken : Fate::trapped;
      return t;
    }
    const Crossing crossing = crossing_of(p, run.ending, run.exit);
    const Move move = move_into(crossing.boundary);
    if (!field.contains(t.column + move.di_x, t.row + move.di_y)) {
      t.fate = Fate::left_field;
      return t;
    }
    if (gates == field.max_gates) {
      t.fate = Fate::cut_off;
      return t;
    }
    if (keep_crossings) t.crossings.push_back(crossing);
    ++t.entries[static_cast<int>(crossing.boundary)];
    t.clamped[static_cast<int>(crossing.boundary)] += space.index_of(crossing).clamped;
    t.column += move.di_x;
    t.row += move.di_y;
    go_on(run);
  }
}

Trial run_trial(const GateParams& p, const Method& method, const FieldParams& field,
                const BodyState& start, const StateSpace& space, RandomForce& force,
                bool keep_crossings) {
  if (field.fidelity == Fidelity::active) {
    BodyState body = start;
    return run_trial(
        p, field, space, keep_crossings, [&] { return run_gate(p, method, body, force); },
        [&](const GateRun& run) { body = shifted_into_next(p, run.ending, run.exit); });
  }
  Crowd crowd(p, field, start);
  return run_trial(
      p, field, space, keep_crossings, [&] { return crowd.run_gate(force); },
      [&](const GateRun& run) { crowd.go_on(run.ending); });
}

}  // namespace

std::uint64_t stream_row(const BodyState& b) {
  // From the bits of the state; the random generator serves as the hash.
  const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x + 0.0); };  // -0 is 0
  const r123::Philox4x64::ctr_type state = {{bits(b.x), bits(b.y), bits(b.vx), bits(b.vy)}};
  return r123::Philox4x64()(state, {{0, 0}})[0] >> 8;  // the top byte of a key is its purpose
}

FieldTally& FieldTally::operator+=(const FieldTally& o) {
  final_gates += o.final_gates;
  trials += o.trials;
  trapped += o.trapped;
  left_field += o.left_field;
  cut_off += o.cut_off;
  broken += o.broken;
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
  const std::uint64_t row = stream_row(start);
  std::vector<Trial> trials(range.count);
  tbb::parallel_for(std::int64_t{0}, range.count, [&](std::int64_t i) {
    const Stream stream{seed, row, static_cast<std::uint64_t>(range.first + i)};
    RandomForce force(p.forces, Random(Purpose::field, stream));
    trials[i] = run_trial(p, *method, field, start, space, force, keep_crossings);
  });

  FieldTally tally(field);
  tally.trials = range.count;
  tally.final_gate_of_trial.reserve(trials.size());
  for (const Trial& t : trials) {
    ++tally.final_gates(t.row, t.column);
    tally.final_gate_of_trial.push_back(t.row * field.columns + t.column);
    tally.trapped += t.fate == Fate::trapped;
    tally.left_field += t.fate == Fate::left_field;
    tally.cut_off += t.fate == Fate::cut_off;
    tally.broken += t.fate == Fate::broken;
    for (int b = 0; b < kBoundaries; ++b) {
      tally.entries[b] += t.entries[b];
      tally.clamped[b] += t.clamped[b];
    }
    tally.health += t.health;
    tally.crossings.insert(tally.crossings.end(), t.crossings.begin(), t.crossings.end());
  }
  return tally;
}

}  // namespace gatewalk::lattice
