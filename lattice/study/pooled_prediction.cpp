#include "lattice/study/pooled_prediction.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "dynamics/share.h"
#include "lattice/scene/settle.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;
using markov::FinalDistribution;

// Numbers of first trials, so that no other command runs these: full ones, those through one gate,
// scattered ones.
constexpr std::int64_t kFullOwn = std::int64_t{1} << 41, kFirstOwn = std::int64_t{1} << 42,
                       kScatteredOwn = std::int64_t{1} << 43;
constexpr std::int64_t kLeastTrials = 2 * kTrialGroups;  // per start
constexpr std::int64_t kFirstRound = 20 * kTrialGroups;  // trials of all starts together
constexpr std::int64_t kLeastFirstRuns = 500;            // of a start that meets a pool

Crossing entry_of(const BodyState& b) { return {Boundary::enter, b.x, b.vx, b.vy}; }

BodyState body_of(const Crossing& c) { return {c.d, 0.0, c.vx, c.vy}; }

void require_fine(const AccuracyOptions& options) {
  if (!(options.accuracy > 0.0 && options.accuracy < 1.0))
    throw std::invalid_argument("accuracy " + std::to_string(options.accuracy) +
                                " is not permitted: must lie in (0, 1)");
}

/// Multiplications that exact predictions take, of one start, about.
double exact_cost(std::int64_t nonzeros, const FieldParams& field) {
  constexpr double kStepsWithoutLimit = 50.0;
  const double cells = static_cast<double>(field.columns) * field.rows;
  const double steps = field.max_gates;
  return static_cast<double>(nonzeros) * (field.max_gates == 0
                                              ? cells * kStepsWithoutLimit
                                              : std::min(cells, 2.0 * steps * steps) * steps / 2.0);
}

/// What walks say, as a prediction. Over which edge bodies left from a corner cell is not known:
/// they count as having crossed there.
FinalDistribution shares_of(const markov::WalkTally& tally) {
  const auto n = static_cast<double>(tally.walks);
  FinalDistribution d;
  d.final_cells = tally.final_cells.cast<double>() / n;
  for (std::size_t e = 0; e < markov::kEndings; ++e)
    d.endings[e] = static_cast<double>(tally.endings[e]) / n;
  d.trapped = static_cast<double>(tally.trapped) / n;
  d.left_field = static_cast<double>(tally.left_field) / n;
  d.cut_off = static_cast<double>(tally.cut_off) / n;
  d.unsampled = static_cast<double>(tally.unsampled) / n;
  d.mean_steps = static_cast<double>(tally.steps) / n;
  const Eigen::Index columns = tally.final_cells.cols(), rows = tally.final_cells.rows();
  for (Eigen::Index i = 0; i < tally.final_cells.size(); ++i) {
    const auto share = [&](std::int64_t count) { return static_cast<double>(count) / n; };
    const std::int64_t trapped = tally.trapped_cells.data()[i],
                       departed = tally.departed_cells.data()[i], all = tally.final_cells.data()[i];
    if (trapped == all) continue;
    const markov::Ending edge = i / columns == rows - 1 ? markov::Ending::far_edge
                                : i % columns == 0      ? markov::Ending::left_edge
                                                        : markov::Ending::right_edge;
    markov::CellEndings cell{i};
    cell.by_ending[static_cast<std::size_t>(markov::Ending::trapped)] = share(trapped);
    cell.by_ending[static_cast<std::size_t>(edge)] = share(departed);
    cell.by_ending[static_cast<std::size_t>(markov::Ending::cut_off)] =
        share(all - trapped - departed);
    d.mixed_cells.push_back(cell);
  }
  return d;
}

/// Predictions from the start rows that stand behind a kernel's: exact, or by `walks` where there
/// are any.
std::vector<FinalDistribution> predictions(const Kernel& kernel,
                                           const std::vector<std::vector<std::int64_t>>& first_rows,
                                           const FieldParams& field, markov::WalkRange walks,
                                           std::uint64_t seed) {
  std::vector<markov::Start> places;
  for (std::size_t i = 0; i < first_rows.size(); ++i)
    places.push_back({field.start_column(), 0, kernel.space.size() + static_cast<int>(i)});
  const markov::Field cells{field.columns, field.rows};
  const markov::Chain chain = chain_of(kernel, first_rows);
  if (walks.count == 0)
    return markov::predict(chain, cells, places, {.max_cells = field.max_gates});
  const markov::Walker walker(chain);
  std::vector<FinalDistribution> all;
  for (const markov::Start& start : places)
    all.push_back(shares_of(walker.walk(cells, start, field.max_gates, seed, walks)));
  return all;
}

