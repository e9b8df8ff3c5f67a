// SPDX-License-Identifier: MIT
#include "cli/render/fidelity.h"

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

using lattice::FidelityOfStart;
using lattice::FidelityRun;
using lattice::FidelityStudy;
using lattice::FidelityVariant;
using lattice::FieldTally;
using lattice::PairedChange;
using lattice::Sufficiency;

std::string step_text(const FidelityVariant& v) { return quantity(v.scene.gate.run.step, "s", 7); }

double share(std::int64_t part, const FieldTally& of) {
  return static_cast<double>(part) / static_cast<double>(of.trials);
}

/// "Start 0, 0, 15: active is enough: ..."
std::string sentence(const FidelityOfStart& s) {
  const auto about = [](const char* name, const PairedChange& c) {
    return std::string(name) + " has TV " + fixed(c.apart.total_variation, 4) + " +- " +
           fixed(c.uncertainty(), 4) + " where chance makes " +
           fixed(c.in_pairs.floor_total_variation, 4) + " (p " +
           p_text(c.in_pairs.p_total_variation) + ")";
  };
  const std::string words[] = {
      "active is enough",
      std::to_string(s.runs[0].tally.trials) + " trials cannot tell whether active is enough",
      "active is not enough"};
  return "Start " + digits(s.start.d) + ", " + digits(s.start.vx) + ", " + digits(s.start.vy) +
         ": " + words[static_cast<int>(s.active_is())] + ": " +
         about("remember", *s.runs[1].change) + ", " + about("all", *s.runs[2].change) + ".";
}

Json to_json(const FidelityVariant& v, const FidelityRun& run) {
  const FieldTally& t = run.tally;
  Json j;
  j["fidelity"] = name_of(v.scene.field.fidelity);
  j["method"] = v.scene.gate.run.method;
  j["step_s"] = v.scene.gate.run.step;
  j["seconds_per_trial"] = run.seconds_per_trial;
  j["fates"] = {{"trapped", share(t.trapped, t)},
                {"departed", share(t.left_field, t)},
                {"cut_off", share(t.cut_off, t)},
                {"not_finite", share(t.broken, t)}};
  if (run.change) {
    j["changed_share"] = run.change->changed;
    j["total_variation_uncertainty"] = run.change->uncertainty();
    j["as_independent_samples"] = cli::to_json(run.change->apart);
    j["in_pairs"] = cli::to_json(run.change->in_pairs);
  }
  j["final_gates"] = grid(t.final_gates);
  j["status"] = cli::to_json(t.health);
  return j;
}

/// "  4  5  10  | active (moreau)  ..."
std::string line_of(const FidelityOfStart& s, const FidelityVariant& v, const FidelityRun& run) {
  const auto shown = [&](std::int64_t n, int width) {
    return padded(percent(static_cast<double>(n), static_cast<double>(run.tally.trials), 2), width);
  };
  std::string line = start_text(dynamics::disc_section(), dynamics::entry_of(s.start.body())) +
                     "  | " + padded(v.name(), -18) +
                     padded(fixed(1e3 * run.seconds_per_trial, 2), 7) +
                     shown(run.tally.trapped, 9) + shown(run.tally.left_field, 10) +
                     shown(run.tally.cut_off, 9) + " |";
  if (!run.change) return line;
  const lattice::Comparison &a = run.change->apart, &p = run.change->in_pairs;
  return line + padded(percent(run.change->changed, 1.0), 8) +
         padded(fixed(a.total_variation, 4), 8) + padded(fixed(a.floor_total_variation, 4), 8) +
         padded(fixed(p.floor_total_variation, 4), 8) + padded(p_text(a.p_total_variation), 8) +
         padded(p_text(p.p_total_variation), 8) + padded(fixed(a.corrcoef, 4), 10) +
         padded(fixed(a.rmse_per_100, 3), 8);
}

}  // namespace

Json to_json(const FidelityStudy& study) {
  Json j;
  j["machine"] = machine();
  j["trials"] = study.trials;
  j["threads"] = study.threads;
  j["bound"] = lattice::kSmallChange;
  j["starts"] = Json::array();
  for (const FidelityOfStart& s : study.starts) {
    Json one;
    one["start"] = to_json(dynamics::disc_section(), dynamics::entry_of(s.start.body()));
    const Sufficiency active = s.active_is();
    one["active_is_enough"] =
        active == Sufficiency::cannot_tell ? Json() : Json(active == Sufficiency::enough);
    one["sentence"] = sentence(s);
    one["runs"] = Json::array();
    for (std::size_t v = 0; v < study.variants.size(); ++v)
      one["runs"].push_back(to_json(study.variants[v], s.runs[v]));
    j["starts"].push_back(std::move(one));
  }
  return j;
}

