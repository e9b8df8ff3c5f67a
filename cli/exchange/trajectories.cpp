// SPDX-License-Identifier: MIT
#include "cli/exchange/trajectories.h"

namespace gatewalk::cli {
namespace {

void add(Trajectories& all, const dynamics::StateSpace& space, const dynamics::Entry& start,
         const lattice::PassageTable::Rows& passages) {
  auto& one = all.emplace_back();
  one.push_back(space.index_of(start).state);
  for (const lattice::CellPassage passage : passages) {
    if (passage.fate == dynamics::Fate::left)
      one.push_back(space.index_of(passage.entry).state);
    else if (passage.fate == dynamics::Fate::trapped)
      one.push_back(space.trapped());
  }
}

}  // namespace

Trajectories trajectories_of(const lattice::RunPool& pool, const dynamics::StateSpace& space) {
  Trajectories all;
  for (const lattice::OwnRuns& s : pool.starts)
    for (const lattice::FieldTrials* trials : {&s.full, &s.first})
      for (std::size_t i = 0; i < trials->passed.size(); ++i)
        add(all, space, s.start, trials->of_trial(i));
  for (std::size_t i = 0; i < pool.scattered.starts.size(); ++i)
    add(all, space, pool.scattered.starts[i], pool.scattered.each.of_trial(i));
  return all;
}

}  // namespace gatewalk::cli
