// SPDX-License-Identifier: MIT
#include "lattice/study/parameter_effects.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>

#include "dynamics/base/kept_pieces.h"
#include "lattice/pool/pool_runner.h"
#include "lattice/statistics/group_spread.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;

/// The terms of a mean.
struct Terms {
  std::int64_t n = 0;
  double sum = 0.0, sizes = 0.0, largest = 0.0;
  void add(double x) {
    ++n;
    sum += x;
    sizes += std::abs(x);
    largest = std::max(largest, std::abs(x));
  }
  [[nodiscard]] double mean() const { return sum / static_cast<double>(n); }
  /// True if one term makes at least a tenth of the sum. Rarer terms may then be larger still, and
  /// the mean is not reliable.
  [[nodiscard]] bool few_make_it() const {
    constexpr double kMostOfOne = 0.1;
    return !(largest < kMostOfOne * sizes);
  }
};

/// The values after runs through changed cells, by sample; empty if the cells cannot be changed so.
struct ChangedRuns {
  std::vector<double> above, below;
  Health health;
};
template <class Archive>
void each_part(Archive& archive, ChangedRuns& runs) {
  archive(runs.above, runs.below, runs.health);
}

/// Number of states for which the passages of a chain and of its groups take 8 GiB.
double most_states(const FieldParams& field) {
  constexpr double kMostBytes = 8.0 * (1 << 30), kNumbers = 2.0 * 4.0;
  return kMostBytes /
         (kNumbers * sizeof(double) * field.columns * field.rows * std::max(1, field.max_gates));
}

class Parameters {
 public:
  Parameters(const Problem& problem, const AnalysedChain& chain, const ReactiveVisits& passages,
             const std::vector<ReactiveVisits>& groups, const ParameterOptions& options)
      : field_(problem.field), cells_(problem.cells), options_(options) {
    add_samples(chain, passages, options.runs);
    for (std::size_t g = 0; g < groups.size(); ++g)
      add_samples(chain.groups[g], groups[g], options.runs / std::ssize(groups));
  }

  /// Runs item `item`: 0 through the unchanged cells (result in `above`), k through cells with
  /// number k - 1 changed.
  [[nodiscard]] ChangedRuns run(std::int64_t item) const {
    ChangedRuns runs;
    if (item == 0) {
      runs.above = values(cells_.cells, runs.health);
      return runs;
    }
    const auto number = static_cast<std::size_t>(item - 1);
    if (std::all_of(cells_.cells.begin(), cells_.cells.end(),
                    [&](const auto& cell) { return cell->numbers()[number].value == 0.0; }))
      return runs;
    const double step = options_.relative_step;
    if (const Cells larger = changed(number, 1.0 + step); !larger.empty())
      runs.above = values(larger, runs.health);
    if (const Cells smaller = changed(number, 1.0 - step); !smaller.empty())
      runs.below = values(smaller, runs.health);
    return runs;
  }

  /// Takes the results of run(item), in the order of the items. Returns an effect if the number is
  /// not zero and can be changed.
  [[nodiscard]] std::optional<ParameterEffect> take(std::int64_t item, ChangedRuns runs) {
    health_ += runs.health;
    if (item == 0) {
      as_it_is_ = std::move(runs.above);
      return {};
    }
    const bool up = !runs.above.empty(), down = !runs.below.empty();
    if (!up && !down) return {};
    return effect(static_cast<std::size_t>(item - 1), up ? runs.above : as_it_is_,
                  down ? runs.below : as_it_is_, up, down);
  }
  [[nodiscard]] const Health& health() const { return health_; }

