// SPDX-License-Identifier: MIT
#include "lattice/pool/lumped_chain.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <span>
#include <stdexcept>
#include <utility>

#include "markov/lumping.h"
#include "markov/predict.h"

namespace gatewalk::lattice {
namespace {

using dynamics::Entry;

/// Cuts states along an axis into parts of about equal weight, and appends each state's part to its
/// key. States at the same place stay together.
void cut(std::span<int> states, std::size_t axis, int parts, const std::vector<Entry>& places,
         const std::vector<double>& weights, std::vector<std::vector<int>>& keys) {
  const auto place = [&](int s) { return places[static_cast<std::size_t>(s)].at[axis]; };
  std::sort(states.begin(), states.end(),
            [&](int a, int b) { return std::pair(place(a), a) < std::pair(place(b), b); });
  const auto weight = [&](int s) { return weights[static_cast<std::size_t>(s)]; };
  const double all =
      std::transform_reduce(states.begin(), states.end(), 0.0, std::plus<>(), weight);
  double below = 0.0;
  int part = 0;
  for (auto at = states.begin(); at != states.end();) {
    const auto next = std::find_if(at, states.end(), [&](int s) { return place(s) != place(*at); });
    const double here = std::transform_reduce(at, next, 0.0, std::plus<>(), weight);
    if (all > 0.0)  // by the middle of these states' weights
      part = std::min(parts - 1, static_cast<int>((below + 0.5 * here) / all * parts));
    for (; at != next; ++at) keys[static_cast<std::size_t>(*at)].push_back(part);
    below += here;
  }
}

}  // namespace

std::optional<LumpedChain> lumped_chain(const AnalysedChain& chain, const dynamics::CellMap& map,
                                        const FieldParams& field, const ReactiveVisits& passages,
                                        const LumpingParts& parts) {
  const ChainWithRewards& c = chain.chain;
  const markov::Field cells{field.columns, field.rows};
  const std::vector<double>& visits = passages.state_visits();
  std::vector<Entry> places;
  std::vector<std::vector<int>> keys(static_cast<std::size_t>(c.chain.inputs()));
  std::vector<int> states;
  for (int state = 0; state < chain.space.size(); ++state) {
    places.push_back(chain.space.range(state).middle());
    if (state != c.start.input) {
      states.push_back(state);
      keys[static_cast<std::size_t>(state)].push_back(chain.space.face(state));
    }
  }
  const auto refine = [&](std::size_t axis, int into) {
    std::map<std::vector<int>, std::vector<int>> groups;
    for (const int s : states) groups[keys[static_cast<std::size_t>(s)]].push_back(s);
    for (auto& [key, members] : groups) cut(members, axis, into, places, visits, keys);
  };
  for (std::size_t axis = 0; axis < parts.size(); ++axis) refine(axis, parts[axis]);
  std::map<std::vector<int>, int> numbers;
  for (const auto& key : keys) numbers.try_emplace(key, 0);
  int groups = 0;
  for (auto& [key, number] : numbers) number = groups++;
  std::vector<int> group;
  for (const auto& key : keys) group.push_back(numbers[key]);

  LumpedChain lumped{.states = groups};
  std::vector<markov::Chain> chains;
  for (const markov::Chain& one : c.chain.chains()) {
    markov::Lumping of_type = markov::lump(one, group, visits);
    lumped.largest = std::max(lumped.largest, of_type.largest);
    chains.push_back(std::move(of_type.chain));
  }
  try {
    constexpr double kTolerance = 1e-6;  // the differences are shown with four digits
    if (passages.totals().remainder > kTolerance) return {};
    const auto coarse = markov::predict(
        field_chain(map, std::move(chains)), cells,
        {{c.start.column, c.start.row, group[static_cast<std::size_t>(c.start.input)]}},
        {.max_cells = field.max_gates, .tolerance = kTolerance});
    const auto& of_lumped = coarse.front();
    for (std::size_t e = 0; e < markov::kEndings; ++e)
      lumped.endings += 0.5 * std::abs(passages.totals().endings[e] - of_lumped.endings[e]);
    lumped.final_gates =
        0.5 * (final_cells(c, field, passages) - of_lumped.final_cells).abs().sum();
    return lumped;
  } catch (const std::runtime_error&) {  // walks do not end
    return {};
  }
}

}  // namespace gatewalk::lattice
