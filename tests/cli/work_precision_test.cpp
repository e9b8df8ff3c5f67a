// SPDX-License-Identifier: MIT
#include "cli/render/work_precision.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "cli/fields/json_value.h"

namespace gatewalk::cli {
namespace {

using dynamics::ChartPoint;
using dynamics::Outcome;
using dynamics::Verdict;
using dynamics::WorkPrecision;

/// 100 trials, one to six of each outcome; a setting whose error is significant, one whose error is
/// not, and one that was refused.
WorkPrecision sample() {
  WorkPrecision chart;
  chart.label = "one, two";
  chart.trials = 100;
  chart.reference.setting = {"event", "run.event_tolerance_m", 1e-7, false};
  std::int64_t n = 0;
  for (const Outcome o : {Outcome::traversed_left, Outcome::traversed_right, Outcome::exited_left,
                          Outcome::exited_right, Outcome::trapped, Outcome::broken})
    chart.reference.outcomes[static_cast<std::size_t>(o)] = ++n;
  ChartPoint point;
  point.setting = {"stable", "run.step_s", 0.02, true};
  point.verdict = Verdict::fine;
  point.microseconds = {3.0, 2.0};
  point.errors.outcomes = {.total_variation = 0.5, .standard_error = 0.05, .chance = 0.01};
  chart.points.push_back(point);
  point.errors.outcomes.total_variation = 0.05;  // less than ten trials
  chart.points.push_back(point);
  ChartPoint refused;
  refused.setting = {"penalty", "run.step_s", 0.02, true};
  refused.refusal = "too stiff, too coarse";
  chart.points.push_back(refused);
  return chart;
}

Json sample_json() {
  return json_of([](Fields& out) { describe(out, sample()); });
}

TEST(WorkPrecisionJson, CountsEveryOutcomeUnderItsName) {
  const Json j = sample_json();
  EXPECT_EQ(j.at("reference").at("outcomes"), Json({{"traversed_left", 1},
                                                    {"traversed_right", 2},
                                                    {"exited_left", 3},
                                                    {"exited_right", 4},
                                                    {"trapped", 5},
                                                    {"not_finite", 6}}));
  EXPECT_EQ(j.at("reference").at("setting"), "event 1e-07 m");
}

TEST(WorkPrecisionJson, GivesNoErrorBelowWhatCanBeShown) {
  const Json j = sample_json().at("settings");
  const Json &shown = j[0].at("errors").at("outcomes"), &hidden = j[1].at("errors").at("outcomes");
  EXPECT_EQ(shown.at("total_variation"), 0.5);
  EXPECT_FALSE(shown.contains("below"));
  EXPECT_TRUE(hidden.at("total_variation").is_null());
  EXPECT_EQ(hidden.at("below"), 0.1);
  EXPECT_EQ(j[0].at("microseconds_per_trial").at("min"), 2.0);
  EXPECT_EQ(j[2].at("reason"), "too stiff, too coarse");
  EXPECT_FALSE(j[2].contains("errors"));
}

TEST(WorkPrecisionCsv, HasTheSameFieldsInEveryLine) {
  const std::string csv = csv_of({sample()});
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  const auto commas = std::count(line.begin(), line.end(), ',');
  for (int i = 0; std::getline(lines, line); ++i) {
    EXPECT_TRUE(line.starts_with("\"one, two\",")) << line;
    // One comma stands within the name, and one within the reason of the third.
    EXPECT_EQ(std::count(line.begin(), line.end(), ','), commas + 1 + (i == 2)) << line;
  }
}

/// Whether the figure of a chart contains these words, as gnuplot's script.
bool says(const WorkPrecision& chart, const std::string& words) {
  return figure_of(std::vector{chart}).commands.find(words) != std::string::npos;
}

TEST(WorkPrecisionFigure, SaysWhatHasNoPlaceInIt) {
  WorkPrecision chart = sample();
  EXPECT_TRUE(says(chart, "refused: penalty 0.02 s"));
  EXPECT_TRUE(says(chart, "nothing to compare"));  // no run has left the gate
  EXPECT_FALSE(says(chart, "half or more parted"));
  chart.points[0].errors.strong = {.compared = 1, .parted = 9};
  EXPECT_TRUE(says(chart, "half or more parted"));
  EXPECT_FALSE(says(chart, "nothing to compare"));
}

}  // namespace
}  // namespace gatewalk::cli
