// SPDX-License-Identifier: MIT
#pragma once
/// Is it Markov? What the walks of the full dynamics remember, as JSON and in words.

#include <functional>
#include <string>

#include "cli/render/json_fwd.h"
#include "cli/render/panel.h"
#include "lattice/study/memory.h"

namespace gatewalk::cli {

/// One of several statistics that were looked at together.
[[nodiscard]] Json to_json(const lattice::LookedAt::Test& test);

/// Every question with its p-values, statistics, size and power; the "verdict" of all.
[[nodiscard]] Json to_json(const lattice::MemoryStudy& study);
[[nodiscard]] Json to_json(const lattice::ForceMemory& memory);

/// A line per question, then the verdict.
[[nodiscard]] std::string text_of(const lattice::MemoryStudy& study);
/// Panels of a figure below its others: so high, and drawn from `top` on.
struct MorePanels {
  double height = 0.0;
  std::function<void(Panels& out, double top)> draw{};
};
/// The Chapman-Kolmogorov test: a panel for each way in and each way later, and the implied time
/// scales over the lag. None where it was not asked, or of more ways than panels can be read.
[[nodiscard]] MorePanels panels_of(const lattice::MemoryStudy& study);
/// "the force's hold ...": one sentence.
[[nodiscard]] std::string text_of(const lattice::ForceMemory& memory);

}  // namespace gatewalk::cli
