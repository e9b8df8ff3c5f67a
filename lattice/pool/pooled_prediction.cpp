// SPDX-License-Identifier: MIT
#include "lattice/pool/pooled_prediction.h"

#include <fmt/core.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "dynamics/base/share.h"
#include "lattice/field/exits.h"
#include "lattice/pool/assumptions.h"
#include "lattice/pool/hausman_check.h"
#include "lattice/pool/pool_answers.h"
#include "lattice/pool/predict_pooled.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;
using markov::FinalDistribution;

constexpr std::int64_t kFirstRound = 20 * kTrialGroups;  // trials of all starts together
constexpr std::int64_t kLeastFirstRuns = 500;            // per new start of a pool that has runs

void require_fine(const AccuracyOptions& options) {
  if (!(options.accuracy > 0.0 && options.accuracy < 1.0))
    throw std::invalid_argument("accuracy " + fmt::format("{:f}", options.accuracy) +
                                " is not permitted: must lie in (0, 1)");
}

/// Total variation that this number of walks keeps, in 95 % of cases, from infinitely many walks.
double chance_of_walks(const FinalDistribution& d, std::int64_t walks) {
  constexpr double kToQuantile = 1.3;
  return walks == 0 ? 0.0 : kToQuantile * expected_total_variation(d.final_cells, walks);
}

/// Widens an interval by a share of bodies about which nothing is known.
void widen(std::array<double, 2>& interval, double share) {
  interval = {std::max(0.0, interval[0] - share), std::min(1.0, interval[1] + share)};
}

/// The chain's answer with error bars. `first_runs`: behind the chain's first row; `pool_trials`:
/// behind its other rows.
StartAnswer chain_answer(const FieldParams& field, std::int64_t first_runs,
                         std::int64_t pool_trials, const PoolAnswer& of, std::uint64_t seed) {
  StartAnswer a;
  a.first_runs = first_runs;
  a.unseen = of.unseen;
  a.final = of.whole;
  std::vector<FinalDistribution> groups = of.groups;
  const std::int64_t behind = std::min(first_runs, pool_trials);
  const double chance = chance_of_walks(a.final, of.walks);
  a.error = GroupSpread(a.final, groups, of.coordinates).error(behind, seed);
  a.error.total_variation = std::min(1.0, std::hypot(a.error.total_variation, chance) + a.unseen);
  a.kernel_error_95 = of.kernels.empty()
                          ? a.error.total_variation
                          : std::min(1.0, GroupSpread(a.final, of.kernels, of.coordinates)
                                                  .error(pool_trials, seed)
                                                  .total_variation +
                                              a.unseen);
  if (of.small_leaves) {
    a.final = with_endings(std::move(a.final), of.small_leaves->whole.endings);
    for (std::size_t g = 0; g < groups.size(); ++g)
      groups[g] = with_endings(std::move(groups[g]), of.small_leaves->groups[g].endings);
  }
  const GroupSpread spread(a.final, groups, of.coordinates);
  a.endings = spread.endings_95(behind);
  a.gates_95 = spread.gates_95(behind);
  std::vector<ExitShares> group_exits;
  for (const FinalDistribution& g : groups) group_exits.push_back(exit_shares(g));
  Evidence from = evidence_of(a.final, behind);
  from.bias_left = bias_left(of.coordinates);
  a.exits = exits_of_groups(exit_shares(a.final), group_exits, from);
  if (a.unseen > 0.0) {  // the RMSE is largest if they all move from one gate to another
    const auto gates = static_cast<double>(a.gates_95[0].size());
    a.error.rmse_per_100 += 100.0 * a.unseen * std::sqrt(2.0 / gates);
    a.error.corrcoef = std::nan("");
  }
  for (auto& interval : a.endings.interval) widen(interval, a.unseen);
  a.endings = a.endings.with_limit(field.max_gates);
  for (SideExits& side : a.exits)
    for (auto& interval : side.interval) widen(interval, a.unseen);
  a.exits = within_sides(std::move(a.exits), a.endings);
  a.gates_95[0] = (a.gates_95[0] - a.unseen).max(0.0);
  a.gates_95[1] = (a.gates_95[1] + a.unseen).min(1.0);
  return a;
}

