// SPDX-License-Identifier: MIT
#include "lattice/study/plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <string>
#include <typeinfo>
#include <utility>

#include "dynamics/base/share.h"
#include "lattice/field/gate_chain.h"
#include "lattice/field/running_trial.h"
#include "lattice/pool/kernel.h"
#include "lattice/study/choice_rounds.h"
#include "markov/design.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;

/// Passages may cost nothing, so that no least cost can be found.
struct FreePassages : std::runtime_error {
  using std::runtime_error::runtime_error;
};

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

/// The types of each action's cells, numbered as in cells_of. `choice`: of an action.
CellChoice types_of(const Problem& first, int actions, const CellChoice& choice) {
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
        rounds_("plan", Purpose::plan, cells_, first_, options.accuracy, options.most_runs,
                options.seed, work) {}

  [[nodiscard]] Plan carry_out() {
    rounds_.add(run(any(), actions() * rounds_.count() / 2));
    Tried best = best_for(0.0, {});
    std::vector<Tried> front;
    if (options_.thrift) {
      front.push_back(best);
      try {
        find_front(front);
      } catch (const FreePassages& e) {
        front_refused_ = e.what();
      }
    }
    if (options_.robust && best.plan.policy.always)
      best.plan.worst_case = worst_alone(static_cast<std::size_t>(*best.plan.policy.always));
    if (best.crossed > 0) best.plan.by_cell = best_by_cell();
    judge(best.plan, std::move(front));
    return std::move(best.plan);
  }

 private:
  static constexpr double kMostBytesByCell = 2.0e9;  // for the values of markov::design
  static constexpr double kMostSearched = 1.0e9;  // values times draws, over all maps: some seconds

  [[nodiscard]] int actions() const { return static_cast<int>(actions_.size()); }
  /// A random action, all with equal probability.
  [[nodiscard]] CellChoice any() const {
    return [this](const Place& at, const Entry&) {
      return static_cast<int>(rounds_.word(at, 0) % static_cast<std::uint64_t>(actions()));
    };
  }
  [[nodiscard]] static CellChoice choice_of(const Policy& policy) {
    return [&policy](const Place& at, const Entry& entry) { return policy.action(at, entry); };
  }

  /// A plan, the price that it was chosen for, and the results of the trials that it was chosen by.
  struct Tried {
    Plan plan;
    double price = 0.0;
    std::int64_t crossed = 0;
    double spent = 0.0;
    bool worth_little = false;  // at this price
  };
  /// The best plan at a price; `known`: plans to begin with.
  [[nodiscard]] Tried best_for(double price, std::vector<Plan> known) {
    const ChoiceAim aim{.price = price, .cost = options_.thrift ? options_.thrift->cost : 0};
    auto round = rounds_.choose_best(
        aim, [&] { return choose(price); },
        [&](const Plan& plan) { return run(choice_of(plan.policy)); },
        [&](const Plan& plan) { return run(rounds_.mostly(choice_of(plan.policy), any())); },
        std::move(known));
    const FieldTrials& trials = round.trials[round.winner].each;
    Tried best{std::move(round.candidates[round.winner]), price, crossings_of(trials).crossed,
               total_of(trials, aim.cost),
               rounds_.is_little(aim.worth(trials), aim.squares(trials))};
    best.plan.settled = round.settled;
    return best;
  }

  /// The policies that maximise P(cross) - price * cost, for prices from 0 to the price at which
  /// nothing is gained: there the cost per crossing is least (Dinkelbach 1967). Between two
  /// policies lies at most one for the price at which both are worth the same. `front` begins with
  /// the plan.
  void find_front(std::vector<Tried>& front) {
    const ThriftOptions& thrift = *options_.thrift;
    const auto has_room = [&] {
      return std::ssize(front) < thrift.points && rounds_.has_runs_left();
    };
    const auto tell = [&] {
      work_.tell("policies that take less", std::ssize(front), thrift.points);
    };
    while (has_room() && front.back().crossed > 0 && front.back().spent > 0.0) {
      tell();
      const Tried& last = front.back();
      const double price = static_cast<double>(last.crossed) / last.spent;
      Tried next = best_for(price, {last.plan});
      if (next.worth_little || next.spent >= last.spent) {
        front_finished_ = true;
        break;
      }
      front.push_back(std::move(next));
    }
    std::vector<char> closed(front.size(), 0);  // nothing lies between this one and the next
    while (has_room()) {
      tell();
      const auto at = widest(front, closed);
      if (!at) break;
      const Tried &more = front[*at], &less = front[*at + 1];
      const double price =
          static_cast<double>(more.crossed - less.crossed) / (more.spent - less.spent);
      Tried next = best_for(price, {more.plan, less.plan});
      if (next.crossed < more.crossed && next.crossed > less.crossed && next.spent < more.spent &&
          next.spent > less.spent) {
        front.insert(front.begin() + static_cast<std::ptrdiff_t>(*at) + 1, std::move(next));
        closed.insert(closed.begin() + static_cast<std::ptrdiff_t>(*at) + 1, 0);
      } else {
        closed[*at] = 1;
      }
    }
  }

  /// Index of the first of the two neighbours between which to search next: those around the
  /// probability asked for, or those whose probabilities differ most.
  [[nodiscard]] std::optional<std::size_t> widest(const std::vector<Tried>& front,
                                                  const std::vector<char>& closed) const {
    const double asked = options_.thrift->chance * static_cast<double>(rounds_.count());
    std::optional<std::size_t> best;
    std::int64_t most = 0;
    for (std::size_t i = 0; i + 1 < front.size(); ++i) {
      const std::int64_t more = front[i].crossed, less = front[i + 1].crossed;
      const bool beside =
          asked == 0.0 || (static_cast<double>(more) >= asked && static_cast<double>(less) < asked);
      if (closed[i] || !beside || more - less <= most) continue;
      most = more - less;
      best = i;
    }
    return best;
  }

  [[nodiscard]] RangeRuns run(const CellChoice& choice, std::int64_t count) {
    return rounds_.run({first_.start, types_of(first_, actions(), choice)}, count);
  }
  [[nodiscard]] RangeRuns run(const CellChoice& choice) { return run(choice, rounds_.count()); }

  /// Gains: 1 for crossing, minus the costs of passages at this price. In a state, an action that
  /// was never tried is worth less than any that was.
  [[nodiscard]] markov::Gains gains_of(const Kernel& kernel, double price) const {
    markov::Gains gains = gain_of_crossing();
    if (price == 0.0) return gains;
    const auto sums = cost_sums(kernel, cells_.map, rounds_.pool());
    std::vector<std::vector<double>> mean(kernel.counts.size());  // by type and state
    double most = 0.0;
    for (std::size_t type = 0; type < mean.size(); ++type) {
      auto passages = sums[type].begin();
      for (int state = 0; state < kernel.space.size(); ++state) {
        double runs = 0.0, spent = 0.0;
        for (markov::Counts::InnerIterator it(kernel.counts[type], state); it; ++it) {
          runs += static_cast<double>(it.value());
          spent += passages++->sum[options_.thrift->cost];
        }
        mean[type].push_back(spent / runs);
        if (runs == 0.0) continue;
        most = std::max(most, mean[type].back());
        if (first_.field.max_gates == 0 && !(spent > 0.0))
          throw FreePassages(first_.map().section.costs[options_.thrift->cost].words +
                             " of a passage may be 0 or less: policies that take least need "
                             "field.max_gates, or a cost that each passage has");
      }
    }
    const double untried = 1.0 + price * most * first_.field.columns * first_.field.rows;
    gains.draw.resize(actions_.size());
    for (std::size_t type = 0; type < mean.size(); ++type) {
      auto& of_type = gains.draw[type % actions_.size()].emplace_back();
      for (const double spent : mean[type])
        of_type.push_back(std::isnan(spent) ? -untried : -price * spent);
    }
    return gains;
  }

  /// Each action alone first, so that the simplest of equally good plans wins; then the choices of
  /// chains with leaves of each size.
  [[nodiscard]] std::vector<Plan> choose(double price) const {
    std::vector<Plan> chosen, plans;
    for (const int size : kLeafSizes) chosen.push_back(choose_by(size, price));
    for (int a = 0; a < actions(); ++a) plans.push_back(always(a, chosen.back()));
    std::move(chosen.begin(), chosen.end(), std::back_inserter(plans));
    return plans;
  }

  [[nodiscard]] Kernel kernel_with(int leaf_size) const {
    return kernel_of(cells_.map, rounds_.pool(), leaf_size * options_.per_leaf);
  }
  [[nodiscard]] Plan choose_by(int leaf_size, double price) const {
    Kernel kernel = kernel_with(leaf_size);
    const int kept = options_.thrift ? options_.thrift->points : 1;
    if ((3.0 + kept) * 2.0 * numbers_of(first_.field, kernel.space) > kMostDecisionBytes)
      throw too_large("plan: decisions for");  // for three sizes of leaves, and those kept
    std::vector<std::size_t> every_action(actions_.size());
    std::iota(every_action.begin(), every_action.end(), 0);
    markov::Decisions best = decide_among(every_action, kernel, gains_of(kernel, price));
    const double says = at_start(best, kernel.space);
    Plan plan{{}, {std::move(kernel.space), std::move(best)}, says};
    if (options_.robust) plan.worst_case = std::exchange(plan.chain_says, std::nan(""));
    return plan;
  }

  /// The worst-case worth of a single action, by leaves of the middle size: small leaves are too
  /// uncertain, large ones too coarse.
  [[nodiscard]] double worst_alone(std::size_t action) const {
    const Kernel kernel = kernel_with(kLeafSizes[1]);
    return at_start(decide_among({action}, kernel, gain_of_crossing()), kernel.space);
  }

  [[nodiscard]] double at_start(const markov::Decisions& d, const StateSpace& space) const {
    return d.value[d.at(first_.field.start_column(), first_.field.start_row,
                        space.index_of(first_.start).state)];
  }

  [[nodiscard]] markov::Decisions decide_among(const std::vector<std::size_t>& actions,
                                               const Kernel& kernel,
                                               const markov::Gains& gains) const {
    const std::vector<markov::Chain> by_type = chains_of(kernel);
    std::vector<markov::FieldChain> chains;
    markov::Doubt doubt;
    if (options_.robust) doubt.deviations = kNormal95;
    for (const std::size_t a : actions) {
      std::vector<markov::Chain> of_types;
      auto& runs = doubt.runs.emplace_back();
      for (std::size_t t = 0; t < first_.map().types.size(); ++t) {
        const std::size_t type = t * actions_.size() + a;
        of_types.push_back(by_type[type]);
        runs.push_back(runs_of(kernel.counts[type], cells_.map.types[type].symmetric));
      }
      chains.push_back(field_chain(first_.map(), std::move(of_types)));
    }
    return markov::decide(chains, {first_.field.columns, first_.field.rows}, gains,
                          {.max_cells = first_.field.max_gates, .doubt = std::move(doubt)});
  }

  /// Runs by row. A row may count a run and its mirror image, which is not another run.
  [[nodiscard]] static std::vector<double> runs_of(const markov::Counts& counts, bool symmetric) {
    std::vector<double> runs(static_cast<std::size_t>(counts.rows()), 0.0);
    for (int row = 0; row < counts.rows(); ++row)
      for (markov::Counts::InnerIterator it(counts, row); it; ++it)
        runs[static_cast<std::size_t>(row)] +=
            static_cast<double>(it.value()) / (symmetric ? 2 : 1);
    return runs;
  }

  /// Of the chain's policies by cell and each action everywhere, the one that crosses most often in
  /// new trials.
  [[nodiscard]] std::optional<Plan::ByCell> best_by_cell() {
    const auto cells = static_cast<std::size_t>(first_.field.columns) *
                       static_cast<std::size_t>(first_.field.rows);
    std::vector<std::vector<int>> maps;
    for (int a = 0; a < actions(); ++a) maps.emplace_back(cells, a);
    bool finished = false;
    if (std::optional<std::vector<int>> searched = search_by_cell(finished))
      maps.push_back(std::move(*searched));
    std::optional<Policy> best;
    std::int64_t most = -1;
    const std::int64_t first = rounds_.next();
    for (const std::vector<int>& map : maps) {
      Policy policy = by_cell(map);
      rounds_.go_back_to(first);
      if (const std::int64_t crossed = crossings_of(run(choice_of(policy)).each).crossed;
          crossed > most) {
        most = crossed;
        best = std::move(policy);
      }
    }
    return Plan::ByCell{.policy = std::move(*best), .searched = finished};
  }

  /// The best action by cell, as a map of types among all types under all actions; the search
  /// begins with each action everywhere. nullopt if memory or time do not suffice.
  [[nodiscard]] std::optional<std::vector<int>> search_by_cell(bool& finished) const {
    const FieldParams& field = first_.field;
    const Kernel kernel = kernel_with(kLeafSizes[1]);
    finished = false;
    const double draws = field.max_gates > 0 ? field.max_gates : field.columns + field.rows;
    const double most_solves =
        kMostSearched / (draws * field.columns * field.rows * kernel.space.size());
    if (8.0 * numbers_of(first_.field, kernel.space) > kMostBytesByCell ||
        most_solves < 2.0 * actions())
      return {};
    std::vector<std::vector<int>> everywhere(actions_.size());
    for (int row = 0; row < field.rows; ++row)
      for (int column = 0; column < field.columns; ++column)
        for (int a = 0; a < actions(); ++a)
          everywhere[static_cast<std::size_t>(a)].push_back(cells_.map.type_of(column, row) + a);
    markov::DesignOptions search{.max_cells = field.max_gates,
                                 .most_changes = field.columns * field.rows,
                                 .from = {everywhere.begin() + 1, everywhere.end()}};
    for (int type = 0; type < std::ssize(cells_.map.types); ++type)
      search.kind_of_type.push_back(type / actions());
    search.told = [this](std::size_t done) {
      work_.tell("searches for actions by gate", static_cast<std::int64_t>(done), actions());
    };
    search.most_solves = static_cast<std::int64_t>(most_solves);
    markov::Designs best = markov::design(
        markov::FieldChain::by_cell(chains_of(kernel), field.columns, everywhere.front()),
        {field.columns, field.rows}, chain_start(kernel.space, field, first_.start).start,
        gain_of_crossing(), search);
    finished = best.finished;
    std::vector<int> action = std::move(best.optima.front().type_of_cell);
    for (int& type : action) type %= actions();
    return action;
  }

  /// The policy that takes the map's action, whatever a body's entry and number of cells passed.
  [[nodiscard]] Policy by_cell(const std::vector<int>& map) const {
    const Section& section = first_.map().section;
    StateSpace space(section, std::vector<Tree>(section.faces.size()), {});  // a leaf for each face
    markov::Decisions decisions{.field = {first_.field.columns, first_.field.rows},
                                .inputs = space.size(),
                                .max_cells = first_.field.max_gates};
    for (int draw = 0; draw < std::max(1, first_.field.max_gates); ++draw)
      for (const int action : map)
        decisions.action.insert(decisions.action.end(), static_cast<std::size_t>(space.size()),
                                static_cast<std::uint16_t>(action));
    return {std::move(space), std::move(decisions)};
  }

  [[nodiscard]] static Plan always(int action, const Plan& like) {
    const markov::Decisions& d = like.policy.decisions;
    return {{},
            {like.policy.space,
             {.field = d.field, .inputs = d.inputs, .max_cells = d.max_cells},
             action},
            std::nan("")};
  }

  /// True if the policy takes `action_in(column, row)` in every cell, for all entries.
  template <class ActionIn>
  [[nodiscard]] static bool always_takes(const Policy& policy, ActionIn action_in) {
    const markov::Decisions& d = policy.decisions;
    for (int row = 0; row < d.field.rows; ++row)
      for (int column = 0; column < d.field.columns; ++column) {
        const int wanted = action_in(column, row);
        if (policy.always && *policy.always != wanted) return false;
        for (int draws = 0; !policy.always && draws < std::max(1, d.max_cells); ++draws)
          for (int input = 0; input < d.inputs; ++input)
            if (d.action[d.at(column, row, input, draws)] != wanted) return false;
      }
    return true;
  }

  /// Judges the plan by held-out trials.
  void judge(Plan& plan, std::vector<Tried> front) {
    const std::int64_t first = rounds_.next();
    const FieldTrials own = run(choice_of(plan.policy)).each;
    plan.crossings = crossings_of(own);
    plan.usage = usage_of(own);
    if (plan.by_cell) {
      rounds_.go_back_to(first);
      const FieldTrials by_cell = run(choice_of(plan.by_cell->policy)).each;
      plan.by_cell->crossings = crossings_of(by_cell);
      const markov::Decisions& d = plan.by_cell->policy.decisions;
      const bool same = always_takes(plan.policy, [&](int column, int row) {
        return static_cast<int>(d.action[d.at(column, row, 0)]);
      });
      plan.by_cell->worth = same ? Gain::over_itself() : gain_over(own, by_cell);
    }
    for (int a = 0; a < actions(); ++a) {
      rounds_.go_back_to(first);
      const FieldTrials alone = run([a](const Place&, const Entry&) { return a; }).each;
      plan.alone.push_back(crossings_of(alone));
      const bool same = always_takes(plan.policy, [a](int, int) { return a; });
      plan.gains.push_back(same ? Gain::over_itself() : gain_over(own, alone));
    }
    for (Tried& point : front) {
      rounds_.go_back_to(first);
      const FieldTrials trials = run(choice_of(point.plan.policy)).each;
      plan.front.push_back({point.price, std::move(point.plan.policy), crossings_of(trials),
                            spent_by(trials, options_.thrift->cost)});
    }
    // Removes points that another point beats in both numbers: they were chosen by chance.
    for (std::size_t i = plan.front.size(); i-- > 1;)
      if (std::any_of(plan.front.begin(), plan.front.end(), [&, i](const FrontPoint& other) {
            const FrontPoint& point = plan.front[i];
            return &other != &point && other.crossings.crossed >= point.crossings.crossed &&
                   other.spent.mean <= point.spent.mean;
          }))
        plan.front.erase(plan.front.begin() + static_cast<std::ptrdiff_t>(i));
    plan.front_finished = front_finished_;
    plan.front_refused = front_refused_;
    static_cast<ChoiceSummary&>(plan) = rounds_.summary(plan.settled);
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
      int column = field.start_column(), row = field.start_row;
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
  ChoiceRounds rounds_;
  bool front_finished_ = false;
  std::string front_refused_;
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
  const CellChoice choice = [&](const Place& at, const Entry& entry) {
    const int action = policy.action(at, entry);
    if (action < 0 || action >= n) throw std::out_of_range("policy: takes an action of others");
    return action;
  };
  const TypeChoice types{first.start, types_of(first, n, choice)};
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
  require_choice_options("plan", options.accuracy, options.per_leaf);
  require_actions(actions);
  if (options.robust && options.thrift)
    throw std::invalid_argument("plan: robust policies that take less are not found");
  if (const auto& thrift = options.thrift) {
    if (thrift->cost >= actions.front().problem.map().section.costs.size())
      throw std::invalid_argument("plan: there is no such cost");
    if (thrift->points < 1 || thrift->points > 100)
      throw std::invalid_argument("plan: a front of 1 to 100 policies");
    if (!(thrift->chance >= 0.0 && thrift->chance < 1.0))
      throw std::invalid_argument("plan: a chance to cross lies in [0, 1)");
  }
  return Planner(actions, options, work).carry_out();
}

}  // namespace gatewalk::lattice
