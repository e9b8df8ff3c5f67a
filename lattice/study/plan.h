// SPDX-License-Identifier: MIT
#pragma once
/// Plans: which of several actions a body should take in each cell, depending on its entry, to
/// cross the field as often as possible. An action is the field while the body takes it: other
/// forces, stiffer joints, or cells of another kind.

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

/// An action of a body. All actions must have the same section, field, map and start, and cells of
/// the same kinds whose bodies carry the same memory, which is not checked. For discs: the same
/// body and gate size.
struct Action {
  std::string name;
  Problem problem;
};

/// All types of cells under all actions, numbered type * actions + action. Throws
/// std::invalid_argument if the actions do not belong together, and for more than 256 such cells.
[[nodiscard]] dynamics::CellField cells_of(const std::vector<Action>& actions);

/// An action for each cell and state and, if the field limits the cells, for each number of cells
/// passed.
struct Policy {
  dynamics::StateSpace space;
  markov::Decisions decisions;
  std::optional<int> always{};  // a single action everywhere; then there are no decisions

  /// The action of a body at `place` with this entry. Throws std::out_of_range for a place outside
  /// the policy.
  [[nodiscard]] int action(const Place& place, const dynamics::Entry& entry) const;
};

/// A trade of crossing probability against a cost.
struct ThriftOptions {
  std::size_t cost = 0;  // by Section::costs; its mean over each state's passages must be > 0
  int points = 5;        // most policies of the front, including the plan's own
  /// Finds more points near this crossing probability; 0: along the whole front.
  double chance = 0.0;
};

/// How a plan is searched.
struct PlanOptions {
  double accuracy = 0.02;               // half of the widest interval of a probability to cross
  std::int64_t most_runs = 20'000'000;  // gate runs to choose with, about
  int per_leaf = dynamics::kEntriesPerLeaf;
  std::uint64_t seed = 1;
  std::optional<ThriftOptions> thrift{};
  /// Searches policies that are best if the mean of every row of the matrices is 1.96 standard
  /// errors worse than counted, in all rows at once (markov::Doubt); not with thrift.
  bool robust = false;
};

/// A policy that crosses less often and costs less. Under a bound on the mean cost, the best policy
/// is one of these points, or a random mix of two (Altman 1999, Constrained Markov Decision
/// Processes, chapter 3).
struct FrontPoint {
  /// The policy maximises P(cross) - price * cost among those found; 0 for the plan itself.
  double price = 0.0;
  Policy policy;
  Crossings crossings{};  // of the held-out trials of the plan
  Spent spent{};          // of the held-out trials of the plan
};

/// The best policy found, and its comparison with simpler policies.
struct Plan : ChoiceSummary {
  Policy policy;
  /// Probability to cross by the chain that the policy was chosen with, which is too optimistic;
  /// NaN if a single action crossed most often, and for robust policies.
  double chain_says = 0.0;
  /// For robust policies: the worst-case probability by that chain; for a single action, by the
  /// chain with leaves of the middle size. Each row is as bad as its runs permit, so the value lies
  /// far below what is likely. It may still be too optimistic, because the chain knows only
  /// outcomes that were seen, and takes all entries of a leaf as alike. The probability to cross
  /// itself is in `crossings`.
  std::optional<double> worst_case{};
  /// Held-out trials, not used in the search: of the policy, and of each action alone, under the
  /// same noise as long as bodies take the same ways.
  Crossings crossings{};
  std::vector<Crossings> alone{};
  std::vector<Gain> gains{};  // over each action alone
  /// The best policy that depends on the cell only, not on a body's entry or its number of cells
  /// passed: the best of each action everywhere and of those that the chain finds. `worth`: the
  /// plan's gain over it in the same trials, which is the value of knowing entry and number.
  /// nullopt if nothing crossed.
  struct ByCell {
    Policy policy;
    Crossings crossings{};
    Gain worth{};
    bool searched = false;  // searched in the chain, to the end: larger fields take too long
  };
  std::optional<ByCell> by_cell{};
  /// If thrift is set: from the plan to the least cost per crossing, by price.
  std::vector<FrontPoint> front{};
  /// No policy was found with less cost per crossing than the last point.
  bool front_finished = false;
  std::string front_refused{};  // why the search for the front stopped early; usually empty
  std::vector<double> usage{};  // (actions x cells) uses of each action in each cell, per trial
};

/// Searches the best policy. Trials in which bodies try all actions give a matrix per action over
/// common states. The best policies for these matrices (markov/decide.h), with three leaf sizes,
/// run as full trials beside each action alone and the best so far, all with the same trial
/// numbers; these trials are added. Rounds (at least one) go on until one gains little or the runs
/// are used up. Robust policies are found for each leaf size and compared in the same way: small
/// leaves have few runs, large ones merge entries, which their uncertainty sets ignore. Without a
/// limit of cells, bodies must not circle for ever. The result is the same on any number of
/// threads. Throws std::invalid_argument as cells_of, for fewer than two actions, an accuracy
/// outside [0.001, 0.5), and robust policies with thrift; std::runtime_error if a run broke or
/// decisions do not fit into memory, and as markov::decide.
[[nodiscard]] Plan make_plan(const std::vector<Action>& actions, const PlanOptions& options,
                             const dynamics::Work& work = {});

/// Runs trials through the field in which bodies follow the policy; trials have the noise that
/// field_trials gives to their numbers. Throws std::invalid_argument as cells_of, std::out_of_range
/// for a policy that was not made for these actions, their field or their start.
[[nodiscard]] FieldTally policy_trials(const std::vector<Action>& actions, const Policy& policy,
                                       dynamics::TrialRange trials, std::uint64_t seed,
                                       const dynamics::Work& work = {},
                                       const TakeTrials& take = {});

}  // namespace gatewalk::lattice
