// SPDX-License-Identifier: MIT
#pragma once
/// Where the cells of a field lie in planes (stencil.h), and the stencils that move mass between
/// them.

#include <hwy/aligned_allocator.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <new>
#include <vector>

#include "markov/predict/stencil.h"

namespace gatewalk::markov {

/// The nearest multiple of kLanes that is not above, not below.
constexpr std::ptrdiff_t lanes_down(std::ptrdiff_t x) { return x / kLanes * kLanes; }
constexpr std::ptrdiff_t lanes_up(std::ptrdiff_t x) { return lanes_down(x + kLanes - 1); }

struct Move {
  int di_x, di_y;
};

/// Share `p` of the mass in plane `source` goes to plane `target` by a move (its number).
struct Entry {
  int target, move, source;
  double p;
};

/// What a cell passes on, and where to: entries as groups for apply_pass(), in passes without two
/// groups of the same target.
struct Stencil {
  std::vector<Term> terms;
  std::vector<std::vector<Group>> passes;
  int most_terms = 0;  // of a target

  Stencil() = default;
  explicit Stencil(const std::vector<Entry>& entries);
};

/// All passes of the stencil over all ranges; see apply_pass().
void apply_stencil(const Stencil& stencil, const Shift* shifts, std::ptrdiff_t stride,
                   const double* source_mask, const std::vector<Range>& ranges, const double* from,
                   double* to, bool add);

/// Some planes of a PlaneBuffer.
class Planes {
 public:
  Planes() = default;
  Planes(double* first, std::ptrdiff_t size) : p_(first), size_(size) {}
  [[nodiscard]] double* data() const { return p_; }
  [[nodiscard]] std::ptrdiff_t size() const { return size_; }  // numbers
  void clear() const { std::fill_n(p_, size_, 0.0); }

 private:
  double* p_ = nullptr;
  std::ptrdiff_t size_ = 0;
};

/// Numbers are read from all over a large buffer, which small pages make a fifth slower.
void ask_for_large_pages(double* first, std::ptrdiff_t count);

/// The memory of planes, all numbers zero to begin with, from a register boundary on. One piece: to
/// allocate its parts one by one makes a small prediction three times as long (the allocator gives
/// the pages back each time, and they are faulted in again).
class PlaneBuffer {
 public:
  PlaneBuffer() = default;
  PlaneBuffer(std::ptrdiff_t count, std::ptrdiff_t stride) { reset(count, stride); }
  /// Other planes in the same memory, if it is large enough.
  void reset(std::ptrdiff_t count, std::ptrdiff_t stride) {
    std::fill_n(reserve(count * stride), count * stride, 0.0);
    stride_ = stride;
    taken_ = 0;
  }
  /// Room for so many numbers, not set. What was there before is forgotten.
  [[nodiscard]] double* reserve(std::ptrdiff_t numbers) {
    if (numbers > size_) {
      size_ = 0;
      p_ = nullptr;
      p_ = hwy::AllocateAligned<double>(static_cast<std::size_t>(numbers));
      if (!p_) throw std::bad_alloc();
      size_ = numbers;
      ask_for_large_pages(p_.get(), size_);
    }
    return p_.get();
  }
  /// The next `count` planes; not more in all than the buffer has.
  [[nodiscard]] Planes take(std::ptrdiff_t count) {
    double* const first = p_.get() + taken_ * stride_;
    taken_ += count;
    return {first, count * stride_};
  }

 private:
  hwy::AlignedFreeUniquePtr<double[]> p_;
  std::ptrdiff_t size_ = 0, stride_ = 0, taken_ = 0;
};

/// Places of the cells of several fields of equal size, side by side, one field per start. With two
/// colours, as on a chessboard, a plane holds only the cells of one: every move leads to the other.
class Layout {
 public:
  struct Place {
    std::ptrdiff_t at;
    int colour;
  };

  /// `parities`, one per start: cells with equal column + row + parity have the same colour.
  Layout(std::int64_t columns, std::int64_t rows, const std::vector<Move>& moves, int colours,
         const std::vector<std::int64_t>& parities);

  [[nodiscard]] std::ptrdiff_t stride() const { return stride_; }
  [[nodiscard]] int colours() const { return colours_; }
  [[nodiscard]] Place place(std::size_t start, std::int64_t column, std::int64_t row) const {
    const std::ptrdiff_t p = origin_ + row * pitch_ + offsets_[start] + column;
    return {p / colours_, static_cast<int>(p % colours_)};
  }
  /// One shift per move, from cells of a colour.
  [[nodiscard]] const Shift* shifts(int colour) const {
    return shifts_[static_cast<std::size_t>(colour)].data();
  }
  /// The shift of a tally: each number stays in its cell (offset 0, mask 1 in every cell).
  [[nodiscard]] const Shift* identity(int colour) const {
    return &identity_[static_cast<std::size_t>(colour)];
  }

  /// Appends whole registers that hold those columns and rows of all starts, none twice.
  void cover(std::int64_t left, std::int64_t right, std::int64_t bottom, std::int64_t top,
             std::vector<Range>& ranges) const;

 private:
  [[nodiscard]] std::ptrdiff_t offset_of(const Move& m) const { return m.di_y * pitch_ + m.di_x; }

  int colours_;
  std::vector<std::ptrdiff_t> offsets_;  // of a start's columns
  std::ptrdiff_t pitch_ = 0;             // from row to row; odd with two colours
  std::ptrdiff_t origin_ = 0, stride_ = 0;
  std::vector<PlaneBuffer> masks_;
  std::array<std::vector<Shift>, 2> shifts_;
  std::array<Shift, 2> identity_{};
};

}  // namespace gatewalk::markov