/// The chain's answer, or the shares of the start's own trials if these are more precise.
StartAnswer answer_of(const FieldParams& field, const OwnRuns& s, const PoolAnswer& of,
                      std::uint64_t seed) {
  StartAnswer a = chain_answer(field, s.first_runs(), of.pool_trials, of, seed);
  a.start = s.start;
  a.trials = std::ssize(s.full.endings);
  if (a.trials == 0) return a;
  FieldTally tally(field);
  tally.count(s.full.final_gates, s.full.endings);
  const Error95 of_trials = error_of_shares(tally.final_cells, seed);
  a.trials_error_95 = of_trials.total_variation;
  a.from_trials = a.trials_error_95 < 0.95 * a.error.total_variation;
  if (!a.from_trials) return a;
  a.error = of_trials;
  a.final = shares_of(s.full, field);
  a.endings = EndingShares(tally.endings, a.trials).with_limit(field.max_gates);
  a.exits = exits_of(tally);
  a.gates_95 = {a.final.final_cells, a.final.final_cells};
  const auto never = interval_of_share(0.0, static_cast<double>(a.trials));
  for (Eigen::Index cell = 0; cell < a.final.final_cells.size(); ++cell) {
    const double share = a.final.final_cells.data()[cell];
    const auto interval =
        share == 0.0 ? never : interval_of_share(share, static_cast<double>(a.trials));
    for (std::size_t side = 0; side < 2; ++side) a.gates_95[side].data()[cell] = interval[side];
  }
  return a;
}

/// How many more trials the next round makes. Errors fall as 1 / sqrt(trials), but an error bar is
/// itself an estimate, which gets better as it comes near the goal.
struct Schedule {
  double far = 2.5;          // above this factor of trials, ...
  double part_of_far = 0.6;  // ... a round makes only this part of the factor, ...
  double most = 16.0;        // ... and at most this factor: otherwise trials may be wasted
  double margin = 1.1;       // below `far`, a round makes this factor more than needed, ...
  double least = 1.2;        // ... and at least this factor: otherwise there may be many rounds
};

/// For many starts, chains and answers take as long as the runs: fewer and larger rounds.
constexpr Schedule kForMany{.part_of_far = 0.8, .margin = 1.6, .least = 1.6};

/// The factor by which the number of trials grows in the next round.
double times_more(double error, double wanted, const Schedule& by = {}) {
  const double times = (error / wanted) * (error / wanted);
  return times > by.far ? std::min(by.part_of_far * times, by.most)
                        : std::max(by.margin * times, by.least);
}

