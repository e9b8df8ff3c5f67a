// SPDX-License-Identifier: MIT
#include "lattice/study/design.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "dynamics/base/share.h"
#include "lattice/gate_chain.h"
#include "lattice/study/chosen_trials.h"
#include "markov/predict.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;

class FieldDesigner {
  using Map = std::vector<int>;

 public:
  FieldDesigner(const Problem& problem, const FieldDesignOptions& options, const Work& work)
      : problem_(problem),
        options_(options),
        work_(work),
        trials_("design", problem.cells, problem, options.seed, work),
        count_(static_cast<std::int64_t>(
            std::ceil(std::pow(kNormal95 / (2.0 * options.accuracy), 2.0)))) {
    const FieldParams& field = problem.field;
    for (int row = 0; row < field.rows; ++row)
      for (int column = 0; column < field.columns; ++column)
        own_.push_back(problem.map().type_of(column, row));
    become_ = options.become;
    if (become_.empty())
      for (int type = 0; type < std::ssize(problem.map().types); ++type) become_.push_back(type);
    std::sort(become_.begin(), become_.end());
    become_.erase(std::unique(become_.begin(), become_.end()), become_.end());
  }

  [[nodiscard]] DesignedField carry_out() {
    trials_.add(trials_.run([&](const Place& at, const Entry&) { return any(at); },
                            (std::ssize(become_) + 1) * count_ / 2));
    std::optional<DesignedField> best;
    for (;;) {
      // Small leaves tell ways to enter apart, large ones know better what each type does there.
      std::vector<DesignedField> fields(1);
      for (const int times : {1, 8, 64})
        if (auto chosen = choose(times * options_.per_leaf)) fields.push_back(std::move(*chosen));
      if (fields.size() == 1)
        throw std::runtime_error(
            "design: values for so many cells, states and gates do not fit into memory; a smaller "
            "field.max_gates (0: no limit) needs less");
      // Of several that cross as often the first: no change without a gain.
      fields[0] = {.type_of_cell = own_, .by_chain = fields.back().by_chain};
      if (best) fields.push_back(std::move(*best));
      ++rounds_;
      std::vector<FieldTrials> trials;
      std::vector<std::int64_t> counts;  // the more the better
      const std::int64_t first = trials_.next();
      for (const DesignedField& f : fields) {
        trials_.go_back_to(first);
        trials.push_back(run(f.type_of_cell, count_));
        const std::int64_t crossed = crossings_of(trials.back()).crossed;
        counts.push_back(options_.least ? -crossed : crossed);
      }
      const auto most = std::max_element(counts.begin(), counts.end());
      // Rare crossings gain little of all trials, but much beside chance.
      const auto gained = static_cast<double>(*most - counts.back());
      const auto larger = static_cast<double>(std::max(std::abs(*most), std::abs(counts.back())));
      const bool settled = rounds_ > 1 &&
                           gained <= 0.5 * options_.accuracy * static_cast<double>(count_) &&
                           gained <= 2.0 * std::sqrt(larger);
      const auto winner = static_cast<std::size_t>(most - counts.begin());
      trials_.add(trials[winner]);
      best = std::move(fields[winner]);
      best->settled = settled;
      if (settled || trials_.gate_runs() >= options_.most_runs) break;
      trials_.add(trials_.run(
          [&](const Place& at, const Entry&) {
            return trials_.word(Purpose::design, at, 1) % kTries == 0
                       ? any(at)
                       : best->type_of_cell[cell_of(at)];
          },
          count_));
    }
    judge(*best);
    return std::move(*best);
  }

 private:
  static constexpr std::uint64_t kTries = 4;   // other types are tried: once in so many cells
  static constexpr double kMostBytes = 2.0e9;  // of values, as markov::design has them

  [[nodiscard]] std::size_t cell_of(const Place& at) const {
    return static_cast<std::size_t>(at.row * problem_.field.columns + at.column);
  }
  /// One of those that may stand there.
  [[nodiscard]] int any(const Place& at) const {
    const auto drawn = trials_.word(Purpose::design, at, 0) % (become_.size() + 1);
    return drawn < become_.size() ? become_[drawn] : own_[cell_of(at)];
  }
  [[nodiscard]] FieldTrials run(const Map& map, std::int64_t count) {
    return trials_.run([&](const Place& at, const Entry&) { return map[cell_of(at)]; }, count);
  }

  [[nodiscard]] std::vector<Map> drawn_maps() const {
    std::vector<Map> maps;
    for (int search = 0; search < options_.searches; ++search) {
      Random random(Purpose::design, {options_.seed, 0, static_cast<std::uint64_t>(search)});
      Map map = own_;
      for (int i = 0; i < options_.most_changes; ++i)
        map[static_cast<std::size_t>(random.below(std::ssize(map)))] =
            become_[static_cast<std::size_t>(random.below(std::ssize(become_)))];
      maps.push_back(std::move(map));
    }
    return maps;
  }

