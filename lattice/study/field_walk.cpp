// SPDX-License-Identifier: MIT
#include "lattice/study/field_walk.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>

namespace gatewalk::lattice {

using markov::Ending;

markov::FinalDistribution distribution_of(const Walked& walked, const FieldParams& field) {
  markov::FinalDistribution d;
  const std::int64_t cells = std::int64_t{field.columns} * field.rows;
  d.final_cells =
      Eigen::Map<const markov::CellProbabilities>(walked.ends.data(), field.rows, field.columns);
  for (std::size_t e = 0; e < markov::kEndings; ++e)
    d.endings[e] = walked.ends[cells + static_cast<Eigen::Index>(e)];
  d.mean_steps = walked.gates;
  d.remainder = walked.remainder;
  return d;
}

FieldWalk::FieldWalk(const FieldParams& field, const dynamics::StateSpace& space)
    : field_(field), space_(space) {
  constexpr std::int64_t kMostNumbers = 100'000'000;
  if (cells() * space.size() > kMostNumbers)
    throw std::invalid_argument("validate: " + std::to_string(cells()) + " cells times " +
                                std::to_string(space.size()) + " states are more than " +
                                std::to_string(kMostNumbers));
}

Walked FieldWalk::walk(const markov::FieldChain& chain, const std::vector<Entering>& entering,
                       const std::vector<double>& weights) const {
  const std::int64_t inputs = space_.size();
  const bool limited = field_.max_gates > 0;
  std::vector<std::size_t> order(entering.size());
  std::iota(order.begin(), order.end(), 0);
  if (limited)  // without a limit, the number of gates visited does not matter
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return entering[a].gates < entering[b].gates;
    });
  Walked walked{no_ends()};
  std::vector<double> here(static_cast<std::size_t>(cells() * inputs), 0.0), next(here);
  std::size_t begun = 0;
  constexpr int kMostSteps = 1'000'000;
  constexpr double kNobody = 1e-12;
  for (int step = 0; limited ? step < field_.max_gates : step < kMostSteps; ++step) {
    for (; begun < order.size() && (!limited || entering[order[begun]].gates == step); ++begun) {
      const Entering& e = entering[order[begun]];
      here[static_cast<std::size_t>(e.cell * inputs + space_.index_of(e.entry).state)] +=
          weights[order[begun]];
    }
    walked.remainder = 0.0;
    for (const double mass : here) walked.remainder += std::abs(mass);
    if (walked.remainder < kNobody && begun == order.size()) break;
    for (std::int64_t cell = 0; cell < cells(); ++cell) draw(chain, cell, step, here, next, walked);
    std::swap(here, next);
    std::fill(next.begin(), next.end(), 0.0);
    walked.remainder = 0.0;
  }
  return walked;
}

void FieldWalk::draw(const markov::FieldChain& chain, std::int64_t cell, int step,
                     const std::vector<double>& here, std::vector<double>& next,
                     Walked& walked) const {
  const std::int64_t inputs = space_.size();
  const std::int64_t column = cell % field_.columns, row = cell / field_.columns;
  const markov::Chain& of_cell = chain.at(column, row);
  for (std::int64_t input = 0; input < inputs; ++input) {
    const double mass = here[static_cast<std::size_t>(cell * inputs + input)];
    if (mass == 0.0) continue;
    walked.gates += mass;
    if (!of_cell.is_sampled(static_cast<int>(input))) {
      end(walked.ends, cell, Ending::unsampled, mass);
      continue;
    }
    for (markov::Probabilities::InnerIterator it(of_cell.matrix(), input); it; ++it) {
      const markov::Exit& exit = of_cell.exits()[static_cast<std::size_t>(it.col())];
      std::int64_t to_column = column, to_row = row;
      const auto ending = markov::follow({field_.columns, field_.rows}, exit,
                                         step + 1 == field_.max_gates, to_column, to_row);
      if (ending)
        end(walked.ends, cell, *ending, mass * it.value());
      else
        next[static_cast<std::size_t>((to_row * field_.columns + to_column) * inputs +
                                      exit.next_input)] += mass * it.value();
    }
  }
}

}  // namespace gatewalk::lattice
