// SPDX-License-Identifier: MIT
#include "lattice/pool/kernel.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace gatewalk::lattice {
namespace {

using namespace dynamics;

/// Calls use(entry, passage, next) for the unbroken runs of the group's trials, without the first
/// `skipped` runs of each trial. `start_of(i)`: where trial i started; `next`: the following run of
/// the same trial, which is the next call's passage, or null.
template <class StartOf, class Use>
void each_run(const FieldTrials& trials, TrialGroup group, std::size_t skipped, StartOf start_of,
              Use use) {
  constexpr CellPassage kNone{.fate = Fate::broken};
  for (std::int64_t i = 0; i < std::ssize(trials.passed); ++i) {
    if (!group.holds(trials, i)) continue;
    const auto passages = trials.of_trial(static_cast<std::size_t>(i));
    if (passages.size() <= skipped) continue;
    Entry entry = skipped == 0 ? start_of(i) : passages[skipped - 1].entry;
    CellPassage passage = passages[skipped];
    for (std::size_t k = skipped; k < passages.size(); ++k) {
      const CellPassage next = k + 1 < passages.size() ? passages[k + 1] : kNone;
      if (passage.fate != Fate::broken)
        use(entry, passage, next.fate == Fate::broken ? nullptr : &next);
      entry = passage.entry;
      passage = next;
    }
  }
}

template <class Use>
void each_kernel_run(const RunPool& pool, TrialGroup group, Use use) {
  for (const OwnRuns& s : pool.starts)
    each_run(
        s.full, group, 1, [&](std::int64_t) { return s.start; }, use);
  each_run(
      pool.scattered.each, group, 0,
      [&](std::int64_t i) { return pool.scattered.starts[static_cast<std::size_t>(i)]; }, use);
}

// Number of leaves in a box: leaves adjacent in preorder are near each other; together they have
// some hundred entries.
constexpr int kStatesOfBox = 16;

int output_of(const StateSpace& space, const CellPassage& passage, const Entry& entry) {
  return passage.fate == Fate::trapped ? space.trapped() : space.index_of(entry).state;
}

/// Counts of runs from state row[i] to output column[i].
markov::Counts counted(const std::vector<int>& row, const std::vector<int>& column, int states) {
  std::vector<std::int64_t> end(static_cast<std::size_t>(states) + 1, 0);
  for (const int r : row) ++end[static_cast<std::size_t>(r) + 1];
  std::partial_sum(end.begin(), end.end(), end.begin());
  std::vector<int> sorted(column.size());  // columns, sorted by row
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

/// By type: the number of counts per run, 2 in symmetric cells.
std::vector<std::size_t> images_of(const CellMap& map) {
  std::vector<std::size_t> images;
  for (const CellMap::Type& type : map.types) images.push_back(type.symmetric ? 2 : 1);
  return images;
}

/// Joins the leaves of a tree into parts with at least `least` runs each. `runs`: of each leaf;
/// `first` gets for each leaf the first leaf of its part.
void join_leaves(const Tree& tree, const std::int64_t* runs, std::int64_t least, int first_state,
                 int* first) {
  const std::size_t nodes = tree.nodes.size();
  // By node: its second half, number of leaves, next node.
  std::vector<std::size_t> above(nodes), leaves(nodes, 1), end(nodes);
  for (std::size_t i = nodes; i-- > 0;) {
    end[i] = i + 1;
    if (tree.nodes[i].axis == Tree::kLeaf) continue;
    above[i] = end[i + 1];
    end[i] = end[above[i]];
    leaves[i] = leaves[i + 1] + leaves[above[i]];
  }
  std::vector<std::pair<std::size_t, std::size_t>> open{{0, 0}};  // node, index of its first leaf
  while (!open.empty()) {
    const auto [node, begin] = open.back();
    open.pop_back();
    const auto runs_in = [&](std::size_t from, std::size_t count) {
      return std::accumulate(runs + from, runs + from + count, std::int64_t{0});
    };
    const std::size_t below = node + 1, cut = begin + (leaves[node] > 1 ? leaves[below] : 0);
    if (leaves[node] > 1 && runs_in(begin, cut - begin) >= least &&
        runs_in(cut, leaves[above[node]]) >= least) {
      open.emplace_back(below, begin);
      open.emplace_back(above[node], cut);
    } else {
      std::fill(first + begin, first + begin + leaves[node], first_state + static_cast<int>(begin));
    }
  }
}

/// Counts of one type, from row[i] to column[i]. Leaves with few runs are counted together; `first`
/// gets for each leaf the first leaf that it is counted with.
markov::Counts counts_of_type(const StateSpace& space, std::vector<int> row,
                              const std::vector<int>& column, std::int64_t least,
                              std::vector<int>& first) {
  std::vector<std::int64_t> runs(static_cast<std::size_t>(space.size()), 0);
  for (const int r : row) ++runs[static_cast<std::size_t>(r)];
  first = joined_leaves(space, runs, least);
  for (int& r : row) r = first[static_cast<std::size_t>(r)];
  const markov::Counts parts = counted(row, column, space.size());
  markov::Counts counts(parts.rows(), parts.cols());
  for (int leaf = 0; leaf < space.size(); ++leaf) {
    counts.startVec(leaf);
    for (markov::Counts::InnerIterator it(parts, first[static_cast<std::size_t>(leaf)]); it; ++it)
      counts.insertBack(leaf, it.col()) = it.value();
  }
  counts.finalize();
  return counts;
}

/// Adds the counts of runs that further words count. `entries`, `types`, `row`, `column`: by count.
void add_borrowed(const Kernel& kernel, const CellMap& map, const RunPool& pool, TrialGroup group,
                  EntryTable& entries, std::vector<std::uint8_t>& types, std::vector<int>& row,
                  std::vector<int>& column) {
  const Section& section = map.section;
  each_kernel_run(pool, group, [&](const Entry& entry, const CellPassage& run, const auto*) {
    const auto add = [&](const Entry& from, const CellPassage& passage) {
      entries.push_back(from);
      types.push_back(run.type);
      row.push_back(kernel.space.index_of(from).state);
      column.push_back(output_of(kernel.space, passage, passage.entry));
    };
    kernel.borrowers.each(section, entry, run, add);
    if (map.types[run.type].symmetric)
      kernel.borrowers.each(section, mirrored(section, entry), mirrored(section, run), add);
  });
}

}  // namespace

void each_entry(const RunPool& pool, TrialGroup group,
                const std::function<void(const Entry& entry, int type)>& use) {
  each_kernel_run(pool, group, [&](const Entry& entry, const CellPassage& run, const auto*) {
    use(entry, run.type);
  });
}

std::int64_t kernel_runs(const RunPool& pool) {
  std::int64_t runs = std::ssize(pool.scattered.each.passages);
  for (const OwnRuns& s : pool.starts) runs += std::ssize(s.full.passages);
  return runs;
}

std::int64_t Kernel::nonzeros() const {
  std::int64_t all = 0;
  for (const markov::Counts& c : counts) all += c.nonZeros();
  return all;
}

Kernel kernel_of(const CellMap& map, const RunPool& pool, int per_leaf, TrialGroup group,
                 std::optional<int> per_row) {
  const std::vector<std::size_t> images = images_of(map);
  const Section& section = map.section;
  EntryTable entries(section);
  std::vector<std::uint8_t> types;
  const auto about = static_cast<std::size_t>(2 * kernel_runs(pool) / group.of);
  entries.reserve(about);
  types.reserve(about);
  each_kernel_run(pool, group, [&](const Entry& entry, const CellPassage& run, const auto*) {
    entries.push_back(entry);
    if (images[run.type] == 2) entries.push_back(mirrored(section, entry));
    types.resize(entries.size(), run.type);
  });
  std::vector<int> row, column;
  const std::int64_t fits = 2 * static_cast<std::int64_t>(entries.size()) / kMostStates;
  per_leaf = static_cast<int>(std::max<std::int64_t>(per_leaf, fits));
  const int least = per_row.value_or(per_leaf);
  StateSpace space = tree_space(section, entries, per_leaf, {}, &row);
  column.reserve(row.size());
  each_kernel_run(pool, group, [&](const Entry&, const CellPassage& run, const CellPassage* next) {
    const std::size_t at = column.size() + images[run.type];
    for (std::size_t image = 0; image < images[run.type]; ++image)
      column.push_back(
          next && image < images[next->type]
              ? row[at + image]
              : output_of(space, run, image == 0 ? run.entry : mirrored(section, run.entry)));
  });
  Kernel kernel{std::move(space), {}};
  if (section.words) {
    std::vector<std::vector<std::int64_t>> runs(map.types.size(),
                                                std::vector<std::int64_t>(section.faces.size()));
    for (std::size_t i = 0; i < types.size(); ++i)
      ++runs[types[i]][static_cast<std::size_t>(entries.face(i))];
    kernel.borrowers = Borrowers(section, runs, 2 * std::int64_t{least});
    add_borrowed(kernel, map, pool, group, entries, types, row, column);
  }
  const bool of_all = group.of == 1;
  if (map.types.size() == 1) {
    kernel.counts.push_back(counted(row, column, kernel.space.size()));
    if (of_all) kernel.seen.emplace_back(kernel.space, entries, row);
    return kernel;
  }
  for (std::size_t type = 0; type < map.types.size(); ++type) {
    EntryTable there(section);
    std::vector<int> from, to;
    for (std::size_t i = 0; i < types.size(); ++i) {
      if (types[i] != type) continue;
      if (of_all) there.push_back(entries[i]);
      from.push_back(row[i]);
      to.push_back(column[i]);
    }
    if (of_all) kernel.seen.emplace_back(kernel.space, there, from);
    kernel.counts.push_back(
        counts_of_type(kernel.space, std::move(from), to, least, kernel.shared_by.emplace_back()));
  }
  return kernel;
}

CellPassage mirrored(const Section& section, CellPassage passage) {
  if (passage.fate == Fate::left) passage.entry = mirrored(section, passage.entry);
  return passage;
}

Borrowers::Borrowers(const Section& section, const std::vector<std::vector<std::int64_t>>& runs,
                     std::int64_t least) {
  const Words& words = *section.words;
  const auto at = [](int i) { return static_cast<std::size_t>(i); };
  for (const std::vector<std::int64_t>& of_type : runs) {
    std::vector<std::int64_t> with_end = of_type;  // by label: runs of all words with this end
    for (int w = words.size() - 1; w > 0; --w)     // shorter words come first
      for (int face = 0; face < words.letters().faces; ++face)
        with_end[at(words.label(face, words.shorter(w)))] += with_end[at(words.label(face, w))];
    auto& takers = takers_.emplace_back(of_type.size());
    for (int w = 0; w < words.size(); ++w)
      for (int face = 0; face < words.letters().faces; ++face) {
        if (of_type[at(words.label(face, w))] >= least) continue;
        int end = w;
        while (end != 0 && with_end[at(words.label(face, end))] < least) end = words.shorter(end);
        takers[at(words.label(face, end))].push_back(w);
      }
  }
}

SeenEntries::SeenEntries(const StateSpace& space, const EntryTable& entries,
                         const std::vector<int>& state)
    : coordinates(entries.coordinates()) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  Box none;
  std::fill_n(none.low.begin(), coordinates, kNone);
  std::fill_n(none.high.begin(), coordinates, -kNone);
  boxes.assign(
      static_cast<std::size_t>(space.size() / kStatesOfBox + std::ssize(space.trees()) + 1), none);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    Box& b = boxes[place_of(space, state[i])];
    ++b.entries;
    for (std::size_t axis = 0; axis < coordinates; ++axis) {
      const double x = entries.at(i)[axis];
      b.low[axis] = std::min(b.low[axis], x);
      b.high[axis] = std::max(b.high[axis], x);
    }
  }
}

