// SPDX-License-Identifier: MIT
#include "lattice/study/trials.h"

#include <utility>

#include "dynamics/base/kept_pieces.h"
#include "lattice/field/running_trial.h"
#include "markov/walk.h"

namespace gatewalk::lattice {

FieldTally field_trials(const FieldParams& field, dynamics::TrialRange trials,
                        const RunTrialRange& run, const dynamics::Work& work,
                        const TakeTrials& take) {
  FieldTally tally(field);
  in_kept_pieces(
      work, {"field trials", trials}, RunTrials{FieldTally(field), {}},
      [&](dynamics::TrialRange range) {
        FieldTrials each;
        FieldTally part = run(range, each);
        return RunTrials{std::move(part), std::move(each)};
      },
      [&](const RunTrials& piece) {
        tally += piece.tally;
        if (take) take(piece.each);
      });
  return tally;
}

TakeTrials added_to(FieldCosts& costs) {
  return [&](const FieldTrials& each) { costs.add(each); };
}

FieldTally field_trials(const Problem& problem, dynamics::TrialRange trials, std::uint64_t seed,
                        const dynamics::Work& work, const TakeTrials& take, bool keep_passages) {
  FieldTally tally = field_trials(
      problem.field, trials,
      [&](dynamics::TrialRange range, FieldTrials& each) {
        each.keep_passages = keep_passages;
        return run_field(problem.cells, problem.field, problem.start, seed, range, &each);
      },
      work, take);
  if (problem.check) problem.check(trials.count, seed, tally.health, work);
  return tally;
}

markov::WalkTally walks(const markov::FieldChain& chain, const FieldParams& field,
                        const markov::Start& start, std::int64_t count, std::uint64_t seed,
                        const dynamics::Work& work) {
  const markov::Walker walker(chain);
  markov::WalkTally tally;
  work.in_pieces("walks", count, [&](dynamics::TrialRange range) {
    tally += walker.walk({field.columns, field.rows}, start, field.max_gates, seed,
                         {range.first, range.count});
  });
  return tally;
}

}  // namespace gatewalk::lattice
