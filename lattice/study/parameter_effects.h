// SPDX-License-Identifier: MIT
#pragma once
/// The sensitivity of an ending's probability to the numbers of a scene.

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

/// The effect of one number.
struct ParameterEffect {
  std::string key;     // key of dynamics::Cell::Number
  double value = 0.0;  // NaN if types differ in it
  /// Per cent change of the probability per per cent of the value, in gates of all types: (P+ - P-)
  /// / (2 P step). The effect in each gate is taken to first order; effects in the gates along a
  /// way to the target multiply. The interval includes the sampling error of these gate runs and
  /// the error of the chain (by its groups). NaN if few runs dominate: one makes a tenth of the
  /// effect, a group has none, or more than one in twenty is left out.
  Mean95 elasticity;
  std::vector<Mean95> of_type;  // elasticity of gates of one type alone
  /// Elasticity to one side each, with more and with less of the number; NaN if the cell does not
  /// permit it.
  double more = 0.0, less = 0.0;
  bool bends = false;  // more and less differ significantly: no single number describes the effect
  /// Share of the places where bodies cannot enter the changed gate, or where runs broke.
  double left_out = 0.0;
};

/// How the numbers are changed.
struct ParameterOptions {
  std::int64_t runs = 20'000;   // gate runs on each side of a number, and as many for its interval
  double relative_step = 0.02;  // change of a number on each side
  std::uint64_t seed = 1;
};

/// The effects of all numbers on the target's probability.
struct ParameterEffects {
  double chance = 0.0;  // of the target, by this chain
  /// Of the numbers that can be changed; empty if the probability is 0.
  std::vector<ParameterEffect> effects;
  std::int64_t added_runs = 0;  // new runs in the pool
  std::int64_t pool_runs = 0;   // all runs in the pool
  dynamics::Health health;      // of the runs behind the effects
  double seconds = 0.0;
};

/// Runs gates at the places that bodies pass on their way to the target, with a little more and a
/// little less of each number under the same noise; the chain gives the probability of the target
/// afterwards. The chain's groups give the interval. Costs are not used.
[[nodiscard]] ParameterEffects parameter_effects(const Problem& problem, const AnalysedChain& chain,
                                                 markov::Ending target,
                                                 const ParameterOptions& options,
                                                 const dynamics::Work& work = {});

/// The effects by the chain of a pool, from its runs of the start. Full trials are added (about
/// `most_runs` new gate runs at most) until the chain has 25 times as many runs as the parameters,
/// so that its error does not exceed their sampling error. The number of states grows with the
/// square root of the runs. Throws as predict_pooled.
[[nodiscard]] ParameterEffects parameter_effects(const Problem& problem, RunPool& pool,
                                                 markov::Ending target,
                                                 const ParameterOptions& options,
                                                 int per_leaf = dynamics::kEntriesPerLeaf,
                                                 std::int64_t most_runs = 20'000'000,
                                                 const dynamics::Work& work = {});

}  // namespace gatewalk::lattice
