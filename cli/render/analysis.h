// SPDX-License-Identifier: MIT
#pragma once
/// What a chain tells besides the final gates, as a result, a table and a figure.

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

/// How bodies end, on which the analysis builds.
struct AnalysedAnswer {
  lattice::EndingShares endings{EndingChances{}};
  Rest rest{};                 // what the endings leave out
  bool from_trials = false;    // whether the endings are the trials' own shares
  bool reached = true;         // whether the accuracy was reached
  std::int64_t gate_runs = 0;  // simulated for the chain
  int states = 0;
  double seconds = 0.0;
  std::optional<dynamics::Health> health{};  // none: the file has none
  std::optional<lattice::Settled> method{};
};

/// The result of `analyze`.
struct AnalysedField {
  ShownField shown;
  std::optional<dynamics::Entry> start{};
  AnalysedAnswer answer{};
  lattice::Analysis analysis;
  lattice::ParameterEffects parameters{};
  double step = 0.0;                     // relative change of the parameters
  std::optional<DirectTrials> direct{};  // from --trials
  std::optional<RangedShares> shares{};  // from --over
  std::optional<PassageResult> passage{};
  Provenance made_by{};

  /// Gate runs of the chain and of the parameters, and the time of both (s).
  [[nodiscard]] std::int64_t gate_runs() const { return answer.gate_runs + parameters.health.runs; }
  [[nodiscard]] double seconds() const {
    return answer.seconds + analysis.seconds + parameters.seconds;
  }
};
void describe(Fields& out, const AnalysedField& field);
/// Describes the keys that pages show.
void describe_for_page(Fields& out, const AnalysedField& field);
/// The first screen, with as many influences as fit above `lines_below` further lines; and what
/// --details adds to it.
[[nodiscard]] std::string answer_text(const AnalysedField& field, std::int64_t lines_below);
[[nodiscard]] std::string details_text(const AnalysedField& field);
[[nodiscard]] Figure figure_of(const AnalysedField& field);

/// Costs of bodies with this ending (all bodies without one), by the chain.
[[nodiscard]] Spent spent(const lattice::Analysis& analysis, std::optional<markov::Ending> ending);
/// The distance between the durations of the chain's walks and of trials: the largest difference
/// between their distribution functions (Kolmogorov-Smirnov), and the 95 % limit of this distance
/// for equal distributions. For one ending, or all; NaN if walks or trials are fewer than 50.
struct KolmogorovDistance {
  double distance = kUnknown, chance_95 = kUnknown;
};
[[nodiscard]] KolmogorovDistance duration_distance(const lattice::Analysis& analysis,
                                                   const lattice::FieldCosts& costs,
                                                   std::optional<markov::Ending> ending);

/// The target in words.
[[nodiscard]] const char* target_name(const AnalysedField& field);
/// The distribution function of durations of the chain's walks with one ending, at about a hundred
/// points; empty if there are none.
struct DurationCurve {
  std::vector<double> seconds, share;
};
[[nodiscard]] DurationCurve duration_curve(const lattice::Analysis& analysis,
                                           markov::Ending ending);
/// The largest probability of the target from any start.
[[nodiscard]] double most_of_starts(const lattice::Analysis& analysis);
/// The parameters in the order of their effect, largest first.
[[nodiscard]] std::vector<lattice::ParameterEffect> sorted_effects(const AnalysedField& field);

}  // namespace gatewalk::cli
