// SPDX-License-Identifier: MIT
#include "dynamics/disc/row_trials.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <stdexcept>

#include "dynamics/disc/disc_section.h"
#include "dynamics/disc/runs.h"

namespace gatewalk::dynamics {

RowTrials row_trials(const StateSpace& space, const GateParams& p, std::uint64_t seed,
                     TrialRange range, const Entries& entries) {
  if (!entries.empty() && std::ssize(entries) != space.size())
    throw std::invalid_argument("row_trials: entries are not those of the state space");
  const auto start_of = [&](int row, Random& random) {
    if (entries.empty() || entries[row].empty()) return space.sample(row, random);
    return entries[row][random.below(static_cast<std::int64_t>(entries[row].size()))];
  };
  const auto method = make_method(p);
  std::vector<std::int64_t> first_run{0};  // first run of each row, among all runs
  for (int row = 0; row < space.size(); ++row)
    first_run.push_back(first_run.back() + range.count * runs_per_trial(space, row));
  const auto row_of = [&](std::int64_t run) {
    return static_cast<int>(std::upper_bound(first_run.begin(), first_run.end(), run) -
                            first_run.begin()) -
           1;
  };
  RowTrials all{.trials = range.count,
                .arrivals = std::vector<Arrival>(static_cast<std::size_t>(first_run.back())),
                .health = {}};
  tbb::enumerable_thread_specific<Health> health;  // the order does not matter
  carry_out_trials(
      p, *method, std::ssize(all.arrivals),
      [&](RunSlot& slot) {
        const int row = row_of(slot.trial);
        const std::int64_t run =
            range.first * runs_per_trial(space, row) + slot.trial - first_run[row];
        const Stream stream{seed, static_cast<std::uint64_t>(row), static_cast<std::uint64_t>(run)};
        Random random(Purpose::row, stream);
        slot.start = entry_state(p, start_of(row, random));
        slot.force = RandomForce(p.forces, random);
      },
      [&](RunSlot& slot, const GateRun& run) {
        add_run(health.local(), p, run);
        Arrival& out = all.arrivals[static_cast<std::size_t>(slot.trial)];
        if (run.outcome == Outcome::trapped) {
          out.column = space.trapped();
        } else if (run.outcome != Outcome::broken) {
          const auto index = space.index_of(crossing_of(p, run.outcome, run.exit));
          out.column = index.state;
          out.clamped = index.clamped;
        }
        out.costs = costs_of(run);
        return false;
      });

  for (const Health& part : health) all.health += part;
  return all;
}

void add(Transitions& t, const RowTrials& trials) {
  const std::int64_t arrivals = std::ssize(trials.arrivals), each = runs_per_trial(t.space);
  const bool fit =
      each > 0 ? arrivals % each == 0 && trials.trials == arrivals / each : arrivals == 0;
  if (!fit || std::any_of(trials.arrivals.begin(), trials.arrivals.end(), [&](const Arrival& a) {
        return a.column < -1 || a.column > t.space.size() || a.clamped < 0 || a.clamped > 1;
      }))
    throw std::runtime_error("a kept piece has trials of other states");
  t.health += trials.health;
  auto next = trials.arrivals.begin();
  for (int row = 0; row < t.space.size(); ++row) {
    const auto end = next + trials.trials * runs_per_trial(t.space, row);
    for (; next != end; ++next) {
      if (next->column < 0) continue;
      ++t.rows[row][next->column];
      t.costs[row][next->column].add(next->costs);
      ++t.trials[row];
      t.clamped[row] += next->clamped;
    }
  }
}

void add_trials(Transitions& t, const GateParams& p, std::uint64_t seed, TrialRange range,
                const Entries& entries) {
  add(t, row_trials(t.space, p, seed, range, entries));
}

}  // namespace gatewalk::dynamics
