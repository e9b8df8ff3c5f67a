// SPDX-License-Identifier: MIT
#include "lattice/study/best_start.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "dynamics/base/random.h"
#include "dynamics/base/share.h"
#include "lattice/field/gate_chain.h"
#include "lattice/field/running_trial.h"
#include "lattice/pool/kernel.h"
#include "lattice/study/choice_rounds.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;

class Starter {
 public:
  Starter(const Problem& problem, const BestStartOptions& options, const Work& work)
      : problem_(problem),
        options_(options),
        columns_(options.columns.empty() ? std::vector<int>{problem.field.start_column()}
                                         : options.columns),
        own_{problem.field.start_column(), problem.start},
        rounds_("start", Purpose::plan, problem.cells, problem, options.accuracy, options.most_runs,
                options.seed, work) {}

  [[nodiscard]] BestStart carry_out() {
    rounds_.add(explore(kSpread * rounds_.count()));
    const auto round = rounds_.choose_best<TrialStart>(
        {}, [&] { return choose(); }, [&](const TrialStart& start) { return run(start); },
        [&](const TrialStart&) { return explore(rounds_.count()); });
    const bool own = !clearly_more(crossings_of(round.trials[round.winner].each),
                                   crossings_of(round.trials[kOwn].each));
    return judged(own ? own_ : round.candidates[round.winner], own, round.settled);
  }

 private:
  // Trials of the first round, as a multiple of those of a start.
  static constexpr std::int64_t kSpread = 8;
  static constexpr int kTournament = 4;  // number of drawn starts of which the best is taken
  static constexpr std::size_t kOwn = kLeafSizes.size();  // index after those of the leaf sizes

  /// True if one start is better than another by more than a standard error.
  [[nodiscard]] static bool clearly_more(const Crossings& one, const Crossings& other) {
    const auto variance = [](const Crossings& c) {
      const double n = static_cast<double>(c.trials), k = static_cast<double>(c.crossed);
      return k * (1.0 - k / n);
    };
    return static_cast<double>(one.crossed - other.crossed) >
           std::sqrt(variance(one) + variance(other));
  }

  [[nodiscard]] RangeRuns run(const TrialStart& start) {
    return rounds_.run({start.entry, {}, [&start](std::int64_t) { return start; }},
                       rounds_.count());
  }

  /// Trials from starts anywhere, or where a chain gives a higher probability.
  [[nodiscard]] RangeRuns explore(std::int64_t count) {
    const StartOfTrial start = [&](std::int64_t trial) {
      Random random(Purpose::plan, {options_.seed, 0, static_cast<std::uint64_t>(trial)});
      TrialStart best = drawn(random);
      for (int i = 1; chances_ && i < kTournament; ++i)
        if (const TrialStart other = drawn(random);
            chances_->chance(other) > chances_->chance(best))
          best = other;
      return best;
    };
    RangeRuns trials = rounds_.run({own_.entry, {}, start}, count);
    drawn_.insert(drawn_.end(), trials.starts.begin(), trials.starts.end());
    return trials;
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

  [[nodiscard]] std::vector<TrialStart> choose() {
    std::vector<TrialStart> starts;
    for (const int size : kLeafSizes) {
      StartChances chances = chances_with(size);
      starts.push_back(best_of(chances));
      if (size == kLeafSizes[1]) chances_ = std::move(chances);
    }
    starts.push_back(own_);
    return starts;
  }

  [[nodiscard]] StartChances chances_with(int leaf_size) const {
    const FieldParams& field = problem_.field;
    Kernel kernel = kernel_of(problem_.map(), rounds_.pool(), leaf_size * options_.per_leaf);
    if (2.0 * numbers_of(field, kernel.space) > kMostDecisionBytes)
      throw too_large("plan: values of");
    markov::Decisions chances = markov::decide({field_chain(problem_.map(), chains_of(kernel))},
                                               {field.columns, field.rows}, gain_of_crossing(),
                                               {.max_cells = field.max_gates});
    chances.action.clear();  // there is only one action
    return {std::move(kernel.space), std::move(chances), field.start_row};
  }

  /// The best column, with the mean of the drawn starts in the best leaf that has any.
  [[nodiscard]] TrialStart best_of(const StartChances& chances) const {
    TrialStart best{columns_.front(), drawn_.front()};
    int leaf = chances.space.index_of(best.entry).state;
    for (const Entry& entry : drawn_) {
      const int state = chances.space.index_of(entry).state;
      for (const int column : columns_)
        if (const TrialStart start{column, entry}; chances.chance(start) > chances.chance(best)) {
          best = start;
          leaf = state;
        }
    }
    double n = 0.0;
    std::vector<double> sum(options_.ranges.size());
    for (const Entry& entry : drawn_) {
      if (chances.space.index_of(entry).state != leaf) continue;
      n += 1.0;
      for (std::size_t r = 0; r < sum.size(); ++r)
        sum[r] += entry.at[options_.ranges[r].coordinate];
    }
    for (std::size_t r = 0; r < sum.size(); ++r)
      best.entry.at[options_.ranges[r].coordinate] = sum[r] / n;
    return best;
  }

  /// Judges a start by held-out trials. The own start is the best known if these cross no less
  /// often from there.
  [[nodiscard]] BestStart judged(const TrialStart& best, bool own, bool settled) {
    const std::int64_t first = rounds_.next();
    const FieldTrials with = run(best).each;
    rounds_.go_back_to(first);
    const FieldTrials without = run(own_).each;
    own = own || crossings_of(with).crossed <= crossings_of(without).crossed;
    return {rounds_.summary(settled),
            std::move(*chances_),
            own ? own_ : best,
            own,
            crossings_of(own ? without : with),
            crossings_of(without),
            own ? Gain::over_itself() : gain_over(with, without)};
  }

  const Problem& problem_;
  const BestStartOptions& options_;
  std::vector<int> columns_;
  TrialStart own_;
  ChoiceRounds rounds_;
  std::optional<StartChances> chances_;  // of the last choice, with leaves of the middle size
  std::vector<Entry> drawn_;
};

}  // namespace

double StartChances::chance(const TrialStart& start) const {
  return chances.value[chances.at(start.column, row, space.index_of(start.entry).state)];
}

BestStart best_start(const Problem& problem, const BestStartOptions& options, const Work& work) {
  const auto require = [](bool holds, const std::string& what) {
    if (!holds) throw std::invalid_argument("plan of a start: " + what);
  };
  require_cells(problem.cells);
  require_choice_options("plan of a start", options.accuracy, options.per_leaf);
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
    require(problem.field.contains(column, problem.field.start_row), "there is no such column");
  BestStart best = Starter(problem, options, work).carry_out();
  if (problem.check) problem.check(best.gate_runs / 10, options.seed, best.health, work);
  return best;
}

}  // namespace gatewalk::lattice