std::size_t SeenEntries::place_of(const StateSpace& space, int state) {
  const int face = space.face(state), first = space.first(face);
  return static_cast<std::size_t>(first / kStatesOfBox + face + (state - first) / kStatesOfBox);
}

bool SeenEntries::holds(std::size_t box, const Entry& entry) const {
  const Box& b = boxes[box];
  for (std::size_t axis = 0; axis < coordinates; ++axis) {
    const double x = entry.at[axis];
    if (x < b.low[axis] || x > b.high[axis]) return false;
  }
  return true;
}

double missing_mass(const Kernel& kernel, const CellMap& map, const FieldParams& field,
                    const OwnRuns& start) {
  if (field.max_gates == 1 || start.first_runs() == 0) return 0.0;
  // First runs that enter each box, by type of the gate entered.
  std::vector<std::vector<std::int64_t>> here;
  for (const SeenEntries& seen : kernel.seen) here.emplace_back(seen.boxes.size());
  std::int64_t outside = 0;
  for (const FieldTrials* trials : {&start.full, &start.first})
    for (std::size_t i = 0; i < trials->passed.size(); ++i) {
      const auto passages = trials->of_trial(i);
      const CellPassage passage = passages.front();
      if (passages.size() > 1 || passage.fate != Fate::left)
        continue;  // the kernel has this entry, or there is none
      const Face& move = kernel.space.section().faces[passage.entry.face];
      const int column = field.start_column() + move.di_x, row = field.start_row + move.di_y;
      if (!field.contains(column, row)) continue;
      const auto type = static_cast<std::size_t>(map.type_of(column, row));
      const std::size_t at =
          SeenEntries::place_of(kernel.space, kernel.space.index_of(passage.entry).state);
      ++here[type][at];
      if (!kernel.seen[type].holds(at, passage.entry)) ++outside;
    }
  // With n entries in a box, the next one lies outside one of the box's sides with probability
  // about sides / (n + 1). The variance grows with the number of first runs in one box.
  constexpr std::int64_t kFew = 12;  // boxes with fewer entries say nothing
  const double sides = 2.0 * static_cast<double>(kernel.space.section().coordinates.size());
  double expected = 0.0, variance = 0.0;
  for (std::size_t type = 0; type < here.size(); ++type)
    for (std::size_t i = 0; i < here[type].size(); ++i) {
      const std::int64_t n = kernel.seen[type].boxes[i].entries;
      if (n < kFew) continue;
      const double mean = sides * static_cast<double>(here[type][i]) / static_cast<double>(n + 1);
      expected += mean;
      variance += mean + mean * mean / sides;
    }
  return std::max(0.0, static_cast<double>(outside) - expected - 2.0 * std::sqrt(variance)) /
         static_cast<double>(start.first_runs());
}

