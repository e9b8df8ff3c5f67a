// SPDX-License-Identifier: MIT
#pragma once
/// Monte Carlo walks: what the paper's "Markov Chain Monte Carlo" pseudo-code does, per cell one
/// draw from the row of Eq. (16)'s matrix.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "markov/ends.h"

namespace gatewalk::markov {

/// Walks first, first + 1, ... first + count - 1: a walk is named by its number, so any split over
/// calls, threads or machines gives the same walks.
struct WalkRange {
  std::int64_t first = 0;
  std::int64_t count = 0;
};

/// How walks ended, all but those still walking: the sum of all endings is walks - still_walking.
struct WalkTally : Ends<std::int64_t> {
  std::int64_t walks = 0;
  std::int64_t still_walking = 0;  // without max_cells: followed for kMostCells cells, not ended
  std::int64_t steps = 0;          // draws over all walks
  /// Throws std::invalid_argument if both have cells, of different fields.
  WalkTally& operator+=(const WalkTally& other);
};

/// Walk w under `seed` draws from Philox4x64-10 with key {seed, kWalkStream} and counter
/// {block, w, start input, 0}: four words a block, one word a draw. Other users of the same seed
/// take another second key word, so no two ever share a stream.
inline constexpr std::uint64_t kWalkStream = 0x77616c6b'00000001;  // "walk", version 1

/// Draws from the rows of a chain: Walker's alias method (Vose's construction), one table per row,
/// built in integers: each probability is met to a few words of 2^64, except that what a row lacks
/// from 1 (rounding, at most 1e-12) goes to its largest entry.
class Walker {
 public:
  /// Where the field has no limit, a walk is followed through no more cells than this.
  static constexpr int kMostCells = 1'000'000;

  explicit Walker(const FieldChain& chain);

  /// An output of `row` for a uniform 64-bit word; never one of probability zero. Rows and outputs
  /// of several types of cells are numbered one behind the other.
  [[nodiscard]] int draw(int row, std::uint64_t word) const;

  /// Runs `range` (from 0 up) on all threads of the current TBB arena, many walks at once in vector
  /// registers (Google Highway). At most `max_cells` cells are visited (0: no limit of the field;
  /// then a walk is followed through kMostCells, and is `still_walking`). Same walks for any number
  /// of threads and any instruction set. `final_cell_of_walk`, if given, gets row * columns +
  /// column per walk, also of those still walking: where they were stopped. Chains with an exit of
  /// 512 cells or more, or with 2^21 nonzeros or more, and fields with cells of several types are
  /// walked plainly.
  [[nodiscard]] WalkTally walk(const Field& field, const Start& start, int max_cells,
                               std::uint64_t seed, WalkRange range,
                               std::vector<std::int32_t>* final_cell_of_walk = nullptr) const;

  /// The same walks, one after the other: the plain reference.
  [[nodiscard]] WalkTally walk_plainly(
      const Field& field, const Start& start, int max_cells, std::uint64_t seed, WalkRange range,
      std::vector<std::int32_t>* final_cell_of_walk = nullptr) const;

  /// Whether walk() uses vector registers.
  [[nodiscard]] bool walks_in_lanes() const { return !moves_.empty(); }

 private:
  struct Job;
  struct Counters;
  [[nodiscard]] WalkTally run(bool in_lanes, const Field& field, const Start& start, int max_cells,
                              std::uint64_t seed, WalkRange range,
                              std::vector<std::int32_t>* final_cell_of_walk) const;
  [[nodiscard]] WalkTally run(bool in_lanes, const Job& job) const;
  void walk_plainly(const Job& job, std::int64_t first, std::int64_t last,
                    Counters& counters) const;
  void walk_in_lanes(const Job& job, std::int64_t first, std::int64_t last,
                     Counters& counters) const;
  [[nodiscard]] std::int32_t pick(int row, std::uint64_t word) const;
  [[nodiscard]] std::uint64_t packed(const Exit& exit) const;

  Chain chain_;                      // of all types of cells, one behind the other
  std::optional<FieldChain> types_;  // which cell has which, if there are several
  // Slots: one per nonzero, in the order of the matrix, and one more for all unsampled rows in
  // lanes.
  std::vector<std::uint64_t> keep_;    // (slots) the first output, up to here within the slot
  std::vector<std::int32_t> outputs_;  // (slots x 2) else the second
  std::vector<std::uint64_t>
      moves_;  // (slots x 2) outputs packed for lanes; empty if that cannot be
};

}  // namespace gatewalk::markov
