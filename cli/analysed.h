// SPDX-License-Identifier: MIT
#pragma once
/// What gatewalk analyze looks at: the chain of a subject, and what its cells' numbers change.

#include <optional>

#include "cli/ranged.h"
#include "cli/render/analysis.h"
#include "cli/subject.h"
#include "lattice/pool/costed_chain.h"
#include "lattice/study/prediction.h"

namespace gatewalk::cli {

/// The chain of a subject, and what is said of how its walks end.
struct AnalysedSubject {
  std::optional<lattice::AnalysedChain> chain;
  std::optional<lattice::PooledPrediction> of_runs{};  // one of these two says where bodies end
  std::optional<lattice::Prediction> of_bins{};
  AnalysedAnswer answer{};
  bool clean = true;
};

/// From gate runs, to which more are added until the error bar says enough; from a matrix of bins.
[[nodiscard]] AnalysedSubject analysed(const Options& options, Subject& s);

/// What the numbers of the cells change; nothing where the chain cannot tell.
[[nodiscard]] lattice::ParameterEffects effects_of(const lattice::ParameterOptions& how, Subject& s,
                                                   const AnalysedSubject& c,
                                                   const lattice::Analysis& analysis,
                                                   const dynamics::Work& work);

/// What --first-passage asks for; none without it. Throws UsageError naming what is allowed.
[[nodiscard]] std::optional<PassageAsked> first_passage_asked(const Options& options,
                                                              const Subject& s);
/// Its answer by the chain, and a warning where tables are left out; none without. Throws
/// UsageError for a state of a chain that has others now.
[[nodiscard]] std::optional<PassageResult> first_passage_of(
    const Options& options, const std::optional<PassageAsked>& asked, const Subject& s,
    const AnalysedSubject& c);

/// Declares --over and --over-trials.
void add_ranges(Options& options);
/// The scene over the ranges of --over; none without them. Throws UsageError and SceneError.
[[nodiscard]] std::optional<Ranged> over_of(const Options& options, const Subject& s);
/// How much of the variance of the target's chance over them each number makes; none without them.
[[nodiscard]] std::optional<RangedShares> shares_of(const Options& options,
                                                    const std::optional<Ranged>& ranged,
                                                    const Subject& s, markov::Ending target);

}  // namespace gatewalk::cli
