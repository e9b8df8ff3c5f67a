// SPDX-License-Identifier: MIT
#pragma once
/// Rare events: the probability to get far into a field, where direct simulation would never see a
/// body. Importance splitting of full trials (Villen-Altamirano 1991; Glasserman et al. 1999), with
/// the chain's committor as the measure of progress.

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

/// The value of an entry into a gate: proportional to the estimated probability to reach the target
/// from there. Any function > 0 gives an unbiased estimate; a good one gives a precise estimate.
using EntryValue = std::function<double(int column, int row, const dynamics::Entry& entry)>;

/// The target, and when splitting stops.
struct SplittingOptions {
  int row = 0;                           // the target: entering this row, counted from 0
  double accuracy = 0.05;                // relative standard error at which the simulation stops
  std::optional<std::int64_t> trials{};  // if given, exactly this number, whatever the accuracy
  std::int64_t most_runs = 20'000'000;   // most gate runs, about
  std::int64_t most_in_vain = 100'000;   // most trials while no body reaches the target
  std::uint64_t seed = 1;
  static constexpr std::int64_t kFirst = 1000;  // trials that run whatever most_runs is
};

/// The probability to enter one row.
struct RowChance {
  double probability = 0.0;
  double relative_standard_error = 0.0;  // NaN if no body entered
  double at_most = 1.0;                  // upper end of the interval if no body entered
  std::int64_t trials = 0;               // independent trials behind it
  /// Two-sided 95 % interval, of the logarithm, which makes such estimates less skewed. For a
  /// probability above 1/2 it is at least as wide as the Jeffreys interval of the trials, because
  /// some bodies may fail although all seen ones succeeded. It begins at 0 if no body entered.
  [[nodiscard]] std::array<double, 2> interval_95() const;
};

/// The results of split().
struct Splitting {
  std::vector<RowChance> rows;  // of the rows ahead of the start's, up to the target
  int first_row = 1;            // the row of rows.front()
  std::int64_t trials = 0;      // independent trials, each of which becomes many bodies or none
  std::int64_t gate_runs = 0;
  bool reached = false;  // the accuracy asked for is reached
  dynamics::Health health;
};

/// The problem cut to the rows of cells before `row`, without a limit of cells. Throws
/// std::invalid_argument if its map has fewer rows, and for a row not ahead of the start's.
[[nodiscard]] Problem up_to_row(const Problem& problem, int row);

/// Runs full trials from the start, without a limit of gates, with splitting. A body that enters a
/// gate of value v should have the weight v0/v, with v0 the value of the start. Within a factor of
/// two its weight stays. Otherwise the body becomes a random whole number of bodies of weight v0/v,
/// which keep its weight on average and have independent random forces from then on. The weights
/// that enter a row sum to an unbiased estimate of the probability, whatever the values. The bits
/// are the same on any number of threads. Throws std::invalid_argument as up_to_row, for a value
/// that is not positive, for recorded runs, and if bodies may move back to a row before, where they
/// would be counted twice.
[[nodiscard]] Splitting split(const Problem& problem, double start_value, const EntryValue& value,
                              const SplittingOptions& options, const dynamics::Work& work = {});

/// Splitting, with the chain that gave the values of entries.
struct RareEvent {
  Splitting splitting;
  std::vector<double> chain;  // the chain's own probabilities, by splitting.rows
  std::int64_t pool_runs = 0;
  double chain_seconds = 0.0;  // pool and chain
  double seconds = 0.0;        // everything
};

/// Splits with the committor of a chain made from full trials: 60 000, or down to an eighth of that
/// if some hundreds of them enter the row or none leaves the first gate. With several gate types,
/// half of these trials run through fields of one type each (except for the first gate); otherwise
/// few bodies would see types far from the start.
[[nodiscard]] RareEvent rare_event(const Problem& problem, const SplittingOptions& options,
                                   const dynamics::Work& work = {});

/// Direct simulation: number of trials that entered each row ahead of the start's.
struct DirectRows {
  std::int64_t trials = 0;
  std::vector<std::int64_t> entered;  // the last one: crossed the field
  double seconds = 0.0;
};
/// Runs direct simulation; bodies must not move back to a row before. Throws as field_trials.
[[nodiscard]] DirectRows direct_rows(const Problem& problem, std::int64_t trials,
                                     std::uint64_t seed, const dynamics::Work& work = {});

}  // namespace gatewalk::lattice
