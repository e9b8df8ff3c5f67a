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

}  // namespace gatewalk::cli
