// SPDX-License-Identifier: MIT
#pragma once
/// A figure that a test measured for a requirement, with the requirement's limit. The figure goes
/// into the test's entry of --gtest_output=json, from which results/requirements/run.sh makes its
/// table.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/near_singular.h"

namespace gatewalk::test {

struct Figure {
  int requirement = 0;
  std::string_view method;  // "contact" for what all methods share
  std::string_view what;    // equal words from several tests give one line of the table
  double figure = std::numeric_limits<double>::quiet_NaN();  // the worst value; NaN meets no limit
  std::string_view unit = "-";
  /// The limit of the requirement; NaN: only the figure is asked for.
  double limit = std::numeric_limits<double>::quiet_NaN();
  bool at_least = false;              // the limit is a minimum, not a maximum
  std::int64_t cases = 1, asked = 1;  // number of cases tested, and asked for by the requirement
};

/// Records a figure; not from within parallel loops. Texts must not contain quotation marks or
/// backslashes.
inline void measured(const Figure& f) {
  const auto number = [](double x) {
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", x);
    return std::isfinite(x) ? std::string(text) : std::string("null");
  };
  const bool within = f.at_least ? f.figure >= f.limit : f.figure <= f.limit;
  const auto quoted = [](std::string_view s) { return '"' + std::string(s) + '"'; };
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  // Each record has its own key, because a second record under one key replaces the first.
  testing::Test::RecordProperty(
      "figure_" + std::to_string(test->result()->test_property_count()),
      "{\"requirement\":" + std::to_string(f.requirement) + ",\"method\":" + quoted(f.method) +
          ",\"what\":" + quoted(f.what) + ",\"figure\":" + number(f.figure) +
          ",\"unit\":" + quoted(f.unit) + ",\"limit\":" + number(f.limit) +
          ",\"at_least\":" + (f.at_least ? "true" : "false") + ",\"within\":" +
          (std::isnan(f.limit) ? "null"
           : within            ? "true"
                               : "false") +
          ",\"cases\":" + std::to_string(f.cases) + ",\"asked\":" + std::to_string(f.asked) + "}");
}

/// The symmetric double hit: speeds of the disc (m/s) and of both beams (rad/s) after it.
inline void measured_double_hit(std::string_view method, double vy, double left, double right) {
  const double error =
      std::max({std::abs(vy - 10.78125), std::abs(left - 1.51875), std::abs(right - 1.51875)});
  measured({.requirement = 7,
            .method = method,
            .what = "symmetric double hit, error of speeds",
            .figure = error,
            .unit = "m/s, rad/s",
            .limit = 1e-12});
  measured({.requirement = 7,
            .method = method,
            .what = "left beam's speed less the right's",
            .figure = std::abs(left - right),
            .unit = "rad/s",
            .limit = 1e-13});
}

/// Contacts that are held: the worst gap (radii) and the worst pull (N) of `held` checks.
inline void measured_held(std::string_view method, double gap, double pull, std::int64_t held) {
  measured({.requirement = 6,
            .method = method,
            .what = "gap of held contacts",
            .figure = gap,
            .unit = "R",
            .limit = 1e-9,
            .cases = held});
  measured({.requirement = 6,
            .method = method,
            .what = "pull of held contacts",
            .figure = pull,
            .unit = "N",
            .limit = 1e-12,
            .cases = held});
}

/// Mirrored trials have the same bits. To be called after the comparison, which stops at the first
/// trial that differs.
inline void measured_mirror(std::string_view method, std::int64_t trials, std::int64_t asked) {
  measured({.requirement = 8,
            .method = method,
            .what = "mirrored trials with other bits",
            .figure = testing::Test::HasFailure() ? 1.0 : 0.0,
            .unit = "trials",
            .limit = 0.0,
            .cases = trials,
            .asked = asked});
}

/// Near-singular starts give no NaN and no penetration; called for each of five kinds of starts.
inline void measured_trouble(std::string_view method, const dynamics::GateParams& p,
                             const std::vector<Trouble>& seen) {
  int not_finite = 0;
  double overlap = 0.0;
  for (const Trouble& t : seen) {
    not_finite += t.not_finite > 0;
    overlap = std::max(overlap, t.overlap);
  }
  const auto n = static_cast<std::int64_t>(seen.size());
  measured({.requirement = 11,
            .method = method,
            .what = "near-singular starts that end in NaN",
            .figure = static_cast<double>(not_finite),
            .unit = "starts",
            .limit = 0.0,
            .cases = n,
            .asked = 200'000});
  measured({.requirement = 11,
            .method = method,
            .what = "penetration from near-singular starts",
            .figure = overlap / p.body.radius,
            .unit = "R",
            .limit = 1e-6,
            .cases = n,
            .asked = 200'000});
}

/// Random scenes end without NaN and do not hang; also the longest time of one of them.
struct AnyScenes {
  int scenes, refused, broken, escaped, hung;
  double slowest;  // s of CPU
};
inline void measured_scenes(std::string_view method, const AnyScenes& s) {
  const auto count = [&](std::string_view what, int n, double limit) {
    measured({.requirement = 12,
              .method = method,
              .what = what,
              .figure = static_cast<double>(n),
              .unit = "scenes",
              .limit = limit,
              .cases = s.scenes,
              .asked = 100'000});
  };
  const double none = std::numeric_limits<double>::quiet_NaN();
  count("random scenes with a NaN that the result does not own to", s.escaped, 0.0);
  count("random scenes that hang", s.hung, 0.0);
  count("random scenes that end as broken and say so", s.broken, none);
  count("random scenes refused by name", s.refused, none);
  measured({.requirement = 4,
            .method = method,
            .what = "slowest scene, CPU time",
            .figure = s.slowest,
            .unit = "s",
            .limit = 10.0,
            .cases = s.scenes});
}

/// CPU seconds of this thread, independent of the machine's other work.
inline double thread_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace gatewalk::test
