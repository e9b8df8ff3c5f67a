// SPDX-License-Identifier: MIT
#include "dynamics/cells/transitions.h"

#include <algorithm>
#include <stdexcept>

namespace gatewalk::dynamics {

Transitions::Transitions(StateSpace state_space)
    : space(std::move(state_space)),
      rows(space.size()),
      costs(space.size()),
      trials(space.size(), 0),
      clamped(space.size(), 0) {}

Eigen::SparseMatrix<std::int64_t, Eigen::RowMajor> Transitions::counts() const {
  std::vector<Eigen::Triplet<std::int64_t>> entries;
  for (int row = 0; row < space.size(); ++row)
    for (const auto& [column, n] : rows[row]) entries.emplace_back(row, column, n);
  Eigen::SparseMatrix<std::int64_t, Eigen::RowMajor> m(space.size(), space.size() + 1);
  m.setFromTriplets(entries.begin(), entries.end());
  return m;
}

Transitions::Totals Transitions::totals() const {
  Totals total;
  for (int row = 0; row < space.size(); ++row) {
    const auto stuck = rows[row].find(space.trapped());
    total.runs += trials[row];
    total.crossings += trials[row] - (stuck == rows[row].end() ? 0 : stuck->second);
    total.clamped += clamped[row];
    total.nonzeros += static_cast<std::int64_t>(rows[row].size());
    total.empty_rows += trials[row] == 0;
  }
  return total;
}

Transitions::Totals& Transitions::Totals::operator+=(const Totals& o) {
  runs += o.runs;
  crossings += o.crossings;
  clamped += o.clamped;
  nonzeros += o.nonzeros;
  empty_rows += o.empty_rows;
  return *this;
}

Transitions& Transitions::operator+=(const Transitions& o) {
  if (!(space == o.space))
    throw std::invalid_argument("transitions of two different state spaces cannot be added");
  for (int row = 0; row < space.size(); ++row) {
    for (const auto& [column, n] : o.rows[row]) rows[row][column] += n;
    for (const auto& [column, sums] : o.costs[row]) costs[row][column] += sums;
    trials[row] += o.trials[row];
    clamped[row] += o.clamped[row];
  }
  health += o.health;
  return *this;
}

Entries entries_of(const StateSpace& space, const std::vector<Entry>& seen) {
  Entries entries(space.size());
  for (const Entry& c : seen) entries[space.index_of(c).state].push_back(c);
  return entries;
}

std::int64_t runs_per_trial(const StateSpace& space, int row) {
  const std::int64_t bins = space.size() - static_cast<std::int64_t>(space.points().size());
  return row < bins ? 1 : std::max<std::int64_t>(1, bins / 10);
}

std::int64_t runs_per_trial(const StateSpace& space) {
  std::int64_t runs = 0;
  for (int row = 0; row < space.size(); ++row) runs += runs_per_trial(space, row);
  return runs;
}

}  // namespace gatewalk::dynamics
