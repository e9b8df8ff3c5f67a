#include "dynamics/transitions.h"

#include <tbb/enumerable_thread_specific.h>

#include <stdexcept>

#include "dynamics/runs.h"

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
  tbb::enumerable_thread_specific<Health> health;  // sums and largest values: any order will do
  carry_out_trials(
      p, *method, static_cast<std::int64_t>(outcomes.size()),
      [&](RunSlot& slot) {
        const auto row = static_cast<int>(slot.trial / range.count);
        const Stream stream{seed, static_cast<std::uint64_t>(row),
                            static_cast<std::uint64_t>(range.first + slot.trial % range.count)};
        Random random(Purpose::row, stream);
        slot.start = entry_state(p, start_of(row, random));
        slot.force = RandomForce(p.forces, random);
      },
      [&](RunSlot& slot, const GateRun& run) {
        health.local().add(p, run);
        Outcome& out = outcomes[static_cast<std::size_t>(slot.trial)];
        if (run.ending == Ending::trapped) {
          out.column = t.space.trapped();
        } else if (run.ending != Ending::broken) {
          const auto index = t.space.index_of(crossing_of(p, run.ending, run.exit));
          out = {index.state, index.clamped};
        }
        return false;
      });

  for (const Health& part : health) t.health += part;
  for (int row = 0; row < t.space.size(); ++row) {
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
