// SPDX-License-Identifier: MIT
#include "cli/render/pooled_prediction.h"
#include "cli/render/assumptions.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "cli/fields/text.h"
#include "cli/render/choice.h"
#include "cli/render/exits.h"
#include "cli/render/field_ends.h"
#include "cli/render/final_gates.h"
#include "cli/render/health.h"
#include "cli/render/scene.h"
#include "lattice/statistics/compare.h"

namespace gatewalk::cli {
namespace {

double worst_error(const lattice::PooledPrediction& p) {
  double worst = 0.0;
  for (const lattice::StartAnswer& a : p.starts)
    if (!(worst >= a.error.total_variation)) worst = a.error.total_variation;  // also takes NaN
  return worst;
}

double direct_seconds(const lattice::PooledPrediction& p) {
  double sum = 0.0;
  for (const lattice::StartAnswer& a : p.starts) sum += a.direct_seconds;
  return sum;
}

void describe_direct_seconds(Fields& out, double seconds) {
  out.number({"direct_seconds", "s",
              "estimated time of direct simulation with the same error_95; null: unknown"},
             seconds);
}

}  // namespace

void describe_error(Fields& out, double error_95) {
  out.number({"error_95", "1",
              "95 % bound: total variation of final_gates from the truth (starts: the largest); "
              "null: unknown"},
             error_95);
}

void describe(Fields& out, const lattice::StartAnswer& a, const ShownField& shown) {
  FieldEnds<double> ends = ends_of(a.final, a.endings);
  if (a.from_trials) {  // whose endings at the edges are counted one by one
    ends.departed = 0.0;
    for (const markov::Ending edge : markov::kEdges) ends.departed += a.final[edge];
  }
  ends.describe_endings(out);
  ends.describe_gates(out, &a.gates_95);
  ends.describe_sums(out);
  ends.describe_never_sampled(out);
  ends.describe_still_walking(out);
  describe_exits(out, shown_exits(a.exits, a.final), shown);
  describe_answer_from(out, a.from_trials);
  describe_error(out, a.error.total_variation);
  out.number(
      {"corrcoef_95", "1",
       "95 % bound: correlation of final_gates with the truth is at least this; null: unknown"},
      a.error.corrcoef);
  out.number(
      {"rmse_per_100_95", "trials per 100",
       "95 % bound: root mean squared difference of final_gates from the truth is at most this"},
      a.error.rmse_per_100);
  out.number({"kernel_error_95", "1",
              "error_95 with infinitely many first runs; of an answer from walks: error_95"},
             a.kernel_error_95);
  out.number({"unseen_entries", "1",
              "share of bodies that enter the second gate where no gate run begins; in error_95"},
             a.unseen);
  out.count({"full_trials", "1", "full trials from this start"}, a.trials);
  out.count({"first_runs", "1", "runs through the first gate only, from this start"}, a.first_runs);
  describe_direct_seconds(out, a.direct_seconds);
}

void describe(Fields& out, const RunsPrediction& runs, bool given) {
  const lattice::PooledPrediction& p = runs.prediction;
  out.number(
      {"accuracy", "1", "error_95 that was asked for; for a matrix of any start, half of its own"},
      runs.accuracy);
  out.flag({"reached", "whether error_95 is at most accuracy, for all starts"}, p.reached);
  out.optional(given, [&](Fields& f) { describe_error(f, worst_error(p)); });
  describe_hausman_check(out, p.hausman_check);
  describe_assumptions(out, p.assumptions);
  out.count({"gate_runs", "1", "gate runs that this command simulated"}, p.gate_runs);
  out.count({"states", "1", "number of states of the chain"}, p.states);
  out.count({"nonzeros", "1", "transition probabilities of the chain that are not 0"}, p.nonzeros);
  out.number({"seconds", "s", "wall-clock time of runs, chains and error bars"}, p.seconds);
  out.number({"run_seconds", "s", "wall-clock time of the runs alone"}, p.run_seconds);
  out.optional(given, [&](Fields& f) { describe_direct_seconds(f, direct_seconds(p)); });
  describe_status(out, p.health);
  describe_method(out, runs.method);
  out.if_any({"recorded", "the recorded runs behind the chain"}, runs.recorded,
             [&](Fields& r, const auto& value) {
               const RecordedRuns recorded = value;
               describe(r, recorded.counts);
               describe_lost_bounds(r, recorded.bounds);
             });
}

namespace {

/// "2779 simulated trials", "500 runs through the first gate", "12 recorded trials".
std::string runs_of(const RunsPrediction& runs) {
  if (runs.recorded)
    return counted(runs.recorded->counts.trials, "recorded trial", "recorded trials");
  std::int64_t trials = 0, first_runs = 0;
  for (const lattice::StartAnswer& a : runs.prediction.starts) {
    trials += a.trials;
    first_runs += a.first_runs;
  }
  std::string text;
  if (trials > 0) text = counted(trials, "simulated trial", "simulated trials");
  if (first_runs > 0)
    text += (text.empty() ? "" : " and ") +
            counted(first_runs, "run through the first gate", "runs through the first gate");
  return text.empty() ? "the gate runs of the file" : text;
}

/// The end of a sentence on whether the chain's own trials show a fault, at the level of validate;
/// empty if the chain has none, or if only the method behind both showed faults.
std::string own_trials_text(const lattice::PooledPrediction& p) {
  const auto& own = p.hausman_check;
  if (lattice::wrong_assumption(p.assumptions)) return "; one of its assumptions is wrong";
  if (!own) return "";
  if (own->p <= lattice::JointTest::kLevel)
    return fmt::format("; the chain differs from its own trials ({})", p_words(own->p));
  if (!beware_of(p.health).empty()) return "";
  return fmt::format("; the chain's own trials show no fault of it ({})", p_words(own->p));
}

bool has_error_bar(const lattice::StartAnswer& a) { return std::isfinite(a.error.total_variation); }

}  // namespace

std::string answer_text(const lattice::StartAnswer& a) {
  std::string text = endings_text(ends_of(a.final, a.endings).shares);
  if (a.from_trials)
    text += "These are the shares of the trials: they are more precise here than the chain.\n";
  if (has_error_bar(a))
    text +=
        fmt::format("Final gates: within a total variation of {} of the truth, 95 times in 100.\n",
                    digits(a.error.total_variation, 2));
  return text;
}

std::string answer_text(const RunsPrediction& runs) {
  const auto& starts = runs.prediction.starts;
  const bool any = std::any_of(starts.begin(), starts.end(), has_error_bar);
  std::string text = wrapped(fmt::format(
      "From {}, pooled into a chain of {} states{}{}.", runs_of(runs), runs.prediction.states,
      any ? "" : ", without error bars", own_trials_text(runs.prediction)));
  const bool all_from_trials = std::all_of(
      starts.begin(), starts.end(), [](const lattice::StartAnswer& a) { return a.from_trials; });
  if (any)
    text += all_from_trials
                ? "The 95 % intervals count the sampling error of the trials.\n"
                : "The 95 % intervals include sampling error and the chain's own approximation "
                  "error.\n";
  if (runs.recorded)
    text += beware_of_lost(runs.recorded->counts, runs.recorded->bounds, starts.front().endings);
  return text + beware_of(runs.prediction, runs.accuracy, runs.recorded.has_value()) +
         beware_of(runs.prediction.assumptions, runs.recorded.has_value()) +
         beware_of(runs.prediction.health);
}

std::string details_text(const lattice::StartAnswer& a, const ShownField& shown) {
  std::string text = ends_of(a.final, a.endings).maps(shown.field, "% of all bodies") +
                     table_of(shown_exits(a.exits, a.final), shown);
  if (has_error_bar(a))
    text += fmt::format(
        "Error bars of the final gates, each right 95 times in 100: total variation at most {},\n"
        "corrcoef at least {}, RMSE at most {} per 100.\n",
        fixed(a.error.total_variation, 4), fixed(a.error.corrcoef, 4),
        fixed(a.error.rmse_per_100, 3));
  if (!a.from_trials && a.unseen > 0.0)
    text += fmt::format(
        "{} of the bodies enter the second gate where no simulated run did. Their ending is a "
        "guess,\nand the error bars include it.\n",
        percent(a.unseen, 1.0, 2));
  return text + rest_text(rest_of(a.final));
}

std::string details_text(const RunsPrediction& runs) {
  const lattice::PooledPrediction& p = runs.prediction;
  std::string text = fmt::format(
      "{}{}Simulated for this answer: {} gate runs; the chain has {} states. Time: {} s.\n",
      hausman_check_text(p.hausman_check), assumptions_text(p.assumptions), p.gate_runs, p.states,
      fixed(p.seconds, 2));
  if (const double direct = direct_seconds(p); std::isfinite(direct))
    text += fmt::format("Direct simulation with the same error bar would take about {} s.\n",
                        fixed(direct, 2));
  text += method_line(runs.method);
  return runs.recorded ? text + table_of(runs.recorded->counts) + table_of(runs.recorded->bounds)
                       : text;
}

std::string not_reached(const lattice::PooledPrediction& prediction, double accuracy,
                        bool is_recorded) {
  if (prediction.reached) return "";
  const double error = worst_error(prediction);
  return fmt::format("the accuracy of {} was not reached{}{}", digits(accuracy),
                     std::isfinite(error) ? ", the error bar is " + fixed(error, 4) : "",
                     is_recorded ? "" : "; --gate-runs allows more runs");
}

std::string beware_of(const lattice::PooledPrediction& prediction, double accuracy,
                      bool is_recorded) {
  const std::string text = not_reached(prediction, accuracy, is_recorded);
  return text.empty() ? "" : wrapped("Beware: " + text + ".");
}

void describe_hausman_check(Fields& out, const std::optional<lattice::HausmanCheck>& own) {
  out.maybe(Label("own_trials",
                  "test: full trials of all starts against the chain's answers; null: no such "
                  "trials, or walks")
                .shared(),
            own, [](Fields& f, const lattice::HausmanCheck& o) {
              f.count({"trials", "1", "number of full trials"}, o.trials);
              f.number({"total_variation", "1",
                        "total variation between the final gates of these trials and the chain's"},
                       o.total_variation);
              f.number({"chance_total_variation", "1",
                        "mean total variation of as many trials drawn from the chain's answer"},
                       o.chance_total_variation);
              f.number({"p", "1", "p-value of final gates and endings together"}, o.p);
              f.flag({"differs", "whether p is at most 0.01: the chain differs from the trials"},
                     o.differs());
            });
}

std::string hausman_check_text(const std::optional<lattice::HausmanCheck>& own) {
  if (!own) return "";
  return fmt::format(
      "Check: the final gates of {} full trials differ from the chain's by a total variation of "
      "{};\n"
      "chance alone makes {} ({}).{}\n",
      own->trials, fixed(own->total_variation, 4), fixed(own->chance_total_variation, 4),
      p_words(own->p), own->differs() ? " So the chain errs." : "");
}

}  // namespace gatewalk::cli
