// SPDX-License-Identifier: MIT
#pragma once
/// Blocks of cells as the cells of a coarser field. The chain over blocks is as exact as the chain
/// over cells, and all solvers accept it: a second route to every prediction without a limit.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "markov/predict.h"
#include "tests/support/field_states.h"

namespace gatewalk::markov {

/// A field in blocks. An input of a block is one of its cells with the state in which a walk enters
/// that cell from outside. Its outputs lead to inputs of other blocks, or the walk is trapped in
/// one of the block's cells. Without a limit of cells, walks leave over the same edges and are
/// trapped as often as over cells; a final cell becomes its block, and a step a visit of a block.
struct BlockField {
  FieldChain chain;            // of blocks
  Field block;                 // cells of one block
  std::vector<Start> entries;  // by input of a block: cell in the block, and state

  /// The field in blocks. Throws std::invalid_argument unless `cells` are whole blocks.
  [[nodiscard]] Field field(const Field& cells) const;
  /// A start in blocks. Throws std::invalid_argument if it is not one of the entries.
  [[nodiscard]] Start start(const Start& in_cells) const;
};

namespace whole_blocks {

[[noreturn]] inline void refuse_blocks(const std::string& what) {
  throw std::invalid_argument("blocks: " + what);
}

inline std::string size_of(const Field& f) {
  return std::to_string(f.columns) + " x " + std::to_string(f.rows);
}

/// The block that contains a cell, and the cell's index in the block.
struct Place {
  int block, cell;
};
inline Place place(int cell, int of) {
  const int block = cell >= 0 ? cell / of : -((-cell + of - 1) / of);
  return {block, cell - block * of};
}

using Key = std::array<int, 3>;  // row and column in the block, state

inline Key key(const Field& block, const Start& s) {
  return {place(s.row, block.rows).cell, place(s.column, block.columns).cell, s.input};
}

/// All ways of entering a block, for all types together: from the cells of a block over its border.
inline std::vector<Start> entries_of(const FieldChain& chain, const Field& block,
                                     const std::vector<Start>& starts) {
  std::set<Key> moves;  // di_y, di_x, state
  for (const Chain& c : chain.chains())
    for (Eigen::Index k = 0; k < c.matrix().nonZeros(); ++k) {
      const Exit& exit = c.exits()[static_cast<std::size_t>(c.matrix().innerIndexPtr()[k])];
      if (exit.next_input != Exit::kTrapped) moves.insert({exit.di_y, exit.di_x, exit.next_input});
    }
  std::set<Key> keys;
  for (const Start& s : starts) keys.insert(key(block, s));
  for (int row = 0; row < block.rows; ++row)
    for (int column = 0; column < block.columns; ++column)
      for (const auto& [di_y, di_x, input] : moves) {
        const Start to{column + di_x, row + di_y, input};
        if (place(to.column, block.columns).block != 0 || place(to.row, block.rows).block != 0)
          keys.insert(key(block, to));
      }
  std::vector<Start> entries;
  for (const auto& [row, column, input] : keys) entries.push_back({column, row, input});
  return entries;
}

/// A block as a cell: the probability of each exit, by entry.
inline Chain block_chain(const std::vector<Chain>& chains, const Field& block,
                         const std::vector<int>& types, const std::vector<Start>& entries,
                         const std::map<Key, int>& input_of) {
  const FieldChain cells = FieldChain::by_cell(chains, block.columns, types);
  const FieldStates f = field_states(cells, block, entries);
  const Dense<double> chances = end_chances(absorbing_chain<double>(f), std::ssize(entries));
  std::vector<Exit> exits{Exit{}};  // trapped
  std::map<Key, int> known;         // an exit's number, by its properties
  std::vector<int> output_of;       // by end; -1: never sampled
  for (const FieldStates::End& end : f.ends) {
    if (end.why == Ending::trapped || end.why == Ending::unsampled) {
      output_of.push_back(end.why == Ending::trapped ? 0 : -1);
      continue;
    }
    const Exit exit{input_of.at(key(block, end.beyond)),
                    place(end.beyond.column, block.columns).block,
                    place(end.beyond.row, block.rows).block};
    const auto [it, is_new] =
        known.try_emplace({exit.next_input, exit.di_x, exit.di_y}, static_cast<int>(exits.size()));
    if (is_new) exits.push_back(exit);
    output_of.push_back(it->second);
  }
  std::vector<Eigen::Triplet<double>> p;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const Start& entry = entries[i];
    /// then the block is not sampled either
    if (!cells.at(entry.column, entry.row).is_sampled(entry.input)) continue;
    for (std::size_t e = 0; e < f.ends.size(); ++e) {
      const double chance = chances(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(e));
      if (chance == 0.0) continue;
      if (output_of[e] < 0)
        refuse_blocks("walks get into a state never sampled within a block of " + size_of(block) +
                      " cells");
      p.emplace_back(static_cast<int>(i), output_of[e], chance);
    }
  }
  Probabilities matrix(std::ssize(entries), std::ssize(exits));
  matrix.setFromTriplets(p.begin(), p.end());
  return Chain::from_probabilities(std::move(matrix), std::move(exits));
}

}  // namespace whole_blocks

