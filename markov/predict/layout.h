// SPDX-License-Identifier: MIT
#pragma once
/// The layout of a field's cells in planes (stencil.h), and the stencils that move mass between
/// cells.

#include <hwy/aligned_allocator.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <new>
#include <vector>

#include "markov/predict/stencil.h"

namespace gatewalk::markov {

/// The nearest multiple of kLanes that is not above x (down) or not below x (up).
constexpr std::ptrdiff_t lanes_down(std::ptrdiff_t x) { return x / kLanes * kLanes; }
constexpr std::ptrdiff_t lanes_up(std::ptrdiff_t x) { return lanes_down(x + kLanes - 1); }

struct Move {
  int di_x, di_y;
};

/// A transition: the share `p` of the mass in plane `source` goes to plane `target` by move number
/// `move`.
struct Entry {
  int target, move, source;
  double p;
};

/// The transitions of a cell as groups for apply_pass(), in passes without two groups of the same
/// target.
struct Stencil {
  std::vector<Term> terms;
  std::vector<std::vector<Group>> passes;
  int most_terms = 0;  // largest number of terms of a target

  Stencil() = default;
  explicit Stencil(const std::vector<Entry>& entries);
};

/// Applies all passes of the stencil to all ranges; see apply_pass().
void apply_stencil(const Stencil& stencil, const Shift* shifts, std::ptrdiff_t stride,
                   const double* source_mask, const std::vector<Range>& ranges, const double* from,
                   double* to, bool add);

/// A part of a PlaneBuffer: some planes.
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

/// Asks the system for large pages: scattered reads from a large buffer are a fifth slower with
/// small ones.
void ask_for_large_pages(double* first, std::ptrdiff_t count);

/// The memory of planes, aligned to registers and initially zero. It is one allocation, because
/// separate allocations make a small prediction three times as long: the allocator returns pages
/// each time, and they are faulted in again.
class PlaneBuffer {
 public:
  PlaneBuffer() = default;
  PlaneBuffer(std::ptrdiff_t count, std::ptrdiff_t stride) { reset(count, stride); }
  /// Replaces the planes by others, in the same memory if it is large enough.
  void reset(std::ptrdiff_t count, std::ptrdiff_t stride) {
    std::fill_n(reserve(count * stride), count * stride, 0.0);
    stride_ = stride;
    taken_ = 0;
  }
  /// Room for `numbers` uninitialised numbers. Earlier content is lost.
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
  /// The next `count` planes. All calls together must not take more planes than the buffer has.
  [[nodiscard]] Planes take(std::ptrdiff_t count) {
    double* const first = p_.get() + taken_ * stride_;
    taken_ += count;
    return {first, count * stride_};
  }

 private:
  hwy::AlignedFreeUniquePtr<double[]> p_;
  std::ptrdiff_t size_ = 0, stride_ = 0, taken_ = 0;
};

/// The places of cells of several fields of equal size side by side, one field per start. With two
/// colours, as on a chessboard, a plane holds the cells of one colour: every move leads to the
/// other.
class Layout {
 public:
  struct Place {
    std::ptrdiff_t at;
    int colour;
  };

  /// Lays out the cells. `parities`, one per start: cells with equal column + row + parity have the
  /// same colour.
  Layout(std::int64_t columns, std::int64_t rows, const std::vector<Move>& moves, int colours,
         const std::vector<std::int64_t>& parities);

  [[nodiscard]] std::ptrdiff_t stride() const { return stride_; }
  [[nodiscard]] int colours() const { return colours_; }
  [[nodiscard]] Place place(std::size_t start, std::int64_t column, std::int64_t row) const {
    const std::ptrdiff_t p = origin_ + row * pitch_ + offsets_[start] + column;
    return {p / colours_, static_cast<int>(p % colours_)};
  }
  /// The shifts of all moves, from cells of a colour.
  [[nodiscard]] const Shift* shifts(int colour) const {
    return shifts_[static_cast<std::size_t>(colour)].data();
  }
  /// The identity shift for tallies: each number stays in its cell (offset 0, mask 1 in every
  /// cell).
  [[nodiscard]] const Shift* identity(int colour) const {
    return &identity_[static_cast<std::size_t>(colour)];
  }

  /// Appends ranges of whole registers that hold these columns and rows of all starts, without
  /// overlap.
  void cover(std::int64_t left, std::int64_t right, std::int64_t bottom, std::int64_t top,
             std::vector<Range>& ranges) const;

 private:
  [[nodiscard]] std::ptrdiff_t offset_of(const Move& m) const { return m.di_y * pitch_ + m.di_x; }

  int colours_;
  std::vector<std::ptrdiff_t> offsets_;  // offset of each start's columns
  std::ptrdiff_t pitch_ = 0;             // from row to row; odd with two colours
  std::ptrdiff_t origin_ = 0, stride_ = 0;
  std::vector<PlaneBuffer> masks_;
  std::array<std::vector<Shift>, 2> shifts_;
  std::array<Shift, 2> identity_{};
};

}  // namespace gatewalk::markov