  /// None where it does not fit into memory.
  [[nodiscard]] std::optional<DesignedField> choose(int per_leaf) {
    Kernel kernel = kernel_of(problem_.map(), trials_.pool(), per_leaf);
    if (8.0 * std::max(1, problem_.field.max_gates) * static_cast<double>(own_.size()) *
            kernel.space.size() >
        kMostBytes)
      return {};
    std::vector<markov::Chain> chains;
    for (const markov::Counts& counts : kernel.counts)
      chains.push_back(markov::Chain::from_counts(counts, exits_of(kernel.space)));
    const FieldParams& field = problem_.field;
    markov::Gains gains;
    gains.ending[static_cast<std::size_t>(markov::Ending::far_edge)] = 1.0;
    // What is not known is no reason to choose a type.
    gains.ending[static_cast<std::size_t>(markov::Ending::unsampled)] = options_.least ? 1.0 : 0.0;
    const markov::Field size{field.columns, field.rows};
    const markov::Start start = chain_start(kernel.space, field, problem_.start).start;
    const auto chain = markov::FieldChain::by_cell(std::move(chains), field.columns, own_);
    const std::vector<Map> from = drawn_maps();
    DesignedField designed;
    designed.by_chain =
        markov::design(chain, size, start, gains,
                       {.max_cells = field.max_gates,
                        .least = options_.least,
                        .most_changes = options_.most_changes,
                        .become = become_,
                        .from = from,
                        .told = [&](std::size_t search) {
                          work_.tell("searches for a design", static_cast<std::int64_t>(search),
                                     std::ssize(from) + 1);
                        }});
    solves_ += designed.by_chain.solves;
    // What is told is the chance to cross alone.
    const auto crosses = [&](const Map& map) {
      markov::PredictOptions how;
      how.max_cells = field.max_gates;
      return markov::predict(markov::FieldChain::by_cell(chain.chains(), field.columns, map), size,
                             {start}, how)[0]
          .endings[static_cast<std::size_t>(markov::Ending::far_edge)];
    };
    if (options_.least) {
      designed.by_chain.before = crosses(own_);
      for (markov::FieldDesign& optimum : designed.by_chain.optima)
        optimum.gain = crosses(optimum.type_of_cell);
    }
    designed.type_of_cell = designed.by_chain.optima.front().type_of_cell;
    return designed;
  }

  /// By trials that nothing was chosen by.
  void judge(DesignedField& best) {
    const std::int64_t first = trials_.next();
    const FieldTrials with = run(best.type_of_cell, count_);
    trials_.go_back_to(first);
    const FieldTrials without = run(own_, count_);
    best.crossings = crossings_of(with);
    best.before = crossings_of(without);
    best.gain = best.type_of_cell == own_ ? Gain::over_itself() : gain_over(with, without);
    best.by_chain.solves = solves_;
    best.rounds = rounds_;
    best.gate_runs = trials_.gate_runs();
    best.health = trials_.health();
    if (problem_.check) problem_.check(best.gate_runs / 10, options_.seed, best.health, work_);
  }

  const Problem& problem_;
  const FieldDesignOptions& options_;
  const Work& work_;
  ChosenTrials trials_;
  std::int64_t count_;  // trials of a field in a round
  Map own_;
  std::vector<int> become_;
  int rounds_ = 0;
  std::int64_t solves_ = 0;
};

}  // namespace

DesignedField design_field(const Problem& problem, const FieldDesignOptions& options,
                           const Work& work) {
  const auto require = [](bool holds, const std::string& what) {
    if (!holds) throw std::invalid_argument("design: " + what);
  };
  require(options.accuracy >= 0.001 && options.accuracy < 0.5, "accuracy must lie in [0.001, 0.5)");
  require(options.per_leaf >= 1 && options.per_leaf <= 1'000'000, "leaves of 1 to 1000000 entries");
  require(options.searches >= 0, "searches must be at least 0");
  require_cells(problem.cells);
  const auto types = std::ssize(problem.map().types);
  require(types >= 2, "the field has cells of one type only");
  for (const int type : options.become)
    require(type >= 0 && type < types, "there is no such type to become");
  const std::int64_t cells = std::int64_t{problem.field.columns} * problem.field.rows;
  require(options.most_changes >= 1 && options.most_changes <= cells,
          "1 to " + std::to_string(cells) + " cells can be changed");
  problem.map().require_fits(problem.field.columns, problem.field.rows);
  if (const std::vector<int>& to = options.become, &map = problem.map().type_of_cell;
      to.size() == 1)
    require(map.empty() ? to[0] != 0 : std::count(map.begin(), map.end(), to[0]) < std::ssize(map),
            "all cells have the type that they may become");
  return FieldDesigner(problem, options, work).carry_out();
}

}  // namespace gatewalk::lattice