/// What the pool says of some of its starts.
struct Said {
  std::vector<FinalDistribution> whole;                // (starts)
  std::vector<std::vector<FinalDistribution>> groups;  // (starts x kTrialGroups)
  /// The same with the first runs of all trials in every group: what the kernel alone makes. Empty
  /// if not asked for.
  std::vector<std::vector<FinalDistribution>> kernels{};
  int states = 0;
  std::int64_t nonzeros = 0;
  std::int64_t walks = 0;  // behind each of `whole`; 0: they are exact
};

/// The kernels of a pool and of its groups; they stay while only first runs are added.
class Kernels {
 public:
  void renew(const Scene& scene, const RunPool& pool, int per_leaf) {
    std::int64_t runs = std::ssize(pool.scattered.each.passages);
    for (const StartTrials& s : pool.starts) runs += std::ssize(s.full.passages);
    if (std::exchange(runs_, runs) == runs) return;
    tbb::parallel_for(-1, kTrialGroups, [&](int g) {
      const TrialGroup group = g < 0 ? TrialGroup{} : TrialGroup{g, kTrialGroups};
      kernels_[static_cast<std::size_t>(g + 1)] = kernel_of(scene.gate, pool, per_leaf, group);
    });
  }
  [[nodiscard]] const Kernel& whole() const { return *kernels_.front(); }
  [[nodiscard]] const Kernel& of_group(int g) const {
    return *kernels_[static_cast<std::size_t>(g + 1)];
  }

 private:
  std::int64_t runs_ = -1;
  std::array<std::optional<Kernel>, kTrialGroups + 1> kernels_;
};

Said ask(const Scene& scene, const RunPool& pool, Kernels& kernels,
         const std::vector<std::size_t>& starts, const AccuracyOptions& options,
         bool with_kernels) {
  // Where exact predictions take longer, walks do: so many, of a group a part of them.
  constexpr double kMostExact = 1e9;
  constexpr std::int64_t kWalks = std::int64_t{1} << 22, kWalksOfGroup = std::int64_t{1} << 18;
  const std::size_t n = starts.size();
  Said said{.whole = {}, .groups = {n, std::vector<FinalDistribution>(kTrialGroups)}};
  if (with_kernels) said.kernels = said.groups;
  const auto rows = [&](const StateSpace& space, TrialGroup group) {
    std::vector<std::vector<std::int64_t>> all;
    for (const std::size_t s : starts)
      all.push_back(first_row(scene.gate, space, pool.starts[s], group));
    return all;
  };
  const bool by_walks =
      exact_cost(2 * pool.gate_runs(), scene.field) > kMostExact;  // some nonzeros a run
  kernels.renew(scene, pool, options.per_leaf);
  tbb::parallel_for(-1, kTrialGroups, [&](int g) {
    if (g < 0) {
      const Kernel& kernel = kernels.whole();
      said.walks = by_walks ? kWalks : 0;
      said.whole =
          predictions(kernel, rows(kernel.space, {}), scene.field, {0, said.walks}, options.seed);
      said.states = kernel.space.size();
      said.nonzeros = kernel.counts.nonZeros();
      return;
    }
    const TrialGroup group{g, kTrialGroups};
    const Kernel& kernel = kernels.of_group(g);
    auto first = rows(kernel.space, group);
    if (with_kernels) {
      auto all = rows(kernel.space, {});
      first.insert(first.end(), all.begin(), all.end());
    }
    const markov::WalkRange walks{kWalks + g * kWalksOfGroup, by_walks ? kWalksOfGroup : 0};
    auto found = predictions(kernel, first, scene.field, walks, options.seed);
    for (std::size_t i = 0; i < n; ++i) {
      said.groups[i][static_cast<std::size_t>(g)] = std::move(found[i]);
      if (with_kernels) said.kernels[i][static_cast<std::size_t>(g)] = std::move(found[n + i]);
    }
  });
  return said;
}

