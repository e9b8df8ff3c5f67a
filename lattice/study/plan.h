// SPDX-License-Identifier: MIT
#pragma once
/// What a body should do on its way: which of several actions to take in each cell, by how it
/// enters, so that it crosses the field as often as it can. An action is the field as it is while a
/// body takes it: other forces, stiffer joints, or cells of another kind.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/base/work.h"
#include "dynamics/cells/cell.h"
#include "dynamics/cells/state_space.h"
#include "dynamics/cells/tree_space.h"
#include "lattice/field/field_trials.h"
#include "lattice/field/problem.h"
#include "lattice/study/crossings.h"
#include "lattice/study/trials.h"
#include "markov/decide.h"

namespace gatewalk::lattice {

/// What a body may do. All have the same section, field, map and start, and cells of the same kinds
/// that differ in nothing that bodies carry with them, which is not checked: of discs, the body and
/// the gate's measures.
struct Action {
  std::string name;
  Problem problem;
};

/// All types of cells with all actions: number type * actions + action. Throws
/// std::invalid_argument unless the actions belong together, and for more than 256 of these.
[[nodiscard]] dynamics::CellField cells_of(const std::vector<Action>& actions);

/// An action for each cell and state, and where the field limits the cells for each number of cells
/// passed.
struct Policy {
  dynamics::StateSpace space;
  markov::Decisions decisions;
  std::optional<int> always{};  // one action everywhere: then there are no decisions

  /// Throws std::out_of_range for a place that it is not made for.
  [[nodiscard]] int action(const Place& place, const dynamics::Entry& entry) const;
};

/// Whether to give up some of the chance to cross for less of a cost.
struct ThriftOptions {
  std::size_t cost = 0;  // by Section::costs; more than 0 in the mean of each state's passages
  int points = 5;        // policies of the front at most, the plan's own among them
  /// More points where bodies cross so often; 0: all along the front.
  double chance = 0.0;
};

struct PlanOptions {
  double accuracy = 0.02;  // half of the widest interval that a chance to cross may have
  std::int64_t most_runs = 20'000'000;  // gate runs to choose by, about
  int per_leaf = dynamics::kEntriesPerLeaf;
  std::uint64_t seed = 1;
  std::optional<ThriftOptions> thrift{};
  /// Policies that are best where the mean of each row of the matrices is 1.96 standard errors
  /// worse than was counted, all rows at once (markov::Doubt); not with thrift.
  bool robust = false;
};

/// A policy that crosses less often and takes less. With a bound of the mean cost the best policy
/// is one of these, or one of two by chance (Altman 1999, Constrained Markov Decision Processes,
/// chapter 3).
struct FrontPoint {
  /// Of the policies that were found its chance to cross less so much for each unit of the cost is
  /// the largest; 0: the plan.
  double price = 0.0;
  Policy policy;
  Crossings crossings{};  // of the trials that judge the plan
  Spent spent{};          // by the same
};

struct Plan : ChoiceSummary {
  Policy policy;
  /// Chance to cross by the chain that it was chosen by, too good where that takes chance for
  /// skill; NaN where one action alone crossed oftest, and of robust policies.
  double chain_says = 0.0;
  /// Of robust policies: what that chain says in the worst case; of one action alone, what the
  /// chain of leaves of the middle size says. Each row is as bad as its runs leave possible for
  /// itself, so that it lies far below what is likely; but it knows only what rows have seen, and
  /// believes that a leaf's entries are alike, so that it may be too good too. The chance to cross
  /// is `crossings`.
  std::optional<double> worst_case{};
  /// New trials in full, none of which it was chosen by: of the policy, and of each action alone,
  /// under the same noise as far as bodies take the same ways.
  Crossings crossings{};
  std::vector<Crossings> alone{};
  std::vector<Gain> gains{};  // over each action alone
  /// The best that was found of policies that know the cell alone, which choose the same action
  /// however a body enters and how many it has passed: of what the chain finds and each action
  /// everywhere. How often it crosses in the same trials, and what the plan gains over it: what
  /// knowing the way in, and how many were passed, is worth. None where nothing crossed.
  struct ByCell {
    Policy policy;
    Crossings crossings{};
    Gain worth{};
    bool searched = false;  // in the chain, to the end: larger fields take too long
  };
  std::optional<ByCell> by_cell{};
  /// If asked for: from the plan to what takes least for each crossing, by price.
  std::vector<FrontPoint> front{};
  bool front_finished = false;  // nothing was found that takes less for each crossing than its end
  std::string front_refused{};  // why no more of it was looked for; mostly empty
  std::vector<double> usage{};  // (actions x cells) how often it is taken there, per trial
};

/// Trials in which bodies try all actions fill a matrix for each over common states. The best
/// policies for these (markov/decide.h), with leaves of three sizes, are carried out in full,
/// beside each action alone and the best so far, all with the same trials; these are added, and so
/// on until a round gains little or there are no more runs; one round there always is. Robust
/// policies are found for each size of leaves and chosen among in the same way, since small leaves
/// have few runs and large ones lump entries together, of which their sets know nothing. Where the
/// field does not limit the cells, bodies must not circle for ever. The same on any number of
/// threads. Throws std::invalid_argument as cells_of, for fewer than two actions, for an accuracy
/// outside [0.001, 0.5) and for robust policies that take less, and std::runtime_error when a run
/// broke, where decisions do not fit into memory, and as markov::decide.
[[nodiscard]] Plan make_plan(const std::vector<Action>& actions, const PlanOptions& options,
                             const dynamics::Work& work = {});

/// Trials through the field in which bodies do what the policy says; with the noise that
/// field_trials of these numbers have. Throws std::invalid_argument as cells_of, std::out_of_range
/// for a policy that is not made for these actions, their field or their start.
[[nodiscard]] FieldTally policy_trials(const std::vector<Action>& actions, const Policy& policy,
                                       dynamics::TrialRange trials, std::uint64_t seed,
                                       const dynamics::Work& work = {},
                                       const TakeTrials& take = {});

}  // namespace gatewalk::lattice
