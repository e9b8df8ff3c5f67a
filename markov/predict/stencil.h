// SPDX-License-Identifier: MIT
#pragma once
/// Stencils applied to many cells at once in vector registers (Google Highway: the instruction set
/// is chosen when the program runs; the bits are the same with any).
///
/// The numbers of all cells are stored in planes, one per input state. A cell has the same place in
/// each plane; the next plane begins `stride` numbers later. gather() and sweep_strips() have
/// layouts of their own.

#include <cstddef>
#include <cstdint>
#include <span>

namespace gatewalk::markov {

/// The numbers in the longest register. Ranges begin and end at multiples of this.
inline constexpr std::ptrdiff_t kLanes = 8;

/// A range of places [first, last).
struct Range {
  std::ptrdiff_t first, last;
};

/// A term of a sum: p times the number in plane `source`.
struct Term {
  double p;
  int source;
};

/// A sum of terms, with its target plane and the number of the shift by which it goes there.
struct Group {
  int begin, end;  // terms
  int target;      // plane
  int shift;
};

/// A shift from each cell to the place `offset` further on. `mask`, indexed by the target place, is
/// 1 if the place is a cell of the field, else 0.
struct Shift {
  std::ptrdiff_t offset;
  const double* mask;
};

/// One pass of a stencil: groups and their shifts. No plane may be the target of two groups.
struct StencilPass {
  const Term* terms;
  const Group* groups;
  int count;  // groups
  const Shift* shifts;
  std::ptrdiff_t stride;
  const double* source_mask = nullptr;  // by source place: 1 for cells that take part, else 0
};

/// Applies a pass. For each group and each place c in [first, last), multiples of kLanes:
/// to[target][c + offset] = mask[c + offset] * source_mask[c] * sum of p * from[source][c]; with
/// `add`, the sum is added to the target. Terms are summed in their order, rounded after each
/// product and each sum.
void apply_pass(const StencilPass& pass, const double* from, double* to, std::ptrdiff_t first,
                std::ptrdiff_t last, bool add);

/// The number of terms that are prefetched; at least as many must follow the last one.
inline constexpr int kTermsAhead = 48;

/// A term: p times the numbers of state `source` in the cell that move `move` leads to.
struct GatherTerm {
  double p;
  int source, move;
};

struct GatherPass {
  const GatherTerm* terms;
  const int* ends;  // (states + 1): terms of state s are [ends[s], ends[s + 1])
  int states;
};

/// The numbers of a cell to be gathered, by move, and their destination: (states x kLanes) each.
struct GatherCell {
  const double* const* from;
  double* to;
};
/// The largest number of cells that share each term.
inline constexpr int kMostGathered = 4;

/// The adjoint of apply_pass() for kLanes numbers side by side: for each of 1 to kMostGathered
/// cells and each state, to[state] = sum of p * from[move][source]. Terms are summed in their
/// order, rounded after each product and each sum.
void gather(const GatherPass& pass, std::span<const GatherCell> cells);

/// A term: a share (by its index) times the number `offset` further on. The type is small because
/// large chains exceed the near caches.
struct StripTerm {
  std::int32_t share, offset;
};

/// A row in strips, one for each of kLanes numbers side by side; each place along the strips holds
/// all states.
struct StripPass {
  const double* shares;
  const StripTerm* terms;
  const int* ends;     // (states + 1): terms of state s are [ends[s], ends[s + 1])
  const double* mask;  // (length x kLanes) 1 for a cell of the field, else 0
  int length;
  std::ptrdiff_t stride;  // distance between places along the strips
  double tolerance;
};

struct StripChange {
  double largest = 0.0, largest_number = 0.0;
  double excess = 0.0;  // largest change minus `tolerance` times the number
};

/// Computes x = mask * (b + sum of share * x) in place for states [first, last), one place along
/// the strips after the other, upwards from the first or downwards from the last.
void sweep_strips(const StripPass& pass, int first, int last, bool upwards, const double* b,
                  double* x, StripChange& change);

/// Computes to[i] = from[i + by] for each group of kLanes numbers, 0 from outside; by is 1 or -1.
void shift_lanes(const double* from, double* to, std::ptrdiff_t count, int by);

/// Computes to += from in `count` planes from the first on.
void accumulate(const double* from, double* to, int count, std::ptrdiff_t stride,
                std::ptrdiff_t first, std::ptrdiff_t last);

}  // namespace gatewalk::markov
