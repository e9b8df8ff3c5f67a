// SPDX-License-Identifier: MIT
#include "lattice/study/body_memory.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "dynamics/base/random.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;

constexpr std::uint64_t kBodySigns = 0x626f6479'00000001;  // "body"

struct BodyRun {
  int state, before, outcome;
  std::int32_t body;
};

/// All runs but those of trials' first cells, by state.
std::vector<BodyRun> runs_by_state(const Problem& problem, const RunPool& pool,
                                   const StateSpace& space) {
  const FieldTrials& trials = pool.scattered.each;
  const int faces = static_cast<int>(problem.map().section.faces.size());
  std::vector<BodyRun> runs;
  for (std::size_t i = 0; i < trials.passed.size(); ++i) {
    int before = -1;
    Entry entry = pool.scattered.starts[i];
    for (const CellPassage passage : trials.of_trial(i)) {
      if (passage.fate == Fate::broken) break;
      if (before >= 0)
        runs.push_back({passage.type * space.size() + space.index_of(entry).state, before,
                        passage.fate == Fate::trapped ? faces : passage.entry.face,
                        trials.bodies[i]});
      before = entry.face;
      entry = passage.entry;
    }
  }
  std::stable_sort(runs.begin(), runs.end(),
                   [](const BodyRun& a, const BodyRun& b) { return a.state < b.state; });
  return runs;
}

}  // namespace

BodyMemory body_memory(const Problem& problem, const RunPool& pool, int per_leaf,
                       std::int64_t null_draws, std::uint64_t seed) {
  if (null_draws < 1) throw std::invalid_argument("memory of bodies: needs a draw at least");
  const Kernel kernel = kernel_of(problem.map(), pool, per_leaf);
  const std::vector<BodyRun> runs = runs_by_state(problem, pool, kernel.space);
  const auto faces = static_cast<Eigen::Index>(problem.map().section.faces.size());
  const Eigen::Index outcomes = faces + 1;
  BodyMemory found;
  found.null_draws = null_draws;
  // (faces before x outcomes, bodies): counts less expected; as drawn, with the chance that a
  // state's few runs take away by being its own mean given back.
  Eigen::MatrixXd seen = Eigen::MatrixXd::Zero(faces * outcomes, pool.bodies()), drawn = seen;
  Eigen::VectorXd runs_after = Eigen::VectorXd::Zero(faces);
  for (auto from = runs.begin(); from != runs.end();) {
    const auto to =
        std::find_if(from, runs.end(), [&](const BodyRun& r) { return r.state != from->state; });
    const auto n = static_cast<double>(to - from);
    Eigen::VectorXd before = Eigen::VectorXd::Zero(faces), out = Eigen::VectorXd::Zero(outcomes);
    for (auto r = from; r != to; ++r) {
      before[r->before] += 1.0 / n;
      out[r->outcome] += 1.0 / n;
    }
    if (before.maxCoeff() < 1.0 - 0.5 / n && out.maxCoeff() < 1.0 - 0.5 / n) {
      ++found.states;
      found.runs += to - from;
      runs_after += n * before;
      for (auto r = from; r != to; ++r)
        for (Eigen::Index b = 0; b < faces; ++b)
          for (Eigen::Index o = 0; o < outcomes; ++o) {
            const double part = ((r->before == b) - before[b]) * ((r->outcome == o) - out[o]);
            seen(b * outcomes + o, r->body) += part;
            drawn(b * outcomes + o, r->body) += part * std::sqrt(n / (n - 1.0));
          }
    }
    from = to;
  }
  const Eigen::VectorXd deviation = drawn.rowwise().norm();
  const auto statistics = [&](const Eigen::VectorXd& difference) {
    double together = 0.0, strongest = 0.0;
    Eigen::Index at = -1;
    for (Eigen::Index i = 0; i < difference.size(); ++i) {
      if (deviation[i] == 0.0) continue;
      const double size = std::abs(difference[i]) / deviation[i];
      together += size * size;
      if (at >= 0 && size <= strongest) continue;
      strongest = size;
      at = i;
    }
    return std::tuple(together, strongest, at);
  };
  std::vector<double> all;
  for (std::int64_t k = 0; k < null_draws; ++k) {
    Random random(Purpose::memory, {seed, kBodySigns, static_cast<std::uint64_t>(k)});
    Eigen::VectorXd sign(drawn.cols());
    for (double& s : sign) s = random.uniform() < 0.5 ? -1.0 : 1.0;
    const auto [together, strongest, at] = statistics(drawn * sign);
    all.insert(all.end(), {together, strongest});
  }
  const Eigen::VectorXd difference = seen.rowwise().sum();
  const auto [together, strongest, at] = statistics(difference);
  all.insert(all.end(), {together, strongest});
  const MultipleTests looked(all, 2);
  found.together = looked.tests[0];
  found.strongest = looked.tests[1];
  found.p = looked.p;
  if (at < 0) return found;
  found.face = static_cast<int>(at / outcomes);
  found.outcome = static_cast<int>(at % outcomes);
  found.more = difference[at] / runs_after[found.face];
  return found;
}

}  // namespace gatewalk::lattice