std::vector<int> joined_leaves(const StateSpace& space, const std::vector<std::int64_t>& runs,
                               std::int64_t least) {
  std::vector<int> first(runs.size());
  for (int face = 0; face < std::ssize(space.trees()); ++face) {
    const int begin = space.first(face);
    join_leaves(space.trees()[static_cast<std::size_t>(face)], runs.data() + begin, least, begin,
                first.data() + begin);
  }
  return first;
}

markov::Counts counts_between(const StateSpace& rows, const StateSpace& outputs, const CellMap& map,
                              const RunPool& pool, int type) {
  const Section& section = map.section;
  const bool images = map.types[static_cast<std::size_t>(type)].symmetric;
  std::vector<Eigen::Triplet<std::int64_t>> runs;
  each_kernel_run(pool, {}, [&](const Entry& entry, const CellPassage& run, const auto*) {
    if (run.type != type) return;
    runs.emplace_back(rows.index_of(entry).state, output_of(outputs, run, run.entry), 1);
    if (images)
      runs.emplace_back(rows.index_of(mirrored(section, entry)).state,
                        output_of(outputs, run, mirrored(section, run.entry)), 1);
  });
  markov::Counts counts(rows.size(), std::int64_t{outputs.size()} + 1);
  counts.setFromTriplets(runs.begin(), runs.end());
  return counts;
}

