// SPDX-License-Identifier: MIT
#pragma once
/// What the page of an answer holds: gatewalk predict --page.

#include <optional>
#include <string>
#include <vector>

#include "cli/render/analysis.h"
#include "cli/render/shown_field.h"
#include "cli/render/start.h"
#include "lattice/study/by_start_and_cell.h"

namespace gatewalk::cli {

/// What is told of one start by its own runs (of bins: by its state).
struct PageAnswer {
  std::optional<dynamics::Entry> start;
  const markov::FinalDistribution& final;
  lattice::EndingShares endings;
  std::array<markov::CellProbabilities, 2> gates_95{};  // without intervals: empty
  std::string from;                                     // "chain", "trials", "matrix"
  double error_95 = 0.0;                                // NaN: not known
  std::int64_t first_runs = 0;
};

/// What the page was made from.
struct PageChain {
  bool has_trees;  // else bins
  int states;
  std::int64_t gate_runs;
  std::string asked;  // the scene or the file
  bool is_matrix, can_run;
};

struct AnswerPage {
  std::string title;
  const ShownField& shown;
  const lattice::Scene* scene;     // whose gates are drawn to scale; null: other cells
  std::vector<PageAnswer> starts;  // one at least; the cells' bodies have the first one
  const dynamics::StateSpace& space;
  std::vector<int> faces;  // through which starts may be
  const lattice::StartStates& states;
  const std::vector<lattice::CellAhead>& cells;
  const std::vector<std::array<int, 2>>& moves;  // of the cells' `next`
  PageChain chain;
  const AnalysedField& analysis;  // of which the page shows parts
};

/// Shares are packed as the digits that are shown (share_code), beside `gates_95` with their
/// intervals; what is left out `left_out` says.
void describe(Fields& out, const AnswerPage& page, bool gates_95);

/// A share as percents() shows it in 16 bits: hundredths of a per cent; above 10 000 two digits and
/// a power of ten, where these would be 0; 65535: not a number.
[[nodiscard]] std::uint16_t share_code(double share);

}  // namespace gatewalk::cli
