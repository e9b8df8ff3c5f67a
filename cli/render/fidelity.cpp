// SPDX-License-Identifier: MIT
#include "cli/render/fidelity.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>

#include "cli/fields/csv.h"
#include "cli/fields/text.h"
#include "cli/fields/text_table.h"
#include "cli/render/field_ends.h"
#include "cli/render/final_gates.h"
#include "cli/render/health.h"
#include "cli/render/panel.h"
#include "cli/render/quantity.h"
#include "cli/render/start.h"
#include "dynamics/disc/disc_section.h"

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
    return fmt::format("{} has TV {} +- {} (chance {}, p {})", name,
                       fixed(c.apart.total_variation, 4), fixed(c.uncertainty(), 4),
                       fixed(c.in_pairs.floor_total_variation, 4),
                       p_text(c.in_pairs.p_total_variation));
  };
  const std::string words[] = {
      "active is enough",
      fmt::format("{} trials cannot tell whether active is enough", s.runs[0].tally.trials),
      "active is not enough"};
  return wrapped(fmt::format("Start {}, {}, {}: {}: {}, {}.", digits(s.start.x), digits(s.start.vx),
                             digits(s.start.vy), words[static_cast<int>(s.active_is())],
                             about("remember", *s.runs[1].change),
                             about("all", *s.runs[2].change)));
}

void describe(Fields& out, const FidelityVariant& v, const FidelityRun& run) {
  const FieldTally& t = run.tally;
  out.text(Label("fidelity", "how much of the field moves, as in field.fidelity")
               .one_of({lattice::kFidelityNames.begin(), lattice::kFidelityNames.end()}),
           name_of(v.scene.field.fidelity));
  out.text({"method", "method that was used, as in run.method"}, v.scene.gate.run.method);
  out.number({"step_s", "s", "time step that was used, as in run.step_s"}, v.scene.gate.run.step);
  out.number({"seconds_per_trial", "s",
              "wall-clock time of a trial, the shortest of several interleaved repeats"},
             run.seconds_per_trial);
  out.object({"fates", "shares of trials by how they ended"}, [&](Fields& f) {
    describe_fates(f, t);
    f.number({"not_finite", "1", "share of trials with a run that stopped being finite numbers"},
             share(t.broken(), t));
  });
  out.optional(run.change.has_value(), [&](Fields& f) {
    const PairedChange change = run.change.value_or(PairedChange());
    describe_change(f, change);
    f.object(
        Label("as_independent_samples",
              "final gates compared with the first run's, as if they did not share random numbers"),
        [&](Fields& apart) { cli::describe(apart, change.apart); });
    f.object(
        Label(
            "in_pairs",
            "final gates compared with the first run's, trial by trial with shared random numbers"),
        [&](Fields& pairs) { cli::describe(pairs, change.in_pairs); });
  });
  out.grid({"final_gates", "1", "number of trials by the gate in which they end"}, t.final_cells);
  describe_status(out, t.health);
}

}  // namespace

void describe(Fields& out, const FidelityResult& result) {
  const auto& [study, made_by] = result;
  out.text({"machine", "processor on which times were taken"}, machine());
  out.count({"trials", "1", "number of trials in each run"}, study.trials);
  out.count({"threads", "1", "number of threads on which times were taken"}, study.threads);
  out.number(
      {"bound", "1", "largest total variation of the final gates that counts as a small change"},
      lattice::kSmallChange);
  out.list_of({"starts", "one for each start"}, study.starts.size(), [&](Fields& f, std::size_t i) {
    const FidelityOfStart& s = study.starts[i];
    describe_start(f, dynamics::disc_section(),
                   dynamics::entry_of(study.variants.front().scene.gate, s.start));
    const Sufficiency active = s.active_is();
    f.flag(
        {"active_is_enough",
         "whether remember and all change active's final gates by at most bound; null: too few "
         "trials to tell"},
        active == Sufficiency::cannot_tell ? std::optional<bool>() : active == Sufficiency::enough);
    f.text({"sentence", "active_is_enough in a sentence"}, sentence(s));
    f.list_of(
        {"runs", "one run for each fidelity and method; the others are compared with the first"},
        s.runs.size(),
        [&](Fields& run, std::size_t v) { describe(run, study.variants[v], s.runs[v]); });
  });
  describe_made_by(out, made_by);
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
        return run.change ? x : kUnknown;  // an empty field
      };
      const lattice::Comparison &a = c.apart, &p = c.in_pairs;
      csv.row(s.start.x, s.start.vx, s.start.vy, std::string(name_of(scene.field.fidelity)),
              scene.gate.run.method, scene.gate.run.step, static_cast<double>(t.trials),
              run.seconds_per_trial, share(t.trapped(), t), share(t.left_field(), t),
              share(t.cut_off(), t), share(t.broken(), t), changed(c.changed),
              changed(a.total_variation), changed(c.uncertainty()),
              changed(a.floor_total_variation), changed(p.floor_total_variation),
              changed(a.p_total_variation), changed(p.p_total_variation), changed(a.p_energy),
              changed(p.p_energy), changed(a.corrcoef), changed(a.floor.corrcoef),
              changed(a.rmse_per_100), changed(a.floor.rmse_per_100),
              t.health.clean() ? "true" : "false");
    }
  return csv.text();
}