/// Runs trials into a pool and keeps count.
class Runner {
 public:
  Runner(const Scene& scene, const AccuracyOptions& options, const Work& work)
      : scene_(scene),
        field_(scene.field),
        space_(StateSpace::paper(scene.gate)),
        options_(options),
        work_(work) {
    field_.fidelity = Fidelity::active;
  }

  void run_full(StartTrials& s, std::int64_t count) {
    const std::int64_t done = std::ssize(s.full.final_gates);
    run("full trials", count, [&](TrialRange range) {
      return run_field(scene_.gate, field_, body_of(s.start), space_, options_.seed,
                       {kFullOwn + done + range.first, range.count}, &s.full);
    });
  }
  void run_first(StartTrials& s, std::int64_t count) {
    FieldParams one_gate = field_;
    one_gate.max_gates = 1;
    const std::int64_t done = std::ssize(s.first.final_gates);
    run("first runs", count, [&](TrialRange range) {
      return run_field(scene_.gate, one_gate, body_of(s.start), space_, options_.seed,
                       {kFirstOwn + done + range.first, range.count}, &s.first);
    });
  }
  void run_scattered(ScatteredTrials& s, const StartRange& starts, std::int64_t count) {
    const std::int64_t done = std::ssize(s.starts);
    run("scattered trials", count, [&](TrialRange range) {
      std::vector<BodyState> bodies;
      for (std::int64_t i = 0; i < range.count; ++i) {
        bodies.push_back(drawn(starts, done + range.first + i));
        s.starts.push_back(entry_of(bodies.back()));
      }
      return run_field(scene_.gate, field_, bodies, space_, options_.seed,
                       {kScatteredOwn + done + range.first, range.count}, &s.each);
    });
  }
  /// Start number `i` in the range.
  [[nodiscard]] BodyState drawn(const StartRange& starts, std::int64_t i) const {
    Random random(Purpose::resampling, {options_.seed, static_cast<std::uint64_t>(kScatteredOwn),
                                        static_cast<std::uint64_t>(i)});
    const auto within = [&](const std::array<double, 2>& r) {
      return r[0] + (r[1] - r[0]) * random.uniform();
    };
    BodyState b;
    b.x = within(starts.d);
    b.vx = within(starts.vx);
    b.vy = within(starts.vy);
    return b;
  }

  [[nodiscard]] bool may_go_on() const { return gate_runs < options_.most_runs; }
  /// Gate runs of a full trial, in the mean of those so far.
  [[nodiscard]] double gates_per_trial() const {
    return trials_ > 0 ? static_cast<double>(trial_runs_) / static_cast<double>(trials_) : 1.0;
  }
  [[nodiscard]] double seconds_per_gate_run() const {
    return seconds / static_cast<double>(std::max<std::int64_t>(1, gate_runs));
  }
  /// Checks a sample by a better method.
  void finish() {
    if (gate_runs > 0)
      check_outcomes(scene_, RunsFrom::everywhere, options_.seed, std::max(trials_, gate_runs / 10),
                     health, work_);
  }

  std::int64_t gate_runs = 0;
  double seconds = 0.0;
  Health health;

 private:
  void run(const char* what, std::int64_t count,
           const std::function<FieldTally(TrialRange)>& carry_out) {
    const Stopwatch watch;
    const auto most = static_cast<double>(options_.most_runs - gate_runs);
    count = std::max<std::int64_t>(
        kLeastTrials, static_cast<std::int64_t>(
                          std::min(static_cast<double>(count), most / gates_per_trial() + 1.0)));
    work_.in_pieces(what, count, [&](TrialRange range) {
      const FieldTally tally = carry_out(range);
      health += tally.health;
      gate_runs += tally.health.runs;
      trials_ += tally.trials;
      trial_runs_ += tally.health.runs;
    });
    seconds += watch.seconds();
    if (health.broken > 0)
      throw std::runtime_error("prediction: " + std::to_string(health.broken) +
                               " gate runs stopped being finite numbers; try method stable or a "
                               "smaller run.step_s");
  }

