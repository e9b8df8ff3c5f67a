// SPDX-License-Identifier: MIT
#pragma once
/// What a chain tells beyond the final gates: durations and costs, the probability of an ending
/// from each start, the paths that lead there, and the gates whose trapping matters most.

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/base/work.h"
#include "lattice/field/problem.h"
#include "lattice/pool/chain_with_rewards.h"
#include "lattice/pool/lumped_chain.h"
#include "lattice/statistics/group_spread.h"
#include "markov/paths.h"
#include "markov/quasi_stationary.h"
#include "markov/totals.h"

namespace gatewalk::lattice {

/// What an analysis is asked for.
struct AnalysisOptions {
  /// The ending that starts, paths and trapping refer to.
  markov::Ending target = markov::Ending::far_edge;
  std::int64_t timed_walks = 100'000;
  std::size_t paths = 5;
  LumpingParts lumping{};
  std::uint64_t seed = 1;
  /// Shares of all bodies by ending, if they are predicted from smaller states (pool_answers.h)
  /// than those of the chain.
  std::optional<std::array<double, markov::kEndings>> endings{};
};

/// The probability of the target from one way of entering the first cell by the start's face; NaN
/// if no run entered so. In a field that is its own mirror image: the mean with the mirror image's
/// probability, for each overlap of two states. The interval includes sampling error and the bias
/// of coarser states.
struct StartChance {
  dynamics::StateRange range;
  Mean95 chance;
  std::int64_t runs = 0;  // of its state, and of the mirror image's
};
/// Number of starts with intervals: those with most entries.
inline constexpr std::ptrdiff_t kToldStarts = 300;

/// The results of an analysis.
struct Analysis {
  markov::Ending target{};
  double target_chance = 0.0;
  /// True if the chain gives the target a probability of 0 or, within rounding, 1. Its runs then
  /// cannot tell what a small change of a number would do.
  [[nodiscard]] bool is_certain() const {
    constexpr double kRounding = 1e-9;
    return !(target_chance > 0.0 && target_chance < 1.0 - kRounding);
  }
  /// Shares of all bodies by ending: AnalysisOptions::endings, or else the chain's.
  std::array<double, markov::kEndings> endings{};
  bool by_groups = false;       // intervals come from groups of the trials; none for bins
  markov::WalkTotals totals{};  // quantities by Section::costs
  /// The reason why visits, gates, times and costs are NaN: their sums were stopped with walks
  /// under way. Empty if they are known.
  [[nodiscard]] std::string why_unfinished() const;
  /// Mean number of gates visited, and mean costs, of all bodies. Intervals include sampling error
  /// and the bias of coarser states; none without groups, or if few runs end so (mean_95).
  Mean95OfRuns gates{};
  std::vector<Mean95OfRuns> costs{};                                   // by Section::costs
  std::array<std::vector<Mean95OfRuns>, markov::kEndings> costs_of{};  // by ending
  std::vector<markov::TimedWalk> walks{};                              // times in s
  std::optional<markov::QuasiStationary> endless{};  // nullopt: see why_not_endless
  std::string why_not_endless{};
  std::vector<double> endless_boundaries{};  // share of its states by face
  /// By start. If there are more than kToldStarts, those with intervals come first.
  std::vector<StartChance> starts{};
  [[nodiscard]] std::ptrdiff_t told_starts() const {
    return std::min(std::ssize(starts), kToldStarts);
  }
  markov::FrequentPaths paths{};
  /// (rows x columns) `passed`: visits of bodies that end in the target, per such body. `trapping`:
  /// by how many per cent the target's probability grows if one per cent fewer bodies are trapped
  /// in the gate: d ln P / d -ln(share trapped), with the others continuing as the rest does. Empty
  /// for the target "trapped", and for a target of probability 0.
  markov::CellProbabilities passed{}, trapping{};
  std::vector<double> state_trapping{};  // `trapping` by shown_number of states, over all gates
  std::vector<double> type_trapping{};   // `trapping` by type of cell
  struct Type {
    double visits = 0.0, trapped = 0.0;  // expected numbers per body
  };
  std::vector<Type> types{};   // by type of cell
  dynamics::StateSpace space;  // of the chain
  LumpingParts lumping{};
  std::optional<LumpedChain> lumped{};  // nullopt if it cannot be computed
  double seconds = 0.0;
};

/// Number of states for which an analysis of this field, with groups, takes about 8 GiB.
[[nodiscard]] double most_analysed_states(const Problem& problem);
/// Entries per leaf for a chain that can be analysed: `per_leaf`, which gives `states` states from
/// the pool's runs, or more if these are too many.
[[nodiscard]] int leaf_of_analysis(const Problem& problem, const RunPool& pool, int per_leaf,
                                   int states);
/// Analyses a chain. Throws std::invalid_argument for more states than most_analysed_states.
[[nodiscard]] Analysis analyze(const Problem& problem, const AnalysedChain& chain,
                               const AnalysisOptions& options, const dynamics::Work& work = {});

}  // namespace gatewalk::lattice
