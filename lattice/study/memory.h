// SPDX-License-Identifier: MIT
#pragma once
/// Is the chain Markov? Tests whether a body's state in the chain tells all that matters for what
/// comes next, on walks of the full dynamics through the chain's states.

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dynamics/base/work.h"
#include "dynamics/cells/state_space.h"
#include "lattice/field/field_trials.h"
#include "lattice/field/problem.h"
#include "lattice/pool/run_pool.h"
#include "lattice/statistics/gates_ahead.h"
#include "lattice/statistics/independence.h"
#include "lattice/statistics/paired_change.h"

namespace gatewalk::lattice {

struct RunTrials;

// ---- The states' memory ----

/// An empty list of walks. The way of entering a state is its face; states of several gate types
/// are numbered consecutively, type by type.
[[nodiscard]] StateWalks no_walks(const dynamics::StateSpace& space, std::size_t types = 1);

/// Appends trials, whose passages must be kept, as walks through the states of `space`; the walks
/// begin in state `first`, and end before a run that broke. `same`, if given: by state of all
/// types, the state that stands for it.
void add_walks(StateWalks& walks, const dynamics::StateSpace& space, int first,
               const FieldTrials& each, const std::vector<int>& same = {});

/// Names of the coarse origins of a body, in the gate before: the origins of the section's faces.
/// If mirror images enter by the same face, its origin has two halves ("from below in the left
/// half", "from below in the right half", "from the right", "from the left").
[[nodiscard]] std::vector<std::string> origins_of(const dynamics::Section& section);
/// Visits from the sixth on count as one, and so do rows from i_y = 5 on.
inline constexpr int kVisits = 6, kRows = 6;

/// The questions about memory.
enum class Question : std::uint8_t {
  gates_ahead,  // do the kernel's powers predict where bodies are some gates later?
  gate_before,  // does the gate before help to predict the outcome, once the state is known?
  visit,        // does the number of gates passed help?
  row,          // does the row of the field help?
};
inline constexpr int kQuestions = 4;
inline constexpr std::array<std::string_view, kQuestions> kQuestionKeys{
    "gates_ahead", "gate_before", "visit", "row"};

/// The answers to all questions.
struct MemoryStudy {
  static constexpr double kLevel = 0.05;  // for all questions together

  std::int64_t walks = 0, runs = 0;
  /// Not tested (no steps) with several gate types, because the next type depends on the place.
  GatesAhead ahead;
  /// Labels: origins_of; visit; row of the field, from 0. Outcomes: the face of the next entry, or
  /// trapped (after the faces).
  Independence gate_before, visit, row;
  std::vector<std::string> origins, outcomes;  // names: of the gate before, and of all outcomes

  [[nodiscard]] const Independence& independence(Question q) const {
    return q == Question::gate_before ? gate_before : q == Question::visit ? visit : row;
  }
  [[nodiscard]] double p(Question q) const {
    return q == Question::gates_ahead ? ahead.p : independence(q).p;
  }
  /// p-value adjusted for all questions (holm).
  [[nodiscard]] double p_adjusted(Question q) const;
  [[nodiscard]] bool remembers(Question q) const { return p_adjusted(q) <= kLevel; }
  /// True if any question finds memory: the chain then forgets something that matters.
  [[nodiscard]] bool remembers() const;
};

struct MemoryOptions {
  /// Behind each p-value; 399 to 999, by the number of runs.
  std::optional<std::int64_t> null_draws = {};
  std::uint64_t seed = 1;
  int start_row = 0;  // the row of the field that walks start in
};

/// Asks all questions about walks in this space. Throws std::invalid_argument if there are no
/// walks.
[[nodiscard]] MemoryStudy study_memory(const StateWalks& walks, const dynamics::StateSpace& space,
                                       const MemoryOptions& options,
                                       const dynamics::Work& work = {});

// ---- The memory of bodies ----

/// For recorded runs: tests whether the face of the cell before (label) helps to predict a run's
/// outcome (a face, or trapped after the faces), once state and type are known. The runs of one
/// body form a cluster. Throws std::invalid_argument for no draws.
[[nodiscard]] Independence body_memory(const Problem& problem, const RunPool& pool, int per_leaf,
                                       std::int64_t null_draws, std::uint64_t seed);

// ---- The force's memory ----

/// Difference of a share between two sets of the same trials, second minus first, with 95 % bounds.
struct PairedDifference {
  double difference = 0.0, low = 0.0, high = 0.0;  // relative to all trials
};
/// `only_first`, `only_second`: numbers of trials with the property in that set only. The interval
/// is that of Agresti and Min (Statist. Med. 24, 2005), with half a trial added to each cell of the
/// table.
[[nodiscard]] PairedDifference paired_difference(std::int64_t only_first, std::int64_t only_second,
                                                 std::int64_t trials);

/// The same trials with the random force kept over crossings, as in the model, and drawn anew at
/// each crossing.
struct ForceMemory {
  PairedChange change;                                     // of the final gates
  std::array<PairedDifference, markov::kEndings> endings;  // drawn anew minus kept, by Ending

  [[nodiscard]] bool matters() const {
    return change.in_pairs.p_total_variation <= MemoryStudy::kLevel;
  }
};

/// Compares the two sets. Throws std::invalid_argument unless both have the same number of trials.
[[nodiscard]] ForceMemory force_memory(const RunTrials& held, const RunTrials& anew,
                                       std::uint64_t seed);

}  // namespace gatewalk::lattice
