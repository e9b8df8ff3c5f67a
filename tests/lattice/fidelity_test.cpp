// SPDX-License-Identifier: MIT
// The effect of memory and neighbours: counts and verdicts by hand, and the trials that are
// compared.
#include "lattice/scene/study/fidelity.h"
#include "tests/support/disc_fields.h"

#include <gtest/gtest.h>

namespace gatewalk::lattice {
namespace {

std::vector<std::string> names(const std::vector<FidelityVariant>& variants) {
  std::vector<std::string> all;
  for (const FidelityVariant& v : variants) all.push_back(v.name());
  return all;
}

TEST(FidelityVariants, AreMoreauAtEveryFidelityAndTheDefaultMethod) {
  Scene scene = parse_scene("run.method = 'paper'\nfield.fidelity = 'active'", "scene");
  EXPECT_EQ(names(fidelity_variants(scene)),
            (std::vector<std::string>{"active (moreau)", "remember (moreau)", "all (moreau)",
                                      "active (stable)"}));
  for (const FidelityVariant& v : fidelity_variants(scene))
    EXPECT_EQ(v.scene.gate.run.step, dynamics::default_step(v.scene.gate)) << v.name();
  scene = parse_scene("run.step_s = 0.001", "scene");
  for (const FidelityVariant& v : fidelity_variants(scene))
    EXPECT_EQ(v.scene.gate.run.step, 0.001) << v.name();
}

/// Trials of a field of 3 x 3 gates that end in these gates.
FidelityRun ending_in(const std::vector<std::int32_t>& gates) {
  FidelityRun run{FieldTally({.columns = 3, .rows = 3}), gates};
  run.tally.count(gates, std::vector(gates.size(), std::optional(markov::Ending::trapped)));
  return run;
}

PairedChange change_of(const FidelityRun& after, const FidelityRun& before) {
  return paired_change({after.final_gates, after.tally.final_cells},
                       {before.final_gates, before.tally.final_cells}, 1);
}

TEST(PairedChange, CountsTrialsAndDistributionsApart) {
  // One of four trials ends elsewhere, whichever of the two samples the null assigns it to.
  const PairedChange one = change_of(ending_in({0, 1, 2, 8}), ending_in({0, 1, 2, 3}));
  EXPECT_EQ(one.changed, 0.25);
  EXPECT_EQ(one.apart.total_variation, 0.25);
  EXPECT_EQ(one.in_pairs.total_variation, 0.25);
  EXPECT_EQ(one.in_pairs.floor_total_variation_95, 0.25);
  EXPECT_EQ(one.uncertainty(), 0.25 + 3.0 / 4);
  // Two trials change places: every trial ends elsewhere, but the distribution is the same.
  const PairedChange swapped = change_of(ending_in({1, 0}), ending_in({0, 1}));
  EXPECT_EQ(swapped.changed, 1.0);
  EXPECT_EQ(swapped.apart.total_variation, 0.0);
  EXPECT_EQ(swapped.in_pairs.floor_total_variation_95, 1.0);  // in half of the draws
}

/// 1000 trials with a sampling error of 0.01: the uncertainty is 0.013.
PairedChange seen(double total_variation) {
  PairedChange c{.trials = 1000};
  c.apart.total_variation = total_variation;
  c.in_pairs.floor_total_variation_95 = 0.01;
  return c;
}

TEST(PairedChange, IsJudgedWithItsUncertainty) {
  EXPECT_EQ(seen(0.0169).without_is(), Sufficiency::enough);
  EXPECT_EQ(seen(0.0171).without_is(), Sufficiency::cannot_tell);
  EXPECT_EQ(seen(0.0429).without_is(), Sufficiency::cannot_tell);
  EXPECT_EQ(seen(0.0431).without_is(), Sufficiency::not_enough);
  // If no trial changed, a hundred trials are the fewest that suffice.
  EXPECT_EQ(PairedChange{.trials = 100}.without_is(), Sufficiency::enough);
  EXPECT_EQ(PairedChange{.trials = 99}.without_is(), Sufficiency::cannot_tell);
}

TEST(FidelityOfStart, IsWhatTheWorseOfMemoryAndNeighboursSays) {
  const auto of = [](double remember, double all) {
    FidelityOfStart s;
    for (const double tv : {0.0, remember, all, 1.0})  // the other integrator does not count
      s.runs.push_back({ending_in({}).tally, {}, 0.0, seen(tv)});
    return s.active_is();
  };
  EXPECT_EQ(of(0.0, 0.0), Sufficiency::enough);
  EXPECT_EQ(of(0.02, 0.0), Sufficiency::cannot_tell);
  EXPECT_EQ(of(0.02, 0.1), Sufficiency::not_enough);
  EXPECT_EQ(of(0.1, 0.02), Sufficiency::not_enough);
}

TEST(FidelityStudy, RunsTheTrialsOfTheFullDynamics) {
  const auto variants =
      fidelity_variants(parse_scene("field = { rows = 3, columns = 3 }", "scene"));
  std::vector<std::string> told;
  const FidelityStudy study =
      compare_fidelities(variants, {{{0.0, 0.0, 0.0, 15.0}, {4.0, 0.0, 5.0, 10.0}}, 10, 7},
                         {[&](std::string_view what, std::int64_t done, std::int64_t) {
                           if (done == 0) told.emplace_back(what);
                         }});
  ASSERT_EQ(study.starts.size(), 2u);
  const auto space = dynamics::table3_space({});
  for (std::size_t v = 0; v < variants.size(); ++v) {
    dynamics::Health health;
    for (const FidelityOfStart& s : study.starts) {
      const Scene& scene = variants[v].scene;
      FieldTrials each;
      const FieldTally plain =
          run_field(scene.gate, scene.field, s.start, 7, {0, 10}, &each, &space);
      EXPECT_EQ(s.runs[v].final_gates, each.final_gates);
      EXPECT_EQ(s.runs[v].change.has_value(), v > 0);
      EXPECT_GT(s.runs[v].seconds_per_trial, 0.0);
      health += plain.health;
    }
    EXPECT_EQ(study.health(v).runs, health.runs);
    EXPECT_EQ(study.health(v).steps, health.steps);
  }
  std::vector<std::string> wanted;
  for (std::size_t k = 0; k < study.starts.size(); ++k) {
    for (const FidelityVariant& v : variants) wanted.push_back(v.name());
    wanted.emplace_back("timing");
  }
  EXPECT_EQ(told, wanted);
}

// In a single gate there is nothing to remember, and no neighbour.
TEST(FidelityStudy, SeesNoChangeInASingleGate) {
  const FidelityStudy study = compare_fidelities(
      fidelity_variants(parse_scene("field = { rows = 1, columns = 1 }", "scene")),
      {{{0.0, 0.0, 15.0}}, 30, 1});
  for (const std::size_t v : {1, 2}) {
    EXPECT_EQ(study.starts[0].runs[v].change->changed, 0.0);
    EXPECT_EQ(study.starts[0].runs[v].change->apart.total_variation, 0.0);
  }
}

}  // namespace
}  // namespace gatewalk::lattice