  const Scene& scene_;
  FieldParams field_;
  StateSpace space_;
  const AccuracyOptions& options_;
  const Work& work_;
  std::int64_t trials_ = 0, trial_runs_ = 0;
};

/// Total variation that so many walks keep from what endlessly many would give, 95 times in 100.
double chance_of_walks(const FinalDistribution& d, std::int64_t walks) {
  constexpr double kToQuantile = 1.3;
  return walks == 0 ? 0.0 : kToQuantile * expected_total_variation(d.final_cells, walks);
}

/// Error bars of one start; `chance` is that of the walks behind `whole`.
StartAnswer answer_of(const Scene& scene, const StartTrials& s, FinalDistribution whole,
                      double chance, const std::vector<FinalDistribution>& groups,
                      const std::vector<FinalDistribution>& kernels, std::uint64_t seed) {
  StartAnswer a;
  a.start = s.start;
  a.trials = s.knows_endings ? std::ssize(s.full.final_gates) : 0;
  a.first_runs = s.first_runs();
  const GroupSpread spread(whole, groups);
  const std::int64_t behind = a.trials > 0 ? a.trials : a.first_runs;
  a.error = spread.error(behind, seed);
  a.error.total_variation = std::hypot(a.error.total_variation, chance);
  a.kernel_error_95 = kernels.empty()
                          ? a.error.total_variation
                          : GroupSpread(whole, kernels).error(behind, seed).total_variation;
  Error95 of_trials{1.0, 0.0, 100.0};
  if (a.trials > 0) {
    CellCounts counts = CellCounts::Zero(scene.field.rows, scene.field.columns);
    for (const std::int32_t cell : s.full.final_gates) ++counts.data()[cell];
    of_trials = error_of_shares(counts, seed);
    a.trials_error_95 = of_trials.total_variation;
    a.from_trials = a.trials_error_95 < 0.95 * a.error.total_variation;
  }
  if (!a.from_trials) {
    a.endings = spread.endings_95(behind);
    a.gates_95 = spread.gates_95(behind);
    a.final = std::move(whole);
    return a;
  }
  a.error = of_trials;
  a.final = shares_of(s.full, scene.field);
  std::array<std::int64_t, markov::kEndings> endings{};
  for (const auto& e : s.full.endings)
    if (e) ++endings[static_cast<std::size_t>(*e)];
  a.endings = EndingShares(endings, a.trials);
  a.gates_95 = {a.final.final_cells, a.final.final_cells};
  for (Eigen::Index i = 0; i < a.final.final_cells.size(); ++i) {
    const auto interval =
        interval_of_share(a.final.final_cells.data()[i], static_cast<double>(a.trials));
    for (std::size_t side = 0; side < 2; ++side) a.gates_95[side].data()[i] = interval[side];
  }
  return a;
}

/// So many times the trials make the square of the error as small as is wanted. A long way is gone
/// in two steps: the error is known the better the nearer it is.
double times_more(double error, double wanted) {
  const double times = (error / wanted) * (error / wanted);
  return times > 2.5 ? std::min(0.6 * times, 16.0) : std::max(1.1 * times, 1.2);
}

/// Adds trials of a start whose answer is not certain enough: first runs where these make most of
/// the error, else full ones.
void add_trials_of(StartTrials& s, const StartAnswer& a, double accuracy, Runner& runner) {
  const double error = a.error.total_variation, kernel = a.kernel_error_95;
  const double first = std::sqrt(std::max(0.0, error * error - kernel * kernel));
  if (kernel < 0.85 * accuracy && first > 1.2 * kernel) {
    const double left = std::sqrt(accuracy * accuracy - kernel * kernel);
    const auto n = static_cast<double>(a.first_runs);
    runner.run_first(s, static_cast<std::int64_t>(n * (times_more(first, left) - 1.0)));
    return;
  }
  const auto n =
      static_cast<double>(std::max<std::int64_t>(std::ssize(s.full.final_gates), kFirstRound / 2));
  runner.run_full(s, static_cast<std::int64_t>(n * (times_more(error, accuracy) - 1.0)));
}

