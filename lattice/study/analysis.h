// SPDX-License-Identifier: MIT
#pragma once
/// What a chain says beyond the final gates: how long bodies take and what work, how likely each
/// start is to end in one way, which ways there lead, and what would change that most.

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

struct AnalysisOptions {
  markov::Ending target = markov::Ending::far_edge;  // what starts, paths and trapping are of
  std::int64_t timed_walks = 100'000;
  std::size_t paths = 5;
  LumpingParts lumping{};
  std::uint64_t seed = 1;
};

/// The chance of the target from one of the ways to enter the first cell by the start's face; NaN
/// where no run did. In a field that is its own mirror image the mean with that of the image, by
/// ranges that two states have in common. The interval: sampling, and what smaller states would
/// change.
struct StartChance {
  dynamics::StateRange range;
  Mean95 chance;
  std::int64_t runs = 0;  // of its state, and of the image's
};
/// So many starts have intervals, those entered most; more of them nobody reads.
inline constexpr std::ptrdiff_t kToldStarts = 300;

struct Analysis {
  markov::Ending target{};
  double target_chance = 0.0;
  /// By this chain nobody ends so, or everybody but for rounding: its runs cannot tell what a
  /// little more or less of a number would change.
  [[nodiscard]] bool is_certain() const {
    constexpr double kRounding = 1e-9;
    return !(target_chance > 0.0 && target_chance < 1.0 - kRounding);
  }
  bool by_groups = false;       // of trials, which make the intervals; none of bins
  markov::WalkTotals totals{};  // quantities by Section::costs
  /// Gates visited, and what bodies took, of all of them. Intervals: sampling, and what smaller
  /// states would change; none without groups, nor from few runs that end so (mean_95).
  /// Why visits, gates, times and costs are no numbers: the sums were stopped with walks under way.
  /// Empty where they are.
  [[nodiscard]] std::string why_unfinished() const;
  Mean95OfRuns gates{};
  std::vector<Mean95OfRuns> costs{};                                   // by Section::costs
  std::array<std::vector<Mean95OfRuns>, markov::kEndings> costs_of{};  // by ending
  std::vector<markov::TimedWalk> walks{};                              // seconds
  std::optional<markov::QuasiStationary> endless{};                    // none: see below
  std::string why_not_endless{};
  std::vector<double> endless_boundaries{};  // its states by face
  /// All of them; if they are more than kToldStarts, those that have intervals come first.
  std::vector<StartChance> starts{};
  [[nodiscard]] std::ptrdiff_t told_starts() const {
    return std::min(std::ssize(starts), kToldStarts);
  }
  markov::FrequentPaths paths{};
  /// (rows x columns) visits of bodies that end in the target, per body of these; and per cent that
  /// the chance of the target would grow were one per cent fewer trapped in the gate (d ln P / d
  /// -ln of the share trapped, the others going on as the rest does). Of the target "trapped", and
  /// of one that nobody ends in, the latter is empty.
  markov::CellProbabilities passed{}, trapping{};
  std::vector<double>
      state_trapping{};  // the latter by shown_number of states, in all gates together
  std::vector<double> type_trapping{};  // and by type of cell
  struct Type {
    double visits = 0.0, trapped = 0.0;  // expected, of a body
  };
  std::vector<Type> types{};   // of cells
  dynamics::StateSpace space;  // of the chain
  LumpingParts lumping{};
  std::optional<LumpedChain> lumped{};  // none where it cannot be made
  double seconds = 0.0;
};

/// Of how many states an analysis of this field, with groups, takes some 8 GiB.
[[nodiscard]] double most_analysed_states(const Problem& problem);
/// Entries of a leaf for a chain that can be analysed: `per_leaf`, which makes so many states of
/// the pool's runs, or more where these are too many.
[[nodiscard]] int leaf_of_analysis(const Problem& problem, const RunPool& pool, int per_leaf,
                                   int states);
/// Throws std::invalid_argument for more states than most_analysed_states.
[[nodiscard]] Analysis analyze(const Problem& problem, const AnalysedChain& chain,
                               const AnalysisOptions& options, const dynamics::Work& work = {});

}  // namespace gatewalk::lattice
