// SPDX-License-Identifier: MIT
#include "lattice/study/analysis.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <utility>

#include "lattice/pool/passages.h"
#include "lattice/statistics/group_spread.h"
#include "lattice/statistics/share_95.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;

/// Throws where the states of all cells take too much memory: chances and passages, with a limit by
/// draw and beside some waves of shares and totals; as much again for all groups.
void require_memory(const CostedChain& c, const FieldParams& field, bool with_groups) {
  constexpr double kMostBytes = 8.0 * (1 << 30);
  const auto costs = static_cast<double>(c.rewards.front().size());
  const double states = static_cast<double>(field.columns) * field.rows * c.chain.inputs();
  const double numbers =
      field.max_gates > 0 ? 2.0 * (1.0 + 2.0 * costs) + 4.0 * field.max_gates : 4.0;
  if (states * numbers * sizeof(double) * (with_groups ? 2.0 : 1.0) > kMostBytes)
    throw std::invalid_argument(
        "analysis: the states of " + std::to_string(field.columns) + " x " +
        std::to_string(field.rows) +
        " gates take more than 8 GiB; ask for fewer states (--accuracy, build --states) or gates");
}

/// Whether a mirror image of the field is the field itself.
bool same_in_mirror(const CellMap& map, const FieldParams& field) {
  for (int row = 0; row < field.rows; ++row)
    for (int column = 0; column < field.columns; ++column)
      if (map.type_of(column, row) != map.type_of(field.columns - 1 - column, row)) return false;
  return field.columns % 2 == 1 &&
         std::all_of(map.types.begin(), map.types.end(),
                     [](const CellMap::Type& type) { return type.symmetric; });
}

markov::Ending mirrored(markov::Ending ending) {
  if (ending == markov::Ending::left_edge) return markov::Ending::right_edge;
  return ending == markov::Ending::right_edge ? markov::Ending::left_edge : ending;
}

/// What both hold, along so many coordinates; none if that is nothing.
std::optional<StateRange> common_part(const StateRange& a, const StateRange& b,
                                      std::size_t coordinates) {
  StateRange both = a;
  for (std::size_t axis = 0; axis < coordinates; ++axis) {
    both.at[axis] = {std::max(a.at[axis][0], b.at[axis][0]),
                     std::min(a.at[axis][1], b.at[axis][1])};
    if (!(both.at[axis][0] < both.at[axis][1])) return {};
  }
  return both;
}

/// The chance of the target by start. In a field that is its own mirror image, a start is as likely
/// to end so as its image to end so in the mirror: the mean of both, where their states overlap.
std::vector<StartChance> chances_of_starts(const AnalysedChain& chain, const CellMap& map,
                                           const FieldParams& field, int start_face,
                                           const Passages& passages,
                                           const std::vector<Passages>& groups) {
  const CostedChain& c = chain.chain;
  const StateSpace& space = chain.space;
  const markov::Ending target = passages.chance().ending(), image = mirrored(target);
  const bool in_mirror = same_in_mirror(map, field);
  const markov::Field cells{field.columns, field.rows};
  const std::int64_t first_cell = std::int64_t{c.start.row} * field.columns + c.start.column;
  const markov::Chain& first = c.chain.at(c.start.column, c.start.row);

  struct Chances {
    const StateSpace& space;
    const markov::EndingChance& of_target;
    std::optional<markov::EndingChance> of_image{};  // where it is another
  };
  std::vector<Chances> all{{space, passages.chance()}};
  for (std::size_t g = 0; g < groups.size(); ++g)
    all.push_back({chain.groups[g].space, groups[g].chance()});
  if (in_mirror && image != target)
    for (std::size_t k = 0; k < all.size(); ++k)
      all[k].of_image.emplace(k == 0 ? c.chain : chain.groups[k - 1].chain.chain, cells, image,
                              field.max_gates);
  const auto mean_of = [&](const Chances& s, const Entry& start) {
    const double own = s.of_target(1, first_cell, s.space.index_of(start).state);
    if (!in_mirror) return own;
    const int there = s.space.index_of(dynamics::mirrored(s.space.section(), start)).state;
    return std::midpoint(own, (s.of_image ? *s.of_image : s.of_target)(1, first_cell, there));
  };
  const auto runs_of = [&](int state) {
    return static_cast<double>(chain.runs[static_cast<std::size_t>(state)]);
  };
  const auto gate_runs =
      static_cast<double>(std::accumulate(chain.runs.begin(), chain.runs.end(), std::int64_t{0}));
  std::vector<StartChance> starts;
  const auto add = [&](const StateRange& range, bool sampled) {
    constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
    StartChance start{range, {kUnknown, {kUnknown, kUnknown}}};
    if (sampled) {
      std::vector<double> parts;
      for (std::size_t k = 1; k < all.size(); ++k) parts.push_back(mean_of(all[k], range.middle()));
      start.chance.mean = mean_of(all.front(), range.middle());
      if (!parts.empty())
        start.chance.interval = share_95(
            start.chance.mean, parts, {runs_of(space.index_of(range.middle()).state), gate_runs});
    }
    starts.push_back(start);
  };
  std::vector<int> entries;
  for (int state = 0; state < space.size(); ++state)
    if (space.face(state) == start_face) entries.push_back(state);
  for (const int state : entries) {
    if (!in_mirror) {
      add(space.range(state), first.is_sampled(state));
      continue;
    }
    for (const int other : entries)
      if (const auto both = common_part(space.range(state),
                                        dynamics::mirrored(space.section(), space.range(other)),
                                        space.section().coordinates.size()))
        add(*both, first.is_sampled(state) && first.is_sampled(other));
  }
  return starts;
}

}  // namespace

