// SPDX-License-Identifier: MIT
#pragma once
/// Blocks beside their cells.

#include <gtest/gtest.h>

#include <vector>

#include "markov/predict.h"

namespace gatewalk::markov::test {

/// A field of `cells` filled with one pattern of types, `block.columns` wide and `block.rows` high.
inline FieldChain repeated(std::vector<Chain> chains, const Field& block,
                           const std::vector<int>& pattern, const Field& cells) {
  std::vector<int> types;
  for (int row = 0; row < cells.rows; ++row)
    for (int column = 0; column < cells.columns; ++column)
      types.push_back(pattern[static_cast<std::size_t>(row % block.rows * block.columns +
                                                       column % block.columns)]);
  return FieldChain::by_cell(std::move(chains), cells.columns, std::move(types));
}

/// Endings, and shares of cells added by block.
inline void expect_same_in_blocks(const FinalDistribution& fine, const FinalDistribution& coarse,
                                  const Field& block, double bound) {
  for (std::size_t e = 0; e < kEndings; ++e)
    EXPECT_NEAR(fine.endings[e], coarse.endings[e], bound) << "ending " << e;
  CellProbabilities added =
      CellProbabilities::Zero(coarse.final_cells.rows(), coarse.final_cells.cols());
  for (Eigen::Index row = 0; row < fine.final_cells.rows(); ++row)
    for (Eigen::Index column = 0; column < fine.final_cells.cols(); ++column)
      added(row / block.rows, column / block.columns) += fine.final_cells(row, column);
  EXPECT_LE((added - coarse.final_cells).abs().sum(), bound);
}

}  // namespace gatewalk::markov::test
