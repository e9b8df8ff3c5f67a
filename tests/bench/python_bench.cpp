// SPDX-License-Identifier: MIT
/// What Python's functions call, timed in C++; tests/bench/python_bench.py runs it.
///   python_bench predict MATRIX.nc TIMES   milliseconds of the library's prediction from runs and
///                                          matrices in memory, and of the command's whole: a line
///                                          "library,command" each time
///   python_bench pillars CELLS.toml TRIALS passages, microseconds each, share that crosses
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "cli/commands.h"
#include "cli/fields/json_value.h"
#include "dynamics/cells/cell.h"
#include "lattice/field/field_trials.h"
#include "lattice/pool/predict_pooled.h"
#include "lattice/pool/tree_chain.h"
#include "lattice/recorded/recorded_pool.h"
#include "lattice/scene/cell_file.h"
#include "lattice/scene/scene_problem.h"
#include "lattice/source/source.h"
#include "lattice/source/source_file.h"

namespace {

using namespace gatewalk;

/// CPU time (ms).
template <class F>
double milliseconds(const F& f) {
  const std::clock_t begin = std::clock();
  f();
  return 1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

void predict(const std::string& path, int times) {
  const auto source = std::make_shared<lattice::SourceFile>(path);
  source->keep_in_memory();
  const lattice::Problem problem = lattice::problem_of(source->own_scene());
  const auto by_library = [&] {
    lattice::RunPool pool = *source->runs();
    lattice::AccuracyOptions how;
    how.accuracy = 0.5;  // no new runs
    (void)lattice::predict_pooled(problem, pool, {problem.start}, how);
  };
  const auto by_command = [&] {
    cli::Arguments arguments{path, "--quiet", "--json=-"};
    arguments.files = {source};
    arguments.given_out = [](const cli::Description& describe) { (void)cli::json_of(describe); };
    arguments.work = dynamics::Work{};
    (void)cli::run_predict(arguments);
  };
  for (int k = 0; k < times; ++k)
    std::printf("%.4f,%.4f\n", milliseconds(by_library), milliseconds(by_command));
}

/// scenes/programs/pillars.py with a time limit of 200 steps.
class Pillars : public dynamics::Cell {
 public:
  explicit Pillars(dynamics::Section section) : section_(std::move(section)) {}
  [[nodiscard]] const dynamics::Section& section() const override { return section_; }
  [[nodiscard]] bool is_symmetric() const override { return true; }
  [[nodiscard]] dynamics::Passage pass(dynamics::Body& body) const override {
    constexpr double kRadius = 0.3, kTurning = 0.7, kStep = 0.02, kHalf = 0.5;
    constexpr int kSteps = 200;
    enum Face { kSouth, kNorth, kWest, kEast };
    const double s = body.entry.at[0], v = body.entry.at[1],
                 into = std::sqrt(std::max(1.0 - v * v, 0.0));
    const int face = body.entry.face;
    const double sign = face == kSouth || face == kWest ? 1.0 : -1.0;
    const bool along_y = face == kSouth || face == kNorth;
    double x = along_y ? s : -sign * kHalf, y = along_y ? -sign * kHalf : s;
    double vx = along_y ? v : sign * into, vy = along_y ? sign * into : v;
    const double turning = kTurning * std::sqrt(kStep);
    dynamics::Passage passage;
    for (int k = 0; k < kSteps; ++k) {
      const double to_x = vx != 0.0 ? (std::copysign(kHalf, vx) - x) / vx : kStep,
                   to_y = vy != 0.0 ? (std::copysign(kHalf, vy) - y) / vy : kStep,
                   to_edge = std::min(to_x, to_y);
      if (to_edge < kStep) {
        passage.fate = dynamics::Fate::left;
        passage.costs[0] = k * kStep + std::max(to_edge, 0.0);
        const bool by_y = to_y < to_x;
        const int out = by_y ? (vy > 0.0 ? kSouth : kNorth) : (vx > 0.0 ? kWest : kEast);
        passage.next = {out, {by_y ? x + to_edge * vx : y + to_edge * vy, by_y ? vx : vy}};
        body.entry = passage.next;
        return passage;
      }
      const double angle = std::atan2(vy, vx) + turning * body.random.normal();
      x += kStep * vx;
      y += kStep * vy;
      vx = std::cos(angle);
      vy = std::sin(angle);
      const double rr = x * x + y * y, closing = (x * vx + y * vy) / rr;
      if (rr < kRadius * kRadius && closing < 0.0) {
        vx -= 2.0 * closing * x;
        vy -= 2.0 * closing * y;
      }
    }
    passage.fate = dynamics::Fate::trapped;
    passage.costs[0] = kSteps * kStep;
    return passage;
  }

 private:
  dynamics::Section section_;
};

void pillars(const std::string& path, std::int64_t trials) {
  const lattice::CellFile file = lattice::read_cell_file(path);
  lattice::Problem problem = lattice::problem_of(file, {});
  problem.cells.cells = {std::make_shared<const Pillars>(problem.map().section)};
  problem.start = *file.start;
  lattice::FieldTally tally(problem.field);
  const double ms = milliseconds([&] {
    tally = lattice::run_field(problem.cells, problem.field, problem.start, 1, {0, trials});
  });
  std::printf(
      "%lld,%.4f,%.4f\n", static_cast<long long>(tally.health.runs),
      1e3 * ms / static_cast<double>(tally.health.runs),
      static_cast<double>(tally.endings[static_cast<std::size_t>(markov::Ending::far_edge)]) /
          static_cast<double>(trials));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  const tbb::global_control allow(tbb::global_control::max_allowed_parallelism, 1);
  if (std::string_view(argv[1]) == "predict")
    predict(argv[2], std::atoi(argv[3]));
  else
    pillars(argv[2], std::atoll(argv[3]));
}
