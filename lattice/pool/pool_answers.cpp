// SPDX-License-Identifier: MIT
#include "lattice/pool/pool_answers.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "markov/walk.h"

namespace gatewalk::lattice {
namespace {

using markov::FinalDistribution;

// Above kMostExact multiplications answers come from walks: kWalks for all trials, kWalksOfGroup
// for each group.
constexpr double kMostExact = 1e9;
constexpr std::int64_t kWalks = std::int64_t{1} << 22, kWalksOfGroup = std::int64_t{1} << 18;

/// About the number of multiplications that an exact prediction takes.
double exact_cost(std::int64_t nonzeros, const FieldParams& field) {
  constexpr double kStepsWithoutLimit = 50.0;
  const double cells = static_cast<double>(field.columns) * field.rows;
  const double steps = field.max_gates;
  return static_cast<double>(nonzeros) * (field.max_gates == 0
                                              ? cells * kStepsWithoutLimit
                                              : std::min(cells, 2.0 * steps * steps) * steps / 2.0);
}

/// Whether answers come from Monte Carlo walks. A single column has few cells and is always
/// predicted exactly.
bool by_walks(std::int64_t nonzeros, const FieldParams& field) {
  return field.columns > 1 && exact_cost(nonzeros, field) > kMostExact;
}

/// Whether the adjoints of all chains cost less. Measured: an adjoint takes about as long as one
/// prediction per cell; error bars ask for several rows of each start, so adjoints pay from a
/// quarter as many starts as cells. Adjoints go through all steps, also those after which no body
/// walks any more, and need gates of one type.
bool pays_adjoint(const dynamics::CellMap& map, const FieldParams& field, std::size_t starts) {
  return map.types.size() == 1 && field.max_gates > 0 &&
         field.max_gates <= 2 * (field.columns + field.rows) &&
         4 * static_cast<std::int64_t>(starts) >= std::int64_t{field.columns} * field.rows;
}

/// Whether adjoints fit into memory for chains with leaves of this many entries: the numbers that
/// they keep (about 2 per cell and state) and need meanwhile (about 8).
bool fits_adjoint(const RunPool& pool, const FieldParams& field, int leaf) {
  constexpr std::int64_t kMostNumbers = 400'000'000;
  const std::int64_t cells = std::int64_t{field.columns} * field.rows,
                     states = 2 * 2 * kernel_runs(pool) / leaf;  // of all chains, at most
  return 10 * cells * states <= kMostNumbers;
}

/// The shares of a walk tally as a prediction.
FinalDistribution prediction_of(const markov::WalkTally& tally) {
  const auto n = static_cast<double>(tally.walks);
  const auto share = [&](std::int64_t count) { return static_cast<double>(count) / n; };
  FinalDistribution d{shares_of(tally, share)};
  d.remainder = share(tally.still_walking);
  d.mean_steps = share(tally.steps);
  return d;
}

/// Exact predictions, or predictions from `walks` if there are any.
KernelAnswers answers_of(const Kernel& kernel, const dynamics::CellMap& map,
                         const markov::Counts& first_rows, const FieldParams& field,
                         markov::WalkRange walks, std::uint64_t seed) {
  std::vector<markov::Start> places;
  for (int i = 0; i < first_rows.rows(); ++i)
    places.push_back({field.start_column(), field.start_row, kernel.space.size() + i});
  const markov::Field cells{field.columns, field.rows};
  const markov::FieldChain chain = chain_of(kernel, map, field, first_rows);
  if (walks.count == 0)
    return {markov::predict(chain, cells, places, {.max_cells = field.max_gates})};
  const markov::Walker walker(chain);
  KernelAnswers answers{{}, walks.count};
  for (const markov::Start& start : places)
    answers.final.push_back(prediction_of(walker.walk(cells, start, field.max_gates, seed, walks)));
  return answers;
}

/// The mean of these rows as one row; each of them has the same weight.
markov::Counts mean_row(const markov::Counts& rows) {
  if (rows.rows() == 1) return rows;
  constexpr double kParts = 1099511627776.0;  // 2^40, so that rounding does not matter
  std::vector<Eigen::Triplet<std::int64_t>> all;
  for (Eigen::Index row = 0; row < rows.rows(); ++row) {
    const auto runs = static_cast<double>(rows.row(row).sum());
    for (markov::Counts::InnerIterator it(rows, row); it; ++it)
      all.emplace_back(0, static_cast<int>(it.col()),
                       std::llround(kParts * static_cast<double>(it.value()) / runs));
  }
  markov::Counts mean(1, rows.cols());
  mean.setFromTriplets(all.begin(), all.end());
  return mean;
}

}  // namespace

int ending_leaf(const RunPool& pool, int per_leaf) {
  constexpr std::int64_t kLeast = 2, kMostStates = 50'000;
  if (per_leaf > dynamics::kEntriesPerLeaf) return per_leaf;
  return static_cast<int>(
      std::min<std::int64_t>(per_leaf, std::max(kLeast, 2 * kernel_runs(pool) / kMostStates)));
}

std::vector<std::optional<SmallLeaves>> by_small_leaves(const dynamics::CellMap& map,
                                                        const FieldParams& field,
                                                        const RunPool& pool,
                                                        const std::vector<FirstRow>& starts,
                                                        int leaf, TrialGroup group) {
  std::vector<std::optional<SmallLeaves>> found(starts.size());
  std::vector<FirstRow> asked;
  std::vector<std::size_t> place;
  for (std::size_t i = 0; i < starts.size(); ++i)
    if (!std::holds_alternative<dynamics::Entry>(starts[i])) {
      asked.push_back(starts[i]);
      place.push_back(i);
    }
  const bool adjoint = pays_adjoint(map, field, asked.size());
  if (asked.empty() || (adjoint && !fits_adjoint(pool, field, leaf))) return found;
  const Kernel kernel = kernel_of(map, pool, leaf, group);
  const markov::Counts rows = first_rows(
      kernel, map, pool, asked, map.type_of(field.start_column(), field.start_row), {group});
  if (!adjoint) {
    const KernelAnswers answers = answers_of(kernel, map, rows, field, {}, 0);
    for (std::size_t i = 0; i < asked.size(); ++i)
      found[place[i]] = SmallLeaves{answers.final[i].endings, answers.final[i].final_cells};
    return found;
  }
  const markov::EndTable chances = markov::ending_chances(
      chain_of(kernel, map, field, {}).chains().front(), {field.columns, field.rows},
      field.start_column(), field.start_row, field.max_gates);
  for (std::size_t i = 0; i < asked.size(); ++i) {
    EndingsOf& of = found[place[i]].emplace().endings;
    const auto row = static_cast<Eigen::Index>(i);
    const auto all = static_cast<double>(rows.row(row).sum());
    for (markov::Counts::InnerIterator it(rows, row); it; ++it)
      for (std::size_t e = 0; e < of.size(); ++e)
        of[e] +=
            static_cast<double>(it.value()) / all * chances(it.col(), static_cast<Eigen::Index>(e));
    if (!(all > 0.0)) of[static_cast<std::size_t>(markov::Ending::unsampled)] = 1.0;
  }
  return found;
}

std::optional<GroupedMaps> mean_maps(const dynamics::CellMap& map, const FieldParams& field,
                                     const RunPool& pool, const std::vector<FirstRow>& starts,
                                     int leaf, std::optional<int> per_row) {
  if (by_walks(2 * kernel_runs(pool), field)) return {};
  GroupedMaps maps{.whole = {}, .groups = std::vector<markov::CellProbabilities>(kTrialGroups)};
  tbb::parallel_for(-1, kTrialGroups, [&](int g) {
    const TrialGroup group = g < 0 ? TrialGroup{} : TrialGroup{g, kTrialGroups};
    const Kernel kernel = kernel_of(map, pool, leaf, group, per_row);
    const markov::Counts rows = mean_row(first_rows(
        kernel, map, pool, starts, map.type_of(field.start_column(), field.start_row), {group}));
    FinalDistribution found = std::move(answers_of(kernel, map, rows, field, {}, 0).final.front());
    if (g < 0) maps.unsampled = found.unsampled();
    (g < 0 ? maps.whole : maps.groups[static_cast<std::size_t>(g)]) = std::move(found.final_cells);
  });
  return maps;
}

FinalDistribution with_endings(FinalDistribution prediction, const EndingsOf& endings) {
  EndingsOf times;
  for (std::size_t e = 0; e < times.size(); ++e)
    if (prediction.endings[e] == 0.0 && endings[e] > kShareRounding) return prediction;
  for (std::size_t e = 0; e < times.size(); ++e)
    times[e] = prediction.endings[e] > 0.0 ? endings[e] / prediction.endings[e] : 1.0;
  for (std::size_t e = 0; e < times.size(); ++e) prediction.endings[e] *= times[e];
  // In all cells that are not mixed every body was trapped.
  markov::CellProbabilities trapped = trapped_cells(prediction);
  trapped *= times[static_cast<std::size_t>(markov::Ending::trapped)];
  prediction.final_cells = trapped;
  for (auto& cell : prediction.mixed_cells) {
    double sum = 0.0;
    for (std::size_t e = 0; e < times.size(); ++e) sum += cell.by_ending[e] *= times[e];
    prediction.final_cells.data()[cell.cell] = sum;
  }
  return prediction;
}

KernelAnswers answers_of(const Kernel& kernel, const dynamics::CellMap& map,
                         const markov::Counts& first_rows, const FieldParams& field,
                         std::uint64_t seed) {
  const std::int64_t of_a_type = kernel.nonzeros() / std::ssize(kernel.counts);
  return answers_of(kernel, map, first_rows, field, {0, by_walks(of_a_type, field) ? kWalks : 0},
                    seed);
}

GroupedMaps PoolAnswer::maps() const {
  GroupedMaps maps{whole.final_cells, {}, whole.unsampled()};
  for (const FinalDistribution& group : groups) maps.groups.push_back(group.final_cells);
  return maps;
}

std::optional<GroupedMaps> PoolAnswer::maps_of_small_leaves() const {
  if (!small_leaves || small_leaves->whole.final_cells.size() == 0) return {};
  const auto& [all, of_groups] = *small_leaves;
  GroupedMaps maps{
      all.final_cells, {}, all.endings[static_cast<std::size_t>(markov::Ending::unsampled)]};
  for (const SmallLeaves& group : of_groups) maps.groups.push_back(group.final_cells);
  return maps;
}

PoolChains::PoolChains(const dynamics::CellMap& map, const FieldParams& field, int per_leaf,
                       std::size_t starts, std::uint64_t seed)
    : map_(map),
      field_(field),
      ending_per_leaf_(per_leaf),
      per_leaf_(pays_adjoint(map, field, starts) ? 2 * per_leaf : per_leaf),
      seed_(seed) {}

bool PoolChains::by_adjoint(const RunPool& pool, std::size_t starts) const {
  return pays_adjoint(map_, field_, starts) && fits_adjoint(pool, field_, per_leaf_);
}

void PoolChains::renew(const RunPool& pool) {
  const std::int64_t runs = kernel_runs(pool);
  if (std::exchange(runs_, runs) == runs) return;
  by_walks_ = by_walks(2 * runs, field_);  // some nonzeros per run
  std::vector<std::optional<Kernel>> kernels(kTrialGroups + 1);
  tbb::parallel_for(-1, kTrialGroups, [&](int g) {
    const TrialGroup group = g < 0 ? TrialGroup{} : TrialGroup{g, kTrialGroups};
    kernels[static_cast<std::size_t>(g + 1)] = kernel_of(map_, pool, per_leaf_, group);
  });
  chains_.clear();
  for (auto& kernel : kernels) chains_.push_back({.kernel = std::move(*kernel)});
}

KernelAnswers PoolChains::answers(const GroupChain& chain, int group,
                                  const markov::Counts& rows) const {
  if (!chain.adjoint) {
    const std::int64_t walks = group < 0 ? kWalks : kWalksOfGroup;
    return answers_of(chain.kernel, map_, rows, field_,
                      {group < 0 ? 0 : kWalks + group * kWalksOfGroup, by_walks_ ? walks : 0},
                      seed_);
  }
  KernelAnswers answers;
  for (Eigen::Index row = 0; row < rows.rows(); ++row) {
    std::vector<std::int64_t> counts(static_cast<std::size_t>(rows.cols()), 0);
    for (markov::Counts::InnerIterator it(rows, row); it; ++it)
      counts[static_cast<std::size_t>(it.col())] = it.value();
    answers.final.push_back(chain.adjoint->predict(counts));
  }
  return answers;
}

PoolAnswers PoolChains::ask(const RunPool& pool, const std::vector<FirstRow>& starts) {
  renew(pool);
  if (!chains_.front().adjoint && by_adjoint(pool, starts.size()))
    tbb::parallel_for(std::size_t{0}, chains_.size(), [&](std::size_t g) {
      GroupChain& c = chains_[g];
      c.adjoint.emplace(chain_of(c.kernel, map_, field_, {}).chains().front(),
                        markov::Field{field_.columns, field_.rows}, field_.start_column(),
                        field_.start_row, field_.max_gates);
    });
  const std::size_t n = starts.size();
  const bool with_kernels = !by_walks_ || chains_.front().adjoint;
  const Kernel& all = chains_.front().kernel;
  PoolAnswers said{std::vector<PoolAnswer>(n), all.space.size(), all.nonzeros()};
  const int coordinates = coordinates_cut(all.space);
  for (std::size_t i = 0; i < n; ++i) {
    PoolAnswer& of = said.starts[i];
    of.groups.resize(kTrialGroups);
    if (with_kernels) of.kernels.resize(kTrialGroups);
    of.pool_trials = pool.trials();
    of.coordinates = coordinates;
    if (const auto* const own = std::get_if<const OwnRuns*>(&starts[i]))
      of.unseen = missing_mass(all, map_, field_, **own);
  }
  tbb::parallel_for(-1, kTrialGroups, [&](int g) {
    const GroupChain& chain = chains_[static_cast<std::size_t>(g + 1)];
    std::vector<TrialGroup> groups;
    if (g >= 0) groups.push_back({g, kTrialGroups});
    if (g < 0 || with_kernels) groups.emplace_back();
    KernelAnswers found =
        answers(chain, g,
                first_rows(chain.kernel, map_, pool, starts,
                           map_.type_of(field_.start_column(), field_.start_row), groups));
    const auto at = static_cast<std::size_t>(g);
    for (std::size_t i = 0; i < n; ++i) {
      PoolAnswer& of = said.starts[i];
      if (g < 0) of.walks = found.walks;
      (g < 0 ? of.whole : of.groups[at]) = std::move(found.final[i]);
      if (g >= 0 && with_kernels) of.kernels[at] = std::move(found.final[n + i]);
    }
  });
  return said;
}

bool PoolChains::add_endings(const RunPool& pool, const std::vector<FirstRow>& starts,
                             PoolAnswers& said) const {
  const int leaf = ending_leaf(pool, ending_per_leaf_);
  if (said.by_walks() || leaf >= ending_per_leaf_) return false;
  std::array<std::vector<std::optional<SmallLeaves>>, kTrialGroups + 1> found;
  tbb::parallel_for(-1, kTrialGroups, [&](int g) {
    const TrialGroup group = g < 0 ? TrialGroup{} : TrialGroup{g, kTrialGroups};
    found[static_cast<std::size_t>(g + 1)] =
        by_small_leaves(map_, field_, pool, starts, leaf, group);
  });
  for (std::size_t i = 0; i < starts.size(); ++i) {
    if (!found[0][i]) continue;
    auto& of = said.starts[i].small_leaves;
    of = {.whole = *found[0][i], .groups = {}};
    for (std::size_t g = 0; g < kTrialGroups; ++g) of->groups[g] = *found[g + 1][i];
  }
  return true;
}

}  // namespace gatewalk::lattice
