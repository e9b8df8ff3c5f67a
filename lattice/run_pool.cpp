#include "lattice/run_pool.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "dynamics/quantile_bins.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;

/// Calls use(entry, passage, goes_on) for the runs of some trials of the group that did not break,
/// but the first `skipped` ones of each trial. `start_of(i)`: where trial i started; `goes_on`: the
/// next call is for the run that follows it.
template <class StartOf, class Use>
void each_run(const FieldTrials& trials, TrialGroup group, std::size_t skipped, StartOf start_of,
              Use use) {
  for (std::int64_t i = group.group; i < std::ssize(trials.final_gates); i += group.of) {
    const auto passages = trials.of_trial(static_cast<std::size_t>(i));
    for (std::size_t k = skipped; k < passages.size(); ++k)
      if (passages[k].ending != Ending::broken)
        use(k == 0 ? start_of(i) : passages[k - 1].entry, passages[k],
            k + 1 < passages.size() && passages[k + 1].ending != Ending::broken);
  }
}

template <class Use>
void each_kernel_run(const RunPool& pool, TrialGroup group, Use use) {
  for (const StartTrials& s : pool.starts)
    each_run(
        s.full, group, 1, [&](std::int64_t) { return s.start; }, use);
  each_run(
      pool.scattered.each, group, 0,
      [&](std::int64_t i) { return pool.scattered.starts[static_cast<std::size_t>(i)]; }, use);
}

// Leaves next to each other in preorder lie near each other; some hundred entries.
constexpr int kStatesOfBox = 16;

int output_of(const StateSpace& space, const GatePassage& passage, const Crossing& entry) {
  return passage.ending == Ending::trapped ? space.trapped() : space.index_of(entry).state;
}

/// Counts of runs from row[i] to column[i].
markov::Counts counted(const std::vector<int>& row, const std::vector<int>& column, int states) {
  std::vector<std::int64_t> end(static_cast<std::size_t>(states) + 1, 0);
  for (const int r : row) ++end[static_cast<std::size_t>(r) + 1];
  std::partial_sum(end.begin(), end.end(), end.begin());
  std::vector<int> sorted(column.size());  // by row
  for (std::size_t i = 0; i < row.size(); ++i)
    sorted[static_cast<std::size_t>(end[static_cast<std::size_t>(row[i])]++)] = column[i];
  markov::Counts counts(states, std::int64_t{states} + 1);
  counts.reserve(std::ssize(column));
  auto at = sorted.begin();
  for (int r = 0; r < states; ++r) {
    const auto last = sorted.begin() + end[static_cast<std::size_t>(r)];
    std::sort(at, last);
    counts.startVec(r);
    while (at != last) {
      const auto next = std::find_if(at, last, [&](int c) { return c != *at; });
      counts.insertBack(r, *at) = next - at;
      at = next;
    }
  }
  counts.finalize();
  return counts;
}

}  // namespace

std::size_t RunPool::place_of(const Crossing& start) const {
  const auto own = std::find_if(starts.begin(), starts.end(),
                                [&](const StartTrials& s) { return s.start == start; });
  return static_cast<std::size_t>(own - starts.begin());
}

std::int64_t RunPool::gate_runs() const {
  std::int64_t runs = std::ssize(scattered.each.passages);
  for (const StartTrials& s : starts) runs += s.gate_runs();
  return runs;
}

std::int64_t RunPool::trials() const {
  std::int64_t trials = std::ssize(scattered.starts);
  for (const StartTrials& s : starts) trials += std::ssize(s.full.final_gates);
  return trials;
}

Kernel kernel_of(const GateParams& p, const RunPool& pool, int per_leaf, TrialGroup group) {
  const bool mirror = symmetric(p);
  std::vector<Crossing> entries;
  each_kernel_run(pool, group, [&](const Crossing& entry, const GatePassage&, bool) {
    entries.push_back(entry);
    if (mirror) entries.push_back(mirrored(entry));
  });
  std::vector<int> row, column;
  const std::int64_t fits = 2 * std::ssize(entries) / kMostStates;
  per_leaf = static_cast<int>(std::max<std::int64_t>(per_leaf, fits));
  StateSpace space = tree_space(p, entries, per_leaf, {}, &row);
  column.reserve(row.size());
  const std::size_t together = mirror ? 2 : 1;
  each_kernel_run(pool, group, [&](const Crossing&, const GatePassage& passage, bool goes_on) {
    const std::size_t next = column.size() + together;
    for (std::size_t image = 0; image < together; ++image)
      column.push_back(goes_on ? row[next + image]
                               : output_of(space, passage,
                                           image == 0 ? passage.entry : mirrored(passage.entry)));
  });
  markov::Counts counts = counted(row, column, space.size());
  SeenEntries seen = group.of == 1 ? SeenEntries(space, entries, row) : SeenEntries();
  return {std::move(space), std::move(counts), std::move(seen)};
}

SeenEntries::SeenEntries(const StateSpace& space, const std::vector<Crossing>& entries,
                         const std::vector<int>& state) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  boxes.assign(static_cast<std::size_t>(space.size() / kStatesOfBox + kBoundaries + 1),
               {{kNone, kNone, kNone}, {-kNone, -kNone, -kNone}});
  for (std::size_t i = 0; i < entries.size(); ++i) {
    Box& b = boxes[place_of(space, state[i])];
    ++b.entries;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double x = entries[i].*kCrossingAxes[axis];
      b.low[axis] = std::min(b.low[axis], x);
      b.high[axis] = std::max(b.high[axis], x);
    }
  }
}

std::size_t SeenEntries::place_of(const StateSpace& space, int state) {
  const Boundary b = space.boundary(state);
  const int first = space.first(b);
  return static_cast<std::size_t>(first / kStatesOfBox + static_cast<int>(b) +
                                  (state - first) / kStatesOfBox);
}

