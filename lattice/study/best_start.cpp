// SPDX-License-Identifier: MIT
#include "lattice/study/best_start.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "dynamics/base/random.h"
#include "dynamics/base/share.h"
#include "lattice/gate_chain.h"
#include "lattice/pool/run_pool.h"
#include "lattice/study/chosen_trials.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;

/// Chances to cross of a chain.
struct Values {
  StateSpace space;
  markov::Decisions chances;

  [[nodiscard]] double at(const TrialStart& start) const {
    return chances.value[chances.at(start.column, 0, space.index_of(start.entry).state)];
  }
};

class Starter {
 public:
  Starter(const Problem& problem, const BestStartOptions& options, const Work& work)
      : problem_(problem),
        options_(options),
        columns_(options.columns.empty() ? std::vector<int>{problem.field.start_column()}
                                         : options.columns),
        own_{problem.field.start_column(), problem.start},
        trials_("start", problem.cells, problem, options.seed, work),
        count_(trials_for(options.accuracy)) {}

  [[nodiscard]] BestStart carry_out() {
    explore({}, kSpread * count_);
    std::optional<TrialStart> known;
    for (int rounds = 1;; ++rounds) {
      std::vector<TrialStart> starts;
      std::optional<Values> middle;
      for (const int times : kLeafSizes) {
        Values values = values_of(times * options_.per_leaf);
        starts.push_back(best_of(values));
        if (times == kLeafSizes[1]) middle = std::move(values);
      }
      starts.push_back(own_);
      if (known) starts.push_back(*known);
      std::vector<std::int64_t> crossed;
      std::vector<FieldTrials> all;
      const std::int64_t first = trials_.next();
      for (const TrialStart& start : starts) {
        trials_.go_back_to(first);
        all.push_back(run(start));
        crossed.push_back(crossings_of(all.back()).crossed);
      }
      const auto most = static_cast<std::size_t>(std::max_element(crossed.begin(), crossed.end()) -
                                                 crossed.begin());
      trials_.add(all[most], {starts[most].entry});
      const double gained = static_cast<double>(crossed[most] - crossed.back());
      const bool settled = known &&
                           gained <= 0.5 * options_.accuracy * static_cast<double>(count_) &&
                           gained <= 2.0 * std::sqrt(static_cast<double>(crossed[most]));
      if (settled || trials_.gate_runs() >= options_.most_runs) {
        const bool own = !clearly_more(crossed[most], crossed[kOwn]);
        return judged(own ? own_ : starts[most], own, std::move(*middle), rounds, settled);
      }
      known = starts[most];
      explore(middle, count_);
    }
  }

 private:
  static constexpr std::int64_t kSpread = 8;  // trials of the first round, by those of a start
  static constexpr int kTournament = 4;       // drawn starts, of which the best is taken
  static constexpr std::size_t kOwn = kLeafSizes.size();  // behind those of each size of leaves

  /// Another start is taken if it is better by more than a standard error.
  [[nodiscard]] bool clearly_more(std::int64_t one, std::int64_t other) const {
    const auto variance = [&](std::int64_t crossed) {
      const double n = static_cast<double>(count_), k = static_cast<double>(crossed);
      return k * (1.0 - k / n);
    };
    return static_cast<double>(one - other) > std::sqrt(variance(one) + variance(other));
  }

  [[nodiscard]] FieldTrials run(const TrialStart& start) {
    return trials_.run_from([&start](std::int64_t) { return start; }, count_);
  }

  /// Trials from starts anywhere, or where the chain says that they do better.
  void explore(const std::optional<Values>& values, std::int64_t count) {
    const auto start_of = [&](std::int64_t trial) {
      Random random(Purpose::plan, {options_.seed, 0, static_cast<std::uint64_t>(trial)});
      TrialStart best = drawn(random);
      for (int i = 1; values && i < kTournament; ++i)
        if (const TrialStart other = drawn(random); values->at(other) > values->at(best))
          best = other;
      return best;
    };
    const std::int64_t first = trials_.next();
    const FieldTrials trials = trials_.run_from(start_of, count);
    std::vector<Entry> entries;
    for (std::int64_t i = 0; i < count; ++i) entries.push_back(start_of(first + i).entry);
    drawn_.insert(drawn_.end(), entries.begin(), entries.end());
    trials_.add(trials, std::move(entries));
  }
  [[nodiscard]] TrialStart drawn(Random& random) const {
    const auto n = static_cast<double>(columns_.size());
    const auto place =
        std::min(columns_.size() - 1, static_cast<std::size_t>(n * random.uniform()));
    TrialStart start{columns_[place], own_.entry};
    for (const CoordinateRange& range : options_.ranges)
      start.entry.at[range.coordinate] = range.low + (range.high - range.low) * random.uniform();
    return start;
  }

