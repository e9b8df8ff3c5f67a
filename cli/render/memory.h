// SPDX-License-Identifier: MIT
#pragma once
/// Is it Markov? What the walks of the full dynamics remember, as a result and in words.

#include <functional>
#include <string>

#include "cli/fields/fields.h"
#include "cli/render/panel.h"
#include "lattice/study/memory.h"

namespace gatewalk::cli {

/// The keys of one of several statistics that were looked at together.
void describe(Fields& out, const lattice::MultipleTests::Test& test);

/// Every question with its p-values, statistics, size and power; the "verdict" of all.
void describe(Fields& out, const lattice::MemoryStudy& study);
void describe(Fields& out, const lattice::ForceMemory& memory);

/// The answer to all questions in one line, and the answer to each of them.
[[nodiscard]] std::string sentence_of(const lattice::MemoryStudy& study);
[[nodiscard]] std::string text_of(const lattice::MemoryStudy& study);
/// Panels of a figure below its others: so high, and drawn from `top` on.
struct MorePanels {
  double height = 0.0;
  std::function<void(Panels& out, double top)> draw{};
};
/// The Chapman-Kolmogorov test: a panel for each way in and each way later, and the implied time
/// scales over the lag. None where it was not asked, or of more ways than panels can be read.
[[nodiscard]] MorePanels panels_of(const lattice::MemoryStudy& study);
/// What the force's hold over crossings does, in two lines.
[[nodiscard]] std::string sentence_of(const lattice::ForceMemory& memory);

}  // namespace gatewalk::cli
