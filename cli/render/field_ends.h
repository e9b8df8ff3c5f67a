// SPDX-License-Identifier: MIT
#pragma once
/// Where and how bodies end in a field, by trials, by walks or as predicted: what their results and
/// tables say alike.

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

/// Numbers of trials or walks, or shares of all bodies as predicted (Number: double).
template <class Number>
struct FieldEnds : markov::Ends<Number> {
  double bodies = 1.0;           // that the numbers are of; shares are of 1
  lattice::EndingShares shares;  // of the endings, as they are shown
  Number still_walking{};        // which the endings leave out, as those never sampled
  Number departed = this->left_field();

  /// Cells as shares of all bodies.
  [[nodiscard]] markov::CellProbabilities share_of(const markov::CellNumbers<Number>& cells) const {
    return cells.template cast<double>() / bodies;
  }
  /// The keys "endings" and "endings_95".
  void describe_endings(Fields& out) const;
  /// The maps "final_gates", with `limits` if there are any, "trapped_gates" and "departed_gates".
  void describe_gates(Fields& out, const GateLimits* limits = nullptr) const;
  /// The keys "trapped", "departed" and "cut_off"; with their intervals, if asked for.
  void describe_sums(Fields& out, bool with_intervals = false) const;
  void describe_never_sampled(Fields& out) const;
  /// `share`: 95 % interval of the share of these walks.
  void describe_still_walking(Fields& out, const std::optional<Interval>& share = {}) const;
  /// The maps of final gates and of trapped bodies in `unit` ("% of trials"), and the share of
  /// bodies that left the field.
  [[nodiscard]] std::string maps(const std::string& unit) const;
};

/// The keys "trapped", "departed" and "cut_off": shares of trials, or as predicted.
void describe_fates(Fields& out, const lattice::FieldTally& tally);
void describe_fates(Fields& out, const markov::FinalDistribution& f);

[[nodiscard]] FieldEnds<std::int64_t> ends_of(const lattice::FieldTally& tally,
                                              const lattice::FieldParams& field);
[[nodiscard]] FieldEnds<std::int64_t> ends_of(const markov::WalkTally& tally,
                                              const lattice::FieldParams& field);
/// `shares`: of the prediction's endings, with intervals.
[[nodiscard]] FieldEnds<double> ends_of(const markov::FinalDistribution& f,
                                        const lattice::EndingShares& shares);

}  // namespace gatewalk::cli
