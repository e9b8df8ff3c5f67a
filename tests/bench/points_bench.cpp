// SPDX-License-Identifier: MIT
/// How much chance is left where noise is laid by points (lattice/field/rqmc_trials.h), and what
/// that costs:
///   points_bench SCENE [KEY=VALUE ...]
/// prints lines "what,trials,replicates,plain,points": variances over replicates, plain and with
/// points, each as the square of the sum of standard deviations (total variation squared, but for a
/// factor); and microseconds of a gate run on one thread, the least of several.
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "lattice/field/rqmc_trials.h"
#include "lattice/pool/pool_runner.h"
#include "lattice/pool/pooled_prediction.h"
#include "lattice/pool/predict_pooled.h"
#include "lattice/scene/scene_problem.h"

namespace {

using namespace gatewalk;
using namespace gatewalk::lattice;

/// The numbers of one replicate.
using Numbers = std::vector<double>;

double variance(const std::vector<Numbers>& replicates) {
  const auto n = static_cast<double>(replicates.size());
  double sum = 0.0;
  for (std::size_t k = 0; k < replicates.front().size(); ++k) {
    double mean = 0.0, squares = 0.0;
    for (const Numbers& r : replicates) mean += r[k] / n;
    for (const Numbers& r : replicates) squares += (r[k] - mean) * (r[k] - mean) / (n - 1.0);
    sum += std::sqrt(squares);
  }
  return sum * sum;
}

Numbers numbers_of(const markov::CellProbabilities& p) { return {p.data(), p.data() + p.size()}; }

/// Trials without points, from the start.
OwnRuns plain_trials(const Problem& problem, const FieldParams& field, std::int64_t count,
                     std::uint64_t seed) {
  OwnRuns s;
  s.start = problem.start;
  (void)run_field(problem.cells, field, problem.start, seed, {0, count}, &s.full);
  return s;
}

/// Shares of the first gate's exits, each split into eight: below and above the medians of where
/// and how fast bodies leave.
class FirstGate {
 public:
  explicit FirstGate(const Problem& problem) : problem_(problem), field_(problem.field) {
    field_.max_gates = 1;
    const OwnRuns pilot = plain_trials(problem, field_, 20'000, 77);
    std::map<int, std::vector<dynamics::Entry>> by_face;
    for (const CellPassage p : pilot.full.passages.rows())
      if (p.fate == dynamics::Fate::left) by_face[p.entry.face].push_back(p.entry);
    for (auto& [face, entries] : by_face)
      for (std::size_t axis = 0; axis < kAxes; ++axis) {
        const auto middle = entries.begin() + std::ssize(entries) / 2;
        std::nth_element(entries.begin(), middle, entries.end(),
                         [&](const auto& a, const auto& b) { return a.at[axis] < b.at[axis]; });
        medians_[face].at[axis] = middle->at[axis];
      }
  }
  [[nodiscard]] Numbers shares(const FieldTrials& trials) const {
    Numbers all(8 * dynamics::kMostFaces + 1);
    for (std::size_t i = 0; i < trials.final_gates.size(); ++i) {
      const CellPassage p = trials.of_trial(i).front();
      std::size_t place = 8 * dynamics::kMostFaces;
      if (p.fate == dynamics::Fate::left) {
        place = 8 * static_cast<std::size_t>(p.entry.face);
        const auto median = medians_.find(p.entry.face);
        for (std::size_t axis = 0; axis < kAxes && median != medians_.end(); ++axis)
          place += static_cast<std::size_t>(p.entry.at[axis] > median->second.at[axis]) << axis;
      }
      all[place] += 1.0 / static_cast<double>(trials.final_gates.size());
    }
    return all;
  }
  [[nodiscard]] const FieldParams& field() const { return field_; }

 private:
  static constexpr std::size_t kAxes = 3;
  const Problem& problem_;
  FieldParams field_;
  std::map<int, dynamics::Entry> medians_;
};

OwnRuns runner_trials(const Problem& problem, bool first, std::int64_t count, std::uint64_t seed) {
  const dynamics::Work work;
  OwnRuns s;
  s.start = problem.start;
  PoolRunner runner(problem, seed, std::numeric_limits<std::int64_t>::max(), work);
  if (first)
    runner.run_first(s, count);
  else
    runner.run_full(s, count);
  return s;
}

void print(const char* what, std::int64_t trials, int replicates, double plain, double points) {
  std::printf("%s,%lld,%d,%.4g,%.4g\n", what, static_cast<long long>(trials), replicates, plain,
              points);
  std::fflush(stdout);
}

void first_gate(const Problem& problem, std::int64_t trials, int replicates) {
  const FirstGate gate(problem);
  std::vector<Numbers> plain, points;
  for (int r = 0; r < replicates; ++r) {
    const auto seed = static_cast<std::uint64_t>(1000 + r);
    plain.push_back(gate.shares(plain_trials(problem, gate.field(), trials, seed).full));
    points.push_back(gate.shares(runner_trials(problem, true, trials, seed).first));
  }
  print("first gate", trials, replicates, variance(plain), variance(points));
}

void field(const Problem& problem, std::int64_t trials, int replicates) {
  std::vector<Numbers> direct[2], chain[2];
  for (int r = 0; r < replicates; ++r)
    for (const int with : {0, 1}) {
      const auto seed = static_cast<std::uint64_t>(1000 + r);
      RunPool pool;
      pool.starts.push_back(with == 0 ? plain_trials(problem, problem.field, trials, seed)
                                      : runner_trials(problem, false, trials, seed));
      direct[with].push_back(
          numbers_of(shares_of(pool.starts.front().full, problem.field).final_cells));
      chain[with].push_back(
          numbers_of(predict_whole(problem, pool, {problem.start}, dynamics::kEntriesPerLeaf, 1)
                         .front()
                         .final_cells));
    }
  print("final gates of trials", trials, replicates, variance(direct[0]), variance(direct[1]));
  print("final gates of the chain", trials, replicates, variance(chain[0]), variance(chain[1]));
}

/// Measures the cost of plain runs and of runs with points in turn.
void cost(const Problem& problem, bool first, std::int64_t trials) {
  constexpr int kTimes = 5;
  FieldParams field = problem.field;
  if (first) field.max_gates = 1;
  double least[2] = {std::numeric_limits<double>::max(), std::numeric_limits<double>::max()};
  for (int r = 0; r < kTimes; ++r)
    for (const int with : {0, 1}) {
      const auto seed = static_cast<std::uint64_t>(1000 + r);
      const dynamics::Stopwatch watch;
      const OwnRuns s = with == 0 ? plain_trials(problem, field, trials, seed)
                                  : runner_trials(problem, first, trials, seed);
      least[with] =
          std::min(least[with], 1e6 * watch.seconds() / static_cast<double>(s.gate_runs()));
    }
  print(first ? "us of a first run" : "us of a gate run", trials, kTimes, least[0], least[1]);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return 2;
  const tbb::global_control allow(tbb::global_control::max_allowed_parallelism, 1);
  const Scene scene = read_scene(argv[1], std::vector<std::string>(argv + 2, argv + argc));
  const Problem problem = problem_of(scene);
  for (const std::int64_t trials : {512, 2048, 8192}) first_gate(problem, trials, 32);
  for (const std::int64_t trials : {4096, 16384}) field(problem, trials, 16);
  cost(problem, true, 16384);
  cost(problem, false, 16384);
}
