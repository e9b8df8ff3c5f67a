// SPDX-License-Identifier: MIT
#pragma once
/// Monte Carlo walks, as in the paper's "Markov Chain Monte Carlo" pseudo-code: one draw per cell
/// from the row of Eq. (16)'s matrix.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "markov/ends.h"

namespace gatewalk::markov {

/// The walks numbered first, first + 1, ..., first + count - 1. The number names a walk, so any
/// split over calls, threads or machines gives the same walks.
struct WalkRange {
  std::int64_t first = 0;
  std::int64_t count = 0;
};

/// How walks ended. The sum of all endings is walks - still_walking.
struct WalkTally : Ends<std::int64_t> {
  std::int64_t walks = 0;
  std::int64_t still_walking = 0;  // without a limit: not ended within kMostCells cells
  std::int64_t steps = 0;          // draws of all walks
  /// Adds other walks. Throws std::invalid_argument if both have cells and their fields differ.
  WalkTally& operator+=(const WalkTally& other);
};

/// The second word of the key for walks. Walk w under `seed` draws from Philox4x64-10 with key
/// {seed, kWalkStream} and counter {block, w, start input, 0}: four words per block, one word per
/// draw. Other users of the same seed take another second word, so no two share a stream.
inline constexpr std::uint64_t kWalkStream = 0x77616c6b'00000001;  // "walk", version 1

/// Draws walks from a chain by Walker's alias method (Vose's construction) with one table per row.
/// Tables are integers: each probability is exact to a few parts in 2^64, except that the row's
/// largest entry takes what the row's sum lacks from 1 (rounding, at most 1e-12).
class Walker {
 public:
  /// The number of cells after which a walk without a limit is stopped.
  static constexpr int kMostCells = 1'000'000;

  /// Builds the alias tables of the chain's rows.
  explicit Walker(const FieldChain& chain);

  /// Draws an output of `row` from a uniform 64-bit word; outputs of probability zero are never
  /// drawn. With several types of cells, rows and outputs of all types are numbered consecutively.
  [[nodiscard]] int draw(int row, std::uint64_t word) const;

  /// Runs the walks of `range` (numbers >= 0) on all threads of the current TBB arena, many at once
  /// in vector registers (Google Highway). A walk visits at most `max_cells` cells; 0 means no
  /// limit, and a walk is then `still_walking` after kMostCells cells. The walks are the same for
  /// any number of threads and any instruction set.
  ///
  /// `final_cell_of_walk`, if given, receives row * columns + column of each walk's last cell, also
  /// for walks still going on. Chains with an exit of 512 cells or more or with 2^21 nonzeros or
  /// more, and fields with several types of cells, do not use vector registers.
  [[nodiscard]] WalkTally walk(const Field& field, const Start& start, int max_cells,
                               std::uint64_t seed, WalkRange range,
                               std::vector<std::int32_t>* final_cell_of_walk = nullptr) const;

  /// Runs the same walks one after the other: the plain reference for walk().
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

  Chain chain_;                      // of all types of cells, one after the other
  std::optional<FieldChain> types_;  // types of the cells, if there are several
  // Slots: one per nonzero in the order of the matrix, plus one for all unsampled rows (in lanes).
  std::vector<std::uint64_t> keep_;    // (slots) words up to this one draw the first output
  std::vector<std::int32_t> outputs_;  // (slots x 2) the first and the second output
  std::vector<std::uint64_t> moves_;   // (slots x 2) packed outputs; empty if they do not fit
};

}  // namespace gatewalk::markov
