#pragma once
/// Sums over many cells at once, in vector registers (Google Highway: the instruction set is chosen
/// when the program runs; the same bits with any).
///
/// Numbers of all cells lie in stripes, one per input state: a cell has the same place in each, the
/// next stripe begins `stride` numbers on.

#include <cstddef>

namespace gatewalk::markov {

/// Ranges begin and end at multiples of this: numbers in the longest register.
inline constexpr std::ptrdiff_t kLanes = 8;

/// p times the number in stripe `source`.
struct Term {
  double p;
  int source;
};

/// The sum of some terms, and the stripe and the way it goes.
struct Group {
  int begin, end;  // terms
  int target;      // stripe
  int way;
};

/// From each cell to the one `shift` places on; `mask`, by the place gone to: 1 where a cell can be
/// entered so, else 0.
struct Way {
  std::ptrdiff_t shift;
  const double* mask;
};

/// Which groups go which ways. No stripe may be the target of two groups.
struct Push {
  const Term* terms;
  const Group* groups;
  int count;  // groups
  const Way* ways;
  std::ptrdiff_t stride;
  const double* mine = nullptr;  // by the place gone from: 1 for cells that take part, else 0
};

/// For each group and each place c in [first, last), multiples of kLanes:
/// to[target][c + shift] = mask * sum of p * from[source][c], or, with `add`, that much more. Terms
/// are summed in their order, rounded after each product and each sum.
void push(const Push& p, const double* from, double* to, std::ptrdiff_t first, std::ptrdiff_t last,
          bool add);

/// to += from, in `count` stripes from the first on.
void accumulate(const double* from, double* to, int count, std::ptrdiff_t stride,
                std::ptrdiff_t first, std::ptrdiff_t last);

}  // namespace gatewalk::markov