/// Time that direct simulation would take for the same error bar, at this run's speed, s.
double direct_seconds(const StartAnswer& a, const PoolRunner& runner, std::uint64_t seed) {
  if (runner.gate_runs == 0) return std::nan("");
  constexpr std::int64_t kTrials = 10'000;
  const CellCounts drawn = sampled(a.final.final_cells, kTrials, seed, 0);
  const double times = error_of_shares(drawn, seed).total_variation / a.error.total_variation;
  return times * times * static_cast<double>(kTrials) * a.final.mean_steps *
         runner.seconds_per_gate_run();
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Adds trials for the starts whose answers are too uncertain, until all answers are precise
/// enough.
class PredictionRun {
 public:
  PredictionRun(const Problem& problem, RunPool& pool, const std::vector<Entry>& starts,
                const AccuracyOptions& options, const Work& work)
      : problem_(problem),
        pool_(pool),
        options_(options),
        work_(work),
        runner_(problem, options.seed, options.limit(), work),
        chains_(problem.map(), problem.field, options.per_leaf, starts.size(), options.seed) {
    place(starts);
    result_.starts.resize(starts.size());
    said_.starts.resize(starts.size());
    open_ = all();
  }

  [[nodiscard]] PooledPrediction carry_out() {
    if (options_.trials) work_.end_part();  // only then do all parts of a run need the same trials
    const bool may_add = !options_.first_runs && !options_.trials;
    while (ask() && runner_.may_go_on() && may_add) add_trials();
    add_endings();
    result_.reached = open_.empty();
    result_.gate_runs = runner_.gate_runs;
    result_.run_seconds = runner_.seconds;
    result_.hausman_check = look_at_own_trials();
    result_.assumptions = look_at_assumptions();
    result_.seconds = watch_.seconds();
    tbb::parallel_for(std::size_t{0}, result_.starts.size(), [&](std::size_t k) {
      result_.starts[k].direct_seconds = direct_seconds(result_.starts[k], runner_, options_.seed);
    });
    runner_.finish();
    result_.health = runner_.health;
    return std::move(result_);
  }

 private:
  [[nodiscard]] std::optional<HausmanCheck> look_at_own_trials() const {
    if (by_walks_) return {};
    std::vector<TrialsAndChain> of;
    for (std::size_t k = 0; k < result_.starts.size(); ++k)
      if (const StartAnswer& a = result_.starts[k]; a.trials > 0 && !a.from_trials)
        of.push_back({pool_.starts[places_[k]].full, a.final});
    return hausman_check(of, problem_.field, options_.seed);
  }

  [[nodiscard]] std::vector<AssumptionCheck> look_at_assumptions() const {
    if (by_walks_) return {};
    std::vector<std::size_t> by_chain;
    for (const std::size_t k : all())
      if (!result_.starts[k].from_trials) by_chain.push_back(k);
    if (by_chain.empty()) return {};
    const PoolAnswer& of = said_.starts[by_chain.front()];
    std::optional<GroupedMaps> chain, small_leaves;
    if (by_chain.size() == 1 && all_asked_) {
      chain = of.maps();
      small_leaves = of.maps_of_small_leaves();
    }
    return check_assumptions(problem_.map(), problem_.field, pool_, rows_of(by_chain),
                             chains_.per_leaf(), of.coordinates, options_.seed, std::move(chain),
                             small_leaves);
  }

  [[nodiscard]] std::vector<std::size_t> all() const {
    std::vector<std::size_t> starts(result_.starts.size());
    std::iota(starts.begin(), starts.end(), 0);
    return starts;
  }

  /// Finds the starts in the pool, or adds them with some trials each.
  void place(const std::vector<Entry>& starts) {
    const bool has_kernel = pool_.gate_runs() > 0;
    for (auto to_place = std::ssize(starts); const Entry& entry : starts) {
      const std::int64_t part = runner_.runs_left() / to_place--;
      places_.push_back(pool_.place_of(entry));
      if (places_.back() < pool_.starts.size()) continue;
      OwnRuns& s = pool_.starts.emplace_back();
      s.start = entry;
      if (has_kernel)
        runner_.run_first(s, options_.first_runs.value_or(std::min(kLeastFirstRuns, part)));
      else
        runner_.run_full(s, options_.trials.value_or(kFirstRound) / std::ssize(starts));
    }
  }

  /// Computes the answers for the open starts, and closes those that are precise enough. Returns
  /// false if no more trials are wanted, or if they would not help.
  [[nodiscard]] bool ask() {
    // The adjoint answers for all starts at the cost of one. Closed starts are then asked again,
    // which corrects error bars that were small by chance.
    if (chains_.by_adjoint(pool_, open_.size())) open_ = all();
    const std::vector<std::size_t> asked = open_;
    all_asked_ = asked.size() == result_.starts.size();
    PoolAnswers said = chains_.ask(pool_, rows_of(asked));
    for (std::size_t i = 0; i < asked.size(); ++i)
      said_.starts[asked[i]] = std::move(said.starts[i]);
    said.starts = std::move(said_.starts);
    said_ = std::move(said);
    result_.states = said_.states;
    result_.nonzeros = said_.nonzeros;
    by_walks_ = said_.starts[asked.front()].walks > 0;
    answer(asked);
    std::erase_if(open_, [&](std::size_t k) {
      return result_.starts[k].error.total_variation <= options_.accuracy;
    });
    if (open_.empty() && must_ask_all()) {
      open_ = all();
      return ask();
    }
    // The walks have their own sampling error: if it makes up half of the error, more trials do not
    // help.
    return !open_.empty() && std::none_of(asked.begin(), asked.end(), [&](std::size_t k) {
      return chance_of_walks(said_.starts[k].whole, said_.starts[k].walks) >=
             0.5 * options_.accuracy;
    });
  }

  /// Whether closed starts must be asked again before the end. All answers of few starts come from
  /// the last pool. Many keep the answers that closed them: each time that all are asked, a
  /// prediction takes at least a fifth longer, and some bars are slightly too large again. But no
  /// answer comes from walks if the adjoint makes it exact.
  [[nodiscard]] bool must_ask_all() const {
    if (all_asked_) return false;
    return !chains_.are_for_many() ||
           (by_walks_ && chains_.by_adjoint(pool_, result_.starts.size()));
  }

  [[nodiscard]] std::vector<FirstRow> rows_of(const std::vector<std::size_t>& starts) const {
    std::vector<FirstRow> rows;
    for (const std::size_t k : starts) rows.emplace_back(&pool_.starts[places_[k]]);
    return rows;
  }

  /// Makes the answers for these starts from what the chains said.
  void answer(const std::vector<std::size_t>& starts) {
    tbb::parallel_for(std::size_t{0}, starts.size(), [&](std::size_t i) {
      const std::size_t k = starts[i];
      result_.starts[k] =
          answer_of(problem_.field, pool_.starts[places_[k]], said_.starts[k], options_.seed);
    });
  }

  /// Adds the endings from small leaves to all answers.
  void add_endings() {
    if (must_ask_all()) {
      open_ = all();
      static_cast<void>(ask());
    }
    if (!by_walks_ && chains_.add_endings(pool_, rows_of(all()), said_)) answer(all());
  }

  /// The part of the error that comes from the first runs.
  [[nodiscard]] static double first_error(const StartAnswer& a) {
    const double e = a.error.total_variation - a.unseen, k = a.kernel_error_95 - a.unseen;
    return std::sqrt(std::max(1e-4 * e * e, e * e - k * k));
  }

  /// The error bar that kernels should reach alone, so that the total number of gate runs is
  /// smallest. The kernel's runs serve all starts, first runs only their own start; each part of
  /// the squared error falls as 1 / runs.
  [[nodiscard]] double kernel_goal() const {
    std::vector<double> kernel, first;
    for (const std::size_t k : open_) {
      const StartAnswer& a = result_.starts[k];
      kernel.push_back(a.kernel_error_95 * std::sqrt(static_cast<double>(pool_.gate_runs())));
      first.push_back(first_error(a) * std::sqrt(static_cast<double>(a.first_runs)));
    }
    const double shared = median(kernel),
                 own = median(first) * std::sqrt(static_cast<double>(result_.starts.size()));
    return options_.accuracy *
           std::sqrt(std::clamp(shared / std::max(1e-9, shared + own), 0.2, 0.72));
  }

  /// What a start needs: further full trials, and the total number of runs through its first gate.
  struct Order {
    std::size_t start;
    double full = 0.0, first = 0.0;
  };

  /// Runs a round. If the orders need more gate runs than are left, each order gets its share of
  /// them.
  void add_trials() {
    const std::vector<Order> orders = by_walks_ ? orders_for_walks() : orders_for_kernels();
    std::vector<double> costs;
    for (const Order& o : orders)
      costs.push_back(o.full * runner_.gates_per_trial() + more_first(o, o.full));
    double wanted = std::accumulate(costs.begin(), costs.end(), 0.0);
    for (std::size_t i = 0; i < orders.size() && runner_.may_go_on(); wanted -= costs[i++]) {
      const Order& o = orders[i];
      OwnRuns& s = pool_.starts[places_[o.start]];
      const double part = std::min(1.0, static_cast<double>(runner_.runs_left()) / wanted);
      if (o.full > 0.0) runner_.run_full(s, static_cast<std::int64_t>(part * o.full));
      if (const double more = more_first(o, (1.0 - part) * o.full);
          more > 0.0 && runner_.may_go_on())
        runner_.run_first(s, static_cast<std::int64_t>(part * more));
    }
  }

  /// First runs that an order still needs once `full` more full trials are run.
  [[nodiscard]] double more_first(const Order& order, double full = 0.0) const {
    const auto made = static_cast<double>(pool_.starts[places_[order.start]].first_runs());
    return std::max(0.0, order.first - made - full);
  }

  /// Orders when answers come from walks: rounds take long, so full trials grow by the whole
  /// factor.
  [[nodiscard]] std::vector<Order> orders_for_walks() const {
    std::vector<Order> orders;
    for (const std::size_t k : open_) {
      const double times = times_more(result_.starts[k].error.total_variation, options_.accuracy);
      orders.push_back({k, own_trials_of(k) * (times - 1.0)});
    }
    return orders;
  }

  [[nodiscard]] std::vector<Order> orders_for_kernels() const {
    const Schedule by = chains_.by_adjoint(pool_, result_.starts.size()) ? kForMany : Schedule{};
    const double goal = kernel_goal();
    std::vector<std::size_t> lacking;  // starts whose kernel is too uncertain
    for (const std::size_t k : open_)
      if (result_.starts[k].kernel_error_95 > 1.05 * goal) lacking.push_back(k);
    // If these starts are few, first runs can compensate to some extent.
    if (4 * lacking.size() < result_.starts.size())
      std::erase_if(lacking, [&](std::size_t k) {
        return result_.starts[k].kernel_error_95 < 0.85 * options_.accuracy;
      });
    std::vector<Order> orders;
    for (const std::size_t k : open_) {
      const StartAnswer& a = result_.starts[k];
      const bool lacks = std::find(lacking.begin(), lacking.end(), k) != lacking.end();
      const double kernel = lacks ? goal : a.kernel_error_95;
      const double wanted = std::sqrt(options_.accuracy * options_.accuracy - kernel * kernel);
      Order& order = orders.emplace_back(k);
      if (lacks) order.full = trials_for_kernel(k, goal, std::ssize(lacking), by);
      if (!lacks || first_error(a) > wanted)
        order.first = static_cast<double>(a.first_runs) * times_more(first_error(a), wanted, by);
    }
    return orders;
  }

  /// Full trials for this start's kernel: the number needed if only its own trials helped, or its
  /// part of the number needed if all trials helped alike, whichever is less.
  [[nodiscard]] double trials_for_kernel(std::size_t k, double goal, std::int64_t lacking,
                                         const Schedule& by) const {
    const StartAnswer& a = result_.starts[k];
    const double all = static_cast<double>(pool_.gate_runs()) / std::max(1.0, a.final.mean_steps) /
                       static_cast<double>(lacking);
    return std::min(own_trials_of(k), all) * (times_more(a.kernel_error_95, goal, by) - 1.0);
  }

  /// The start's number of full trials, at least half of a first round.
  [[nodiscard]] double own_trials_of(std::size_t k) const {
    const std::int64_t trials = std::ssize(pool_.starts[places_[k]].full.passed);
    return static_cast<double>(std::max(trials, kFirstRound / 2));
  }

  const Stopwatch watch_;
  const Problem& problem_;
  RunPool& pool_;
  const AccuracyOptions& options_;
  const Work& work_;
  PoolRunner runner_;
  PoolChains chains_;
  bool all_asked_ = false;           // whether the last answers were those of all starts
  bool by_walks_ = false;            // whether the current answers come from walks
  std::vector<std::size_t> places_;  // indices of the starts in the pool
  std::vector<std::size_t> open_;    // starts whose answers are not precise enough yet
  PoolAnswers said_{};               // what the chains last said of each start
  PooledPrediction result_;
};

}  // namespace

