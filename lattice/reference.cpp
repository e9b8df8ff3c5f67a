#include "lattice/reference.h"

#include <tbb/parallel_for.h>

#include <bit>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "dynamics/disc/runs.h"
#include "lattice/field_stepper.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;

/// One trial's part of the tally.
struct RunningTrial {
  std::optional<markov::Ending> ending;  // none: a run stopped being finite
  std::int32_t column = 0, row = 0;
  int gates = 0;  // visited
  Costs costs{};
  std::array<std::int32_t, kBoundaries> entries{}, clamped{};
  Health health;
  std::vector<GatePassage> passages;
  /// Where its next run begins and under which force, while it waits for gates of another type.
  struct Waiting {
    BodyState from;
    RandomForce force;
  };
  std::unique_ptr<Waiting> waiting;
};

/// Takes the result of a trial's run through one gate. The crossing into the next gate; none when
/// the trial ends here.
std::optional<Entry> follow(RunningTrial& t, const FieldGates& gates, const FieldParams& field,
                            const StateSpace& space, const GateRun& run, bool keep_passages) {
  const auto type = static_cast<std::uint8_t>(gates.type_of(t.column, t.row));
  const GateParams& p = gates.types()[type];
  add_run(t.health, p, run);
  ++t.gates;
  const Costs costs = costs_of(run);
  for (std::size_t c = 0; c < kCosts; ++c) t.costs[c] += costs[c];
  if (run.ending == Ending::broken || run.ending == Ending::trapped) {
    if (run.ending == Ending::trapped) t.ending = markov::Ending::trapped;
    if (keep_passages) t.passages.push_back({run.ending, type, {}, costs});
    return {};
  }
  const Entry crossing = crossing_of(p, run.ending, run.exit);
  if (keep_passages) t.passages.push_back({run.ending, type, crossing, costs});
  const Face& move = disc_section().faces[crossing.face];
  if (!field.contains(t.column + move.di_x, t.row + move.di_y)) {
    t.ending =
        markov::edge_before({field.columns, field.rows}, t.column + move.di_x, t.row + move.di_y);
    return {};
  }
  if (t.gates == field.max_gates) {
    t.ending = markov::Ending::cut_off;
    return {};
  }
  ++t.entries[crossing.face];
  t.clamped[crossing.face] += space.index_of(crossing).clamped;
  t.column += move.di_x;
  t.row += move.di_y;
  return crossing;
}

RandomForce field_force(const GateParams& p, const BodyState& start, std::uint64_t seed,
                        std::int64_t trial) {
  const Stream stream{seed, stream_row(p, start), static_cast<std::uint64_t>(trial)};
  return {p.forces, Random(Purpose::field, stream)};
}

