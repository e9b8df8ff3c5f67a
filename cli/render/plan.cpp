// SPDX-License-Identifier: MIT
#include "cli/render/plan.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <ranges>
#include <utility>

#include "cli/fields/text.h"
#include "cli/fields/text_table.h"
#include "cli/render/choice.h"
#include "cli/render/crossings.h"
#include "cli/render/field_figure.h"
#include "cli/render/final_gates.h"
#include "cli/render/quantity.h"
#include "cli/render/type_marks.h"

namespace gatewalk::cli {
namespace {

constexpr int kFewVisits = 10;  // visits in all trials; maps leave out gates with fewer

std::size_t cells_in(const PlannedField& p) {
  return static_cast<std::size_t>(p.shown.field.columns) *
         static_cast<std::size_t>(p.shown.field.rows);
}

/// How often an action is taken, per trial: (rows x columns).
markov::CellProbabilities usage_of(const PlannedField& p, std::size_t action) {
  return by_gate(p.plan.usage.data() + action * cells_in(p), p.shown.field);
}

/// Marks of the actions in a text map: their numbers, as in the file of --policy.
constexpr std::string_view kMarks = "0123456789abcdefghijklmnopqrstuvwxyz";
char mark_of(std::size_t action) { return action < kMarks.size() ? kMarks[action] : ' '; }

/// A text map with the mark of each cell's action, the far row first.
std::string map_text(const PlannedField& p) {
  const int columns = p.shown.field.columns, rows = p.shown.field.rows;
  if (columns > kMostPrinted || rows > kMostPrinted || p.actions.size() > kMarks.size()) return "";
  const std::vector<MostTaken> most = most_taken(p);
  std::string text = fmt::format(
      "Most frequent action in each gate, far row first (.: fewer than {} of {} bodies came):\n",
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

/// Sentences on what the plan gains.
std::string gain_verdict(const PlannedField& p) {
  const std::size_t best = best_alone(p.plan);
  const lattice::Gain& gain = p.plan.gains[best];
  const std::string alone = p.actions[best] + " all the time";
  if (const auto& always = p.plan.policy.always)
    return fmt::format("The best policy found takes {} all the time.\n",
                       p.actions[static_cast<std::size_t>(*always)]);
  if (gain.interval_95[1] < 0.0)
    return wrapped(
        fmt::format("Beware: the plan is worse than {}, by {} points. Sampling noise led the "
                    "search; use a smaller --accuracy.",
                    alone, gain_text(gain)));
  return gain_sentence(gain, "The best policy found", alone);
}

std::string worst_text(const lattice::Plan& plan) {
  if (!plan.worst_case) return "";
  return fmt::format("Worst case, each row of the chain 1.96 standard errors worse: {} % cross.\n",
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
    return fmt::format("No policy was found that takes less for each crossing ({}).\n", cost.words);
  TextTable table({{"", -2}, {"crossed, %", 22}, {"per trial", 36}, {"per crossing", 36}});
  const std::optional<std::size_t> chosen = cheapest(p);
  for (std::size_t i = 0; i < p.plan.front.size(); ++i) {
    const auto& [price, policy, crossings, spent] = p.plan.front[i];
    table.row({chosen == i ? "*" : "", with_interval(crossings.share(), crossings.interval_95()),
               between(spent.mean, spent.mean_95),
               between(spent.per_crossing, spent.per_crossing_95)});
  }
  return fmt::format("Policies that take less ({}), with the same random numbers{}\n{}", cost.words,
                     chosen ? " (*: the one that --chance chooses):" : ":", table.text());
}

/// The action taken most in each gate; null if no body came.
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

/// The action in each gate, for a policy that depends on the gate alone.
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

/// The colours of kSequential.
constexpr std::array<const char*, 8> kShades{"#440154", "#46327e", "#365c8d", "#277f8e",
                                             "#1fa187", "#4ac16d", "#a0da39", "#fde725"};

/// The name escaped so that gnuplot's tics show each letter.
std::string escaped(const std::string& name) {
  std::string text;
  for (const char c : name) text += c == '_' ? std::string("\\_") : std::string(1, c);
  return text;
}

/// A colour for each action, dark to light, with names beside the colour bar.
Colours colours_of(const PlannedField& p, const Box& bar) {
  const auto n = static_cast<int>(p.actions.size());
  std::vector<std::string> names;
  std::string steps;
  for (int a = 0; a < n; ++a) {
    names.push_back(escaped(p.actions[static_cast<std::size_t>(a)]));
    const std::string colour = kShades[static_cast<std::size_t>(
        std::lround(static_cast<double>(a * (kShades.size() - 1)) / std::max(1, n - 1)))];
    for (const int edge : {a, a + 1})
      steps += fmt::format("{}{} '{}'", steps.empty() ? "" : ", ", edge, colour);
  }
  Colours colours{-0.5, n - 0.5, bar, tics_of(names) + " scale 0"};
  if (p.actions.size() <= kShades.size())
    colours.palette = fmt::format("set palette defined ({})\n", steps);
  return colours;
}

/// The probability to cross against the mean cost of a trial, for the policies that cost less.
void add_front(Panels& out, const PlannedField& p, const Box& box) {
  const dynamics::CostInfo& cost = p.shown.map.section.costs[p.thrift->cost];
  double low = p.plan.front[0].spent.mean, high = low;
  double lowest = 1.0, highest = 0.0;
  Rows& rows = out.data("$front");
  for (const lattice::FrontPoint& point : p.plan.front) {
    const double mean = point.spent.mean;  // with few trials it has no interval
    const bool few = std::isnan(point.spent.mean_95[0]);
    const auto [from, to] = few ? std::array<double, 2>{mean, mean} : point.spent.mean_95;
    const auto [least, most] = point.crossings.interval_95();
    low = std::min(low, from);
    high = std::max(high, to);
    lowest = std::min(lowest, least);
    highest = std::max(highest, most);
    rows.add(mean, from, to - from, 100.0 * point.crossings.share(), 100.0 * least,
             100.0 * (most - least), "");
  }
  const double margin = 0.05 * (high - low);
  Panel& panel = out.add(box);
  panel.say("policies that take less: " + cost.key, 8, box.top - 18);
  panel.x = {"mean of a trial, " + cost.unit, low - margin, high + margin,
             digits(tic_step(high - low, 3))};
  panel.y = {"% crossed", kFree, kFree, digits(tic_step(100.0 * (highest - lowest), 4))};
  panel.draw(rows, "2:4:3:(0)", kIntervals, kIntervalPen);
  panel.draw_again("1:5:(0):6", kIntervals, kIntervalPen);
  panel.draw_again("1:4", "linespoints", {.colour = "#365c8d", .width = 1, .mark = 7, .size = 0.6});
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
       "action that the plan takes most in each gate, from the near row on; null: no body came"},
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
                  {"action", "action that this policy takes in each gate, from the near row on"},
                  action_rows(p, policy.decisions));
            });
  out.optional(p.thrift.has_value(), [&](Fields& f) { describe_front(f, p); });
  describe_search(out, plan, p.seconds);
  describe_made_by(out, p.made_by);
}

namespace {

/// A line for each single action, and one for the policy that depends on the gate alone.
std::string actions_table(const PlannedField& p) {
  const lattice::Plan& plan = p.plan;
  TextTable table({{"", -4},
                   {"always one action", -kFit},
                   {"crossed, %", 22, 0, "", "  "},
                   {"the plan gains, points", 26},
                   {"the plan takes it", 19, 1, "%"}});
  double all = 0.0;
  for (const double u : plan.usage) all += u;
  for (std::size_t a = 0; a < p.actions.size(); ++a)
    table.row({fmt::format("  {}", mark_of(a)), p.actions[a],
               with_interval(plan.alone[a].share(), plan.alone[a].interval_95()),
               gain_text(plan.gains[a]), 100.0 * usage_of(p, a).sum() / all});
  if (const auto& gates = plan.by_cell)
    table.row({"", "by gate alone",
               with_interval(gates->crossings.share(), gates->crossings.interval_95()),
               gain_text(gates->worth)});
  return table.text();
}

/// Entries at one face for which a policy takes one action.
struct Region {
  dynamics::StateRange range;
  int leaves = 1;
  int action = 0;
};

/// The coordinate along which two regions of one action touch, all others being equal; nullopt if
/// they are no one region together.
std::optional<std::size_t> joint_axis(const Region& a, const Region& b) {
  if (a.action != b.action || a.range.face != b.range.face) return {};
  std::optional<std::size_t> axis;
  for (std::size_t c = 0; c < a.range.at.size(); ++c) {
    const auto &here = a.range.at[c], &there = b.range.at[c];
    if (here == there) continue;
    if (axis || (here[1] != there[0] && there[1] != here[0])) return {};
    axis = c;
  }
  return axis;
}

/// The regions of a policy of trees in one gate, those of most leaves first.
std::vector<Region> regions_of(const lattice::Policy& policy, const lattice::Place& place) {
  std::vector<Region> regions;
  const int leaves = policy.space.size() - static_cast<int>(policy.space.points().size());
  for (int state = 0; state < leaves; ++state) {
    const dynamics::StateRange range = policy.space.range(state);
    regions.push_back({range, 1, policy.action(place, range.middle())});
  }
  for (std::size_t i = 0; i < regions.size(); ++i)
    for (std::size_t k = 0; k < regions.size(); ++k) {
      Region& one = regions[i];
      const auto axis = k == i ? std::nullopt : joint_axis(one, regions[k]);
      if (!axis) continue;
      auto& [from, to] = one.range.at[*axis];
      from = std::min(from, regions[k].range.at[*axis][0]);
      to = std::max(to, regions[k].range.at[*axis][1]);
      one.leaves += regions[k].leaves;
      regions.erase(regions.begin() + static_cast<std::ptrdiff_t>(k));
      i = k = static_cast<std::size_t>(-1);  // a larger region may touch any other: begin again
      break;
    }
  std::ranges::stable_sort(regions, std::ranges::greater(), &Region::leaves);
  return regions;
}

/// A range with three digits: "S s [-0.499, 0.0049] m".
std::string entries_text(const dynamics::Section& section, const dynamics::StateRange& range) {
  std::string text;
  for (std::size_t c = 0; c < section.coordinates.size(); ++c) {
    const dynamics::Coordinate& coordinate = section.coordinates[c];
    text += fmt::format("{} {} [{}, {}]{}", c == 0 ? "" : ",", coordinate.name,
                        digits(range.at[c][0], 3), digits(range.at[c][1], 3),
                        dynamics::behind_number(coordinate.unit));
  }
  return section.faces[static_cast<std::size_t>(range.face)].name + text;
}

/// When the plan takes which action: a list for the most visited gate besides the start's.
std::string regions_text(const PlannedField& p) {
  const lattice::Policy& policy = p.plan.policy;
  if (policy.always || !policy.space.has_trees()) return "";
  const int columns = p.shown.field.columns, start_column = p.shown.field.start_column(),
            start_row = p.shown.field.start_row;
  const std::vector<MostTaken> most = most_taken(p);
  std::optional<std::size_t> gate;
  for (std::size_t k = 0; k < most.size(); ++k)
    if (k != static_cast<std::size_t>(start_row * columns + start_column) && most[k].shown &&
        (!gate || most[k].visits > most[*gate].visits))
      gate = k;
  if (!gate) return "";
  const int column = static_cast<int>(*gate) % columns, row = static_cast<int>(*gate) / columns,
            passed = std::abs(row - start_row) + std::abs(column - start_column);
  const std::vector<Region> regions =
      regions_of(policy, {.column = column, .row = row, .passed = passed});
  constexpr std::size_t kMost = 8;
  std::string text = fmt::format(
      "Actions in gate {},{}, the most visited after the start's, by how a body enters{}:\n",
      column - start_column, row,
      p.shown.field.max_gates > 0 ? fmt::format(" after {}", counted(passed, "gate", "gates"))
                                  : "");
  for (const Region& region : regions | std::views::take(kMost))
    text += wrapped(fmt::format("  {}, {}: {}", p.actions[static_cast<std::size_t>(region.action)],
                                counted(region.leaves, "state", "states"),
                                entries_text(policy.space.section(), region.range)),
                    "    ");
  if (const std::size_t all = regions.size(); all > kMost)
    text += fmt::format("  and {} smaller ranges (--policy writes all of them)\n", all - kMost);
  return text;
}

/// Whether the table of actions is short enough for the first screen.
bool is_short(const PlannedField& p) { return p.actions.size() <= 5; }

}  // namespace

std::string answer_text(const PlannedField& p) {
  const lattice::Plan& plan = p.plan;
  return chance_text(plan.crossings) + worst_text(plan) + gain_verdict(p) +
         (p.thrift      ? front_text(p)
          : is_short(p) ? actions_table(p) + map_text(p)
                        : "") +
         basis_text(plan);
}

std::string details_text(const PlannedField& p) {
  std::string text = "\n";
  if (p.thrift || !is_short(p)) text += actions_table(p) + map_text(p);
  if (const std::string regions = regions_text(p); !regions.empty()) text += regions + "\n";
  text +=
      "by gate alone: the best policy found that knows the gate, but not how the body enters.\n"
      "All policies are compared with the same random numbers.\n";
  if (p.plan.by_cell && !p.plan.by_cell->searched)
    text += "The field is too large to try every policy by gate alone; a better one may exist.\n";
  return text +
         fmt::format("{}Time: {} s.\n", method_lines({p.actions, p.methods}), fixed(p.seconds, 1));
}

Figure figure_of(const PlannedField& p) {
  const std::vector<MostTaken> most = most_taken(p);
  markov::CellProbabilities visits(p.shown.field.rows, p.shown.field.columns);
  for (std::size_t i = 0; i < most.size(); ++i) visits.data()[i] = most[i].visits;
  const auto [map, box] = SmallMap(visits, p.shown.field);
  const TypeMarks types(p.shown);
  const double legend = box.bottom + 52, bars_top = legend + types.legend_height() + 30;

  Panels out;
  // A block of several gates shows the action of the gate that most bodies visit.
  Rows& rows = out.data("$actions");
  for (Eigen::Index r = 0; r < map.rows.blocks(); ++r)
    for (Eigen::Index c = 0; c < map.columns.blocks(); ++c) {
      const MostTaken* shown = nullptr;
      for (const std::size_t gate : gates_in(map, r, c, p.shown.field))
        if (most[gate].shown && (!shown || most[gate].visits > shown->visits)) shown = &most[gate];
      if (shown) rows.add(c, r, shown->action, fixed(100.0 * shown->share, 0));
    }
  Panel& panel = add_map(out, map, box);
  panel.say("most frequent action in each gate that enough bodies visit, its %", 8, 18);
  panel.colours = colours_of(p, box.beside());
  panel.draw_cells(rows);
  if (numbers_fit(map, box)) panel.draw_numbers(static_cast<double>(p.actions.size() - 1));
  types.add_legend(panel, legend, types.draw_on(out, panel, map, "plan"));

  std::vector<std::pair<std::string, lattice::Crossings>> crossings{{"plan", p.plan.crossings}};
  if (const auto& by_cell = p.plan.by_cell)
    crossings.emplace_back("gate alone", by_cell->crossings);
  for (std::size_t a = 0; a < p.actions.size(); ++a)
    crossings.emplace_back(escaped(p.actions[a]), p.plan.alone[a]);
  const double end = add_crossings(
      out, bars_top, "crossed, %, by the plan, by the gate alone and by each action", crossings);
  if (p.plan.front.size() < 2) return out.figure(static_cast<int>(std::ceil(end + 12)));
  add_front(out, p, {70, 330, end + 56, end + 196});
  return out.figure(static_cast<int>(std::ceil(end + 252)));
}

}  // namespace gatewalk::cli
