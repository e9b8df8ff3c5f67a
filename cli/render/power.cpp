// SPDX-License-Identifier: MIT
#include "cli/render/power.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "cli/fields/text.h"
#include "cli/fields/text_table.h"
#include "cli/render/choice.h"
#include "cli/render/final_gates.h"
#include "cli/render/health.h"
#include "cli/render/pooled_prediction.h"

namespace gatewalk::cli {
namespace {

using lattice::Effect;
using lattice::EndingPlan;
using lattice::ExperimentOptions;

/// The endings to test: those of this prediction; and those of both predictions.
std::vector<std::size_t> looked_at(const PowerResult& p) {
  return lattice::endings_to_look_at(p.prediction, p.prediction);
}
std::vector<std::size_t> looked_at_apart(const PowerResult& p) {
  return lattice::endings_to_look_at(p.prediction, p.versus->prediction);
}

// ---- The result ----

/// Where bodies end by a prediction.
void describe(Fields& out, const lattice::StartAnswer& a) {
  describe_endings(out, shown_endings(a.endings, a.final));
  describe(out, rest_of(a.final));
  out.grid({"final_gates", "1", "share of all bodies by the gate in which they end"},
           a.final.final_cells);
  describe_answer_from(out, a.from_trials);
  describe_error(out, a.error.total_variation);
}

/// What differs: an ending from the prediction, an ending between two groups, or the final gates.
enum class Differs { ending, ending_of_groups, final_gates };

void describe(Fields& out, const Effect& effect, const ExperimentOptions& options, Differs what) {
  if (what == Differs::final_gates)
    out.number({"total_variation", "1", "total variation of the final gates between the two"},
               effect.difference);
  else
    out.number({"percentage_points", "%",
                "difference of the ending's share, in percentage points (versus: other less this)"},
               100.0 * effect.difference);
  out.count(
      {"trials", "1",
       "trials (of each experiment) that detect the difference; null: over 100 000, or impossible"},
      effect.trials);
  if (what != Differs::final_gates)
    out.count({"trials_if_all_are_looked_at", "1",
               "trials that detect the difference when all endings are tested; null as for trials"},
              effect.trials_of_all);
  out.optional(options.trials.has_value(), [&](Fields& f) {
    f.number(
        {"power", "1",
         "share of experiments of the planned trials that detect the difference; null: impossible"},
        effect.power.value_or(kUnknown));
  });
  if (what != Differs::ending_of_groups)
    out.flag({"within_error_of_prediction",
              "whether the prediction's own error may be as large as the difference"},
             effect.within_error);
}

/// An object with a key for each of these endings; `kind` names the object there.
template <class Describe>
void by_ending(Fields& out, const Label& label, const std::vector<std::size_t>& endings,
               std::string_view kind, Describe describe) {
  out.object(label, [&](Fields& f) {
    for (std::size_t e = 0; e < kAllEndingNames.size(); ++e)
      f.optional(std::ranges::count(endings, e) > 0, [&](Fields& o) {
        const EndingName& name = kAllEndingNames[e];
        describe(o, Label(name.key, fmt::format("bodies that {}", meaning_of(name))).shared(kind),
                 e);
      });
  });
}

template <std::size_t n>
void describe_plans(Fields& out, const PowerResult& p, std::array<Effect, n> EndingPlan::*effects,
                    Differs what) {
  by_ending(out, {"endings", "a list for each ending, by size of the difference"}, looked_at(p),
            what == Differs::ending ? "differences" : "differences_of_groups",
            [&](Fields& f, const Label& ending, std::size_t e) {
              f.list(ending, p.plan.endings[e].*effects, [&](Fields& item, const Effect& effect) {
                describe(item, effect, p.options, what);
              });
            });
}

void describe_smallest(Fields& out, const PowerResult& p) {
  const auto points = [&](const Label& label, lattice::SmallestDifference EndingPlan::*least) {
    by_ending(out, label, looked_at(p), "smallest_difference",
              [&](Fields& f, const Label& ending, std::size_t e) {
                f.object(ending, [&](Fields& d) { describe(d, p.plan.endings[e].*least); });
              });
  };
  points({"endings_percentage_points", "smallest differences if only one ending is tested"},
         &EndingPlan::least);
  points({"endings_percentage_points_if_all_are_looked_at",
          "smallest differences if all endings are tested"},
         &EndingPlan::least_of_all);
  out.number({"final_gates_total_variation", "1",
              "smallest detected total variation of the final gates; null: none is detected"},
             p.plan.least_total_variation.value_or(kUnknown));
}

void describe(Fields& out, const PowerVersus& versus, const PowerResult& p) {
  out.texts({"set", "values of --versus: keys of the other scene, or a matrix"}, versus.set);
  describe(out, versus.prediction);
  out.object({"apart", "trials that tell the two predictions apart"}, [&](Fields& apart) {
    by_ending(apart, {"endings", "trials that tell them apart by one ending"},
              lattice::endings_to_look_at(p.prediction, versus.prediction), "difference",
              [&](Fields& f, const Label& ending, std::size_t e) {
                f.object(ending, [&](Fields& effect) {
                  describe(effect, versus.apart.endings[e], p.options, Differs::ending);
                });
              });
    apart.object({"final_gates", "trials that tell them apart by the final gates"}, [&](Fields& f) {
      describe(f, versus.apart.final_gates, p.options, Differs::final_gates);
    });
  });
  out.optional(versus.scene.has_value(), [&](Fields& f) {
    f.text({"scene", "the other scene, as TOML; absent for a matrix"},
           versus.scene ? lattice::to_toml(*versus.scene) : "");
  });
}

// ---- Tables ----

std::string trials_text(const std::optional<std::int64_t>& trials) {
  return trials ? std::to_string(*trials) : fmt::format(">{}", lattice::kMostPlanned);
}

/// " fewer" or " more" if the share can change by this much in that direction only; else empty.
std::string only_direction(double share, double difference) {
  if (share + difference > 1.0) return " fewer";
  return share - difference < 0.0 ? " more" : "";
}
std::string only_direction(const lattice::StartAnswer& a, std::size_t e, const Effect& effect) {
  const auto at = static_cast<std::size_t>(kAllEndingNames[e].ending);
  return only_direction(std::clamp(a.final.endings[at], 0.0, 1.0), effect.difference);
}

/// "29 (41)", "29 (41) fewer"; followed by ? if the prediction's own error may be as large.
std::string effect_text(const Effect& effect, const std::string& direction) {
  return fmt::format("{} ({}){}{}", trials_text(effect.trials), trials_text(effect.trials_of_all),
                     direction, effect.within_error ? "?" : " ");
}
/// "29"; followed by ? if the prediction's own error may be as large.
std::string gates_text(const Effect& effect) {
  return trials_text(effect.trials) + (effect.within_error ? "?" : " ");
}

std::string power_text(const Effect& effect) {
  return effect.power ? fixed(100.0 * *effect.power, 0) + " %" : "-";
}

constexpr int kName = -12, kShare = 10, kCell = 18;

lattice::EndingShares predicted_shares(const lattice::StartAnswer& a) {
  return shown_endings(a.endings, a.final);
}

std::string share_text(const lattice::StartAnswer& a, std::size_t e) {
  return percents(predicted_shares(a).share[static_cast<std::size_t>(kAllEndingNames[e].ending)]);
}

std::string sureness(const ExperimentOptions& options) {
  return fmt::format("power {} %, level {} %", digits(100.0 * options.goal.power),
                     digits(100.0 * options.goal.level));
}

/// What makes the prediction more precise.
const char* more_precise(const PowerResult& p) {
  return p.recorded ? "more recorded bodies help" : "a smaller --accuracy helps";
}

/// The legend under a table: `always`, and a line for each mark that occurs in `rows`.
std::string legend(const PowerResult& p, const std::string& rows, const std::string& always) {
  std::string text = always;
  const auto explain = [&](const char* mark, const std::string& what) {
    if (rows.find(mark) != rows.npos) text += what + "\n";
  };
  explain("?", fmt::format("?: the prediction itself may be off by as much; {}.", more_precise(p)));
  explain(">", fmt::format(">{}: more trials than that, or such a shift is impossible.",
                           lattice::kMostPlanned));
  explain("none", "none: no shift is detected this often.");
  explain(" fewer", "fewer: so many points more would be over 100 %; the number is for fewer.");
  explain(" more", "more: so many points fewer would be below 0 %; the number is for more.");
  explain(" - ", "-: such a shift is impossible.");
  return text;
}

constexpr const char* kBrackets =
    "First number: trials if only this ending is tested; in brackets: if all endings are tested.\n";

/// A table of endings: names, predicted shares, and a column for each difference with this width,
/// headed by the difference times `scale` and `behind`; then the columns `more`.
template <std::size_t n>
TextTable table_of_endings(const std::array<double, n>& differences, int width, const char* behind,
                           std::vector<TextColumn> more = {}, const char* share = "predicted",
                           double scale = 100.0) {
  std::vector<TextColumn> columns{{"", kName}, {share, kShare}};
  for (const double d : differences) columns.push_back({digits(scale * d) + behind, width});
  columns.insert(columns.end(), more.begin(), more.end());
  return TextTable(std::move(columns));
}

/// A line of table_of_endings(); `text` writes an effect.
template <std::size_t n, class Text>
std::vector<TextCell> line_of(const std::string& name, const std::string& share,
                              const std::array<Effect, n>& effects, Text text) {
  std::vector<TextCell> cells{name, share};
  for (const Effect& effect : effects) cells.emplace_back(text(effect));
  return cells;
}

/// Adds a line for each ending to test.
template <std::size_t n>
void add_lines(TextTable& table, const PowerResult& p, std::array<Effect, n> EndingPlan::*effects) {
  for (const std::size_t e : looked_at(p))
    table.row(line_of(kAllEndingNames[e].name, share_text(p.prediction, e),
                      p.plan.endings[e].*effects, [&](const Effect& effect) {
                        return effect_text(effect, only_direction(p.prediction, e, effect));
                      }));
}

std::string needed_table(const PowerResult& p) {
  TextTable endings = table_of_endings(lattice::kShareDifferences, kCell, " points "),
            gates = table_of_endings(lattice::kTotalVariations, kCell, " ", {}, "", 1.0);
  add_lines(endings, p, &EndingPlan::effects);
  gates.row(line_of("final gates", "", p.plan.final_gates, gates_text));
  return fmt::format(
      "\nOne experiment against the model: trials needed ({}) to detect that\n"
      "an ending is so many points more or less often than predicted (the larger of both "
      "numbers,\nif both are possible):\n"
      "\n{}{}\n"
      "Trials needed to detect that the final gates differ by this total variation, spread over "
      "all\n"
      "gates (the difference that is hardest to detect):\n\n{}{}",
      sureness(p.options), endings.text(), legend(p, endings.rows(), kBrackets), gates.text(),
      legend(p, gates.rows(), ""));
}

std::string groups_table(const PowerResult& p) {
  TextTable table = table_of_endings(lattice::kGroupDifferences, kCell, " points ");
  add_lines(table, p, &EndingPlan::of_groups);
  return fmt::format(
      "\nTwo groups, such as animals with and without a treatment: trials of each group needed\n"
      "({}) to detect that an ending differs between the groups by so many points.\n"
      "One group ends as predicted; the number is the larger one for more and less often, if both\n"
      "are possible:\n\n{}{}",
      sureness(p.options), table.text(),
      legend(p, table.rows(), kBrackets) +
          "The trials must come from different animals: m trials of one animal count as\n"
          "m / (1 + (m - 1) r), where r is the correlation between them.\n");
}

std::string power_table(const PowerResult& p) {
  TextTable table = table_of_endings(lattice::kShareDifferences, 11, " points", {{"smallest", 16}});
  for (const std::size_t e : looked_at(p)) {
    const EndingPlan& plan = p.plan.endings[e];
    auto cells =
        line_of(kAllEndingNames[e].name, share_text(p.prediction, e), plan.effects, power_text);
    cells.emplace_back(
        fmt::format("{:>16}  ({})", text_of(plan.least), text_of(plan.least_of_all)));
    table.row(cells);
  }
  std::string gates;
  for (std::size_t k = 0; k < p.plan.final_gates.size(); ++k)
    gates += fmt::format("  TV {}: {}", digits(lattice::kTotalVariations[k]),
                         power_text(p.plan.final_gates[k]));
  const auto& least = p.plan.least_total_variation;
  table.row({"final gates", "",
             fmt::format("{}  smallest TV {}", gates, least ? fixed(*least, 3) : "none")});
  return fmt::format(
      "\nOne experiment of {} against the model: how likely it detects a shift of so many\n"
      "points, and the smallest shift that {} % of such experiments detect:\n\n{}{}",
      counted(*p.options.trials, "trial", "trials"), digits(100.0 * p.options.goal.power),
      table.text(),
      legend(p, table.rows(),
             "+5.0 / -4.0: 5 points more, or 4 fewer, than predicted; in brackets: if all endings "
             "are tested.\nA shift that only one direction allows counts in that direction. TV: "
             "total variation.\n"));
}

std::string versus_table(const PowerResult& p) {
  const auto& [set, other, apart, scene] = *p.versus;
  const std::string n = p.options.trials ? std::to_string(*p.options.trials) : "";
  std::vector<TextColumn> columns{
      {"", kName}, {"predicted", kShare}, {"versus", kShare}, {"trials of each ", kCell}},
      of_gates{{"", kName}, {"", 2 * kShare}, {"", kCell}};
  if (p.options.trials) {
    columns.push_back({fmt::format("power of {} each", n), 20});
    of_gates.push_back(columns.back());
  }
  TextTable endings(columns), gates(of_gates);
  const auto add = [&](TextTable& table, std::vector<TextCell> cells, const Effect& effect) {
    if (p.options.trials) cells.emplace_back(power_text(effect));
    table.row(cells);
  };
  for (const std::size_t e : looked_at_apart(p))
    add(endings,
        {kAllEndingNames[e].name, share_text(p.prediction, e), share_text(other, e),
         effect_text(apart.endings[e], "")},
        apart.endings[e]);
  add(gates,
      {"final gates", "total variation " + fixed(apart.final_gates.difference, 3),
       gates_text(apart.final_gates)},
      apart.final_gates);
  return fmt::format(
      "\nTwo experiments{}, one {}\n{}Trials of each that tell them apart ({}):\n\n{}{}{}",
      n.empty() ? "" : fmt::format(" of {} trials each", n),
      scene ? "with this scene, one with" : "with this group, one with the group of",
      wrapped(fmt::format("{}.", fmt::join(set, ", "))), sureness(p.options), endings.text(),
      gates.rows(), legend(p, endings.rows() + gates.rows(), kBrackets));
}

// ---- Sentences ----

/// "260 trials", "more than 100000 trials"
std::string trials_words(const std::optional<std::int64_t>& trials) {
  return trials ? counted(*trials, "trial", "trials")
                : fmt::format("more than {} trials", lattice::kMostPlanned);
}

/// The larger of the two shifts, up and down, that are detected.
std::optional<double> larger(const lattice::SmallestDifference& d) {
  if (d.more && d.fewer) return std::max(*d.more, *d.fewer);
  return d.more ? d.more : d.fewer;
}

/// "You detect a shift of 12.1 points in crossed, 15.3 in trapped, or a total variation of ..."
std::string shown_by(const PowerResult& p) {
  const std::string begin =
      fmt::format("With {} (power {} %) you detect ", counted(*p.options.trials, "trial", "trials"),
                  digits(100.0 * p.options.goal.power));
  std::vector<std::string> shifts;
  for (const std::size_t e : looked_at(p))
    if (const auto least = larger(p.plan.endings[e].least_of_all))
      shifts.push_back(fmt::format("{}{} in {}", fixed(100.0 * *least, 1),
                                   shifts.empty() ? " points" : "", kAllEndingNames[e].name));
  const std::string gates = p.plan.least_total_variation
                                ? "a total variation of " +
                                      fixed(*p.plan.least_total_variation, 2) +
                                      " in the final gates"
                                : "";
  if (shifts.empty() && gates.empty()) return begin + "no difference from this prediction.";
  return fmt::format("{}{}{}{}{}.", begin, shifts.empty() ? "" : "a shift of ",
                     fmt::join(shifts, ", "), shifts.empty() || gates.empty() ? "" : ", or ",
                     gates);
}

/// The number of trials that detect the effect number `at` in every ending; nullopt: over
/// kMostPlanned.
template <std::size_t n>
std::optional<std::int64_t> trials_of_endings(const PowerResult& p,
                                              std::array<Effect, n> EndingPlan::*effects,
                                              std::size_t at) {
  std::int64_t most = 0;
  for (const std::size_t e : looked_at(p)) {
    const auto& trials = (p.plan.endings[e].*effects)[at].trials_of_all;
    if (!trials) return {};
    most = std::max(most, *trials);
  }
  return most;
}

/// A sentence on the trials needed to distinguish the scene from the other one.
std::string told_apart(const PowerResult& p) {
  const auto& [set, other, apart, scene] = *p.versus;
  std::optional<std::int64_t> by_ending;
  std::string name;
  for (const std::size_t e : looked_at_apart(p))
    if (const auto& n = apart.endings[e].trials_of_all; n && (!by_ending || *n < *by_ending)) {
      by_ending = n;
      name = fmt::format(" ({})", kAllEndingNames[e].name);
    }
  const Effect& gates = apart.final_gates;
  std::string text = fmt::format(
      "To tell this {} from {} (power {} %) you need {} of each by the final gates, {} by the "
      "endings{}.",
      scene ? "scene" : "group", fmt::join(set, ", "), digits(100.0 * p.options.goal.power),
      trials_words(gates.trials), trials_words(by_ending), name);
  if (p.options.trials && gates.power)
    text +=
        fmt::format(" {} of each tell them apart in {} of 100 experiments, by the final gates.",
                    counted(*p.options.trials, "trial", "trials"), fixed(100.0 * *gates.power, 0));
  return text;
}

constexpr std::size_t kPoints = 2, kGates = 2;  // 10 points, a total variation of 0.2
constexpr std::size_t kGroupPoints = 1;         // 10 points between two groups

/// A sentence on two groups of equal size.
std::string groups_sentence(const PowerResult& p) {
  return fmt::format(
      "Two groups: you need up to {} of each to detect a shift of {} points (--details: a table).",
      trials_words(trials_of_endings(p, &EndingPlan::of_groups, kGroupPoints)),
      digits(100.0 * lattice::kGroupDifferences[kGroupPoints]));
}

/// Two sentences: what these trials detect, and how many trials are needed.
std::array<std::string, 2> summary_of(const PowerResult& p) {
  const std::string of_endings = fmt::format(
      "One group against the model: you need up to {} to detect a shift of {} points in an ending.",
      trials_words(trials_of_endings(p, &EndingPlan::effects, kPoints)),
      digits(100.0 * lattice::kShareDifferences[kPoints]));
  const std::string of_gates = fmt::format(
      "To detect a total variation of {} in the final gates you need {}.",
      digits(lattice::kTotalVariations[kGates]), trials_words(p.plan.final_gates[kGates].trials));
  if (p.options.trials) return {shown_by(p), p.versus ? told_apart(p) : of_endings};
  if (p.versus) return {of_endings + " " + of_gates, told_apart(p)};
  return {of_endings, of_gates};
}

/// "44 ", "44 fewer ": the trials if all endings are tested; followed by ? if the prediction's own
/// error may be as large.
std::string of_all_text(const Effect& effect, const std::string& direction) {
  return trials_text(effect.trials_of_all) + direction + (effect.within_error ? "?" : " ");
}

/// The endings of the first screen: predicted shares, and the trials that detect a shift.
std::string first_table(const PowerResult& p) {
  constexpr int kWide = 24, kNarrow = 13;
  const lattice::EndingShares shares = predicted_shares(p.prediction);
  const auto predicted = [](const lattice::EndingShares& of, std::size_t e) {
    const auto at = static_cast<std::size_t>(kAllEndingNames[e].ending);
    return with_interval(of.share[at], of.interval[at]);
  };
  std::vector<TextColumn> columns{{"", kName}, {"predicted, %", kWide}};
  if (p.versus) {
    const lattice::EndingShares others = predicted_shares(p.versus->prediction);
    columns.insert(columns.end(), {{"versus, %", kWide}, {"trials of each ", kWide}});
    TextTable table(columns);
    for (const std::size_t e : looked_at_apart(p))
      table.row({kAllEndingNames[e].name, predicted(shares, e), predicted(others, e),
                 of_all_text(p.versus->apart.endings[e], "")});
    return table.text();
  }
  std::vector<std::size_t> differences{1, 2, 3};  // indices into kShareDifferences
  if (p.options.trials) {
    differences.erase(differences.begin());
    columns.push_back({counted(*p.options.trials, "trial", "trials") + " detect", kWide});
  }
  for (const std::size_t d : differences)
    columns.push_back({digits(100.0 * lattice::kShareDifferences[d]) + " points ", kNarrow});
  TextTable table(columns);
  for (const std::size_t e : looked_at(p)) {
    const EndingPlan& plan = p.plan.endings[e];
    std::vector<TextCell> cells{kAllEndingNames[e].name, predicted(shares, e)};
    if (p.options.trials) cells.emplace_back(text_of(plan.least_of_all));
    for (const std::size_t d : differences)
      cells.emplace_back(
          of_all_text(plan.effects[d], only_direction(p.prediction, e, plan.effects[d])));
    table.row(cells);
  }
  return table.text();
}

}  // namespace

void describe(Fields& out, const lattice::SmallestDifference& d) {
  const auto points = [&](const Field& field, const std::optional<double>& x) {
    out.number(field, x ? 100.0 * *x : kUnknown);
  };
  points({"more", "%", "smallest detected increase, in percentage points; null: none is detected"},
         d.more);
  points({"fewer", "%", "smallest detected decrease, in percentage points; null: none is detected"},
         d.fewer);
}

std::string text_of(const lattice::SmallestDifference& d) {
  const auto text = [](const char* sign, const std::optional<double>& x) {
    return x ? sign + fixed(100.0 * *x, 1) : std::string("none");
  };
  return text("+", d.more) + " / " + text("-", d.fewer);
}

void describe(Fields& out, const PowerResult& p) {
  describe(out, p.prediction);
  const auto sentences = summary_of(p);
  out.texts({"summary",
             "two sentences: what the planned trials show, and how many trials a difference takes"},
            {sentences.begin(), sentences.end()});
  out.number(
      {"power", "1", "statistical power: share of experiments that are to detect a difference"},
      p.options.goal.power);
  out.number({"level", "1", "level of significance: share of experiments with a false detection"},
             p.options.goal.level);
  out.if_any({"trials", "1", "planned trials of each experiment, from --trials"}, p.options.trials);
  out.object({"from_prediction", "one experiment compared with the prediction"}, [&](Fields& f) {
    describe_plans(f, p, &EndingPlan::effects, Differs::ending);
    f.list({"final_gates", "a total variation each, spread over all gates: the hardest to detect"},
           p.plan.final_gates, [&](Fields& item, const Effect& effect) {
             describe(item, effect, p.options, Differs::final_gates);
           });
  });
  out.object(
      {"two_groups", "two groups compared with each other; one of them ends as predicted"},
      [&](Fields& f) { describe_plans(f, p, &EndingPlan::of_groups, Differs::ending_of_groups); });
  out.if_any(
      {"smallest_difference", "smallest difference that the planned trials detect with this power"},
      p.options.trials, [&](Fields& least, const auto&) { describe_smallest(least, p); });
  out.if_any({"versus", "the other scene or group, and the trials that tell it from this one"},
             p.versus, [&](Fields& other, const auto& value) { describe(other, value, p); });
  describe_status(out, p.health);
  describe_method(out, p.method);
  describe_made_by(out, p.made_by);
}

std::string answer_text(const PowerResult& p) {
  const auto sentences = summary_of(p);
  const std::string table = first_table(p);
  std::string text = (p.versus ? "" : wrapped(sentences[0])) + wrapped(sentences[1]);
  if (!p.versus) text += wrapped(groups_sentence(p));
  const bool one_way = table.find(" more") != table.npos || table.find(" fewer") != table.npos;
  text += fmt::format("{}, all endings tested ({}){}:\n{}",
                      p.versus ? "Trials of each of two groups" : "Trials of one group",
                      sureness(p.options), one_way ? "; more, fewer: only that way" : "", table);
  text += fmt::format(
      "The predicted final gates are within a total variation of {} of the truth, 95 times in "
      "100.\n",
      digits(p.prediction.error.total_variation, 2));
  if (table.find('?') != table.npos)
    return text + fmt::format(
                      "Beware: ?: within the error bar ({}). Trials of one animal count "
                      "less.\n",
                      more_precise(p));
  return text +
         "Beware: several trials of one animal count less than trials of different animals "
         "(--details).\n";
}

std::string details_text(const PowerResult& p) {
  return fmt::format(
      "\n{}{}{}{}{}{}{}{}", p.versus ? wrapped(summary_of(p)[0]) + "\n" : "",
      endings_text(predicted_shares(p.prediction), "of all bodies as predicted, 95 % intervals"),
      rest_text(rest_of(p.prediction.final)), needed_table(p), groups_table(p),
      p.options.trials ? power_table(p) : "", p.versus ? versus_table(p) : "",
      method_line(p.method));
}

}  // namespace gatewalk::cli