Analysis analyze(const Problem& problem, const AnalysedChain& chain, const AnalysisOptions& options,
                 const Work& work) {
  const Stopwatch watch;
  const CellMap& map = problem.map();
  const FieldParams& field = problem.field;
  const CostedChain& c = chain.chain;
  const StateSpace& space = chain.space;
  const markov::Field cells{field.columns, field.rows};

  require_memory(c, field, !chain.groups.empty());
  const auto all = all_passages(chain, field, options.target, {},
                                {.places = false, .tolerance = kGroupTolerance}, "analysis", work);
  const Passages& passages = all.whole;
  const auto& groups = all.groups;
  markov::FrequentPaths paths;
  std::optional<LumpedChain> lumped;
  tbb::parallel_invoke(
      [&] {
        paths = markov::most_frequent_paths(c.chain, cells, c.start, field.max_gates,
                                            passages.chance(), options.paths);
      },
      [&] { lumped = lumped_chain(chain, map, field, passages, options.lumping); });

  Analysis out{.target = options.target,
               .target_chance = passages.at_start(),
               .by_groups = !groups.empty(),
               .totals = passages.totals(),
               .gates = {},
               .costs = {},
               .costs_of = {},
               .walks = {},
               .endless = {},
               .why_not_endless = {},
               .endless_boundaries = {},
               .starts = {},
               .paths = std::move(paths),
               .passed = markov::CellProbabilities::Zero(field.rows, field.columns),
               .trapping = {},
               .state_trapping = {},
               .type_trapping = {},
               .types = {},
               .space = space,
               .lumping = options.lumping,
               .lumped = lumped};

  const auto of_totals = [&](const auto& value) {
    std::vector<double> parts;
    for (const Passages& g : groups) parts.push_back(value(g.totals()));
    return mean_95(value(out.totals), parts);
  };
  out.gates = of_totals([](const markov::WalkTotals& t) { return t.visits.sum(); });
  for (std::size_t k = 0; k < map.section.costs.size(); ++k) {
    out.costs.push_back(of_totals(
        [k](const markov::WalkTotals& t) { return markov::WalkTotals::all(t.totals[k]).mean(); }));
    for (std::size_t e = 0; e < markov::kEndings; ++e)
      out.costs_of[e].push_back(
          of_totals([k, e](const markov::WalkTotals& t) { return t.totals[k][e].mean(); }));
  }
  if (!out.costs.empty() && std::isfinite(out.costs[0].mean))
    out.walks = markov::timed_walks(c.chain, cells, c.start, field.max_gates, c.rewards,
                                    options.timed_walks, options.seed);

  std::vector<double> type_share(map.types.size(), 0.0);
  for (int row = 0; row < field.rows; ++row)
    for (int column = 0; column < field.columns; ++column)
      type_share[static_cast<std::size_t>(map.type_of(column, row))] +=
          1.0 / (static_cast<double>(field.rows) * field.columns);
  try {
    out.endless = markov::quasi_stationary(c.chain, type_share);
    out.endless_boundaries.assign(space.section().faces.size(), 0.0);
    for (int state = 0; state < space.size(); ++state)
      out.endless_boundaries[static_cast<std::size_t>(space.face(state))] +=
          out.endless->states[static_cast<std::size_t>(state)];
  } catch (const std::runtime_error& e) {
    out.why_not_endless = e.what();
  }

  out.starts = chances_of_starts(chain, map, field, problem.start.face, passages, groups);

  out.types.resize(map.types.size());
  const auto trapped_shares_of = trapped_shares(c.chain);
  const bool is_reached = out.target_chance > 0.0,
             of_trapped = options.target == markov::Ending::trapped;
  if (is_reached && !of_trapped) {
    out.trapping = out.passed;
    out.state_trapping.resize(static_cast<std::size_t>(space.size()));
    out.type_trapping.resize(map.types.size());
  }
  passages.each([&](const Passages::Place& place, double visits) {
    const auto type =
        static_cast<std::size_t>(map.type_of(static_cast<int>(place.cell % field.columns),
                                             static_cast<int>(place.cell / field.columns)));
    const double trapped = trapped_shares_of[type][static_cast<std::size_t>(place.input)];
    out.types[type].visits += visits;
    out.types[type].trapped += visits * trapped;
    if (!is_reached) return;
    const double part = visits * passages.chance(place) / out.target_chance;
    out.passed.data()[place.cell] += part;
    if (of_trapped || trapped >= 1.0) return;  // nobody goes on from there
    const double effect = part * trapped / (1.0 - trapped);
    out.trapping.data()[place.cell] += effect;
    out.type_trapping[type] += effect;
    if (place.input < space.size())
      out.state_trapping[static_cast<std::size_t>(place.input)] += effect;
  });
  out.seconds = watch.seconds();
  return out;
}

}  // namespace gatewalk::lattice
