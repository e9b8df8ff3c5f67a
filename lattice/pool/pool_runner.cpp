#include "lattice/pool/pool_runner.h"

#include <stdexcept>
#include <string>

#include "lattice/scene/settle.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;

// Numbers of first trials, so that no other command runs these: full ones, those through one gate,
// scattered ones.
constexpr std::int64_t kFullOwn = std::int64_t{1} << 41, kFirstOwn = std::int64_t{1} << 42,
                       kScatteredOwn = std::int64_t{1} << 43;

}  // namespace

PoolRunner::PoolRunner(const Scene& scene, std::uint64_t seed, std::int64_t most_runs,
                       const Work& work)
    : scene_(scene),
      gates_(gates_of(scene)),
      field_(scene.field),
      space_(table3_space(scene.gate)),
      seed_(seed),
      most_runs_(most_runs),
      work_(work) {
  field_.fidelity = Fidelity::active;
}

void PoolRunner::run_full(StartTrials& s, std::int64_t count) {
  const std::int64_t done = std::ssize(s.full.final_gates);
  run("full trials", count, true, [&](TrialRange range) {
    return run_field(gates_, field_, entry_state(scene_.gate, s.start), space_, seed_,
                     {kFullOwn + done + range.first, range.count}, &s.full);
  });
}

void PoolRunner::run_first(StartTrials& s, std::int64_t count) {
  FieldParams one_gate = field_;
  one_gate.max_gates = 1;
  const std::int64_t done = std::ssize(s.first.final_gates);
  run("first runs", count, false, [&](TrialRange range) {
    return run_field(gates_, one_gate, entry_state(scene_.gate, s.start), space_, seed_,
                     {kFirstOwn + done + range.first, range.count}, &s.first);
  });
}

void PoolRunner::run_scattered(ScatteredTrials& s, const StartRange& starts, std::int64_t count) {
  const std::int64_t done = std::ssize(s.starts);
  run("scattered trials", count, true, [&](TrialRange range) {
    std::vector<BodyState> bodies;
    for (std::int64_t i = 0; i < range.count; ++i) {
      bodies.push_back(drawn(starts, done + range.first + i));
      s.starts.push_back(entry_of(bodies.back()));
    }
    return run_field(gates_, field_, bodies, space_, seed_,
                     {kScatteredOwn + done + range.first, range.count}, &s.each);
  });
}

BodyState PoolRunner::drawn(const StartRange& starts, std::int64_t i) const {
  Random random(Purpose::resampling,
                {seed_, static_cast<std::uint64_t>(kScatteredOwn), static_cast<std::uint64_t>(i)});
  const auto within = [&](const std::array<double, 2>& r) {
    return r[0] + (r[1] - r[0]) * random.uniform();
  };
  BodyState b;
  b.x = within(starts.d);
  b.vx = within(starts.vx);
  b.vy = within(starts.vy);
  return b;
}

void PoolRunner::finish() {
  if (gate_runs > 0)
    check_outcomes(scene_, RunsFrom::everywhere, seed_, std::max(trials_, gate_runs / 10), health,
                   work_);
}

void PoolRunner::run(const char* what, std::int64_t count, bool through_field,
                     const std::function<FieldTally(TrialRange)>& carry_out) {
  const Stopwatch watch;
  const auto most = static_cast<double>(most_runs_ - gate_runs);
  count = std::max<std::int64_t>(
      kLeastTrials,
      static_cast<std::int64_t>(std::min(static_cast<double>(count),
                                         most / (through_field ? gates_per_trial() : 1.0) + 1.0)));
  work_.in_pieces(what, count, [&](TrialRange range) {
    const FieldTally tally = carry_out(range);
    health += tally.health;
    gate_runs += tally.health.runs;
    if (!through_field) return;
    trials_ += tally.trials;
    trial_runs_ += tally.health.runs;
  });
  seconds += watch.seconds();
  if (health.broken > 0)
    throw std::runtime_error("prediction: " + std::to_string(health.broken) +
                             " gate runs stopped being finite numbers; try method stable or a "
                             "smaller run.step_s");
}

}  // namespace gatewalk::lattice
