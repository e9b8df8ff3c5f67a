// SPDX-License-Identifier: MIT
#include "cli/render/plan.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "cli/render/choice.h"
#include "cli/render/final_gates.h"
#include "cli/render/health.h"
#include "cli/render/json.h"
#include "cli/render/quantity.h"
#include "cli/render/text.h"

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
  markov::CellProbabilities usage(p.shown.field.rows, p.shown.field.columns);
  const double* from = p.plan.usage.data() + action * cells_in(p);
  for (Eigen::Index r = 0; r < usage.rows(); ++r)
    for (Eigen::Index c = 0; c < usage.cols(); ++c) usage(r, c) = *from++;
  return usage;
}

/// What stands for an action in a map.
constexpr std::string_view kMarks = "123456789abcdefghijklmnopqrstuvwxyz";
char mark_of(std::size_t action) { return action < kMarks.size() ? kMarks[action] : ' '; }

/// A mark for each cell, the far row first.
std::string map_text(const PlannedField& p) {
  const int columns = p.shown.field.columns, rows = p.shown.field.rows;
  if (columns > kMostPrinted || rows > kMostPrinted || p.actions.size() > kMarks.size()) return "";
  const std::vector<MostTaken> most = most_taken(p);
  std::string text = "\nthe action that is taken most in each gate (.: fewer than " +
                     std::to_string(kFewVisits) + " of " + std::to_string(p.plan.crossings.trials) +
                     " bodies came), far row first:\n";
  for (int r = rows; r-- > 0;) {
    text += padded(std::to_string(r), 4) + " ";
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
  const std::string& name = p.actions[best];
  if (const auto& always = p.plan.policy.always)
    return "the best that was found is to take " + p.actions[static_cast<std::size_t>(*always)] +
           " all the time\n";
  if (gain.interval_95[1] < 0.0)
    return "the plan is worse than " + name + " all the time, " + gain_text(gain) +
           " points: chosen by chance; a smaller --accuracy helps\n";
  if (gain.interval_95[0] > 0.0)
    return "choosing by the way in gains " + gain_text(gain) + " points over " + name +
           " all the time\n";
  return "choosing by the way in is not shown to gain anything over " + name +
         " all the time: " + gain_text(gain) +
         " points; a smaller --accuracy\nshows a smaller gain, if there is one\n";
}

std::string worst_text(const lattice::Plan& plan) {
  if (!plan.worst_case) return "";
  return "with each row 1.96 standard errors worse than counted: " +
         fixed(100.0 * *plan.worst_case, 2) + " %\n";
}

/// The action that a policy of gates alone takes in each: (rows x columns).
Json by_gate_of(const PlannedField& p) {
  if (!p.plan.by_cell) return {};
  const auto& [policy, crossings, worth, searched] = *p.plan.by_cell;
  Json json{{"crossed", crossings.share()},
            {"interval_95", crossings.interval_95()},
            {"gain", worth.difference},
            {"gain_95", gain_95(worth)},
            {"searched", searched}};
  const markov::Decisions& d = policy.decisions;
  for (int r = 0; r < d.field.rows; ++r) {
    Json row;
    for (int c = 0; c < d.field.columns; ++c) row.push_back(p.actions[d.action[d.at(c, r, 0)]]);
    json["action"].push_back(std::move(row));
  }
  return json;
}

Json interval_of(const std::array<double, 2>& interval) {
  return {or_null(interval[0]), or_null(interval[1])};
}
Json front_of(const PlannedField& p) {
  Json json = Json::array();
  const std::optional<std::size_t> chosen = cheapest(p);
  for (std::size_t i = 0; i < p.plan.front.size(); ++i) {
    const lattice::FrontPoint& point = p.plan.front[i];
    json.push_back(
        {{"price", point.price},
         {"crossed", point.crossings.share()},
         {"interval_95", point.crossings.interval_95()},
         {"mean", point.spent.mean},
         {"mean_95", std::isfinite(point.spent.mean_95[0]) ? Json(point.spent.mean_95) : Json()},
         {"per_crossing", or_null(point.spent.per_crossing)},
         {"per_crossing_95", interval_of(point.spent.per_crossing_95)},
         {"chosen", chosen == i}});
  }
  return json;
}
std::string front_text(const PlannedField& p) {
  if (!p.thrift) return "";
  const dynamics::CostInfo& cost = p.shown.map.section.costs[p.thrift->cost];
  const auto amount = [&](double x) {
    return std::isinf(x) ? std::string("no end") : quantity(x, cost.unit, 3);
  };
  const auto between = [&](double mean, const std::array<double, 2>& interval) {
    if (std::isnan(interval[0]) && std::isfinite(mean)) return amount(mean) + " (few trials)";
    return amount(mean) + " [" + amount(interval[0]) + ", " + amount(interval[1]) + "]";
  };
  if (p.plan.front.size() < 2)
    return "\nno policy was found that takes less for each crossing (" + cost.words + ")\n";
  std::string text = "\npolicies that take less (" + cost.words + "), under the same noise:\n\n" +
                     padded("crossed, %", 24) + padded("a trial takes", 32) +
                     padded("each crossing takes", 32) + "\n";
  const std::optional<std::size_t> chosen = cheapest(p);
  for (std::size_t i = 0; i < p.plan.front.size(); ++i) {
    const lattice::FrontPoint& point = p.plan.front[i];
    text += (chosen == i ? "* " : "  ") +
            padded(with_interval(point.crossings.share(), point.crossings.interval_95()), 22) +
            padded(between(point.spent.mean, point.spent.mean_95), 32) +
            padded(between(point.spent.per_crossing, point.spent.per_crossing_95), 32) + "\n";
  }
  return text;
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

Json gain_95(const lattice::Gain& gain) {
  return std::isnan(gain.interval_95[0]) ? Json() : Json(gain.interval_95);
}

std::string gain_text(const lattice::Gain& gain) {
  const auto points = [](double x) { return fixed(100.0 * x, 2); };
  if (std::isnan(gain.interval_95[0])) return points(gain.difference);
  return (gain.difference > 0.0 ? "+" : "") + points(gain.difference) + " [" +
         points(gain.interval_95[0]) + ", " + points(gain.interval_95[1]) + "]";
}

std::string few_crossings(const lattice::Crossings& c) {
  constexpr std::int64_t kFew = 30;
  if (c.crossed >= kFew) return "";
  if (c.crossed == 0)
    return "none of " + std::to_string(c.trials) +
           " trials crossed: too rare to choose by; a smaller field.rows asks for less, gatewalk "
           "rare says how rare it is";
  return "only " + std::to_string(c.crossed) + " of " + std::to_string(c.trials) +
         " trials crossed: few show what helps; a smaller --accuracy runs more";
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

Json to_json(const PlannedField& p) {
  const lattice::Plan& plan = p.plan;
  Json json;
  json["crossed"] = plan.crossings.share();
  json["interval_95"] = plan.crossings.interval_95();
  json["trials"] = plan.crossings.trials;
  json["chain"] = std::isnan(plan.chain_says) ? Json() : Json(plan.chain_says);
  if (plan.worst_case) json["worst_case"] = *plan.worst_case;
  json["best_alone"] = p.actions[best_alone(plan)];
  for (std::size_t a = 0; a < p.actions.size(); ++a) {
    Json action{{"name", p.actions[a]},
                {"crossed", plan.alone[a].share()},
                {"interval_95", plan.alone[a].interval_95()},
                {"gain", plan.gains[a].difference},
                {"gain_95", gain_95(plan.gains[a])},
                {"taken", grid(usage_of(p, a))}};
    if (p.methods[a]) action["method"] = to_json(*p.methods[a]);
    json["actions"].push_back(std::move(action));
  }
  const std::vector<MostTaken> most = most_taken(p);
  for (int r = 0; r < p.shown.field.rows; ++r) {
    Json row;
    for (int c = 0; c < p.shown.field.columns; ++c) {
      const int action = most[static_cast<std::size_t>(r * p.shown.field.columns + c)].action;
      row.push_back(action < 0 ? Json() : Json(p.actions[static_cast<std::size_t>(action)]));
    }
    json["most_taken"].push_back(std::move(row));
  }
  json["by_gate"] = by_gate_of(p);
  if (p.thrift) {
    json["least"] = p.shown.map.section.costs[p.thrift->cost].key;
    json["front"] = front_of(p);
    json["front_finished"] = p.plan.front_finished;
  }
  json["rounds"] = plan.rounds;
  json["settled"] = plan.settled;
  json["gate_runs"] = plan.gate_runs;
  json["seconds"] = p.seconds;
  json["status"] = to_json(plan.health);
  return json;
}

std::string table_of(const PlannedField& p) {
  const lattice::Plan& plan = p.plan;
  std::size_t width = plan.by_cell ? 10 : 6;
  for (const std::string& name : p.actions) width = std::max(width, name.size());
  const int name_width = -static_cast<int>(width) - 2;
  std::string table =
      "chance to cross: " + with_interval(plan.crossings.share(), plan.crossings.interval_95()) +
      " % of " + std::to_string(plan.crossings.trials) + " trials by which nothing was chosen\n" +
      worst_text(plan) + verdict(p) + "\neach action all the time, under the same noise:\n\n    " +
      padded("action", name_width) + padded("crossed, %", 22) +
      padded("the plan's gain, points", 28) + padded("the plan takes it", 20) + "\n";
  double all = 0.0;
  for (const double u : plan.usage) all += u;
  for (std::size_t a = 0; a < p.actions.size(); ++a)
    table += std::string("  ") + mark_of(a) + " " + padded(p.actions[a], name_width) +
             padded(with_interval(plan.alone[a].share(), plan.alone[a].interval_95()), 22) +
             padded(gain_text(plan.gains[a]), 28) +
             padded(fixed(100.0 * usage_of(p, a).sum() / all, 1) + " %", 20) + "\n";
  if (plan.by_cell)
    table += "    " + padded("gate alone", name_width) +
             padded(with_interval(plan.by_cell->crossings.share(),
                                  plan.by_cell->crossings.interval_95()),
                    22) +
             padded(gain_text(plan.by_cell->worth), 28) + "\n";
  if (plan.by_cell && !plan.by_cell->searched)
    table +=
        "gate alone: not all that was to be tried was, in so large a field; there may be better\n";
  return table + front_text(p) + map_text(p) + std::to_string(plan.gate_runs) + " gate runs in " +
         std::to_string(plan.rounds) + (plan.rounds == 1 ? " round, " : " rounds, ") +
         fixed(p.seconds, 1) + " s\n";
}

}  // namespace gatewalk::cli
