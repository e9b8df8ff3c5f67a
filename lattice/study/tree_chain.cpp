#include "lattice/study/tree_chain.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>

#include "lattice/compare.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;

std::vector<std::vector<std::int64_t>> own_rows(const Scene& scene, const RunPool& pool,
                                                const StateSpace& space) {
  std::vector<std::vector<std::int64_t>> rows;
  for (const StartTrials& s : pool.starts) rows.push_back(first_row(scene.gate, space, s));
  return rows;
}

/// What walks from the starts end with, or from anywhere in the range where there are none.
std::vector<markov::FinalDistribution> answers(const Scene& scene, const RunPool& pool,
                                               const Kernel& kernel) {
  auto rows = own_rows(scene, pool, kernel.space);
  if (rows.empty()) rows.push_back(first_row(scene.gate, kernel.space, pool.scattered));
  std::vector<markov::Start> places;
  for (std::size_t i = 0; i < rows.size(); ++i)
    places.push_back({scene.field.start_column(), 0, kernel.space.size() + static_cast<int>(i)});
  return markov::predict(chain_of(kernel, rows), {scene.field.columns, scene.field.rows}, places,
                         {.max_cells = scene.field.max_gates});
}

/// Larger leaves, until there are no more states than that.
void limit_states(TreeChain& chain, const Scene& scene, int most) {
  if (most < kBoundaries)
    throw std::invalid_argument("a chain has " + std::to_string(kBoundaries) +
                                " states at least, one for each way to enter a gate; " +
                                std::to_string(most) + " are too few");
  const Kernel full = chain.kernel;
  while (chain.kernel.space.size() > most) {
    const double times = static_cast<double>(chain.kernel.space.size()) / most;
    chain.per_leaf = std::max(chain.per_leaf + 1,
                              static_cast<int>(std::ceil(chain.per_leaf * std::sqrt(times))));
    chain.kernel = kernel_of(scene.gate, chain.pool, chain.per_leaf);
  }
  if (chain.kernel.space.size() == full.space.size()) return;
  const auto before = answers(scene, chain.pool, full),
             after = answers(scene, chain.pool, chain.kernel);
  for (std::size_t i = 0; i < before.size(); ++i)
    chain.states_bias =
        std::max(chain.states_bias, total_variation(before[i].final_cells, after[i].final_cells));
}

Transitions transitions_with(const Scene& scene, const RunPool& pool, const Kernel& kernel) {
  std::vector<Crossing> starts;
  for (const StartTrials& s : pool.starts) starts.push_back(s.start);
  return transitions_of(kernel, starts, own_rows(scene, pool, kernel.space));
}

}  // namespace

TreeChain make_tree_chain(const Scene& scene, const TreeOptions& options, const Work& work) {
  if (options.starts.empty() && !options.range)
    throw std::invalid_argument("a chain needs a start, or a range of starts");
  RunPool pool;
  std::optional<PooledRange> range;
  std::optional<PooledPrediction> prediction;
  if (options.range) {
    AccuracyOptions part = options.accuracy;
    part.accuracy *= 1.2 * kPartForOne;
    range = pool_range(scene, pool, *options.range, part, work);
  }
  if (!options.starts.empty())
    prediction = predict_pooled(scene, pool, options.starts, options.accuracy, work);
  Kernel kernel = kernel_of(scene.gate, pool, options.accuracy.per_leaf);
  TreeChain chain{.pool = std::move(pool),
                  .kernel = kernel,
                  .transitions = Transitions(kernel.space),
                  .per_leaf = options.accuracy.per_leaf,
                  .prediction = std::move(prediction),
                  .range = std::move(range)};
  if (options.most_states) limit_states(chain, scene, *options.most_states);
  chain.transitions = transitions_with(scene, chain.pool, chain.kernel);
  if (chain.range) chain.transitions.health += chain.range->health;
  if (chain.prediction) chain.transitions.health += chain.prediction->health;
  return chain;
}

// ---- Runs in a file ----

namespace {

struct RunArray {
  const char *name, *unit, *meaning;
};
constexpr RunArray kTrialRuns{"trial_runs", "1",
                              "gate runs of each trial, one after the other in run_*"},
    kTrialD{"trial_d", "m", "where each trial started, on the lower edge of a gate"},
    kTrialVx{"trial_vx", "m s-1", "lateral velocity there"},
    kTrialVy{"trial_vy", "m s-1", "forward velocity there"},
    kRunEnding{"run_ending", "1",
               "how each gate run ended: 0 traversed, 1 exited left, 2 exited right, 3 trapped"},
    kRunBoundary{"run_boundary", "1",
                 "how it entered the next gate: 0 EN, 1 RD, 2 LD, 3 RT, 4 LT (trapped: 0)"},
    kRunD{"run_d", "m", "where on that boundary (trapped: 0)"},
    kRunVx{"run_vx", "m s-1", "lateral velocity there (trapped: 0)"},
    kRunVy{"run_vy", "m s-1", "forward velocity there (trapped: 0)"};

/// Appends trials to the tables.
struct RunTables {
  std::vector<double> trial_runs, trial_d, trial_vx, trial_vy;
  std::vector<double> ending, boundary, d, vx, vy;

