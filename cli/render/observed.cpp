// SPDX-License-Identifier: MIT
#include "cli/render/observed.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "cli/render/final_gates.h"
#include "cli/render/json.h"
#include "cli/render/power.h"
#include "cli/render/text.h"
#include "cli/render/validation.h"

namespace gatewalk::cli {
namespace {

using lattice::Judgement;

/// A difference that experiments should see, as a share.
constexpr double kFewAreEnough = 0.25;

std::size_t index_of(const EndingName& e) { return static_cast<std::size_t>(e.ending); }

/// What bodies do that end so, in the order of kEndingNames: "fewer cross".
constexpr std::array<const char*, kEndingNames.size()> kDo{
    "cross", "leave by the left side", "leave by the right side", "are trapped", "are cut off"};

std::string p_of(const Judgement& j) { return j.p < 0.001 ? "p < 0.001" : "p = " + fixed(j.p, 3); }

/// The smallest adjusted p-value of the final gates; NaN: they were not counted.
double p_of_gates(const Judgement& j) {
  double least = std::nan("");
  for (const double p :
       {j.total_variation.p_adjusted, j.energy.p_adjusted, j.chi_squared.p_adjusted})
    least = std::fmin(least, p);
  return least;
}

/// "fewer cross, 10.00 [4.22, 19.07] % of them, 28.10 % by the model; final gates, ..."
std::string differences(const lattice::ObservedComparison& c, const Judgement& j,
                        const lattice::EndingShares& model) {
  std::string text;
  const auto say = [&](const std::string& what) { text += (text.empty() ? "" : "; ") + what; };
  for (std::size_t e = 0; e < kEndingNames.size(); ++e) {
    const std::size_t at = index_of(kEndingNames[e]);
    if (!j.differs(kEndingNames[e].ending)) continue;
    say(std::string(c.endings.share[at] < model.share[at] ? "fewer " : "more ") + kDo[e] + ", " +
        with_interval(c.endings.share[at], c.endings.interval[at]) + " % of them, " +
        fixed(100.0 * model.share[at], 2) + " % by the model");
  }
  if (p_of_gates(j) <= Judgement::kLevel)
    say("they end in other gates, total variation " + fixed(j.total_variation.seen, 3) +
        " (chance: " + fixed(j.chance_total_variation, 3) + ")");
  if (j.differs(markov::Ending::unsampled)) say("states never sampled");
  return text;
}

Json against(const std::optional<lattice::Comparison>& gates, const Judgement& j) {
  Json json = cli::to_json(j);
  for (const EndingName& e : kEndingNames) json["p_endings"][e.key] = j.endings[index_of(e)].p;
  if (gates) json["final_gates"] = cli::to_json(*gates);
  return json;
}

Json least_differences(const lattice::ObservedComparison& c) {
  const lattice::LeastDifferences& least = c.least;
  Json json = {{"power", least.goal.power}, {"level", least.goal.level}};
  if (c.seen.has_gates()) json["final_gates_total_variation"] = or_null(least.final_gates);
  if (!c.seen.has_endings()) return json;
  json["endings_total_variation"] = or_null(least.endings);
  for (const EndingName& e : kEndingNames)
    if (!c.endings.rules_out(e.ending))
      json["endings_percentage_points"][e.key] = cli::to_json(c.least.by_ending[index_of(e)]);
  return json;
}

std::string gates_line(const char* name, const lattice::Comparison& c, const Judgement& j) {
  return "  " + padded(name, -12) + padded(fixed(c.corrcoef, 3), 8) + " (" +
         fixed(c.floor.corrcoef, 3) + ")" + padded(fixed(c.rmse_per_100, 3), 9) + " (" +
         fixed(c.floor.rmse_per_100, 3) + ")" + padded(fixed(c.total_variation, 3), 9) + " (" +
         fixed(j.chance_total_variation, 3) + ", " + fixed(j.chance_total_variation_95, 3) + ")" +
         padded(p_text(p_of_gates(j)), 9) + "\n";
}

std::string endings_part(const lattice::ObservedComparison& c, const lattice::StartValidation& v) {
  const auto column = [&](const std::string& header, const lattice::EndingShares& shares) {
    std::vector<std::string> cells{header};
    for (const EndingName& e : kEndingNames)
      cells.push_back(with_interval(shares.share[index_of(e)], shares.interval[index_of(e)]));
    std::size_t width = 0;
    for (const std::string& cell : cells) width = std::max(width, cell.size());
    for (std::string& cell : cells) cell = padded(cell, static_cast<int>(width) + 2);
    return cells;
  };
  const auto observed = column("observed", c.endings),
             dynamics = column("dynamics", v.dynamics_endings),
             chain = column("chain", v.exact_endings);
  std::string text = padded("", 10) + observed[0] + dynamics[0] + chain[0] +
                     "  p: dynamics   chain    seen from, points\n";
  for (std::size_t e = 0; e < kEndingNames.size(); ++e) {
    const std::size_t at = index_of(kEndingNames[e]);
    if (c.endings.rules_out(kEndingNames[e].ending)) continue;
    text += padded(kEndingNames[e].name, -10) + observed[e + 1] + dynamics[e + 1] + chain[e + 1] +
            padded(p_text(c.against_dynamics.endings[at].p_adjusted), 13) +
            padded(p_text(c.against_chain.endings[at].p_adjusted), 8) + "      " +
            text_of(c.least.by_ending[at]) + "\n";
  }
  return text;
}

std::string from_on(const std::optional<double>& total_variation) {
  return total_variation ? "from " + fixed(*total_variation, 2) + " on"
                         : "not at all (none of this kind is large enough)";
}

/// One sentence; p-values belong to the differences that it names.
std::string verdict_of(const lattice::ObservedComparison& c, const lattice::StartValidation& v) {
  const Judgement &d = c.against_dynamics, &k = c.against_chain;
  const std::string these = "these " + std::to_string(c.seen.trials()) + " trials ",
                    in_dynamics = "the dynamics by more than chance (" + p_of(d) + ")",
                    in_chain = "the chain (" + p_of(k) + ")";
  if (d.differs())
    return these + "differ from " + in_dynamics + ": " + differences(c, d, v.dynamics_endings) +
           (k.differs() ? "; and so they do from " : "; but not from ") + in_chain;
  if (k.differs())
    return these + "do not differ from " + in_dynamics + ", but from " + in_chain + ": " +
           differences(c, k, v.exact_endings) +
           "; the dynamics is the model, the chain its approximation";
  return these + "do not differ from " + in_dynamics + ", nor from " + in_chain +
         "; that does not say that they are equal";
}

}  // namespace

Json to_json(const lattice::ObservedComparison& c, const lattice::StartValidation& v,
             const std::vector<std::string>& files) {
  Json json;
  json["verdict"] = verdict_of(c, v);
  json["files"] = files;
  json["trials"] = c.seen.trials();
  if (c.seen.has_endings()) {
    json["endings"] = endings(c.seen.endings);
    json["endings_95"] = endings_95(c.endings);
  }
  if (c.seen.has_gates()) json["final_gates"] = grid(c.seen.final_gates);
  json["against_dynamics"] = against(c.dynamics_gates, c.against_dynamics);
  json["against_chain"] = against(c.chain_gates, c.against_chain);
  json["smallest_difference"] = least_differences(c);
  return json;
}

std::string table_of(const lattice::ObservedComparison& c, const lattice::StartValidation& v) {
  const std::int64_t n = c.seen.trials();
  std::string text = "Observed: " + std::to_string(n) + (n == 1 ? " trial" : " trials") +
                     ", beside " + std::to_string(v.dynamics.trials) +
                     " of the full dynamics and the exact chain. p: how often chance makes as "
                     "large a\ndifference in anything that is looked at.\n\n";
  if (c.seen.has_endings())
    text += "Endings, % with 95 % intervals\n" + endings_part(c, v) +
            "Seen from: so many points more (+) or fewer (-) than the model are seen in " +
            fixed(100.0 * c.least.goal.power, 0) + " of 100 experiments of " + std::to_string(n) +
            (n == 1 ? " trial" : " trials") + "; none: no difference is.\n";
  if (c.seen.has_endings() && c.seen.has_gates()) text += "\n";
  if (c.seen.has_gates()) {
    text += "Final gates     corrcoef (floor)   RMSE (floor)      TV (chance, at 95 %)        p\n" +
            gates_line("dynamics", *c.dynamics_gates, c.against_dynamics) +
            gates_line("chain", *c.chain_gates, c.against_chain) +
            "A total variation (TV) of the final gates is seen " + from_on(c.least.final_gates) +
            " if it is spread over all gates, the hardest to see.\n";
  }
  std::string said = verdict_of(c, v);
  for (std::size_t at = 0; (at = said.find("; ", at)) != said.npos;) said.replace(at, 2, ";\n  ");
  return text + "\n" + said +
         "\n\nThe p to quote is that against the dynamics in this sentence, the smallest of "
         "those above: it counts that all is\nlooked at. The dynamics is the model, the chain its "
         "approximation.\n\nWhether the chain is to be trusted: " +
         verdict(v) + ".\n(More of that without --observed, and in --json.)\n";
}

std::string who_went_back(const lattice::Observed& observed) {
  if (observed.went_back == 0) return "";
  return std::to_string(observed.went_back) + " of " +
         std::to_string(observed.went_back + observed.seen.trials()) +
         " trials went back, which no body of the model does: they are left out, and the other " +
         std::to_string(observed.seen.trials()) +
         " used. Who gave up in front of a gate is trapped there";
}

std::string too_few_observed(const lattice::Observed& observed) {
  const std::int64_t n = observed.seen.trials();
  const lattice::PowerGoal goal;
  const auto least = lattice::smallest_difference(n, 0.5, goal);
  if (least.more && *least.more <= kFewAreEnough) return "";
  return std::to_string(n) + (n == 1 ? " trial shows" : " trials show") +
         " little: an ending of 50 % must be " +
         (least.more ? fixed(100.0 * *least.more, 0) + " points off" : "more than 50 points off") +
         " to be seen in " + fixed(100.0 * goal.power, 0) +
         " of 100 such experiments; gatewalk power says how many trials it takes";
}

std::string endings_not_listed(const lattice::Observed& observed,
                               const lattice::StartValidation& v) {
  constexpr double kWorthASentence = 0.01;
  if (!observed.seen.has_endings()) return "";
  std::string text;
  for (const EndingName& e : kEndingNames) {
    const double share = v.dynamics_endings.share[index_of(e)];
    if (observed.listed[index_of(e)] || share < kWorthASentence) continue;
    text += (text.empty() ? "the table of endings has no row for " : ", ") + std::string(e.name) +
            ", which counts as 0 (dynamics: " + percent(share, 1.0) + ")";
    if (e.ending == markov::Ending::cut_off)
      text += "; field.max_gates = 0 cuts off nobody, if nothing stopped your trials";
  }
  return text;
}

}  // namespace gatewalk::cli