std::vector<std::vector<CostSums>> cost_sums(const Kernel& kernel, const CellMap& map,
                                             const RunPool& pool, TrialGroup group) {
  const auto row_of = [&](std::size_t type, int leaf) {
    return kernel.shared_by.empty() ? leaf : kernel.shared_by[type][static_cast<std::size_t>(leaf)];
  };
  std::vector<std::vector<CostSums>> sums;
  for (const markov::Counts& counts : kernel.counts)
    sums.emplace_back(static_cast<std::size_t>(counts.nonZeros()));
  each_kernel_run(pool, group, [&](const Entry& entry, const CellPassage& run, const auto*) {
    const markov::Counts& counts = kernel.counts[run.type];
    kernel.each_count(map, entry, run, [&](int row, int column) {
      const auto *begin = counts.innerIndexPtr() + counts.outerIndexPtr()[row],
                 *end = counts.innerIndexPtr() + counts.outerIndexPtr()[row + 1];
      const auto* const at = std::lower_bound(begin, end, column);
      if (at == end || *at != column)
        throw std::invalid_argument("cost sums: a run is none of the kernel's");
      sums[run.type][static_cast<std::size_t>(at - counts.innerIndexPtr())].add(run.costs);
    });
  });
  for (std::size_t type = 0; type < kernel.shared_by.size(); ++type) {
    const auto* const begin = kernel.counts[type].outerIndexPtr();
    for (int leaf = 0; leaf < kernel.space.size(); ++leaf)
      if (const int row = row_of(type, leaf); row != leaf)
        std::copy(sums[type].begin() + begin[row], sums[type].begin() + begin[row + 1],
                  sums[type].begin() + begin[leaf]);
  }
  return sums;
}

