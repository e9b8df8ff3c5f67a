// SPDX-License-Identifier: MIT
#pragma once
/// Blocks of cells as the cells of a coarser field: a chain over blocks that is as exact as the one
/// over cells, and that all solvers take as it is.

#include <vector>

#include "markov/chain.h"

namespace gatewalk::markov {

/// An input of a block is a cell of it and the state in which a walk enters that cell from outside;
/// its outputs lead to the inputs of other blocks, or it is trapped in one of its cells. Walks
/// without limit of cells end over the same edges and as often trapped as over cells; a final cell
/// becomes its block, and a step a visit of a block.
struct BlockField {
  FieldChain chain;            // of blocks
  Field block;                 // cells of one
  std::vector<Start> entries;  // by input of a block: cell in the block, and state

  /// The field in blocks. Throws std::invalid_argument unless `cells` are whole blocks.
  [[nodiscard]] Field field(const Field& cells) const;
  /// A start in blocks. Throws std::invalid_argument if it is none of the entries.
  [[nodiscard]] Start start(const Start& in_cells) const;
};

/// Each pattern of types that fills a block is solved once by dense elimination (absorbing.h), so a
/// terrain that repeats itself costs one pattern. `starts`, in cells, become entries too: walks may
/// begin within blocks and in states that no exit leads to. Blocks of blocks: call it again with
/// the chain of blocks. Throws std::invalid_argument if cells of several types do not fill whole
/// blocks, more than kMostDenseStates (field_states.h) states of a block are reached, some walk in
/// a block never ends, or one gets into a state never sampled.
[[nodiscard]] BlockField block_field(const FieldChain& chain, const Field& block,
                                     const std::vector<Start>& starts = {});

}  // namespace gatewalk::markov
