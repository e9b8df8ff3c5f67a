// SPDX-License-Identifier: MIT
#include "cli/render/work_precision.h"

#include <cmath>

#include "cli/render/csv.h"
#include "cli/render/figure.h"
#include "cli/render/health.h"
#include "cli/render/json.h"
#include "cli/render/provenance.h"
#include "cli/render/quantity.h"
#include "cli/render/text.h"
#include "lattice/text/text_stream.h"

namespace gatewalk::cli {

using dynamics::ChartPoint;
using dynamics::Errors;
using dynamics::Outcome;
using dynamics::StrongError;
using dynamics::WeakError;
using dynamics::WorkPrecision;

namespace {

/// A figure as the chart may give it: nothing when it is below what the reference can show.
struct Shown {
  double value = std::nan("");
  bool below = false;
};
Shown shown(double value, double limit) {
  if (std::isfinite(value) && value < limit) return {std::nan(""), true};
  return {value, false};
}

// ---- CSV ----

std::string number(double x) { return std::isfinite(x) ? digits(x) : std::string(); }

/// "value,standard error,chance,limit that it is below"
std::string csv_of(const WeakError& e, double limit) {
  const Shown tv = shown(e.total_variation, limit);
  return number(tv.value) + ',' + (tv.below ? "" : number(e.standard_error)) + ',' +
         number(e.chance) + ',' + (tv.below ? number(limit) : "");
}

std::string csv_of(const ChartPoint& p, const WorkPrecision& chart) {
  const dynamics::Health& h = p.health;
  lattice::TextStream out;
  out << csv_text(chart.label) << ',' << p.setting.method << ',' << p.setting.key << ','
      << digits(p.setting.value) << ',' << (p.setting.usual ? 1 : 0) << ','
      << dynamics::name_of(p.verdict) << ',' << h.runs << ',';
  if (!p.ran()) {  // nothing but the reason
    out << std::string(30, ',') << csv_text(p.refusal) << "\n";
    return out.str();
  }
  const auto& [outcomes, columns, strong] = p.errors;
  const Shown position = shown(strong.position, chart.position_limit());
  out << number(p.least_microseconds()) << ',' << number(p.median_microseconds()) << ','
      << number(p.steps_per_trial()) << ',' << number(p.evaluations_per_trial()) << ','
      << csv_of(outcomes, chart.outcome_bound(p.errors)) << ',' << outcomes.changed << ','
      << csv_of(columns, chart.column_bound(p.errors)) << ',' << strong.compared << ','
      << number(strong.parted_share()) << ',' << number(position.value) << ','
      << (position.below ? number(chart.position_limit()) : "");
  for (const auto what : {&StrongError::velocity, &StrongError::time, &StrongError::energy})
    out << ',' << number(shown(strong.*what, chart.strong_limit(what)).value);
  out << ',' << h.broken << ',' << p.out_of_work << ',' << h.penetrating << ',' << h.creating_energy
      << ',' << h.fast << ',' << h.unstable << ',' << h.undefined_contacts << ',' << h.forced_holds
      << ',' << number(h.worst_penetration) << ',' << number(h.worst_energy_created) << ",\n";
  return out.str();
}

// ---- JSON ----

Json to_json(const WeakError& e, double limit) {
  const Shown tv = shown(e.total_variation, limit);
  Json j;
  j["total_variation"] = tv.value;
  j["standard_error"] = tv.below ? std::nan("") : e.standard_error;
  j["chance"] = e.chance;
  j["trials_changed"] = e.changed;
  if (tv.below) j["below"] = limit;
  return j;
}

Json to_json(const StrongError& e, const WorkPrecision& chart, bool of_reference) {
  Json j;
  j["compared"] = e.compared;
  j["parted"] = e.parted;
  j["parted_share"] = e.parted_share();
  j["trapped_in_both"] = e.trapped;
  const auto add = [&](const char* name, double value, double limit) {
    const Shown median = shown(value, of_reference ? 0.0 : limit);
    j[name]["median"] = median.below ? Json{{"below", limit}} : Json(median.value);
  };
  add("position_m", e.position, chart.position_limit());
  add("velocity_m_per_s", e.velocity, chart.strong_limit(&StrongError::velocity));
  add("time_s", e.time, chart.strong_limit(&StrongError::time));
  add("energy_J", e.energy, chart.strong_limit(&StrongError::energy));
  return j;
}

/// What the reference shows of itself is given in full.
Json to_json(const Errors& e, const WorkPrecision& chart, bool of_reference) {
  return {{"outcomes", to_json(e.outcomes, of_reference ? 0.0 : chart.outcome_bound(e))},
          {"columns", to_json(e.columns, of_reference ? 0.0 : chart.column_bound(e))},
          {"strong", to_json(e.strong, chart, of_reference)}};
}

Json reference_json(const WorkPrecision& chart) {
  const dynamics::Reference& r = chart.reference;
  Json outcomes;  // those that are even count as right (accuracy.h)
  for (const auto& [outcome, key, words] : dynamics::kOutcomeNames)
    if (outcome != Outcome::traversed_even) outcomes[std::string(key)] = r[outcome];
  return {{"setting", r.setting.name()},
          {"status", dynamics::name_of(r.verdict)},
          {"evaluations_per_trial", r.evaluations_per_trial},
          {"outcomes", outcomes},
          {"own_error", {{"against", r.second.name()}, {"errors", to_json(r.own, chart, true)}}},
          {"another_method",
           {{"against", r.other_method.name()}, {"errors", to_json(r.other, chart, true)}}}};
}

Json to_json(const ChartPoint& p, const WorkPrecision& chart) {
  Json s;
  s["method"] = p.setting.method;
  s["key"] = p.setting.key;
  s["value"] = p.setting.value;
  s["default"] = p.setting.usual;
  s["status"] = dynamics::name_of(p.verdict);
  if (!p.ran()) {
    s["reason"] = p.refusal;
    return s;
  }
  s["microseconds_per_trial"] = {{"min", p.least_microseconds()},
                                 {"median", p.median_microseconds()},
                                 {"rounds", p.microseconds}};
  s["steps_per_trial"] = p.steps_per_trial();
  s["evaluations_per_trial"] = p.evaluations_per_trial();
  s["runs_cut_short"] = p.out_of_work;
  s["errors"] = to_json(p.errors, chart, false);
  s["health"] = gatewalk::cli::to_json(p.health);
  return s;
}

// ---- Table ----

/// "1.20e-03", or "<2.0e-02" below the limit.
std::string error_text(double value, double limit) {
  if (shown(value, limit).below) return "<" + scientific(limit, 1);
  return std::isfinite(value) ? scientific(value, 2) : "-";
}

std::string line_of(const ChartPoint& p, const WorkPrecision& chart) {
  const std::string name = (p.setting.usual ? "* " : "  ") + padded(p.setting.name(), -20);
  if (!p.ran()) return name + "   refused: " + p.refusal + "\n";
  const auto& e = p.errors;
  const bool below = e.outcomes.total_variation < chart.outcome_bound(e);
  return name + padded(fixed(p.least_microseconds(), 1), 11) +
         padded(fixed(p.steps_per_trial(), 0), 8) + "  " +
         padded(error_text(e.outcomes.total_variation, chart.outcome_bound(e)), -10) +
         padded(below ? "" : error_text(e.outcomes.standard_error, 0.0), -10) +
         padded(error_text(e.outcomes.chance, 0.0), -10) +
         padded(error_text(e.columns.total_variation, chart.column_bound(e)), -10) +
         padded(error_text(e.strong.position, chart.position_limit()), -11) +
         padded(percent(e.strong.parted_share(), 1.0, 2), 8) + "  " +
         std::string(dynamics::name_of(p.verdict)) + "\n";
}

std::string reference_text(const WorkPrecision& chart) {
  const dynamics::Reference& r = chart.reference;
  lattice::TextStream out;
  const auto share = [&](Outcome outcome) {
    return percent(static_cast<double>(r[outcome]), static_cast<double>(chart.trials));
  };
  const auto against = [&](const dynamics::Setting& setting, const Errors& e) {
    out << "  against " << padded(setting.name(), -20) << " outcomes "
        << digits(e.outcomes.total_variation) << ", columns " << digits(e.columns.total_variation)
        << ", exit " << quantity(e.strong.position, "m") << ", parted "
        << percent(e.strong.parted_share(), 1.0, 3) << "\n";
  };
  out << "  reference " << r.setting.name() << " (" << dynamics::name_of(r.verdict)
      << "): traversed left " << share(Outcome::traversed_left) << ", right "
      << share(Outcome::traversed_right) << ", exited left " << share(Outcome::exited_left)
      << ", right " << share(Outcome::exited_right) << ", trapped " << share(Outcome::trapped)
      << "\n";
  against(r.second, r.own);
  against(r.other_method, r.other);
  return out.str();
}

}  // namespace

Json to_json(const WorkPrecision& chart) {
  Json j;
  j["scene"] = chart.label;
  j["trials"] = chart.trials;
  j["timed_trials"] = chart.timed_trials;
  j["reference"] = reference_json(chart);
  j["settings"] = Json::array();
  for (const ChartPoint& p : chart.points) j["settings"].push_back(to_json(p, chart));
  return j;
}

std::string csv_of(const std::vector<WorkPrecision>& charts) {
  std::string out =
      "scene,method,key,value,default,status,trials,microseconds_min,microseconds_median,"
      "steps_per_trial,evaluations_per_trial,outcome_tv,outcome_tv_se,outcome_tv_chance,"
      "outcome_tv_below,outcomes_changed,column_tv,column_tv_se,column_tv_chance,column_tv_below,"
      "trials_compared,parted_share,position_median_m,position_median_below_m,"
      "velocity_median_m_per_s,time_median_s,energy_median_J,runs_not_finite,runs_cut_short,"
      "runs_penetrating,runs_creating_energy,runs_too_fast,runs_beyond_bound,"
      "contacts_without_formula,forced_holds,worst_penetration_m,worst_energy_created_J,reason\n";
  for (const WorkPrecision& chart : charts)
    for (const ChartPoint& p : chart.points) out += csv_of(p, chart);
  return out;
}

std::string table_of(const WorkPrecision& chart) {
  std::string out = chart.label + ": " + std::to_string(chart.trials) + " trials per setting, " +
                    std::to_string(chart.timed_trials) + " timed\n" + reference_text(chart) +
                    "  setting                us/trial   steps  outcomes  +-        chance    "
                    "columns   exit (m)   parted   status\n";
  for (const ChartPoint& p : chart.points) out += line_of(p, chart);
  const ChartPoint* cheapest = chart.cheapest();
  return out + "  cheapest setting without faults, outcomes within " +
         digits(chart.params.run.tolerance) + ": " +
         (cheapest == nullptr ? "none shown; more --trials may show one"
                              : cheapest->setting.name()) +
         "\n";
}

std::string work_precision_legend(std::int64_t rounds) {
  return "* usual: the method's default. us/trial: least of " + std::to_string(rounds) +
         " rounds on one thread, " + machine() +
         "\noutcomes, columns: total variation from the reference, of the outcomes and of the "
         "crossing"
         "\nstates; +-: its standard error; chance: what chance alone would show; <: not told from "
         "no error."
         "\nexit (m): median distance at the exit; parted: share of exits that took another "
         "course, these count"
         "\nas infinitely far. status: ok, or the worst fault seen.\n";
}

}  // namespace gatewalk::cli
