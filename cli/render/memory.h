// SPDX-License-Identifier: MIT
#pragma once
/// Is it Markov? What the walks of the full dynamics remember, as JSON and in words.

#include <string>

#include "cli/render/json_fwd.h"
#include "lattice/study/memory.h"

namespace gatewalk::cli {

/// One of several statistics that were looked at together.
[[nodiscard]] Json to_json(const lattice::LookedAt::Test& test);

/// Every question with its p-values, statistics, size and power; the "verdict" of all.
[[nodiscard]] Json to_json(const lattice::MemoryStudy& study);
[[nodiscard]] Json to_json(const lattice::ForceMemory& memory);

/// A line per question, then the verdict.
[[nodiscard]] std::string text_of(const lattice::MemoryStudy& study);
/// "the force's hold ...": one sentence.
[[nodiscard]] std::string text_of(const lattice::ForceMemory& memory);

}  // namespace gatewalk::cli
