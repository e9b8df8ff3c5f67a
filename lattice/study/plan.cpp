// SPDX-License-Identifier: MIT
#include "lattice/study/plan.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <stdexcept>
#include <typeinfo>
#include <utility>

#include "dynamics/base/share.h"
#include "lattice/gate_chain.h"
#include "lattice/pool/run_pool.h"
#include "lattice/study/chosen_trials.h"
#include "markov/design.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;

/// What a body that enters there does.
using ActionChoice = std::function<int(const Place& place, const Entry& entry)>;

bool same_kinds(const CellField& a, const CellField& b) {
  return std::equal(a.cells.begin(), a.cells.end(), b.cells.begin(), b.cells.end(),
                    [](const auto& x, const auto& y) {
                      const Cell &one = *x, &other = *y;
                      return typeid(one) == typeid(other);
                    });
}

void require_actions(const std::vector<Action>& actions) {
  const auto require = [](bool fits, const std::string& what) {
    if (!fits) throw std::invalid_argument("plan: " + what);
  };
  require(actions.size() >= 2, "needs two actions at least");
  const Problem& first = actions.front().problem;
  for (const auto& [name, p] : actions) {
    require_cells(p.cells);
    require(p.map().section == first.map().section && same_kinds(p.cells, first.cells) &&
                p.width == first.width && p.length == first.length,
            "action " + name + " has cells of another kind");
    require(
        p.map().columns == first.map().columns && p.map().type_of_cell == first.map().type_of_cell,
        "action " + name + " has another map");
    require(p.field.columns == first.field.columns && p.field.rows == first.field.rows &&
                p.field.max_gates == first.field.max_gates,
            "action " + name + " has another field");
    require(p.start == first.start, "action " + name + " starts elsewhere");
  }
  require(actions.size() * first.map().types.size() <= 256,
          "more than 256 pairs of an action and a type of cell");
}

/// Each action's types of cells behind each other, as cells_of says.
CellChoice types_of(const Problem& first, int actions, const ActionChoice& choice) {
  return [&first, actions, choice](const Place& at, const Entry& entry) {
    return first.map().type_of(at.column, at.row) * actions + choice(at, entry);
  };
}

class Planner {
 public:
  Planner(const std::vector<Action>& actions, const PlanOptions& options, const Work& work)
      : actions_(actions),
        first_(actions.front().problem),
        cells_(cells_of(actions)),
        options_(options),
        work_(work),
        trials_("plan", cells_, first_, options.seed, work),
        count_(static_cast<std::int64_t>(
            std::ceil(std::pow(kNormal95 / (2.0 * options.accuracy), 2.0)))) {}

  [[nodiscard]] Plan carry_out() {
    trials_.add(
        run([&](const Place& at, const Entry&) { return any(at); }, actions() * count_ / 2));
    std::optional<Plan> best;
    for (;;) {
      // Small leaves tell ways to enter apart, large ones know better what each action does there.
      std::vector<Plan> plans;
      for (const int times : {1, 8, 64}) plans.push_back(choose(times * options_.per_leaf));
      for (int a = 0; a < actions(); ++a) plans.push_back(always(a, plans[2]));
      if (best) plans.push_back(std::move(*best));
      ++rounds_;
      std::vector<FieldTrials> trials;
      std::vector<std::int64_t> counts;
      const std::int64_t first = trials_.next();
      for (const Plan& plan : plans) {
        trials_.go_back_to(first);
        trials.push_back(run(choice_of(plan), count_));
        counts.push_back(crossings_of(trials.back()).crossed);
      }
      const auto most = std::max_element(counts.begin(), counts.end());
      // Rare crossings gain little of all trials, but much beside chance.
      const auto gained = static_cast<double>(*most - counts.back());
      const bool settled = rounds_ > 1 &&
                           gained <= 0.5 * options_.accuracy * static_cast<double>(count_) &&
                           gained <= 2.0 * std::sqrt(static_cast<double>(*most));
      const auto winner = static_cast<std::size_t>(most - counts.begin());
      trials_.add(trials[winner]);
      best = std::move(plans[winner]);
      best->settled = settled;
      if (settled || trials_.gate_runs() >= options_.most_runs) break;
      trials_.add(run(
          [&](const Place& at, const Entry& entry) {
            return word(at, 1) % kTries == 0 ? any(at) : best->policy.action(at, entry);
          },
          count_));
    }
    best->by_cell = choose_by_cell();
    judge(*best);
    return std::move(*best);
  }

 private:
  static constexpr std::uint64_t kTries = 4;   // other actions are tried: once in so many cells
  static constexpr double kMostBytes = 8.0e9;  // of decisions
  static constexpr double kMostBytesByCell = 2.0e9;  // of values, as markov::design has them

