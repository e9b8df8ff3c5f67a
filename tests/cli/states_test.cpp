// SPDX-License-Identifier: MIT
#include "cli/render/states.h"

#include <gtest/gtest.h>

#include <string>

#include "cli/fields/json_value.h"
#include "cli/render/choice.h"
#include "cli/render/matrix.h"
#include "dynamics/disc/disc_section.h"
#include "markov/formats/counts.h"

namespace gatewalk::cli {
namespace {

const std::string kBins =
    R"({"bins":"paper","factor":2.0,"states":87,"outermost_bins":"closed","row_starts":"visited",)"
    R"("rows_without_entries":3,"starts_of_their_own":[],"pilot":{"trials":200,"entries":1094,)"
    R"("status":{"clean":true,"runs":1294,"runs_penetrating_over_1_percent":0,)"
    R"("runs_creating_energy":0,"runs_too_fast_for_the_step":0,)"
    R"("runs_beyond_the_stability_bound":0,"runs_not_finite":0,"contacts_without_a_formula":0,)"
    R"("steps_forced_to_hold":2,"worst_penetration_m":9.983125437429408e-13,)"
    R"("worst_energy_created_J":0.0,"worst_speed_m_per_s":54.66276126140336,"steps":318582,)"
    R"("evaluations":1521675,"impacts":32527,"trials_checked":0,"outcome_error_seen":0.0}},)"
    R"("resolution":{"clamped_share":0.13071297989031078,"states_entered":78,)"
    R"("states_of_90_percent":44,"unresolved_variance":{"d":0.11022282454946374,)"
    R"("vx":0.14556907154745602,"vy":0.11639106802925922},"poor":false}})";
const std::string kTrees =
    R"({"bins":"tree","states":193,"outermost_bins":"open","entries_per_leaf":7,"gate_runs":1008,)"
    R"("accuracy":0.02,"starts_of_their_own":[{"d_m":0.0,"vx_m_per_s":0.0,"vy_m_per_s":15.0},)"
    R"({"face":"RD","d_m":1.5,"vx_m_per_s":-2.0,"vy_m_per_s":3.0}],)"
    R"("error_95":[0.08470133238516495,null],"range":null,"states_bias":0.25)";
const std::string kOwnTrials =
    R"({"trials":160,"total_variation":0.5,"chance_total_variation":0.25,"p":0.957,)"
    R"("differs":false})";
const std::string kAnyStart =
    R"({"bins":"tree","states":14,"outermost_bins":"open","entries_per_leaf":7,"gate_runs":68,)"
    R"("accuracy":0.02,"starts_of_their_own":[],"range":{"d_m":[-25.0,25.0],)"
    R"("vx_m_per_s":[-25.0,25.0],"vy_m_per_s":[10.0,20.0],"tried_on_starts":7,)"
    R"("kernel_error_95":0.20407777101013685,"worst_kernel_error_95":null},"states_bias":0.0,)"
    R"("own_trials":null})";
const std::string kRecorded =
    R"({"bins":"tree","entries_per_leaf":7,"gate_runs":40,"starts_of_their_own":[],"range":null,)"
    R"("states_bias":0.0,"states":9})";

StateRecord read(const std::string& attribute) {
  return state_record(attribute, dynamics::disc_section());
}

TEST(StateRecord, AttributesAreReadAsTheyWereWritten) {
  for (const std::string& attribute :
       {kBins, kTrees + R"(,"own_trials":)" + kOwnTrials + "}", kTrees + R"(,"own_trials":null})",
        kTrees + "}", kAnyStart, kRecorded, std::string(R"({"bins":"imported","states":87})"),
        std::string(R"({"bins":"imported","states":8,"probabilities":true})")})
    EXPECT_EQ(attribute_of(read(attribute)), attribute);
}

TEST(StateRecord, SaysWhatSentencesAndStartsNeed) {
  const StateRecord trees = read(kTrees + "}");
  ASSERT_TRUE(trees.trees && !trees.bins);
  EXPECT_EQ(trees.trees->gate_runs, 1008);
  EXPECT_EQ(trees.starts.at(1), (dynamics::Entry{dynamics::Boundary::right_deflect, {1.5, -2, 3}}));
  EXPECT_EQ(states_line(trees),
            "States: 191, leaves of trees with 7 entries or more, from 1008 gate runs.\n"
            "Starts with a state of their own: 0,0,15; RD:1.5,-2,3\n"
            "The limit of states changes the final gates by a total variation of 0.2500.\n"
            "A single row has few runs and is noisy; a prediction averages over all rows.\n");
  EXPECT_EQ(read(kAnyStart).trees->range->range.at[2], (std::array{10.0, 20.0}));
  EXPECT_EQ(states_line(read(kBins)),
            "States: 87 (Table III's bins x 2.0). Of 1094 entries in 200 pilot trials, 13.1 % lie "
            "outside the bins\n"
            "and 90 % lie in 44 states. Variance that remains within states: d 11.0 %, vx 14.6 %, "
            "vy 11.6 %.\n"
            "States that no body was seen to enter: 3; their rows start anywhere in the bin.\n");
}

lattice::MatrixFile file_with(const std::string& key, const std::string& text) {
  const dynamics::StateSpace space(dynamics::disc_section(),
                                   std::vector<dynamics::Tree>(dynamics::kBoundaries), {});
  return {dynamics::Transitions(space), {{key, text}}};
}

TEST(MatrixRecords, WhatIsDamagedIsRefusedByName) {
  for (const std::string& damaged :
       {std::string("{"), std::string("[]"), std::string(R"({"bins":"tree","states":9})"),
        kTrees.substr(0, kTrees.find("RD")) + "XX" + kTrees.substr(kTrees.find("RD") + 2) + "}"})
    try {
      (void)recorded_states(file_with("state_space", damaged), "m.nc");
      ADD_FAILURE() << damaged;
    } catch (const markov::BadFile& e) {
      EXPECT_STREQ(e.what(), "m.nc: its record of the state space is damaged");
    }
  EXPECT_FALSE(recorded_states(file_with("seed", "1"), "m.nc").has_value());
  EXPECT_THROW((void)recorded_method(file_with("method", R"({"asked":"auto"})"), "m.nc"),
               markov::BadFile);
  EXPECT_FALSE(recorded_health(file_with("status", R"({"clean":true})")).has_value());
}

TEST(MatrixRecords, AMethodIsReadAsItWasWritten) {
  const std::string method =
      R"({"asked":"auto","tolerance":0.005,"method":"moreau","step_s":0.002,)"
      R"("event_tolerance_m":0.01,"met":true,"pilot_trials":4000,"pilot_starts":9,)"
      R"("reference":{"method":"event","key":"run.event_tolerance_m","value":1e-05,)"
      R"("verdict":"ok"},"tried":[{"method":"moreau","key":"run.step_s","value":0.02,)"
      R"("verdict":"penetration","outcome_total_variation":null,"uncertainty":null,)"
      R"("trials_changed":0,"work_per_trial":2.16126},{"method":"stable","key":"run.step_s",)"
      R"("value":0.01,"verdict":"ok","outcome_total_variation":0.00475,)"
      R"("uncertainty":0.00187725863961256,"trials_changed":53,"work_per_trial":17.461305}]})";
  const auto settled = recorded_method(file_with("method", method), "m.nc");
  ASSERT_TRUE(settled);
  EXPECT_EQ(attribute_of(*settled), method);
}

}  // namespace
}  // namespace gatewalk::cli