FinalDistribution shares_of(const FieldTrials& trials, const FieldParams& field) {
  const auto n = static_cast<double>(trials.final_gates.size());
  FieldTally tally(field);
  tally.count(trials.final_gates, trials.endings);
  // Adds 1 / n once per trial, as a sum over trials would.
  FinalDistribution d{markov::shares_of(tally, [&](std::int64_t count) {
    double share = 0.0;
    for (; count > 0; --count) share += 1.0 / n;
    return share;
  })};
  d.mean_steps = static_cast<double>(trials.passages.size()) / n;
  return d;
}

PooledPrediction predict_pooled(const Problem& problem, RunPool& pool,
                                const std::vector<Entry>& starts, const AccuracyOptions& options,
                                const Work& work) {
  require_fine(options);
  return PredictionRun(problem, pool, starts, options, work).carry_out();
}

StartRange usual_range(const Problem& problem) {
  const Section& section = problem.map().section;
  const Entry& start = problem.start;
  StartRange range{start.face,
                   usual_at(section, section.faces[static_cast<std::size_t>(start.face)])};
  for (std::size_t axis = 0; axis < section.coordinates.size(); ++axis) {
    auto& [low, high] = range.at[axis];
    low = std::min(low, start.at[axis]);
    high = std::max(high, start.at[axis]);
  }
  return range;
}