 private:
  [[nodiscard]] ParameterEffect effect(std::size_t number, const std::vector<double>& above,
                                       const std::vector<double>& below, bool up, bool down) const {
    const Cell::Number first = cells_.cells.front()->numbers()[number];
    double value = first.value;
    for (const auto& cell : cells_.cells)
      if (cell->numbers()[number].value != first.value) value = std::nan("");
    const double step = options_.relative_step;
    const auto used = [&](std::size_t i) {
      return std::isfinite(above[i] + below[i] + as_it_is_[i]);
    };
    const auto sides = [&](auto counted) {
      return Sides{terms(used, counted, [&](std::size_t i) { return above[i] - as_it_is_[i]; }),
                   terms(used, counted, [&](std::size_t i) { return as_it_is_[i] - below[i]; }),
                   terms(used, counted, [&](std::size_t i) { return above[i] - below[i]; })};
    };
    const auto all = [](std::size_t) { return true; };
    const Sides changes = sides(all);
    const auto more = [&](const Sides& s, std::size_t part) {
      return compounded(s.more[part].mean(), part) / step;
    };
    const auto less = [&](const Sides& s, std::size_t part) {
      return -compounded(-s.less[part].mean(), part) / step;
    };
    const auto both = [&](const Sides& s, std::size_t part) {
      return (more(s, part) + less(s, part)) / (up && down ? 2.0 : 1.0);
    };
    ParameterEffect e{first.key, value, {}, {}};
    e.left_out =
        1.0 - static_cast<double>(changes.both.front().n) / static_cast<double>(options_.runs);
    constexpr double kMostLeftOut = 0.05;
    const auto central = [&](const Sides& s) {
      const bool few = s.both.front().few_make_it() || e.left_out > kMostLeftOut;
      return of_parts(few, [&](std::size_t part) { return both(s, part); });
    };
    e.elasticity = central(changes);
    for (int type = 0; type < std::ssize(cells_.cells) && cells_.cells.size() > 1; ++type)
      e.of_type.push_back(central(sides([&](std::size_t i) { return samples_[i].type == type; })));
    e.more = up ? more(changes, 0) : std::nan("");
    e.less = down ? less(changes, 0) : std::nan("");
    const Mean95 bend = of_parts(changes.both.front().few_make_it(), [&](std::size_t part) {
      return more(changes, part) - less(changes, part);
    });
    constexpr double kSure = 1.5;  // in half-widths of 95 %: 9 in 1000 by chance
    e.bends = up && down && std::abs(bend.mean) > kSure * (bend.mean - bend.interval[0]);
    return e;
  }

  /// The samples of one chain: of all trials, or of a group of them.
  struct Part {
    const StateSpace& space;
    const ReactiveVisits& passages;
  };
  struct Sample {
    std::size_t part;
    ReactiveVisits::Place place;
    int type;
    Entry entry;
    double weight;  // importance weight of the sample
    double room;    // clearance in the unchanged gate
  };

  /// Random numbers of the analysis: for the samples' places, and for the noise of their runs.
  enum class Draw : std::uint64_t { place, noise };
  [[nodiscard]] Random drawn(Draw what, std::size_t sample) const {
    return {Purpose::sensitivity,
            {options_.seed, static_cast<std::uint64_t>(what), static_cast<std::uint64_t>(sample)}};
  }

  void add_samples(const AnalysedChain& chain, const ReactiveVisits& passages, std::int64_t count) {
    parts_.push_back({chain.space, passages});
    if (!(passages.at_start() > 0.0)) return;  // for a group: nothing is known
    const ReactiveVisits::Draws draws(passages);
    for (std::int64_t i = 0; i < count; ++i) {  // one from each of equal parts
      Random random = drawn(Draw::place, samples_.size());
      const ReactiveVisits::Place place =
          draws.place((static_cast<double>(i) + random.uniform()) / static_cast<double>(count));
      const auto column = static_cast<int>(place.cell % field_.columns),
                 row = static_cast<int>(place.cell / field_.columns);
      const int type = cells_.map.type_of(column, row);
      const Entry entry = chain.entry(place.input, random);
      samples_.push_back({parts_.size() - 1, place, type, entry, draws.weight(place),
                          cells_.cells[static_cast<std::size_t>(type)]->clearance(entry)});
    }
  }