void tally_trial(FieldTally& tally, const RunningTrial& t) {
  ++tally.final_gates(t.row, t.column);
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

std::vector<Entry> FieldTrials::entries() const {
  std::vector<Entry> all;
  for (std::size_t i = 0; i < passed.size(); ++i) {
    const auto of = of_trial(i);
    for (std::size_t k = 0; k + 1 < of.size(); ++k) all.push_back(of[k].entry);
  }
  return all;
}

FieldTally& FieldTally::operator+=(const FieldTally& o) {
  held.add(o.held);
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
  return *this;
}

namespace {

/// Trials that wait for a run in gates of the same type.
struct Wave {
  std::vector<std::int64_t> trials;
  std::mutex mutex;  // trials join from several threads
};

/// Carries out all runs of `trials`, each gate fresh: in waves, the trials in gates of one type
/// together. A trial goes on in its slot while the type stays the same; else it waits for the next
/// wave of its own.
void run_active(std::vector<RunningTrial>& trials, const FieldGates& gates,
                const FieldParams& field,
                const std::function<const BodyState&(std::int64_t)>& start_of,
                const std::function<RandomForce(std::int64_t)>& force_of, const StateSpace& space,
                bool keep_passages, HeldForce held) {
  const std::size_t types = gates.types().size();
  std::vector<std::unique_ptr<const Method>> methods;
  for (const GateParams& p : gates.types()) methods.push_back(make_method(p));
  std::vector<Wave> waves(types);
  for (std::int64_t i = 0; i < std::ssize(trials); ++i)
    waves[gates.type_of(trials[i].column, trials[i].row)].trials.push_back(i);
  for (bool more = true; more;) {
    more = false;
    for (std::size_t type = 0; type < types; ++type) {
      const std::vector<std::int64_t> wave = std::exchange(waves[type].trials, {});
      if (wave.empty()) continue;
      more = true;
      const GateParams& p = gates.types()[type];
      carry_out_trials(
          p, *methods[type], std::ssize(wave),
          [&](RunSlot& slot) {
            const std::int64_t i = wave[slot.trial];
            const auto waiting = std::move(trials[i].waiting);
            slot.start = waiting ? waiting->from : start_of(i);
            slot.force = waiting ? waiting->force : force_of(i);
            slot.force.enter(p.forces);
          },
          [&](RunSlot& slot, const GateRun& run) {
            const std::int64_t i = wave[slot.trial];
            RunningTrial& t = trials[i];
            if (!follow(t, gates, field, space, run, keep_passages)) return false;
            slot.start = shifted_into_next(p, run.ending, run.exit);
            if (held == HeldForce::drawn_anew) slot.force.drop_hold();
            const auto next = static_cast<std::size_t>(gates.type_of(t.column, t.row));
            if (next == type) return true;
            t.waiting = std::make_unique<RunningTrial::Waiting>(slot.start, slot.force);
            const std::lock_guard lock(waves[next].mutex);
            waves[next].trials.push_back(i);
            return false;
          });
    }
  }
}

FieldTally run_from(const FieldGates& gates, const FieldParams& field,
                    const std::function<const BodyState&(std::int64_t)>& start_of,
                    const StateSpace& space, std::uint64_t seed, TrialRange range,
                    FieldTrials* each, HeldForce held) {
  gates.require_fits(field);
  for (const GateParams& p : gates.types()) validate(p, field);
  const GateParams& p = gates.at(field.start_column(), 0);
  const bool keep_passages = each != nullptr && each->keep_passages;
  std::vector<RunningTrial> trials(range.count);
  for (RunningTrial& t : trials) t.column = field.start_column();
  const auto force_of = [&](std::int64_t i) {
    return field_force(p, start_of(i), seed, range.first + i);
  };
  if (field.fidelity == Fidelity::active) {
    run_active(trials, gates, field, start_of, force_of, space, keep_passages, held);
  } else {
    if (gates.types().size() > 1)
      throw InvalidParameter("field.fidelity", "field.fidelity = \"" +
                                                   std::string(name_of(field.fidelity)) +
                                                   "\" is not permitted: gates of several types "
                                                   "are only run with \"active\"");
    (void)make_method(p);  // refuses what cannot be run
    tbb::parallel_for(std::int64_t{0}, range.count, [&](std::int64_t i) {
      FieldStepper stepper(p, field, start_of(i));
      RandomForce force = force_of(i);
      for (GateRun run = stepper.run_gate(force);
           follow(trials[i], gates, field, space, run, keep_passages);
           run = stepper.run_gate(force)) {
        stepper.go_on(run.ending);
        if (held == HeldForce::drawn_anew) force.drop_hold();
      }
    });
  }

  FieldTally tally(field);
  tally.held.add(range);
  tally.trials = range.count;
  for (const RunningTrial& t : trials) tally_trial(tally, t);
  if (keep_passages) each->passages.begin(disc_section());
  if (each != nullptr)
    for (const RunningTrial& t : trials) {
      each->final_gates.push_back(t.row * field.columns + t.column);
      each->endings.push_back(t.ending);
      each->costs.push_back(t.costs);
      if (!keep_passages) continue;
      for (const GatePassage& passage : t.passages) each->passages.push_back(passage);
      each->passed.push_back(std::ssize(each->passages));
    }
  return tally;
}

}  // namespace

FieldTally run_field(const FieldGates& gates, const FieldParams& field, const BodyState& start,
                     const StateSpace& space, std::uint64_t seed, TrialRange range,
                     FieldTrials* each, HeldForce held) {
  return run_from(
      gates, field, [&](std::int64_t) -> const BodyState& { return start; }, space, seed, range,
      each, held);
}

FieldTally run_field(const FieldGates& gates, const FieldParams& field,
                     const std::vector<BodyState>& starts, const StateSpace& space,
                     std::uint64_t seed, TrialRange range, FieldTrials* each) {
  if (std::ssize(starts) != range.count)
    throw std::invalid_argument("run_field: " + std::to_string(starts.size()) + " starts for " +
                                std::to_string(range.count) + " trials");
  return run_from(
      gates, field,
      [&](std::int64_t i) -> const BodyState& { return starts[static_cast<std::size_t>(i)]; },
      space, seed, range, each, HeldForce::goes_on);
}

FieldTrace trace_field(const FieldGates& gates, const FieldParams& field, const BodyState& start,
                       std::uint64_t seed, std::int64_t trial, std::size_t most_samples) {
  if (field.fidelity != Fidelity::active)
    throw InvalidParameter("field.fidelity",
                           "field.fidelity = \"" + std::string(name_of(field.fidelity)) +
                               "\" is not permitted: only \"active\" can be traced");
  gates.require_fits(field);
  for (const GateParams& p : gates.types()) validate(p, field);
  const GateParams& first = gates.at(field.start_column(), 0);
  const StateSpace space = table3_space(first);  // for counts of clamped entries, unused here
  RunningTrial t;
  t.column = field.start_column();
  RandomForce force = field_force(first, start, seed, trial);
  FieldTrace trace;
  for (BodyState from = start;;) {
    const GateParams& p = gates.at(t.column, t.row);
    force.enter(p.forces);
    trace.visits.push_back(
        {t.column, t.row, trace_gate(p, *make_method(p), from, force, most_samples)});
    most_samples -= trace.visits.back().trace.samples.size();
    const GateRun& run = trace.visits.back().trace.run;
    if (!follow(t, gates, field, space, run, false)) break;
    from = shifted_into_next(p, run.ending, run.exit);
  }
  trace.ending = t.ending;
  return trace;
}

}  // namespace gatewalk::lattice
