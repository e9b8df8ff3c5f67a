// SPDX-License-Identifier: MIT
#include "markov/predict/row_elimination.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "markov/predict/stencil.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "markov/predict/row_elimination.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef GATEWALK_MARKOV_ROW_ELIMINATION_ONCE
#define GATEWALK_MARKOV_ROW_ELIMINATION_ONCE

namespace gatewalk::markov {

/// The equations of one row. Vectors of a column have `r.height` numbers for r and `l.height` for
/// l.
struct RowSystem {
  const RowElimination::Column* const* columns;
  int count;
  const Block *rr, *lr, *ll;
  const double *entering_r, *entering_l;  // (count vectors)
  double *visits_r, *visits_l;            // (count vectors)
  double* arriving;                       // (one vector of r)
};

}  // namespace gatewalk::markov

#endif  // GATEWALK_MARKOV_ROW_ELIMINATION_ONCE

HWY_BEFORE_NAMESPACE();
namespace gatewalk::markov {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<double, kLanes>;

/// Computes some registers of y = from + a x. Columns are summed in two chains, to reduce the wait
/// for each sum.
template <int Height>
void multiply_some(const double* HWY_RESTRICT a, const Block& block, const double* HWY_RESTRICT x,
                   const double* from, double* y) {
  const D d;
  const auto n = static_cast<std::ptrdiff_t>(hn::Lanes(d));
  hn::Vec<D> even[Height], odd[Height];
  for (int i = 0; i < Height; ++i) even[i] = odd[i] = hn::Zero(d);
  int j = 0;
  for (; j + 1 < block.columns; j += 2, a += 2 * block.height) {
    const auto x0 = hn::Set(d, x[j]), x1 = hn::Set(d, x[j + 1]);
    for (int i = 0; i < Height; ++i) {
      even[i] = hn::Add(even[i], hn::Mul(x0, hn::LoadU(d, a + i * n)));
      odd[i] = hn::Add(odd[i], hn::Mul(x1, hn::LoadU(d, a + block.height + i * n)));
    }
  }
  if (j < block.columns) {
    const auto x0 = hn::Set(d, x[j]);
    for (int i = 0; i < Height; ++i)
      even[i] = hn::Add(even[i], hn::Mul(x0, hn::LoadU(d, a + i * n)));
  }
  for (int i = 0; i < Height; ++i)
    hn::StoreU(hn::Add(hn::LoadU(d, from + i * n), hn::Add(even[i], odd[i])), d, y + i * n);
}

/// Computes y = from + a x; `from` may be y.
void multiply(const Block& a, const double* HWY_RESTRICT x, const double* from, double* y) {
  const auto n = static_cast<std::ptrdiff_t>(hn::Lanes(D()));
  for (std::ptrdiff_t i = 0; i < a.height;) {
    const std::ptrdiff_t left = (a.height - i) / n;
    const double* const top = a.p.data() + i;
    switch (left) {
      case 1:
        multiply_some<1>(top, a, x, from + i, y + i);
        break;
      case 2:
        multiply_some<2>(top, a, x, from + i, y + i);
        break;
      case 3:
        multiply_some<3>(top, a, x, from + i, y + i);
        break;
      default:
        multiply_some<4>(top, a, x, from + i, y + i);
        break;
    }
    i += std::min<std::ptrdiff_t>(left, 4) * n;
  }
}

/// Computes c = from + a b.
void multiply_blocks(const Block& a, const Block& b, const Block& from, Block& c) {
  for (int j = 0; j < b.columns; ++j) multiply(a, b.column(j), from.column(j), c.column(j));
}

/// Replaces a by its inverse (Gauss-Jordan) and returns the least pivot. No pivoting is needed: a =
/// I - Q with Q >= 0 whose columns sum to at most 1 (an M-matrix), so all pivots are positive
/// unless a is singular.
double invert(Block& a) {
  const D d;
  const auto n = static_cast<std::ptrdiff_t>(hn::Lanes(d));
  double least = 1.0;
  for (int k = 0; k < a.columns; ++k) {
    double* const HWY_RESTRICT pivot_column = a.column(k);
    const double pivot = pivot_column[k];
    least = std::min(least, pivot);
    pivot_column[k] = 1.0;
    const auto by = hn::Set(d, 1.0 / pivot);
    for (std::ptrdiff_t i = 0; i < a.height; i += n)
      hn::StoreU(hn::Mul(by, hn::LoadU(d, pivot_column + i)), d, pivot_column + i);
    for (int j = 0; j < a.columns; ++j) {
      if (j == k) continue;
      double* const HWY_RESTRICT column = a.column(j);
      const auto times = hn::Set(d, column[k]);
      column[k] = 0.0;
      for (std::ptrdiff_t i = 0; i < a.height; i += n)
        hn::StoreU(
            hn::Sub(hn::LoadU(d, column + i), hn::Mul(times, hn::LoadU(d, pivot_column + i))), d,
            column + i);
    }
  }
  return least;
}

/// Solves r = N (arriving + G' Ll l) and l = entering + Lr r + Ll l of the column to the right, for
/// all columns: first `arriving` from the left, then l from the right.
void solve_row(const RowSystem& s) {
  const std::ptrdiff_t r = s.rr->height, l = s.ll->height;
  std::copy_n(s.entering_r, r, s.arriving);
  for (int c = 0; c < s.count; ++c) {
    double* const u = s.visits_r + c * r;
    std::fill_n(u, r, 0.0);
    multiply(s.columns[c]->visits, s.arriving, u, u);  // u = N arriving
    if (c + 1 == s.count) break;
    // arriving = entering + G entering_l + Rr u
    multiply(s.columns[c]->first_passage, s.entering_l + c * l, s.entering_r + (c + 1) * r,
             s.arriving);
    multiply(*s.rr, u, s.arriving, s.arriving);
  }
  std::copy_n(s.entering_l + (s.count - 1) * l, l, s.visits_l + (s.count - 1) * l);
  for (int c = s.count - 1; c >= 0; --c) {
    double *const at_r = s.visits_r + c * r, *const at_l = s.visits_l + c * l;
    multiply(s.columns[c]->turned, at_l, at_r, at_r);  // r = u + M l
    if (c == 0) break;
    multiply(*s.ll, at_l, s.entering_l + (c - 1) * l, at_l - l);  // l = entering + Ll l + Lr r
    multiply(*s.lr, at_r, at_l - l, at_l - l);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace gatewalk::markov
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gatewalk::markov {
HWY_EXPORT(multiply_blocks);
HWY_EXPORT(invert);
HWY_EXPORT(solve_row);

namespace {

constexpr std::size_t kMostNumbers = std::size_t{64} << 20;  // 512 MiB of columns

Block product(const Block& a, const Block& b) {
  const Block none(a.rows, b.columns);
  Block c(a.rows, b.columns);
  HWY_DYNAMIC_DISPATCH(multiply_blocks)(a, b, none, c);
  return c;
}

/// The index of each input in `inputs`; -1 for other inputs.
std::vector<int> places(const std::vector<int>& inputs, int n_in) {
  std::vector<int> place(static_cast<std::size_t>(n_in), -1);
  for (std::size_t i = 0; i < inputs.size(); ++i)
    place[static_cast<std::size_t>(inputs[i])] = static_cast<int>(i);
  return place;
}

}  // namespace

Block::Block(int n_rows, int n_columns)
    : rows(n_rows),
      columns(n_columns),
      height(static_cast<int>((n_rows + kLanes - 1) / kLanes * kLanes)),
      p(static_cast<std::size_t>(height) * static_cast<std::size_t>(n_columns)) {}

bool RowElimination::suits(const Chain& chain) {
  constexpr int kMostStates = 2000;
  std::vector<char> is_entered(static_cast<std::size_t>(chain.inputs()));
  for (int input = 0; input < chain.inputs(); ++input)
    for (Probabilities::InnerIterator it(chain.matrix(), input); it; ++it) {
      const Exit& exit = chain.exits()[static_cast<std::size_t>(it.col())];
      if (exit.next_input == Exit::kTrapped || exit.di_y != 0) continue;
      if (std::abs(exit.di_x) != 1) return false;
      is_entered[static_cast<std::size_t>(exit.next_input)] = 1;
    }
  return std::count(is_entered.begin(), is_entered.end(), 1) <= kMostStates;
}

RowElimination::RowElimination(const Chain& chain) {
  const auto each_move = [&](int input, auto&& seen) {
    for (Probabilities::InnerIterator it(chain.matrix(), input); it; ++it) {
      const Exit& exit = chain.exits()[static_cast<std::size_t>(it.col())];
      if (exit.next_input != Exit::kTrapped && exit.di_y == 0) seen(exit, it.value());
    }
  };
  std::vector<char> is_right(static_cast<std::size_t>(chain.inputs())), is_left(is_right);
  for (int input = 0; input < chain.inputs(); ++input)
    each_move(input, [&](const Exit& exit, double) {
      (exit.di_x > 0 ? is_right : is_left)[static_cast<std::size_t>(exit.next_input)] = 1;
    });
  for (int input = 0; input < chain.inputs(); ++input) {
    if (is_right[static_cast<std::size_t>(input)]) right_.push_back(input);
    if (is_left[static_cast<std::size_t>(input)]) {
      left_.push_back(input);
      is_also_right_.push_back(is_right[static_cast<std::size_t>(input)]);
    }
  }
  const int r = static_cast<int>(right_.size()), l = static_cast<int>(left_.size());
  const std::vector<int> right_place = places(right_, chain.inputs()),
                         left_place = places(left_, chain.inputs());
  rr_ = Block(r, r), rl_ = Block(r, l), lr_ = Block(l, r), ll_ = Block(l, l);
  const auto fill = [&](const std::vector<int>& from, Block& to_right, Block& to_left) {
    for (std::size_t j = 0; j < from.size(); ++j)
      each_move(from[j], [&](const Exit& exit, double p) {
        const auto next = static_cast<std::size_t>(exit.next_input);
        const auto column = static_cast<int>(j);
        (exit.di_x > 0 ? to_right.column(column)[right_place[next]]
                       : to_left.column(column)[left_place[next]]) += p;
      });
  };
  fill(right_, rr_, lr_);
  fill(left_, rl_, ll_);
}

double RowElimination::solve_cost() const {
  return (3.0 * rr_.height * rr_.columns + 2.0 * rl_.height * rl_.columns +
          1.0 * lr_.height * lr_.columns + 1.0 * ll_.height * ll_.columns) /
         kLanes;
}

double RowElimination::column_cost() const {
  const double r = rr_.height, l = ll_.height;
  return (r * l * r + r * l * l + r * r * r + 2.0 * r * r * l) / kLanes;
}

bool RowElimination::append() const {
  const int r = rr_.rows, l = ll_.rows;
  Column next{Block(r, r), Block(r, l), rl_};
  if (columns_.empty()) {
    for (int i = 0; i < r; ++i) next.visits.column(i)[i] = 1.0;
  } else {
    const Block& first_passage = columns_.back().first_passage;
    next.visits = product(first_passage, lr_);  // N = (I - G' Lr)^-1
    for (double& p : next.visits.p) p = -p;
    for (int i = 0; i < r; ++i) next.visits.column(i)[i] += 1.0;
    if (!(HWY_DYNAMIC_DISPATCH(invert)(next.visits) > 1e-14)) return false;
    next.turned = product(next.visits, product(first_passage, ll_));  // M = N G' Ll
    HWY_DYNAMIC_DISPATCH(multiply_blocks)
    (rr_, next.turned, rl_, next.first_passage);  // G = Rl + Rr M
    double change = 0.0;
    for (std::size_t i = 0; i < first_passage.p.size(); ++i)
      change = std::max(change, std::abs(next.first_passage.p[i] - first_passage.p[i]));
    is_settled_ = change <= 1e-17;
  }
  columns_.push_back(std::move(next));
  return true;
}

std::vector<const RowElimination::Column*> RowElimination::columns(int count) const {
  const std::lock_guard lock(growing_);
  const std::size_t numbers = (rr_.p.size() + 2 * rl_.p.size()) + 1;
  std::vector<const Column*> all;
  for (int c = 0; c < count; ++c) {
    if (static_cast<std::size_t>(c) == columns_.size() && !is_settled_ && !is_singular_) {
      if (columns_.size() >= kMostNumbers / numbers) return {};
      is_singular_ = !append();
    }
    if (static_cast<std::size_t>(c) >= columns_.size() && is_singular_) return {};
    all.push_back(&columns_[std::min(static_cast<std::size_t>(c), columns_.size() - 1)]);
  }
  return all;
}

std::size_t RowElimination::workspace(int count) const {
  return static_cast<std::size_t>(count) * 2 * (rr_.height + ll_.height) + rr_.height;
}

void RowElimination::solve(const std::vector<const Column*>& columns, const double* entering,
                           double* visits, std::ptrdiff_t stride, double* workspace) const {
  const auto count = static_cast<std::ptrdiff_t>(columns.size());
  const std::ptrdiff_t r = rr_.height, l = ll_.height;
  const auto take = [&workspace](std::ptrdiff_t numbers) {
    return std::exchange(workspace, workspace + numbers);
  };
  double *const entering_r = take(count * r), *const entering_l = take(count * l),
                *const visits_r = take(count * r), *const visits_l = take(count * l),
                *const arriving = take(r);
  std::fill(entering_r, visits_r, 0.0);  // entering_r and entering_l
  // A few columns at a time, because they share reads of the planes.
  constexpr std::ptrdiff_t kTogether = 2 * kLanes;
  for (std::ptrdiff_t first = 0; first < count; first += kTogether) {
    const std::ptrdiff_t end = std::min(first + kTogether, count);
    for (std::size_t i = 0; i < right_.size(); ++i)
      for (std::ptrdiff_t c = first; c < end; ++c)
        entering_r[c * r + static_cast<std::ptrdiff_t>(i)] = entering[right_[i] * stride + c];
    for (std::size_t i = 0; i < left_.size(); ++i)
      for (std::ptrdiff_t c = first; c < end && !is_also_right_[i]; ++c)
        entering_l[c * l + static_cast<std::ptrdiff_t>(i)] = entering[left_[i] * stride + c];
  }
  HWY_DYNAMIC_DISPATCH(solve_row)
  ({columns.data(), static_cast<int>(count), &rr_, &lr_, &ll_, entering_r, entering_l, visits_r,
    visits_l, arriving});
  for (std::ptrdiff_t first = 0; first < count; first += kTogether) {
    const std::ptrdiff_t end = std::min(first + kTogether, count);
    for (std::size_t i = 0; i < right_.size(); ++i)
      for (std::ptrdiff_t c = first; c < end; ++c)
        visits[right_[i] * stride + c] += visits_r[c * r + static_cast<std::ptrdiff_t>(i)];
    for (std::size_t i = 0; i < left_.size(); ++i)
      for (std::ptrdiff_t c = first; c < end; ++c)
        visits[left_[i] * stride + c] += visits_l[c * l + static_cast<std::ptrdiff_t>(i)];
  }
}

}  // namespace gatewalk::markov
#endif
