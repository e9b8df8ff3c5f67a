// SPDX-License-Identifier: MIT
#pragma once
/// What a chain says beyond the final gates, as JSON, as a table and as a picture.

#include <optional>
#include <string>

#include "cli/render/figure.h"
#include "cli/render/final_gates.h"
#include "cli/render/json_fwd.h"
#include "cli/render/shown_field.h"
#include "cli/render/variance_shares.h"
#include "lattice/field_costs.h"
#include "lattice/statistics/ending_shares.h"
#include "lattice/study/analysis.h"
#include "lattice/study/parameter_effects.h"

namespace gatewalk::cli {

/// The same field by trials of the full dynamics.
struct DirectTrials {
  lattice::FieldTally tally;
  lattice::FieldCosts costs;
};

struct AnalysedField {
  const ShownField& shown;
  const std::optional<dynamics::Entry>& start;  // none: as bodies were seen to enter first
  const lattice::EndingShares& endings;
  const lattice::Analysis& analysis;
  const lattice::ParameterEffects& parameters;
  const std::optional<DirectTrials>& direct;
  bool from_trials = false;    // the endings are the trials' own shares
  bool reached = true;         // the accuracy asked for
  std::int64_t gate_runs = 0;  // made for the chain
  int states = 0;
  double seconds = 0.0;                  // of the prediction behind the endings
  double step = 0.0;                     // of the parameters
  Rest rest{};                           // what the endings leave out
  const RangedShares* shares = nullptr;  // of --over, for the picture
};

/// How far the durations of the chain's walks are from those of trials: the largest difference
/// between their distribution functions (Kolmogorov), and what 95 % of so many trials of the same
/// distribution have no more than. Of all, or of one ending; NaN where either has fewer than 50.
struct KolmogorovDistance {
  double distance, chance_95;
};
[[nodiscard]] KolmogorovDistance duration_distance(const lattice::Analysis& analysis,
                                                   const lattice::FieldCosts& costs,
                                                   std::optional<markov::Ending> ending);

/// The target in words.
[[nodiscard]] const char* target_name(const AnalysedField& field);
/// The distribution function of the durations of the chain's walks with one ending, at some hundred
/// points; empty where there are none.
struct DurationCurve {
  std::vector<double> seconds, share;
};
[[nodiscard]] DurationCurve duration_curve(const lattice::Analysis& analysis,
                                           markov::Ending ending);
/// The largest chance of the target from any start.
[[nodiscard]] double most_of_starts(const lattice::Analysis& analysis);
/// The parameters, those that matter most first.
[[nodiscard]] std::vector<lattice::ParameterEffect> sorted_effects(const AnalysedField& field);

/// Without "status" and "made_by".
[[nodiscard]] Json to_json(const AnalysedField& field);
[[nodiscard]] std::string table_of(const AnalysedField& field);
[[nodiscard]] Figure figure_of(const AnalysedField& field);

}  // namespace gatewalk::cli
