// SPDX-License-Identifier: MIT
#include "cli/render/pooled_prediction.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "cli/render/exits.h"
#include "cli/render/final_gates.h"
#include "cli/render/health.h"
#include "cli/render/json.h"
#include "cli/render/scene.h"
#include "cli/render/start.h"
#include "cli/render/text.h"

namespace gatewalk::cli {
namespace {

void add_to(Json& json, const lattice::StartAnswer& a, const ShownField& shown) {
  const markov::FinalDistribution& f = a.final;
  const lattice::EndingShares told = shown_endings(a.endings, f);
  json["endings"] = endings(told.share);
  json["endings_95"] = endings_95(told);
  json.update(json_of([&](Fields& out) { describe_final_gates(out, f); }));
  json["still_walking"] = f.remainder;
  json["exits"] = cli::to_json(shown_exits(a.exits, f), shown);
  json.update(json_of([&](Fields& out) {
    out.object({"final_gates_95", "95 % intervals of the final gates"}, [&](Fields& g) {
      describe_map(g, {"low", "1", "their lower ends"}, a.gates_95[0]);
      describe_map(g, {"high", "1", "their upper ends"}, a.gates_95[1]);
    });
  }));
  json["answer_from"] = a.from_trials ? "trials" : "chain";
  json["error_95"] = a.error.total_variation;
  json["corrcoef_95"] = a.error.corrcoef;
  json["rmse_per_100_95"] = a.error.rmse_per_100;
  json["kernel_error_95"] = a.kernel_error_95;
  json["unseen_entries"] = a.unseen;
  json["full_trials"] = a.trials;
  json["first_runs"] = a.first_runs;
  json["direct_seconds"] = std::isfinite(a.direct_seconds) ? Json(a.direct_seconds) : Json();
}

std::string table_of(const lattice::StartAnswer& a, const ShownField& shown) {
  const markov::FinalDistribution& f = a.final;
  const bool known = std::isfinite(a.error.total_variation);
  std::string table = endings_text(shown_endings(a.endings, f),
                                   known ? "of all bodies, 95 % intervals that count everything"
                                         : "of all bodies, without intervals") +
                      limits_text(shown) + map_of(f.final_cells) +
                      map_of_trapped(markov::trapped_cells(f)) + "departed " +
                      percent(f.left_field, 1.0, 2) + "\n" +
                      cli::table_of(shown_exits(a.exits, f), shown);
  if (known)
    table += "error: at most " + fixed(a.error.total_variation, 4) +
             " in total variation of the final gates, corrcoef at least " +
             fixed(a.error.corrcoef, 4) + ", RMSE at most " + fixed(a.error.rmse_per_100, 3) +
             " per 100, each 95 times in 100 (sampling, states and memory)\n";
  if (a.from_trials) table += "the trials' own shares: they are more certain here than the chain\n";
  if (!a.from_trials && a.unseen > 0.0)
    table += "the error counts " + percent(a.unseen, 1.0, 2) +
             " that enter the second gate where no gate run did: what becomes of them is a guess\n";
  return table + rest_text(rest_of(f));
}

Start start_of(const lattice::StartAnswer& a) { return a.as_seen ? Start() : Start(a.start); }

double worst_error(const lattice::PooledPrediction& p) {
  double worst = 0.0;
  for (const lattice::StartAnswer& a : p.starts)
    if (!(worst >= a.error.total_variation)) worst = a.error.total_variation;  // or not a number
  return worst;
}

Json direct_seconds(const lattice::PooledPrediction& p) {
  double sum = 0.0;
  for (const lattice::StartAnswer& a : p.starts) sum += a.direct_seconds;
  return std::isfinite(sum) ? Json(sum) : Json();
}

}  // namespace

void describe_own_trials(Fields& out, const std::optional<lattice::OwnTrials>& own) {
  out.maybe(Label("own_trials",
                  "the full trials of all starts against the chain that was made from them; null: "
                  "none of a chain's answers, or answers by walks")
                .shared(),
            own, [](Fields& f, const lattice::OwnTrials& o) {
              f.count({"trials", "1", "full trials"}, o.trials);
              f.number({"total_variation", "1", "between their final gates and the chain's"},
                       o.total_variation);
              f.number({"chance_total_variation", "1",
                        "mean of the same for as many trials drawn from the chain's answer"},
                       o.chance_total_variation);
              f.number({"p", "1", "of final gates and endings together"}, o.p);
              f.flag({"differs", "p is at most 1 %: the chain errs"}, o.differs());
            });
}

Json to_json(const std::optional<lattice::OwnTrials>& own) {
  return json_of([&](Fields& out) { describe_own_trials(out, own); })["own_trials"];
}

std::string own_trials_text(const std::optional<lattice::OwnTrials>& own) {
  if (!own) return "";
  return fmt::format("check: its {} full trials themselves are {} away, chance makes {} ({}){}\n",
                     own->trials, fixed(own->total_variation, 4),
                     fixed(own->chance_total_variation, 4), p_words(own->p),
                     own->differs() ? ": the chain errs" : "");
}

Json to_json(const lattice::PooledPrediction& p, const ShownField& shown, double accuracy,
             bool given) {
  Json json;
  if (!given) add_to(json, p.starts.front(), shown);
  for (std::size_t k = 0; given && k < p.starts.size(); ++k) {
    Json one;
    one["start"] = to_json(shown.map.section, start_of(p.starts[k]));
    add_to(one, p.starts[k], shown);
    json["starts"].push_back(std::move(one));
  }
  json["accuracy"] = accuracy;
  json["reached"] = p.reached;
  json["error_95"] = worst_error(p);
  json["own_trials"] = to_json(p.own_trials);
  json["gate_runs"] = p.gate_runs;
  json["states"] = p.states;
  json["nonzeros"] = p.nonzeros;
  json["seconds"] = p.seconds;
  json["run_seconds"] = p.run_seconds;
  json["direct_seconds"] = direct_seconds(p);
  json["status"] = to_json(p.health);
  return json;
}

std::string table_of(const lattice::PooledPrediction& p, const ShownField& shown, bool given) {
  std::string table;
  for (std::size_t k = 0; k < p.starts.size(); ++k)
    table += (k > 0 ? "\n" : "") +
             (given ? title_of(shown.map.section, start_of(p.starts[k])) + "\n" : "") +
             table_of(p.starts[k], shown);
  table += own_trials_text(p.own_trials);
  const Json direct = direct_seconds(p);
  table += std::to_string(p.gate_runs) + " gate runs, " + std::to_string(p.states) + " states, " +
           fixed(p.seconds, 2) + " s";
  if (!direct.is_null())
    table += "; direct simulation would take some " + fixed(direct.get<double>(), 2) + " s";
  return table + "\n";
}

}  // namespace gatewalk::cli
