// SPDX-License-Identifier: MIT
#include "markov/predict/stencil.h"

#include <algorithm>
#include <cassert>
#include <type_traits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "markov/predict/stencil.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace gatewalk::markov {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<double, kLanes>;

/// `Width` registers share each p. Loads, one per product, are aligned where the planes are; only
/// stores are shifted.
template <int Width>
void apply_block(const StencilPass& pass, const double* HWY_RESTRICT from, double* HWY_RESTRICT to,
                 bool add, std::ptrdiff_t c) {
  const D d;
  const auto n = static_cast<std::ptrdiff_t>(hn::Lanes(d));
  for (const Group* g = pass.groups; g != pass.groups + pass.count; ++g) {
    hn::Vec<D> s[Width];
    for (int i = 0; i < Width; ++i) s[i] = hn::Zero(d);
    const Term* const end = pass.terms + g->end;
    for (const Term* k = pass.terms + g->begin; k != end; ++k) {
      const auto p = hn::Set(d, k->p);
      const double* const in = from + k->source * pass.stride + c;
      for (int i = 0; i < Width; ++i) s[i] = hn::Add(s[i], hn::Mul(p, hn::LoadU(d, in + i * n)));
    }
    if (pass.source_mask)
      for (int i = 0; i < Width; ++i)
        s[i] = hn::Mul(s[i], hn::LoadU(d, pass.source_mask + c + i * n));

    const Shift& shift = pass.shifts[g->shift];
    const std::ptrdiff_t there = c + shift.offset, place = g->target * pass.stride + there;
    for (int i = 0; i < Width; ++i) {
      s[i] = hn::Mul(s[i], hn::LoadU(d, shift.mask + there + i * n));
      double* const out = to + place + i * n;
      hn::StoreU(add ? hn::Add(hn::LoadU(d, out), s[i]) : s[i], d, out);
    }
  }
}

template <int Width>
using Registers = std::integral_constant<int, Width>;

/// Calls block(Registers<Width>(), c) for the registers from `first` to `last`, several together.
template <class Block>
void in_blocks(std::ptrdiff_t first, std::ptrdiff_t last, Block block) {
  constexpr std::ptrdiff_t kWidest = 8;
  const auto n = static_cast<std::ptrdiff_t>(hn::Lanes(D()));
  const std::ptrdiff_t registers = (last - first) / n;
  // Blocks of nearly the same width.
  const std::ptrdiff_t blocks = (registers + kWidest - 1) / kWidest;
  for (std::ptrdiff_t i = 0; i < blocks; ++i) {
    const std::ptrdiff_t begin = registers * i / blocks,
                         width = registers * (i + 1) / blocks - begin;
    const std::ptrdiff_t c = first + begin * n;
    switch (width) {
      case 1:
        block(Registers<1>(), c);
        break;
      case 2:
        block(Registers<2>(), c);
        break;
      case 3:
        block(Registers<3>(), c);
        break;
      case 4:
        block(Registers<4>(), c);
        break;
      case 5:
        block(Registers<5>(), c);
        break;
      case 6:
        block(Registers<6>(), c);
        break;
      case 7:
        block(Registers<7>(), c);
        break;
      default:
        block(Registers<kWidest>(), c);
        break;
    }
  }
}

template <int Cells, bool Ahead>
void gather_cells(const GatherPass& pass, const GatherCell* cells) {
  const D d;
  constexpr int kRegisters = kLanes / hn::MaxLanes(D());
  const auto n = static_cast<std::ptrdiff_t>(hn::Lanes(d));
  const auto numbers = [cells](int cell, const GatherTerm& term) {
    return cells[cell].from[term.move] + std::ptrdiff_t{term.source} * kLanes;
  };
  const GatherTerm* k = pass.terms + pass.ends[0];
  for (int state = 0; state < pass.states; ++state) {
    hn::Vec<D> s[Cells][kRegisters];
    for (auto& of_cell : s)
      for (auto& part : of_cell) part = hn::Zero(d);
    for (const GatherTerm* const end = pass.terms + pass.ends[state + 1]; k != end; ++k) {
      const auto p = hn::Set(d, k->p);
      if constexpr (Ahead)
        for (int c = 0; c < Cells; ++c) hwy::Prefetch(numbers(c, k[kTermsAhead]));
      for (int c = 0; c < Cells; ++c)
        for (int i = 0; i < kRegisters; ++i)
          s[c][i] = hn::Add(s[c][i], hn::Mul(p, hn::LoadU(d, numbers(c, *k) + i * n)));
    }
    for (int c = 0; c < Cells; ++c)
      for (int i = 0; i < kRegisters; ++i)
        hn::StoreU(s[c][i], d, cells[c].to + std::ptrdiff_t{state} * kLanes + i * n);
  }
}

template <int Cells>
void gather_near_or_far(const GatherPass& pass, const GatherCell* cells) {
  constexpr int kNear = 8192;  // states, half a MiB per cell; beyond, prefetching is faster
  pass.states <= kNear ? gather_cells<Cells, false>(pass, cells)
                       : gather_cells<Cells, true>(pass, cells);
}

void gather_in_registers(const GatherPass& pass, std::span<const GatherCell> cells) {
  switch (cells.size()) {
    case 1:
      return gather_near_or_far<1>(pass, cells.data());
    case 2:
      return gather_near_or_far<2>(pass, cells.data());
    case 3:
      return gather_near_or_far<3>(pass, cells.data());
    default:
      return gather_near_or_far<kMostGathered>(pass, cells.data());
  }
}