  [[nodiscard]] int actions() const { return static_cast<int>(actions_.size()); }
  [[nodiscard]] std::uint64_t word(const Place& at, std::uint64_t what) const {
    return trials_.word(Purpose::plan, at, what);
  }
  [[nodiscard]] int any(const Place& at) const {
    return static_cast<int>(word(at, 0) % static_cast<std::uint64_t>(actions()));
  }
  [[nodiscard]] static ActionChoice choice_of(const Plan& plan) {
    return [&plan](const Place& at, const Entry& entry) { return plan.policy.action(at, entry); };
  }

  [[nodiscard]] FieldTrials run(const ActionChoice& choice, std::int64_t count) {
    return trials_.run(types_of(first_, actions(), choice), count);
  }

  [[nodiscard]] double bytes_of(const StateSpace& space) const {
    return 2.0 * std::max(1, first_.field.max_gates) * first_.field.columns * first_.field.rows *
           space.size();
  }

  [[nodiscard]] static markov::Gains crossing() {
    markov::Gains gains;
    gains.ending[static_cast<std::size_t>(markov::Ending::far_edge)] = 1.0;
    return gains;
  }

  [[nodiscard]] Plan choose(int per_leaf) const {
    Kernel kernel = kernel_of(cells_.map, trials_.pool(), per_leaf);
    if (4.0 * bytes_of(kernel.space) > kMostBytes)  // of three sizes of leaves, and the best so far
      throw std::runtime_error(
          "plan: decisions for so many cells, states and gates do not fit into memory; a smaller "
          "field.max_gates (0: no limit) needs less");
    std::vector<markov::FieldChain> chains;
    for (std::size_t a = 0; a < actions_.size(); ++a) {
      std::vector<markov::Chain> of_types;
      for (std::size_t t = 0; t < first_.map().types.size(); ++t)
        of_types.push_back(markov::Chain::from_counts(kernel.counts[t * actions_.size() + a],
                                                      exits_of(kernel.space)));
      chains.push_back(field_chain(first_.map(), std::move(of_types)));
    }
    markov::Decisions best = markov::decide(chains, {first_.field.columns, first_.field.rows},
                                            crossing(), {.max_cells = first_.field.max_gates});
    const double says = best.value[best.at(first_.field.start_column(), 0,
                                           kernel.space.index_of(first_.start).state)];
    return {.policy = {std::move(kernel.space), std::move(best)}, .chain_says = says};
  }

  /// A map of types, all of them with all actions: searches from each action everywhere.
  [[nodiscard]] std::optional<Plan::ByCell> choose_by_cell() const {
    const FieldParams& field = first_.field;
    const Kernel kernel = kernel_of(cells_.map, trials_.pool(), 8 * options_.per_leaf);
    if (4.0 * bytes_of(kernel.space) > kMostBytesByCell) return {};  // a number for a decision
    std::vector<markov::Chain> chains;
    for (const markov::Counts& counts : kernel.counts)
      chains.push_back(markov::Chain::from_counts(counts, exits_of(kernel.space)));
    std::vector<std::vector<int>> everywhere(actions_.size());
    for (int row = 0; row < field.rows; ++row)
      for (int column = 0; column < field.columns; ++column)
        for (int a = 0; a < actions(); ++a)
          everywhere[static_cast<std::size_t>(a)].push_back(cells_.map.type_of(column, row) + a);
    markov::DesignOptions how{.max_cells = field.max_gates,
                              .most_changes = field.columns * field.rows,
                              .from = {everywhere.begin() + 1, everywhere.end()}};
    for (int type = 0; type < std::ssize(cells_.map.types); ++type)
      how.kind_of_type.push_back(type / actions());
    how.told = [this](std::size_t search) {
      work_.tell("searches for actions by gate", static_cast<std::int64_t>(search), actions());
    };
    const markov::Field size{field.columns, field.rows};
    const std::vector<int> best =
        markov::design(
            markov::FieldChain::by_cell(std::move(chains), field.columns, everywhere.front()), size,
            chain_start(kernel.space, field, first_.start).start, crossing(), how)
            .optima.front()
            .type_of_cell;
    const Section& section = kernel.space.section();
    StateSpace space(section, std::vector<Tree>(section.faces.size()), {});  // a leaf for each face
    markov::Decisions decisions{
        .field = size, .inputs = space.size(), .max_cells = field.max_gates};
    for (int draw = 0; draw < std::max(1, field.max_gates); ++draw)
      for (const int type : best)
        decisions.action.insert(decisions.action.end(), static_cast<std::size_t>(space.size()),
                                static_cast<std::uint16_t>(type % actions()));
    return Plan::ByCell{.policy = {std::move(space), std::move(decisions)}};
  }

  [[nodiscard]] static Plan always(int action, const Plan& like) {
    const markov::Decisions& d = like.policy.decisions;
    return {.policy = {like.policy.space,
                       {.field = d.field, .inputs = d.inputs, .max_cells = d.max_cells},
                       action},
            .chain_says = std::nan("")};
  }

