// SPDX-License-Identifier: MIT
#pragma once
/// Expected visits of walks that end in a given way, and the committor of that ending from every
/// state (transition path theory).

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

#include "dynamics/base/work.h"
#include "lattice/field/field_params.h"
#include "lattice/pool/chain_with_rewards.h"
#include "markov/committor.h"
#include "markov/totals.h"

namespace gatewalk::lattice {

/// How often walks pass each state of each cell at each draw (without a limit of gates: at any
/// draw), and the chance of the target ending from there (committor).
class ReactiveVisits {
 public:
  /// Which parts to compute, and to what tolerance.
  struct Parts {
    bool costs = true;   // else totals() has no quantities, which take most of the time
    bool places = true;  // else each() and Draws have no places
    double tolerance = markov::kRowTolerance;  // for the rows of a field without limit
    std::function<void(double part)> told{};   // called with the finished part of the work, 1: done
  };
  /// Without a limit of gates, walks are followed until those left are few compared with the walks
  /// that end in the target. Throws as markov::EndingChance and walk_totals.
  ReactiveVisits(const ChainWithRewards& c, const FieldParams& field, markov::Ending target,
                 const Parts& parts);

  /// A state of a cell, at a draw.
  struct Place {
    int draw = 1;
    std::int64_t cell = 0;
    int input = 0;
  };
  [[nodiscard]] const markov::EndingChance& chance() const { return chance_; }
  [[nodiscard]] double chance(const Place& at) const { return chance_(at.draw, at.cell, at.input); }
  /// The chance of the target ending at the start.
  [[nodiscard]] double at_start() const { return at_start_; }
  /// Sums of costs over all walks, and how walks end.
  [[nodiscard]] const markov::WalkTotals& totals() const { return totals_; }
  /// Mean number of draws of a walk that ends in the target; NaN if no walk does.
  [[nodiscard]] double draws_to_target() const { return to_target_ / at_start_; }
  /// Expected number of draws of a walk in each state (inputs).
  [[nodiscard]] const std::vector<double>& state_visits() const { return state_visits_; }

  /// Calls use(place, share of the walks there) for all places that walks pass.
  template <class Use>
  void each(Use use) const {
    for (std::size_t layer = 0; layer < shares_.size(); ++layer) {
      Place at = place_of(layer);
      for (const double share : shares_[layer]) {
        if (share > 0.0) use(at, share);
        ++at.input;
      }
    }
  }

  /// Draws places in proportion to their visits: half by the visits of all walks, half by the
  /// visits of walks that end in the target.
  class Draws {
   public:
    explicit Draws(const ReactiveVisits& passages);
    /// The place that a uniform number in (0, 1) draws.
    [[nodiscard]] Place place(double uniform) const;
    /// Importance weight: the mean of weight * f over places drawn is the sum of share * f over all
    /// places.
    [[nodiscard]] double weight(const Place& at) const {
      return 2.0 / (passages_.chance(at) / to_target_.back() + 1.0 / all_.back());
    }

   private:
    const ReactiveVisits& passages_;
    std::vector<std::size_t> passed_;      // indices into shares_ of layers with places
    std::vector<double> all_, to_target_;  // cumulative shares over the places of passed_
  };

 private:
  /// The first place of shares_[layer].
  [[nodiscard]] Place place_of(std::size_t layer) const {
    const auto at = static_cast<std::int64_t>(layer);
    return {static_cast<int>(at / cells_) + 1, at % cells_, 0};
  }

  markov::EndingChance chance_;
  double at_start_, to_target_ = 0.0;
  bool limited_;
  std::int64_t inputs_, cells_;
  std::vector<double> state_visits_;
  std::vector<std::vector<double>> shares_;  // (draws x cells), by input; empty: no walk passes
  markov::WalkTotals totals_;
};

/// Tolerance for groups of trials: the intervals made of them have two or three digits.
inline constexpr double kGroupTolerance = 1e-6;

/// Reactive visits of a chain, and of the groups behind its error bars.
struct AllReactiveVisits {
  ReactiveVisits whole;
  std::vector<ReactiveVisits> groups;
};

/// Computes the visits of the chain and of its groups, on all threads. `work` is told of each
/// finished part under the name `what`, from any thread, one at a time.
[[nodiscard]] AllReactiveVisits all_reactive_visits(const AnalysedChain& chain,
                                                    const FieldParams& field, markov::Ending target,
                                                    const ReactiveVisits::Parts& of_whole,
                                                    const ReactiveVisits::Parts& of_groups,
                                                    std::string_view what,
                                                    const dynamics::Work& work);

/// The share of a state's draws that end trapped, by cell type and state.
[[nodiscard]] std::vector<std::vector<double>> trapped_shares(const markov::FieldChain& field);

/// Probability that a walk ends in each cell (rows x columns), from the places that walks pass.
[[nodiscard]] markov::CellProbabilities final_cells(const ChainWithRewards& c,
                                                    const FieldParams& field,
                                                    const ReactiveVisits& passages);

}  // namespace gatewalk::lattice
