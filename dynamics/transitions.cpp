#include "dynamics/transitions.h"

#include <tbb/parallel_for.h>

#include <stdexcept>

namespace gatewalk::dynamics {

Transitions::Transitions(StateSpace state_space)
    : space(std::move(state_space)),
      rows(space.size()),
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

Transitions& Transitions::operator+=(const Transitions& o) {
  if (!(space == o.space))
    throw std::invalid_argument("transitions of two different state spaces cannot be added");
  for (int row = 0; row < space.size(); ++row) {
    for (const auto& [column, n] : o.rows[row]) rows[row][column] += n;
    trials[row] += o.trials[row];
    clamped[row] += o.clamped[row];
  }
  health += o.health;
  return *this;
}

Entries entries_of(const StateSpace& space, const std::vector<Crossing>& seen) {
  Entries entries(space.size());
  for (const Crossing& c : seen) entries[space.index_of(c).state].push_back(c);
  return entries;
}

void add_trials(Transitions& t, const GateParams& p, std::uint64_t seed, TrialRange range,
                const Entries& entries) {
  if (!entries.empty() && entries.size() != t.rows.size())
    throw std::invalid_argument("add_trials: entries are not those of the state space");
  const auto start_of = [&](int row, Random& random) {
    if (entries.empty() || entries[row].empty()) return t.space.sample(row, random);
    return entries[row][random.below(static_cast<std::int64_t>(entries[row].size()))];
  };
  const auto method = make_method(p);
  struct Outcome {
    int column = -1;
    bool clamped = false;
  };
  std::vector<Outcome> outcomes(static_cast<std::size_t>(t.space.size()) * range.count);
  std::vector<Health> health(t.space.size());

  tbb::parallel_for(0, t.space.size(), [&](int row) {
    for (std::int64_t i = 0; i < range.count; ++i) {
      const Stream stream{seed, static_cast<std::uint64_t>(row),
                          static_cast<std::uint64_t>(range.first + i)};
      Random random(Purpose::row, stream);
      const BodyState start = entry_state(p, start_of(row, random));
      RandomForce force(p.forces, random);
      const GateRun run = run_gate(p, *method, start, force);
      health[row].add(p, run);
      Outcome& out = outcomes[row * range.count + i];
      if (run.ending == Ending::broken) continue;
      if (run.ending == Ending::trapped) {
        out.column = t.space.trapped();
        continue;
      }
      const auto index = t.space.index_of(crossing_of(p, run.ending, run.exit));
      out = {index.state, index.clamped};
    }
  });

  for (int row = 0; row < t.space.size(); ++row) {
    t.health += health[row];
    for (std::int64_t i = 0; i < range.count; ++i) {
      const Outcome& out = outcomes[row * range.count + i];
      if (out.column < 0) continue;
      ++t.rows[row][out.column];
      ++t.trials[row];
      t.clamped[row] += out.clamped;
    }
  }
}

}  // namespace gatewalk::dynamics
