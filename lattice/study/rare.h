// SPDX-License-Identifier: MIT
#pragma once
/// How likely a body is to get far into a field, where direct simulation would never see it:
/// importance splitting of full trials (Villen-Altamirano 1991; Glasserman et al. 1999) with the
/// chain's committor as the measure of how far a body has got.

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "dynamics/base/work.h"
#include "dynamics/cells/health.h"
#include "lattice/field/problem.h"
#include "lattice/pool/run_pool.h"

namespace gatewalk::lattice {

/// How much an entry into a gate is worth: in proportion to the chance to reach the target from
/// there, as well as one knows. Any function > 0 gives an unbiased estimate, a good one a sure one.
using EntryValue = std::function<double(int column, int row, const dynamics::Entry& entry)>;

struct SplittingOptions {
  int row = 0;                           // the target: entering it, rows counted from 0
  double accuracy = 0.05;                // relative standard error that ends it
  std::optional<std::int64_t> trials{};  // exactly so many, whatever the accuracy
  std::int64_t most_runs = 20'000'000;   // gate runs, about
  std::int64_t most_in_vain = 100'000;   // trials while no body has come to the target
  std::uint64_t seed = 1;
};

/// Chance to enter one row.
struct RowChance {
  double probability = 0.0;
  double relative_standard_error = 0.0;  // NaN where no body came; and then ...
  double at_most = 1.0;                  // ... the upper end of the interval
  std::int64_t trials = 0;               // independent ones behind it
  /// Two-sided. That of the logarithm, in which such estimates are less skewed, and of a chance
  /// above a half no narrower than Jeffreys' of the trials: where all came, some may still not.
  /// From 0 where no body came.
  [[nodiscard]] std::array<double, 2> interval_95() const;
};

struct Splitting {
  std::vector<RowChance> rows;  // (options.row) rows 1, 2, ... up to the target
  std::int64_t trials = 0;      // independent ones, each of which becomes many bodies or none
  std::int64_t gate_runs = 0;
  bool reached = false;  // as accurate as was asked for
  dynamics::Health health;
};

/// The field with as many rows of cells as there are before `row`, and no limit of cells. Throws
/// std::invalid_argument where its map has fewer, and for a row below 1.
[[nodiscard]] Problem up_to_row(const Problem& problem, int row);

/// Full trials from the start, without limit of gates. A body of weight w that enters a
/// gate of value v is to weigh v0/v, v0 the value of the start: within a factor of two it goes on
/// as it is; else it becomes a whole number of bodies of such weights, by chance so that the mean
/// is w, each with random forces of its own from then on. The weights that enter a row add up to an
/// unbiased estimate of the chance to enter it, whatever the values. The same bits on any number of
/// threads. Throws std::invalid_argument as up_to_row, for a value that is not positive, for
/// recorded runs, and where bodies may move back to a row before: they would be counted twice.
[[nodiscard]] Splitting split(const Problem& problem, double start_value, const EntryValue& value,
                              const SplittingOptions& options, const dynamics::Work& work = {});

struct RareEvent {
  Splitting splitting;
  std::vector<double> chain;  // (options.row) the chain's own answers: rows 1, 2, ...
  std::int64_t pool_runs = 0;
  double chain_seconds = 0.0;  // of the pool and the chain's answers
  double seconds = 0.0;        // of all
};

/// The same with the committor of a chain that full trials make first, 60 000, or down to an eighth
/// of that where some hundreds of them enter the row or none leaves the first gate. Where gates are
/// of several types half of these run through fields of one type each, but for the first gate: else
/// types that stand far from the start would be seen by few bodies.
[[nodiscard]] RareEvent rare_event(const Problem& problem, const SplittingOptions& options,
                                   const dynamics::Work& work = {});

/// Direct simulation: how many trials entered rows 1, 2, ...
struct DirectRows {
  std::int64_t trials = 0;
  std::vector<std::int64_t> entered;  // (field.rows), the last: crossed the field
  double seconds = 0.0;
};
/// Runs them; nobody may move back to a row before. Throws as field_trials.
[[nodiscard]] DirectRows direct_rows(const Problem& problem, std::int64_t trials,
                                     std::uint64_t seed, const dynamics::Work& work = {});

}  // namespace gatewalk::lattice