std::string answer_text(const FidelityStudy& study) {
  std::string out;
  for (const FidelityOfStart& s : study.starts) out += sentence(s);
  return out +
         wrapped(fmt::format(
             "From {} trials for each start and field.fidelity, all with the same random numbers. "
             "TV: "
             "total variation of the final gates from those with active beams. Active is enough "
             "where TV with its uncertainty (+-) is at most {}.",
             study.trials, digits(lattice::kSmallChange)));
}

std::string details_text(const FidelityStudy& study) {
  const TextColumn start{"   d   vx   vy"}, name{"fidelity (method)", -18, 0, "", "  | "};
  TextTable endings({start,
                     name,
                     {"ms", 8, 2},
                     {"trapped", 10, 2, "%"},
                     {"departed", 11, 2, "%"},
                     {"cut off", 10, 2, "%"}}),
      changes({start,
               name,
               {"changed", 8, 1, "%"},
               {"TV", 8, 4},
               {"floor", 8, 4},
               {"pairs", 8, 4},
               {"p", 7},
               {"p pairs", 8},
               {"corrcoef", 9, 4},
               {"RMSE", 7, 3}});
  for (const FidelityOfStart& s : study.starts)
    for (std::size_t v = 0; v < study.variants.size(); ++v) {
      const FidelityRun& run = s.runs[v];
      const FieldTally& t = run.tally;
      const std::string at = start_text(
                            dynamics::disc_section(),
                            dynamics::entry_of(study.variants.front().scene.gate, s.start)),
                        variant = study.variants[v].name();
      endings.row({at, variant, 1e3 * run.seconds_per_trial, 100.0 * share(t.trapped(), t),
                   100.0 * share(t.left_field(), t), 100.0 * share(t.cut_off(), t)});
      if (!run.change) continue;
      const lattice::Comparison &a = run.change->apart, &p = run.change->in_pairs;
      changes.row({at, variant, 100.0 * run.change->changed, a.total_variation,
                   a.floor_total_variation, p.floor_total_variation, p_text(a.p_total_variation),
                   p_text(p.p_total_variation), a.corrcoef, a.rmse_per_100});
    }
  const auto step = [](const FidelityVariant& v) {
    return fmt::format("{} ({})", step_text(v), v.scene.gate.run.method);
  };
  return fmt::format(
      "\nThe step is {}, {}.\n"
      "ms: wall-clock time per trial, {}, least of {} repeats in turn.\n\n{}\n"
      "Compared with the first line of the start. changed: trials that end in another gate. TV: "
      "total\n"
      "variation of the final gates; floor: what chance gives between independent samples; pairs: "
      "what\n"
      "chance gives between samples with the same noise. RMSE: trials per 100.\n\n{}\n"
      "The uncertainty of TV is what chance makes of pairs 95 times in 100, and 3 trials of {} "
      "more.\n"
      "Active is not enough where TV less its uncertainty is more than {}.\n",
      step(study.variants.front()), step(study.variants.back()),
      counted(study.threads, "thread", "threads"), lattice::kFidelityRepeats, endings.text(),
      changes.text(), study.trials, digits(lattice::kSmallChange));
}

std::vector<std::string> complaints(const FidelityStudy& study) {
  std::vector<std::string> all;
  for (std::size_t v = 0; v < study.variants.size(); ++v)
    if (const dynamics::Health health = study.health(v); !health.clean())
      all.push_back(fmt::format("{}, step {}: {}", study.variants[v].name(),
                                step_text(study.variants[v]), complaint(health)));
  return all;
}

