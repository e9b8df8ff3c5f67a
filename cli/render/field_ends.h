// SPDX-License-Identifier: MIT
#pragma once
/// Where and how bodies end in a field: what results and tables of trials, walks and predictions
/// share.

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "cli/fields/fields.h"
#include "cli/render/shown_field.h"
#include "lattice/field/field_trials.h"
#include "lattice/statistics/ending_shares.h"
#include "markov/predict.h"
#include "markov/walk.h"

namespace gatewalk::cli {

/// Numbers of trials or walks; or, with Number double, predicted shares of all bodies.
template <class Number>
struct FieldEnds : markov::Ends<Number> {
  double bodies = 1.0;           // all bodies; 1 for shares
  lattice::EndingShares shares;  // shares of the endings, as shown
  Number still_walking{};        // walks that the endings leave out because they are under way
  Number departed = this->left_field();

  /// A map as shares of all bodies.
  [[nodiscard]] markov::CellProbabilities share_of(const markov::CellNumbers<Number>& cells) const {
    return cells.template cast<double>() / bodies;
  }
  /// The keys "endings" and "endings_95".
  void describe_endings(Fields& out) const;
  /// The maps "final_gates" (with `limits` if given), "trapped_gates" and "departed_gates".
  void describe_gates(Fields& out, const GateLimits* limits = nullptr) const;
  /// The keys "trapped", "departed" and "cut_off", with intervals if asked for.
  void describe_sums(Fields& out, bool with_intervals = false) const;
  void describe_never_sampled(Fields& out) const;
  /// The key of walks that are under way; `share` is the 95 % interval of their share.
  void describe_still_walking(Fields& out, const std::optional<Interval>& share = {}) const;
  /// The maps of final gates and of trapped bodies in `unit` ("% of trials"), and the share of
  /// bodies that left the field.
  [[nodiscard]] std::string maps(const lattice::FieldParams& field, const std::string& unit) const;
};

/// The keys "trapped", "departed" and "cut_off" as shares of trials, or as predicted.
void describe_fates(Fields& out, const lattice::FieldTally& tally);
void describe_fates(Fields& out, const markov::FinalDistribution& f);

[[nodiscard]] FieldEnds<std::int64_t> ends_of(const lattice::FieldTally& tally,
                                              const lattice::FieldParams& field);
[[nodiscard]] FieldEnds<std::int64_t> ends_of(const markov::WalkTally& tally,
                                              const lattice::FieldParams& field);
/// `shares`: the prediction's endings, with intervals.
[[nodiscard]] FieldEnds<double> ends_of(const markov::FinalDistribution& f,
                                        const lattice::EndingShares& shares);

}  // namespace gatewalk::cli
