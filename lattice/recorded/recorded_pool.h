// SPDX-License-Identifier: MIT
#pragma once
/// Recorded runs as what chains are made of.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lattice/field/problem.h"
#include "lattice/pool/pooled_prediction.h"
#include "lattice/pool/run_pool.h"
#include "lattice/recorded/recorded.h"

namespace gatewalk::lattice {

/// All runs of all trials; those of one body go together when trials are taken in groups.
[[nodiscard]] RunPool pool_of(RecordedRuns runs);

/// The other way round: simulated trials from a start, each of a body of its own, added to `runs`;
/// and the cells that they ran through, as a cell file. Who was trapped is so by the table: the
/// file has no time limit. `runs.passages` must be of the section.
void add_trials(RecordedRuns& runs, const FieldTrials& each, const dynamics::Entry& start);
[[nodiscard]] CellFile cells_of(const Problem& problem);

/// The field of the cells; there are none to run. Faces without a usual range get that of the
/// entries seen, or one scale about 0 where there was none: nothing leads to such a state.
[[nodiscard]] Problem problem_of(const CellFile& cells, const RunPool& pool);

/// What recorded runs cannot tell, a sentence each: few bodies, faces that nobody entered by.
[[nodiscard]] std::vector<std::string> doubts_of(const RunPool& pool, const Problem& problem);
/// Whether places on the faces are farther off than a cell is large. Empty: none is.
[[nodiscard]] std::string far_from_faces(const RunPool& pool, const Problem& problem);

/// What became of bodies that were lost from sight, if one may guess: all were trapped, or all left
/// as another body did that entered by the same state (drawn; those of states that nobody is known
/// to have left stay lost).
enum class LostFate { trapped, left };
[[nodiscard]] RunPool with_lost(const RunPool& pool, const Problem& problem, LostFate fate,
                                int per_leaf, std::uint64_t seed);
/// The share of all passages that were lost.
[[nodiscard]] double lost_share(const RunPool& pool);

/// Predictions from a start (none: as bodies were seen to enter first) if all lost bodies had been
/// trapped, and if all had left; without any when nobody was lost.
struct LostBounds {
  double lost = 0.0;  // share of all passages
  std::array<markov::FinalDistribution, 2> final{};
};
[[nodiscard]] LostBounds lost_bounds(const Problem& problem, const RunPool& pool,
                                     const std::optional<dynamics::Entry>& start, int per_leaf,
                                     std::uint64_t seed);

}  // namespace gatewalk::lattice