  void add(const Crossing& start, std::span<const GatePassage> passages) {
    trial_runs.push_back(static_cast<double>(passages.size()));
    trial_d.push_back(start.d);
    trial_vx.push_back(start.vx);
    trial_vy.push_back(start.vy);
    for (const GatePassage& p : passages) {
      ending.push_back(static_cast<double>(p.ending));
      boundary.push_back(static_cast<double>(p.entry.boundary));
      d.push_back(p.entry.d);
      vx.push_back(p.entry.vx);
      vy.push_back(p.entry.vy);
    }
  }
};

}  // namespace

std::vector<markov::NamedArray> arrays_of(const RunPool& pool) {
  RunTables t;
  for (const StartTrials& s : pool.starts)
    for (const FieldTrials* trials : {&s.full, &s.first})
      for (std::size_t i = 0; i < trials->final_gates.size(); ++i)
        t.add(s.start, trials->of_trial(i));
  for (std::size_t i = 0; i < pool.scattered.starts.size(); ++i)
    t.add(pool.scattered.starts[i], pool.scattered.each.of_trial(i));
  std::vector<markov::NamedArray> arrays;
  const auto add = [&](const RunArray& array, std::vector<double>& values) {
    arrays.push_back({array.name, array.unit, array.meaning, std::move(values)});
  };
  add(kTrialRuns, t.trial_runs);
  add(kTrialD, t.trial_d);
  add(kTrialVx, t.trial_vx);
  add(kTrialVy, t.trial_vy);
  add(kRunEnding, t.ending);
  add(kRunBoundary, t.boundary);
  add(kRunD, t.d);
  add(kRunVx, t.vx);
  add(kRunVy, t.vy);
  return arrays;
}

bool has_runs(const MatrixFile& file) {
  return std::any_of(file.arrays.begin(), file.arrays.end(),
                     [](const markov::NamedArray& a) { return a.name == kTrialRuns.name; });
}

RunPool pool_of(const MatrixFile& file, const std::string& path) {
  const auto table = [&](const RunArray& array) -> const std::vector<double>& {
    for (const markov::NamedArray& a : file.arrays)
      if (a.name == array.name) return a.values;
    throw markov::BadFile(path + ": no table " + array.name);
  };
  const auto &runs = table(kTrialRuns), &trial_d = table(kTrialD), &trial_vx = table(kTrialVx),
             &trial_vy = table(kTrialVy);
  const auto &ending = table(kRunEnding), &boundary = table(kRunBoundary), &d = table(kRunD),
             &vx = table(kRunVx), &vy = table(kRunVy);
  const auto refuse = [&](const std::string& what) {
    throw markov::BadFile(path + ": its gate runs do not add up: " + what);
  };
  const auto whole_in = [](double x, int end) { return x >= 0.0 && x < end && x == std::floor(x); };
  for (const auto* t : {&trial_d, &trial_vx, &trial_vy})
    if (t->size() != runs.size()) refuse("trials");
  for (const auto* t : {&boundary, &d, &vx, &vy})
    if (t->size() != ending.size()) refuse("runs");

  RunPool pool;
  for (const Crossing& start : file.transitions.space.points()) {
    StartTrials& s = pool.starts.emplace_back();
    s.start = start;
    s.knows_endings = false;
  }
  std::size_t at = 0;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const Crossing start{Boundary::enter, trial_d[i], trial_vx[i], trial_vy[i]};
    const auto own = std::find_if(pool.starts.begin(), pool.starts.end(),
                                  [&](const StartTrials& s) { return s.start == start; });
    if (own == pool.starts.end()) pool.scattered.starts.push_back(start);
    FieldTrials& trials = own == pool.starts.end() ? pool.scattered.each : own->full;
    if (!(runs[i] >= 1.0 && runs[i] <= static_cast<double>(ending.size() - at)))
      refuse("trial " + std::to_string(i + 1));
    for (const std::size_t end = at + static_cast<std::size_t>(runs[i]); at < end; ++at) {
      if (!whole_in(ending[at], 4) || !whole_in(boundary[at], kBoundaries))
        refuse("run " + std::to_string(at + 1));
      trials.passages.push_back({static_cast<Ending>(ending[at]),
                                 {static_cast<Boundary>(boundary[at]), d[at], vx[at], vy[at]}});
    }
    trials.passed.push_back(std::ssize(trials.passages));
    trials.final_gates.push_back(0);
    trials.endings.push_back({});
  }
  if (at != ending.size()) refuse("runs of no trial");
  return pool;
}

Transitions matrix_of(const Scene& scene, const RunPool& pool, const std::vector<BodyState>& starts,
                      int per_leaf) {
  const Kernel kernel = kernel_of(scene.gate, pool, per_leaf);
  std::vector<Crossing> points;
  std::vector<std::vector<std::int64_t>> rows;
  for (const BodyState& b : starts) {
    const Crossing entry{Boundary::enter, b.x, b.vx, b.vy};
    if (std::find(points.begin(), points.end(), entry) != points.end()) continue;
    const auto own = std::find_if(pool.starts.begin(), pool.starts.end(),
                                  [&](const StartTrials& s) { return s.start == entry; });
    if (own == pool.starts.end())
      throw std::invalid_argument("matrix: a start has no runs of its own");
    points.push_back(entry);
    rows.push_back(first_row(scene.gate, kernel.space, *own));
  }
  return transitions_of(kernel, points, rows);
}

}  // namespace gatewalk::lattice
