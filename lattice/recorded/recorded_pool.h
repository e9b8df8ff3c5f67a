// SPDX-License-Identifier: MIT
#pragma once
/// Recorded runs as the pool that chains are made from.

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

/// All runs as a pool; all trials of one body go into the same group.
[[nodiscard]] RunPool pool_of(RecordedRuns runs);

/// Adds simulated trials from a start to `runs`, each with a body of its own. `runs.passages` must
/// belong to the same section.
void add_trials(RecordedRuns& runs, const FieldTrials& each, const dynamics::Entry& start);
/// The cells of a problem as a cell file. It has no time limit: bodies count as trapped if the
/// table says so.
[[nodiscard]] CellFile cells_of(const Problem& problem);

/// The field of recorded cells, which has no cells to run. A face without a usual range gets the
/// range of the entries seen, or one scale around 0 if there were none: no run leads to that state.
[[nodiscard]] Problem problem_of(const CellFile& cells, const RunPool& pool);

/// What recorded runs cannot tell, one sentence each: too few bodies for error bars, faces to which
/// passages lead and by which no body was seen to enter.
[[nodiscard]] std::vector<std::string> doubts_of(const RunPool& pool, const Problem& problem);
/// A sentence on the faces to which no passage leads; empty if there are none. No prediction from
/// the observed entries needs these faces.
[[nodiscard]] std::string faces_without_use(const RunPool& pool, const Problem& problem);
/// A sentence if places on the faces are further from the middle than a cell is large; else empty.
[[nodiscard]] std::string far_from_faces(const RunPool& pool, const Problem& problem);

/// The assumed fate of bodies that were lost: all were trapped, or all left as another body from
/// the same state did. That body is drawn at random; bodies in states from which no body is known
/// to have left stay lost.
enum class LostFate { trapped, left };
[[nodiscard]] RunPool with_lost(const RunPool& pool, const Problem& problem, LostFate fate,
                                int per_leaf, std::uint64_t seed);
/// The share of all passages that were lost.
[[nodiscard]] double lost_share(const RunPool& pool);

/// Predictions from a start (nullopt: from the observed first entries) if all lost bodies had been
/// trapped, and if all had left; without predictions if no body was lost.
struct LostBounds {
  double lost = 0.0;  // share of all passages
  std::array<markov::FinalDistribution, 2> final{};
};
[[nodiscard]] LostBounds lost_bounds(const Problem& problem, const RunPool& pool,
                                     const std::optional<dynamics::Entry>& start, int per_leaf,
                                     std::uint64_t seed);

}  // namespace gatewalk::lattice
