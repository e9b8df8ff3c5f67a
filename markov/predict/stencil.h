// SPDX-License-Identifier: MIT
#pragma once
/// A stencil applied to many cells at once, in vector registers (Google Highway: the instruction
/// set is chosen when the program runs; the same bits with any).
///
/// The numbers of all cells lie in planes, one per input state. A cell has the same place in each
/// plane; the next plane begins `stride` numbers on. (But see gather() and sweep_strips().)

#include <cstddef>
#include <cstdint>
#include <span>

namespace gatewalk::markov {

/// Ranges begin and end at multiples of this: numbers in the longest register.
inline constexpr std::ptrdiff_t kLanes = 8;

/// Places [first, last).
struct Range {
  std::ptrdiff_t first, last;
};

/// p times the number in plane `source`.
struct Term {
  double p;
  int source;
};

/// The sum of some terms, the plane it goes to, and the shift (its number) by which it goes there.
struct Group {
  int begin, end;  // terms
  int target;      // plane
  int shift;
};

/// From each cell to the one `offset` places on. `mask`, by the place gone to: 1 where that place
/// is a cell of the field, else 0.
struct Shift {
  std::ptrdiff_t offset;
  const double* mask;
};

/// Groups, and the shifts they go by. No plane may be the target of two groups.
struct StencilPass {
  const Term* terms;
  const Group* groups;
  int count;  // groups
  const Shift* shifts;
  std::ptrdiff_t stride;
  const double* source_mask =
      nullptr;  // by the place gone from: 1 for cells that take part, else 0
};

/// For each group and each place c in [first, last), multiples of kLanes:
/// to[target][c + offset] = mask[c + offset] * source_mask[c] * sum of p * from[source][c], or,
/// with `add`, that much more. Terms are summed in their order, rounded after each product and each
/// sum.
void apply_pass(const StencilPass& pass, const double* from, double* to, std::ptrdiff_t first,
                std::ptrdiff_t last, bool add);

/// So many terms are looked at ahead; as many more must follow the last.
inline constexpr int kTermsAhead = 48;

/// p times the numbers of state `source` a move away.
struct GatherTerm {
  double p;
  int source, move;
};

struct GatherPass {
  const GatherTerm* terms;
  const int* ends;  // of each state's terms, the first state's begin before it (states + 1)
  int states;
};

/// Where a cell's numbers are gathered from, by move, and go to: (states x kLanes) each.
struct GatherCell {
  const double* const* from;
  double* to;
};
/// So many cells share each term.
inline constexpr int kMostGathered = 4;

/// The adjoint of apply_pass(), of kLanes numbers side by side: for each of 1 to kMostGathered
/// cells and each state, to[state] = sum of p * from[move][source]. Terms are summed in their
/// order, rounded after each product and each sum.
void gather(const GatherPass& pass, std::span<const GatherCell> cells);

/// A share (its number) times the number `offset` on. Small, as large chains are read from beyond
/// the caches that are near.
struct StripTerm {
  std::int32_t share, offset;
};

/// A row in strips, one for each of kLanes numbers side by side: of each place along the strips all
/// states.
struct StripPass {
  const double* shares;
  const StripTerm* terms;
  const int* ends;     // of each state's terms, the first state's begin before it (states + 1)
  const double* mask;  // (length x kLanes) 1 for a cell of the field, else 0
  int length;
  std::ptrdiff_t stride;  // from a place along the strips to the next
  double tolerance;
};

struct StripChange {
  double largest = 0.0, largest_number = 0.0;
  double excess = 0.0;  // over `tolerance` times the number
};

/// x = mask * (b + sum of share * x), in place, states [first, last), one place along the strips
/// after the other, from the first or from the last one on.
void sweep_strips(const StripPass& pass, int first, int last, bool upwards, const double* b,
                  double* x, StripChange& change);

/// to[i] = from[i + by], each kLanes numbers for themselves, 0 from outside; by is 1 or -1.
void shift_lanes(const double* from, double* to, std::ptrdiff_t count, int by);

/// to += from, in `count` planes from the first on.
void accumulate(const double* from, double* to, int count, std::ptrdiff_t stride,
                std::ptrdiff_t first, std::ptrdiff_t last);

}  // namespace gatewalk::markov
