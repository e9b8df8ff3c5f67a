#include "lattice/pool/costed_chain.h"

#include <tbb/parallel_for.h>

#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "lattice/statistics/group_spread.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;

/// Means over the draws behind each count, as the chain's nonzeros stand.
std::vector<markov::Reward> rewards_of(const std::vector<std::int64_t>& counts,
                                       const std::vector<CostSums>& sums) {
  std::vector<markov::Reward> rewards(kCosts);
  for (std::size_t c = 0; c < kCosts; ++c)
    for (std::size_t i = 0; i < counts.size(); ++i) {
      const auto n = static_cast<double>(counts[i]);
      rewards[c].mean.push_back(sums[i].sum[c] / n);
      rewards[c].square.push_back(sums[i].squares[c] / n);
    }
  return rewards;
}

}  // namespace

CostedChain costed_chain(const Kernel& kernel, const CellMap& map, const FieldParams& field,
                         const RunPool& pool, const StartTrials& start, TrialGroup group) {
  const auto first = first_row(map, kernel.space, start, group);
  const auto first_sums = first_cost_sums(map, kernel.space, start, group);
  const auto sums = cost_sums(kernel, map, pool, group);
  markov::Rewards rewards;
  for (std::size_t type = 0; type < kernel.counts.size(); ++type) {
    const markov::Counts& k = kernel.counts[type];
    std::vector<std::int64_t> counts(k.valuePtr(), k.valuePtr() + k.nonZeros());
    std::vector<CostSums> costs = sums[type];
    if (static_cast<int>(type) == map.type_of(field.start_column(), 0))
      for (std::size_t output = 0; output < first.size(); ++output)
        if (first[output] > 0) {
          counts.push_back(first[output]);
          costs.push_back(first_sums[output]);
        }
    rewards.push_back(rewards_of(counts, costs));
  }
  return {chain_of(kernel, map, field, {first}),
          std::move(rewards),
          {field.start_column(), 0, kernel.space.size()}};
}

namespace {

/// Entries of the pool's runs by leaf, mirror images too.
std::vector<std::vector<Entry>> entries_of_leaves(const Kernel& kernel, const CellMap& map,
                                                  const RunPool& pool, TrialGroup group) {
  std::vector<std::vector<Entry>> entries(static_cast<std::size_t>(kernel.space.size()));
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

}  // namespace

AnalysedChain analysed_chain(const Scene& scene, const RunPool& pool, const Entry& start,
                             int per_leaf) {
  const std::size_t own = pool.place_of(start);
  if (own == pool.starts.size())
    throw std::invalid_argument("analysis: the start has no runs of its own");
  const CellMap map = gates_of(scene).map();
  const auto chain_of_group = [&](TrialGroup group) -> AnalysedChain {
    Kernel kernel = kernel_of(map, pool, per_leaf, group);
    CostedChain chain = costed_chain(kernel, map, scene.field, pool, pool.starts[own], group);
    auto entries = entries_of_leaves(kernel, map, pool, group);
    entries.push_back({start});
    const auto type = static_cast<std::size_t>(map.type_of(scene.field.start_column(), 0));
    std::vector<std::int64_t> runs;
    for (int state = 0; state < kernel.space.size(); ++state)
      runs.push_back(kernel.counts[type].row(state).sum());
    return {.chain = std::move(chain),
            .space = std::move(kernel.space),
            .entry =
                [entries = std::move(entries)](int state, Random& random) {
                  const auto& there = entries[static_cast<std::size_t>(state)];
                  return there[static_cast<std::size_t>(random.below(std::ssize(there)))];
                },
            .runs = std::move(runs)};
  };
  std::array<std::optional<AnalysedChain>, kTrialGroups> parts;
  tbb::parallel_for(0, kTrialGroups, [&](int g) {
    parts[static_cast<std::size_t>(g)] = chain_of_group({g, kTrialGroups});
  });
  AnalysedChain whole = chain_of_group({});
  for (auto& part : parts) whole.groups.push_back(std::move(*part));
  return whole;
}

AnalysedChain analysed_chain(const Scene& scene, const std::vector<Transitions>& matrices,
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
    rewards.push_back(rewards_of(counts, sums));
  }
  const StateSpace& space = matrices.front().space;
  return {.chain = {make_chain(gates_of(scene).map(), matrices), std::move(rewards), start},
          .space = space,
          .entry = [space](int state, Random& random) { return space.sample(state, random); }};
}

}  // namespace gatewalk::lattice
