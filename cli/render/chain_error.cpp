// SPDX-License-Identifier: MIT
#include "cli/render/chain_error.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cli/render/csv.h"
#include "cli/render/final_gates.h"
#include "cli/render/health.h"
#include "cli/render/json.h"
#include "cli/render/provenance.h"
#include "cli/render/quantity.h"
#include "cli/render/start.h"
#include "cli/render/text.h"
#include "lattice/text/text_stream.h"

namespace gatewalk::cli {
namespace {

using lattice::ChainAnswer;
using lattice::ChainCurve;
using lattice::ChainErrorChart;
using lattice::ChainPoint;
using lattice::ChainSummary;
using lattice::DirectSimulation;
using lattice::FieldTruth;
using lattice::FinalGateError;
using lattice::kChainWalks;

std::string seconds_text(double s) { return fixed(s, s < 1 ? 3 : s < 100 ? 1 : 0); }

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();  // an empty field

const char* row_starts(const ChainCurve& c) { return c.entries.empty() ? "uniform" : "visited"; }

// ---- JSON ----

Json json_of(const FinalGateError& e) {
  return {{"total_variation", e.total_variation}, {"corrcoef", e.corrcoef}};
}

/// Infinity, which JSON has not, as null.
Json finite(double x) { return std::isfinite(x) ? Json(x) : Json(); }

Json json_of(const ChainAnswer& a) {
  Json j{{"exact", json_of(a.exact)}, {"exact_s", a.exact_seconds}};
  j["exact"]["total_variation_sd"] = finite(a.exact_sd);
  for (std::size_t w = 0; w < kChainWalks.size(); ++w) {
    const std::string name = "walks_" + std::to_string(kChainWalks[w]);
    j[name] = json_of(a.walks[w]);
    j[name + "_s"] = a.walk_seconds[w];
  }
  j["sampling_total_variation"] = a.sampling;
  j["bins_total_variation"] = a.bins;
  j["never_sampled_share"] = a.never_sampled;
  return j;
}

Json json_of(const ChainCurve& c) {
  return {{"bins", c.factor},
          {"states", c.space.size()},
          {"row_starts", row_starts(c)},
          {"one_thread_s_per_gate_run", c.seconds_per_run},
          {"points", c.trials.size()}};
}

Json json_of(const ChainErrorChart& chart, const ChainPoint& p) {
  const ChainCurve& curve = chart.curves[p.curve];
  Json j{{"bins", curve.factor},
         {"states", curve.space.size()},
         {"row_starts", row_starts(curve)},
         {"trials_per_row", p.trials},
         {"gate_runs", p.runs},
         {"matrices", p.matrices},
         {"build_s", p.build_seconds},
         {"clamped_share", p.clamped_share},
         {"rows_never_sampled", p.rows_never_sampled},
         {"starts", Json::array()}};
  for (const ChainAnswer& a : p.answers) j["starts"].push_back(json_of(a));
  return j;
}

Json summary_json(const ChainErrorChart& chart, std::size_t s) {
  const ChainSummary summary = summary_of(chart, s);
  const auto place = [&](std::size_t i) {
    const ChainPoint& p = chart.points[i];
    return Json{{"bins", chart.curves[p.curve].factor},
                {"trials_per_row", p.trials},
                {"seconds", p.seconds(s)},
                {"total_variation", p.error(s)}};
  };
  Json j{{"best", place(summary.best)},
         {"cheapest_near_best", place(summary.cheapest)},
         {"chain_pays_from_s", finite(summary.pays_from)},
         {"chain_pays_until_s", finite(summary.pays_until)},
         {"starts_to_pay", finite(summary.starts_to_pay)}};
  if (summary.best_visited) j["best_visited"] = place(*summary.best_visited);
  return j;
}

Json start_json(const ChainErrorChart& chart, std::size_t s) {
  const FieldTruth& t = chart.truths[s];
  const auto n = static_cast<double>(t.tally.trials);
  Json j;
  j["start"] = to_json(dynamics::disc_section(), t.start.entry());
  j["truth"] = {{"trials", t.tally.trials},
                {"one_thread_s_per_trial", t.seconds_per_trial},
                {"floor", json_of(t.floor)},
                {"trapped", static_cast<double>(t.tally.trapped) / n},
                {"departed", static_cast<double>(t.tally.left_field) / n},
                {"cut_off", static_cast<double>(t.tally.cut_off) / n},
                {"final_gates", grid(t.tally.final_gates)}};
  j["direct_simulation"] = Json::array();
  for (const DirectSimulation& d : chart.direct[s])
    j["direct_simulation"].push_back({{"trials", d.trials},
                                      {"seconds", d.seconds},
                                      {"drawn", json_of(d.drawn)},
                                      {"formula", json_of(d.formula)}});
  j["trees"] = Json::array();
  for (const lattice::TreePoint& p : chart.trees[s]) {
    Json tree = json_of(p.error);
    tree["accuracy"] = p.accuracy;
    tree["error_95"] = p.error_95;
    tree["predictions"] = lattice::kTreePredictions;
    tree["gate_runs"] = p.gate_runs;
    tree["states"] = p.states;
    tree["seconds"] = p.seconds;
    j["trees"].push_back(std::move(tree));
  }
  j["summary"] = summary_json(chart, s);
  return j;
}

// ---- Table ----

/// Until when the chain is better than direct simulation, for one start and for many.
std::string when_it_pays(const ChainErrorChart& chart, const ChainSummary& summary, std::size_t s) {
  const FieldTruth& truth = chart.truths[s];
  std::string text;
  if (summary.pays_from == ChainSummary::kNever) {
    text = "For one start direct simulation is better than bins at every cost charted";
  } else {
    text = "For one start bins are better from " + seconds_text(summary.pays_from) + " s";
    text += summary.pays_until == ChainSummary::kNever
                ? " on, as far as this truth can tell"
                : "; from " + seconds_text(summary.pays_until) + " s (" +
                      digits(std::round(summary.pays_until / truth.seconds_per_trial)) +
                      " trials) on direct simulation is better than any matrix charted";
  }
  if (summary.starts_to_pay == ChainSummary::kNever)
    return text + ". Its error costs direct simulation less than one prediction: it never pays.\n";
  const double direct = truth.seconds_for(chart.points[summary.cheapest].error(s));
  return text + ". For many starts, at that cheapest point, it pays from " +
         digits(summary.starts_to_pay) + (summary.starts_to_pay == 1.0 ? " start" : " starts") +
         " on (" + seconds_text(direct) + " s of direct simulation each).\n";
}

/// "Trees: TV 0.045 in 0.03 s (direct simulation 0.103), 0.023 in 0.1 s (0.052)."
std::string trees_text(const ChainErrorChart& chart, std::size_t s) {
  const FieldTruth& truth = chart.truths[s];
  std::string text;
  for (const lattice::TreePoint& p : chart.trees[s]) {
    const auto trials =
        std::max<std::int64_t>(1, std::llround(p.seconds / truth.seconds_per_trial));
    text += (text.empty() ? "Trees (predict --accuracy): TV " : ", ") +
            fixed(p.error.total_variation, 3) + " in " + seconds_text(p.seconds) + " s (" +
            (text.empty() ? "direct simulation then has " : "") +
            fixed(lattice::expected_total_variation(truth.p, truth.as_against_exact(trials)), 3) +
            ")";
  }
  return text.empty() ? "Trees: no prediction within --runs-limit.\n" : text + ".\n";
}

/// A paragraph for one start.
std::string words_of(const ChainErrorChart& chart, std::size_t s) {
  const ChainSummary summary = summary_of(chart, s);
  const auto place = [&](const ChainPoint& p) {
    return name_of(chart.curves[p.curve]) + ", " + std::to_string(p.trials) + " trials a row, " +
           seconds_text(p.seconds(s)) + " s";
  };
  const ChainPoint &best = chart.points[summary.best], &cheapest = chart.points[summary.cheapest];
  std::string text =
      "The best error of bins is TV " + fixed(best.error(s), 3) + " (" + place(best) +
      "; the truth's noise: " + fixed(chart.truths[s].floor.total_variation, 3) + "); ";
  text += summary.cheapest == summary.best
              ? "nothing cheaper comes within 1.5 times of it.\n"
              : "the cheapest within 1.5 times of it is TV " + fixed(cheapest.error(s), 3) + " (" +
                    place(cheapest) + ").\n";
  text += when_it_pays(chart, summary, s);
  const ChainAnswer& a = best.answers[s];
  text += std::string("At their best bins are limited by ") +
          (a.bins > a.sampling ? "what they forget (TV " + fixed(a.bins, 3) + "; sampling makes " +
                                     fixed(a.sampling, 3) + "): more trials would not help.\n"
                               : "the sampling of its matrix (TV " + fixed(a.sampling, 3) +
                                     "; bins and what they forget make " + fixed(a.bins, 3) +
                                     "): more trials would help.\n");
  if (summary.best_visited) {
    const ChainPoint& visited = chart.points[*summary.best_visited];
    text += "With rows started where bodies were seen to enter its best is TV " +
            fixed(visited.error(s), 3) + " (" + place(visited) +
            ", the trials that saw them included).\n";
  }
  return text + trees_text(chart, s);
}

/// Seconds, total variation of the chain, that of direct simulation at this cost.
std::string cell_of(const ChainPoint& p, const FieldTruth& truth, std::size_t s) {
  const double seconds = p.seconds(s);
  const auto direct = std::max<std::int64_t>(1, std::llround(seconds / truth.seconds_per_trial));
  return padded(seconds_text(seconds), 8) + padded(fixed(p.error(s), 3), 10) +
         padded(
             fixed(lattice::expected_total_variation(truth.p, truth.as_against_exact(direct)), 3),
             8);
}

/// Curves [first, beyond) side by side, for one start: a line for each number of trials a row, and
/// the parts of the last one's error.
std::string block_of(const ChainErrorChart& chart, std::size_t s, std::size_t first,
                     std::size_t beyond) {
  std::string out = "\n";
  const auto row = [&](const std::string& name, const auto& cell) {
    out += padded(name, 12) + " ";
    for (std::size_t c = first; c < beyond; ++c) out += "|" + padded(cell(c), -29);
    out += "\n";
  };
  const auto point = [&](std::size_t curve, std::int64_t trials) {
    const auto at =
        std::find_if(chart.points.begin(), chart.points.end(),
                     [&](const ChainPoint& p) { return p.curve == curve && p.trials == trials; });
    return at == chart.points.end() ? nullptr : &*at;
  };
  row("trials/row", [&](std::size_t c) {
    const ChainCurve& curve = chart.curves[c];
    return name_of(curve) + " (" + std::to_string(curve.space.size()) + ")";
  });
  for (const std::int64_t trials : lattice::kChainTrials) {
    bool any = false;
    for (std::size_t c = first; c < beyond; ++c) any |= point(c, trials) != nullptr;
    if (any)
      row(std::to_string(trials), [&](std::size_t c) {
        const ChainPoint* p = point(c, trials);
        return p == nullptr ? std::string() : cell_of(*p, chart.truths[s], s);
      });
  }
  for (const auto part : {&ChainAnswer::sampling, &ChainAnswer::bins})
    row(part == &ChainAnswer::sampling ? "sampling" : "bins", [&](std::size_t c) {
      if (chart.curves[c].trials.empty()) return padded("-", 18);
      return padded(fixed(point(c, chart.curves[c].trials.back())->answers[s].*part, 3), 18);
    });
  return out;
}

}  // namespace

std::string name_of(const FieldTruth& truth) {
  const lattice::PaperStart& start = truth.start;
  const Sized speed = readable_unit("m/s", std::max(std::abs(start.vx), std::abs(start.vy)));
  return "start d = " + quantity(start.d, "m") + ", v = (" + digits(start.vx / speed.size) + ", " +
         digits(start.vy / speed.size) + ") " + speed.name;
}

std::string name_of(const ChainCurve& curve) {
  return "bins x " + digits(curve.factor) + (curve.visited ? ", visited" : "");
}

Json to_json(const ChainErrorChart& chart) {
  Json json;
  json["machine"] = machine();
  json["seconds_are"] = "CPU time of one thread";
  json["truth_trials"] = chart.options.truth_trials;
  json["runs_limit"] = chart.options.runs_limit;
  json["pilot_trials"] = chart.pilot_trials;
  json["bins"] = chart.bins.name();
  json["matrices_drawn_anew"] = lattice::kMatricesDrawnAnew;
  json["starts"] = Json::array();
  for (std::size_t s = 0; s < chart.truths.size(); ++s)
    json["starts"].push_back(start_json(chart, s));
  json["curves"] = Json::array();
  for (const ChainCurve& c : chart.curves) json["curves"].push_back(json_of(c));
  json["points"] = Json::array();
  for (const ChainPoint& p : chart.points) json["points"].push_back(json_of(chart, p));
  json["status"] = to_json(chart.health);
  return json;
}

std::string csv_of(const ChainErrorChart& chart) {
  Csv csv(
      "d_m,vx_m_per_s,vy_m_per_s,answer,bins,states,row_starts,trials,gate_runs,matrices,build_s,"
      "answer_s,total_s,total_variation,total_variation_sd,corrcoef,sampling_total_variation,"
      "bins_total_variation,formula_total_variation,formula_corrcoef,truth_floor_total_variation,"
      "truth_floor_corrcoef,clamped_share,rows_never_sampled,never_sampled_share");
  for (std::size_t s = 0; s < chart.truths.size(); ++s) {
    const lattice::PaperStart& start = chart.truths[s].start;
    const FinalGateError& floor = chart.truths[s].floor;
    for (const ChainPoint& p : chart.points) {
      const ChainAnswer& a = p.answers[s];
      const ChainCurve& curve = chart.curves[p.curve];
      const auto line = [&](const std::string& answer, double seconds, const FinalGateError& e,
                            double sd, double sampling, double bins) {
        csv.row(start.d, start.vx, start.vy, answer, curve.factor, curve.space.size(),
                row_starts(curve), p.trials, p.runs, p.matrices, p.build_seconds, seconds,
                p.build_seconds + seconds, e.total_variation, sd, e.corrcoef, sampling, bins, kNone,
                kNone, floor.total_variation, floor.corrcoef, p.clamped_share, p.rows_never_sampled,
                a.never_sampled);
      };
      line("exact", a.exact_seconds, a.exact, a.exact_sd, a.sampling, a.bins);
      for (std::size_t w = 0; w < kChainWalks.size(); ++w)
        line(std::to_string(kChainWalks[w]) + " walks", a.walk_seconds[w], a.walks[w], kNone, kNone,
             kNone);
    }
    for (const lattice::TreePoint& p : chart.trees[s])
      csv.row(start.d, start.vx, start.vy, "tree", kNone, p.states, "visited", kNone, p.gate_runs,
              lattice::kTreePredictions, kNone, kNone, p.seconds, p.error.total_variation, kNone,
              p.error.corrcoef, kNone, kNone, kNone, kNone, floor.total_variation, floor.corrcoef,
              kNone, kNone, kNone);
    for (const DirectSimulation& d : chart.direct[s])
      csv.row(start.d, start.vx, start.vy, "direct simulation", kNone, kNone, kNone, d.trials,
              kNone, kNone, kNone, d.seconds, d.seconds, d.drawn.total_variation, kNone,
              d.drawn.corrcoef, kNone, kNone, d.formula.total_variation, d.formula.corrcoef,
              floor.total_variation, floor.corrcoef, kNone, kNone, kNone);
  }
  return csv.text();
}

std::string table_of(const ChainErrorChart& chart) {
  lattice::TextStream out;
  for (std::size_t s = 0; s < chart.truths.size(); ++s) {
    const FieldTruth& truth = chart.truths[s];
    out << (s == 0 ? "" : "\n") << "S" << name_of(truth).substr(1) << ": " << truth.tally.trials
        << " full trials, " << fixed(1e3 * truth.seconds_per_trial, 2)
        << " ms each; seconds, TV of the exact chain, TV of direct simulation at that cost\n";
    for (std::size_t first = 0; first < chart.curves.size(); first += 4)  // as many fit in a line
      out << block_of(chart, s, first, std::min(first + 4, chart.curves.size()));
    out << "\n" << words_of(chart, s);
  }
  out << "\nSampling, bins: the parts of the last line's TV that come from the matrix's trials and "
         "from its\n"
         "states. Seconds: CPU time of one thread, one matrix and one prediction. TV: against the "
         "full trials,\n"
         "whose noise both share; the chain's a mean over up to 8 matrices of different trials.\n";
  for (const ChainCurve& c : chart.curves)
    if (c.trials.empty())
      out << name_of(c) << ": no point, " << c.space.size() << " rows of "
          << lattice::kChainTrials.front() << " trials exceed --runs-limit "
          << chart.options.runs_limit << ".\n";
  return out.str();
}

}  // namespace gatewalk::cli
