// SPDX-License-Identifier: MIT
#include "lattice/study/design.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "dynamics/base/share.h"
#include "lattice/field/gate_chain.h"
#include "lattice/field/running_trial.h"
#include "lattice/study/choice_rounds.h"
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
        rounds_("design", Purpose::design, problem.cells, problem, options.accuracy,
                options.most_runs, options.seed, work) {
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
    const CellChoice other = [&](const Place& at, const Entry&) { return any(at); };
    rounds_.add(
        rounds_.run({problem_.start, other}, (std::ssize(become_) + 1) * rounds_.count() / 2));
    auto round = rounds_.choose_best<DesignedField>(
        {.rarely = options_.least}, [&] { return choose(); },
        [&](const DesignedField& field) { return run(types_of(field.type_of_cell)); },
        [&](const DesignedField& field) {
          return run(rounds_.mostly(types_of(field.type_of_cell), other));
        });
    DesignedField best = std::move(round.candidates[round.winner]);
    judge(best, round.settled);
    return best;
  }

 private:
  static constexpr double kMostBytes = 2.0e9;  // for the values of markov::design

  [[nodiscard]] std::size_t cell_of(const Place& at) const {
    return static_cast<std::size_t>(at.row * problem_.field.columns + at.column);
  }
  /// A random one of the permitted types, or the cell's own.
  [[nodiscard]] int any(const Place& at) const {
    const auto drawn = rounds_.word(at, 0) % (become_.size() + 1);
    return drawn < become_.size() ? become_[drawn] : own_[cell_of(at)];
  }
  [[nodiscard]] CellChoice types_of(const Map& map) const {
    return [this, &map](const Place& at, const Entry&) { return map[cell_of(at)]; };
  }
  [[nodiscard]] RangeRuns run(const CellChoice& types) {
    return rounds_.run({problem_.start, types}, rounds_.count());
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

  /// The unchanged field, and the choices of chains with leaves of each size. Among equals the
  /// first wins: no change without a gain.
  [[nodiscard]] std::vector<DesignedField> choose() {
    std::vector<DesignedField> fields(1);
    for (const int size : kLeafSizes)
      if (auto chosen = choose_by(size)) fields.push_back(std::move(*chosen));
    if (fields.size() == 1) throw too_large("design: values for");
    fields[0].type_of_cell = own_;
    fields[0].by_chain = fields.back().by_chain;
    return fields;
  }

  /// nullopt if the values do not fit into memory.
  [[nodiscard]] std::optional<DesignedField> choose_by(int leaf_size) {
    const Kernel kernel = kernel_of(problem_.map(), rounds_.pool(), leaf_size * options_.per_leaf);
    if (8.0 * numbers_of(problem_.field, kernel.space) > kMostBytes) return {};
    const FieldParams& field = problem_.field;
    markov::Gains gains = gain_of_crossing();
    // Unknown outcomes must not speak for a type.
    gains.ending[static_cast<std::size_t>(markov::Ending::unsampled)] = options_.least ? 1.0 : 0.0;
    const markov::Field size{field.columns, field.rows};
    const markov::Start start = chain_start(kernel.space, field, problem_.start).start;
    const auto chain = markov::FieldChain::by_cell(chains_of(kernel), field.columns, own_);
    const std::vector<Map> maps = drawn_maps();
    DesignedField designed;
    designed.by_chain =
        markov::design(chain, size, start, gains,
                       {.max_cells = field.max_gates,
                        .least = options_.least,
                        .most_changes = options_.most_changes,
                        .become = become_,
                        .from = maps,
                        .told = [&](std::size_t search) {
                          work_.tell("searches for a design", static_cast<std::int64_t>(search),
                                     std::ssize(maps) + 1);
                        }});
    solves_ += designed.by_chain.solves;
    // The reported value is the probability to cross only.
    const auto crosses = [&](const Map& map) {
      return markov::predict(markov::FieldChain::by_cell(chain.chains(), field.columns, map), size,
                             {start}, {.max_cells = field.max_gates})[0]
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

  /// Judges a field by held-out trials.
  void judge(DesignedField& best, bool settled) {
    const std::int64_t first = rounds_.next();
    const FieldTrials with = run(types_of(best.type_of_cell)).each;
    rounds_.go_back_to(first);
    const FieldTrials without = run(types_of(own_)).each;
    best.crossings = crossings_of(with);
    best.before = crossings_of(without);
    best.gain = best.type_of_cell == own_ ? Gain::over_itself() : gain_over(with, without);
    best.by_chain.solves = solves_;
    static_cast<ChoiceSummary&>(best) = rounds_.summary(settled);
    if (problem_.check) problem_.check(best.gate_runs / 10, options_.seed, best.health, work_);
  }

  const Problem& problem_;
  const FieldDesignOptions& options_;
  const Work& work_;
  ChoiceRounds rounds_;
  Map own_;
  std::vector<int> become_;
  std::int64_t solves_ = 0;
};

}  // namespace

DesignedField design_field(const Problem& problem, const FieldDesignOptions& options,
                           const Work& work) {
  const auto require = [](bool holds, const std::string& what) {
    if (!holds) throw std::invalid_argument("design: " + what);
  };
  require_choice_options("design", options.accuracy, options.per_leaf);
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
