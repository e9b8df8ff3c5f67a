// SPDX-License-Identifier: MIT
#include "markov/lumping.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

#include "markov/totals.h"

namespace gatewalk::markov {
namespace {

[[noreturn]] void refuse_lumping(const std::string& what) {
  throw std::invalid_argument("lumping: " + what);
}

int number_of_groups(const Chain& chain, const std::vector<int>& group_of,
                     const std::vector<double>& weights) {
  const auto inputs = static_cast<std::size_t>(chain.inputs());
  if (group_of.size() != inputs || weights.size() != inputs)
    refuse_lumping(std::to_string(group_of.size()) + " groups and " +
                   std::to_string(weights.size()) + " weights for " + std::to_string(inputs) +
                   " states");
  std::vector<char> is_named(inputs);
  for (std::size_t i = 0; i < inputs; ++i) {
    if (group_of[i] < 0 || group_of[i] >= chain.inputs())
      refuse_lumping("state " + std::to_string(i) + " (counted from 0) is in group " +
                     std::to_string(group_of[i]) + " of " + std::to_string(inputs) + " at most");
    if (!(weights[i] >= 0.0 && std::isfinite(weights[i])))
      refuse_lumping("the weight of state " + std::to_string(i) +
                     " (counted from 0) is negative or no number");
    is_named[static_cast<std::size_t>(group_of[i])] = 1;
  }
  const auto groups = std::find(is_named.begin(), is_named.end(), 0) - is_named.begin();
  for (const int g : group_of)
    if (g >= groups)
      refuse_lumping("group " + std::to_string(groups) + " has no state, but later ones do");
  return static_cast<int>(groups);
}

/// The outputs merged by the group and cell to which they lead, in the order of the chain's
/// outputs.
std::vector<Exit> lumped_exits(const Chain& chain, const std::vector<int>& group_of,
                               std::vector<Eigen::Index>& lumped_output) {
  std::vector<Exit> exits;
  std::map<std::array<int, 3>, Eigen::Index> known;
  for (const Exit& exit : chain.exits()) {
    Exit to = exit;
    if (exit.next_input != Exit::kTrapped)
      to.next_input = group_of[static_cast<std::size_t>(exit.next_input)];
    const auto [it, is_new] =
        known.try_emplace({to.next_input, to.di_x, to.di_y}, std::ssize(exits));
    if (is_new) exits.push_back(to);
    lumped_output.push_back(it->second);
  }
  return exits;
}

double total_variation(const Eigen::ArrayXd& a, const Eigen::ArrayXd& b) {
  return 0.5 * (a - b).abs().sum();
}

}  // namespace

Lumping lump(const Chain& chain, const std::vector<int>& group_of,
             const std::vector<double>& weights) {
  const int groups = number_of_groups(chain, group_of, weights);
  std::vector<Eigen::Index> lumped_output;
  std::vector<Exit> exits = lumped_exits(chain, group_of, lumped_output);
  // Sampled states of each group.
  std::vector<std::vector<int>> sampled(static_cast<std::size_t>(groups));
  for (int input = 0; input < chain.inputs(); ++input)
    if (chain.is_sampled(input))
      sampled[static_cast<std::size_t>(group_of[static_cast<std::size_t>(input)])].push_back(input);

  Probabilities p(groups, std::ssize(exits));
  std::vector<Lumping::Group> all(sampled.size());
  for (std::size_t g = 0; g < sampled.size(); ++g) {
    const std::vector<int>& states = sampled[g];
    Lumping::Group& group = all[g];
    std::vector<Eigen::ArrayXd> rows;  // lumped rows of the group's states
    Eigen::ArrayXd shares(std::ssize(states));
    for (std::size_t i = 0; i < states.size(); ++i) {
      Eigen::ArrayXd row = Eigen::ArrayXd::Zero(std::ssize(exits));
      for (Probabilities::InnerIterator it(chain.matrix(), states[i]); it; ++it)
        row(lumped_output[static_cast<std::size_t>(it.col())]) += it.value();
      rows.push_back(std::move(row));
      shares(static_cast<Eigen::Index>(i)) = weights[static_cast<std::size_t>(states[i])];
    }
    if (states.empty()) continue;
    group.weight = shares.sum();
    if (group.weight > 0.0)
      shares /= group.weight;
    else
      shares.setConstant(1.0 / static_cast<double>(states.size()));
    Eigen::ArrayXd mean = Eigen::ArrayXd::Zero(std::ssize(exits));
    for (std::size_t i = 0; i < rows.size(); ++i)
      mean += shares(static_cast<Eigen::Index>(i)) * rows[i];
    if (rows.size() > 1) mean /= mean.sum();  // the sum is 1 up to rounding
    for (std::size_t i = 0; i < rows.size(); ++i) {
      group.mean += shares(static_cast<Eigen::Index>(i)) * total_variation(rows[i], mean);
      for (std::size_t j = 0; j < i; ++j)
        group.largest = std::max(group.largest, total_variation(rows[i], rows[j]));
    }
    for (Eigen::Index j = 0; j < mean.size(); ++j)
      if (mean(j) != 0.0) p.insert(static_cast<Eigen::Index>(g), j) = mean(j);
  }
  Lumping lumping{Chain::from_probabilities(std::move(p), std::move(exits)), std::move(all)};
  double weight = 0.0;
  for (const Lumping::Group& group : lumping.groups) {
    weight += group.weight;
    lumping.largest += group.weight * group.largest;
    lumping.mean += group.weight * group.mean;
  }
  if (weight > 0.0) {
    lumping.largest /= weight;
    lumping.mean /= weight;
  }
  return lumping;
}

std::vector<double> expected_visits(const FieldChain& chain, const Field& field, const Start& start,
                                    int max_cells) {
  std::vector<double> visits(static_cast<std::size_t>(chain.inputs()), 0.0);
  const WalkTotals totals = walk_totals(chain, field, start, max_cells, {},
                                        [&](int, std::int64_t, int input, double share) {
                                          visits[static_cast<std::size_t>(input)] += share;
                                        },
                                        {.all = 1e-13});
  if (totals.remainder > 1e-13)
    throw std::runtime_error(
        fmt::format("expected visits: a share of {:.2g} still walks", totals.remainder));
  return visits;
}

LumpingError lumping_error(const FieldChain& fine, const FieldChain& lumped,
                           const std::vector<int>& group_of, const Field& field, const Start& start,
                           const PredictOptions& options) {
  validate(fine, field, start, options.max_cells);
  if (std::ssize(group_of) != fine.inputs())
    refuse_lumping(std::to_string(group_of.size()) + " groups for " +
                   std::to_string(fine.inputs()) + " states");
  const Start of_group{start.column, start.row, group_of[static_cast<std::size_t>(start.input)]};
  LumpingError error;
  error.fine = std::move(predict(fine, field, {start}, options).front());
  error.lumped = std::move(predict(lumped, field, {of_group}, options).front());
  for (std::size_t e = 0; e < kEndings; ++e)
    error.endings += 0.5 * std::abs(error.fine.endings[e] - error.lumped.endings[e]);
  error.final_cells = 0.5 * (error.fine.final_cells - error.lumped.final_cells).abs().sum();
  return error;
}

}  // namespace gatewalk::markov
