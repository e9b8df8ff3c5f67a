// SPDX-License-Identifier: MIT
#pragma once
/// What is said of recorded runs.

#include <cstdint>
#include <string>
#include <vector>

#include "cli/fields/fields.h"
#include "lattice/source/cell_matrix.h"

namespace gatewalk::cli {

/// Recorded runs by number.
struct RecordedCounts {
  std::int64_t bodies = 0, trials = 0, passages = 0;
  std::int64_t left = 0, trapped = 0, lost = 0;  // of the passages, by what became of the body
};
[[nodiscard]] RecordedCounts counts_of(const lattice::RunPool& pool);
void describe(Fields& out, const RecordedCounts& counts);
/// The key "recorded", of results that recorded runs are behind.
void describe_recorded(Fields& out, const RecordedCounts& counts);
[[nodiscard]] std::string table_of(const RecordedCounts& counts);
[[nodiscard]] std::string table_of(const lattice::RunPool& pool);
/// The key "lost_bounds", where anybody was lost.
void describe_lost_bounds(Fields& out, const lattice::LostBounds& bounds);
/// Empty where nobody was lost.
[[nodiscard]] std::string table_of(const lattice::LostBounds& bounds);

}  // namespace gatewalk::cli
