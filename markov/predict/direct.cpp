// SPDX-License-Identifier: MIT
#include <algorithm>
#include <utility>

#include "markov/predict/end_sums.h"
#include "markov/predict/transient.h"
#include "markov/solvers.h"

namespace gatewalk::markov {

std::optional<ExpectedDraws> expected_draws(Transient& t, double most_operations) {
  const std::vector<char> ends = can_end(t);
  const Blocks blocks = blocks_of(t);
  std::vector<std::size_t> block_of(t.states.size());
  for (std::size_t b = 0; b + 1 < blocks.begin.size(); ++b)
    for (std::int64_t i = blocks.begin[b]; i < blocks.begin[b + 1]; ++i)
      block_of[static_cast<std::size_t>(blocks.order[static_cast<std::size_t>(i)])] = b;

  // `draws` holds the inflow of a state from earlier blocks first, then its visits.
  ExpectedDraws found{std::vector<double>(t.states.size(), 0.0)};
  std::vector<double>& draws = found.by_state;
  draws.front() = 1.0;
  BlockElimination elimination(t.states.size());
  CompensatedSum endless;
  double left = most_operations - static_cast<double>(t.index.size());
  for (std::size_t b = blocks.begin.size() - 1; b-- > 0;) {
    const std::int64_t* const first = blocks.order.data() + blocks.begin[b];
    const std::int64_t* const last = blocks.order.data() + blocks.begin[b + 1];
    if (!ends[static_cast<std::size_t>(*first)]) {  // then no state of its block can
      for (const std::int64_t* s = first; s != last; ++s)
        endless += std::exchange(draws[static_cast<std::size_t>(*s)], 0.0);
      continue;
    }
    if (!elimination.eliminate(t, first, last, left)) return {};
    elimination.visits(first, draws);
    for (const std::int64_t* s = first; s != last; ++s) {
      const auto from = static_cast<std::size_t>(*s);
      for (auto k = static_cast<std::size_t>(t.begin[from]) + 1;
           k < static_cast<std::size_t>(t.begin[from + 1]); ++k) {
        const auto to = static_cast<std::size_t>(t.index[k]);
        if (block_of[to] != b) draws[to] -= draws[from] * t.value[k];
      }
    }
  }
  found.endless = endless.value();
  found.operations = most_operations - left;
  return found;
}

std::optional<FinalDistribution> solve_directly(const FieldChain& chain, const Field& field,
                                                const Start& start, double most_operations) {
  validate(chain, field, start, 0);
  if (!fits_pair_by_pair(chain, field)) return {};
  if (!chain.at(start.column, start.row).is_sampled(start.input)) {
    EndSums ends(field);
    ends.add(Ending::unsampled, std::int64_t{start.row} * field.columns + start.column, 1.0);
    return ends.result();
  }
  Transient t(chain, field, start);
  const auto draws = expected_draws(t, most_operations);
  if (!draws) return {};
  FinalDistribution result = t.ended(draws->by_state, chain, field);
  result.endless = result.remainder = draws->endless;
  // The relative error of each number is about n roundings (Grassmann, Taksar and Heyman 1985).
  result.rounding = 1e-15 * static_cast<double>(t.states.size());
  result.operations = draws->operations;
  return result;
}

}  // namespace gatewalk::markov
