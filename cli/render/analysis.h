// SPDX-License-Identifier: MIT
#pragma once
/// What a chain says beyond the final gates, as a result, as a table and as a picture.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/fields/fields.h"
#include "cli/render/costs.h"
#include "cli/render/figure.h"
#include "cli/render/final_gates.h"
#include "cli/render/first_passage.h"
#include "cli/render/provenance.h"
#include "cli/render/shown_field.h"
#include "cli/render/start.h"
#include "cli/render/variance_shares.h"
#include "lattice/field/field_costs.h"
#include "lattice/scene/settle.h"
#include "lattice/statistics/ending_shares.h"
#include "lattice/study/analysis.h"
#include "lattice/study/parameter_effects.h"

namespace gatewalk::cli {

/// The same field by trials of the full dynamics.
struct DirectTrials {
  lattice::FieldTally tally;
  lattice::FieldCosts costs;
};

/// How bodies end, which an analysis goes beyond.
struct AnalysedAnswer {
  lattice::EndingShares endings{EndingChances{}};
  Rest rest{};                 // what these leave out
  bool from_trials = false;    // they are the trials' own shares
  bool reached = true;         // the accuracy asked for
  std::int64_t gate_runs = 0;  // made for the chain
  int states = 0;
  double seconds = 0.0;
  std::optional<dynamics::Health> health{};  // none: the file keeps none
  std::optional<lattice::Settled> method{};
};

/// The result of `analyze`.
struct AnalysedField {
  ShownField shown;
  std::optional<dynamics::Entry> start{};
  AnalysedAnswer answer{};
  lattice::Analysis analysis;
  lattice::ParameterEffects parameters{};
  double step = 0.0;                     // of the parameters
  std::optional<DirectTrials> direct{};  // of --trials
  std::optional<RangedShares> shares{};  // of --over
  std::optional<PassageResult> passage{};
  Provenance made_by{};

  /// All gate runs, and the time of all.
  [[nodiscard]] std::int64_t gate_runs() const { return answer.gate_runs + parameters.health.runs; }
  [[nodiscard]] double seconds() const {
    return answer.seconds + analysis.seconds + parameters.seconds;
  }
};
void describe(Fields& out, const AnalysedField& field);
/// The keys that pages show.
void describe_for_page(Fields& out, const AnalysedField& field);
/// The first screen, and what --details adds to it.
[[nodiscard]] std::string answer_text(const AnalysedField& field);
[[nodiscard]] std::string details_text(const AnalysedField& field);
[[nodiscard]] Figure figure_of(const AnalysedField& field);

/// What bodies take that end so, or all of them, by the chain.
[[nodiscard]] Spent spent(const lattice::Analysis& analysis, std::optional<markov::Ending> ending);
/// How far the durations of the chain's walks are from those of trials: the largest difference
/// between their distribution functions (Kolmogorov), and what 95 % of so many trials of the same
/// distribution have no more than. Of all, or of one ending; NaN where either has fewer than 50.
struct KolmogorovDistance {
  double distance = kUnknown, chance_95 = kUnknown;
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

}  // namespace gatewalk::cli
