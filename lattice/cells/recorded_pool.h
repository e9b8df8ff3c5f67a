#pragma once
/// Recorded runs as what chains are made of.

#include <cstdint>

#include "lattice/cells/recorded.h"
#include "lattice/pool/run_pool.h"
#include "lattice/problem.h"

namespace gatewalk::lattice {

/// All runs of all trials; those of one body go together when trials are taken in groups.
[[nodiscard]] RunPool pool_of(const RecordedRuns& runs);

/// The field of the cells; there are none to run. Faces without a usual range get that of the
/// entries seen, or one scale about 0 where there was none: nothing leads to such a state.
[[nodiscard]] Problem problem_of(const CellFile& cells, const RunPool& pool);

/// What became of bodies that were lost from sight, if one may guess: all were trapped, or all left
/// as another body did that entered by the same state (drawn; those of states that nobody is known
/// to have left stay lost).
enum class LostFate { trapped, left };
[[nodiscard]] RunPool with_lost(const RunPool& pool, const Problem& problem, LostFate fate,
                                int per_leaf, std::uint64_t seed);
/// The share of all passages that were lost.
[[nodiscard]] double lost_share(const RunPool& pool);

}  // namespace gatewalk::lattice