  /// By part: terms of the relative changes of the probability, to first order.
  struct Sides {
    std::vector<Terms> more, less, both;
  };
  /// Terms of the samples for which used(sample) holds; all other samples add zero.
  template <class Used, class Counted, class Change>
  [[nodiscard]] std::vector<Terms> terms(Used used, Counted counted, Change change) const {
    std::vector<Terms> terms(parts_.size());
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      const Sample& s = samples_[i];
      if (used(i))
        terms[s.part].add(counted(i) ? s.weight * change(i) / parts_[s.part].passages.at_start()
                                     : 0.0);
    }
    return terms;
  }

  /// Changes in the gates along a way multiply: n equal small changes with the sum `sum`,
  /// compounded.
  [[nodiscard]] double compounded(double sum, std::size_t part) const {
    const double gates = parts_[part].passages.draws_to_target();
    return std::pow(std::max(0.0, 1.0 + sum / gates), gates) - 1.0;
  }

  /// The mean of `value(part)`: part 0 is the whole, the others are the groups. The spread of the
  /// groups contains the sampling error of as many runs as the whole has.
  template <class Value>
  [[nodiscard]] Mean95 of_parts(bool few_make_it, Value value) const {
    std::vector<double> groups;
    for (std::size_t part = 1; part < parts_.size() && !few_make_it; ++part)
      groups.push_back(value(part));
    return mean_95(value(0), groups);
  }

  using Cells = std::vector<std::shared_ptr<const Cell>>;  // by type

  /// The cells of all types with the number multiplied by `times`; empty if a type does not permit
  /// it.
  [[nodiscard]] Cells changed(std::size_t number, double times) const {
    Cells cells;
    for (const auto& cell : cells_.cells) {
      cells.push_back(cell->with(number, times));
      if (!cells.back()) return {};
    }
    return cells;
  }

  /// The probability of the target after a passage of each sample through these cells. NaN if the
  /// run broke, or if a changed cell blocks the entry, so that bodies would enter otherwise.
  [[nodiscard]] std::vector<double> values(const Cells& cells, Health& health) const {
    std::vector<double> out(samples_.size());
    for (int type = 0; type < std::ssize(cells); ++type) {
      const Cell& cell = *cells[static_cast<std::size_t>(type)];
      std::vector<std::size_t> here;
      for (std::size_t i = 0; i < samples_.size(); ++i) {
        if (samples_[i].type != type) continue;
        if (cell.clearance(samples_[i].entry) < std::min(0.0, samples_[i].room))
          out[i] = std::nan("");
        else
          here.push_back(i);
      }
      carry_out_trials(
          cell, std::ssize(here),
          [&](Body& body) {
            const std::size_t i = here[static_cast<std::size_t>(body.trial)];
            body.entry = samples_[i].entry;
            body.random = drawn(Draw::noise, i);
            cell.begin(body);
          },
          [&](Body& body, const Passage& passage) {
            const std::size_t i = here[static_cast<std::size_t>(body.trial)];
            out[i] = value_of(samples_[i], passage);
            return false;
          },
          health);
    }
    return out;
  }

  [[nodiscard]] double value_of(const Sample& s, const Passage& passage) const {
    const Part& part = parts_[s.part];
    const markov::EndingChance& chance = part.passages.chance();
    const auto is = [&](markov::Ending e) { return chance.ending() == e ? 1.0 : 0.0; };
    if (passage.fate == Fate::broken) return std::nan("");
    if (passage.fate == Fate::trapped) return is(markov::Ending::trapped);
    const Face& move = part.space.section().faces[static_cast<std::size_t>(passage.next.face)];
    const auto column = static_cast<int>(s.place.cell % field_.columns) + move.di_x,
               row = static_cast<int>(s.place.cell / field_.columns) + move.di_y;
    if (!field_.contains(column, row))
      return is(markov::edge_before({field_.columns, field_.rows}, column, row));
    return chance(s.place.draw + 1, std::int64_t{row} * field_.columns + column,
                  part.space.index_of(passage.next).state);
  }

  const FieldParams& field_;
  const CellField& cells_;
  const ParameterOptions& options_;
  std::vector<Part> parts_;  // of all trials, then of the groups
  std::vector<Sample> samples_;
  std::vector<double> as_it_is_;  // values in the unchanged cells
  Health health_;
};

}  // namespace