/// What direct simulation would take for the same error bar, by this run's speed.
double direct_seconds(const StartAnswer& a, const Runner& runner, std::uint64_t seed) {
  if (runner.gate_runs == 0) return std::nan("");
  constexpr std::int64_t kTrials = 10'000;
  const CellCounts drawn = sampled(a.final.final_cells, kTrials, seed, 0);
  const double times = error_of_shares(drawn, seed).total_variation / a.error.total_variation;
  return times * times * static_cast<double>(kTrials) * a.final.mean_steps *
         runner.seconds_per_gate_run();
}

/// Places of the starts in the pool, put there if need be; each has some trials.
std::vector<std::size_t> places_of(const std::vector<BodyState>& starts, RunPool& pool,
                                   std::optional<std::int64_t> first_runs, Runner& runner) {
  const bool has_kernel = pool.gate_runs() > 0;
  std::vector<std::size_t> places;
  for (const BodyState& body : starts) {
    if (body.y != 0.0)
      throw std::invalid_argument(
          "start.y_m = " + std::to_string(body.y) +
          " is not permitted for a chain: its states are entries from below, start.y_m must be 0");
    const Crossing entry = entry_of(body);
    places.push_back(pool.place_of(entry));
    if (places.back() < pool.starts.size()) continue;
    StartTrials& s = pool.starts.emplace_back();
    s.start = entry;
    if (has_kernel)
      runner.run_first(s, first_runs.value_or(kLeastFirstRuns));
    else
      runner.run_full(s, std::max(kLeastTrials, kFirstRound / std::ssize(starts)));
  }
  return places;
}

}  // namespace

FinalDistribution shares_of(const FieldTrials& trials, const FieldParams& field) {
  const auto n = static_cast<double>(trials.final_gates.size());
  FinalDistribution d;
  d.final_cells = CellProbabilities::Zero(field.rows, field.columns);
  std::map<std::int64_t, markov::CellEndings> mixed;
  for (std::size_t i = 0; i < trials.final_gates.size(); ++i) {
    const std::int32_t cell = trials.final_gates[i];
    const auto ending = static_cast<std::size_t>(trials.endings[i].value());
    d.final_cells.data()[cell] += 1.0 / n;
    d.endings[ending] += 1.0 / n;
    auto& of_cell = mixed.try_emplace(cell, markov::CellEndings{cell}).first->second;
    of_cell.by_ending[ending] += 1.0 / n;
  }
  for (const auto& [cell, endings] : mixed)
    if (endings.by_ending.front() < d.final_cells.data()[cell]) d.mixed_cells.push_back(endings);
  d.trapped = d.endings[static_cast<std::size_t>(markov::Ending::trapped)];
  d.cut_off = d.endings[static_cast<std::size_t>(markov::Ending::cut_off)];
  for (const markov::Ending edge : markov::kEdges)
    d.left_field += d.endings[static_cast<std::size_t>(edge)];
  d.mean_steps = static_cast<double>(trials.passages.size()) / n;
  return d;
}

PooledPrediction predict_pooled(const Scene& scene, RunPool& pool,
                                const std::vector<BodyState>& starts,
                                const AccuracyOptions& options, const Work& work) {
  require_fine(options);
  const Stopwatch watch;
  Runner runner(scene, options, work);
  PooledPrediction result;
  const bool has_others = pool.gate_runs() > 0;
  const std::vector<std::size_t> places = places_of(starts, pool, options.first_runs, runner);
  result.starts.resize(starts.size());
  std::vector<std::size_t> open(starts.size());  // those that are not certain enough yet
  std::iota(open.begin(), open.end(), 0);
  Kernels kernels;
  while (!open.empty()) {
    std::vector<std::size_t> asked;
    for (const std::size_t k : open) asked.push_back(places[k]);
    // A single start's full trials make both its row and the kernel, in good proportion.
    const bool with_kernels = starts.size() > 1 || has_others;
    Said said = ask(scene, pool, kernels, asked, options, with_kernels);
    result.states = said.states;
    result.nonzeros = said.nonzeros;
    std::vector<std::size_t> left;
    bool chance_is_too_much = false;  // of walks: more trials would not help
    for (std::size_t i = 0; i < open.size(); ++i) {
      const std::size_t k = open[i];
      const double chance = chance_of_walks(said.whole[i], said.walks);
      chance_is_too_much = chance_is_too_much || chance >= options.accuracy;
      result.starts[k] = answer_of(
          scene, pool.starts[places[k]], std::move(said.whole[i]), chance, said.groups[i],
          with_kernels ? said.kernels[i] : std::vector<FinalDistribution>{}, options.seed);
      if (result.starts[k].error.total_variation > options.accuracy) left.push_back(k);
    }
    result.reached = left.empty();
    if (!runner.may_go_on() || options.first_runs || chance_is_too_much) break;
    open = std::move(left);
    for (const std::size_t k : open)
      if (runner.may_go_on())
        add_trials_of(pool.starts[places[k]], result.starts[k], options.accuracy, runner);
  }
  result.gate_runs = runner.gate_runs;
  result.run_seconds = runner.seconds;
  result.seconds = watch.seconds();
  for (StartAnswer& a : result.starts) a.direct_seconds = direct_seconds(a, runner, options.seed);
  runner.finish();
  result.health = runner.health;
  return result;
}

