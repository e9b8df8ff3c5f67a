// SPDX-License-Identifier: MIT
/// Walks that circle, without limit of cells: what each solver takes, and how far it is from the
/// elimination without subtraction (direct).
///   circles_bench
/// prints lines "case,states,solver,seconds,off,bound": the least time of several on one thread,
/// the largest difference of an ending, and what the answer says that it is off at most.
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "markov/committor.h"
#include "markov/first_passage.h"
#include "markov/solvers.h"
#include "tests/markov/chains.h"

namespace {

using namespace gatewalk::markov;
using Solver = PredictOptions::Solver;

/// A chain of `states`, each of which leads to eight others and is trapped with probability
/// `leave`. If `moves`, states move to the right, left, ahead and back in turn; else walks circle
/// in one cell.
Chain circling(int states, double leave, bool moves) {
  test::Words words(3);
  std::vector<Exit> exits;
  for (int j = 0; j < states; ++j) {
    const int way = j % 4;
    const auto to = [&](int forth, int back) {
      return !moves ? 0 : way == forth ? 1 : way == back ? -1 : 0;
    };
    exits.push_back({j, to(0, 1), to(2, 3)});
  }
  exits.push_back({});
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < states; ++i) {
    for (int k = 0; k < 8; ++k) entries.emplace_back(i, words.below(states), (1.0 - leave) / 8.0);
    entries.emplace_back(i, states, leave);
  }
  Probabilities p(states, states + 1);
  p.setFromTriplets(entries.begin(), entries.end());
  return Chain::from_probabilities(p, exits);
}

/// The least time (s) of several runs.
double seconds(const std::function<void()>& run) {
  double least = INFINITY;
  for (double all = 0.0; all < 0.3;) {
    const auto begin = std::chrono::steady_clock::now();
    run();
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    least = std::min(least, took.count());
    all += took.count();
  }
  return least;
}

void predictions(const std::string& name, const Chain& chain, const Field& field) {
  const Start start{field.columns / 2, 0, 0};
  const FinalDistribution exact = *solve_directly(chain, field, start, 1e12);
  const std::pair<const char*, Solver> solvers[] = {{"direct", Solver::direct},
                                                    {"klu", Solver::klu},
                                                    {"steps", Solver::steps},
                                                    {"automatic", Solver::automatic}};
  for (const auto& [solver, how] : solvers) try {
      FinalDistribution d;
      const double took =
          seconds([&, how = how] { d = predict(chain, field, {start}, {.solver = how}).front(); });
      double off = 0.0;
      for (std::size_t e = 0; e < kEndings; ++e)
        off = std::max(off, std::abs(d.endings[e] - exact.endings[e]));
      std::printf("%s,%d,%s,%.3g,%.1e,%.1e\n", name.c_str(), chain.inputs(), solver, took, off,
                  d.remainder + d.rounding);
    } catch (const std::exception&) {
      std::printf("%s,%d,%s,refused,,\n", name.c_str(), chain.inputs(), solver);
    }
}

void committors(const std::string& name, const Chain& chain, const Field& field) {
  Committor swept;
  FirstPassages eliminated;
  const double sweeps = seconds([&] { swept = committor(chain, field); }),
               elimination = seconds([&] {
                 eliminated = first_passages(chain, field, {.ending = Ending::far_edge}, 0);
               });
  double off = 0.0;
  for (std::size_t i = 0; i < swept.values.size(); ++i)
    off = std::max(off, std::abs(swept.values[i] - eliminated.chance[i]));
  std::printf("%s,%d,committor,%.3g,%.1e,\n", name.c_str(), chain.inputs(), sweeps, off);
  std::printf("%s,%d,elimination,%.3g,0,\n", name.c_str(), chain.inputs(), elimination);
}

}  // namespace

int main() {
  std::puts("case,states,solver,seconds,off,bound");
  tbb::task_arena(1).execute([] {
    for (const auto& [trapped, leave] :
         {std::pair{"1e-2", 1e-2}, {"1e-4", 1e-4}, {"1e-8", 1e-8}, {"1e-12", 1e-12}})
      predictions(std::string("one cell; trapped ") + trapped, circling(60, leave, false), {1, 1});
    for (const int states : {200, 600, 1500})
      predictions("one cell; trapped 1e-4", circling(states, 1e-4, false), {1, 1});
    predictions("9 x 9 cells; trapped 1e-4", circling(20, 1e-4, true), {9, 9});
    const Chain down = Chain::from_counts(test::lattice_counts(3), test::lattice_exits());
    for (const Field field : {Field{3, 3}, Field{5, 4}, Field{9, 9}}) {
      const std::string size = std::to_string(field.columns) + " x " + std::to_string(field.rows);
      predictions(size + " cells with ways back", down, field);
      committors(size + " cells with ways back: committor", down, field);
    }
  });
}