namespace {

std::vector<FirstRow> rows_of(const RunPool& pool,
                              const std::vector<std::optional<Entry>>& starts) {
  std::vector<FirstRow> rows;
  for (const auto& start : starts) rows.push_back(pool.first_row(start));
  return rows;
}

/// The answers of all runs: final gates from the kernel, endings from small leaves.
KernelAnswers whole_answers(const Kernel& kernel, const Problem& problem, const RunPool& pool,
                            const std::vector<FirstRow>& rows, int per_leaf, std::uint64_t seed) {
  const CellMap& map = problem.map();
  KernelAnswers answers = answers_of(
      kernel, map, first_rows(kernel, map, pool, rows, problem.start_type()), problem.field, seed);
  const int leaf = ending_leaf(pool, per_leaf);
  if (answers.walks > 0 || leaf >= per_leaf) return answers;
  const auto endings = by_small_leaves(map, problem.field, pool, rows, leaf);
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (endings[i])
      answers.final[i] = with_endings(std::move(answers.final[i]), endings[i]->endings);
  return answers;
}

}  // namespace

std::vector<FinalDistribution> predict_whole(const Problem& problem, const RunPool& pool,
                                             const std::vector<std::optional<Entry>>& starts,
                                             int per_leaf, std::uint64_t seed) {
  return whole_answers(kernel_of(problem.map(), pool, per_leaf), problem, pool,
                       rows_of(pool, starts), per_leaf, seed)
      .final;
}

