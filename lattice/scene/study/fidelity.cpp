// SPDX-License-Identifier: MIT
#include "lattice/scene/study/fidelity.h"

#include <tbb/global_control.h>

#include <limits>

#include "dynamics/disc/methods/method.h"
#include "lattice/gates/disc_field.h"
#include "lattice/scene/terrain.h"

namespace gatewalk::lattice {
namespace {

constexpr std::int64_t kTimedTrials = 64;
constexpr std::int64_t kTimedAtOnce = 16;

FieldTally run(const FidelityVariant& v, const dynamics::BodyState& start,
               const dynamics::StateSpace& space, std::uint64_t seed, dynamics::TrialRange range,
               FieldTrials* each = nullptr) {
  return run_field(v.scene.gate, v.scene.field, start, seed, range, each, &space);
}

PairedChange change_of(const FidelityRun& variant, const FidelityRun& base, std::uint64_t seed) {
  return paired_change({variant.final_gates, variant.tally.final_cells},
                       {base.final_gates, base.tally.final_cells}, seed);
}

/// Seconds per trial of every variant. The variants run the same trials in turn, so that other load
/// on the machine affects all alike.
std::vector<double> time_trials(const std::vector<FidelityVariant>& variants,
                                const dynamics::BodyState& start, const dynamics::StateSpace& space,
                                const FidelityOptions& options, const dynamics::Work& work) {
  const std::int64_t timed = std::min(options.trials, kTimedTrials);
  const std::int64_t pieces = (timed + kTimedAtOnce - 1) / kTimedAtOnce;
  const auto kinds = static_cast<std::int64_t>(variants.size());
  std::vector<double> seconds(kFidelityRepeats * kinds, 0.0);
  work.in_pieces("timing", kFidelityRepeats * pieces * kinds, [&](dynamics::TrialRange items) {
    for (std::int64_t item = items.first; item < items.first + items.count; ++item) {
      const std::int64_t kind = item % kinds, piece = item / kinds % pieces,
                         repeat = item / kinds / pieces;
      const std::int64_t from = piece * kTimedAtOnce;
      const dynamics::Stopwatch watch;
      (void)run(variants[kind], start, space, options.seed,
                {from, std::min(kTimedAtOnce, timed - from)});
      seconds[repeat * kinds + kind] += watch.seconds();
    }
  });
  std::vector<double> least(variants.size(), std::numeric_limits<double>::infinity());
  for (std::int64_t i = 0; i < kFidelityRepeats * kinds; ++i)
    least[i % kinds] = std::min(least[i % kinds], seconds[i] / static_cast<double>(timed));
  return least;
}

FidelityOfStart run_start(const std::vector<FidelityVariant>& variants,
                          const dynamics::BodyState& start, const FidelityOptions& options,
                          const dynamics::Work& work) {
  const auto space = dynamics::table3_space(variants[0].scene.gate);
  FidelityOfStart all{start, {}};
  for (const FidelityVariant& v : variants) {
    FieldTally tally(v.scene.field);
    FieldTrials each;
    work.in_pieces(v.name(), options.trials, [&](dynamics::TrialRange range) {
      tally += run(v, start, space, options.seed, range, &each);
    });
    all.runs.push_back({std::move(tally), std::move(each.final_gates)});
  }
  const std::vector<double> seconds = time_trials(variants, start, space, options, work);
  for (std::size_t v = 0; v < variants.size(); ++v) {
    all.runs[v].seconds_per_trial = seconds[v];
    if (v > 0) all.runs[v].change = change_of(all.runs[v], all.runs[0], options.seed);
  }
  return all;
}

}  // namespace

std::string FidelityVariant::name() const {
  return std::string(name_of(scene.field.fidelity)) + " (" + scene.gate.run.method + ")";
}

std::vector<FidelityVariant> fidelity_variants(const Scene& scene) {
  require_no_terrain(scene, "a comparison of fidelities");
  std::vector<FidelityVariant> all;
  const auto add = [&](Fidelity fidelity, const std::string& method) {
    Scene s = scene;
    s.field.fidelity = fidelity;
    s.gate.run.method = method;
    if (!s.named.contains("run.step_s")) s.gate.run.step = dynamics::default_step(s.gate);
    validate(s.gate, s.field);
    (void)dynamics::make_method(s.gate);  // throws for gates that the method cannot run
    all.push_back({std::move(s)});
  };
  for (const Fidelity f : {Fidelity::active, Fidelity::remember, Fidelity::all}) add(f, "moreau");
  add(Fidelity::active, dynamics::GateParams{}.run.method);
  (void)dynamics::table3_space(scene.gate);  // throws for gates too short for their beams
  return all;
}

dynamics::Health FidelityStudy::health(std::size_t variant) const {
  dynamics::Health sum;
  for (const FidelityOfStart& s : starts) sum += s.runs[variant].tally.health;
  return sum;
}

bool FidelityStudy::clean() const {
  for (std::size_t v = 0; v < variants.size(); ++v)
    if (!health(v).clean()) return false;
  return true;
}

FidelityStudy compare_fidelities(const std::vector<FidelityVariant>& variants,
                                 const FidelityOptions& options, const dynamics::Work& work) {
  FidelityStudy study{variants,
                      options.trials,
                      static_cast<int>(tbb::global_control::active_value(
                          tbb::global_control::max_allowed_parallelism)),
                      {}};
  for (const dynamics::BodyState& start : options.starts)
    study.starts.push_back(run_start(variants, start, options, work));
  return study;
}

}  // namespace gatewalk::lattice
