#include "lattice/pooled_runs.h"

#include <algorithm>
#include <utility>

#include "dynamics/quantile_bins.h"
#include "dynamics/tree_space.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;

/// Calls use(first, entry, passage) for every run of the group: whether it is the first of its
/// trial in a state of the start's own.
template <class Use>
void each_run(const StartTrials& start, TrialGroup group, Use use) {
  for (std::int64_t i = group.group; i < start.trials(); i += group.of) {
    Crossing entry = start.start;
    bool first = start.own_state;
    for (const GatePassage& passage : start.each.of_trial(static_cast<std::size_t>(i))) {
      if (passage.ending != Ending::broken) use(first, entry, passage);
      entry = passage.entry;
      first = false;
    }
  }
}

/// Row and column of every count, as row * columns + column.
markov::Counts counted(std::vector<std::int64_t> places, int states) {
  const std::int64_t columns = states + 1;
  std::sort(places.begin(), places.end());
  markov::Counts counts(states, columns);
  std::int64_t row = 0;
  counts.startVec(row);
  for (auto at = places.begin(); at != places.end();) {
    const auto next = std::find_if(at, places.end(), [&](std::int64_t p) { return p != *at; });
    while (row < *at / columns) counts.startVec(++row);
    counts.insertBack(row, *at % columns) = next - at;
    at = next;
  }
  while (row + 1 < states) counts.startVec(++row);
  counts.finalize();
  return counts;
}

}  // namespace

CountedStates pooled(const GateParams& p, const std::vector<StartTrials>& starts, int per_leaf,
                     TrialGroup group) {
  const bool mirror = symmetric(p);
  std::vector<Crossing> entries, points;
  for (const StartTrials& s : starts) {
    if (s.own_state) points.push_back(s.start);
    each_run(s, group, [&](bool first, const Crossing& entry, const GatePassage&) {
      if (!first) entries.push_back(entry);
    });
  }
  if (mirror) add_mirror_images(entries);
  CountedStates result{tree_space(p, std::move(entries), per_leaf, std::move(points)), {}, 0};

  const StateSpace& space = result.space;
  const std::int64_t columns = space.size() + 1;
  std::vector<std::int64_t> places;
  for (const StartTrials& s : starts)
    each_run(s, group, [&](bool first, const Crossing& entry, const GatePassage& passage) {
      const auto count = [&](const Crossing& from, const Crossing& to) {
        const int column =
            passage.ending == Ending::trapped ? space.trapped() : space.index_of(to).state;
        places.push_back(space.index_of(from).state * columns + column);
      };
      count(entry, passage.entry);
      if (mirror && (!first || mirrored(entry) == entry))
        count(mirrored(entry), mirrored(passage.entry));
      ++result.runs;
    });
  result.counts = counted(std::move(places), space.size());
  return result;
}

}  // namespace gatewalk::lattice
