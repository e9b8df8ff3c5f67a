#include "lattice/study/trials.h"

namespace gatewalk::lattice {

FieldTally field_trials(const FieldParams& field, std::int64_t trials, const RunTrialRange& run,
                        const dynamics::Work& work, FieldCosts* costs, ExitCounts* exits) {
  FieldTally tally(field);
  work.in_pieces("field trials", trials, [&](dynamics::TrialRange range) {
    FieldTrials each;
    tally += run(range, each);
    if (costs != nullptr) costs->add(each);
    if (exits != nullptr) exits->add(each);
  });
  return tally;
}

FieldTally field_trials(const Problem& problem, std::int64_t trials, std::uint64_t seed,
                        const dynamics::Work& work, FieldCosts* costs, ExitCounts* exits,
                        const TakeTrials& take) {
  FieldTally tally = field_trials(
      problem.field, trials,
      [&](dynamics::TrialRange range, FieldTrials& each) {
        each.keep_passages = static_cast<bool>(take);
        FieldTally part =
            run_field(problem.cells, problem.field, problem.start, seed, range, &each);
        if (take) take(each);
        return part;
      },
      work, costs, exits);
  if (problem.check) problem.check(trials, seed, tally.health, work);
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
