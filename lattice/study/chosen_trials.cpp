// SPDX-License-Identifier: MIT
#include "lattice/study/chosen_trials.h"

#include <cmath>
#include <stdexcept>

#include "dynamics/base/share.h"

namespace gatewalk::lattice {

using namespace dynamics;

FieldTally chosen_trials(const CellField& cells, const Problem& first, const CellChoice& choice,
                         std::uint64_t seed, TrialRange range, FieldTrials& each) {
  const TypeChoice type{first.start, choice};
  return run_field(
      cells, first.field,
      [&](std::int64_t i, Body& body) {
        const std::int64_t trial = range.first + i;
        const Place start{first.field.start_column(), 0, 0, trial};
        begin_trial(*cells.cells[static_cast<std::size_t>(type.type(start, first.start))],
                    first.start, seed, trial, body);
      },
      range, &each, nullptr, Memory::kept, type);
}

std::int64_t trials_for(double accuracy) {
  return static_cast<std::int64_t>(std::ceil(std::pow(kNormal95 / (2.0 * accuracy), 2.0)));
}

FieldTrials ChosenTrials::run(const CellChoice& choice, std::int64_t count) {
  return in_pieces(
      [&](TrialRange range, FieldTrials& each) {
        return chosen_trials(cells_, first_, choice, seed_, range, each);
      },
      count);
}

FieldTrials ChosenTrials::run_from(const StartOfTrial& from, std::int64_t count) {
  return in_pieces(
      [&](TrialRange range, FieldTrials& each) {
        return run_field(cells_, first_.field,
                         [&](std::int64_t i, Body& body) {
                           const std::int64_t trial = range.first + i;
                           const TrialStart start = from(trial);
                           begin_trial(cells_.at(start.column, 0), start.entry, seed_, trial, body);
                         },
                         range, &each, nullptr, Memory::kept, {.from = from});
      },
      count);
}

FieldTrials ChosenTrials::in_pieces(const RunRange& run_range, std::int64_t count) {
  FieldTrials all{.final_gates = {}, .keep_passages = true};
  const RunTrials none{FieldTally(first_.field), {.final_gates = {}, .keep_passages = true}};
  work_.in_kept_pieces(
      {"trials of a " + name_, {next_, count}}, none,
      [&](TrialRange range) {
        RunTrials piece = none;
        piece.tally = run_range(range, piece.each);
        return piece;
      },
      [&](const RunTrials& piece) {
        all.append(piece.each);
        health_ += piece.tally.health;
      });
  next_ += count;
  gate_runs_ += std::ssize(all.passages);
  if (health_.broken > 0)
    throw std::runtime_error(name_ + ": " + std::to_string(health_.broken) +
                             " gate runs stopped being finite numbers; try method stable or a "
                             "smaller run.step_s");
  return all;
}

void ChosenTrials::add(const FieldTrials& trials, std::vector<Entry> starts) {
  if (starts.size() == 1) starts.resize(trials.final_gates.size(), starts.front());
  pool_.scattered.starts.insert(pool_.scattered.starts.end(), starts.begin(), starts.end());
  pool_.scattered.each.append(trials);
}

std::uint64_t ChosenTrials::word(Purpose purpose, const Place& at, std::uint64_t what) const {
  return Random(purpose, {seed_, 2 * static_cast<std::uint64_t>(at.passed) + what,
                          static_cast<std::uint64_t>(at.trial)})
      .word();
}

}  // namespace gatewalk::lattice