namespace {

/// Calls use(output, passage) for the first runs of one group of these trials; `with_images`: for
/// their mirror images too.
template <class Use>
void each_first_run(const CellMap& map, const StateSpace& space, const FieldTrials& trials,
                    bool with_images, TrialGroup group, Use use) {
  const std::vector<std::size_t> images = images_of(map);
  for (std::int64_t i = 0; i < std::ssize(trials.passed); ++i) {
    if (!group.holds(trials, i)) continue;
    const CellPassage passage = trials.of_trial(static_cast<std::size_t>(i)).front();
    if (passage.fate == Fate::broken) continue;
    use(output_of(space, passage, passage.entry), passage);
    if (with_images && images[passage.type] == 2)
      use(output_of(space, passage, mirrored(space.section(), passage.entry)), passage);
  }
}

/// Calls use_run(output, passage) for the first runs behind a start's row in cells of this type:
/// its own, or those of all scattered trials through such cells. The latter count without mirror
/// images, because cells may be symmetric while the distribution of starts is not. Without any
/// runs, calls use_leaf(leaf) instead: for the start's leaf, or for those of all scattered trials.
template <class UseRun, class UseLeaf>
void each_first_run(const Kernel& kernel, const CellMap& map, const RunPool& pool,
                    const FirstRow& start, int type, TrialGroup group, UseRun use_run,
                    UseLeaf use_leaf) {
  const StateSpace& space = kernel.space;
  const auto use_entry = [&](const Entry& entry) { use_leaf(space.index_of(entry).state); };
  if (const auto* const entry = std::get_if<Entry>(&start)) return use_entry(*entry);
  if (const auto* const own = std::get_if<const OwnRuns*>(&start)) {
    const bool in_the_middle = mirrored(space.section(), (*own)->start) == (*own)->start;
    for (const FieldTrials* trials : {&(*own)->full, &(*own)->first})
      each_first_run(map, space, *trials, in_the_middle, group, use_run);
    return;
  }
  const FieldTrials& each = pool.scattered.each;
  const auto is_of_type = [&](std::size_t i) { return each.of_trial(i).front().type == type; };
  std::size_t i = 0;
  while (i < each.passed.size() && !is_of_type(i)) ++i;
  if (i < each.passed.size())
    return each_first_run(map, space, each, false, group,
                          [&](int output, const CellPassage& passage) {
                            if (passage.type == type) use_run(output, passage);
                          });
  for (std::int64_t k = 0; k < std::ssize(pool.scattered.starts); ++k)
    if (group.holds(each, k)) use_entry(pool.scattered.starts[static_cast<std::size_t>(k)]);
}

}  // namespace

