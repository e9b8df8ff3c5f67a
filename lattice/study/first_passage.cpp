// SPDX-License-Identifier: MIT
#include "lattice/study/first_passage.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <numeric>

#include "lattice/statistics/share_95.h"

namespace gatewalk::lattice {
namespace {

/// The time only. Empty if it was not measured, because a body already in the target would need 0
/// seconds.
markov::Rewards times_of(const markov::Rewards& rewards) {
  markov::Rewards times;
  bool known = false;
  for (const auto& of_type : rewards) {
    if (of_type.empty()) continue;
    const std::vector<double>& mean = times.emplace_back(1, of_type.front()).front().mean;
    known = known || std::any_of(mean.begin(), mean.end(), [](double x) { return x == x; });
  }
  return known ? times : markov::Rewards{};
}

struct AtStart {
  double chance, gates, time;
};

AtStart at_start(const markov::FirstPassages& f, const markov::Start& start) {
  const std::size_t at = f.at(start);
  return {f.chance[at], f.draws[at],
          f.totals.empty() ? std::numeric_limits<double>::quiet_NaN() : f.totals.front()[at]};
}

}  // namespace

FirstPassage first_passage(const FieldParams& field, const AnalysedChain& chain,
                           const markov::PassageTarget& target) {
  const auto passages_of = [&](const ChainWithRewards& c) {
    return markov::first_passages(c.chain, {field.columns, field.rows}, target, field.max_gates,
                                  times_of(c.rewards));
  };
  FirstPassage out{{}, {}, {}, passages_of(chain.chain)};
  const AtStart whole = at_start(out.all, chain.chain.start);
  const markov::Start& start = chain.chain.start;
  const bool is_there =
      target.holds(std::int64_t{start.row} * field.columns + start.column, start.input);
  std::vector<AtStart> groups(target.input || is_there ? 0 : chain.groups.size());
  tbb::parallel_for(std::size_t{0}, groups.size(), [&](std::size_t g) {
    const ChainWithRewards& c = chain.groups[g].chain;
    groups[g] = at_start(passages_of(c), c.start);
  });
  std::vector<double> chances, gates, times;
  const auto bodies = static_cast<double>(chain.bodies);
  RunsBehind runs{bodies * whole.chance, {}};
  for (const AtStart& g : groups) {
    chances.push_back(g.chance);
    gates.push_back(g.gates);
    times.push_back(g.time);
    runs.groups.push_back(bodies / kTrialGroups * g.chance);
  }
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const auto gate_runs =
      static_cast<double>(std::accumulate(chain.runs.begin(), chain.runs.end(), std::int64_t{0}));
  out.chance = {whole.chance, chances.empty()
                                  ? std::array<double, 2>{kNone, kNone}
                                  : share_95(whole.chance, chances, {bodies, gate_runs})};
  out.gates = mean_95(whole.gates, gates, runs);
  out.time = mean_95(whole.time, times, runs);
  return out;
}

}  // namespace gatewalk::lattice