namespace {

/// How each variant looks.
constexpr std::array<Pen, 4> kLooks{Pen{.colour = kFirstColour, .mark = 7, .size = 0.8},
                                    Pen{.colour = kSecondColour, .mark = 5, .size = 0.8},
                                    Pen{.colour = kThirdColour, .mark = 9, .size = 0.8},
                                    Pen{.colour = kFourthColour, .mark = 13, .size = 0.8}};

/// The name of a variant in a figure's key.
std::string plain_name(const FidelityStudy& study, std::size_t v) {
  const lattice::Scene& scene = study.variants[v].scene;
  return std::string(name_of(scene.field.fidelity)) +
         (v == 3 ? ", method " + scene.gate.run.method : "");
}

}  // namespace

Figure figure_of(const FidelityStudy& study) {
  constexpr double kLine = 15, kRow = 4 * kLine + 12, kTop = 92;
  const std::size_t n = study.starts.size(), variants = study.variants.size();
  const double bottom = kTop + kRow * static_cast<double>(n);
  Panels out;
  // A line for each variant of each start, from the top down: "line TV TV- TV+ chance ms".
  std::vector<Rows*> rows;
  for (std::size_t v = 0; v < variants; ++v)
    rows.push_back(&out.data(fmt::format("$variant{}", v)));
  std::vector<Tic> tics;
  double most = lattice::kSmallChange, slowest = 0.0;
  for (std::size_t s = 0; s < n; ++s) {
    const lattice::FidelityOfStart& of = study.starts[s];
    const double first = kRow * static_cast<double>(s) + 0.5 * (kRow - 3 * kLine);
    tics.push_back(
        {fmt::format("{}, {}, {}", digits(of.start.x), digits(of.start.vx), digits(of.start.vy)),
         first + 1.5 * kLine});
    for (std::size_t v = 0; v < variants; ++v) {
      const FidelityRun& run = of.runs[v];
      const double line = first + kLine * static_cast<double>(v), ms = 1e3 * run.seconds_per_trial;
      slowest = std::max(slowest, ms);
      if (run.change) {
        const double tv = run.change->apart.total_variation, apart = run.change->uncertainty();
        most = std::max(most, tv + apart);
        rows[v]->add(line, tv, std::max(0.0, tv - apart), tv + apart,
                     run.change->in_pairs.floor_total_variation, ms);
      } else {
        rows[v]->add(line, "NaN NaN NaN NaN", ms);
      }
    }
  }
  const Pen chance{.colour = kInk, .width = 1.2, .mark = 2, .size = 0.7},
      bound{.colour = kInk, .dashes = 2};
  std::vector<Layer> key;
  for (std::size_t v = 0; v < variants; ++v)
    key.push_back(entry("points", kLooks[v % kLooks.size()], plain_name(study, v)));
  out.add_key(8, 30, {key[0], key[1]});
  out.add_key(140, 30, {key[2], key[3]});
  out.add_key(330, 30,
              {entry("points", chance, "chance"),
               entry("lines", bound, "bound " + digits(lattice::kSmallChange))});

  Panel& changes = out.add({100, 330, kTop, bottom});
  changes.say(fmt::format("{} trials; starts: d (m), v_x, v_y (m/s)", study.trials), 8, 16);
  changes.x = {"total variation to active", 0, 1.05 * most, digits(tic_step(most, 4))};
  changes.y = {"", bottom - kTop, 0, tics_of(tics) + " scale 0"};
  changes.grid = std::string("xtics") + kThin;
  changes.uprights.push_back({lattice::kSmallChange, bound});
  Panel& times = out.add({362, 492, kTop, bottom});
  times.x = {fmt::format("ms, {}{}", study.threads, study.threads == 1 ? " thread" : " threads"), 0,
             kFree, digits(tic_step(slowest, 2))};
  times.y = {"", changes.y.low, changes.y.high, kNoTics};
  times.grid = changes.grid;
  for (std::size_t v = 0; v < variants; ++v) {
    Pen pen = kLooks[v % kLooks.size()];
    times.draw(*rows[v], "6:1", "points", pen);
    if (v == 0) continue;
    pen.width = 1.2;
    changes.draw(*rows[v], "2:1:3:4", "xerrorbars", pen);
    changes.draw(*rows[v], "5:1", "points", chance);
  }
  return out.figure(static_cast<int>(bottom + 62));
}

}  // namespace gatewalk::cli