PooledPrediction predict_recorded(const Problem& problem, const RunPool& pool,
                                  const std::vector<std::optional<Entry>>& starts,
                                  const AccuracyOptions& options) {
  const Stopwatch watch;
  const CellMap& map = problem.map();
  const int per_leaf = options.per_leaf;
  const std::uint64_t seed = options.seed;
  const std::int64_t bodies = pool.bodies();
  PooledPrediction result;
  const std::vector<FirstRow> rows = rows_of(pool, starts);
  PoolAnswers said;
  KernelAnswers whole;  // if bodies are too few for error bars
  if (bodies >= kLeastBodies) {
    PoolChains chains(map, problem.field, per_leaf, starts.size(), seed);
    said = chains.ask(pool, rows);
    static_cast<void>(chains.add_endings(pool, rows, said));
    // Of the chain as a whole: for all bodies as they were seen.
    const std::vector<FirstRow> as_seen{std::monostate{}};
    if (!said.by_walks() && !said.starts.empty() && !pool.scattered.starts.empty())
      result.assumptions = check_assumptions(map, problem.field, pool, as_seen, chains.per_leaf(),
                                             said.starts.front().coordinates, seed);
  } else {
    const Kernel kernel = kernel_of(map, pool, per_leaf);
    whole = whole_answers(kernel, problem, pool, rows, per_leaf, seed);
    said.states = kernel.space.size();
    said.nonzeros = kernel.nonzeros();
  }
  result.states = said.states;
  result.nonzeros = said.nonzeros;
  for (std::size_t i = 0; i < starts.size(); ++i) {
    StartAnswer& a = result.starts.emplace_back();
    if (bodies >= kLeastBodies) {
      a = chain_answer(problem.field, bodies, bodies, said.starts[i], seed);
    } else {
      const double unknown = std::nan("");
      a.error = {unknown, unknown, unknown};
      a.kernel_error_95 = unknown;
      a.final = std::move(whole.final[i]);
      a.endings = EndingShares(a.final.endings);
      a.exits = exits_of(exit_shares(a.final), {}, {});
      a.gates_95.fill(
          CellProbabilities::Constant(problem.field.rows, problem.field.columns, unknown));
    }
    a.start = starts[i].value_or(Entry{});
    a.as_seen = !starts[i];
    a.direct_seconds = std::nan("");
    result.reached = result.reached && !(a.error.total_variation > options.accuracy);
  }
  result.seconds = watch.seconds();
  return result;
}

