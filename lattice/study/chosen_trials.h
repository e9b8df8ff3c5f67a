// SPDX-License-Identifier: MIT
#pragma once
/// Trials in which the type of each cell is chosen when a body enters it, and the runs of those
/// that something is to be chosen by.

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "dynamics/base/work.h"
#include "lattice/pool/run_pool.h"
#include "lattice/problem.h"
#include "lattice/reference.h"
#include "lattice/study/crossings.h"

namespace gatewalk::lattice {

/// Trials of `first` in cells of these types; with the noise that field_trials of these numbers
/// have.
[[nodiscard]] FieldTally chosen_trials(const dynamics::CellField& cells, const Problem& first,
                                       const CellChoice& choice, std::uint64_t seed,
                                       dynamics::TrialRange range, FieldTrials& each);

/// Of so many trials a chance of one half has an interval of twice the accuracy.
[[nodiscard]] std::int64_t trials_for(double accuracy);
/// Sizes of leaves to choose by, in those asked for: small ones tell ways to enter apart, large
/// ones know better what comes of each.
inline constexpr std::array<int, 3> kLeafSizes{1, 8, 64};
/// Bytes that decisions or values of all cells, states and gates may take.
inline constexpr double kMostDecisionBytes = 8.0e9;

/// Such trials one behind the other, of numbers that trials of a field do not have.
class ChosenTrials {
 public:
  /// What is given outlives it. `name`: of the study, for messages and kept pieces.
  ChosenTrials(std::string name, const dynamics::CellField& cells, const Problem& first,
               std::uint64_t seed, const dynamics::Work& work)
      : name_(std::move(name)), cells_(cells), first_(first), seed_(seed), work_(work) {}

  /// The next `count` of them. Throws std::runtime_error when a run broke.
  [[nodiscard]] FieldTrials run(const CellChoice& choice, std::int64_t count);
  /// The same in the map's cells, each trial from a start of its own.
  [[nodiscard]] FieldTrials run_from(const StartOfTrial& from, std::int64_t count);
  [[nodiscard]] std::int64_t next() const { return next_; }
  /// The trials from that number on once more.
  void go_back_to(std::int64_t next) { next_ = next; }

  /// Into the pool. Of several runs of the same trials one only: a run that is twice in a leaf says
  /// nothing new.
  void add(const FieldTrials& trials) { add(trials, {first_.start}); }
  /// `starts`: of each trial, or one of all.
  void add(const FieldTrials& trials, std::vector<dynamics::Entry> starts);
  [[nodiscard]] const RunPool& pool() const { return pool_; }

  /// Chance that the noise of the trials knows nothing of.
  [[nodiscard]] std::uint64_t word(dynamics::Purpose purpose, const Place& at,
                                   std::uint64_t what) const;
  [[nodiscard]] std::int64_t gate_runs() const { return gate_runs_; }  // of all
  [[nodiscard]] const dynamics::Health& health() const { return health_; }

 private:
  /// Of a range of trials, each of which is appended.
  using RunRange = std::function<FieldTally(dynamics::TrialRange range, FieldTrials& each)>;
  [[nodiscard]] FieldTrials in_pieces(const RunRange& run_range, std::int64_t count);

  std::string name_;
  const dynamics::CellField& cells_;
  const Problem& first_;
  std::uint64_t seed_;
  const dynamics::Work& work_;
  std::int64_t next_ = std::int64_t{1} << 50;
  RunPool pool_;
  std::int64_t gate_runs_ = 0;
  dynamics::Health health_;
};

}  // namespace gatewalk::lattice
