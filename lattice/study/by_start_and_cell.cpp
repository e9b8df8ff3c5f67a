// SPDX-License-Identifier: MIT
#include "lattice/study/by_start_and_cell.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "dynamics/base/share.h"
#include "lattice/statistics/quantiles.h"
#include "lattice/statistics/share_95.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;
using markov::EndTable;

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr auto kEndCount = static_cast<Eigen::Index>(markov::kEndings);

/// Means over the runs of each state (rows) of the values of their outputs.
EndTable means_of(const markov::Counts& counts, const std::vector<std::int64_t>& runs,
                  const EndTable& by_output) {
  EndTable means = (counts.cast<double>() * by_output.matrix()).array();
  for (Eigen::Index state = 0; state < means.rows(); ++state)
    means.row(state) /= static_cast<double>(runs[static_cast<std::size_t>(state)]);
  return means;
}

/// Half-width of the 95 % interval of a mean of runs.
class MeanOfRuns {
 public:
  explicit MeanOfRuns(double runs)
      : runs_(runs), quantile_(runs < 2.0 ? 0.0 : student_t_975(runs - 1.0)) {}
  [[nodiscard]] double half_width(double mean, double mean_square) const {
    if (runs_ < 2.0) return 1.0;
    return quantile_ * std::sqrt(std::max(0.0, mean_square - mean * mean) / (runs_ - 1.0));
  }

 private:
  double runs_, quantile_;
};

/// True if a range contains mirror images of its own entries: its runs then are counted with their
/// images.
bool holds_mirror_images(const Section& section, const StateRange& range) {
  const Face& face = section.faces[static_cast<std::size_t>(range.face)];
  if (face.mirror != range.face) return false;
  for (std::size_t axis = 0; axis < section.coordinates.size(); ++axis)
    if (face.is_odd(axis) && !(range.at[axis][0] < 0.0 && range.at[axis][1] > 0.0)) return false;
  return true;
}

/// Which leaves are joined to which states.
struct Joined {
  std::vector<int> of_leaf;
  std::vector<int> first_leaf;  // by state
};
Joined joined(const StateSpace& space, const std::vector<std::int64_t>& runs,
              const std::vector<int>& faces, std::int64_t least) {
  const std::vector<int> first = joined_leaves(space, runs, least);
  Joined j{std::vector<int>(first.size(), -1), {}};
  for (const int face : faces) {
    const int begin = space.first(face), end = space.first(face + 1);
    for (int leaf = begin; leaf < end; ++leaf) {
      const auto at = static_cast<std::size_t>(leaf);
      if (first[at] == leaf) j.first_leaf.push_back(leaf);
      j.of_leaf[at] = static_cast<int>(j.first_leaf.size()) - 1;
    }
  }
  return j;
}

}  // namespace

ChainOutcomes chain_outcomes(const AnalysedChain& chain, const FieldParams& field,
                             const Work& work) {
  const markov::Field cells{field.columns, field.rows};
  const auto of = [&](const AnalysedChain& c) {
    return markov::outcomes(c.chain.chain, cells, c.chain.start, field.max_gates);
  };
  const std::int64_t all = std::ssize(chain.groups) + 1;
  const auto tell = [&](std::int64_t done) { work.tell("what every start leads to", done, all); };
  tell(0);
  ChainOutcomes outcomes{of(chain), {}};
  for (const AnalysedChain& group : chain.groups) {
    tell(std::ssize(outcomes.groups) + 1);
    outcomes.groups.push_back(of(group));
  }
  tell(all);
  return outcomes;
}

