// SPDX-License-Identifier: MIT
#include "lattice/statistics/gates_ahead.h"

#include <tbb/parallel_for.h>

#include <Eigen/Core>
#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "dynamics/base/random.h"
#include "markov/dense.h"
#include "markov/quasi_stationary.h"

namespace gatewalk::lattice {
namespace {

using Table = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
/// Second word of the streams of Purpose::memory; tests of independence have small numbers.
constexpr std::uint64_t kDealStream = 1u << 20;

/// The outcomes of all runs, sorted by state: the state entered, kTrapped, or, for the last run of
/// a walk that was stopped, -2 minus the state entered.
struct OutcomeSeen {
  static constexpr std::int32_t kTrapped = StateWalks::kTrapped;
  std::vector<std::int32_t> all;    // (runs)
  std::vector<std::int64_t> first;  // (states + 1)

  static bool stops(std::int32_t outcome) { return outcome < kTrapped; }
  static std::int32_t entered(std::int32_t outcome) {
    return stops(outcome) ? -2 - outcome : outcome;
  }

  explicit OutcomeSeen(const StateWalks& w) : all(w.state.size()), first(w.way.size() + 1) {
    for (const std::int32_t s : w.state) ++first[static_cast<std::size_t>(s) + 1];
    std::partial_sum(first.begin(), first.end(), first.begin());
    std::vector<std::int64_t> at = first;
    for (std::int64_t walk = 0; walk < w.walks(); ++walk)
      for (std::int64_t i = w.begin(walk); i < w.passed[walk]; ++i) {
        const std::int32_t next = w.next[i];
        const bool stopped = i + 1 == w.passed[walk] && next != kTrapped;
        all[at[w.state[i]]++] = stopped ? -2 - next : next;
      }
  }
  [[nodiscard]] std::int64_t runs(std::size_t state) const {
    return first[state + 1] - first[state];
  }
};

/// For 0, 1, ... `most` gates ahead, the predicted shares of walks from each state by way (states x
/// ways + 1). A state without runs continues as the states entered in the same way do, or as all
/// states if there are none.
std::vector<Table> powers(const StateWalks& w, const OutcomeSeen& outcomes, int most) {
  const auto states = static_cast<Eigen::Index>(w.way.size());
  std::vector<Table> ahead{Table::Zero(states, w.ways + 1)};
  for (Eigen::Index s = 0; s < states; ++s) ahead[0](s, w.way[s]) = 1.0;
  for (int k = 1; k <= most; ++k) {
    const Table& before = ahead.back();
    Table table = Table::Zero(states, w.ways + 1), of_way = Table::Zero(w.ways + 1, w.ways + 1);
    Eigen::VectorXd runs_of_way = Eigen::VectorXd::Zero(w.ways + 1);  // last row: all ways together
    for (Eigen::Index s = 0; s < states; ++s) {
      const auto n = static_cast<double>(outcomes.runs(s));
      if (n == 0.0) continue;
      for (auto i = outcomes.first[s]; i < outcomes.first[s + 1]; ++i) {
        const std::int32_t to = OutcomeSeen::entered(outcomes.all[i]);
        if (to == OutcomeSeen::kTrapped)
          table(s, w.ways) += 1.0;
        else
          table.row(s) += before.row(to);
      }
      for (const int group : {w.way[s], w.ways}) {
        of_way.row(group) += table.row(s);
        runs_of_way[group] += n;
      }
      table.row(s) /= n;
    }
    for (Eigen::Index s = 0; s < states; ++s) {
      if (outcomes.runs(s) > 0) continue;
      const int group = runs_of_way[w.way[s]] > 0.0 ? w.way[s] : w.ways;
      table.row(s) = of_way.row(group) / runs_of_way[group];
    }
    ahead.push_back(std::move(table));
  }
  return ahead;
}

/// Counts of runs by the way now and where their walks are later: by gates ahead (0 to most), (ways
/// x ways + 1).
using Counts = std::vector<Table>;

class Seen {
 public:
  Seen(const StateWalks& w, const std::vector<Table>& ahead)
      : w_(w),
        ahead_(ahead),
        most_(static_cast<int>(ahead.size()) - 1),
        counts_(ahead.size(), Table::Zero(w.ways, w.ways + 1)) {}

  /// Adds a walk through these states, all of whose runs count; `last`: outcome of its last run.
  void add(const std::vector<std::int32_t>& states, std::int32_t last) {
    const auto length = static_cast<int>(states.size());
    for (int at = 0; at < length; ++at)
      for (int k = 0; k <= std::min(at, most_); ++k)
        counts_[k](w_.way[states[at - k]], w_.way[states[at]]) += 1.0;
    const std::int32_t end = OutcomeSeen::entered(last);
    // The i-th last run reaches the end in i gates.
    for (int i = 1; i <= std::min(length, most_); ++i)
      for (int k = i; k <= most_; ++k) {
        const std::int32_t from = w_.way[states[length - i]];
        if (end == OutcomeSeen::kTrapped)
          counts_[k](from, w_.ways) += 1.0;
        else
          counts_[k].row(from) += ahead_[k - i].row(end);
      }
  }
  [[nodiscard]] const Counts& counts() const { return counts_; }