  /// By trials that nothing was chosen by.
  void judge(Plan& plan) {
    const std::int64_t first = trials_.next();
    const FieldTrials own = run(choice_of(plan), count_);
    plan.crossings = crossings_of(own);
    plan.usage = usage_of(own);
    if (plan.by_cell) {
      trials_.go_back_to(first);
      const FieldTrials by_cell =
          run([&policy = plan.by_cell->policy](
                  const Place& at, const Entry& entry) { return policy.action(at, entry); },
              count_);
      plan.by_cell->crossings = crossings_of(by_cell);
      plan.by_cell->worth = gain_over(own, by_cell);
    }
    for (int a = 0; a < actions(); ++a) {
      trials_.go_back_to(first);
      const FieldTrials alone = run([a](const Place&, const Entry&) { return a; }, count_);
      plan.alone.push_back(crossings_of(alone));
      plan.gains.push_back(gain_over(own, alone));
    }
    plan.rounds = rounds_;
    plan.gate_runs = trials_.gate_runs();
    plan.health = trials_.health();
    for (const Action& a : actions_)
      if (a.problem.check)
        a.problem.check(plan.gate_runs / (10 * std::ssize(actions_)), options_.seed, plan.health,
                        work_);
  }

  [[nodiscard]] std::vector<double> usage_of(const FieldTrials& trials) const {
    const FieldParams& field = first_.field;
    const std::size_t cells =
        static_cast<std::size_t>(field.columns) * static_cast<std::size_t>(field.rows);
    std::vector<double> usage(actions_.size() * cells, 0.0);
    for (std::size_t i = 0; i < trials.passed.size(); ++i) {
      int column = field.start_column(), row = 0;
      for (const CellPassage& passage : trials.of_trial(i)) {
        usage[static_cast<std::size_t>(passage.type % actions()) * cells +
              static_cast<std::size_t>(row * field.columns + column)] +=
            1.0 / static_cast<double>(trials.passed.size());
        const Face& move = first_.map().section.faces[static_cast<std::size_t>(passage.entry.face)];
        column += move.di_x;
        row += move.di_y;
      }
    }
    return usage;
  }

  const std::vector<Action>& actions_;
  const Problem& first_;
  CellField cells_;
  const PlanOptions& options_;
  const Work& work_;
  ChosenTrials trials_;
  std::int64_t count_;  // trials of a plan in a round
  int rounds_ = 0;
};

}  // namespace

CellField cells_of(const std::vector<Action>& actions) {
  require_actions(actions);
  CellField field{actions.front().problem.map(), {}};
  field.map.types.clear();
  for (int& type : field.map.type_of_cell) type *= static_cast<int>(actions.size());
  for (std::size_t t = 0; t < actions.front().problem.map().types.size(); ++t)
    for (const Action& a : actions) {
      field.map.types.push_back(a.problem.map().types[t]);
      field.cells.push_back(a.problem.cells.cells[t]);
    }
  return field;
}

int Policy::action(const Place& place, const Entry& entry) const {
  if (place.column < 0 || place.column >= decisions.field.columns || place.row < 0 ||
      place.row >= decisions.field.rows || place.passed < 0 ||
      (decisions.max_cells > 0 && place.passed >= decisions.max_cells) || entry.face < 0 ||
      entry.face >= std::ssize(space.trees()))
    throw std::out_of_range("policy: is not made for this place, or this way to enter");
  if (always) return *always;
  return decisions
      .action[decisions.at(place.column, place.row, space.index_of(entry).state, place.passed)];
}

FieldTally policy_trials(const std::vector<Action>& actions, const Policy& policy,
                         TrialRange trials, std::uint64_t seed, const Work& work,
                         const TakeTrials& take) {
  const CellField cells = cells_of(actions);
  const Problem& first = actions.front().problem;
  const auto n = static_cast<int>(actions.size());
  const ActionChoice choice = [&](const Place& at, const Entry& entry) {
    const int action = policy.action(at, entry);
    if (action < 0 || action >= n) throw std::out_of_range("policy: takes an action of others");
    return action;
  };
  const CellChoice types = types_of(first, n, choice);
  FieldTally tally = field_trials(
      first.field, trials,
      [&](TrialRange range, FieldTrials& each) {
        return chosen_trials(cells, first, types, seed, range, each);
      },
      work, take);
  for (int a = 0; a < n; ++a)
    if (const auto& check = actions[static_cast<std::size_t>(a)].problem.check;
        check && policy.always.value_or(a) == a)
      check(policy.always ? trials.count : trials.count / n + 1, seed, tally.health, work);
  return tally;
}

Plan make_plan(const std::vector<Action>& actions, const PlanOptions& options, const Work& work) {
  if (!(options.accuracy >= 0.001 && options.accuracy < 0.5))
    throw std::invalid_argument("plan: accuracy must lie in [0.001, 0.5)");
  if (options.per_leaf < 1 || options.per_leaf > 1'000'000)
    throw std::invalid_argument("plan: leaves of 1 to 1000000 entries");
  require_actions(actions);
  return Planner(actions, options, work).carry_out();
}

}  // namespace gatewalk::lattice
