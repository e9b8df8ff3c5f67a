// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
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

/// Numbers by type of gate: "s 1.20, t 0.44".
template <class Number>
std::string types_text(const std::vector<std::string>& names, Number number) {
  std::vector<std::string> texts;
  for (std::size_t t = 0; t < names.size(); ++t)
    texts.push_back(names[t] + " " + fixed(number(t), 2));
  return fmt::format("{}", fmt::join(texts, ", "));
}

/// Endings whose mean time has no interval, with the reason.
std::string few_runs_text(const lattice::Analysis& a) {
  std::vector<std::string> texts;
  for (const EndingName& e : kAllEndingNames)
    if (const auto& costs = a.costs_of[static_cast<std::size_t>(e.ending)];
        !costs.empty() && !costs.front().why_none.empty() && std::isfinite(costs.front().mean))
      texts.push_back(fmt::format("{}, {}", e.name, costs.front().why_none));
  return texts.empty()
             ? ""
             : wrapped(fmt::format("These means have no interval: {}.", fmt::join(texts, "; ")),
                       "  ");
}

/// The mean number of gates that bodies visit and their mean time, as far as these are known.
std::string means_text(const lattice::Analysis& a) {
  std::vector<std::string> means;
  if (std::isfinite(a.gates.mean))
    means.push_back("visits " + with_limits(a.gates.mean, a.gates.interval, 2, " gates"));
  if (const Mean95OfRuns& time = a.costs.front(); std::isfinite(time.mean))
    means.push_back("takes " + with_limits(time.mean, time.interval, 2, " s"));
  return means.empty() ? "" : fmt::format("On average a body {}.\n", fmt::join(means, " and "));
}

/// A sentence that compares the chain with the trials of --trials.
std::string direct_text(const AnalysedField& f) {
  if (!f.direct) return "";
  const auto [distance, chance_95] = duration_distance(f.analysis, f.direct->costs, {});
  const std::int64_t trials = f.direct->tally.trials;
  if (std::isnan(distance))
    return fmt::format("The {} of the full dynamics are too few to compare times with.\n",
                       counted(trials, "trial", "trials"));
  return wrapped(
      fmt::format("{} trials of the full dynamics {} the chain's distribution of times: the "
                  "largest difference is {}, and chance alone stays below {} (95 %).",
                  trials, distance > chance_95 ? "differ from" : "agree with", fixed(distance, 4),
                  fixed(chance_95, 4)));
}

/// What the intervals of an analysis include.
std::string intervals_text(const AnalysedField& f) {
  if (f.answer.from_trials)
    return "The endings are the shares of the trials, which are more precise here than the chain; "
           "their 95 % intervals count the sampling error of the trials.";
  if (f.analysis.by_groups)
    return "The 95 % intervals include sampling error and the chain's own approximation error.";
  return std::isnan(f.answer.endings.interval.front().front())
             ? "There are no intervals."
             : "The 95 % intervals include only the sampling error of the matrix.";
}

std::string basis_text(const AnalysedField& f) {
  const std::string chain = counted(f.answer.states, "state", "states");
  const std::int64_t runs = f.answer.gate_runs, more = f.parameters.health.runs;
  std::string text = runs > 0 ? fmt::format("From {} gate runs and a chain of {}", runs, chain)
                              : "From a chain of " + chain;
  if (more > 0)
    text += fmt::format("; the influences from {}{} gate runs", more, runs > 0 ? " further" : "");
  return wrapped(text + ". " + intervals_text(f));
}

/// A parameter's elasticity, as a cell of a table.
std::string elasticity_text(const AnalysedField& f, const lattice::ParameterEffect& e) {
  const std::string text = with_limits(e.elasticity.mean, e.elasticity.interval, 2);
  return std::isnan(e.elasticity.interval[0]) && f.analysis.by_groups
             ? text + " (no interval: too few runs make it)"
             : text;
}

/// Whether the slope does not tell what a small change does: 1 % or one step changes the
/// probability by more than a tenth of its value, or more and less of the number differ.
bool is_steep(const AnalysedField& f, const lattice::ParameterEffect& e) {
  constexpr double kGentle = 0.1, kOnePercent = 0.01;
  const auto much = [&](double slope) {
    return std::abs(slope) * std::max(f.step, kOnePercent) > kGentle;
  };
  return e.bends || much(e.elasticity.mean) || much(e.more) || much(e.less);
}

