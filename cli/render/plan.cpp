// SPDX-License-Identifier: MIT
#include "cli/render/plan.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "cli/render/choice.h"
#include "cli/render/final_gates.h"
#include "cli/render/quantity.h"
#include "cli/render/text.h"
#include "cli/render/text_table.h"

namespace gatewalk::cli {
namespace {

constexpr int kMostPrinted = 40;  // columns and rows of a map in the table
constexpr int kFewVisits = 10;    // of all trials: maps leave out what fewer show

std::size_t cells_in(const PlannedField& p) {
  return static_cast<std::size_t>(p.shown.field.columns) *
         static_cast<std::size_t>(p.shown.field.rows);
}

/// How often an action is taken, per trial: (rows x columns).
markov::CellProbabilities usage_of(const PlannedField& p, std::size_t action) {
  return Eigen::Map<const markov::CellProbabilities>(p.plan.usage.data() + action * cells_in(p),
                                                     p.shown.field.rows, p.shown.field.columns);
}

/// What stands for an action in a map.
constexpr std::string_view kMarks = "123456789abcdefghijklmnopqrstuvwxyz";
char mark_of(std::size_t action) { return action < kMarks.size() ? kMarks[action] : ' '; }

/// A mark for each cell, the far row first.
std::string map_text(const PlannedField& p) {
  const int columns = p.shown.field.columns, rows = p.shown.field.rows;
  if (columns > kMostPrinted || rows > kMostPrinted || p.actions.size() > kMarks.size()) return "";
  const std::vector<MostTaken> most = most_taken(p);
  std::string text = fmt::format(
      "\nthe action that is taken most in each gate (.: fewer than {} of {} bodies came), far row "
      "first:\n",
      kFewVisits, p.plan.crossings.trials);
  for (int r = rows; r-- > 0;) {
    text += fmt::format("{:>4} ", r);
    for (int c = 0; c < columns; ++c) {
      const MostTaken& here = most[static_cast<std::size_t>(r * columns + c)];
      text += {' ', here.shown ? mark_of(static_cast<std::size_t>(here.action)) : '.'};
    }
    text += "\n";
  }
  return text;
}

/// What the plan gains, in a sentence.
std::string verdict(const PlannedField& p) {
  const std::size_t best = best_alone(p.plan);
  const lattice::Gain& gain = p.plan.gains[best];
  const std::string &name = p.actions[best], points = gain_text(gain);
  if (const auto& always = p.plan.policy.always)
    return fmt::format("the best that was found is to take {} all the time\n",
                       p.actions[static_cast<std::size_t>(*always)]);
  if (gain.interval_95[1] < 0.0)
    return fmt::format(
        "the plan is worse than {} all the time, {} points: chosen by chance; a smaller --accuracy "
        "helps\n",
        name, points);
  if (gain.interval_95[0] > 0.0)
    return fmt::format("choosing by the way in gains {} points over {} all the time\n", points,
                       name);
  return fmt::format(
      "choosing by the way in is not shown to gain anything over {} all the time: {} points; a "
      "smaller --accuracy\nshows a smaller gain, if there is one\n",
      name, points);
}

std::string worst_text(const lattice::Plan& plan) {
  if (!plan.worst_case) return "";
  return fmt::format("with each row 1.96 standard errors worse than counted: {} %\n",
                     fixed(100.0 * *plan.worst_case, 2));
}

const dynamics::CostInfo& cost_of(const PlannedField& p) {
  return p.shown.map.section.costs[p.thrift->cost];
}

std::string front_text(const PlannedField& p) {
  if (!p.thrift) return "";
  const dynamics::CostInfo& cost = cost_of(p);
  const auto amount = [&](double x) {
    return std::isinf(x) ? std::string("no end") : quantity(x, cost.unit, 3);
  };
  const auto between = [&](double mean, const std::array<double, 2>& interval) {
    if (std::isnan(interval[0]) && std::isfinite(mean)) return amount(mean) + " (few trials)";
    return fmt::format("{} [{}, {}]", amount(mean), amount(interval[0]), amount(interval[1]));
  };
  if (p.plan.front.size() < 2)
    return fmt::format("\nno policy was found that takes less for each crossing ({})\n",
                       cost.words);
  TextTable table(
      {{"", -2}, {"crossed, %", 22}, {"a trial takes", 32}, {"each crossing takes", 32}});
  const std::optional<std::size_t> chosen = cheapest(p);
  for (std::size_t i = 0; i < p.plan.front.size(); ++i) {
    const auto& [price, policy, crossings, spent] = p.plan.front[i];
    table.row({chosen == i ? "*" : "", with_interval(crossings.share(), crossings.interval_95()),
               between(spent.mean, spent.mean_95),
               between(spent.per_crossing, spent.per_crossing_95)});
  }
  return fmt::format("\npolicies that take less ({}), under the same noise:\n\n{}", cost.words,
                     table.text());
}

/// The action that is taken most in each gate; none where nobody came.
TextRows most_taken_rows(const PlannedField& p) {
  const std::vector<MostTaken> most = most_taken(p);
  TextRows rows(static_cast<std::size_t>(p.shown.field.rows));
  for (std::size_t cell = 0; cell < most.size(); ++cell) {
    auto& row = rows[cell / static_cast<std::size_t>(p.shown.field.columns)];
    row.emplace_back();
    if (const int action = most[cell].action; action >= 0)
      row.back() = p.actions[static_cast<std::size_t>(action)];
  }
  return rows;
}

/// The action that a policy of gates alone takes in each.
TextRows action_rows(const PlannedField& p, const markov::Decisions& d) {
  TextRows rows(static_cast<std::size_t>(d.field.rows));
  for (int r = 0; r < d.field.rows; ++r)
    for (int c = 0; c < d.field.columns; ++c)
      rows[static_cast<std::size_t>(r)].emplace_back(p.actions[d.action[d.at(c, r, 0)]]);
  return rows;
}

void describe_action(Fields& out, const PlannedField& p, std::size_t a) {
  out.text({"name", "name of the action"}, p.actions[a]);
  describe_crossed(out, "share of trials that crossed when bodies took this action all the time",
                   p.plan.alone[a]);
  describe_gain(
      out, "share crossed by the plan less that of this action all the time, under the same noise",
      p.plan.gains[a]);
  out.grid({"taken", "1",
            "mean number of times that a trial of the plan takes this action in each gate"},
           usage_of(p, a));
  describe_method(out, p.methods[a]);
}

void describe_front(Fields& out, const PlannedField& p) {
  const dynamics::CostInfo& cost = cost_of(p);
  out.text({"least", "key of the cost that the policies of front save"}, cost.key);
  out.list_of(
      {"front",
       "policies from the plan to the one that costs least for each crossing, by rising price"},
      p.plan.front.size(), [&](Fields& policy, std::size_t i) {
        const auto& [price, does, crossings, spent] = p.plan.front[i];
        policy.number({"price", "1 / unit of least",
                       "the policy maximises P(cross) - price x cost; per unit of the cost in "
                       "least; 0: the plan"},
                      price);
        describe_crossed(policy, "share of trials that crossed under this policy", crossings);
        policy.estimate(
            {"mean", "its own",
             "mean cost of a trial, however the trial ends; unit: that of the cost in least"},
            spent.mean, spent.mean_95);
        policy.estimate(
            {"per_crossing", "its own",
             "cost of all trials divided by the number that crossed; null: none crossed"},
            spent.per_crossing, spent.per_crossing_95);
        policy.flag(
            {"chosen",
             "whether it has the least mean of the policies whose crossed is at least --chance"},
            cheapest(p) == i);
      });
  out.flag({"front_finished",
            "whether the search for a lower per_crossing ended; no: the limit of runs or points "
            "came first"},
           p.plan.front_finished);
}

}  // namespace

std::optional<std::size_t> cheapest(const PlannedField& p) {
  std::optional<std::size_t> best;
  if (!p.thrift || p.thrift->chance == 0.0) return best;
  for (std::size_t i = 0; i < p.plan.front.size(); ++i)
    if (p.plan.front[i].crossings.share() >= p.thrift->chance &&
        (!best || p.plan.front[i].spent.mean < p.plan.front[*best].spent.mean))
      best = i;
  return best;
}
const lattice::Policy& chosen_policy(const PlannedField& p) {
  const std::optional<std::size_t> best = cheapest(p);
  return best ? p.plan.front[*best].policy : p.plan.policy;
}

void describe_crossed(Fields& out, std::string_view meaning, const lattice::Crossings& c) {
  out.estimate({"crossed", "1", meaning}, c.share(), c.interval_95());
}

void describe_chance(Fields& out, const lattice::Crossings& c, double chain) {
  describe_crossed(out, "share of new trials that crossed; the search did not use these trials", c);
  out.count({"trials", "1",
             "new trials of the result, and of each action or start that it is compared with"},
            c.trials);
  out.number({"chain", "1",
              "chance to cross by the chain of the last search; null: one action all the time, or "
              "--robust"},
             chain);
}

void describe_gain(Fields& out, std::string_view meaning, const lattice::Gain& gain) {
  out.estimate({"gain", "1", meaning}, gain.difference, gain.interval_95);
}

std::string chance_text(const lattice::Crossings& c) {
  return fmt::format("chance to cross: {} %", with_interval(c.share(), c.interval_95()));
}

std::string trials_text(const lattice::Crossings& c) {
  return fmt::format(" of {} trials by which nothing was chosen\n", c.trials);
}

std::string gain_text(const lattice::Gain& gain) {
  const auto points = [](double x) { return fixed(100.0 * x, 2); };
  if (std::isnan(gain.interval_95[0])) return points(gain.difference);
  return fmt::format("{}{} [{}, {}]", gain.difference > 0.0 ? "+" : "", points(gain.difference),
                     points(gain.interval_95[0]), points(gain.interval_95[1]));
}

std::string rounds_text(std::int64_t gate_runs, int rounds) {
  return fmt::format("{} gate runs in {}, ", gate_runs, counted(rounds, "round", "rounds"));
}

std::string few_crossings(const lattice::Crossings& c) {
  constexpr std::int64_t kFew = 30;
  if (c.crossed >= kFew) return "";
  if (c.crossed == 0)
    return fmt::format(
        "none of {} trials crossed: too rare to choose by; a smaller field.rows asks for less, "
        "gatewalk rare says how rare it is",
        c.trials);
  return fmt::format(
      "only {} of {} trials crossed: few show what helps; a smaller --accuracy runs more",
      c.crossed, c.trials);
}

std::vector<MostTaken> most_taken(const PlannedField& p) {
  std::vector<MostTaken> most(cells_in(p));
  for (std::size_t cell = 0; cell < most.size(); ++cell) {
    double highest = 0.0;
    for (std::size_t a = 0; a < p.actions.size(); ++a) {
      const double usage = p.plan.usage[a * most.size() + cell];
      most[cell].visits += usage;
      if (usage > highest) {
        highest = usage;
        most[cell].action = static_cast<int>(a);
      }
    }
    if (highest > 0.0) most[cell].share = highest / most[cell].visits;
    most[cell].shown =
        std::lround(most[cell].visits * static_cast<double>(p.plan.crossings.trials)) >= kFewVisits;
  }
  return most;
}

bool gains(const PlannedField& p) {
  return p.plan.policy.always || p.plan.gains[best_alone(p.plan)].interval_95[0] > 0.0;
}

std::size_t best_alone(const lattice::Plan& plan) {
  const auto most = std::max_element(plan.alone.begin(), plan.alone.end(),
                                     [](const lattice::Crossings& a, const lattice::Crossings& b) {
                                       return a.crossed < b.crossed;
                                     });
  return static_cast<std::size_t>(most - plan.alone.begin());
}

void describe(Fields& out, const PlannedField& p) {
  const lattice::Plan& plan = p.plan;
  describe_chance(out, plan.crossings, plan.chain_says);
  out.if_any({"worst_case", "1",
              "with --robust: chance to cross if each row is 1.96 standard errors worse (symmetric "
              "gates: 2.77)"},
             plan.worst_case);
  out.text({"best_alone", "the action that crosses most often when taken all the time"},
           p.actions[best_alone(plan)]);
  out.list_of({"actions", "the actions that a body may take"}, p.actions.size(),
              [&](Fields& action, std::size_t a) { describe_action(action, p, a); });
  out.text_rows(
      {"most_taken",
       "action that the plan takes most in each gate, from the start's row on; null: no body came"},
      most_taken_rows(p));
  out.maybe({"by_gate", "best policy found that chooses by the gate alone; null: no body crossed"},
            plan.by_cell, [&](Fields& gates, const lattice::Plan::ByCell& by_cell) {
              const auto& [policy, crossings, worth, searched] = by_cell;
              describe_crossed(gates, "share of trials that crossed under this policy", crossings);
              describe_gain(gates,
                            "share crossed by the plan less that of this policy: worth of knowing "
                            "entry and gates passed",
                            worth);
              gates.flag({"searched",
                          "whether the search was complete; no: the field is too large, a better "
                          "policy may exist"},
                         searched);
              gates.text_rows(
                  {"action", "action that this policy takes in each gate, from the start's row on"},
                  action_rows(p, policy.decisions));
            });
  out.optional(p.thrift.has_value(), [&](Fields& f) { describe_front(f, p); });
  describe_search(out, plan, p.seconds);
  describe_made_by(out, p.made_by);
}

std::string table_of(const PlannedField& p) {
  const lattice::Plan& plan = p.plan;
  TextTable table({{"", -4},
                   {"action", -kFit},
                   {"crossed, %", 22, 0, "", "  "},
                   {"the plan's gain, points", 28},
                   {"the plan takes it", 20, 1, "%"}});
  double all = 0.0;
  for (const double u : plan.usage) all += u;
  for (std::size_t a = 0; a < p.actions.size(); ++a)
    table.row({fmt::format("  {}", mark_of(a)), p.actions[a],
               with_interval(plan.alone[a].share(), plan.alone[a].interval_95()),
               gain_text(plan.gains[a]), 100.0 * usage_of(p, a).sum() / all});
  std::string not_searched;
  if (const auto& gates = plan.by_cell) {
    table.row({"", "gate alone",
               with_interval(gates->crossings.share(), gates->crossings.interval_95()),
               gain_text(gates->worth)});
    if (!gates->searched)
      not_searched =
          "gate alone: not all that was to be tried was, in so large a field; there may be "
          "better\n";
  }
  return fmt::format(
      "{}{}{}{}\neach action all the time, under the same noise:\n\n{}{}{}{}{}{} s\n",
      chance_text(plan.crossings), trials_text(plan.crossings), worst_text(plan), verdict(p),
      table.text(), not_searched, front_text(p), map_text(p),
      rounds_text(plan.gate_runs, plan.rounds), fixed(p.seconds, 1));
}

}  // namespace gatewalk::cli
