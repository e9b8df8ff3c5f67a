// SPDX-License-Identifier: MIT
#pragma once
/// How the chance of an ending answers to the numbers of a scene.

#include <cstdint>
#include <string>
#include <vector>

#include "dynamics/base/work.h"
#include "dynamics/cells/health.h"
#include "lattice/field/problem.h"
#include "lattice/pool/chain_with_rewards.h"
#include "lattice/pool/reactive_visits.h"
#include "lattice/statistics/group_spread.h"

namespace gatewalk::lattice {

struct ParameterEffect {
  std::string key;     // dynamics::Cell::Number's
  double value = 0.0;  // NaN where types differ in it
  /// Per cent that the chance changes for one per cent of the value in gates of all types: (P+ -
  /// P-) / (2 P step). What the number does at each gate is taken to first order; over the gates of
  /// a way to the target these changes multiply. The interval counts chance in these gate runs and
  /// the chain's own error: of its groups. None where few runs make it: one of them a tenth of it,
  /// none in one of the groups, or more than one in twenty left out.
  Mean95 elasticity;
  std::vector<Mean95> of_type;    // the same, in gates of one type alone
  double more = 0.0, less = 0.0;  // the same to one side each, with more and with less of the
                                  // number; NaN where the cell does not permit it
  bool bends = false;             // these differ by more than chance: no single number says it
  /// Share of the places where bodies cannot enter a gate that is changed so, or where runs broke.
  double left_out = 0.0;
};

struct ParameterOptions {
  std::int64_t runs = 20'000;   // gate runs to each side of a number, and as many for its interval
  double relative_step = 0.02;  // of the number, to each side
  std::uint64_t seed = 1;
};

struct ParameterEffects {
  double chance = 0.0;                   // of the target, by this chain
  std::vector<ParameterEffect> effects;  // of the numbers that can be changed; none where the
                                         // chance is zero
  std::int64_t added_runs = 0;           // to the pool
  std::int64_t pool_runs = 0;            // in it then
  dynamics::Health health;               // of the runs behind them
  double seconds = 0.0;
};

/// In the places that bodies pass on their way to the target: gate runs with a little more and a
/// little less of each number under the same noise, and what the chain says of where they lead. The
/// same with each of the chain's groups, for the interval. What runs take is not used.
[[nodiscard]] ParameterEffects parameter_effects(const Problem& problem, const AnalysedChain& chain,
                                                 markov::Ending target,
                                                 const ParameterOptions& options,
                                                 const dynamics::Work& work = {});

/// The same of the chain of a pool, from its runs of the start. So that the chain's error
/// is no more than chance makes in the runs for parameters, full trials are added until it has 25
/// times as many, `most_runs` new gate runs at most, about; its states grow with the square root of
/// that. Throws as predict_pooled.
[[nodiscard]] ParameterEffects parameter_effects(const Problem& problem, RunPool& pool,
                                                 markov::Ending target,
                                                 const ParameterOptions& options,
                                                 int per_leaf = dynamics::kEntriesPerLeaf,
                                                 std::int64_t most_runs = 20'000'000,
                                                 const dynamics::Work& work = {});

}  // namespace gatewalk::lattice