std::string csv_of(const FidelityStudy& study) {
  Csv csv(
      "d_m,vx_m_per_s,vy_m_per_s,fidelity,method,step_s,trials,seconds_per_trial,trapped_share,"
      "departed_share,cut_off_share,broken_share,changed_share,total_variation,"
      "total_variation_uncertainty,total_variation_floor,total_variation_floor_pairs,"
      "p_total_variation,p_total_variation_pairs,p_energy,p_energy_pairs,corrcoef,corrcoef_floor,"
      "rmse_per_100,rmse_per_100_floor,clean");
  for (const FidelityOfStart& s : study.starts)
    for (std::size_t v = 0; v < study.variants.size(); ++v) {
      const lattice::Scene& scene = study.variants[v].scene;
      const FidelityRun& run = s.runs[v];
      const FieldTally& t = run.tally;
      const PairedChange c = run.change.value_or(PairedChange{});
      const auto changed = [&](double x) {
        return run.change ? x : std::numeric_limits<double>::quiet_NaN();  // an empty field
      };
      const lattice::Comparison &a = c.apart, &p = c.in_pairs;
      csv.row(s.start.d, s.start.vx, s.start.vy, std::string(name_of(scene.field.fidelity)),
              scene.gate.run.method, scene.gate.run.step, static_cast<double>(t.trials),
              run.seconds_per_trial, share(t.trapped, t), share(t.left_field, t),
              share(t.cut_off, t), share(t.broken, t), changed(c.changed),
              changed(a.total_variation), changed(c.uncertainty()),
              changed(a.floor_total_variation), changed(p.floor_total_variation),
              changed(a.p_total_variation), changed(p.p_total_variation), changed(a.p_energy),
              changed(p.p_energy), changed(a.corrcoef), changed(a.floor.corrcoef),
              changed(a.rmse_per_100), changed(a.floor.rmse_per_100),
              t.health.clean() ? "true" : "false");
    }
  return csv.text();
}

std::string table_of(const FidelityStudy& study) {
  lattice::TextStream out;
  const auto step = [](const FidelityVariant& v) {
    return step_text(v) + " (" + v.scene.gate.run.method + ")";
  };
  out << study.trials << " trials per start and line, the same noise in all of them; step "
      << step(study.variants.front()) << ", " << step(study.variants.back()) << ".\n"
      << "Against the first line: share of trials that end in another gate; total variation (TV),\n"
         "what chance gives between independent samples (floor) and between samples that share "
         "their\n"
         "noise (pairs), with p-values; corrcoef and RMSE (trials per 100). ms: wall clock per "
         "trial, "
      << study.threads << (study.threads == 1 ? " thread" : " threads") << ",\nleast of "
      << lattice::kFidelityRepeats << " interleaved repeats.\n\n"
      << "   d   vx   vy  | fidelity (method)      ms  trapped  departed  cut off | changed      "
         "TV   "
         "floor   pairs"
         "       p p pairs  corrcoef    RMSE\n";
  for (const FidelityOfStart& s : study.starts)
    for (std::size_t v = 0; v < study.variants.size(); ++v)
      out << line_of(s, study.variants[v], s.runs[v]) << "\n";
  out << "\nActive is enough where TV is at most " << digits(lattice::kSmallChange)
      << " with its uncertainty (+-) added, and\n"
      << "not enough where it is more with that taken off: what chance makes of pairs 95 times in\n"
      << "100, and 3 trials of " << study.trials << " that may yet show what none did.\n";
  for (const FidelityOfStart& s : study.starts) out << sentence(s) << "\n";
  return out.str();
}

std::vector<std::string> complaints(const FidelityStudy& study) {
  std::vector<std::string> all;
  for (std::size_t v = 0; v < study.variants.size(); ++v)
    if (const dynamics::Health health = study.health(v); !health.clean())
      all.push_back(study.variants[v].name() + ", step " + step_text(study.variants[v]) + ": " +
                    complaint(health));
  return all;
}

}  // namespace gatewalk::cli
