// SPDX-License-Identifier: MIT
#include "markov/explicit_chain.h"

#include <map>
#include <stdexcept>
#include <string>
#include <unordered_map>

namespace gatewalk::markov {

ExplicitChain explicit_chain(const FieldChain& chain, const Field& field, const Start& start,
                             int max_cells, std::int64_t most) {
  validate(chain, field, start, max_cells);
  ExplicitChain all;
  // Number of a state, by its index among all possible ones.
  std::unordered_map<std::uint64_t, std::int64_t> number;
  const auto number_of = [&](const ExplicitChain::State& s) {
    const std::uint64_t place =
        ((static_cast<std::uint64_t>(s.draws) * static_cast<std::uint64_t>(field.rows) +
          static_cast<std::uint64_t>(s.row)) *
             static_cast<std::uint64_t>(field.columns) +
         static_cast<std::uint64_t>(s.column)) *
            static_cast<std::uint64_t>(chain.inputs()) +
        static_cast<std::uint64_t>(s.input);
    const auto [found, is_new] = number.try_emplace(place, std::ssize(all.states));
    if (is_new) {
      if (std::ssize(all.states) == most)
        throw std::invalid_argument("explicit chain: more than " + std::to_string(most) +
                                    " states are reached");
      all.states.push_back(s);
    }
    return found->second;
  };
  (void)number_of({start.column, start.row, start.input, 0});
  // Endings get negative numbers until the number of states is known; then they follow the last
  // state.
  for (std::int64_t k = 0; k < std::ssize(all.states); ++k) {
    const ExplicitChain::State from = all.states[static_cast<std::size_t>(k)];
    std::map<std::int64_t, double> to;
    const auto end = [&](Ending e) -> double& { return to[-1 - static_cast<std::int64_t>(e)]; };
    const Chain& here = chain.at(from.column, from.row);
    if (!here.is_sampled(from.input)) end(Ending::unsampled) = 1.0;
    for (Probabilities::InnerIterator it(here.matrix(), from.input); it; ++it) {
      const Exit& exit = here.exits()[static_cast<std::size_t>(it.col())];
      std::int64_t column = from.column, row = from.row;
      const bool is_last = max_cells > 0 && from.draws + 1 == max_cells;
      if (const auto ending = follow(field, exit, is_last, column, row)) {
        end(*ending) += it.value();
        continue;
      }
      to[number_of({static_cast<std::int32_t>(column), static_cast<std::int32_t>(row),
                    exit.next_input, max_cells > 0 ? from.draws + 1 : 0})] += it.value();
    }
    all.first.push_back(std::ssize(all.target));
    for (auto it = to.lower_bound(0); it != to.end(); ++it) {
      all.target.push_back(it->first);
      all.probability.push_back(it->second);
    }
    for (std::size_t e = 0; e < kEndings; ++e)
      if (const auto it = to.find(-1 - static_cast<std::int64_t>(e)); it != to.end()) {
        all.target.push_back(it->first);
        all.probability.push_back(it->second);
      }
  }
  for (std::int64_t& t : all.target)
    if (t < 0) t = all.ends() - 1 - t;
  for (std::int64_t e = 0; e < static_cast<std::int64_t>(kEndings); ++e) {
    all.first.push_back(std::ssize(all.target));
    all.target.push_back(all.ends() + e);
    all.probability.push_back(1.0);
  }
  all.first.push_back(std::ssize(all.target));
  return all;
}

}  // namespace gatewalk::markov