void apply_in_registers(const StencilPass& pass, const double* HWY_RESTRICT from,
                        double* HWY_RESTRICT to, std::ptrdiff_t first, std::ptrdiff_t last,
                        bool add) {
  in_blocks(first, last, [&]<int Width>(Registers<Width>, std::ptrdiff_t c) {
    apply_block<Width>(pass, from, to, add, c);
  });
}

void accumulate_in_registers(const double* HWY_RESTRICT from, double* HWY_RESTRICT to, int count,
                             std::ptrdiff_t stride, std::ptrdiff_t first, std::ptrdiff_t last) {
  const D d;
  for (int plane = 0; plane < count; ++plane, from += stride, to += stride)
    for (std::ptrdiff_t c = first; c < last; c += static_cast<std::ptrdiff_t>(hn::Lanes(d)))
      hn::StoreU(hn::Add(hn::LoadU(d, to + c), hn::LoadU(d, from + c)), d, to + c);
}

void sweep_in_registers(const StripPass& pass, int first, int last, bool upwards,
                        const double* HWY_RESTRICT b, double* x, StripChange& change) {
  const D d;
  constexpr int kRegisters = kLanes / hn::MaxLanes(D());
  const auto n = static_cast<std::ptrdiff_t>(hn::Lanes(d));
  auto largest = hn::Zero(d), number = hn::Zero(d), excess = hn::Zero(d);
  const auto tolerance = hn::Set(d, pass.tolerance);
  for (int step = 0; step < pass.length; ++step) {
    const int k = upwards ? step : pass.length - 1 - step;
    hn::Vec<D> mask[kRegisters];
    for (int i = 0; i < kRegisters; ++i) mask[i] = hn::LoadU(d, pass.mask + k * kLanes + i * n);
    for (int state = first; state < last; ++state) {
      double* const base = x + k * pass.stride;
      double* const out = base + state * kLanes;
      hn::Vec<D> s[kRegisters];
      for (int i = 0; i < kRegisters; ++i)
        s[i] = hn::LoadU(d, b + k * pass.stride + state * kLanes + i * n);
      const StripTerm* const end = pass.terms + pass.ends[state + 1];
      for (const StripTerm* t = pass.terms + pass.ends[state]; t != end; ++t) {
        hwy::Prefetch(base + t[kTermsAhead].offset);
        const auto p = hn::Set(d, pass.shares[t->share]);
        for (int i = 0; i < kRegisters; ++i)
          s[i] = hn::Add(s[i], hn::Mul(p, hn::LoadU(d, base + t->offset + i * n)));
      }
      for (int i = 0; i < kRegisters; ++i) {
        s[i] = hn::Mul(s[i], mask[i]);
        const auto by = hn::Sub(s[i], hn::LoadU(d, out + i * n));
        const auto change_of = hn::Abs(by), size = hn::Abs(s[i]);
        largest = hn::Max(largest, change_of);
        number = hn::Max(number, size);
        excess = hn::Max(excess, hn::Sub(change_of, hn::Mul(tolerance, size)));
        hn::StoreU(s[i], d, out + i * n);
      }
    }
  }
  change.largest = std::max(change.largest, hn::GetLane(hn::MaxOfLanes(d, largest)));
  change.largest_number = std::max(change.largest_number, hn::GetLane(hn::MaxOfLanes(d, number)));
  change.excess = std::max(change.excess, hn::GetLane(hn::MaxOfLanes(d, excess)));
}

void shift_in_registers(const double* HWY_RESTRICT from, double* HWY_RESTRICT to,
                        std::ptrdiff_t count, int by) {
  const D d;
  const auto n = static_cast<std::ptrdiff_t>(hn::Lanes(d));
  constexpr double kInside[] = {0, 1, 1, 1, 1, 1, 1, 1, 1, 0};
  const double* const inside = kInside + (by > 0 ? 2 : 0);
  for (std::ptrdiff_t c = 0; c < count; c += kLanes)
    for (std::ptrdiff_t i = 0; i < kLanes; i += n)
      hn::StoreU(hn::Mul(hn::LoadU(d, from + c + i + by), hn::LoadU(d, inside + i)), d, to + c + i);
}

}  // namespace HWY_NAMESPACE
}  // namespace gatewalk::markov
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gatewalk::markov {
HWY_EXPORT(apply_in_registers);
HWY_EXPORT(accumulate_in_registers);
HWY_EXPORT(gather_in_registers);
HWY_EXPORT(sweep_in_registers);
HWY_EXPORT(shift_in_registers);

void apply_pass(const StencilPass& pass, const double* from, double* to, std::ptrdiff_t first,
                std::ptrdiff_t last, bool add) {
  HWY_DYNAMIC_DISPATCH(apply_in_registers)(pass, from, to, first, last, add);
}

void gather(const GatherPass& pass, std::span<const GatherCell> cells) {
  assert(!cells.empty() && cells.size() <= kMostGathered);
  HWY_DYNAMIC_DISPATCH(gather_in_registers)(pass, cells);
}

void sweep_strips(const StripPass& pass, int first, int last, bool upwards, const double* b,
                  double* x, StripChange& change) {
  HWY_DYNAMIC_DISPATCH(sweep_in_registers)(pass, first, last, upwards, b, x, change);
}

void shift_lanes(const double* from, double* to, std::ptrdiff_t count, int by) {
  HWY_DYNAMIC_DISPATCH(shift_in_registers)(from, to, count, by);
}

void accumulate(const double* from, double* to, int count, std::ptrdiff_t stride,
                std::ptrdiff_t first, std::ptrdiff_t last) {
  HWY_DYNAMIC_DISPATCH(accumulate_in_registers)(from, to, count, stride, first, last);
}

}  // namespace gatewalk::markov
#endif
