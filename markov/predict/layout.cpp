// SPDX-License-Identifier: MIT
#include "markov/predict/layout.h"

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace gatewalk::markov {

void ask_for_large_pages([[maybe_unused]] double* first, [[maybe_unused]] std::ptrdiff_t count) {
#ifdef __linux__
  constexpr std::uintptr_t kLargePage = 1 << 21;
  const auto begin = reinterpret_cast<std::uintptr_t>(first),
             end = begin + static_cast<std::uintptr_t>(count) * sizeof(double);
  const std::uintptr_t from = (begin + kLargePage - 1) / kLargePage * kLargePage,
                       to = end / kLargePage * kLargePage;
  // Without large pages, small ones serve.
  if (from < to) (void)madvise(reinterpret_cast<void*>(from), to - from, MADV_HUGEPAGE);
#endif
}

Stencil::Stencil(const std::vector<Entry>& entries) {
  // Counting sort by target and move; entries of the same target and move keep their order.
  int moves = 0, targets = 0;
  for (const Entry& e : entries) {
    moves = std::max(moves, e.move + 1);
    targets = std::max(targets, e.target + 1);
  }
  std::vector<int> end(static_cast<std::size_t>(targets * moves) + 1);
  const auto kind = [&](const Entry& e) {
    return static_cast<std::size_t>(e.target * moves + e.move);
  };
  for (const Entry& e : entries) ++end[kind(e) + 1];
  for (std::size_t k = 1; k < end.size(); ++k) end[k] += end[k - 1];
  terms.resize(entries.size());
  for (const Entry& e : entries) {
    int& place = end[kind(e)];  // after the last entry: the beginning of the next kind
    terms[static_cast<std::size_t>(place++)] = {e.p, e.source};
  }
  for (int target = 0, begin = 0; target < targets; ++target) {
    std::size_t pass = 0;
    const int first = begin;
    for (int move = 0; move < moves; ++move) {
      const int next = end[static_cast<std::size_t>(target * moves + move)];
      if (next == begin) continue;
      if (pass == passes.size()) passes.emplace_back();
      passes[pass++].push_back({begin, next, target, move});
      begin = next;
    }
    most_terms = std::max(most_terms, begin - first);
  }
}

void apply_stencil(const Stencil& stencil, const Shift* shifts, std::ptrdiff_t stride,
                   const double* source_mask, const std::vector<Range>& ranges, const double* from,
                   double* to, bool add) {
  for (const auto& groups : stencil.passes) {
    for (const Range& r : ranges)
      apply_pass({stencil.terms.data(), groups.data(), static_cast<int>(groups.size()), shifts,
                  stride, source_mask},
                 from, to, r.first, r.last, add);
    add = true;
  }
}

Layout::Layout(std::int64_t columns, std::int64_t rows, const std::vector<Move>& moves, int colours,
               const std::vector<std::int64_t>& parities)
    : colours_(colours) {
  for (const std::int64_t parity : parities) {
    if (colours == 2 && (pitch_ + parity - parities.front()) % 2 != 0) ++pitch_;
    offsets_.push_back(pitch_);
    pitch_ += columns;
  }
  if (colours == 2 && pitch_ % 2 == 0) ++pitch_;
  std::ptrdiff_t lowest = 0, highest = 0;
  for (const Move& m : moves) {
    lowest = std::min(lowest, offset_of(m));
    highest = std::max(highest, offset_of(m));
  }
  // Whole registers of cells, moved by the largest shift either way, stay in their plane.
  const auto places = [&](std::ptrdiff_t cells) { return (cells + colours - 1) / colours; };
  const std::ptrdiff_t before = lanes_up(places(-lowest));
  origin_ = before * colours;
  stride_ = lanes_up(before + places(rows * pitch_)) + lanes_up(places(highest));
  // An odd number of registers keeps equal places of neighbouring planes in different cache sets.
  if (stride_ / kLanes % 2 == 0) stride_ += kLanes;

  // One mask for each move and one for staying, each for all colours of the target cells.
  for (std::size_t m = 0; m <= moves.size(); ++m) {
    double* const mask = masks_.emplace_back(colours, stride_).take(colours).data();
    const std::int64_t di_x = m < moves.size() ? moves[m].di_x : 0;
    for (std::size_t j = 0; j < parities.size(); ++j)
      for (std::int64_t row = 0; row < rows; ++row)
        for (std::int64_t c = std::max<std::int64_t>(0, di_x);
             c < std::min(columns, columns + di_x); ++c) {
          const Place there = place(j, c, row);
          mask[there.colour * stride_ + there.at] = 1.0;
        }
    for (int colour = 0; colour < colours; ++colour) {
      const auto k = static_cast<std::size_t>(colour);
      if (m == moves.size()) {
        identity_[k] = {0, mask + colour * stride_};
        continue;
      }
      const std::ptrdiff_t to = colour + offset_of(moves[m]);  // relative to the colour's place 0
      const std::ptrdiff_t to_colour = (to % colours + colours) % colours;
      shifts_[k].push_back({(to - to_colour) / colours, mask + to_colour * stride_});
    }
  }
}

void Layout::cover(std::int64_t left, std::int64_t right, std::int64_t bottom, std::int64_t top,
                   std::vector<Range>& ranges) const {
  std::ptrdiff_t done = ranges.empty() ? 0 : ranges.back().last;
  const auto of_rows = [&](std::int64_t low, std::int64_t high) {
    return Range{std::max(done, lanes_down(place(0, left, low).at)),
                 lanes_up(place(offsets_.size() - 1, right, high).at + 1)};
  };
  const auto size = [](const Range& r) { return r.last - r.first; };
  const Range together = of_rows(bottom, top);
  if (size(together) <= (top - bottom + 1) * size(of_rows(bottom, bottom))) {
    ranges.push_back(together);
    return;
  }
  for (std::int64_t row = bottom; row <= top; ++row) {
    ranges.push_back(of_rows(row, row));
    done = ranges.back().last;
  }
}

}  // namespace gatewalk::markov
