// SPDX-License-Identifier: MIT
#pragma once
/// The laws that every numerical method must keep, and how exactly: one row per method, each number
/// with its reason. The tests of the laws are tests/dynamics/laws_test.cpp and limits_test.cpp;
/// properties of a single method are in the tests of that method.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "dynamics/disc/gate.h"
#include "tests/support/numbers.h"

namespace gatewalk::test {

/// The most energy that `trials` noisy trials may create, J, in a study with this step and force
/// (N).
struct CreatedEnergy {
  double step, random, most;
  int trials;
  double event_tolerance = 1e-2;  // m
};

/// How the energy created by noisy trials falls with the step.
struct EnergyOrder {
  double least = 0.0, most = 0.0, random = 10.0;
  int trials = 300;
  bool one_restitution = true;    // tips have the restitution of the sides
  std::array<double, 3> worst{};  // J at steps of 0.004, 0.002 and 0.001 s
};

struct Wall {
  double stiffness, beam_mass;
};

struct Trials {
  int usual, full;
};

struct MethodLaws {
  std::string_view name;
  double step = 0.004;  // s

  // ---- Free motion ----
  /// Error of the free beam after 2 s, as hypot(theta, omega / w0), the accuracy to which it is
  /// known, and the order in which it falls (0: rounding).
  double beam_error = 0.0, beam_digits = 0.0;
  int beam_order = 0;
  /// In a step in which drag takes the fraction g of a free body's speed: the fraction of the speed
  /// that remains, and the fraction of the way at the old speed.
  double (*kept)(double g) = [](double g) { return std::exp(-g); };
  double (*way)(double g) = [](double) { return 1.0; };
  double flight = 500 * 32 * kEps;  // m, m/s; 500 steps, numbers up to 24
  /// Place and time at which a disc leaves at 10 m/s: 126 steps round x by eps 25 m / 2.
  double exit_time = 126 * 12.5 * kEps / 10;  // s
  double exit_place = 50 * kEps;              // m

  // ---- Single hits ----
  bool at_mid_step = false;  // the impulse acts at mid-step, in overlap, not where the gap is zero
  double place = 0.0;        // m, accuracy of the hit's place

  // ---- Many hits ----
  double reversed = 0.0;  // m, m/s, rad; distance from the start on return
  std::vector<CreatedEnergy> created{};
  double overlap_m = 0.0;  // in these trials
  bool clean = true;       // Health reports nothing about these trials
  bool reported = false;   // Health reports created energy
  EnergyOrder order{};
  Trials mirrored{};
  bool same_work = true;  // gaps are evaluated in an order that a mirror image does not change

  // ---- Held contacts ----
  bool holds = false;   // contacts become constraints
  double pull_N = 0.0;  // of a held contact