markov::Counts first_rows(const Kernel& kernel, const CellMap& map, const RunPool& pool,
                          const std::vector<FirstRow>& starts, int type,
                          const std::vector<TrialGroup>& groups) {
  const Eigen::Index outputs = kernel.space.size() + 1;
  markov::Counts rows(std::ssize(groups) * std::ssize(starts), outputs);
  Eigen::Index row = 0;
  for (const TrialGroup group : groups)
    for (const FirstRow& start : starts) {
      std::vector<std::int64_t> counts(static_cast<std::size_t>(outputs), 0);
      each_first_run(
          kernel, map, pool, start, type, group,
          [&](int output, const CellPassage&) { ++counts[static_cast<std::size_t>(output)]; },
          [&](int leaf) {
            const auto& all = kernel.counts[static_cast<std::size_t>(type)];
            for (markov::Counts::InnerIterator it(all, leaf); it; ++it)
              counts[static_cast<std::size_t>(it.col())] += it.value();
          });
      rows.startVec(row);
      for (Eigen::Index output = 0; output < outputs; ++output)
        if (const std::int64_t n = counts[static_cast<std::size_t>(output)]; n > 0)
          rows.insertBack(row, output) = n;
      ++row;
    }
  rows.finalize();
  return rows;
}

std::vector<CostSums> first_cost_sums(const Kernel& kernel,
                                      const std::vector<std::vector<CostSums>>& sums,
                                      const CellMap& map, const RunPool& pool,
                                      const FirstRow& start, int type, TrialGroup group) {
  std::map<int, CostSums> row;  // sums by output
  each_first_run(
      kernel, map, pool, start, type, group,
      [&](int output, const CellPassage& run) { row[output].add(run.costs); },
      [&](int leaf) {
        const markov::Counts& counts = kernel.counts[static_cast<std::size_t>(type)];
        for (auto k = counts.outerIndexPtr()[leaf]; k < counts.outerIndexPtr()[leaf + 1]; ++k)
          if (counts.valuePtr()[k] > 0)
            row[counts.innerIndexPtr()[k]] +=
                sums[static_cast<std::size_t>(type)][static_cast<std::size_t>(k)];
      });
  std::vector<CostSums> in_order;
  for (const auto& [output, sum] : row) in_order.push_back(sum);
  return in_order;
}

markov::FieldChain chain_of(const Kernel& kernel, const CellMap& map, const FieldParams& field,
                            const markov::Counts& first_rows) {
  const int start_type = map.type_of(field.start_column(), field.start_row);
  std::vector<markov::Chain> chains;
  for (const markov::Counts& counts : kernel.counts)
    chains.push_back(markov::Chain::from_counts(
        counts, exits_of(kernel.space),
        std::ssize(chains) == start_type ? first_rows
                                         : markov::Counts(first_rows.rows(), counts.cols())));
  return field_chain(map, std::move(chains));
}

std::vector<Transitions> transitions_of(const Kernel& kernel, const CellMap& map,
                                        const FieldParams& field, const std::vector<Entry>& starts,
                                        const markov::Counts& first_rows) {
  std::vector<Transitions> all;
  const int start_type = map.type_of(field.start_column(), field.start_row);
  for (const markov::Counts& counts : kernel.counts) {
    const bool has_first = std::ssize(all) == start_type;
    Transitions& t =
        all.emplace_back(StateSpace(kernel.space.section(), kernel.space.trees(), starts));
    const auto add_rows = [&](const markov::Counts& from, int first) {
      for (int row = 0; row < from.rows(); ++row)
        for (markov::Counts::InnerIterator it(from, row); it; ++it) {
          const auto at = static_cast<std::size_t>(first + row);
          const int column = static_cast<int>(it.col());
          t.rows[at][column == kernel.space.trapped() ? t.space.trapped() : column] += it.value();
          t.trials[at] += it.value();
        }
    };
    add_rows(counts, 0);
    if (has_first) add_rows(first_rows, kernel.space.size());
  }
  return all;
}

}  // namespace gatewalk::lattice