PooledRange pool_range(const Problem& problem, RunPool& pool, const StartRange& range,
                       const AccuracyOptions& options, const Work& work) {
  require_fine(options);
  for (const auto& [low, high] : range.at)
    if (!(low <= high)) throw std::invalid_argument("range of starts: is empty");
  constexpr int kTried = 7;
  constexpr std::int64_t kFirstRuns = 400, kBegin = 2000, kLargestTried = 20'000;
  const Stopwatch watch;
  PoolRunner runner(problem, options.seed, options.limit(), work);
  PooledRange result;
  result.range = range;
  result.tried_on = kTried;
  // The starts tried; their runs are not kept.
  RunPool tried;
  for (int k = 0; k < kTried; ++k) {
    OwnRuns& s = tried.starts.emplace_back();
    s.start = runner.drawn(range, -1 - k);
    runner.run_first(s, kFirstRuns);
  }
  std::vector<FirstRow> all;
  for (const OwnRuns& s : tried.starts) all.emplace_back(&s);
  runner.run_scattered(pool.scattered, range, options.trials.value_or(kBegin));
  if (options.trials) work.end_part();
  PoolChains chains(problem.map(), problem.field, options.per_leaf, kTried, options.seed);
  for (;;) {
    tried.scattered = std::move(pool.scattered);
    const PoolAnswers said = chains.ask(tried, all);
    pool.scattered = std::move(tried.scattered);
    std::vector<double> errors;
    for (const PoolAnswer& of : said.starts)
      errors.push_back(
          GroupSpread(of.whole, of.kernels.empty() ? of.groups : of.kernels, of.coordinates)
              .error(pool.trials(), options.seed)
              .total_variation);
    result.kernel_error_95 = median(errors);
    result.worst_kernel_error_95 = *std::max_element(errors.begin(), errors.end());
    result.reached = result.kernel_error_95 <= options.accuracy;
    if (result.reached || !runner.may_go_on() || options.trials) break;
    // Trying a large pool costs more than its runs. After the last step the pool is not tried
    // again, and its error is taken to fall as 1 / sqrt(runs).
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
