// SPDX-License-Identifier: MIT
#include "dynamics/disc/params.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <string>

namespace gatewalk::dynamics {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

/// The message with which validate() refuses `params`, or "" if it accepts them; `key` receives the
/// key.
std::string refusal(const GateParams& params, std::string* key = nullptr) {
  try {
    validate(params);
  } catch (const InvalidParameter& error) {
    if (key) *key = error.key();
    return error.what();
  }
  return {};
}

TEST(Params, DefaultsAreValid) { EXPECT_EQ(refusal(GateParams{}), ""); }

TEST(Params, DefaultInertiaIsThePapers) { EXPECT_NEAR(Beams{}.inertia(), 20.83, 0.005); }

TEST(ParamTable, NamesEachFieldOnce) {
  std::set<std::string_view> keys;
  std::set<const double*> places;
  GateParams params;
  for (const ParamInfo& info : gate_param_table()) {
    EXPECT_TRUE(keys.insert(info.key).second) << info.key;
    EXPECT_TRUE(places.insert(&info.ref(params)).second) << info.key;
    EXPECT_FALSE(info.meaning.empty()) << info.key;
  }
  // Every double of GateParams has a key: 2 + 7 + 4 + 3 + 5.
  constexpr std::size_t kDoubles = (sizeof(GateParams) - sizeof(std::string)) / sizeof(double);
  EXPECT_EQ(keys.size(), kDoubles);
  EXPECT_EQ(kDoubles, 21u);
}

struct ExpectedRange {
  std::string_view key;
  double value;  // the default
  const char* range;
};

// Defaults and ranges as the scene contract has them, in its order.
constexpr ExpectedRange kContract[] = {
    {"body.mass_kg", 1.0, "(0, 1e+100]"},
    {"body.radius_m", 10.0, "(0, 1e+100]"},
    {"beams.length_m", 25.0, "(0, 1e+100]"},
    {"beams.mass_kg", 0.1, "(0, 1e+100]"},
    {"beams.stiffness_left_Nm_per_rad", 400.0, "[0, 1e+100]"},
    {"beams.stiffness_right_Nm_per_rad", 400.0, "[0, 1e+100]"},
    {"beams.damping_Nms_per_rad", 50.0, "[0, 1e+100]"},
    {"beams.joint_x_m", 25.0, "(0, 1e+100]"},
    {"beams.joint_y_m", 30.0, "(0, 1e+100]"},
    {"forces.propulsion_N", 8.0, "[0, 1e+100]"},
    {"forces.random_N", 40.0, "[0, 1e+100]"},
    {"forces.random_rate_Hz", 50.0, "(0, 1e+100]"},
    {"forces.drag_Ns_per_m", 0.06, "[0, 1e+100]"},
    {"contact.restitution", 0.8, "[0, 1]"},
    {"contact.tip_restitution", 1.0, "[0, 1]"},
    {"contact.impulse_threshold_Ns", 0.04, "[0, 1e+100]"},
    {"run.step_s", 0.02, "(0, 1e+100]"},
    {"run.time_limit_s", 12.0, "(0, 1e+100]"},
    {"run.traverse_y_m", 60.0, "(0, 1e+100]"},
    {"run.event_tolerance_m", 1e-2, "(0, 1e+100]"},
    {"run.tolerance", 0.005, "[1e-04, 1]"},
};

TEST(ParamTable, HasTheContractsDefaultsAndRanges) {
  const auto table = gate_param_table();
  ASSERT_EQ(table.size(), std::size(kContract));
  for (std::size_t i = 0; i < table.size(); ++i) {
    EXPECT_EQ(table[i].key, kContract[i].key);
    EXPECT_EQ(table[i].get(GateParams{}), kContract[i].value) << table[i].key;
    EXPECT_EQ(table[i].range(), kContract[i].range) << table[i].key;
  }
}

TEST(ParamTable, PermitsItsEndsAndNothingBeyond) {
  for (const ParamInfo& info : gate_param_table()) {
    EXPECT_EQ(info.permits(info.low), !info.low_open) << info.key;
    EXPECT_TRUE(info.permits(std::nextafter(info.low, kInf))) << info.key;
    EXPECT_FALSE(info.permits(std::nextafter(info.low, -kInf))) << info.key;
    EXPECT_TRUE(info.permits(info.high)) << info.key;
    EXPECT_FALSE(info.permits(std::nextafter(info.high, kInf))) << info.key;
    for (const double v : {std::nan(""), kInf, -kInf}) EXPECT_FALSE(info.permits(v)) << info.key;
  }
}

TEST(Validate, RefusesEveryKeyOutOfRangeByName) {
  for (const ParamInfo& info : gate_param_table()) {
    for (const double bad : {-1.0, std::nan(""), kInf, 2.0 * info.high}) {
      GateParams params;
      info.ref(params) = bad;
      std::string key;
      const std::string what = refusal(params, &key);
      EXPECT_EQ(key, info.key);
      EXPECT_EQ(what.find(std::string(info.key) + " = "), 0u) << what;
      EXPECT_NE(what.find("must lie in " + info.range()), std::string::npos) << what;
    }
  }
}

TEST(Validate, ShowsTheValueWithAllItsDigits) {
  GateParams params;
  params.contact.restitution = std::nextafter(1.0, 2.0);
  EXPECT_EQ(refusal(params),
            "contact.restitution = 1.0000000000000002 is not permitted: must lie in [0, 1]");
}

TEST(Validate, ListsTheMethods) {
  GateParams params;
  params.run.method = "euler";
  std::string key;
  const std::string what = refusal(params, &key);
  EXPECT_EQ(key, "run.method");
  EXPECT_NE(what.find("run.method = \"euler\""), std::string::npos) << what;
  for (const std::string_view name : method_names()) {
    EXPECT_NE(what.find("\"" + std::string(name) + "\""), std::string::npos) << what;
    params.run.method = name;
    EXPECT_EQ(refusal(params), "");
  }
}

TEST(Validate, EntranceAndExitLieClearOfTheBeams) {
  std::string key;
  GateParams params;
  params.body.radius = params.beams.joint_y;
  EXPECT_NE(refusal(params, &key).find("beams.joint_y_m = 30"), std::string::npos);
  EXPECT_EQ(key, "body.radius_m");
  params.body.radius = std::nextafter(params.beams.joint_y, 0.0);
  EXPECT_EQ(refusal(params), "");

  params = {};
  params.run.traverse_y = params.beams.joint_y;
  EXPECT_NE(refusal(params, &key).find("beams.joint_y_m = 30"), std::string::npos);
  EXPECT_EQ(key, "run.traverse_y_m");
  params.run.traverse_y = std::nextafter(params.beams.joint_y, kInf);
  EXPECT_EQ(refusal(params), "");
}

// Reciprocals of mass and inertia, and numbers computed from them, must stay finite.
TEST(Validate, RefusesWhatCannotBeComputed) {
  const auto refused = [](auto set) {
    GateParams params;
    set(params);
    return refusal(params) != "";
  };
  EXPECT_TRUE(refused([](GateParams& p) { p.body.mass = 5e-324; }));
  EXPECT_TRUE(refused([](GateParams& p) { p.beams.mass = 5e-324; }));
  EXPECT_TRUE(refused([](GateParams& p) { p.beams.length = 1e-170; }));
  EXPECT_TRUE(refused([](GateParams& p) { p.beams.stiffness_left = 1e99; }));
  EXPECT_TRUE(refused([](GateParams& p) {
    p.run.method = "event", p.run.event_tolerance = 2.0;
  }));  // over a tenth of the radius
  EXPECT_TRUE(
      refused([](GateParams& p) { p.run.method = "event", p.run.event_tolerance = 1e-14; }));
  EXPECT_FALSE(refused([](GateParams& p) { p.beams.stiffness_left = 1e12; }));
  EXPECT_FALSE(refused([](GateParams& p) { p.beams.mass = 1e-12; }));
}

TEST(StepsPerHold, CountsStepsOfOneDraw) {
  GateParams params;
  EXPECT_EQ(steps_per_hold(params), 1);
  params.run.step = 0.004;  // the paper's
  EXPECT_EQ(steps_per_hold(params), 5);
  for (const int n : {1, 2, 3, 7, 20, 80, 1000, 12345678}) {
    params.run.step = 0.02 / n;
    EXPECT_EQ(steps_per_hold(params), n);
  }
  params.forces.random_rate = 1e6;
  params.run.step = 1e-6;
  EXPECT_EQ(steps_per_hold(params), 1);
}

TEST(StepsPerHold, AcceptsAMillionthAndNoMore) {
  GateParams params;
  for (const double sign : {-1.0, 1.0}) {
    params.run.step = 0.004 * (1.0 + sign * 0.9e-6);
    EXPECT_EQ(refusal(params), "");
    params.run.step = 0.004 * (1.0 + sign * 1.1e-6);
    EXPECT_NE(refusal(params), "");
  }
}

struct Misfit {
  double rate, step;
  const char* nearest;
};

TEST(StepsPerHold, NamesTheNearestStepsThatFit) {
  for (const Misfit& m :
       {Misfit{50.0, 0.003, "nearest permitted: 0.00333333333 and 0.00285714286"},
        Misfit{50.0, 0.03, "nearest permitted: 0.02"},  // longer than a hold
        Misfit{0.8, 0.9, "nearest permitted: 1.25 and 0.625"},
        Misfit{30.0, 0.004, "nearest permitted: 0.00416666667 and 0.0037037037"}}) {
    GateParams params;
    params.forces.random_rate = m.rate;
    params.run.step = m.step;
    std::string key;
    const std::string what = refusal(params, &key);
    EXPECT_EQ(key, "run.step_s");
    EXPECT_TRUE(what.ends_with(m.nearest)) << what;
    // The values that the message offers are accepted.
    params.run.step = std::stod(what.substr(what.rfind(' ')));
    EXPECT_EQ(refusal(params), "");
  }
}

TEST(StepsPerHold, RefusesMoreStepsThanAnIntCounts) {
  GateParams params;
  params.run.step = 1e-300;
  params.forces.random_rate = 1e-300;  // the product is 0
  std::string key;
  EXPECT_NE(refusal(params, &key).find("at most 2147483647"), std::string::npos);
  EXPECT_EQ(key, "run.step_s");

  params = {};
  params.run.time_limit = 1e6;
  params.run.step = 1e-4;
  EXPECT_NE(refusal(params, &key).find("1e+10 steps"), std::string::npos);
  EXPECT_EQ(key, "run.time_limit_s");
}

}  // namespace
}  // namespace gatewalk::dynamics
