// SPDX-License-Identifier: MIT
#include "markov/predict/transient.h"

#include <algorithm>

#include "markov/predict/end_sums.h"

namespace gatewalk::markov {
namespace {

/// The number of the state to which an exit of a cell leads; -1 if the walk ends.
std::int64_t next_state(const FieldChain& field_chain, const Field& field, std::int64_t cell,
                        const Exit& exit) {
  if (exit.next_input == Exit::kTrapped) return -1;
  const std::int64_t next =
      neighbour_cell(field, cell % field.columns, cell / field.columns, exit.di_x, exit.di_y);
  const bool walks_on =
      next >= 0 &&
      field_chain.at(next % field.columns, next / field.columns).is_sampled(exit.next_input);
  return walks_on ? next * field_chain.inputs() + exit.next_input : -1;
}

}  // namespace

bool fits_pair_by_pair(const FieldChain& chain, const Field& field) {
  constexpr std::int64_t kMostPairs = 20'000'000;
  return std::int64_t{field.columns} * field.rows <= kMostPairs / std::max(1, chain.inputs());
}

Transient::Transient(const FieldChain& field_chain, const Field& field, const Start& start) {
  const std::int64_t n_in = field_chain.inputs();
  const std::int64_t cells = std::int64_t{field.columns} * field.rows;
  constexpr std::int64_t kUnknown = -1;
  std::vector<std::int64_t> number(static_cast<std::size_t>(cells * n_in), kUnknown);
  // The index of state t in the column under construction, if it is there.
  std::vector<std::int64_t> place;
  const auto visit = [&](std::int64_t state) {
    std::int64_t& known = number[static_cast<std::size_t>(state)];
    if (known == kUnknown) {
      known = static_cast<std::int64_t>(states.size());
      states.push_back(state);
      place.push_back(-1);
    }
    return known;
  };
  const auto add = [&](std::int64_t row, double share) {
    std::int64_t& at = place[static_cast<std::size_t>(row)];
    if (at < begin.back()) {
      at = static_cast<std::int64_t>(index.size());
      index.push_back(row);
      value.push_back(0.0);
    }
    value[static_cast<std::size_t>(at)] += share;
  };

  visit((std::int64_t{start.row} * field.columns + start.column) * n_in + start.input);
  for (std::size_t s = 0; s < states.size(); ++s) {
    const std::int64_t cell = states[s] / n_in;
    add(static_cast<std::int64_t>(s), 1.0);
    const Chain& chain = field_chain.at(cell % field.columns, cell / field.columns);
    double ending = 0.0;
    for (Probabilities::InnerIterator it(chain.matrix(), states[s] % n_in); it; ++it) {
      const std::int64_t next =
          next_state(field_chain, field, cell, chain.exits()[static_cast<std::size_t>(it.col())]);
      if (next < 0)
        ending += it.value();
      else
        add(visit(next), -it.value());
    }
    ends.push_back(ending);
    begin.push_back(static_cast<std::int64_t>(index.size()));
  }
}

FinalDistribution Transient::ended(const std::vector<double>& draws, const FieldChain& field_chain,
                                   const Field& field) const {
  EndSums all(field);
  CompensatedSum mean_steps;
  const std::int64_t n_in = field_chain.inputs();
  for (std::size_t s = 0; s < draws.size(); ++s) {
    mean_steps += draws[s];
    const std::int64_t cell = states[s] / n_in, column = cell % field.columns,
                       row = cell / field.columns;
    const Chain& chain = field_chain.at(column, row);
    for (Probabilities::InnerIterator it(chain.matrix(), states[s] % n_in); it; ++it) {
      const Exit& exit = chain.exits()[static_cast<std::size_t>(it.col())];
      const double mass = draws[s] * it.value();
      if (exit.next_input == Exit::kTrapped) {
        all.add(Ending::trapped, cell, mass);
        continue;
      }
      const std::int64_t next = neighbour_cell(field, column, row, exit.di_x, exit.di_y);
      if (next < 0)
        all.depart(cell, column + exit.di_x, row + exit.di_y, mass);
      else if (next_state(field_chain, field, cell, exit) < 0)
        all.add(Ending::unsampled, next, mass);
    }
  }
  FinalDistribution result = all.result();
  result.mean_steps = mean_steps.value();
  return result;
}

}  // namespace gatewalk::markov