bool SeenEntries::Box::holds(const Crossing& entry) const {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double x = entry.*kCrossingAxes[axis];
    if (x < low[axis] || x > high[axis]) return false;
  }
  return true;
}

double unseen_share(const Kernel& kernel, const FieldParams& field, const StartTrials& start) {
  if (field.max_gates == 1 || start.first_runs() == 0) return 0.0;
  std::vector<std::int64_t> here(kernel.seen.boxes.size());  // first runs that enter each box
  std::int64_t outside = 0;
  for (const FieldTrials* trials : {&start.full, &start.first})
    for (std::size_t i = 0; i < trials->final_gates.size(); ++i) {
      const auto passages = trials->of_trial(i);
      const GatePassage& passage = passages.front();
      if (passages.size() > 1 || passage.ending == Ending::trapped ||
          passage.ending == Ending::broken)
        continue;  // the kernel has the entry, or there is none
      const Move move = move_into(passage.entry.boundary);
      if (!field.contains(field.start_column() + move.di_x, move.di_y)) continue;
      const std::size_t at =
          SeenEntries::place_of(kernel.space, kernel.space.index_of(passage.entry).state);
      ++here[at];
      if (!kernel.seen.boxes[at].holds(passage.entry)) ++outside;
    }
  // Of n entries the next one of the same kind lies beyond one of the six sides of their box with
  // 6 / (n + 1), about; how many of several do is the less certain the more there are of one box.
  constexpr std::int64_t kFew = 12;  // of fewer nothing is known
  double expected = 0.0, variance = 0.0;
  for (std::size_t i = 0; i < here.size(); ++i) {
    const std::int64_t n = kernel.seen.boxes[i].entries;
    if (n < kFew) continue;
    const double mean = 6.0 * static_cast<double>(here[i]) / static_cast<double>(n + 1);
    expected += mean;
    variance += mean + mean * mean / 6.0;
  }
  return std::max(0.0, static_cast<double>(outside) - expected - 2.0 * std::sqrt(variance)) /
         static_cast<double>(start.first_runs());
}

std::vector<std::int64_t> first_row(const GateParams& p, const StateSpace& space,
                                    const StartTrials& start, TrialGroup group) {
  const bool mirror = symmetric(p) && mirrored(start.start) == start.start;
  std::vector<std::int64_t> row(static_cast<std::size_t>(space.size()) + 1, 0);
  for (const FieldTrials* trials : {&start.full, &start.first})
    for (std::int64_t i = group.group; i < std::ssize(trials->final_gates); i += group.of) {
      const GatePassage& passage = trials->of_trial(static_cast<std::size_t>(i)).front();
      if (passage.ending == Ending::broken) continue;
      ++row[static_cast<std::size_t>(output_of(space, passage, passage.entry))];
      if (mirror)
        ++row[static_cast<std::size_t>(output_of(space, passage, mirrored(passage.entry)))];
    }
  return row;
}

std::vector<std::int64_t> first_row(const GateParams& p, const StateSpace& space,
                                    const ScatteredTrials& trials) {
  const bool mirror = symmetric(p);
  std::vector<std::int64_t> row(static_cast<std::size_t>(space.size()) + 1, 0);
  for (std::size_t i = 0; i < trials.starts.size(); ++i) {
    const GatePassage& passage = trials.each.of_trial(i).front();
    if (passage.ending == Ending::broken) continue;
    ++row[static_cast<std::size_t>(output_of(space, passage, passage.entry))];
    if (mirror) ++row[static_cast<std::size_t>(output_of(space, passage, mirrored(passage.entry)))];
  }
  return row;
}

markov::Chain chain_of(const Kernel& kernel,
                       const std::vector<std::vector<std::int64_t>>& first_rows) {
  const markov::Counts& k = kernel.counts;
  markov::Counts counts(k.rows() + std::ssize(first_rows), k.cols());
  counts.reserve(k.nonZeros());
  for (Eigen::Index row = 0; row < counts.rows(); ++row) {
    counts.startVec(row);
    if (row < k.rows()) {
      for (markov::Counts::InnerIterator it(k, row); it; ++it)
        counts.insertBack(row, it.col()) = it.value();
      continue;
    }
    const auto& first = first_rows[static_cast<std::size_t>(row - k.rows())];
    for (Eigen::Index column = 0; column < k.cols(); ++column)
      if (const std::int64_t n = first[static_cast<std::size_t>(column)]; n > 0)
        counts.insertBack(row, column) = n;
  }
  counts.finalize();
  return markov::Chain::from_counts(counts, exits_of(kernel.space));
}

Transitions transitions_of(const Kernel& kernel, const std::vector<Crossing>& starts,
                           const std::vector<std::vector<std::int64_t>>& first_rows) {
  Transitions t(StateSpace(kernel.space.trees(), starts));
  const auto add = [&](int row, int column, std::int64_t n) {
    t.rows[static_cast<std::size_t>(row)]
          [column == kernel.space.trapped() ? t.space.trapped() : column] += n;
    t.trials[static_cast<std::size_t>(row)] += n;
  };
  for (int row = 0; row < kernel.space.size(); ++row)
    for (markov::Counts::InnerIterator it(kernel.counts, row); it; ++it)
      add(row, static_cast<int>(it.col()), it.value());
  for (std::size_t s = 0; s < first_rows.size(); ++s)
    for (int column = 0; column <= kernel.space.size(); ++column)
      if (const std::int64_t n = first_rows[s][static_cast<std::size_t>(column)]; n > 0)
        add(kernel.space.size() + static_cast<int>(s), column, n);
  return t;
}

}  // namespace gatewalk::lattice
