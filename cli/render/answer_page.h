// SPDX-License-Identifier: MIT
#pragma once
/// The content of the interactive page that --page writes.

#include <optional>
#include <string>
#include <vector>

#include "cli/render/analysis.h"
#include "cli/render/shown_field.h"
#include "cli/render/start.h"
#include "lattice/study/by_start_and_cell.h"

namespace gatewalk::cli {

/// The answer for a start by its own runs (for bins: by its state).
struct PageAnswer {
  std::optional<dynamics::Entry> start;
  const markov::FinalDistribution& final;
  lattice::EndingShares endings;
  std::array<markov::CellProbabilities, 2> gates_95{};  // empty: no intervals
  std::string from;                                     // "chain", "trials" or "matrix"
  double error_95 = 0.0;                                // NaN: not known
  std::int64_t first_runs = 0;
};

/// What the page was made from.
struct PageChain {
  bool has_trees;  // false: bins
  int states;
  std::int64_t gate_runs;
  std::string asked;  // the scene or the file
  bool is_matrix, can_run;
};

struct AnswerPage {
  std::string title;
  const ShownField& shown;
  const lattice::Scene* scene;     // its gates are drawn to scale; null: other cells
  std::vector<PageAnswer> starts;  // at least one; bodies in the cells have the first
  const dynamics::StateSpace& space;
  std::vector<int> faces;  // faces through which bodies may start
  const lattice::StartStates& states;
  const std::vector<lattice::CellAhead>& cells;
  const std::vector<std::array<int, 2>>& moves;  // of CellAhead::next
  PageChain chain;
  const AnalysedField& analysis;  // the page shows parts of it
};

/// Describes the page. Shares are packed by share_code(); `gates_95` adds their intervals. The key
/// "left_out" names what is left out.
void describe(Fields& out, const AnswerPage& page, bool gates_95);

/// A share in 16 bits, with the digits that percents() shows. Up to 10 000: hundredths of a per
/// cent. Above: two digits and a power of ten, for shares that hundredths would show as 0. 65535:
/// NaN.
[[nodiscard]] std::uint16_t share_code(double share);

}  // namespace gatewalk::cli