inline Field BlockField::field(const Field& cells) const {
  if (cells.columns % block.columns != 0 || cells.rows % block.rows != 0)
    whole_blocks::refuse_blocks(whole_blocks::size_of(cells) + " cells are not whole blocks of " +
                                whole_blocks::size_of(block));
  return {cells.columns / block.columns, cells.rows / block.rows};
}

inline Start BlockField::start(const Start& in_cells) const {
  const whole_blocks::Place column = whole_blocks::place(in_cells.column, block.columns),
                            row = whole_blocks::place(in_cells.row, block.rows);
  const auto entry = std::find_if(entries.begin(), entries.end(), [&](const Start& e) {
    return e.column == column.cell && e.row == row.cell && e.input == in_cells.input;
  });
  if (entry == entries.end())
    whole_blocks::refuse_blocks(
        "input " + std::to_string(in_cells.input) + " of cell (" + std::to_string(in_cells.column) +
        ", " + std::to_string(in_cells.row) + ") is no way into a block; give it as a start");
  return {column.block, row.block, static_cast<int>(entry - entries.begin())};
}

/// Builds the field in blocks. Each pattern of types that fills a block is solved once by dense
/// elimination (tests/support/absorbing.h), so a periodic terrain costs one pattern. `starts`, in
/// cells, become entries too, so that walks may begin within blocks and in states that no exit
/// leads to. For blocks of blocks, call it again with the chain of blocks. Throws
/// std::invalid_argument if cells of several types do not fill whole blocks, if more than
/// kMostDenseStates (field_states.h) states of a block are reached, or if some walk in a block
/// never ends or enters a state that was never sampled.
inline BlockField block_field(const FieldChain& chain, const Field& block,
                              const std::vector<Start>& starts = {}) {
  if (block.columns < 1 || block.rows < 1)
    whole_blocks::refuse_blocks("a block of " + whole_blocks::size_of(block) + " cells");
  if (chain.columns() % block.columns != 0 || chain.rows() % block.rows != 0)
    whole_blocks::refuse_blocks("types of " + std::to_string(chain.columns()) + " columns and " +
                                std::to_string(chain.rows()) +
                                " rows (0: any) do not fill blocks of " +
                                whole_blocks::size_of(block) + " cells");
  for (const Start& s : starts)
    if (s.input < 0 || s.input >= chain.inputs() || s.column < 0 || s.row < 0)
      whole_blocks::refuse_blocks("a start lies outside the field, or has none of the " +
                                  std::to_string(chain.inputs()) + " states");
  const std::vector<Start> entries = whole_blocks::entries_of(chain, block, starts);
  if (std::ssize(entries) > kMostDenseStates)
    whole_blocks::refuse_blocks(std::to_string(entries.size()) + " ways into a block of " +
                                whole_blocks::size_of(block) + " cells; at most " +
                                std::to_string(kMostDenseStates) + " are possible");
  if (entries.empty())
    whole_blocks::refuse_blocks("no move leads out of a cell, and no start is given");
  std::map<whole_blocks::Key, int> input_of;
  for (std::size_t i = 0; i < entries.size(); ++i)
    input_of[whole_blocks::key(block, entries[i])] = static_cast<int>(i);

  std::vector<Chain> chains;
  std::map<std::vector<int>, int> known;  // by the types of a block's cells
  std::vector<int> types;                 // by block
  const std::int64_t columns = std::max<std::int64_t>(1, chain.columns() / block.columns);
  const std::int64_t rows = std::max<std::int64_t>(1, chain.rows() / block.rows);
  for (std::int64_t block_row = 0; block_row < rows; ++block_row)
    for (std::int64_t block_column = 0; block_column < columns; ++block_column) {
      std::vector<int> pattern;
      for (std::int64_t row = 0; row < block.rows; ++row)
        for (std::int64_t column = 0; column < block.columns; ++column)
          pattern.push_back(
              chain.type_of(block_column * block.columns + column, block_row * block.rows + row));
      const auto [it, is_new] =
          known.try_emplace(std::move(pattern), static_cast<int>(chains.size()));
      if (is_new)
        chains.push_back(
            whole_blocks::block_chain(chain.chains(), block, it->first, entries, input_of));
      types.push_back(it->second);
    }
  const auto of_blocks = [&]() -> FieldChain {
    if (chain.rows() == 0) return chains.front();
    if (chain.columns() == 0) return FieldChain::by_row(std::move(chains), std::move(types));
    return FieldChain::by_cell(std::move(chains), static_cast<int>(columns), std::move(types));
  };
  return {of_blocks(), block, entries};
}

namespace test {

/// A field of `cells` filled with a pattern of types, `block.columns` wide and `block.rows` high.
inline FieldChain repeated(std::vector<Chain> chains, const Field& block,
                           const std::vector<int>& pattern, const Field& cells) {
  std::vector<int> types;
  for (int row = 0; row < cells.rows; ++row)
    for (int column = 0; column < cells.columns; ++column)
      types.push_back(pattern[static_cast<std::size_t>(row % block.rows * block.columns +
                                                       column % block.columns)]);
  return FieldChain::by_cell(std::move(chains), cells.columns, std::move(types));
}

/// Compares endings, and the shares of cells summed by block.
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

}  // namespace test
}  // namespace gatewalk::markov
