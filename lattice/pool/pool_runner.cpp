// SPDX-License-Identifier: MIT
#include "lattice/pool/pool_runner.h"

#include <stdexcept>
#include <string>

namespace gatewalk::lattice {
namespace {

using namespace dynamics;

// Numbers of first trials, so that no other command runs these: full ones, those through one gate,
// scattered ones.
constexpr std::int64_t kFullOwn = std::int64_t{1} << 41, kFirstOwn = std::int64_t{1} << 42,
                       kScatteredOwn = std::int64_t{1} << 43;

}  // namespace

PoolRunner::PoolRunner(const Problem& problem, std::uint64_t seed, std::int64_t most_runs,
                       const Work& work)
    : problem_(problem), seed_(seed), most_runs_(most_runs), work_(work) {}

void PoolRunner::run_full(StartTrials& s, std::int64_t count) {
  const std::int64_t done = std::ssize(s.full.final_gates);
  run("full trials", count, true, s.full, [&](TrialRange range, FieldTrials& each) {
    return run_field(problem_.cells, problem_.field, s.start, seed_,
                     {kFullOwn + done + range.first, range.count}, &each);
  });
}

void PoolRunner::run_first(StartTrials& s, std::int64_t count) {
  FieldParams one_gate = problem_.field;
  one_gate.max_gates = 1;
  const std::int64_t done = std::ssize(s.first.final_gates);
  run("first runs", count, false, s.first, [&](TrialRange range, FieldTrials& each) {
    return run_field(problem_.cells, one_gate, s.start, seed_,
                     {kFirstOwn + done + range.first, range.count}, &each);
  });
}

void PoolRunner::run_scattered(ScatteredTrials& s, const StartRange& starts, std::int64_t count) {
  const std::int64_t done = std::ssize(s.starts);
  run("scattered trials", count, true, s.each, [&](TrialRange range, FieldTrials& each) {
    const std::int64_t first = done + range.first;
    const Cell& cell = problem_.cells.at(problem_.field.start_column(), 0);
    return run_field(
        problem_.cells, problem_.field,
        [&](std::int64_t i, Body& body) {
          begin_trial(cell, drawn(starts, first + i), seed_, kScatteredOwn + first + i, body);
        },
        {kScatteredOwn + first, range.count}, &each);
  });
  for (std::int64_t i = done; i < std::ssize(s.each.final_gates); ++i)
    s.starts.push_back(drawn(starts, i));
}

Entry PoolRunner::drawn(const StartRange& starts, std::int64_t i) const {
  Random random(Purpose::resampling,
                {seed_, static_cast<std::uint64_t>(kScatteredOwn), static_cast<std::uint64_t>(i)});
  Entry entry{starts.face};
  for (std::size_t axis = 0; axis < problem_.map().section.coordinates.size(); ++axis) {
    const auto& [from, to] = starts.at[axis];
    entry.at[axis] = from + (to - from) * random.uniform();
  }
  return entry;
}

void PoolRunner::finish() {
  if (gate_runs > 0 && problem_.check)
    problem_.check(std::max(trials_, gate_runs / 10), seed_, health, work_);
}

void PoolRunner::run(const char* what, std::int64_t count, bool through_field, FieldTrials& all,
                     const std::function<FieldTally(TrialRange, FieldTrials&)>& carry_out) {
  const Stopwatch watch;
  const auto most = static_cast<double>(most_runs_ - gate_runs);
  count = std::max<std::int64_t>(
      kLeastTrials,
      static_cast<std::int64_t>(std::min(static_cast<double>(count),
                                         most / (through_field ? gates_per_trial() : 1.0) + 1.0)));
  work_.in_kept_pieces(
      {what, {0, count}},
      RunTrials{FieldTally(problem_.field), {.final_gates = {}, .keep_passages = true}},
      [&](TrialRange range) {
        FieldTrials each{.final_gates = {}, .keep_passages = true};
        FieldTally tally = carry_out(range, each);
        return RunTrials{std::move(tally), std::move(each)};
      },
      [&](const RunTrials& piece) {
        all.append(piece.each);
        const Health& of = piece.tally.health;
        health += of;
        gate_runs += of.runs;
        if (!through_field) return;
        trials_ += piece.tally.trials;
        trial_runs_ += of.runs;
      });
  seconds += watch.seconds();
  if (health.broken > 0)
    throw std::runtime_error("prediction: " + std::to_string(health.broken) +
                             " gate runs stopped being finite numbers; try method stable or a "
                             "smaller run.step_s");
}

}  // namespace gatewalk::lattice