  // ---- Limits ----
  std::vector<Wall> walls{};
  double wall_overlap = 0.0;  // m
  double fastest = 0.0;       // rad/s or e-folds per second of a beam; faster beams are refused
  std::string_view fastest_key{};
  double near_overlap = std::numeric_limits<double>::infinity();  // m, after near-singular starts
  Trials near_starts{};
  double graze = 0.0;  // least distance from R, in units of R, at which grazing discs are tried
  double graze_slack = 0.0;  // m, gaps that count as contact
  Trials scenes{};
};

/// The name of the method, which becomes part of the test's name: `Methods/AnyMethod.Law/event`.
inline void PrintTo(const MethodLaws& m, std::ostream* out) { *out << m.name; }

inline std::vector<MethodLaws> all_methods() {
  return {
      // Free motion is exact, except for the rounding of 100 or 600 steps of 0.02 s. A hit is found
      // where the gap is at most 1e-10 R, mostly 1e-12 R, and each hit amplifies earlier errors.
      {.name = "stable",
       .step = 0.02,
       .beam_digits = 100 * kEps,
       .flight = 100 * 16 * kEps,
       .place = 1e-9,
       .reversed = 1e-10,  // measured 2.4e-12
       // The midpoint rule's error in constrained motion. It grows with the speed at which the disc
       // slides along the beams, and so with Rm. The limits are about four times the values
       // measured for a disc that has up to 430, 920 and 1370 J:
       //     0.004 s: 9e-6, 3e-5, 6e-5 J    0.02 s: 1.3e-3, 4.7e-3, 8e-3 J
       .created = {{0.004, 10.0, 4e-5, 10'000},
                   {0.004, 40.0, 1.2e-4, 10'000},
                   {0.004, 60.0, 2.5e-4, 10'000},
                   {0.02, 10.0, 5e-3, 10'000},
                   {0.02, 40.0, 2e-2, 10'000},
                   {0.02, 60.0, 3e-2, 10'000}},
       .overlap_m = 1e-8,
       // Measured order 3.0; the midpoint rule guarantees 2. Worst: 1.9e-5, 2.4e-6 and 3e-7 J.
       .order = {2.0, 5.0, 40.0, 2000, false, {8e-5, 1e-5, 1.2e-6}},
       .mirrored = {10'000, 100'000},
       .holds = true,
       // Forces only push, but the method checks for a force at mid-step. At the end of a step a
       // contact may be held half a step too long, with a pull of the change of its force.
       // Measured: 24 N.
       .pull_N = 40.0,
       .walls = {{1e9, 0.1}, {1e12, 1e4}},
       .wall_overlap = 1e-8,
       // 1024 pieces of a step of 0.02 s may each turn a beam's phase by 0.5.
       .fastest = 1024 * 0.5 / 0.02,
       .fastest_key = "run.step_s",
       .near_overlap = 1e-8,  // the method treats gaps up to 1e-10 R as contact
       .near_starts = {25'000, 200'000},
       .graze = 1e-6,  // chords shorter than a step are not detected
       .graze_slack = 1e-9,
       .scenes = {6000, 100'000}},
      // Like stable, without steps: rounding of 100 holds; a hit is found where the gap is at most
      // 1e-13 m.
      {.name = "event",
       .step = 0.02,
       .beam_digits = 100 * 4 * kEps,
       .flight = 100 * 16 * kEps,
       .exit_time = 8 * 25 * kEps / 10,  // one free flight: x is rounded once or twice
       .place = 2e-13,
       .reversed = 1e-10,  // measured 2e-12
       // Measured over 10^4 trials of a disc that has up to 430 and 1370 J: 3e-6 and 5.6e-3 J by
       // default, 1e-11 J at a tolerance of 1e-6 m. The overlap of up to 1e-7 m occurs where the
       // body leaves, because that state is interpolated.
       .created = {{0.02, 10.0, 2e-2, 1000},
                   {0.02, 60.0, 2e-2, 1000},
                   {0.02, 10.0, 1e-9, 200, 1e-6},
                   {0.02, 60.0, 1e-9, 200, 1e-6}},
       .overlap_m = 1e-5,
       .mirrored = {3000, 50'000},
       .same_work = false,
       .holds = true,
       .pull_N = 1e-12,
       .walls = {{1e9, 0.1}, {5e10, 0.1}, {1e12, 1e4}},
       .wall_overlap = 1e-8,
       .fastest = 1000 * 50.0,  // 1000 rad or e-folds in a hold of 0.02 s
       .fastest_key = "run.method",
       .near_overlap = 1e-5,  // measured over 10^5: 4e-12 m
       .near_starts = {20'000, 200'000},
       .graze = 1e-15,
       .graze_slack = 1e-13 + 2e-14,  // gaps up to 1e-14 R are contact; round-off of 10 m
       .scenes = {2000, 100'000}},
      // The midpoint rule: its phase lags by (w0 h)^2 / 12 of w0 t. The impulse acts at mid-step,
      // to round-off; elastic steps are their own inverse; the overlap is the motion within a step.
      {.name = "moreau",
       .beam_error = 1.14e-5,
       .beam_digits = 1e-7,
       .beam_order = 2,
       .kept = [](double g) { return (1 - g / 2) / (1 + g / 2); },
       .at_mid_step = true,
       .place = 4 * kEps * 15,
       .reversed = 1e-11,  // measured 5.4e-13
       // Restitutions of 0.8 on sides and 1 on tips: measured 7.6e-4 and 2.2e-3 J.
       .created = {{0.004, 10.0, 0.01, 300}, {0.004, 40.0, 0.01, 300}},
       .overlap_m = 1.0,
       .clean = false,
       // A closing force on an opening contact gains (h F)^2, in steps whose frequency is
       // proportional to h. Measured means 8.2e-6, 1.2e-6, 1.1e-7 J, worst 7.9e-4, 1.9e-4, 1.9e-5
       // J.
       .order = {1.0, 5.0, 10.0, 300, true, {1.6e-3, 8e-4, 4e-4}},
       .mirrored = {2000, 100'000},
       .walls = {{1e12, 0.1}},                              // far beyond what a step resolves
       .wall_overlap = 0.004 * std::sqrt(2 * 7.0 * 10.1)},  // the disc's motion within a step
      // Semi-implicit Euler against springs: of first order throughout, with the same rounding.
      {.name = "penalty",
       .beam_error = 1.3e-3,  // the printed digits
       .beam_digits = 5e-5,
       .beam_order = 1,
       .kept = [](double g) { return 1 - g; },
       .way = [](double g) { return 1 - g; },  // at the new speed
       // Elastic tips create more energy than springs of a single restitution. Measured worst: 20
       // J.
       .created = {{0.004, 40.0, 30.0, 300}},
       .overlap_m = 10.0,
       .clean = false,
       .reported = true,
       // Including the contacts' springs: means 0.26, 0.12 and 0.05 J, worst 1.4, 1.3 and 0.3 J.
       .order = {0.75, 1.25, 10.0, 300, true, {3.0, 3.0, 1.0}},
       .mirrored = {2000, 100'000}},
      // Explicit Euler, which moves with the old speed, and leaves at the end of a step.
      {.name = "paper",
       .beam_error = 3.3e-3,  // the printed digits
       .beam_digits = 5e-5,
       .beam_order = 1,
       .kept = [](double g) { return 1 - g; },
       .exit_time = 0.004,
       .exit_place = 0.04},
  };
}

/// Fixture for a law that all methods keep; laws of some methods derive from it.
class AnyMethod : public testing::TestWithParam<MethodLaws> {
 protected:
  /// `p` with this method, at the step of its row or another one.
  [[nodiscard]] static dynamics::GateParams by(dynamics::GateParams p, double step = 0.0) {
    p.run.method = GetParam().name;
    p.run.step = step > 0.0 ? step : GetParam().step;
    return p;
  }
  [[nodiscard]] static dynamics::RandomForce force_of(const dynamics::GateParams& p, int trial,
                                                      double sign = 1.0) {
    return {p.forces,
            dynamics::Random(dynamics::Purpose::gate, {3, 0, static_cast<std::uint64_t>(trial)}),
            sign};
  }
};

/// The methods whose rows fit.
inline auto methods_that(bool (*fits)(const MethodLaws&)) {
  std::vector<MethodLaws> fitting;
  for (const MethodLaws& m : all_methods())
    if (fits(m)) fitting.push_back(m);
  return testing::ValuesIn(fitting);
}

/// `exact`: finds hits exactly; `held`: contacts become constraints; `alike`: treats both beams at
/// once.
inline bool exact(const MethodLaws& m) { return m.place > 0.0; }
inline bool held(const MethodLaws& m) { return m.holds; }
inline bool alike(const MethodLaws& m) { return m.mirrored.usual > 0; }
inline bool stepping(const MethodLaws& m) { return m.order.least > 0.0; }

inline std::string method_name(const testing::TestParamInfo<MethodLaws>& m) {
  return std::string(m.param.name);
}

}  // namespace gatewalk::test
