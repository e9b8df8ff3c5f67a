// SPDX-License-Identifier: MIT
#include "markov/ends.h"

#include <stdexcept>
#include <type_traits>
#include <utility>

#include "markov/sum.h"

namespace gatewalk::markov {

template <class Number>
Number Ends<Number>::left_field() const {
  std::conditional_t<std::is_floating_point_v<Number>, CompensatedSum, Number> sum{};
  for (const Ending edge : kEdges) sum += (*this)[edge];
  if constexpr (std::is_floating_point_v<Number>)
    return sum.value();
  else
    return sum;
}

template <class Number>
Ends<Number>& Ends<Number>::operator+=(const Ends& other) {
  const bool has_cells = final_cells.size() > 0, adds_cells = other.final_cells.size() > 0;
  if (has_cells && adds_cells &&
      (final_cells.rows() != other.final_cells.rows() ||
       final_cells.cols() != other.final_cells.cols()))
    throw std::invalid_argument("tallies of different fields cannot be added");
  for (std::size_t e = 0; e < kEndings; ++e) endings[e] += other.endings[e];
  if (!adds_cells) return *this;
  if (!has_cells) {
    final_cells = other.final_cells;
    mixed_cells = other.mixed_cells;
    return *this;
  }
  const auto trapped_in = [](const Ends& ends, std::int64_t cell) {
    CellEndings<Number> all{cell};
    all[Ending::trapped] = ends.final_cells.data()[cell];
    return all;
  };
  std::vector<CellEndings<Number>> both;
  auto here = mixed_cells.begin();
  auto there = other.mixed_cells.begin();
  while (here != mixed_cells.end() || there != other.mixed_cells.end()) {
    const bool is_here = here != mixed_cells.end() &&
                         (there == other.mixed_cells.end() || here->cell <= there->cell),
               is_there = there != other.mixed_cells.end() &&
                          (here == mixed_cells.end() || there->cell <= here->cell);
    auto& sum = both.emplace_back(is_here ? *here : trapped_in(*this, there->cell));
    const auto more = is_there ? *there : trapped_in(other, here->cell);
    for (std::size_t e = 0; e < kEndings; ++e) sum.by_ending[e] += more.by_ending[e];
    here += is_here;
    there += is_there;
  }
  mixed_cells = std::move(both);
  final_cells += other.final_cells;
  return *this;
}

template struct Ends<std::int64_t>;
template struct Ends<double>;

}  // namespace gatewalk::markov
