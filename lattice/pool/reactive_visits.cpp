// SPDX-License-Identifier: MIT
#include "lattice/pool/reactive_visits.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstdlib>
#include <mutex>
#include <optional>
#include <utility>

namespace gatewalk::lattice {

ReactiveVisits::ReactiveVisits(const ChainWithRewards& c, const FieldParams& field,
                               markov::Ending target, const Parts& parts)
    : chance_(c.chain, {field.columns, field.rows}, target, field.max_gates, parts.tolerance,
              c.start),
      at_start_(
          chance_(1, std::int64_t{c.start.row} * field.columns + c.start.column, c.start.input)),
      limited_(field.max_gates > 0),
      inputs_(c.chain.inputs()),
      cells_(std::int64_t{field.columns} * field.rows),
      state_visits_(static_cast<std::size_t>(c.chain.inputs()), 0.0) {
  constexpr double kOfChance = 0.25;  // part of the time, about
  double told = 0.0;
  const auto tell = [&](double part) {
    if (!parts.told || part <= told) return;
    parts.told(part - told);
    told = part;
  };
  tell(kOfChance);
  if (parts.places)
    shares_.resize(static_cast<std::size_t>((limited_ ? field.max_gates : 1) * cells_));
  totals_ = markov::walk_totals(
      c.chain, {field.columns, field.rows}, c.start, field.max_gates,
      parts.costs ? c.rewards : markov::Rewards{},
      [&](int draw, std::int64_t cell, int input, double share) {
        to_target_ += share * chance_(draw, cell, input);
        state_visits_[static_cast<std::size_t>(input)] += share;
        if (!parts.places) return;
        auto& here = shares_[static_cast<std::size_t>((limited_ ? draw - 1 : 0) * cells_ + cell)];
        if (here.empty()) {
          here.resize(static_cast<std::size_t>(inputs_), 0.0);
          tell(kOfChance + (1.0 - kOfChance) * static_cast<double>(limited_ ? draw - 1 : cell) /
                               static_cast<double>(limited_ ? field.max_gates : cells_));
        }
        here[static_cast<std::size_t>(input)] += share;
      },
      {.chance = &chance_, .of_row = parts.tolerance});
  tell(1.0);
}

ReactiveVisits::Draws::Draws(const ReactiveVisits& passages) : passages_(passages) {
  double all = 0.0, to_target = 0.0;
  for (std::size_t layer = 0; layer < passages.shares_.size(); ++layer) {
    if (passages.shares_[layer].empty()) continue;
    passed_.push_back(layer);
    Place at = passages.place_of(layer);
    for (const double share : passages.shares_[layer]) {
      all_.push_back(all += share);
      to_target_.push_back(to_target += share * passages.chance(at));
      ++at.input;
    }
  }
}

ReactiveVisits::Place ReactiveVisits::Draws::place(double uniform) const {
  const auto& sums = uniform < 0.5 ? all_ : to_target_;
  const double part = (uniform < 0.5 ? uniform : uniform - 0.5) * 2.0 * sums.back();
  const auto at = std::min<std::ptrdiff_t>(
      std::upper_bound(sums.begin(), sums.end(), part) - sums.begin(), std::ssize(sums) - 1);
  Place place = passages_.place_of(passed_[static_cast<std::size_t>(at / passages_.inputs_)]);
  place.input = static_cast<int>(at % passages_.inputs_);
  return place;
}

AllReactiveVisits all_reactive_visits(const AnalysedChain& chain, const FieldParams& field,
                                      markov::Ending target, const ReactiveVisits::Parts& of_whole,
                                      const ReactiveVisits::Parts& of_groups, std::string_view what,
                                      const dynamics::Work& work) {
  std::vector<const ChainWithRewards*> chains{&chain.chain};
  for (const AnalysedChain& group : chain.groups) chains.push_back(&group.chain);
  std::vector<std::optional<ReactiveVisits>> parts(chains.size());
  std::mutex telling;
  std::int64_t done = 0;
  work.tell(what, 0, std::ssize(chains));
  tbb::parallel_for(std::size_t{0}, chains.size(), [&](std::size_t k) {
    parts[k].emplace(*chains[k], field, target, k == 0 ? of_whole : of_groups);
    const std::lock_guard lock(telling);
    work.tell(what, ++done, std::ssize(chains));
  });
  AllReactiveVisits all{std::move(*parts.front()), {}};
  for (std::size_t k = 1; k < parts.size(); ++k) all.groups.push_back(std::move(*parts[k]));
  return all;
}

std::vector<std::vector<double>> trapped_shares(const markov::FieldChain& field) {
  std::vector<std::vector<double>> shares;
  for (const markov::Chain& chain : field.chains()) {
    auto& of_type = shares.emplace_back(static_cast<std::size_t>(chain.inputs()), 0.0);
    for (int input = 0; input < chain.inputs(); ++input)
      for (markov::Probabilities::InnerIterator it(chain.matrix(), input); it; ++it)
        if (chain.exits()[static_cast<std::size_t>(it.col())].next_input == markov::Exit::kTrapped)
          of_type[static_cast<std::size_t>(input)] += it.value();
  }
  return shares;
}

markov::CellProbabilities final_cells(const ChainWithRewards& c, const FieldParams& field,
                                      const ReactiveVisits& passages) {
  const markov::FieldChain& chain = c.chain;
  const markov::Field cells{field.columns, field.rows};
  markov::CellProbabilities ends = markov::CellProbabilities::Zero(field.rows, field.columns);
  const auto is_sampled = [&](std::int64_t column, std::int64_t row, int input) {
    return chain.at(column, row).is_sampled(input);
  };
  if (!is_sampled(c.start.column, c.start.row, c.start.input))
    ends(c.start.row, c.start.column) = 1.0;
  const auto trapped = trapped_shares(chain);
  // The farthest move of any exit: most cells are farther than this from all edges.
  std::int64_t far = 0;
  bool all_sampled = true;
  for (const markov::Chain& one : chain.chains()) {
    for (const markov::Exit& exit : one.exits())
      far = std::max<std::int64_t>({far, std::abs(exit.di_x), std::abs(exit.di_y)});
    for (int input = 0; input < one.inputs(); ++input)
      all_sampled = all_sampled && one.is_sampled(input);
  }
  passages.each([&](const ReactiveVisits::Place& place, double share) {
    const std::int64_t column = place.cell % field.columns, row = place.cell / field.columns;
    double& here = ends.data()[place.cell];
    const bool is_last = place.draw == field.max_gates;
    if (all_sampled && !is_last && std::min(column, row) >= far && column + far < field.columns &&
        row + far < field.rows) {
      here += share * trapped[static_cast<std::size_t>(chain.type_of(column, row))]
                             [static_cast<std::size_t>(place.input)];
      return;
    }
    const markov::Chain& draws = chain.at(column, row);
    for (markov::Probabilities::InnerIterator it(draws.matrix(), place.input); it; ++it) {
      const markov::Exit& exit = draws.exits()[static_cast<std::size_t>(it.col())];
      std::int64_t to_column = column, to_row = row;
      if (markov::follow(cells, exit, is_last, to_column, to_row))
        here += share * it.value();
      else if (!is_sampled(to_column, to_row, exit.next_input))
        ends(to_row, to_column) += share * it.value();
    }
  });
  return ends;
}

}  // namespace gatewalk::lattice
