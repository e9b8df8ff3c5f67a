// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>
#include <ranges>

#include "cli/fields/text.h"
#include "cli/fields/text_table.h"
#include "cli/render/analysis.h"
#include "cli/render/costs.h"
#include "cli/render/scene.h"

namespace gatewalk::cli {
namespace {

using lattice::Mean95OfRuns;

/// "s 1.20, t 0.44"
template <class Number>
std::string types_text(const std::vector<std::string>& names, Number number) {
  std::vector<std::string> texts;
  for (std::size_t t = 0; t < names.size(); ++t)
    texts.push_back(names[t] + " " + fixed(number(t), 2));
  return fmt::format("{}", fmt::join(texts, ", "));
}

/// Endings whose mean time has no interval, and why: such a mean is to be read with care.
std::string few_runs_text(const lattice::Analysis& a) {
  std::vector<std::string> texts;
  for (const EndingName& e : kAllEndingNames)
    if (const auto& costs = a.costs_of[static_cast<std::size_t>(e.ending)];
        !costs.empty() && !costs.front().why_none.empty() && std::isfinite(costs.front().mean))
      texts.push_back(fmt::format("{}, {}", e.name, costs.front().why_none));
  return texts.empty() ? ""
                       : fmt::format("(means without an interval: {})\n", fmt::join(texts, "; "));
}

/// How bodies end, and how many gates they visit.
std::string endings_part(const AnalysedField& f) {
  const Mean95OfRuns& gates = f.analysis.gates;
  const lattice::EndingShares& shares = f.answer.endings;
  std::string text =
      endings_text(shares, f.analysis.by_groups
                               ? "of all bodies, 95 % intervals that count everything"
                           : std::isnan(shares.interval.front().front())
                               ? "of all bodies; no intervals"
                               : "of all bodies; 95 % intervals that count the sampling of the "
                                 "matrix") +
      limits_text(f.shown) + rest_text(f.answer.rest) + "\ngates visited  " +
      with_limits(gates.mean, gates.interval, 3);
  if (!gates.why_none.empty())
    text += fmt::format(" ({}: {})",
                        std::isnan(gates.mean) ? "nor visits, times and costs" : "no interval",
                        gates.why_none);
  return text + "\n";
}

/// What bodies take, by the chain and by trials.
std::string costs_part(const AnalysedField& f) {
  const lattice::Analysis& a = f.analysis;
  CostTable costs(f.shown);
  const auto add = [&](const char* name, std::optional<markov::Ending> ending) {
    if (const Spent s = spent(a, ending); s.share > 0.0) costs.add(name, s);
  };
  add("all", {});
  for (const EndingName& e : kAllEndingNames) add(e.name, e.ending);
  std::string text = "\nby the chain\n" + costs.text() + few_runs_text(a);
  if (!std::isfinite(a.costs.front().mean) && !std::isnan(a.gates.mean))
    text += f.shown.mass
                ? "(the file is of an older version, which kept no durations: build it again)\n"
                : "(the durations of some passages are not known)\n";
  if (a.totals.drawn_walks > 0)
    text += fmt::format(
        "(a large field: times and work by ending are those of {} walks with the chain; none of "
        "them: no line)\n",
        a.totals.drawn_walks);
  if (f.direct) {
    const auto [distance, chance_95] = duration_distance(a, f.direct->costs, {});
    text += fmt::format(
        "by {} trials of the full dynamics\n{}largest difference of the two distributions of time: "
        "{} (chance: {}, 95 %)\n",
        f.direct->tally.trials, table_of(f.direct->costs, f.shown), fixed(distance, 4),
        fixed(chance_95, 4));
  }
  if (f.shown.mass)
    text +=
        "work: of the propulsion and of the random force; lost: to hits, dampers and drag, and "
        "left in the beams;\nJ/(kg m): cost of transport, work of both forces per mass and way "
        "forward\n";
  return text;
}

std::string endless_part(const lattice::Analysis& a) {
  if (!a.endless) return "";
  const auto scales = a.endless->moduli | std::views::transform([](double modulus) {
                        return fixed(markov::implied_time_scale(modulus), 2);
                      });
  return fmt::format(
      "\nbodies that go on for ever: {} of them get through or out of each further gate; {} rows a "
      "gate; from gate to gate {} is left of what tells where they started\nimplied time scales "
      "(gates): {}\n",
      percent(a.endless->survival, 1.0), fixed(a.endless->rows_per_cell, 2),
      percent(a.endless->second / a.endless->survival, 1.0), fmt::join(scales, ", "));
}

/// The most frequent ways to the target.
std::string paths_part(const AnalysedField& f) {
  const lattice::FieldParams& field = f.shown.field;
  const markov::FrequentPaths& paths = f.analysis.paths;
  TextTable table({{"", 11}, {.before = " "}});
  for (const markov::CellPath& path : paths.paths) {
    std::string gates;
    std::int64_t row = -1;
    for (const std::int64_t cell : path.cells) {
      gates += fmt::format("{}{}", cell / field.columns == row ? ">" : " ",
                           cell % field.columns - field.start_column());
      row = cell / field.columns;
    }
    table.row({percents(path.share) + " %", gates});
  }
  return fmt::format(
      "\nmost frequent ways to \"{}\", by the columns i_x of their gates (>: in the same "
      "row)\n{}{}",
      target_name(f), table.text(),
      paths.gave_up         ? "  (the search for more was given up: there are very many ways)\n"
      : paths.paths.empty() ? "  (none)\n"
                            : "");
}

/// What would change the chance of the target.
std::string parameters_part(const AnalysedField& f) {
  const lattice::Analysis& a = f.analysis;
  const auto effects = sorted_effects(f);
  if (effects.empty())
    return a.is_certain() ? fmt::format(
                                "{} ends so in these runs: they cannot tell what a little "
                                "more or less of a number changes; --set KEY=VALUE tries "
                                "more\n",
                                a.target_chance > 0.5 ? "everybody" : "nobody")
                          : "";
  // The chain behind these has more runs than that behind the endings above.
  const std::string chance = percents(f.parameters.chance),
                    answer = percents(f.answer.endings.share[static_cast<std::size_t>(a.target)]);
  std::string text = fmt::format(
      "\nper cent that the chance of \"{}\" ({} %{}) grows for 1 % more of each number, 95 %\n",
      target_name(f), chance,
      chance == answer || f.parameters.pool_runs == 0
          ? ""
          : fmt::format(" by the chain of {} gate runs behind these numbers; the answer is the {} "
                        "% above",
                        f.parameters.pool_runs, answer));
  TextTable table({{"", -34}, {}});
  for (const lattice::ParameterEffect& e : effects) {
    std::string line = with_limits(e.elasticity.mean, e.elasticity.interval, 2);
    if (std::isnan(e.elasticity.interval[0]) && a.by_groups)
      line += " (no interval: too few runs make it)";
    if (!e.of_type.empty())
      line +=
          "  of it: " + types_text(f.shown.types, [&](std::size_t t) { return e.of_type[t].mean; });
    if (e.bends)
      line +=
          fmt::format(" (with more of it {}, with less {})", fixed(e.more, 2), fixed(e.less, 2));
    table.row({e.key, line});
  }
  text += table.text();
  text +=
      a.by_groups
          ? "one number at a time, in gates of all types; intervals count chance and the "
            "chain's own error; --set KEY=VALUE\nsays what a large change does\n"
          : "a matrix of bins does not tell how far off these are, and its states are coarse: a "
            "scene tells more\n";
  const double largest = std::abs(effects.front().elasticity.mean) * f.step;
  constexpr double kSmall = 0.3;
  if (largest > kSmall)
    text += fmt::format(
        "the chance changes by {} in a step of {}, so the first are rough: a smaller --step is "
        "more exact\n",
        percent(largest, 1.0, 0), percent(f.step, 1.0));
  return text;
}

std::string types_part(const AnalysedField& f) {
  const lattice::Analysis& a = f.analysis;
  const std::vector<std::string>& types = f.shown.types;
  if (types.empty() || std::isnan(a.gates.mean)) return "";
  std::string text = fmt::format(
      "\nby type of the gate: visits per body {}; trapped there, % of these visits {}",
      types_text(types, [&](std::size_t t) { return a.types[t].visits; }),
      types_text(types,
                 [&](std::size_t t) { return 100.0 * a.types[t].trapped / a.types[t].visits; }));
  if (!a.type_trapping.empty())
    text += fmt::format(";\nper cent that \"{}\" grows for 1 % fewer of these {}", target_name(f),
                        types_text(types, [&](std::size_t t) { return a.type_trapping[t]; }));
  return text + "\n";
}

}  // namespace

std::string table_of(const AnalysedField& f) {
  const lattice::Analysis& a = f.analysis;
  std::string text = (f.passage ? text_of(*f.passage) : "") + endings_part(f) + costs_part(f);
  if (!std::isnan(a.gates.mean))
    text += "\n" + map_of(a.totals.visits, "visits of each gate", "per 100 bodies");
  text += endless_part(a);
  if (f.answer.from_trials)
    text += fmt::format(
        "\nthe endings above are the trials' own shares, which are more certain here; the chain's "
        "are behind all else (\"{}\": {} %)\n",
        target_name(f), percents(a.target_chance));
  text += paths_part(f);
  if (std::ssize(a.starts) > a.told_starts())
    text += fmt::format(
        "other starts: --json has the {} of {} ways to enter that were entered most; --figure "
        "draws all\n",
        a.told_starts(), a.starts.size());
  text += parameters_part(f) + types_part(f);
  if (a.lumped)
    text += fmt::format(
        "\nwith {} states (--lump), total variation to this chain: endings {}, final gates {}\n",
        a.lumped->states, fixed(a.lumped->endings, 4), fixed(a.lumped->final_gates, 4));
  text += fmt::format("{} gate runs, {} states, {} s\n", f.gate_runs(), f.answer.states,
                      fixed(f.seconds(), 2));
  return text + (f.shares ? table_of(*f.shares) : "");
}

}  // namespace gatewalk::cli
