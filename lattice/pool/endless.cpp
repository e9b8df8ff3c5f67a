// SPDX-License-Identifier: MIT
#include "lattice/pool/endless.h"

#include <tbb/parallel_for.h>

#include <array>
#include <optional>
#include <stdexcept>
#include <utility>

#include "lattice/gate_chain.h"

namespace gatewalk::lattice {

using namespace dynamics;

RangeRuns endless_trials(const Cell& cell, const std::function<Entry(Random&)>& start,
                         std::int64_t trials, int passages, std::uint64_t seed, Health& health) {
  if (trials < 1 || passages < 1)
    throw std::invalid_argument("endless trials: trials and passages must be > 0, not " +
                                std::to_string(trials) + " and " + std::to_string(passages));
  RangeRuns all;
  all.starts.resize(static_cast<std::size_t>(trials));
  std::vector<PassageTable> runs(all.starts.size(), PassageTable(cell.section()));
  carry_out_trials(
      cell, trials,
      [&](Body& body) {
        const auto i = static_cast<std::size_t>(body.trial);
        body.random = Random(Purpose::field, {seed, 0, static_cast<std::uint64_t>(body.trial)});
        body.entry = all.starts[i] = start(body.random);
        cell.begin(body);
      },
      [&](Body& body, const Passage& passage) {
        auto& own = runs[static_cast<std::size_t>(body.trial)];
        own.push_back({passage.fate, 0, passage.next, passage.costs});
        return passage.fate == Fate::left && static_cast<int>(own.size()) < passages;
      },
      health);
  all.each.passages.begin(cell.section());
  for (const auto& own : runs) {
    all.each.passages.append(own);
    all.each.passed.push_back(std::ssize(all.each.passages));
  }
  return all;
}

TreeDiffusion tree_diffusion(const CellMap& map, const RunPool& pool,
                             const Eigen::Matrix2d& lattice, int per_leaf, TrialGroup group) {
  if (map.types.size() != 1)
    throw std::invalid_argument("diffusion: cells of several types are not permitted");
  Kernel kernel = kernel_of(map, pool, per_leaf, group);
  const markov::Counts& counts = kernel.counts.front();
  markov::Reward time;
  if (!map.section.costs.empty()) {
    const auto sums = cost_sums(kernel, map, pool, group);
    for (Eigen::Index k = 0; k < counts.nonZeros(); ++k) {
      const auto runs = static_cast<double>(counts.valuePtr()[k]);
      const CostSums& took = sums.front()[static_cast<std::size_t>(k)];
      time.mean.push_back(took.sum[0] / runs);
      time.square.push_back(took.squares[0] / runs);
    }
  }
  const markov::Chain chain = markov::Chain::from_counts(counts, exits_of(kernel.space));
  return {std::move(kernel.space), markov::diffusion(chain, lattice, time)};
}

PooledDiffusion pooled_diffusion(const CellMap& map, const RunPool& pool,
                                 const Eigen::Matrix2d& lattice, int per_leaf) {
  std::array<std::optional<TreeDiffusion>, kTrialGroups> parts;
  tbb::parallel_for(0, kTrialGroups, [&](int g) {
    parts[static_cast<std::size_t>(g)] =
        tree_diffusion(map, pool, lattice, per_leaf, {g, kTrialGroups});
  });
  PooledDiffusion all{tree_diffusion(map, pool, lattice, per_leaf), {}, {}};
  std::vector<double> coefficients;
  for (auto& part : parts) {
    coefficients.push_back(part->walk.coefficient());
    all.groups.push_back(std::move(*part));
  }
  all.coefficient = mean_95(all.whole.walk.coefficient(), coefficients);
  return all;
}

}  // namespace gatewalk::lattice
