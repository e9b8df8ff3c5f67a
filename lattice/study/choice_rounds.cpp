// SPDX-License-Identifier: MIT
#include "lattice/study/choice_rounds.h"

#include <cmath>
#include <stdexcept>

#include "dynamics/base/kept_pieces.h"
#include "dynamics/base/share.h"
#include "lattice/field/gate_chain.h"
#include "lattice/field/running_trial.h"

namespace gatewalk::lattice {

using namespace dynamics;

FieldTally chosen_trials(const CellField& cells, const Problem& first, const TypeChoice& choice,
                         std::uint64_t seed, TrialRange range, FieldTrials& each) {
  return run_field(
      cells, first.field,
      [&](std::int64_t i, Body& body) {
        const std::int64_t trial = range.first + i;
        const TrialStart start =
            choice.from ? choice.from(trial) : TrialStart{first.field.start_column(), choice.start};
        const Cell& cell = choice.type
                               ? *cells.cells[static_cast<std::size_t>(choice.type(
                                     {start.column, first.field.start_row, 0, trial}, start.entry))]
                               : cells.at(start.column, first.field.start_row);
        begin_trial(cell, start.entry, seed, trial, body);
      },
      range, &each, nullptr, Memory::kept, choice);
}

double ChoiceAim::worth(const FieldTrials& trials) const {
  const auto crossed = static_cast<double>(crossings_of(trials).crossed);
  return (rarely ? -crossed : crossed) - (price > 0.0 ? price * total_of(trials, cost) : 0.0);
}

double ChoiceAim::squares(const FieldTrials& trials) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < trials.endings.size(); ++i) {
    double worth = trials.endings[i] == markov::Ending::far_edge ? 1.0 : 0.0;
    if (price > 0.0) worth -= price * trials.costs[i][cost];
    sum += worth * worth;
  }
  return sum;
}

double total_of(const FieldTrials& trials, std::size_t cost) {
  double sum = 0.0;
  for (const Costs& costs : trials.costs) sum += costs[cost];
  return sum;
}

ChoiceRounds::ChoiceRounds(std::string study, Purpose purpose, const CellField& cells,
                           const Problem& first, double accuracy, std::int64_t most_runs,
                           std::uint64_t seed, const Work& work)
    : study_(std::move(study)),
      purpose_(purpose),
      cells_(cells),
      first_(first),
      accuracy_(accuracy),
      most_runs_(most_runs),
      seed_(seed),
      work_(work),
      count_(static_cast<std::int64_t>(std::ceil(std::pow(kNormal95 / (2.0 * accuracy), 2.0)))) {}

RangeRuns ChoiceRounds::run(const TypeChoice& choice, std::int64_t count) {
  RangeRuns trials;
  for (std::int64_t i = 0; i < count; ++i)
    trials.starts.push_back(choice.from ? choice.from(next_ + i).entry : choice.start);
  const RunTrials none{FieldTally(first_.field), {.final_gates = {}, .keep_passages = true}};
  in_kept_pieces(
      work_, {"trials of a " + study_, {next_, count}}, none,
      [&](TrialRange range) {
        RunTrials piece = none;
        piece.tally = chosen_trials(cells_, first_, choice, seed_, range, piece.each);
        return piece;
      },
      [&](const RunTrials& piece) {
        trials.each.append(piece.each);
        summary_.health += piece.tally.health;
      });
  next_ += count;
  summary_.gate_runs += std::ssize(trials.each.passages);
  if (summary_.health.broken > 0)
    throw std::runtime_error(study_ + ": " + std::to_string(summary_.health.broken) +
                             " gate runs stopped being finite numbers; try method stable or a "
                             "smaller run.step_s");
  return trials;
}

void ChoiceRounds::add(const RangeRuns& trials) {
  pool_.scattered.starts.insert(pool_.scattered.starts.end(), trials.starts.begin(),
                                trials.starts.end());
  pool_.scattered.each.append(trials.each);
}

std::uint64_t ChoiceRounds::word(const Place& at, std::uint64_t what) const {
  return Random(purpose_, {seed_, 2 * static_cast<std::uint64_t>(at.passed) + what,
                           static_cast<std::uint64_t>(at.trial)})
      .word();
}

CellChoice ChoiceRounds::mostly(CellChoice best, CellChoice other) const {
  constexpr std::uint64_t kCells = 4;
  return [this, best = std::move(best), other = std::move(other)](const Place& at,
                                                                  const Entry& entry) {
    return word(at, 1) % kCells == 0 ? other(at, entry) : best(at, entry);
  };
}

bool ChoiceRounds::is_little(double gain, double squares) const {
  return gain <= 0.5 * accuracy_ * static_cast<double>(count_) && gain <= 2.0 * std::sqrt(squares);
}

double numbers_of(const FieldParams& field, const StateSpace& space) {
  return static_cast<double>(std::max(1, field.max_gates)) * field.columns * field.rows *
         space.size();
}

std::vector<markov::Chain> chains_of(const Kernel& kernel) {
  std::vector<markov::Chain> chains;
  for (const markov::Counts& counts : kernel.counts)
    chains.push_back(markov::Chain::from_counts(counts, exits_of(kernel.space)));
  return chains;
}

markov::Gains gain_of_crossing() {
  markov::Gains gains;
  gains.ending[static_cast<std::size_t>(markov::Ending::far_edge)] = 1.0;
  return gains;
}

std::runtime_error too_large(const std::string& what) {
  return std::runtime_error(what +
                            " so many cells, states and gates do not fit into memory; a smaller "
                            "field.max_gates (0: no limit) needs less");
}

void require_choice_options(const std::string& study, double accuracy, int per_leaf) {
  if (!(accuracy >= 0.001 && accuracy < 0.5))
    throw std::invalid_argument(study + ": accuracy must lie in [0.001, 0.5)");
  if (per_leaf < 1 || per_leaf > 1'000'000)
    throw std::invalid_argument(study + ": leaves of 1 to 1000000 entries");
}

}  // namespace gatewalk::lattice
