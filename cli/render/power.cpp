// SPDX-License-Identifier: MIT
#include "cli/render/power.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "cli/render/final_gates.h"
#include "cli/render/json.h"
#include "cli/render/text.h"

namespace gatewalk::cli {
namespace {

using lattice::Effect;
using lattice::ExperimentOptions;

std::size_t place(const EndingName& e) { return static_cast<std::size_t>(e.ending); }

Json to_json(const lattice::StartAnswer& a) {
  Json json;
  const lattice::EndingShares shown = shown_endings(a.endings, a.final);
  json["endings"] = endings(shown.share);
  json["endings_95"] = endings_95(shown);
  json["never_sampled"] = a.final.unsampled;
  json["still_walking"] = a.final.remainder;
  json["final_gates"] = grid(a.final.final_cells);
  json["answer_from"] = a.from_trials ? "trials" : "chain";
  json["error_95"] = a.error.total_variation;
  return json;
}

/// `of_ending`: endings are looked at by themselves or all together.
Json to_json(const Effect& effect, const ExperimentOptions& options, bool of_ending) {
  Json json;
  json[of_ending ? "percentage_points" : "total_variation"] =
      (of_ending ? 100.0 : 1.0) * effect.difference;
  json["trials"] = or_null(effect.trials);
  if (of_ending) json["trials_if_all_are_looked_at"] = or_null(effect.trials_of_all);
  if (options.trials) json["power"] = or_null(effect.power);
  json["within_error_of_prediction"] = effect.within_error;
  return json;
}

std::string trials_text(const std::optional<std::int64_t>& trials) {
  return trials ? std::to_string(*trials) : ">" + std::to_string(lattice::kMostPlanned);
}

/// "29 (41)", with ? where the prediction may be as much off.
std::string effect_text(const Effect& effect) {
  return trials_text(effect.trials) + " (" + trials_text(effect.trials_of_all) + ")" +
         (effect.within_error ? "?" : " ");
}

std::string power_text(const Effect& effect) {
  return effect.power ? fixed(100.0 * *effect.power, 0) + " %" : "-";
}

constexpr int kName = -12, kShare = 10, kCell = 20;

std::string share_text(const lattice::StartAnswer& a, std::size_t e) {
  const lattice::EndingShares shown = shown_endings(a.endings, a.final);
  return padded(percents(shown.share[place(kAllEndingNames[e])]), kShare);
}

std::string sureness(const ExperimentOptions& options) {
  return digits(100.0 * options.goal.power) + " % power at a level of " +
         digits(100.0 * options.goal.level) + " %";
}

/// In this prediction alone; and in both.
std::vector<std::size_t> looked_at(const PlannedExperiment& p) {
  return lattice::endings_to_look_at(p.prediction, p.prediction);
}
std::vector<std::size_t> looked_at_apart(const PlannedExperiment& p) {
  return lattice::endings_to_look_at(p.prediction, *p.other);
}

/// A line under a table: its brackets and columns, and the marks that its rows have.
std::string legend(const std::string& rows, const std::string& always) {
  std::string text = always;
  const auto explain = [&](const char* mark, const std::string& what) {
    if (rows.find(mark) != rows.npos) text += (text.empty() ? "" : ";\n") + what;
  };
  explain("?", "?: the prediction may itself be as far off, a smaller --accuracy makes it better");
  explain(">",
          ">" + std::to_string(lattice::kMostPlanned) + ": more, or there is no such difference");
  explain("none", "none: no difference is found so often");
  explain(" - ", "-: there is no such difference");
  return text.empty() ? text : text + ".\n";
}

constexpr const char* kBrackets = "29 (41): 29 if this ending alone is looked at, 41 if all are";

std::string needed_table(const PlannedExperiment& p) {
  std::string text = "\nOne experiment against the model: trials needed, for " +
                     sureness(p.options) +
                     ",\nto see that an ending is so many percentage points more or less often "
                     "than predicted (the worse of both):\n\n" +
                     padded("", kName) + padded("predicted", kShare);
  for (const double d : lattice::kShareDifferences)
    text += padded(digits(100.0 * d) + " points ", kCell);
  std::string rows = "\n";
  for (const std::size_t e : looked_at(p)) {
    rows += padded(kAllEndingNames[e].name, kName) + share_text(p.prediction, e);
    for (const Effect& effect : p.plan.endings[e].effects)
      rows += padded(effect_text(effect), kCell);
    rows += "\n";
  }
  text += rows + legend(rows, kBrackets) +
          "\nThe same, to see that the final gates differ by a total variation of so much, spread "
          "over all of them\n(the hardest to see):\n\n" +
          padded("", kName) + padded("", kShare);
  for (const double d : lattice::kTotalVariations) text += padded(digits(d) + " ", kCell);
  rows = "\n" + padded("final gates", kName) + padded("", kShare);
  for (const Effect& effect : p.plan.final_gates)
    rows += padded(trials_text(effect.trials) + (effect.within_error ? "?" : " "), kCell);
  return text + rows + "\n" + legend(rows, "");
}

std::string groups_table(const PlannedExperiment& p) {
  std::string text =
      "\nTwo groups, such as animals with and without a treatment, one of which ends as predicted: "
      "trials of each group,\nfor " +
      sureness(p.options) +
      ", to see that an ending is so many points more or less often in the other\n(the worse of "
      "both):\n\n" +
      padded("", kName) + padded("predicted", kShare);
  for (const double d : lattice::kGroupDifferences)
    text += padded(digits(100.0 * d) + " points ", kCell);
  std::string rows = "\n";
  for (const std::size_t e : looked_at(p)) {
    rows += padded(kAllEndingNames[e].name, kName) + share_text(p.prediction, e);
    for (const Effect& effect : p.plan.endings[e].of_groups)
      rows += padded(effect_text(effect), kCell);
    rows += "\n";
  }
  return text + rows +
         legend(rows, std::string(kBrackets) +
                          ". Trials are those of different animals: m trials of one animal\ncount "
                          "for m / (1 + (m - 1) r), where r is the correlation between them");
}

std::string power_table(const PlannedExperiment& p) {
  const std::string n = std::to_string(*p.options.trials),
                    often = digits(100.0 * p.options.goal.power) + " %";
  std::string text = "\nOne experiment of " + n + (n == "1" ? " trial" : " trials") +
                     " against the model: how likely a difference of so many points is found, "
                     "and\nthe smallest that is found in " +
                     often + " of such experiments:\n\n" + padded("", kName) +
                     padded("predicted", kShare);
  for (const double d : lattice::kShareDifferences)
    text += padded(digits(100.0 * d) + " points", 11);
  text += padded("smallest", 16);
  std::string rows = "\n";
  for (const std::size_t e : looked_at(p)) {
    const lattice::EndingPlan& plan = p.plan.endings[e];
    rows += padded(kAllEndingNames[e].name, kName) + share_text(p.prediction, e);
    for (const Effect& effect : plan.effects) rows += padded(power_text(effect), 11);
    rows += padded(text_of(plan.least), 16) + "  (" + text_of(plan.least_of_all) + ")\n";
  }
  rows += padded("final gates", kName) + padded("", kShare);
  for (std::size_t k = 0; k < p.plan.final_gates.size(); ++k)
    rows +=
        "  TV " + digits(lattice::kTotalVariations[k]) + ": " + power_text(p.plan.final_gates[k]);
  rows += "  smallest TV " +
          (p.plan.least_total_variation ? fixed(*p.plan.least_total_variation, 3) : "none") + "\n";
  return text + rows +
         legend(rows,
                "+5.0 / -4.0: 5 points more, or 4 fewer, than predicted; in brackets: if all "
                "endings are looked at;\nTV: total variation");
}

std::string versus_table(const PlannedExperiment& p) {
  std::string keys;
  for (const std::string& key : p.versus) keys += (keys.empty() ? "" : ", ") + key;
  const std::string n = p.options.trials ? std::to_string(*p.options.trials) : "";
  std::string text = "\nTwo experiments" + (n.empty() ? "" : " of " + n + " trials each") +
                     (p.other_scene ? ", one of this scene, one with\n"
                                    : ", one with this group, one with that of\n") +
                     keys + ":\ntrials of each that tell them apart, for " + sureness(p.options) +
                     ":\n\n" + padded("", kName) + padded("predicted", kShare) +
                     padded("versus", kShare) + padded("trials of each ", kCell);
  if (p.options.trials) text += padded("power of " + n + " each", 20);
  const auto power = [&](const Effect& effect) {
    return p.options.trials ? padded(power_text(effect), 20) : "";
  };
  std::string rows = "\n";
  for (const std::size_t e : looked_at_apart(p)) {
    const Effect& effect = p.apart->endings[e];
    rows += padded(kAllEndingNames[e].name, kName) + share_text(p.prediction, e) +
            share_text(*p.other, e) + padded(effect_text(effect), kCell) + power(effect) + "\n";
  }
  const Effect& gates = p.apart->final_gates;
  rows += padded("final gates", kName) +
          padded("total variation " + fixed(gates.difference, 3), 2 * kShare) +
          padded(trials_text(gates.trials) + (gates.within_error ? "?" : " "), kCell) +
          power(gates) + "\n";
  return text + rows + legend(rows, kBrackets);
}

/// "12 to 15"
std::string from_to(std::optional<double> least, std::optional<double> most) {
  const std::string low = fixed(100.0 * least.value_or(0.0), 0),
                    high = fixed(100.0 * most.value_or(0.0), 0);
  return low == high ? low : low + " to " + high;
}

/// What so many trials show.
std::string shown_by(const PlannedExperiment& p) {
  const std::string n = std::to_string(*p.options.trials);
  const std::string begin =
      "In " + digits(100.0 * p.options.goal.power) + " of 100 experiments " + n + " trials show ";
  std::optional<double> least, most;
  for (const std::size_t e : looked_at(p)) {
    const lattice::SmallestDifference& all = p.plan.endings[e].least_of_all;
    for (const auto& d : {all.more, all.fewer})
      if (d) {
        least = std::min(*d, least.value_or(*d));
        most = std::max(*d, most.value_or(*d));
      }
  }
  const std::string gates = p.plan.least_total_variation
                                ? "final gates that differ by a total variation of " +
                                      fixed(*p.plan.least_total_variation, 2)
                                : "";
  if (!least && gates.empty()) return begin + "no difference from this prediction.";
  return begin +
         (least ? "an ending that is " + from_to(least, most) + " points off, by ending" : "") +
         (least && !gates.empty() ? ", or " : "") + gates + ".";
}

/// The most trials that any ending takes to be seen `at` kShareDifferences off.
std::string trials_of_endings(const PlannedExperiment& p, std::size_t at) {
  std::int64_t most = 0;
  for (const std::size_t e : looked_at(p))
    most = std::max(
        most, p.plan.endings[e].effects[at].trials_of_all.value_or(lattice::kMostPlanned + 1));
  return trials_text(most > lattice::kMostPlanned ? std::optional<std::int64_t>() : most);
}

/// What it takes to tell the scene from the other one.
std::string told_apart(const PlannedExperiment& p) {
  std::optional<std::int64_t> by_ending;
  std::string name;
  for (const std::size_t e : looked_at_apart(p))
    if (const auto& n = p.apart->endings[e].trials_of_all; n && (!by_ending || *n < *by_ending)) {
      by_ending = n;
      name = kAllEndingNames[e].name;
    }
  std::string keys;
  for (const std::string& key : p.versus) keys += (keys.empty() ? "" : ", ") + key;
  const Effect& gates = p.apart->final_gates;
  std::string text = (p.other_scene ? "To tell this scene from " : "To tell this group from ") +
                     keys + " so often takes " + trials_text(gates.trials) +
                     " trials of each by their final gates, " + trials_text(by_ending) +
                     " by their endings" + (by_ending ? " (" + name + ")" : "");
  if (p.options.trials && gates.power)
    text += "; " + std::to_string(*p.options.trials) + " of each do in " +
            fixed(100.0 * *gates.power, 0) + " of 100 experiments by their final gates";
  return text + ".";
}

/// What these trials show, and what it takes.
std::array<std::string, 2> summary_of(const PlannedExperiment& p) {
  constexpr std::size_t kPoints = 2, kGates = 2;  // 10 points, a total variation of 0.2
  const std::string often = " in " + digits(100.0 * p.options.goal.power) + " of 100 experiments";
  const std::string of_endings = "To see any one ending " +
                                 digits(100.0 * lattice::kShareDifferences[kPoints]) +
                                 " points more or less often" + often + " takes up to " +
                                 trials_of_endings(p, kPoints) + " trials",
                    of_gates = "final gates a total variation of " +
                               digits(lattice::kTotalVariations[kGates]) + " off " +
                               trials_text(p.plan.final_gates[kGates].trials);
  if (p.options.trials)
    return {shown_by(p), p.apart ? told_apart(p) : of_endings + ", " + of_gates + "."};
  if (p.apart) return {of_endings + ", " + of_gates + ".", told_apart(p)};
  return {of_endings + ".", "To see " + of_gates.substr(0, of_gates.rfind(' ')) + often + " takes" +
                                of_gates.substr(of_gates.rfind(' ')) + "."};
}

}  // namespace

Json or_null(const std::optional<double>& x) { return x ? Json(*x) : Json(); }
Json or_null(const std::optional<std::int64_t>& x) { return x ? Json(*x) : Json(); }

Json to_json(const lattice::SmallestDifference& d) {
  const auto points = [](const std::optional<double>& x) { return x ? Json(100.0 * *x) : Json(); };
  return {{"more", points(d.more)}, {"fewer", points(d.fewer)}};
}

std::string text_of(const lattice::SmallestDifference& d) {
  const auto text = [](const char* sign, const std::optional<double>& x) {
    return x ? sign + fixed(100.0 * *x, 1) : std::string("none");
  };
  return text("+", d.more) + " / " + text("-", d.fewer);
}

Json to_json(const PlannedExperiment& p) {
  Json json = to_json(p.prediction);
  json["summary"] = summary_of(p);
  json["power"] = p.options.goal.power;
  json["level"] = p.options.goal.level;
  if (p.options.trials) json["trials"] = *p.options.trials;
  Json& off = json["from_prediction"];
  for (const std::size_t e : looked_at(p))
    for (const Effect& effect : p.plan.endings[e].effects)
      off["endings"][kAllEndingNames[e].key].push_back(to_json(effect, p.options, true));
  for (const Effect& effect : p.plan.final_gates)
    off["final_gates"].push_back(to_json(effect, p.options, false));
  for (const std::size_t e : looked_at(p))
    for (const Effect& effect : p.plan.endings[e].of_groups) {
      Json of_groups = to_json(effect, p.options, true);
      of_groups.erase("within_error_of_prediction");  // it is of the two groups alone
      json["two_groups"]["endings"][kAllEndingNames[e].key].push_back(std::move(of_groups));
    }
  if (p.options.trials) {
    Json& least = json["smallest_difference"];
    for (const std::size_t e : looked_at(p)) {
      const lattice::EndingPlan& plan = p.plan.endings[e];
      least["endings_percentage_points"][kAllEndingNames[e].key] = to_json(plan.least);
      least["endings_percentage_points_if_all_are_looked_at"][kAllEndingNames[e].key] =
          to_json(plan.least_of_all);
    }
    least["final_gates_total_variation"] = or_null(p.plan.least_total_variation);
  }
  if (!p.apart) return json;
  Json& versus = json["versus"];
  versus["set"] = p.versus;
  versus.update(to_json(*p.other));
  for (const std::size_t e : looked_at_apart(p))
    versus["apart"]["endings"][kAllEndingNames[e].key] =
        to_json(p.apart->endings[e], p.options, true);
  versus["apart"]["final_gates"] = to_json(p.apart->final_gates, p.options, false);
  if (p.other_scene) versus["scene"] = lattice::to_toml(*p.other_scene);
  return json;
}

std::string table_of(const PlannedExperiment& p) {
  const auto sentences = summary_of(p);
  std::string text = sentences[0] + "\n" + sentences[1] + "\n\n" +
                     endings_text(shown_endings(p.prediction.endings, p.prediction.final),
                                  "of all bodies as predicted, 95 % intervals") +
                     rest_text(rest_of(p.prediction.final)) + "error: at most " +
                     fixed(p.prediction.error.total_variation, 4) +
                     " in total variation of the final gates, 95 times in 100\n" + needed_table(p) +
                     groups_table(p);
  if (p.options.trials) text += power_table(p);
  if (p.apart) text += versus_table(p);
  return text;
}

}  // namespace gatewalk::cli