StartStates start_states(const Problem& problem, const RunPool& pool, const AnalysedChain& chain,
                         const ChainOutcomes& outcomes, const std::vector<int>& faces, int per_leaf,
                         std::int64_t most) {
  const CellMap& map = problem.map();
  const int type = problem.start_type();
  const FieldParams& field = problem.field;
  const Eigen::Index cells = Eigen::Index{field.columns} * field.rows;
  const StateSpace& space = chain.space;
  const markov::Counts own = counts_between(space, space, map, pool, type);
  std::vector<std::int64_t> runs_of_leaf;
  for (int leaf = 0; leaf < space.size(); ++leaf) runs_of_leaf.push_back(own.row(leaf).sum());

  // With several types, the chain itself joins leaves through which few runs of a type went.
  std::int64_t least = map.types.size() == 1 ? 1 : per_leaf;
  Joined states = joined(space, runs_of_leaf, faces, least);
  while (std::ssize(states.first_leaf) > 1 && std::ssize(states.first_leaf) * cells > most) {
    least = std::max<std::int64_t>(2 * least, per_leaf);
    states = joined(space, runs_of_leaf, faces, least);
  }
  StartStates out{.of_leaf = std::move(states.of_leaf), .states = {}, .least_runs = least};
  markov::Counts join(std::ssize(states.first_leaf), space.size());
  std::vector<Eigen::Triplet<std::int64_t>> parts;
  std::vector<std::int64_t> runs(states.first_leaf.size(), 0);
  std::vector<bool> with_images(runs.size(), false);
  for (int leaf = 0; leaf < space.size(); ++leaf) {
    const int state = out.of_leaf[static_cast<std::size_t>(leaf)];
    if (state < 0) continue;
    const auto at = static_cast<std::size_t>(state);
    parts.emplace_back(state, leaf, 1);
    runs[at] += runs_of_leaf[static_cast<std::size_t>(leaf)];
    with_images[at] = with_images[at] || (map.types[static_cast<std::size_t>(type)].symmetric &&
                                          holds_mirror_images(space.section(), space.range(leaf)));
  }
  join.setFromTriplets(parts.begin(), parts.end());
  const markov::Counts rows = join * own;
  const EndTable& follows = outcomes.whole.by_output;
  const EndTable means = means_of(rows, runs, follows),
                 squares = means_of(rows, runs, follows.square());
  std::vector<EndTable> kernels;
  for (std::size_t g = 0; g < outcomes.groups.size(); ++g)
    kernels.push_back(means_of(join * counts_between(space, chain.groups[g].space, map, pool, type),
                               runs, outcomes.groups[g].by_output));
  const auto bodies = static_cast<double>(pool.bodies()),
             gate_runs = static_cast<double>(pool.gate_runs());
  const Eigen::Array<double, 1, Eigen::Dynamic> most_of_end = follows.colwise().maxCoeff();
  const double no_body = interval_of_share(0.0, bodies)[1];
  const auto interval = [&](Eigen::Index state, Eigen::Index end, double n, double no_run,
                            const MeanOfRuns& first) -> std::array<double, 2> {
    if (kernels.empty()) return {kUnknown, kUnknown};
    const double share = means(state, end);
    // Another run may go another way, and then end so: shares below one run's worth may stay
    // unseen.
    const double more = no_run * most_of_end(end);
    if (share <= kShareRounding) return {0.0, std::min(1.0, more + no_body)};
    std::vector<double> groups;
    for (const EndTable& k : kernels) groups.push_back(k(state, end));
    auto [low, high] =
        share_95(share, groups, {n, gate_runs}, first.half_width(share, squares(state, end)));
    if (share * n < 1.0) high = std::max(high, std::min(1.0, share + more));
    return {low, high};
  };
  for (int& state : out.of_leaf)  // no body entered there
    if (state >= 0 && runs[static_cast<std::size_t>(state)] == 0) state = -1;
  out.states.resize(runs.size());
  tbb::parallel_for(std::size_t{0}, runs.size(), [&](std::size_t s) {
    const auto row = static_cast<Eigen::Index>(s);
    StartState& state = out.states[s];
    state.first_leaf = states.first_leaf[s];
    state.runs = runs[s];
    if (runs[s] == 0) return;
    const double n = static_cast<double>(runs[s]) / (with_images[s] ? 2.0 : 1.0);
    const double no_run = interval_of_share(0.0, n)[1];
    const MeanOfRuns first(n);
    for (Eigen::Index e = 0; e < kEndCount; ++e) {
      state.endings.share[static_cast<std::size_t>(e)] = means(row, e);
      state.endings.interval[static_cast<std::size_t>(e)] = interval(row, e, n, no_run, first);
    }
    state.endings = state.endings.with_limit(field.max_gates);
    state.gates = markov::CellProbabilities::Zero(field.rows, field.columns);
    state.gates_95 = {state.gates, state.gates};
    for (Eigen::Index cell = 0; cell < cells; ++cell) {
      state.gates.data()[cell] = means(row, kEndCount + cell);
      const auto [low, high] = interval(row, kEndCount + cell, n, no_run, first);
      state.gates_95[0].data()[cell] = low;
      state.gates_95[1].data()[cell] = high;
    }
  });
  return out;
}

std::vector<CellAhead> cells_ahead(const ChainOutcomes& outcomes, const FieldParams& field,
                                   std::int64_t bodies, std::int64_t gate_runs) {
  constexpr double kNextToNone = 1e-9;  // visits per body
  const markov::Outcomes& whole = outcomes.whole;
  std::vector<CellAhead> ahead;
  for (Eigen::Index cell = 0; cell < whole.by_cell.rows(); ++cell) {
    const auto visits_of = [cell](const markov::Outcomes& o) { return o.next.row(cell).sum(); };
    const double visits = visits_of(whole);
    std::vector<double> of_groups;
    for (const auto& g : outcomes.groups) of_groups.push_back(visits_of(g));
    CellAhead& a = ahead.emplace_back();
    const auto n = static_cast<double>(bodies);
    a.visits = mean_95(visits, of_groups, {n, std::vector(of_groups.size(), n / kTrialGroups)});
    if (visits < kNextToNone) continue;
    if (a.visits.interval[0] < 0.0) a.visits.interval[0] = 0.0;  // NaN stays NaN
    const bool known =
        !of_groups.empty() && *std::min_element(of_groups.begin(), of_groups.end()) > 0.0;
    const Evidence from{static_cast<double>(bodies) * visits, static_cast<double>(gate_runs)};
    const auto share_of = [&](const auto& part) {
      Mean95 share{part(whole) / visits, {kUnknown, kUnknown}};
      if (!known) return share;
      std::vector<double> parts;
      for (std::size_t g = 0; g < of_groups.size(); ++g)
        parts.push_back(part(outcomes.groups[g]) / of_groups[g]);
      share.interval = share_95(share.mean, parts, from);
      return share;
    };
    for (Eigen::Index e = 0; e < kEndCount; ++e) {
      const Mean95 share = share_of([&](const markov::Outcomes& o) { return o.by_cell(cell, e); });
      a.endings.share[static_cast<std::size_t>(e)] = share.mean;
      a.endings.interval[static_cast<std::size_t>(e)] = share.interval;
    }
    a.endings = a.endings.with_limit(field.max_gates);
    a.gates = markov::CellProbabilities::Zero(field.rows, field.columns);
    for (Eigen::Index end = 0; end < a.gates.size(); ++end)
      a.gates.data()[end] = whole.by_cell(cell, kEndCount + end) / visits;
    for (Eigen::Index move = 0; move < whole.next.cols(); ++move)
      a.next.push_back(share_of([&](const markov::Outcomes& o) { return o.next(cell, move); }));
  }
  return ahead;
}

}  // namespace gatewalk::lattice