/// What one step of a parameter changes, as measured: "+1.71 points for 2 % more"; "steep" where
/// that tells nothing of smaller changes; empty without an interval of the influence, and if the
/// result would be no share.
std::string change_of(const AnalysedField& f, const lattice::ParameterEffect& e) {
  if (is_steep(f, e)) return "steep";
  const double share = f.answer.endings.share[static_cast<std::size_t>(f.analysis.target)],
               change = share * f.step * e.elasticity.mean, changed = share + change;
  if (f.analysis.by_groups && std::isnan(e.elasticity.interval[0])) return "";
  if (!(share > 0.0 && changed >= 0.0 && changed <= 1.0)) return "";
  return fmt::format("{}{} points for {} % more", change > 0.0 ? "+" : "", fixed(100.0 * change, 2),
                     digits(100.0 * f.step));
}

/// A table of the `most` parameters that change the target's probability most.
std::string largest_effects(const AnalysedField& f, std::size_t most) {
  const auto effects = sorted_effects(f);
  if (effects.empty() || most == 0) return "";
  TextTable table({{"", -36, 0, "", "  "}, {"", -24}, {"", 0, 0, "", "  "}});
  for (const lattice::ParameterEffect& e : effects | std::views::take(most)) {
    std::vector<TextCell> cells{e.key, elasticity_text(f, e)};
    if (const std::string change = change_of(f, e); !change.empty()) cells.emplace_back(change);
    table.row(cells);
  }
  return fmt::format(
      "Largest influences on \"{}\" (a slope: % of its chance per % of the number, over +-{} "
      "%):\n{}",
      target_name(f), digits(100.0 * f.step), table.text());
}

/// The relative change of the target's probability in one step of the most influential parameter;
/// 0: not known.
double largest_change(const AnalysedField& f) {
  const auto effects = sorted_effects(f);
  return effects.empty() ? 0.0 : std::abs(effects.front().elasticity.mean) * f.step;
}

bool is_open(const lattice::Mean95& m) { return m.interval[0] < 0.0 && m.interval[1] > 0.0; }

/// A warning about the first screen, in a line.
std::string beware_text(const AnalysedField& f, std::size_t most) {
  const lattice::Analysis& a = f.analysis;
  const auto effects = sorted_effects(f);
  if (effects.empty())
    return a.is_certain()
               ? fmt::format(
                     "Beware: {} ends as \"{}\" here, so these runs tell no influences; try "
                     "--set KEY=VALUE.\n",
                     a.target_chance > 0.5 ? "every body" : "no body", target_name(f))
               : "";
  constexpr double kSmall = 0.3;
  constexpr double kMostSlope = 1000.0;  // of a target that hardly any run reaches
  const double change = largest_change(f);
  if (change == 0.0)
    return "Beware: no changed run ended otherwise, so these runs tell no influences; raise "
           "--runs.\n";
  if (change > kSmall && change > kMostSlope * f.step)
    return fmt::format(
        "Beware: \"{}\" is too rare for these influences; take another --target, or raise "
        "--runs.\n",
        target_name(f));
  if (std::ranges::any_of(effects | std::views::take(most),
                          [&](const auto& e) { return is_steep(f, e); }))
    return "Beware: steep: the slope may not hold for 1 %; gatewalk predict SCENE --set KEY=VALUE "
           "tells.\n";
  if (!a.by_groups)
    return "Beware: a matrix of bins gives coarse influences without intervals; analyze the "
           "scene.\n";
  return std::ranges::any_of(effects | std::views::take(most),
                             [](const auto& e) { return is_open(e.elasticity); })
             ? "Beware: an interval that includes 0 leaves the direction open; raise --runs.\n"
             : "";
}

/// Costs of bodies, by the chain and by trials.
std::string costs_part(const AnalysedField& f) {
  const lattice::Analysis& a = f.analysis;
  CostTable costs(f.shown);
  const auto add = [&](const char* name, std::optional<markov::Ending> ending) {
    if (const Spent s = spent(a, ending); s.share > 0.0) costs.add(name, s);
  };
  add("all", {});
  for (const EndingName& e : kAllEndingNames) add(e.name, e.ending);
  std::string text = "\nTimes and work of a body, by its ending (from the chain)\n" + costs.text() +
                     few_runs_text(a);
  if (!std::isfinite(a.costs.front().mean) && !std::isnan(a.gates.mean))
    text += f.shown.mass ? "An older version wrote this file, without durations. Build it again.\n"
                         : "The durations of some passages are not known.\n";
  if (a.totals.drawn_walks > 0)
    text += wrapped(fmt::format(
        "The field is large: times and work by ending come from {} walks with the chain. An ending "
        "that no walk had has no line.",
        a.totals.drawn_walks));
  if (f.direct)
    text += fmt::format("The same from {} trials of the full dynamics\n{}", f.direct->tally.trials,
                        table_of(f.direct->costs, f.shown));
  if (f.shown.mass)
    text +=
        "push, noise: work of the propulsion and of the random force. lost: energy lost to hits,\n"
        "dampers and drag, or left in the beams. J/(kg m): cost of transport, the work of both\n"
        "forces per mass and distance forward.\n";
  return text;
}

