// SPDX-License-Identifier: MIT
#pragma once
/// A figure of final gates as observed and by a chain, in rows of maps.

#include <string>
#include <vector>

#include "cli/render/figure.h"
#include "cli/render/memory.h"
#include "cli/render/shown_field.h"
#include "markov/predict.h"

namespace gatewalk::cli {

/// The final gates of the same field, as observed and by a chain.
struct ComparedGates {
  std::string summary;  // a line
  markov::CellProbabilities seen, chain;
};
/// A row of maps for each comparison: observed, by the chain, and the difference; `more` below.
[[nodiscard]] Figure figure_of(const std::vector<ComparedGates>& compared, const std::string& title,
                               const std::string& seen_head, const ShownField& shown,
                               const MorePanels& more = {});

}  // namespace gatewalk::cli