 private:
  const StateWalks& w_;
  const std::vector<Table>& ahead_;
  int most_;
  Counts counts_;
};

/// What the kernel's powers predict for `runs` in each state.
Counts predicted(const StateWalks& w, const std::vector<Table>& ahead,
                 const std::vector<std::int64_t>& runs) {
  Counts counts(ahead.size(), Table::Zero(w.ways, w.ways + 1));
  for (std::size_t s = 0; s < runs.size(); ++s)
    for (std::size_t k = 0; runs[s] > 0 && k < ahead.size(); ++k)
      counts[k].row(w.way[s]) +=
          static_cast<double>(runs[s]) * ahead[k].row(static_cast<Eigen::Index>(s));
  return counts;
}

/// Differences as shares of all runs.
Counts excess(Counts seen, const Counts& predicted, const std::vector<std::int64_t>& runs) {
  const double all =
      static_cast<double>(std::accumulate(runs.begin(), runs.end(), std::int64_t{0}));
  for (std::size_t k = 0; k < seen.size(); ++k) seen[k] = (seen[k] - predicted[k]) / all;
  return seen;
}

/// One draw of the null: walks from the same first states, with every state's outcomes permuted.
/// Returns seen minus predicted, as shares of the runs. Runs in circles that no walk reaches are
/// left out.
Counts dealt_excess(const StateWalks& w, const std::vector<Table>& ahead, OutcomeSeen outcomes,
                    dynamics::Random random) {
  for (std::size_t s = 0; s < w.way.size(); ++s)
    for (auto i = outcomes.first[s]; i + 1 < outcomes.first[s + 1]; ++i)
      std::swap(outcomes.all[i], outcomes.all[i + random.below(outcomes.first[s + 1] - i)]);
  std::vector<std::int64_t> at(outcomes.first.begin(), outcomes.first.end() - 1);
  Seen seen(w, ahead);
  std::vector<std::int32_t> states;
  for (std::int64_t walk = 0; walk < w.walks(); ++walk) {
    states.assign(1, w.state[w.begin(walk)]);
    std::int32_t outcome = outcomes.all[at[states.back()]++];
    while (outcome >= 0) {
      states.push_back(outcome);
      outcome = outcomes.all[at[outcome]++];
    }
    seen.add(states, outcome);
  }
  std::vector<std::int64_t> runs;
  for (std::size_t s = 0; s < w.way.size(); ++s) runs.push_back(at[s] - outcomes.first[s]);
  return excess(seen.counts(), predicted(w, ahead, runs), runs);
}

/// Total variation of a table of differences.
double half_sum(const Table& excess) { return 0.5 * excess.cwiseAbs().sum(); }

/// Implied time scales of a table of shares (ways x ways + 1), the longest first.
std::vector<double> time_scales(const Table& shares, int gates) {
  Eigen::MatrixXd kernel = shares.leftCols(shares.rows());
  for (Eigen::Index way = 0; way < shares.rows(); ++way)
    if (const double all = shares.row(way).sum(); all > 0.0) kernel.row(way) /= all;
  std::vector<double> scales;
  for (const double modulus : markov::eigenvalue_moduli(kernel))
    scales.push_back(gates * markov::implied_time_scale(modulus));
  return scales;
}

/// The middle 95 % of the values.
std::array<double, 2> middle_95(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto rim = static_cast<std::size_t>(0.025 * static_cast<double>(values.size()));
  return {values[rim], values[values.size() - 1 - rim]};
}

/// The step of `gates` gates, with its null distribution; `null`: the excess of every draw.
GatesAhead::Step step_of(int gates, const Table& seen, const Table& predicted,
                         const std::vector<Counts>& null) {
  GatesAhead::Step step;
  step.gates = gates;
  step.seen.assign(seen.data(), seen.data() + seen.size());
  step.predicted.assign(predicted.data(), predicted.data() + predicted.size());
  std::vector<double> distances, values(null.size());
  for (const Counts& n : null) distances.push_back(half_sum(n[gates]));
  std::tie(step.chance, step.chance_95) = mean_and_95(distances);
  for (std::size_t c = 0; c < step.seen.size(); ++c) {
    for (std::size_t k = 0; k < null.size(); ++k) values[k] = null[k][gates].data()[c];
    const auto [low, high] = middle_95(values);
    const double excess = step.seen[c] - step.predicted[c];
    step.excess_95.push_back({excess - high, excess - low});
  }
  step.seen_scales = time_scales(seen, gates);
  step.predicted_scales = time_scales(predicted, gates);
  std::vector<std::vector<double>> drawn(step.seen_scales.size());  // by scale
  for (const Counts& n : null) {
    const std::vector<double> scales = time_scales(predicted + n[gates], gates);
    for (std::size_t k = 0; k < drawn.size(); ++k) drawn[k].push_back(scales[k]);
  }
  for (const std::vector<double>& of_scale : drawn) step.scales_95.push_back(middle_95(of_scale));
  return step;
}

}  // namespace

void StateWalks::add(std::span<const std::int32_t> states, std::int32_t end) {
  if (states.empty()) return;
  state.insert(state.end(), states.begin(), states.end());
  next.insert(next.end(), states.begin() + 1, states.end());
  next.push_back(end);
  passed.push_back(std::ssize(state));
}

void StateWalks::validate() const {
  const auto refuse = [](const char* what) {
    throw std::invalid_argument(std::string("walks: ") + what);
  };
  const auto states = std::ssize(way);
  if (state.size() != next.size() || (passed.empty() ? 0 : passed.back()) != std::ssize(state))
    refuse("states, outcomes and walks differ in number");
  for (const std::int32_t x : way)
    if (x < 0 || x >= ways) refuse("a state is entered by no such way");
  for (std::int64_t walk = 0; walk < walks(); ++walk) {
    if (passed[walk] <= begin(walk)) refuse("a walk without a run");
    for (std::int64_t i = begin(walk); i < passed[walk]; ++i) {
      if (state[i] < 0 || state[i] >= states || next[i] < kTrapped || next[i] >= states)
        refuse("no such state");
      if (i + 1 < passed[walk] && next[i] != state[i + 1])
        refuse("a run does not begin where the one before it ended");
    }
  }
}

const GatesAhead::Step& GatesAhead::largest() const {
  return *std::max_element(steps.begin(), steps.end(), [](const Step& a, const Step& b) {
    return a.total_variation.seen - a.chance_95 < b.total_variation.seen - b.chance_95;
  });
}

GatesAhead gates_ahead(const StateWalks& walks, int most, std::int64_t null_draws,
                       std::uint64_t seed) {
  walks.validate();
  if (most < 2 || most > kMostGatesAhead)
    throw std::invalid_argument("gates ahead: from 2 to " + std::to_string(kMostGatesAhead));
  if (walks.walks() == 0) throw std::invalid_argument("gates ahead: no walks");
  if (null_draws < 1) throw std::invalid_argument("gates ahead: null_draws must be at least 1");
  const OutcomeSeen outcomes(walks);
  const std::vector<Table> ahead = powers(walks, outcomes, most);
  Seen seen(walks, ahead);
  for (std::int64_t walk = 0; walk < walks.walks(); ++walk) {
    const auto from = walks.state.begin() + walks.begin(walk),
               to = walks.state.begin() + walks.passed[walk];
    seen.add({from, to}, walks.next[walks.passed[walk] - 1] == StateWalks::kTrapped
                             ? StateWalks::kTrapped
                             : -2 - walks.next[walks.passed[walk] - 1]);
  }
  std::vector<Counts> null(static_cast<std::size_t>(null_draws));
  tbb::parallel_for(std::size_t{0}, null.size(), [&](std::size_t k) {
    null[k] = dealt_excess(walks, ahead, outcomes,
                           dynamics::Random(dynamics::Purpose::memory, {seed, kDealStream, k}));
  });

  GatesAhead result;
  result.runs = std::ssize(walks.state);
  result.null_draws = null_draws;
  std::vector<std::int64_t> runs;
  for (std::size_t s = 0; s < walks.way.size(); ++s) runs.push_back(outcomes.runs(s));
  const Counts expected = predicted(walks, ahead, runs);
  const auto all = static_cast<double>(result.runs);
  std::vector<double> distances;  // (draws + 1 x steps)
  for (const Counts& n : null)
    for (int k = 2; k <= most; ++k) distances.push_back(half_sum(n[k]));
  for (int k = 2; k <= most; ++k) {
    const Table shares = seen.counts()[k] / all, powers_say = expected[k] / all;
    distances.push_back(half_sum(shares - powers_say));
    result.steps.push_back(step_of(k, shares, powers_say, null));
  }
  const MultipleTests judged(distances, result.steps.size());
  for (std::size_t i = 0; i < result.steps.size(); ++i)
    result.steps[i].total_variation = judged.tests[i];
  result.p = judged.p;
  return result;
}

}  // namespace gatewalk::lattice