  [[nodiscard]] Values values_of(int per_leaf) const {
    const FieldParams& field = problem_.field;
    Kernel kernel = kernel_of(problem_.map(), trials_.pool(), per_leaf);
    if (2.0 * std::max(1, field.max_gates) * field.columns * field.rows * kernel.space.size() >
        kMostDecisionBytes)
      throw std::runtime_error(
          "plan: values of so many cells, states and gates do not fit into memory; a smaller "
          "field.max_gates (0: no limit) needs less");
    std::vector<markov::Chain> chains;
    for (const markov::Counts& counts : kernel.counts)
      chains.push_back(markov::Chain::from_counts(counts, exits_of(kernel.space)));
    markov::Gains crossing;
    crossing.ending[static_cast<std::size_t>(markov::Ending::far_edge)] = 1.0;
    markov::Decisions chances =
        markov::decide({field_chain(problem_.map(), std::move(chains))},
                       {field.columns, field.rows}, crossing, {.max_cells = field.max_gates});
    chances.action.clear();  // there is one action
    return {std::move(kernel.space), std::move(chances)};
  }

  /// The middle of the drawn starts in the best leaf that has any.
  [[nodiscard]] TrialStart best_of(const Values& values) const {
    TrialStart best{columns_.front(), drawn_.front()};
    int leaf = values.space.index_of(best.entry).state;
    for (const Entry& entry : drawn_) {
      const int state = values.space.index_of(entry).state;
      for (const int column : columns_)
        if (const TrialStart start{column, entry}; values.at(start) > values.at(best)) {
          best = start;
          leaf = state;
        }
    }
    double n = 0.0;
    std::vector<double> sum(options_.ranges.size());
    for (const Entry& entry : drawn_) {
      if (values.space.index_of(entry).state != leaf) continue;
      n += 1.0;
      for (std::size_t r = 0; r < sum.size(); ++r)
        sum[r] += entry.at[options_.ranges[r].coordinate];
    }
    for (std::size_t r = 0; r < sum.size(); ++r)
      best.entry.at[options_.ranges[r].coordinate] = sum[r] / n;
    return best;
  }

  /// By trials that nothing was chosen by.
  [[nodiscard]] BestStart judged(const TrialStart& best, bool own, Values values, int rounds,
                                 bool settled) {
    const std::int64_t first = trials_.next();
    const FieldTrials with = run(best);
    trials_.go_back_to(first);
    const FieldTrials without = run(own_);
    BestStart found{.best = best,
                    .own = own,
                    .crossings = crossings_of(with),
                    .crossings_of_own = crossings_of(without),
                    .gain = own ? Gain::over_itself() : gain_over(with, without),
                    .space = std::move(values.space),
                    .chances = std::move(values.chances),
                    .rounds = rounds,
                    .settled = settled,
                    .gate_runs = trials_.gate_runs(),
                    .health = trials_.health()};
    return found;
  }

  const Problem& problem_;
  const BestStartOptions& options_;
  std::vector<int> columns_;
  TrialStart own_;
  ChosenTrials trials_;
  std::int64_t count_;  // trials of a start in a round
  std::vector<Entry> drawn_;
};

}  // namespace

double BestStart::chance(const TrialStart& start) const {
  return chances.value[chances.at(start.column, 0, space.index_of(start.entry).state)];
}

BestStart best_start(const Problem& problem, const BestStartOptions& options, const Work& work) {
  const auto require = [](bool holds, const std::string& what) {
    if (!holds) throw std::invalid_argument("plan of a start: " + what);
  };
  require_cells(problem.cells);
  require(options.accuracy >= 0.001 && options.accuracy < 0.5, "accuracy must lie in [0.001, 0.5)");
  require(options.per_leaf >= 1 && options.per_leaf <= 1'000'000, "leaves of 1 to 1000000 entries");
  require(!options.ranges.empty(), "needs a range of one number at least");
  for (std::size_t r = 0; r < options.ranges.size(); ++r)
    for (std::size_t other = 0; other < r; ++other)
      require(options.ranges[r].coordinate != options.ranges[other].coordinate,
              "two ranges are of the same number");
  for (const CoordinateRange& range : options.ranges)
    require(range.coordinate < problem.map().section.coordinates.size() &&
                std::isfinite(range.low) && std::isfinite(range.high) && range.low < range.high,
            "a range is of a number of an entry, and has a low end below its high one");
  for (const int column : options.columns)
    require(problem.field.contains(column, 0), "there is no such column");
  BestStart best = Starter(problem, options, work).carry_out();
  if (problem.check) problem.check(best.gate_runs / 10, options.seed, best.health, work);
  return best;
}

}  // namespace gatewalk::lattice
