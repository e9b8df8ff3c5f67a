// SPDX-License-Identifier: MIT
#pragma once
/// Is it Markov? Tests of what trials of the full dynamics remember, as a result and in words.

#include <functional>
#include <string>

#include "cli/fields/fields.h"
#include "cli/render/panel.h"
#include "lattice/study/memory.h"

namespace gatewalk::cli {

/// The keys of one of several statistics that were tested together.
void describe(Fields& out, const lattice::MultipleTests::Test& test);

/// Every question with its p-values, statistics, effect size and power, and the "verdict" on all.
void describe(Fields& out, const lattice::MemoryStudy& study);
void describe(Fields& out, const lattice::ForceMemory& memory);

/// The answer to all questions in a line; and the answer to each question.
[[nodiscard]] std::string sentence_of(const lattice::MemoryStudy& study);
[[nodiscard]] std::string text_of(const lattice::MemoryStudy& study);
/// Further panels below a figure's own: their height, and a function that draws them from `top` on.
struct MorePanels {
  double height = 0.0;
  std::function<void(Panels& out, double top)> draw{};
};
/// Panels of the Chapman-Kolmogorov test, one for each pair of an entry face and a later face, and
/// the implied time scales over the lag. No panels without the test, or with too many faces to be
/// readable.
[[nodiscard]] MorePanels panels_of(const lattice::MemoryStudy& study);
/// Two lines on the effect of the random force being held across a crossing.
[[nodiscard]] std::string sentence_of(const lattice::ForceMemory& memory);

}  // namespace gatewalk::cli
