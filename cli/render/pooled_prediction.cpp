// SPDX-License-Identifier: MIT
#include "cli/render/pooled_prediction.h"

#include <fmt/core.h>

#include <cmath>

#include "cli/fields/text.h"
#include "cli/render/choice.h"
#include "cli/render/exits.h"
#include "cli/render/field_ends.h"
#include "cli/render/final_gates.h"
#include "cli/render/health.h"
#include "cli/render/scene.h"

namespace gatewalk::cli {
namespace {

double worst_error(const lattice::PooledPrediction& p) {
  double worst = 0.0;
  for (const lattice::StartAnswer& a : p.starts)
    if (!(worst >= a.error.total_variation)) worst = a.error.total_variation;  // or not a number
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
  if (a.from_trials) {  // whose shares are added up one by one
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

std::string table_of(const lattice::StartAnswer& a, const ShownField& shown) {
  const bool known = std::isfinite(a.error.total_variation);
  std::string text = ends_of(a.final, a.endings)
                         .table(known ? "of all bodies, 95 % intervals that count everything"
                                      : "of all bodies, without intervals",
                                limits_text(shown)) +
                     table_of(shown_exits(a.exits, a.final), shown);
  if (known)
    text += fmt::format(
        "error: at most {} in total variation of the final gates, corrcoef at least {}, RMSE at "
        "most {} per 100, each 95 times in 100 (sampling, states and memory)\n",
        fixed(a.error.total_variation, 4), fixed(a.error.corrcoef, 4),
        fixed(a.error.rmse_per_100, 3));
  if (a.from_trials)
    text += "the trials' own shares: they are more certain here than the chain\n";
  else if (a.unseen > 0.0)
    text += fmt::format(
        "the error counts {} that enter the second gate where no gate run did: what becomes of "
        "them is a guess\n",
        percent(a.unseen, 1.0, 2));
  return text + rest_text(rest_of(a.final));
}

std::string table_of(const RunsPrediction& runs) {
  const lattice::PooledPrediction& p = runs.prediction;
  std::string text =
      fmt::format("{}{} gate runs, {} states, {} s", hausman_check_text(p.hausman_check),
                  p.gate_runs, p.states, fixed(p.seconds, 2));
  if (const double direct = direct_seconds(p); std::isfinite(direct))
    text += fmt::format("; direct simulation would take some {} s", fixed(direct, 2));
  text += "\n" + method_line(runs.method);
  return runs.recorded ? text + table_of(runs.recorded->counts) + table_of(runs.recorded->bounds)
                       : text;
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
  return fmt::format("check: its {} full trials themselves are {} away, chance makes {} ({}){}\n",
                     own->trials, fixed(own->total_variation, 4),
                     fixed(own->chance_total_variation, 4), p_words(own->p),
                     own->differs() ? ": the chain errs" : "");
}

}  // namespace gatewalk::cli
