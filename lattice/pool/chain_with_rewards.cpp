// SPDX-License-Identifier: MIT
#include "lattice/pool/chain_with_rewards.h"

#include <tbb/parallel_for.h>

#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "dynamics/cells/entry_table.h"
#include "lattice/statistics/group_spread.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;

/// Mean costs of the runs behind each count, in the order of the chain's nonzeros.
std::vector<markov::Reward> rewards_of(const std::vector<std::int64_t>& counts,
                                       const std::vector<CostSums>& sums, std::size_t costs) {
  std::vector<markov::Reward> rewards(costs);
  for (std::size_t c = 0; c < costs; ++c)
    for (std::size_t i = 0; i < counts.size(); ++i) {
      const auto n = static_cast<double>(counts[i]);
      rewards[c].mean.push_back(sums[i].sum[c] / n);
      rewards[c].square.push_back(sums[i].squares[c] / n);
    }
  return rewards;
}

}  // namespace

ChainWithRewards chain_with_rewards(const Kernel& kernel, const CellMap& map,
                                    const FieldParams& field, const RunPool& pool,
                                    const FirstRow& start, TrialGroup group) {
  const int start_type = map.type_of(field.start_column(), field.start_row);
  const auto sums = cost_sums(kernel, map, pool, group);
  const markov::Counts first = first_rows(kernel, map, pool, {start}, start_type, {group});
  const auto first_sums = first_cost_sums(kernel, sums, map, pool, start, start_type, group);
  markov::Rewards rewards;
  for (std::size_t type = 0; type < kernel.counts.size(); ++type) {
    const markov::Counts& k = kernel.counts[type];
    std::vector<std::int64_t> counts(k.valuePtr(), k.valuePtr() + k.nonZeros());
    std::vector<CostSums> costs = sums[type];
    if (static_cast<int>(type) == start_type) {
      counts.insert(counts.end(), first.valuePtr(), first.valuePtr() + first.nonZeros());
      costs.insert(costs.end(), first_sums.begin(), first_sums.end());
    }
    rewards.push_back(rewards_of(counts, costs, map.section.costs.size()));
  }
  return {chain_of(kernel, map, field, first),
          std::move(rewards),
          {field.start_column(), field.start_row, kernel.space.size()}};
}

namespace {

/// Entries of the pool's runs by leaf, with mirror images.
std::vector<EntryTable> entries_of_leaves(const Kernel& kernel, const CellMap& map,
                                          const RunPool& pool, TrialGroup group) {
  std::vector<EntryTable> entries(static_cast<std::size_t>(kernel.space.size()),
                                  EntryTable(map.section));
  each_entry(pool, group, [&](const Entry& entry, int type) {
    const auto put = [&](const Entry& c) {
      entries[static_cast<std::size_t>(kernel.space.index_of(c).state)].push_back(c);
    };
    put(entry);
    if (map.types[static_cast<std::size_t>(type)].symmetric)
      put(mirrored(kernel.space.section(), entry));
  });
  return entries;
}

/// The entries of the start's row: the start itself, or the entries seen.
EntryTable first_entries(const Kernel& kernel, const CellMap& map, const RunPool& pool,
                         const FirstRow& start, TrialGroup group,
                         const std::vector<EntryTable>& of_leaves) {
  if (const auto* const own = std::get_if<const OwnRuns*>(&start))
    return {map.section, {(*own)->start}};
  if (const auto* const entry = std::get_if<Entry>(&start))
    return of_leaves[static_cast<std::size_t>(kernel.space.index_of(*entry).state)];
  EntryTable entries(map.section);
  for (std::int64_t i = 0; i < std::ssize(pool.scattered.starts); ++i)
    if (group.holds(pool.scattered.each, i))
      entries.push_back(pool.scattered.starts[static_cast<std::size_t>(i)]);
  return entries;
}

}  // namespace

AnalysedChain analysed_chain(const Problem& problem, const RunPool& pool, const FirstRow& start,
                             int per_leaf) {
  const auto* const own = std::get_if<const OwnRuns*>(&start);
  if (own ? (*own)->first_runs() == 0
          : !std::holds_alternative<Entry>(start) && pool.scattered.starts.empty())
    throw std::invalid_argument("analysis: the start has no runs of its own");
  const CellMap& map = problem.map();
  const auto chain_of_group = [&](TrialGroup group) -> AnalysedChain {
    Kernel kernel = kernel_of(map, pool, per_leaf, group);
    ChainWithRewards chain = chain_with_rewards(kernel, map, problem.field, pool, start, group);
    auto entries = entries_of_leaves(kernel, map, pool, group);
    entries.push_back(first_entries(kernel, map, pool, start, group, entries));
    const auto type = static_cast<std::size_t>(problem.start_type());
    std::vector<std::int64_t> runs;
    for (int state = 0; state < kernel.space.size(); ++state)
      runs.push_back(kernel.counts[type].row(state).sum());
    return {.chain = std::move(chain),
            .space = std::move(kernel.space),
            .entry =
                [entries = std::move(entries)](int state, Random& random) {
                  const auto& there = entries[static_cast<std::size_t>(state)];
                  return there[static_cast<std::size_t>(
                      random.below(static_cast<std::int64_t>(there.size())))];
                },
            .runs = std::move(runs)};
  };
  AnalysedChain whole = chain_of_group({});
  if (problem.is_recorded() && pool.bodies() < kLeastBodies) return whole;
  std::array<std::optional<AnalysedChain>, kTrialGroups> parts;
  tbb::parallel_for(0, kTrialGroups, [&](int g) {
    parts[static_cast<std::size_t>(g)] = chain_of_group({g, kTrialGroups});
  });
  for (auto& part : parts) whole.groups.push_back(std::move(*part));
  whole.bodies = pool.bodies();
  return whole;
}

AnalysedChain analysed_chain(const Problem& problem, const std::vector<Transitions>& matrices,
                             const markov::Start& start) {
  markov::Rewards rewards;
  for (const Transitions& t : matrices) {
    std::vector<std::int64_t> counts;
    std::vector<CostSums> sums;
    CostSums unknown;
    unknown.sum.fill(std::nan(""));
    unknown.squares.fill(std::nan(""));
    for (std::size_t row = 0; row < t.rows.size(); ++row)
      for (const auto& [column, n] : t.rows[row]) {
        const auto known = t.costs[row].find(column);
        counts.push_back(n);
        sums.push_back(known == t.costs[row].end() ? unknown : known->second);
      }
    rewards.push_back(rewards_of(counts, sums, t.space.section().costs.size()));
  }
  const StateSpace& space = matrices.front().space;
  return {.chain = {make_chain(problem.map(), matrices), std::move(rewards), start},
          .space = space,
          .entry = [space](int state, Random& random) { return space.sample(state, random); },
          .runs = matrices[static_cast<std::size_t>(problem.start_type())].trials};
}

}  // namespace gatewalk::lattice
