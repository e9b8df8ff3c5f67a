#include "markov/sweep.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>

#include "markov/ends.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "markov/sweep.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef GATEWALK_MARKOV_SWEEP_ONCE
#define GATEWALK_MARKOV_SWEEP_ONCE

namespace gatewalk::markov {

/// One term of a sum over cells: p times the mass `offset` numbers away.
struct Term {
  double p;
  std::ptrdiff_t offset;
};

/// Sums for `targets` stripes of cells: to[t * stride + c] = sum over the terms of t of
/// p * from[offset + c], for c in [first, last); `add`: on top of what is there. Up to kSlack cells
/// behind `last` are written too, as if they belonged to it.
struct Sums {
  const Term* terms;
  const int* begin;  // (targets + 1)
  int targets;
  std::ptrdiff_t stride;
};

constexpr std::ptrdiff_t kSlack = 8;  // numbers in the longest register

}  // namespace gatewalk::markov

#endif  // GATEWALK_MARKOV_SWEEP_ONCE

HWY_BEFORE_NAMESPACE();
namespace gatewalk::markov {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<double, kSlack>;

/// `Width` registers share each p; each cell's sum is taken in the order of the terms, whatever the
/// width.
template <int Width>
void sum_block(const Term* k, const Term* end, const double* HWY_RESTRICT from,
               double* HWY_RESTRICT to, bool add) {
  const D d;
  const auto n = static_cast<std::ptrdiff_t>(hn::Lanes(d));
  hn::Vec<D> s[Width];
  for (int i = 0; i < Width; ++i) s[i] = add ? hn::LoadU(d, to + i * n) : hn::Zero(d);
  for (; k != end; ++k) {
    const auto p = hn::Set(d, k->p);
    const double* const in = from + k->offset;
    for (int i = 0; i < Width; ++i) s[i] = hn::Add(s[i], hn::Mul(p, hn::LoadU(d, in + i * n)));
  }
  for (int i = 0; i < Width; ++i) hn::StoreU(s[i], d, to + i * n);
}

void sum_up(const Sums& sums, const double* HWY_RESTRICT from, double* HWY_RESTRICT to,
            std::ptrdiff_t first, std::ptrdiff_t last, bool add) {
  constexpr std::ptrdiff_t kWidest = 4;
  const auto n = static_cast<std::ptrdiff_t>(hn::Lanes(D()));
  const std::ptrdiff_t registers = (last - first + n - 1) / n;
  const std::ptrdiff_t blocks = (registers + kWidest - 1) / kWidest;  // of nearly the same width
  for (int t = 0; t < sums.targets; ++t) {
    const Term* const begin = sums.terms + sums.begin[t];
    const Term* const end = sums.terms + sums.begin[t + 1];
    double* const out = to + t * sums.stride;
    for (std::ptrdiff_t i = 0; i < blocks; ++i) {
      const std::ptrdiff_t from_register = registers * i / blocks;
      const std::ptrdiff_t width = registers * (i + 1) / blocks - from_register;
      const std::ptrdiff_t c = first + from_register * n;
      switch (width) {
        case 1: sum_block<1>(begin, end, from + c, out + c, add); break;
        case 2: sum_block<2>(begin, end, from + c, out + c, add); break;
        case 3: sum_block<3>(begin, end, from + c, out + c, add); break;
        default: sum_block<4>(begin, end, from + c, out + c, add); break;
      }
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace gatewalk::markov
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gatewalk::markov {
HWY_EXPORT(sum_up);

namespace {

using Numbers = std::vector<double>;

void sum_up(const Sums& sums, const double* from, double* to, std::ptrdiff_t first,
            std::ptrdiff_t last, bool add) {
  HWY_DYNAMIC_DISPATCH(sum_up)(sums, from, to, first, last, add);
}

/// Terms of several targets.
struct Table {
  std::vector<Term> terms;
  std::vector<int> begin{0};
  void end_target() { begin.push_back(static_cast<int>(terms.size())); }
  [[nodiscard]] std::size_t targets() const { return begin.size() - 1; }
  [[nodiscard]] Sums sums(std::ptrdiff_t stride) const {
    return {terms.data(), begin.data(), static_cast<int>(targets()), stride};
  }
};

/// A mass that is nothing: products with it must not become denormal numbers, which are slow.
constexpr double kNothing = 1e-280;

/// Cells in stripes, one per input state, with room on all sides for what moves out of the field and
/// for whole registers.
struct Layout {
  std::ptrdiff_t pitch;   // from row to row
  std::ptrdiff_t origin;  // cell (0, 0)
  std::ptrdiff_t stride;  // from input to input
  Layout(const Field& field, int widest, int tallest)
      : pitch(field.columns + widest),  // the room at the right is that at the left of the next row
        origin((tallest + 1) * pitch + kSlack),
        stride(origin + (field.rows + tallest + 1) * pitch + kSlack) {}
  [[nodiscard]] std::ptrdiff_t at(std::int64_t column, std::int64_t row) const {
    return origin + row * pitch + column;
  }
};

/// A target per stripe of shares, each the sum over all inputs of its share of their mass.
Table shares_of(const std::vector<const Numbers*>& shares, std::ptrdiff_t stride) {
  Table table;
  for (const Numbers* share : shares) {
    for (std::size_t input = 0; input < share->size(); ++input)
      if ((*share)[input] > 0.0)
        table.terms.push_back({(*share)[input], static_cast<std::ptrdiff_t>(input) * stride});
    table.end_target();
  }
  return table;
}

}  // namespace

/// A target per input: where its mass comes from. `shift(source)`: the way from a cell to the one the
/// mass comes from, none if it does not count.
template <class Shift>
Table moves_of(const std::vector<Sweeper::Source>& sources, const std::vector<int>& begin,
               std::ptrdiff_t stride, Shift shift) {
  Table table;
  for (std::size_t input = 0; input + 1 < begin.size(); ++input) {
    for (int k = begin[input]; k < begin[input + 1]; ++k) {
      const Sweeper::Source& s = sources[static_cast<std::size_t>(k)];
      if (const std::optional<std::ptrdiff_t> way = shift(s))
        table.terms.push_back({s.p, s.input * stride + *way});
    }
    table.end_target();
  }
  return table;
}

Sweeper::Sweeper(const Chain& chain) : chain_(chain) {
  const auto n = static_cast<std::size_t>(chain.inputs());
  trapped_.assign(n, 0.0);
  std::vector<std::vector<Source>> into(n);
  for (int input = 0; input < chain.inputs(); ++input) {
    for (Probabilities::InnerIterator it(chain.matrix(), input); it; ++it) {
      const Exit& exit = chain.exits()[static_cast<std::size_t>(it.col())];
      if (exit.next_input == Exit::kTrapped) {
        trapped_[static_cast<std::size_t>(input)] += it.value();
        continue;
      }
      auto same = std::find_if(directions_.begin(), directions_.end(), [&](const Direction& d) {
        return d.di_x == exit.di_x && d.di_y == exit.di_y;
      });
      if (same == directions_.end())
        same = directions_.insert(same, {exit.di_x, exit.di_y, Numbers(n), Numbers(n)});
      const bool sampled = chain.is_sampled(exit.next_input);
      (sampled ? same->on : same->unsampled)[static_cast<std::size_t>(input)] += it.value();
      if (sampled)
        into[static_cast<std::size_t>(exit.next_input)].push_back(
            {it.value(), input, exit.di_x, exit.di_y});
      widest_ = std::max(widest_, std::abs(exit.di_x));
      lowest_ = std::min(lowest_, exit.di_y);
      highest_ = std::max(highest_, exit.di_y);
    }
  }
  endings_.push_back(&trapped_);
  for (const Direction& d : directions_) {
    endings_.push_back(&d.on);
    endings_.push_back(&d.unsampled);
  }
  begin_.push_back(0);
  for (const auto& sources : into) {
    sources_.insert(sources_.end(), sources.begin(), sources.end());
    begin_.push_back(static_cast<int>(sources_.size()));
  }
}

double Sweeper::count_ends(Ends& ends, const Field& field, std::int64_t column, std::int64_t row,
                           bool is_last, const double* tally, std::size_t stride) const {
  const std::int64_t cell = row * field.columns + column;
  ends.add(ends.trapped, cell, *tally);
  double walks_on = 0.0;
  for (const Direction& d : directions_) {
    const double on = *(tally += stride), unsampled = *(tally += stride);
    if (on + unsampled == 0.0) continue;
    const std::int64_t target = neighbour_cell(field, column, row, d.di_x, d.di_y);
    if (target < 0) {
      ends.add(ends.left_field, cell, on + unsampled);
    } else if (is_last) {
      ends.add(ends.cut_off, cell, on + unsampled);
    } else {
      ends.add(ends.unsampled, target, unsampled);
      walks_on += on;
    }
  }
  return walks_on;
}

FinalDistribution Sweeper::propagate(const Field& field, const Start& start, int max_cells,
                                     double tolerance, int max_steps_without_limit) const {
  validate(chain_, field, start, max_cells);
  if (!(tolerance >= 0.0) || max_steps_without_limit < 0)
    throw std::invalid_argument("propagate: tolerance and step limit must not be negative");
  Ends ends(field);
  const std::int64_t start_cell = std::int64_t{start.row} * field.columns + start.column;
  if (!chain_.is_sampled(start.input)) {
    ends.add(ends.unsampled, start_cell, 1.0);
    return ends.result();
  }

  const Layout cells(field, widest_, std::max(-lowest_, highest_));
  const Table moves = moves_of(sources_, begin_, cells.stride, [&](const Source& s) {
    return std::optional(-(s.di_y * cells.pitch + s.di_x));
  });
  const Table endings = shares_of(endings_, cells.stride);
  const auto n_in = static_cast<std::size_t>(chain_.inputs());
  const auto stride = static_cast<std::size_t>(cells.stride);
  Numbers now(n_in * stride), next(n_in * stride), tally(endings.targets() * stride);
  now[static_cast<std::size_t>(start.input) * stride +
      static_cast<std::size_t>(cells.at(start.column, start.row))] = 1.0;

  // The rectangle that walks can have reached.
  std::int64_t left = start.column, right = start.column, bottom = start.row, top = start.row;
  double walking = 1.0;
  CompensatedSum draws;
  int steps = 0;
  while (max_cells > 0 ? steps < max_cells && walking > 0.0
                       : steps < max_steps_without_limit && walking > tolerance) {
    ++steps;
    draws += walking;
    const bool is_last = steps == max_cells;
    CompensatedSum walks_on;
    sum_up(endings.sums(cells.stride), now.data(), tally.data(), cells.at(left, bottom),
           cells.at(right, top) + 1, false);
    for (std::int64_t row = bottom; row <= top; ++row)
      for (std::int64_t column = left; column <= right; ++column)
        walks_on += count_ends(ends, field, column, row, is_last,
                               tally.data() + cells.at(column, row), stride);
    walking = walks_on.value();
    if (is_last) break;

    for (const Direction& d : directions_) {
      left = std::max<std::int64_t>(0, std::min(left, left + d.di_x));
      right = std::min<std::int64_t>(field.columns - 1, std::max(right, right + d.di_x));
      bottom = std::max<std::int64_t>(0, std::min(bottom, bottom + d.di_y));
      top = std::min<std::int64_t>(field.rows - 1, std::max(top, top + d.di_y));
    }
    sum_up(moves.sums(cells.stride), now.data(), next.data(), cells.at(left, bottom),
           cells.at(right, top) + 1, false);
    // What has left the field is counted already.
    for (std::size_t input = 0; input < n_in; ++input) {
      double* const mass = next.data() + input * stride;
      for (std::int64_t row = bottom; row <= top; ++row)
        std::fill_n(mass + cells.at(field.columns, row), widest_, 0.0);
      std::fill_n(mass + cells.at(right, top) + 1, kSlack, 0.0);
    }
    std::swap(now, next);
  }

  FinalDistribution result = ends.result();
  result.remainder = walking;
  result.mean_steps = draws.value();
  result.steps = steps;
  return result;
}

FinalDistribution Sweeper::march(const Field& field, const Start& start, double tolerance,
                                 int most_sums) const {
  validate(chain_, field, start, 0);
  if (!can_march()) throw std::invalid_argument("march: an exit leads to a row below");
  if (!(tolerance >= 0.0)) throw std::invalid_argument("march: tolerance must not be negative");
  Ends ends(field);
  if (!chain_.is_sampled(start.input)) {
    ends.add(ends.unsampled, std::int64_t{start.row} * field.columns + start.column, 1.0);
    return ends.result();
  }

  const Layout cells({field.columns, 1}, widest_, 0);
  const auto within = [&](int di_y) {
    return moves_of(sources_, begin_, cells.stride, [&](const Source& s) {
      return s.di_y == di_y ? std::optional<std::ptrdiff_t>(-s.di_x) : std::nullopt;
    });
  };
  const Table sideways = within(0), endings = shares_of(endings_, cells.stride);
  const Numbers ones(static_cast<std::size_t>(chain_.inputs()), 1.0);
  const Table all = shares_of({&ones}, cells.stride);
  std::vector<Table> upwards;  // by 1, 2, ...
  for (int di_y = 1; di_y <= highest_; ++di_y) upwards.push_back(within(di_y));

  const auto n_in = static_cast<std::size_t>(chain_.inputs());
  const auto stride = static_cast<std::size_t>(cells.stride);
  const std::ptrdiff_t first = cells.at(0, 0), last = cells.at(field.columns, 0);
  const auto clear_outside = [&](Numbers& mass) {
    for (std::size_t input = 0; input < n_in; ++input)
      std::fill_n(mass.data() + input * stride + last, kSlack + widest_, 0.0);
  };
  const auto total = [&](const Numbers& mass, Numbers& tally) {
    sum_up(all.sums(cells.stride), mass.data(), tally.data(), first, last, false);
    CompensatedSum sum;
    for (std::ptrdiff_t c = first; c < last; ++c) sum += tally[static_cast<std::size_t>(c)];
    return sum.value();
  };

  // entering[k]: mass that enters the row k above this one, from below.
  std::vector<Numbers> entering(static_cast<std::size_t>(highest_) + 1, Numbers(n_in * stride));
  Numbers now(n_in * stride), next(n_in * stride), visits(n_in * stride),
      tally(endings.targets() * stride);
  entering.front()[static_cast<std::size_t>(start.input) * stride +
                   static_cast<std::size_t>(cells.at(start.column, 0))] = 1.0;
  CompensatedSum draws, remainder;
  int steps = 0;
  for (std::int64_t row = start.row; row < field.rows; ++row) {
    std::swap(now, entering.front());
    double walking = total(now, tally);
    double above = 0.0;
    for (std::size_t k = 1; k < entering.size(); ++k) above += total(entering[k], tally);
    if (walking + above <= std::max(tolerance, kNothing)) {
      remainder += walking + above;
      break;
    }
    const double enough = std::max(tolerance * walking, kNothing);
    std::fill(visits.begin(), visits.end(), 0.0);
    for (int sums = 0; walking > enough; ++sums) {
      if (sums == most_sums)
        throw std::runtime_error("march: after " + std::to_string(sums) + " moves within row " +
                                 std::to_string(row + 1) + " a share of " + std::to_string(walking) +
                                 " still walks there: it can circle (almost) for ever");
      draws += walking;
      ++steps;
      std::transform(visits.begin(), visits.end(), now.begin(), visits.begin(), std::plus<>());
      sum_up(sideways.sums(cells.stride), now.data(), next.data(), first, last, false);
      clear_outside(next);
      std::swap(now, next);
      walking = total(now, tally);
    }
    remainder += walking;
    sum_up(endings.sums(cells.stride), visits.data(), tally.data(), first, last, false);
    for (std::int64_t column = 0; column < field.columns; ++column)
      (void)count_ends(ends, field, column, row, false, tally.data() + cells.at(column, 0), stride);

    // Rows move down by one; what goes up by k arrives in the k-th.
    std::fill(entering.front().begin(), entering.front().end(), 0.0);
    std::rotate(entering.begin(), entering.begin() + 1, entering.end());
    for (std::size_t k = 0; k < upwards.size(); ++k) {
      sum_up(upwards[k].sums(cells.stride), visits.data(), entering[k].data(), first, last, true);
      clear_outside(entering[k]);
    }
  }

  FinalDistribution result = ends.result();
  result.remainder = remainder.value();
  result.mean_steps = draws.value();
  result.steps = steps;
  return result;
}

FinalDistribution Sweeper::predict(const Field& field, const Start& start, int max_cells) const {
  // Measured on the paper's chain: 9 x 9 cells are quicker step by step, 101 x 101 row by row.
  constexpr std::int64_t kLarge = 400;  // cells
  const bool large = std::int64_t{field.columns} * field.rows > kLarge;
  return max_cells == 0 && large && can_march() ? march(field, start)
                                                : propagate(field, start, max_cells);
}

}  // namespace gatewalk::markov
#endif
