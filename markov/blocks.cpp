// SPDX-License-Identifier: MIT
#include "markov/blocks.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

#include "markov/absorbing.h"
#include "markov/field_states.h"

namespace gatewalk::markov {
namespace {

[[noreturn]] void refuse_blocks(const std::string& what) {
  throw std::invalid_argument("blocks: " + what);
}

std::string size_of(const Field& f) {
  return std::to_string(f.columns) + " x " + std::to_string(f.rows);
}

/// The block that a cell is in, and its place there.
struct Place {
  int block, cell;
};
Place place(int cell, int of) {
  const int block = cell >= 0 ? cell / of : -((-cell + of - 1) / of);
  return {block, cell - block * of};
}

using Key = std::array<int, 3>;  // row and column in the block, state

Key key(const Field& block, const Start& s) {
  return {place(s.row, block.rows).cell, place(s.column, block.columns).cell, s.input};
}

/// All ways into a block, of all types together: from the cells of a block over its border.
std::vector<Start> entries_of(const FieldChain& chain, const Field& block,
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

/// One block as a cell: its chances of each way out, from each way in.
Chain block_chain(const std::vector<Chain>& chains, const Field& block,
                  const std::vector<int>& types, const std::vector<Start>& entries,
                  const std::map<Key, int>& input_of) {
  const FieldChain cells = FieldChain::by_cell(chains, block.columns, types);
  const FieldStates f = field_states(cells, block, entries);
  const Dense<double> chances = end_chances(absorbing_chain<double>(f), std::ssize(entries));
  std::vector<Exit> exits{Exit{}};  // trapped
  std::map<Key, int> known;         // an exit's number, by what it is
  std::vector<int> output_of;       // of each end; -1: never sampled
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
    if (!cells.at(entry.column, entry.row).is_sampled(entry.input)) continue;  // nor is the block
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

}  // namespace

Field BlockField::field(const Field& cells) const {
  if (cells.columns % block.columns != 0 || cells.rows % block.rows != 0)
    refuse_blocks(size_of(cells) + " cells are not whole blocks of " + size_of(block));
  return {cells.columns / block.columns, cells.rows / block.rows};
}

Start BlockField::start(const Start& in_cells) const {
  const Place column = place(in_cells.column, block.columns), row = place(in_cells.row, block.rows);
  const auto entry = std::find_if(entries.begin(), entries.end(), [&](const Start& e) {
    return e.column == column.cell && e.row == row.cell && e.input == in_cells.input;
  });
  if (entry == entries.end())
    refuse_blocks("input " + std::to_string(in_cells.input) + " of cell (" +
                  std::to_string(in_cells.column) + ", " + std::to_string(in_cells.row) +
                  ") is no way into a block; give it as a start");
  return {column.block, row.block, static_cast<int>(entry - entries.begin())};
}

BlockField block_field(const FieldChain& chain, const Field& block,
                       const std::vector<Start>& starts) {
  if (block.columns < 1 || block.rows < 1) refuse_blocks("a block of " + size_of(block) + " cells");
  if (chain.columns() % block.columns != 0 || chain.rows() % block.rows != 0)
    refuse_blocks("types of " + std::to_string(chain.columns()) + " columns and " +
                  std::to_string(chain.rows()) + " rows (0: any) do not fill blocks of " +
                  size_of(block) + " cells");
  for (const Start& s : starts)
    if (s.input < 0 || s.input >= chain.inputs() || s.column < 0 || s.row < 0)
      refuse_blocks("a start lies outside the field, or has none of the " +
                    std::to_string(chain.inputs()) + " states");
  const std::vector<Start> entries = entries_of(chain, block, starts);
  if (std::ssize(entries) > kMostDenseStates)
    refuse_blocks(std::to_string(entries.size()) + " ways into a block of " + size_of(block) +
                  " cells; at most " + std::to_string(kMostDenseStates) + " are possible");
  if (entries.empty()) refuse_blocks("no move leads out of a cell, and no start is given");
  std::map<Key, int> input_of;
  for (std::size_t i = 0; i < entries.size(); ++i)
    input_of[key(block, entries[i])] = static_cast<int>(i);

  std::vector<Chain> chains;
  std::map<std::vector<int>, int> known;  // by the types of a block's cells
  std::vector<int> types;                 // of blocks
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
        chains.push_back(block_chain(chain.chains(), block, it->first, entries, input_of));
      types.push_back(it->second);
    }
  const auto of_blocks = [&]() -> FieldChain {
    if (chain.rows() == 0) return chains.front();
    if (chain.columns() == 0) return FieldChain::by_row(std::move(chains), std::move(types));
    return FieldChain::by_cell(std::move(chains), static_cast<int>(columns), std::move(types));
  };
  return {of_blocks(), block, entries};
}

}  // namespace gatewalk::markov
