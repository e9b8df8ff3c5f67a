#pragma once
/// What a chain says beyond the final gates: how long bodies take and what work, how likely each
/// start is to end in one way, which ways there lead, and what would change that most.

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dynamics/random.h"
#include "dynamics/work.h"
#include "lattice/run_pool.h"
#include "lattice/scene/scene.h"
#include "markov/committor.h"
#include "markov/paths.h"
#include "markov/quasi_stationary.h"
#include "markov/totals.h"

namespace gatewalk::lattice {

/// A field's chain from one start, with what its draws take: the quantities are those of
/// dynamics::kCostNames.
struct CostedChain {
  markov::FieldChain chain;
  markov::Rewards rewards;
  markov::Start start;
};
/// From the runs of one group of the trials, and that group's first runs from `start`, whose row is
/// the last one.
[[nodiscard]] CostedChain costed_chain(const Kernel& kernel, const FieldGates& gates,
                                       const FieldParams& field, const RunPool& pool,
                                       const StartTrials& start, TrialGroup group = {});

/// What is analysed.
struct AnalysedChain {
  CostedChain chain;
  dynamics::StateSpace space;  // of its states; of trees without the start, whose row follows
  std::vector<CostedChain> groups{};  // kTrialGroups, of groups of the trials; or none
  /// An entry into a gate that belongs to the state, drawn: of those seen, in gates of any type; of
  /// bins anywhere in the bin.
  std::function<dynamics::Crossing(int state, dynamics::Random& random)> entry;
};
/// Of trees, from the pool's runs; with error bars. Throws std::invalid_argument when the pool has
/// no runs of `start`.
[[nodiscard]] AnalysedChain analysed_chain(const Scene& scene, const RunPool& pool,
                                           const dynamics::Crossing& start,
                                           int per_leaf = dynamics::kEntriesPerLeaf);
/// Of matrices, one for each of gates_of(scene).types(). What runs took is not a number where they
/// do not know it.
[[nodiscard]] AnalysedChain analysed_chain(const Scene& scene,
                                           const std::vector<dynamics::Transitions>& matrices,
                                           const markov::Start& start);

struct AnalysisOptions {
  markov::Ending target = markov::Ending::far_edge;  // what starts, paths and influences are of
  std::int64_t timed_walks = 100'000;
  std::size_t paths = 5;
  std::int64_t runs = 20'000;   // gate runs to each side of a scene parameter; 0: none
  double relative_step = 0.05;  // of the number, to each side
  std::uint64_t seed = 1;
};

/// A mean with its 95 % interval: sampling, and what smaller states would change; not a number
/// without groups.
struct Mean95 {
  double mean = 0.0;
  std::array<double, 2> interval{};
};

/// How the chance of the target answers to a number of the scene, of all types of gates together.
struct ParameterEffect {
  std::string_view key;  // dynamics::ParamInfo's
  double value = 0.0;    // NaN where types differ in it
  /// Per cent that the chance changes for one per cent of the value: (P+ - P-) / (2 P step), to
  /// first order in what the number does at each gate, with 95 % interval (chance in these runs;
  /// the chain's own error is not in it; NaN where one run in ten thousands says it all).
  Mean95 elasticity;
  double more = 0.0, less = 0.0;  // the same to one side each, with more and with less of the
                                  // number; NaN where the scene does not permit it
  bool bends = false;             // these differ by more than chance: no single number says it
};

/// The chance of the target from one of the ways to enter the first gate from below; NaN where no
/// run did.
struct StartChance {
  dynamics::Cell cell;
  double chance = 0.0;
};

struct Analysis {
  markov::Ending target{};
  double target_chance = 0.0;
  markov::WalkTotals totals;                       // quantities by dynamics::Cost
  Mean95 gates;                                    // visited, and ...
  std::array<Mean95, dynamics::kCosts> costs;      // ... what bodies took, of all of them
  std::vector<markov::TimedWalk> walks;            // seconds
  std::optional<markov::QuasiStationary> endless;  // none: see below
  std::string why_not_endless;
  std::vector<double> endless_boundaries;  // its states by dynamics::Boundary
  std::vector<StartChance> starts;
  markov::FrequentPaths paths;
  /// (rows x columns) visits of bodies that end in the target, per body of these; and per cent that
  /// the chance of the target would grow were one per cent fewer trapped in the gate (d ln P / d
  /// -ln of the share trapped, the others going on as the rest does). Of the target "trapped", and
  /// of one that nobody ends in, the latter is empty.
  markov::CellProbabilities passed, trapping;
  std::vector<double> state_trapping;  // the latter by state, in all gates together
  dynamics::StateSpace space;          // of the chain
  /// One state for each boundary, weighted by visits: how far rows of one group differ at most (a
  /// mean over groups), and the total variation that it costs; none where it cannot be made.
  struct Lumped {
    double largest = 0.0, endings = 0.0, final_gates = 0.0;
  };
  std::optional<Lumped> boundaries;
  std::vector<ParameterEffect> parameters;
  dynamics::Health parameter_health;  // of the runs behind them
  double seconds = 0.0, parameter_seconds = 0.0;
};

/// Throws std::invalid_argument for fields whose states would take more than some 8 GiB.
[[nodiscard]] Analysis analyze(const Scene& scene, const AnalysedChain& chain,
                               const AnalysisOptions& options, const dynamics::Work& work = {});

}  // namespace gatewalk::lattice