ParameterEffects parameter_effects(const Problem& problem, const AnalysedChain& chain,
                                   markov::Ending target, const ParameterOptions& options,
                                   const Work& work) {
  const Stopwatch watch;
  const char* const kRuns = "gate runs for parameters";
  if (problem.is_recorded())
    throw std::invalid_argument("parameters: runs were recorded, there is no cell to change");
  const std::size_t numbers = problem.cells.cells.front()->numbers().size();
  const auto [passages, groups] = all_reactive_visits(
      chain, problem.field, target, {.costs = false},
      {.costs = false, .tolerance = kGroupTolerance}, "chain for parameters", work);
  ParameterEffects out{.chance = passages.at_start(), .effects = {}, .health = {}};
  if (passages.at_start() > 0.0) {
    Parameters parameters(problem, chain, passages, groups, options);
    std::int64_t taken = 0;
    in_kept_pieces(
        work, {kRuns, {0, static_cast<std::int64_t>(numbers) + 1}}, std::vector<ChangedRuns>(),
        [&](TrialRange items) {
          std::vector<ChangedRuns> runs;
          for (std::int64_t k = 0; k < items.count; ++k)
            runs.push_back(parameters.run(items.first + k));
          return runs;
        },
        [&](std::vector<ChangedRuns> piece) {
          for (ChangedRuns& runs : piece)
            if (auto effect = parameters.take(taken++, std::move(runs)))
              out.effects.push_back(std::move(*effect));
        });
    out.health = parameters.health();
  }
  out.seconds = watch.seconds();
  return out;
}

ParameterEffects parameter_effects(const Problem& problem, RunPool& pool, markov::Ending target,
                                   const ParameterOptions& options, int per_leaf,
                                   std::int64_t most_runs, const Work& work) {
  const Stopwatch watch;
  constexpr std::int64_t kPoolOfRuns = 25;
  const std::size_t own = pool.place_of(problem.start);
  if (own == pool.starts.size())
    throw std::invalid_argument("parameters: the start has no runs of its own");
  const std::int64_t had = pool.gate_runs();
  PoolRunner runner(problem, options.seed, most_runs, work);
  const auto lacking = [&] {
    return static_cast<double>(std::min(kPoolOfRuns * options.runs - pool.gate_runs(),
                                        most_runs - runner.gate_runs)) /
           runner.gates_per_trial();  // known from the first trials
  };
  if (lacking() > 0.0) {
    do
      runner.run_full(pool.starts[own], runner.gate_runs == 0
                                            ? PoolRunner::kLeastTrials
                                            : static_cast<std::int64_t>(lacking()));
    while (lacking() > PoolRunner::kLeastTrials);
    runner.finish();
  }
  const auto runs = static_cast<double>(pool.gate_runs());
  const double leaf = std::max(per_leaf * std::sqrt(runs / static_cast<double>(had)),
                               2.0 * runs / most_states(problem.field));  // with mirror images
  const auto chain =
      analysed_chain(problem, pool, &pool.starts[own], static_cast<int>(std::ceil(leaf)));
  ParameterEffects out = parameter_effects(problem, chain, target, options, work);
  out.health += runner.health;
  out.added_runs = runner.gate_runs;
  out.pool_runs = pool.gate_runs();
  out.seconds = watch.seconds();
  return out;
}

}  // namespace gatewalk::lattice
