// SPDX-License-Identifier: MIT
#pragma once
/// Options that plan and design share. Both commands choose by a chain, simulate the choice in
/// full, add these runs to the chain, and repeat.

#include <string>

#include "cli/arguments.h"
#include "lattice/study/crossings.h"

namespace gatewalk::cli {

/// The options that plan and design share.
struct ChoiceRounds {
  TextsOption starts;
  AskedAccuracy accuracy;
};

/// Declares --start, --accuracy, --gate-runs, --seed, --checkpoint and --strict; `also` ends the
/// help text of --start.
inline ChoiceRounds add_choice_rounds(Options& options, const std::string& also = "") {
  const TextsOption starts = options.add_texts(
      "start", "D,VX,VY",
      "start at x = D m, y = 0 with this velocity in m/s (default: the scene's start)" + also);
  const NumberOption accuracy = options.add_number(
      "accuracy", "A", "half of the interval that a chance to cross may have (default: 0.02)");
  const CountOption gate_runs = options.add_count(
      "gate-runs", "N",
      "no new round of choosing after so many gate runs (default: 2e7); one there always is");
  options.add_seed();
  options.add_kept();
  options.add_strict();
  return {starts, {accuracy, gate_runs}};
}

/// Puts the options' values into a lattice::PlanOptions, or a struct with the same members. Throws
/// UsageError.
template <class How>
void take_choice_rounds(const Options& options, const ChoiceRounds& asked, How& how) {
  how.seed = options.seed();
  if (asked.accuracy.accuracy) how.accuracy = asked.accuracy.accuracy.value();
  if (!(how.accuracy >= 0.001 && how.accuracy < 0.5))
    throw UsageError("--accuracy: must lie in [0.001, 0.5)");
  if (asked.accuracy.gate_runs) how.most_runs = asked.accuracy.gate_runs.value(1000);
}

/// Warns if --gate-runs ended the rounds before the choice was settled.
inline void warn_of_choice_rounds(const Options& options, const lattice::ChoiceSummary& search) {
  if (!search.settled)
    options.warn("choosing was not finished after " + std::to_string(search.gate_runs) +
                 " gate runs; --gate-runs allows more");
}

}  // namespace gatewalk::cli
