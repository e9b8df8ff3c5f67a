// SPDX-License-Identifier: MIT
#pragma once
/// What results say of recorded runs.

#include <cstdint>
#include <string>
#include <vector>

#include "cli/fields/fields.h"
#include "lattice/source/cell_matrix.h"

namespace gatewalk::cli {

/// The number of recorded bodies, trials and passages.
struct RecordedCounts {
  std::int64_t bodies = 0, trials = 0, passages = 0;
  std::int64_t left = 0, trapped = 0, lost = 0;  // passages, by what became of the body
  std::int64_t bodies_lost = 0;                  // bodies with at least one passage that was lost
};
[[nodiscard]] RecordedCounts counts_of(const lattice::RunPool& pool);
void describe(Fields& out, const RecordedCounts& counts);
/// The key "recorded", in results from recorded runs.
void describe_recorded(Fields& out, const RecordedCounts& counts);
[[nodiscard]] std::string table_of(const RecordedCounts& counts);
[[nodiscard]] std::string table_of(const lattice::RunPool& pool);
/// The key "lost_bounds", if bodies were lost from sight.
void describe_lost_bounds(Fields& out, const lattice::LostBounds& bounds);
/// A table of the bounds; empty if no body was lost.
[[nodiscard]] std::string table_of(const lattice::LostBounds& bounds);
/// "Beware: 3 of 48 bodies were lost from sight ...", with the bounds of each ending for which a
/// bound lies outside the 95 % interval of `answer`, or the bounds differ by more than its width.
/// Empty if no body was lost.
[[nodiscard]] std::string beware_of_lost(const RecordedCounts& counts,
                                         const lattice::LostBounds& bounds,
                                         const lattice::EndingShares& answer);

}  // namespace gatewalk::cli