std::string endless_part(const lattice::Analysis& a) {
  if (!a.endless) return "";
  const auto scales = a.endless->moduli | std::views::transform([](double modulus) {
                        return fixed(markov::implied_time_scale(modulus), 2);
                      });
  return fmt::format(
      "\nIn an endless field: {} of the bodies still under way survive each further gate, and "
      "advance\n{} rows a gate. The memory of the start falls to {} from one gate to the next "
      "(second\neigenvalue / first). Implied time scales, in gates: {}\n",
      percent(a.endless->survival, 1.0), fixed(a.endless->rows_per_cell, 2),
      percent(a.endless->second / a.endless->survival, 1.0), fmt::join(scales, ", "));
}

/// The most frequent paths to the target.
std::string paths_part(const AnalysedField& f) {
  const lattice::FieldParams& field = f.shown.field;
  const markov::FrequentPaths& paths = f.analysis.paths;
  std::string lines;
  for (const markov::CellPath& path : paths.paths) {
    std::string gates;
    std::int64_t row = -1;
    for (const std::int64_t cell : path.cells) {
      gates += fmt::format("{}{}", cell / field.columns == row ? ">" : " ",
                           cell % field.columns - field.start_column());
      row = cell / field.columns;
    }
    lines +=
        wrapped(fmt::format("{:>11} {}", percents(path.share) + " %", gates), std::string(13, ' '));
  }
  return fmt::format(
      "\nMost frequent paths to \"{}\": columns i_x of their gates (>: the next gate is in the "
      "same "
      "row)\n{}{}",
      target_name(f), lines,
      paths.gave_up         ? "  (there are very many paths; the search for more was stopped)\n"
      : paths.paths.empty() ? "  (none)\n"
                            : "");
}

/// A table of all parameters that change the target's probability.
std::string parameters_part(const AnalysedField& f) {
  const lattice::Analysis& a = f.analysis;
  const auto effects = sorted_effects(f);
  if (effects.empty()) return "";
  // The chain of the parameters has more runs than the chain of the endings above.
  const std::string chance = percents(f.parameters.chance),
                    answer = percents(f.answer.endings.share[static_cast<std::size_t>(a.target)]);
  std::string text = fmt::format(
      "\nInfluences on \"{}\" ({} %): slope, % of its chance per % of each number, over +-{} %\n",
      target_name(f), chance, digits(100.0 * f.step));
  if (chance != answer && f.parameters.pool_runs > 0)
    text +=
        wrapped(fmt::format("({} % comes from the larger chain of {} gate runs behind this "
                            "table. The answer is the {} % above.)",
                            chance, f.parameters.pool_runs, answer));
  for (const lattice::ParameterEffect& e : effects) {
    std::string line = elasticity_text(f, e);
    if (!e.of_type.empty())
      line += "; by type of gate: " +
              types_text(f.shown.types, [&](std::size_t t) { return e.of_type[t].mean; });
    if (e.bends)
      line += fmt::format("; with more of it {}, with less {}", fixed(e.more, 2), fixed(e.less, 2));
    if (is_steep(f, e)) line += "; steep";
    text += wrapped(fmt::format("  {:<36}{}", e.key, line), std::string(40, ' '));
  }
  return text +
         (a.by_groups
              ? "Each number is changed alone, in gates of all types. The 95 % intervals include "
                "sampling error\nand the chain's own approximation error.\n"
              : "") +
         wrapped(
             "steep: 1 % or one step changes the chance by more than a tenth of its value, or "
             "more and less of the number differ. The slope then does not tell what a small "
             "change does: gatewalk predict SCENE --set KEY=VALUE does.");
}

