// SPDX-License-Identifier: MIT
#pragma once
/// Where walks pass that end in one way, and how likely that is from everywhere.

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

/// How often walks pass each state of each cell at each draw (without limit of gates: at any draw),
/// and the chance of the target from there.
class ReactiveVisits {
 public:
  struct Parts {
    bool costs = true;   // else totals() has no quantities, which are most of the time
    bool places = true;  // else each() and Draws have none
    double tolerance = markov::kRowTolerance;  // of the rows of a field without limit
    std::function<void(double part)> told{};   // of parts of the work that are done: 1 in all
  };
  /// Without limit of gates walks are followed until those left are few beside the ones that end in
  /// the target. Throws as markov::EndingChance and walk_totals.
  ReactiveVisits(const ChainWithRewards& c, const FieldParams& field, markov::Ending target,
                 const Parts& parts);

  struct Place {
    int draw = 1;
    std::int64_t cell = 0;
    int input = 0;
  };
  [[nodiscard]] const markov::EndingChance& chance() const { return chance_; }
  [[nodiscard]] double chance(const Place& at) const { return chance_(at.draw, at.cell, at.input); }
  /// The chance of the target at the start.
  [[nodiscard]] double at_start() const { return at_start_; }
  /// What all walks add up, and how they end.
  [[nodiscard]] const markov::WalkTotals& totals() const { return totals_; }
  /// Draws of a walk that ends in the target, on average; not a number where none does.
  [[nodiscard]] double draws_to_target() const { return to_target_ / at_start_; }
  /// Expected draws of a walk in each state (inputs).
  [[nodiscard]] const std::vector<double>& state_visits() const { return state_visits_; }

  /// Calls use(place, share of the walks there) for all places that are passed.
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

  /// Places drawn in proportion to how often they are passed, by all walks and by those that end in
  /// the target, half of each.
  class Draws {
   public:
    explicit Draws(const ReactiveVisits& passages);
    /// The place of a number in (0, 1).
    [[nodiscard]] Place place(double uniform) const;
    /// The mean of weight * f over places drawn is the sum of share * f over all places.
    [[nodiscard]] double weight(const Place& at) const {
      return 2.0 / (passages_.chance(at) / to_target_.back() + 1.0 / all_.back());
    }

   private:
    const ReactiveVisits& passages_;
    std::vector<std::size_t> passed_;      // of shares_, those with places
    std::vector<double> all_, to_target_;  // sums of shares up to each place of these
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
  std::vector<std::vector<double>> shares_;  // (draws x cells), by input; empty: nobody passes
  markov::WalkTotals totals_;
};

/// Groups of trials make intervals, which are known to two or three digits.
inline constexpr double kGroupTolerance = 1e-6;

struct AllReactiveVisits {
  ReactiveVisits whole;
  std::vector<ReactiveVisits> groups;
};

/// Of the chain and of its groups, on all threads. `work` is told of each that is done, as `what`,
/// by any thread, but one at a time.
[[nodiscard]] AllReactiveVisits all_reactive_visits(const AnalysedChain& chain,
                                                    const FieldParams& field, markov::Ending target,
                                                    const ReactiveVisits::Parts& of_whole,
                                                    const ReactiveVisits::Parts& of_groups,
                                                    std::string_view what,
                                                    const dynamics::Work& work);

/// Share of a state's draws that are trapped, by type of cell and state.
[[nodiscard]] std::vector<std::vector<double>> trapped_shares(const markov::FieldChain& field);

/// (rows x columns) Where walks end, of their places.
[[nodiscard]] markov::CellProbabilities final_cells(const ChainWithRewards& c,
                                                    const FieldParams& field,
                                                    const ReactiveVisits& passages);

}  // namespace gatewalk::lattice
