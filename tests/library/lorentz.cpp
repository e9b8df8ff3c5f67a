// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <memory>
#include <string>

#include "dynamics/cells/check_cell.h"
#include "lattice/lattice.h"
#include "lorentz_cell.h"

using namespace gatewalk;

// lorentz GAP: where points of a Lorentz gas leave a field of 3 x 3 cells, by a chain with error
// bars, and by trials through the field.
int main(int, char** words) try {
  const auto gas = std::make_shared<lorentz::LorentzCell>(std::stod(words[1]));
  const auto cell = std::make_shared<dynamics::FunctionCell>(
      gas->section(), [gas](dynamics::Body& body) {  // gives the points kicks in each gap
        double& v = body.entry.at[1];
        v = std::clamp(v + 0.3 * body.random.normal(), -0.99, 0.99);
        return gas->pass(body);
      });
  lattice::Problem problem;
  problem.cells = dynamics::CellField::uniform(cell);
  problem.field = {.columns = 3, .rows = 3, .max_gates = 0};
  problem.start = {0, {0.01, 0.3}};
  for (const std::string& wrong : dynamics::check_cell(*cell, {problem.start})) {
    std::puts(wrong.c_str());
    return 1;
  }
  lattice::Source source = lattice::Source::of(problem);
  source.accuracy = {.accuracy = 0.05};
  const lattice::PooledPrediction prediction = lattice::predict(source);
  const auto trials =
      lattice::run_field(problem.cells, problem.field, problem.start, 2, {0, 20'000});
  const lattice::StartAnswer& answer = prediction.starts.front();
  bool fine = prediction.reached && prediction.health.clean();
  for (const auto& [ending, key, name] : lattice::kAllEndingNames) {
    const auto e = static_cast<std::size_t>(ending);
    const double seen = static_cast<double>(trials[ending]) / static_cast<double>(trials.trials),
                 chance = 2.0 * std::sqrt(seen * (1.0 - seen) / 20'000.0);
    const auto [low, high] = answer.endings.interval[e];
    std::printf("%s [%.4f, %.4f], trials %.4f\n", name, low, high, seen);
    fine = fine && low - chance <= seen && seen <= high + chance;
  }
  return fine ? 0 : 1;
} catch (const std::exception& e) {
  std::fprintf(stderr, "lorentz: %s\n", e.what());
  return 1;
}