std::string types_part(const AnalysedField& f) {
  const lattice::Analysis& a = f.analysis;
  const std::vector<std::string>& types = f.shown.types;
  if (types.empty() || std::isnan(a.gates.mean)) return "";
  std::string text = fmt::format(
      "\nBy type of gate\n  visits per body: {}\n  % of these visits that trap the body: {}\n",
      types_text(types, [&](std::size_t t) { return a.types[t].visits; }),
      types_text(types,
                 [&](std::size_t t) { return 100.0 * a.types[t].trapped / a.types[t].visits; }));
  if (!a.type_trapping.empty())
    text +=
        fmt::format("  % by which \"{}\" grows for 1 % fewer of the trapped: {}\n", target_name(f),
                    types_text(types, [&](std::size_t t) { return a.type_trapping[t]; }));
  return text;
}

/// The chain's error after merging its states, as --lump says.
std::string lumping_text(const lattice::Analysis& a) {
  if (!a.lumped) return "";
  return wrapped(fmt::format(
      "Merged into {} (--lump), the chain errs by a total variation of {} in the endings and {} in "
      "the final gates.",
      counted(a.lumped->states, "state", "states"), fixed(a.lumped->endings, 4),
      fixed(a.lumped->final_gates, 4)));
}
bool is_asked_lumping(const lattice::Analysis& a) {
  return std::ranges::any_of(a.lumping, [](int parts) { return parts != 1; });
}

std::int64_t lines_of(const std::string& text) { return std::ranges::count(text, '\n'); }

}  // namespace

std::string answer_text(const AnalysedField& f, std::int64_t lines_below) {
  constexpr std::int64_t kLines = 15;
  const lattice::EndingShares& shares = f.answer.endings;
  const auto at = static_cast<std::size_t>(f.analysis.target);
  const bool is_of_more = f.passage || f.shares;  // the endings then belong to the details
  std::string text = f.passage ? text_of(*f.passage) : "";
  text += f.shares    ? fmt::format("{:<11}  {} %\n", target_name(f),
                                    with_interval(shares.share[at], shares.interval[at]))
          : f.passage ? ""
                      : endings_text(shares, "of all bodies", impossible_endings(f.shown));
  if (!is_of_more) text += unequal_sides(f.shown);
  if (!f.shares) text += means_text(f.analysis);
  text += direct_text(f);
  if (f.shares) text += answer_text(*f.shares);
  std::string below =
      (is_asked_lumping(f.analysis) ? lumping_text(f.analysis) : "") + basis_text(f);
  if (!is_of_more) {
    constexpr std::int64_t kMost = 3;
    const std::int64_t room = kLines - lines_below - lines_of(text) - lines_of(below) - 2;
    const auto most = static_cast<std::size_t>(std::clamp<std::int64_t>(room, 0, kMost));
    text += largest_effects(f, most);
    below += beware_text(f, most);
  }
  return text + below;
}

std::string details_text(const AnalysedField& f) {
  const lattice::Analysis& a = f.analysis;
  std::string text = "\n";
  if (f.passage || f.shares)
    text += endings_text(f.answer.endings, "of all bodies, 95 % intervals",
                         impossible_endings(f.shown));
  text += limits_text(f.shown) + rest_text(f.answer.rest);
  if (!a.gates.why_none.empty())
    text += wrapped(fmt::format("{}: {}.",
                                std::isnan(a.gates.mean)
                                    ? "Gates visited, visits, times and costs are not known"
                                    : "The mean number of gates has no interval",
                                a.gates.why_none));
  if (f.answer.from_trials)
    text += wrapped(fmt::format(
        "The endings come from the full trials, which are more precise here than the chain. All "
        "other numbers come from the chain, by which \"{}\" is {} %.",
        target_name(f), percents(a.target_chance)));
  text += costs_part(f);
  if (!std::isnan(a.gates.mean))
    text += "\n" + map_of(a.totals.visits, f.shown.field.start_column(), "visits of each gate",
                          "per 100 bodies");
  text += endless_part(a) + paths_part(f);
  if (std::ssize(a.starts) > a.told_starts())
    text +=
        wrapped(fmt::format("Other starts: --json lists the {} of {} ways to enter that were "
                            "entered most, and --figure "
                            "draws all of them.",
                            a.told_starts(), a.starts.size()));
  text += parameters_part(f) + types_part(f);
  if (!is_asked_lumping(a)) text += "\n" + lumping_text(a);
  if (f.shares) text += details_text(*f.shares);
  return text + fmt::format("\nTime: {} s.\n", fixed(f.seconds(), 2));
}

}  // namespace gatewalk::cli
