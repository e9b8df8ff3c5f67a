// SPDX-License-Identifier: MIT
#include "markov/paths.h"

#include <algorithm>
#include <map>
#include <queue>
#include <utility>

namespace gatewalk::markov {
namespace {

/// A step of a path. Paths share their common beginnings.
struct Step {
  std::int64_t cell;
  std::int64_t before;  // index of the previous step; -1: none
};

/// The cells of a path from the start to its last step.
std::vector<std::int64_t> cells_of(const std::vector<Step>& steps, std::int64_t last) {
  std::vector<std::int64_t> cells;
  for (; last >= 0; last = steps[static_cast<std::size_t>(last)].before)
    cells.push_back(steps[static_cast<std::size_t>(last)].cell);
  std::reverse(cells.begin(), cells.end());
  return cells;
}

/// A complete path, or the beginning of one with the states that its walks have in the last cell.
struct Beginning {
  // Upper bound of the share of any continuation; the share of a complete path.
  double at_most = 0.0;
  std::int64_t last = 0;                       // index of the last step
  int length = 1;                              // number of cells
  std::vector<std::pair<int, double>> states;  // {input, share}; empty: the path is complete
  friend bool operator<(const Beginning& a, const Beginning& b) { return a.at_most < b.at_most; }
};

}  // namespace

FrequentPaths most_frequent_paths(const FieldChain& chain, const Field& field, const Start& start,
                                  int max_cells, const EndingChance& chance, std::size_t count,
                                  std::int64_t most_draws) {
  validate(chain, field, start, max_cells);
  const std::int64_t first = std::int64_t{start.row} * field.columns + start.column;
  std::priority_queue<Beginning> open;
  std::vector<Step> steps{{first, -1}};
  open.push({chance(1, first, start.input), 0, 1, {{start.input, 1.0}}});
  FrequentPaths found;
  for (std::int64_t draws = 0; !open.empty() && found.paths.size() < count;) {
    if (draws > most_draws) {
      found.gave_up = true;
      break;
    }
    const Beginning b = open.top();
    open.pop();
    if (!(b.at_most > 0.0)) break;
    if (b.states.empty()) {
      found.paths.push_back({cells_of(steps, b.last), b.at_most});
      continue;
    }
    const std::int64_t cell = steps[static_cast<std::size_t>(b.last)].cell,
                       column = cell % field.columns, row = cell / field.columns;
    const int draw = b.length;
    const Chain& here = chain.at(column, row);
    double ends = 0.0;
    std::map<std::int64_t, std::map<int, double>> onward;  // by cell and input
    for (const auto& [input, share] : b.states) {
      if (!here.is_sampled(input) && chance.ending() == Ending::unsampled) ends += share;
      for (Probabilities::InnerIterator it(here.matrix(), input); it; ++it, ++draws) {
        const Exit& exit = here.exits()[static_cast<std::size_t>(it.col())];
        std::int64_t to_column = column, to_row = row;
        const double p = share * it.value();
        if (const auto ending = follow(field, exit, draw == max_cells, to_column, to_row))
          ends += *ending == chance.ending() ? p : 0.0;
        else
          onward[to_row * field.columns + to_column][exit.next_input] += p;
      }
    }
    if (ends > 0.0) open.push({ends, b.last, draw, {}});
    for (const auto& [to, states] : onward) {
      Beginning next{0.0, std::ssize(steps), draw + 1, {states.begin(), states.end()}};
      steps.push_back({to, b.last});
      for (const auto& [input, share] : next.states)
        next.at_most += share * chance(draw + 1, to, input);
      if (next.at_most > 0.0) open.push(std::move(next));
    }
  }
  return found;
}

}  // namespace gatewalk::markov
