// SPDX-License-Identifier: MIT
// Is the order of agents found whose memory is known? They walk through square cells of one kind
// and turn left, right, back or go straight, by chances that depend on their last turns.
//   order_bench EFFECT FIRST AGENTS     a line for each agent and order from 0 to 3, on standard
//                                       output: order,effect,seed,found,best
// By the earliest turn that an agent needs, the chances of two turns change by EFFECT, after half
// of all turns in between. Each agent has 50 bodies with 200 passages each. See
// results/order/README.md.
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <string>
#include <vector>

#include "dynamics/base/random.h"
#include "lattice/recorded/recorded_pool.h"
#include "lattice/scene/cell_file.h"
#include "lattice/study/order.h"

using namespace gatewalk;
using dynamics::Purpose;
using dynamics::Random;

namespace {

constexpr int kTurns = 4, kBodies = 50, kPassages = 200, kMost = 3;
constexpr const char* kCells = R"(
cell = { width_m = 0.1, length_m = 0.1, symmetric = false, faces = [
  { name = "S", move = [0, 1] }, { name = "E", move = [-1, 0] },
  { name = "N", move = [0, -1] }, { name = "W", move = [1, 0] }
], coordinates = [{ name = "s", unit = "m", scale = 0.1 }] }
field = { columns = 9, rows = 9, max_gates = 20 }
)";

using Chances = std::array<double, kTurns>;

/// Chances of the next turn by the number of the last turns: the latest one counts least.
std::vector<Chances> law(int order, double effect, Random& random) {
  std::size_t contexts = 1;  // by all turns but the earliest
  for (int k = 1; k < order; ++k) contexts *= kTurns;
  std::vector<std::size_t> shuffled(contexts);
  std::iota(shuffled.begin(), shuffled.end(), 0);
  for (std::size_t i = contexts; i > 1; --i)
    std::swap(shuffled[i - 1],
              shuffled[static_cast<std::size_t>(random.below(static_cast<std::int64_t>(i)))]);
  std::vector<Chances> all(order == 0 ? 1 : contexts * kTurns);
  for (std::size_t i = 0; i < contexts; ++i) {
    Chances base;
    double sum = 0.0;
    for (double& chance : base) sum += chance = 0.5 + random.uniform();
    for (double& chance : base) chance = 0.1 + 0.6 * chance / sum;  // 0.1 to 0.4
    const auto first = static_cast<std::size_t>(random.below(kTurns)),
               second = (first + 1 + static_cast<std::size_t>(random.below(kTurns - 1))) % kTurns;
    // Both turns together keep their chance, which is at least the effect.
    const double both = std::max(base[first] + base[second], effect + 0.04),
                 times = (1.0 - both) / (1.0 - base[first] - base[second]);
    for (std::size_t t = 0; t < kTurns; ++t)
      if (t != first && t != second) base[t] *= times;
    base[first] = base[second] = 0.5 * both;
    const bool depends = order > 0 && (i + 1) * 2 <= contexts + 1;
    for (std::size_t earliest = 0; earliest < (order == 0 ? 1 : kTurns); ++earliest) {
      Chances chances = base;
      const double change = !depends ? 0.0 : (earliest % 2 == 0 ? 0.5 : -0.5) * effect;
      chances[first] += change;
      chances[second] -= change;
      all[order == 0 ? 0 : earliest * contexts + shuffled[i]] = chances;
    }
  }
  return all;
}

lattice::RunPool agents(const lattice::CellFile& cells, int order, double effect,
                        std::uint64_t seed) {
  Random of_law(Purpose::terrain, {seed, static_cast<std::uint64_t>(order), 0});
  const std::vector<Chances> chances = law(order, effect, of_law);
  lattice::RecordedRuns runs;
  runs.passages.begin(cells.map.section);
  for (std::int32_t body = 0; body < kBodies; ++body) {
    Random random(Purpose::field,
                  {seed, static_cast<std::uint64_t>(order), static_cast<std::uint64_t>(body)});
    runs.bodies.push_back(std::to_string(body));
    runs.trials.push_back({{0, {}}, body, std::ssize(runs.passages), kPassages});
    int face = 0;
    std::size_t last = 0;
    for (int k = 0; k < kPassages; ++k) {
      const double u = random.uniform();
      std::size_t turn = 0;
      for (double sum = chances[last][0]; u > sum && turn + 1 < kTurns; sum += chances[last][turn])
        ++turn;
      face = (face + static_cast<int>(turn)) % kTurns;
      last = (last * kTurns + turn) % chances.size();
      runs.passages.push_back({dynamics::Fate::left, 0, {face, {}}, {}});
    }
  }
  return lattice::pool_of(std::move(runs));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fputs("order_bench EFFECT FIRST AGENTS\n", stderr);
    return 2;
  }
  const double effect = std::atof(argv[1]);
  const std::uint64_t first = std::strtoull(argv[2], nullptr, 10);
  const std::uint64_t count = std::strtoull(argv[3], nullptr, 10);
  const lattice::CellFile cells = lattice::parse_cell_file(kCells, "cells");
  for (std::uint64_t seed = first; seed < first + count; ++seed)
    for (int order = 0; order <= kMost; ++order) {
      const lattice::RunPool pool = agents(cells, order, effect, seed);
      const lattice::OrderStudy study =
          lattice::study_order(lattice::problem_of(cells, pool), pool,
                               {.least = 0, .most = kMost + 1, .seed = seed, .with_halves = false});
      std::printf("%d,%g,%llu,%d,%d\n", order, effect, static_cast<unsigned long long>(seed),
                  study.answer().order, study.orders[study.best].order);
      std::fflush(stdout);
    }
  return 0;
}
