#pragma once
/// What is said of recorded runs.

#include <array>
#include <string>
#include <vector>

#include "cli/render/json_fwd.h"
#include "lattice/cells/cell_matrix.h"
#include "markov/predict.h"

namespace gatewalk::cli {

/// Bodies, trials, passages by what became of them.
[[nodiscard]] Json to_json(const lattice::RunPool& pool);
[[nodiscard]] std::string table_of(const lattice::RunPool& pool);
/// What they cannot tell, a sentence each: few bodies, faces that nobody entered by.
[[nodiscard]] std::vector<std::string> doubts(const lattice::RunPool& pool,
                                              const lattice::Problem& problem);

/// Predictions if all lost bodies had been trapped, and if all had left.
struct LostBounds {
  double lost = 0.0;  // share of all passages
  std::array<markov::FinalDistribution, 2> final;
};
[[nodiscard]] Json to_json(const LostBounds& bounds);
[[nodiscard]] std::string table_of(const LostBounds& bounds);

}  // namespace gatewalk::cli
