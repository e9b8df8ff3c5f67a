// SPDX-License-Identifier: MIT
/// Laws of physics with exact values, which any numerical method must keep, over many trials.
///   physics_bench [TRIALS=1000000]
/// Prints lines "law,by,what,figure,unit,limit,kept,cases". Fails if a law with a limit is broken.
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include "dynamics/disc/ensemble.h"
#include "dynamics/disc/methods/method.h"
#include "tests/support/held_force.h"
#include "tests/support/lorentz.h"
#include "tests/support/scenes.h"

namespace {

using namespace gatewalk;
using namespace gatewalk::dynamics;

constexpr double kNoLimit = NAN;
/// The limit of figures in standard errors. About 60 are printed, so one run in 300 exceeds it by
/// chance.
constexpr double kStandardErrors = 4.0;
bool all_kept = true;

struct Law {
  std::string law, by, what, unit;
  double limit = kNoLimit;
  bool at_least = false;  // the limit is a minimum, not a maximum
};

void line(const Law& l, double figure, std::int64_t cases) {
  std::printf("%s,%s,%s,%.3g,%s,", l.law.c_str(), l.by.c_str(), l.what.c_str(), figure,
              l.unit.c_str());
  if (std::isnan(l.limit)) {
    std::printf(",");
  } else {
    const bool kept = l.at_least ? figure >= l.limit : figure <= l.limit;
    all_kept = all_kept && kept;
    std::printf("%s %g,%s", l.at_least ? ">=" : "<=", l.limit, kept ? "yes" : "NO");
  }
  std::printf(",%lld\n", static_cast<long long>(cases));
  std::fflush(stdout);
}

/// Sums over trials 0 .. n - 1, in an order that no number of threads changes.
template <std::size_t k>
std::array<double, k> sums(std::int64_t n,
                           const std::function<std::array<double, k>(std::int64_t)>& of_trial) {
  return tbb::parallel_deterministic_reduce(
      tbb::blocked_range<std::int64_t>(0, n, 1000), std::array<double, k>{},
      [&](const auto& range, std::array<double, k> sum) {
        for (std::int64_t trial = range.begin(); trial < range.end(); ++trial) {
          const auto own = of_trial(trial);
          for (std::size_t i = 0; i < k; ++i) sum[i] += own[i];
        }
        return sum;
      },
      [](std::array<double, k> a, const std::array<double, k>& b) {
        for (std::size_t i = 0; i < k; ++i) a[i] += b[i];
        return a;
      });
}

// ---- Elastic, undamped, without drag: the forces' work is the energy of body and beams ----

void work_is_energy(const std::string& method, double tolerance, double step, double limit,
                    std::int64_t trials) {
  GateParams p = test::study(0.0);
  p.contact.restitution = 1.0;
  p.forces.random = 40.0;
  p.run.method = method;
  p.run.event_tolerance = tolerance;
  p.run.step = step;
  const auto by = make_method(p);
  const auto sum = sums<4>(trials, [&](std::int64_t trial) -> std::array<double, 4> {
    RandomForce force = gate_force(p, 1, trial);
    double off = 0.0, work = 0.0;
    // At the last step the body is outside; the run itself ends at the moment of leaving.
    const auto follow = [&](const EnergyLedger::Step& s) {
      work = s.propulsion_work + s.random_work;
      off = energy(p, s.state) - work;
    };
    const GateRun run =
        run_gate(p, *by, {}, force, std::numeric_limits<std::int64_t>::max(), follow);
    return {off, off * off, work * work, static_cast<double>(run.watch.impacts)};
  });
  const auto n = static_cast<double>(trials);
  const double rms = std::sqrt(sum[1] / sum[2]);
  char setting[64];
  if (method == "event")
    std::snprintf(setting, sizeof setting, "event at %g m", tolerance);
  else
    std::snprintf(setting, sizeof setting, "%s at %g s", method.c_str(), step);
  line({"work is energy", setting, "rms of energy less work by rms of work", "-", limit}, rms,
       trials);
  line({"work is energy", setting, "mean of energy less work by rms of work", "-", limit},
       std::abs(sum[0] / n) / std::sqrt(sum[2] / n), trials);
  line({"work is energy", setting, "hits of a trial", "-"}, sum[3] / n, trials);
}

// ---- Free flight: drift, diffusion and work of the held force ----

void free_flight(const std::string& method, double drag, std::int64_t trials) {
  constexpr double kAside = 3.0, kFlight = 2.0;
  GateParams p = test::without_beams({});
  p.forces.drag = drag;
  p.run.method = method;
  p.run.step = default_step(p);
  p.run.time_limit = kFlight;
  p.run.traverse_y = 1e5 * p.body.radius;
  const auto by = make_method(p);
  const BodyState start{.x = 0.0, .y = 0.0, .vx = kAside, .vy = 15.0};
  const test::FreeFlight exact = test::free_flight(p, start.x, start.vx, kFlight);
  // Values are centred on the exact means, so that squares lose no digits.
  const auto sum = sums<10>(trials, [&](std::int64_t trial) -> std::array<double, 10> {
    RandomForce force = gate_force(p, 2, trial);
    const GateRun run = run_gate(p, *by, start, force);
    const double x = run.exit.x - exact.mean_x, v = run.exit.vx - exact.mean_v;
    const double w = run.random_work - exact.mean_work;
    return {x, v, x * x, v * v, x * v, w, x * x * x * x, v * v * v * v, x * x * v * v, w * w};
  });
  const auto n = static_cast<double>(trials);
  const auto z = [&](double of, double squares, double expected) {
    const double mean = of / n;
    return std::abs(mean - expected) / std::sqrt((squares / n - mean * mean) / n);
  };
  char setting[64];
  std::snprintf(setting, sizeof setting, "%s (drag %g N s/m)", method.c_str(), drag);
  const auto said = [&](std::string_view what, double figure) {
    line({"free flight", setting, std::string(what), "standard errors", kStandardErrors}, figure,
         trials);
  };
  said("mean place", z(sum[0], sum[2], 0.0));
  said("mean velocity", z(sum[1], sum[3], 0.0));
  said("variance of place", z(sum[2], sum[6], exact.var_x));
  said("variance of velocity (diffusion)", z(sum[3], sum[7], exact.var_v));
  said("covariance of both", z(sum[4], sum[8], exact.cov));
  // Euler's steps give F^2 h^2 / 2M too little or too much work each. For these methods the missing
  // share is printed, which is of the order of step by hold.
  if (method == "paper" || method == "penalty")
    line({"free flight", setting, "share of the mean work of the random force missed", "-"},
         std::abs(sum[5] / n) / exact.mean_work, trials);
  else
    said("mean work of the random force", z(sum[5], sum[9], 0.0));
}

// ---- Order of convergence, through hits and held contacts ----

// Long enough for a beam to hold the body; in flights and at hits `event` and `stable` make no
// error at all. Later meetings with the beams amplify errors without bound.
constexpr double kSeconds = 4.0;

void order(const std::string& method, double first, double factor, int halvings, double least) {
  GateParams p = test::study(50.0);
  p.forces.random = 0.0;
  p.run.time_limit = kSeconds;
  std::vector<BodyState> starts, exact;
  for (int i = 0; i < 400; ++i) starts.push_back({-19.0 + 0.095 * i, 5.0, 0.3, 12.0});
  const auto ends = [&](const GateParams& q) {
    const auto by = make_method(q);
    std::vector<BodyState> all;
    for (const BodyState& start : starts) {
      RandomForce force = gate_force(q, 1, 0);
      all.push_back(run_gate(q, *by, start, force).exit);
    }
    return all;
  };
  GateParams reference = p;
  reference.run.method = "event";
  reference.run.event_tolerance = 1e-12;
  exact = ends(reference);
  p.run.method = method;
  std::vector<double> lengths, errors;
  for (int i = 0; i <= halvings; ++i) {
    (method == "event" ? p.run.event_tolerance : p.run.step) = first / std::pow(factor, i);
    const auto found = ends(p);
    double log_mean = 0.0;
    for (std::size_t k = 0; k < found.size(); ++k)
      log_mean += std::log(std::hypot(found[k].x - exact[k].x, found[k].y - exact[k].y) + 1e-15) /
                  static_cast<double>(found.size());
    lengths.push_back(-i * std::log(factor));
    errors.push_back(log_mean);
  }
  double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  const auto n = static_cast<double>(lengths.size());
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    x += lengths[i] / n, y += errors[i] / n;
    xx += lengths[i] * lengths[i] / n, xy += lengths[i] * errors[i] / n;
  }
  const double slope = (xy - x * y) / (xx - x * x);
  char setting[64];
  std::snprintf(setting, sizeof setting, "%s from %g to %g %s", method.c_str(), first,
                first / std::pow(factor, halvings), method == "event" ? "m" : "s");
  const auto cases = static_cast<std::int64_t>(starts.size() * lengths.size());
  line({"convergence", setting, "order of the error in place after 4 s", "-", least, true}, slope,
       cases);
  line({"convergence", setting, "geometric mean of that error at the finest", "m"},
       std::exp(errors.back()), cases);
}