StartRange usual_range(const Scene& scene) {
  const Bins bins = StateSpace::paper(scene.gate).bins().front();
  const auto holding = [](const std::vector<double>& edges, double own) {
    return std::array<double, 2>{std::min(edges.front(), own), std::max(edges.back(), own)};
  };
  return {holding(bins.d, scene.start.x), holding(bins.vx, scene.start.vx),
          holding(bins.vy, scene.start.vy)};
}

PooledRange pool_range(const Scene& scene, RunPool& pool, const StartRange& range,
                       const AccuracyOptions& options, const Work& work) {
  require_fine(options);
  for (const auto* r : {&range.d, &range.vx, &range.vy})
    if (!((*r)[0] <= (*r)[1])) throw std::invalid_argument("range of starts: is empty");
  constexpr int kTried = 7;
  constexpr std::int64_t kFirstRuns = 400, kBegin = 2000, kLargestTried = 20'000;
  const Stopwatch watch;
  Runner runner(scene, options, work);
  PooledRange result;
  result.range = range;
  result.tried_on = kTried;
  // The starts that it is tried on; their runs are not kept.
  RunPool tried;
  for (int k = 0; k < kTried; ++k) {
    StartTrials& s = tried.starts.emplace_back();
    s.start = entry_of(runner.drawn(range, -1 - k));
    runner.run_first(s, kFirstRuns);
  }
  std::vector<std::size_t> all(kTried);
  std::iota(all.begin(), all.end(), 0);
  runner.run_scattered(pool.scattered, range, kBegin);
  Kernels kernels;
  for (;;) {
    tried.scattered = std::move(pool.scattered);
    const Said said = ask(scene, tried, kernels, all, options, true);
    pool.scattered = std::move(tried.scattered);
    std::vector<double> errors;
    for (std::size_t k = 0; k < all.size(); ++k)
      errors.push_back(GroupSpread(said.whole[k], said.kernels[k])
                           .error(kFirstRuns, options.seed)
                           .total_variation);
    std::sort(errors.begin(), errors.end());
    result.kernel_error_95 = errors[errors.size() / 2];
    result.worst_kernel_error_95 = errors.back();
    result.reached = result.kernel_error_95 <= options.accuracy;
    if (result.reached || !runner.may_go_on()) break;
    // To try a large pool costs more than its runs: the last step is made on trust.
    const auto n = static_cast<double>(pool.scattered.starts.size());
    const bool last = pool.scattered.starts.size() >= kLargestTried;
    const double times = std::min(times_more(result.kernel_error_95, options.accuracy), 4.0);
    runner.run_scattered(pool.scattered, range, static_cast<std::int64_t>(n * (times - 1.0)));
    if (!last) continue;
    result.kernel_error_95 /= std::sqrt(times);
    result.worst_kernel_error_95 /= std::sqrt(times);
    result.reached = result.kernel_error_95 <= 1.05 * options.accuracy;
    break;
  }
  result.gate_runs = runner.gate_runs;
  result.seconds = watch.seconds();
  runner.finish();
  result.health = runner.health;
  return result;
}

}  // namespace gatewalk::lattice
