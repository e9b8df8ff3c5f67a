#pragma once
/// Fields in stripes (stripes.h), and moves from cell to cell in them.

#include <hwy/aligned_allocator.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <new>
#include <vector>

#include "markov/predict/stencil.h"

namespace gatewalk::markov {

struct Move {
  int di_x, di_y;
};

/// Share `p` of the mass in stripe `source` goes to stripe `target` by a move (its number).
struct Entry {
  int target, move, source;
  double p;
};

/// Entries as groups for push(), in passes without two groups of the same target.
struct Table {
  std::vector<Term> terms;
  std::vector<std::vector<Group>> passes;
  int most_terms = 0;  // of a target

  Table() = default;
  explicit Table(const std::vector<Entry>& entries);
};

struct Range {
  std::ptrdiff_t first, last;
};

/// All passes over all ranges; see push().
void push_all(const Table& table, const Way* ways, std::ptrdiff_t stride, const double* mine,
              const std::vector<Range>& ranges, const double* from, double* to, bool add);

/// Zeros to begin with, from a register boundary on.
class Numbers {
 public:
  explicit Numbers(std::ptrdiff_t count)
      : p_(hwy::AllocateAligned<double>(static_cast<std::size_t>(count))) {
    if (!p_) throw std::bad_alloc();
    std::fill_n(p_.get(), count, 0.0);
  }
  [[nodiscard]] double* data() { return p_.get(); }

 private:
  hwy::AlignedFreeUniquePtr<double[]> p_;
};

/// Fields of equal size, side by side, one per start. With two colours, as on a chessboard, a
/// stripe has only the cells of one: every move leads to the other.
class Board {
 public:
  struct Place {
    std::ptrdiff_t at;
    int colour;
  };

  /// `parities`, one per start: cells with equal column + row + parity have the same colour.
  Board(std::int64_t columns, std::int64_t rows, const std::vector<Move>& moves, int colours,
        const std::vector<std::int64_t>& parities);

  [[nodiscard]] std::ptrdiff_t stride() const { return stride_; }
  [[nodiscard]] int colours() const { return colours_; }
  [[nodiscard]] Place place(std::size_t start, std::int64_t column, std::int64_t row) const {
    const std::ptrdiff_t p = origin_ + row * pitch_ + offsets_[start] + column;
    return {p / colours_, static_cast<int>(p % colours_)};
  }
  /// One per move, from cells of a colour.
  [[nodiscard]] const Way* ways(int colour) const {
    return ways_[static_cast<std::size_t>(colour)].data();
  }
  /// Stays where it is.
  [[nodiscard]] const Way* still(int colour) const {
    return &still_[static_cast<std::size_t>(colour)];
  }

  /// Appends whole registers that hold those columns and rows of all starts, none twice.
  void cover(std::int64_t left, std::int64_t right, std::int64_t bottom, std::int64_t top,
             std::vector<Range>& ranges) const;

 private:
  [[nodiscard]] std::ptrdiff_t way_of(const Move& m) const { return m.di_y * pitch_ + m.di_x; }

  int colours_;
  std::vector<std::ptrdiff_t> offsets_;  // of a start's columns
  std::ptrdiff_t pitch_ = 0;             // from row to row; odd with two colours
  std::ptrdiff_t origin_ = 0, stride_ = 0;
  std::vector<Numbers> masks_;
  std::array<std::vector<Way>, 2> ways_;
  std::array<Way, 2> still_{};
};

}  // namespace gatewalk::markov
