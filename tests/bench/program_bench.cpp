// SPDX-License-Identifier: MIT
/// program_bench COMMAND TRIALS THREADS IN_FLIGHT...: what a passage through a cell program costs,
/// by how many are under way at a time. Prints lines of CSV:
/// in_flight,passages,wall_us,own_cpu_us,its_cpu_us, a passage each. With tests/cells/echo.cpp,
/// which does nothing, that is what speaking to a program costs.

#include <sys/resource.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "cli/cells/program.h"

namespace {

using namespace gatewalk;

double cpu_seconds(int whose) {
  rusage used = {};
  getrusage(whose, &used);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(used.ru_utime) + seconds(used.ru_stime);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 5) return 2;
  const std::int64_t trials = std::atoll(argv[2]);
  const int threads = std::atoi(argv[3]);
  constexpr int kMostCells = 13;
  const tbb::global_control allow(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(threads));
  tbb::task_arena arena(threads);
  for (int k = 4; k < argc; ++k) {
    dynamics::Health health;
    const double own = cpu_seconds(RUSAGE_SELF), its = cpu_seconds(RUSAGE_CHILDREN);
    const auto begin = std::chrono::steady_clock::now();
    {
      const cli::ProgramCell cell(argv[1], {.in_flight = std::atoll(argv[k])});
      const std::size_t coordinates = cell.section().coordinates.size();
      arena.execute([&] {
        dynamics::carry_out_trials(
            cell, trials,
            [&](dynamics::Body& body) {
              body.random = dynamics::Random(dynamics::Purpose::field,
                                             {.trial = static_cast<std::uint64_t>(body.trial)});
              body.entry = {};
              // Numbers with all their digits; a velocity along the cells, if entries have one.
              for (std::size_t c = 0; c < coordinates; ++c)
                body.entry.at[c] = body.random.uniform() + (c == 2 ? 15.0 : 0.0);
              cell.begin(body);
            },
            [&](dynamics::Body& body, const dynamics::Passage& passage) {
              return passage.fate == dynamics::Fate::left && body.random.below(kMostCells) > 0;
            },
            health);
      });
    }
    const double wall =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    const double each = 1e6 / static_cast<double>(health.runs);
    std::printf("%s,%lld,%.3f,%.3f,%.3f\n", argv[k], static_cast<long long>(health.runs),
                each * wall, each * (cpu_seconds(RUSAGE_SELF) - own),
                each * (cpu_seconds(RUSAGE_CHILDREN) - its));
    std::fflush(stdout);
  }
}
