// SPDX-License-Identifier: MIT
#pragma once
/// Is it Markov? Whether where a body is in the chain says all of what comes next: the walks of the
/// full dynamics through the chain's states, asked for memory.

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

/// No walks yet. States are entered by a boundary each; those of several types of gates are
/// numbered one type behind the other.
[[nodiscard]] StateWalks no_walks(const dynamics::StateSpace& space, std::size_t types = 1);

/// Appends the trials of `each`, which has kept their passages, as walks of the space; they begin
/// in state `first`. A walk ends before a run that broke. `same`, if given: the state by which each
/// one goes, of all types.
void add_walks(StateWalks& walks, const dynamics::StateSpace& space, int first,
               const FieldTrials& each, const std::vector<int>& same = {});

/// The coarse states that a body may come from, of the gate before: the origins of the section's
/// faces, in two halves where mirror images enter by the same face ("from below in the left half",
/// "from below in the right half", "from the right", "from the left").
[[nodiscard]] std::vector<std::string> origins_of(const dynamics::Section& section);
/// Visits from the sixth on, and rows from i_y = 5 on, count as one.
inline constexpr int kVisits = 6, kRows = 6;

/// What is asked.
enum class Question : std::uint8_t {
  gates_ahead,  // do the kernel's powers put bodies where they are some gates later?
  gate_before,  // does where it came from tell more of the outcome than the state does?
  visit,        // ... which gate of its walk it is?
  row,          // ... which row of the field?
};
inline constexpr int kQuestions = 4;
inline constexpr std::array<std::string_view, kQuestions> kQuestionKeys{
    "gates_ahead", "gate_before", "visit", "row"};

struct MemoryStudy {
  static constexpr double kLevel = 0.05;  // of all questions together

  std::int64_t walks = 0, runs = 0;
  /// Not asked (no steps) of gates of several types: which one comes next depends on the place.
  GatesAhead ahead;
  /// Labels: origins_of; the visit, and the row of the field, from 0. Outcomes: boundary of the
  /// next entry, or trapped (behind the faces).
  Independence gate_before, visit, row;
  std::vector<std::string> origins, outcomes;  // names: of the gate before, and of all outcomes

  [[nodiscard]] const Independence& independence(Question q) const {
    return q == Question::gate_before ? gate_before : q == Question::visit ? visit : row;
  }
  [[nodiscard]] double p(Question q) const {
    return q == Question::gates_ahead ? ahead.p : independence(q).p;
  }
  /// Adjusted for asking all questions (Holm, Scand. J. Statist. 6, 1979).
  [[nodiscard]] double p_adjusted(Question q) const;
  [[nodiscard]] bool remembers(Question q) const { return p_adjusted(q) <= kLevel; }
  /// Any of them: the chain forgets what matters.
  [[nodiscard]] bool remembers() const;
};

struct MemoryOptions {
  std::optional<std::int64_t> null_draws = {};  // behind each p-value; 399 to 999, by the runs
  std::uint64_t seed = 1;
};

/// Asks the walks, of this space, all questions. Throws std::invalid_argument for no walks.
[[nodiscard]] MemoryStudy study_memory(const StateWalks& walks, const dynamics::StateSpace& space,
                                       const MemoryOptions& options,
                                       const dynamics::Work& work = {});

// ---- The memory of bodies ----

/// Of recorded runs, whether the face of the cell before (label) tells more of a run's outcome (a
/// face, or behind them trapped) than its state and type do. Runs of one body are a cluster. Throws
/// std::invalid_argument for no draws.
[[nodiscard]] Independence body_memory(const Problem& problem, const RunPool& pool, int per_leaf,
                                       std::int64_t null_draws, std::uint64_t seed);

// ---- The force's memory ----

/// How much more often trials end so in the second of two sets of the same trials, with 95 %.
struct PairedDifference {
  double difference = 0.0, low = 0.0, high = 0.0;  // of the shares of all trials
};
/// `only_first`, `only_second`: trials of which only that set has it. Interval of Agresti and Min
/// (Statist. Med. 24, 2005): half a trial more in each cell of the table.
[[nodiscard]] PairedDifference paired_difference(std::int64_t only_first, std::int64_t only_second,
                                                 std::int64_t trials);

/// The same trials with the random force held over crossings, as the model has it, and drawn anew.
struct ForceMemory {
  PairedChange change;                                     // of the final gates
  std::array<PairedDifference, markov::kEndings> endings;  // drawn anew less held, by Ending

  [[nodiscard]] bool matters() const {
    return change.in_pairs.p_total_variation <= MemoryStudy::kLevel;
  }
};

/// Throws std::invalid_argument unless both are of the same number of trials.
[[nodiscard]] ForceMemory force_memory(const RunTrials& held, const RunTrials& anew,
                                       std::uint64_t seed);

}  // namespace gatewalk::lattice