// ---- The Lorentz gas: Santalo's mean chord, and the measure that passages keep ----

void lorentz_gas(double gap, std::int64_t passages) {
  constexpr int kBoxes = 8;
  const double a = 2.0 + gap;
  const std::array<lorentz::Point, 3> corners{lorentz::Point(0, 0), lorentz::Point(a, 0),
                                              lorentz::Point(a / 2.0, std::sqrt(3.0) / 2.0 * a)};
  constexpr std::size_t kAll = 3 * kBoxes * kBoxes;
  const auto sum = sums<kAll + 2>(passages, [&](std::int64_t passage) {
    Random random(Purpose::gate, {3, 0, static_cast<std::uint64_t>(passage)});
    Entry at{static_cast<int>(random.below(3)),
             {gap * (random.uniform() - 0.5), 2.0 * random.uniform() - 1.0}};
    const double stay = lorentz::cross(corners, at);
    std::array<double, kAll + 2> own{};
    const auto box = [](double share) {
      return std::clamp(static_cast<int>(kBoxes * share), 0, kBoxes - 1);
    };
    own[(at.face * kBoxes + box(at.at[0] / gap + 0.5)) * kBoxes + box(0.5 * at.at[1] + 0.5)] = 1.0;
    own[kAll] = stay;
    own[kAll + 1] = stay * stay;
    return own;
  });
  const auto n = static_cast<double>(passages);
  const double mean = sum[kAll] / n, error = std::sqrt((sum[kAll + 1] / n - mean * mean) / n);
  double squares = 0.0;
  for (std::size_t i = 0; i < kAll; ++i)
    squares += (sum[i] - n / kAll) * (sum[i] - n / kAll) / (n / kAll);
  const double freedom = kAll - 1;
  char setting[64];
  std::snprintf(setting, sizeof setting, "Lorentz gas (gap %g)", gap);
  line({"kinetic theory", setting, "mean stay less Santalo's pi A / P", "standard errors",
        kStandardErrors},
       std::abs(mean - test::mean_stay_in_triangle(gap)) / error, passages);
  line({"kinetic theory", setting, "invariant measure: chi^2 of exits in 192 boxes",
        "standard errors", kStandardErrors},
       std::abs(squares - freedom) / std::sqrt(2.0 * freedom), passages);
}

}  // namespace

int main(int count, char** words) {
  const std::int64_t trials = count > 1 ? std::atoll(words[1]) : 1'000'000;
  std::printf("law,by,what,figure,unit,limit,kept,cases\n");
  work_is_energy("event", 1e-2, 0.02, 1e-3, trials);
  work_is_energy("event", 1e-7, 0.02, 1e-8, trials / 10);
  work_is_energy("stable", 1e-2, 0.02, 1e-3, trials);
  work_is_energy("stable", 1e-2, 0.005, 1e-4, trials / 10);
  work_is_energy("moreau", 1e-2, 0.004, kNoLimit, trials / 10);
  for (const std::string_view method : method_names())
    if (method != "auto")
      for (const double drag : {0.0, 0.06}) free_flight(std::string(method), drag, trials);
  order("event", 1e-2, 10.0, 4, 0.9);
  order("stable", 0.005, 2.0, 5, 1.8);
  order("moreau", 0.001, 2.0, 5, 0.9);
  order("penalty", 0.004, 2.0, 5, kNoLimit);
  order("paper", 0.004, 2.0, 5, kNoLimit);
  for (const double gap : {0.05, 0.2, 0.3}) lorentz_gas(gap, 10 * trials);
  return all_kept ? 0 : 1;
}
