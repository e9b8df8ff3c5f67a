// SPDX-License-Identifier: MIT
#include "markov/predict.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>

#include "markov/predict/plan.h"
#include "markov/predict/transient.h"
#include "markov/solvers.h"

namespace gatewalk::markov {
namespace {

using Solver = PredictOptions::Solver;

constexpr int kFarthest = 10'000;  // cells; planes have room for one such move beyond each end

std::ptrdiff_t number_of(const std::vector<Move>& moves, const Exit& exit) {
  return std::find_if(moves.begin(), moves.end(),
                      [&](const Move& m) { return m.di_x == exit.di_x && m.di_y == exit.di_y; }) -
         moves.begin();
}

/// Prepares a chain as stencils; the plan already lists the inputs that are entered.
PreparedChain prepare(const PredictionPlan& plan, const Chain& chain,
                      const std::vector<char>& is_entered) {
  PreparedChain prepared;
  std::vector<Entry> moves, ends, walking;
  moves.reserve(static_cast<std::size_t>(chain.matrix().nonZeros()));
  const std::vector<int> move_of = moves_of_exits(plan.moves, chain);
  std::vector<double> shares(kTallyMoved + plan.moves.size());  // shares of an input, by ending
  for (int input = 0; input < plan.inputs; ++input) {
    std::fill(shares.begin(), shares.end(), 0.0);
    // Only a start can be in any other input, and its first draw is separate.
    if (!is_entered[static_cast<std::size_t>(input)]) continue;
    if (chain.is_sampled(input)) {
      prepared.walking_inputs.push_back(input);
      walking.push_back({kTallyTotal, 0, input, 1.0});
    } else {
      prepared.unsampled.push_back(input);
      shares[kTallyUnsampled] = 1.0;
    }
    for (Probabilities::InnerIterator it(chain.matrix(), input); it; ++it) {
      const auto output = static_cast<std::size_t>(it.col());
      const int next = chain.exits()[output].next_input, move = move_of[output];
      if (next == Exit::kTrapped) {
        shares[kTallyTrapped] += it.value();
        continue;
      }
      shares[static_cast<std::size_t>(kTallyMoved + move)] += it.value();
      moves.push_back({next, move, input, it.value()});
    }
    for (std::size_t ending = 0; ending < shares.size(); ++ending)
      if (shares[ending] > 0.0)
        ends.push_back({static_cast<int>(ending), 0, input, shares[ending]});
  }
  prepared.moves = Stencil(moves);
  prepared.ends = Stencil(ends);
  prepared.walking = Stencil(walking);
  prepared.by_row = std::make_unique<const LazyRowStencils>(plan, chain);
  if (RowElimination::suits(chain))
    prepared.elimination = std::make_unique<const LazyRowElimination>(chain);
  return prepared;
}

Stencil totals_of(const std::vector<int>& inputs) {
  std::vector<Entry> entries;
  for (const int input : inputs) entries.push_back({kTallyTotal, 0, input, 1.0});
  return Stencil(entries);
}

std::unique_ptr<const PredictionPlan> plan_of(FieldChain field_chain) {
  auto plan = std::make_unique<PredictionPlan>(std::move(field_chain));
  const std::vector<Chain>& chains = plan->field_chain.chains();
  plan->has_uniform_rows = plan->field_chain.has_uniform_rows();
  plan->inputs = plan->field_chain.inputs();
  std::vector<char> is_entered(static_cast<std::size_t>(plan->inputs)), from_below(is_entered),
      sideways(is_entered);
  for (const Chain& chain : chains) {
    plan->outputs = std::max(plan->outputs, chain.outputs());
    std::vector<char> is_seen(static_cast<std::size_t>(chain.outputs()));
    for (Eigen::Index k = 0; k < chain.matrix().nonZeros(); ++k) {
      const auto output = static_cast<std::size_t>(chain.matrix().innerIndexPtr()[k]);
      const Exit& exit = chain.exits()[output];
      if (std::exchange(is_seen[output], 1) || exit.next_input == Exit::kTrapped) continue;
      if (std::max(exit.di_x, exit.di_y) > kFarthest || std::min(exit.di_x, exit.di_y) < -kFarthest)
        throw std::invalid_argument("predict: a move of (" + std::to_string(exit.di_x) + ", " +
                                    std::to_string(exit.di_y) + ") cells is more than " +
                                    std::to_string(kFarthest) +
                                    "; without a limit of cells solver klu takes it");
      const auto next = static_cast<std::size_t>(exit.next_input);
      is_entered[next] = 1;
      if (exit.di_y > 0) from_below[next] = 1;
      if (exit.di_y == 0) sideways[next] = 1;
      if (number_of(plan->moves, exit) == std::ssize(plan->moves))
        plan->moves.push_back({exit.di_x, exit.di_y});
    }
  }
  for (const Move& m : plan->moves) {
    plan->widest = std::max(plan->widest, std::abs(m.di_x));
    plan->lowest = std::min(plan->lowest, m.di_y);
    plan->highest = std::max(plan->highest, m.di_y);
    plan->is_chequered = plan->is_chequered && (m.di_x + m.di_y) % 2 != 0;
  }
  for (int input = 0; input < plan->inputs; ++input) {
    if (from_below[static_cast<std::size_t>(input)]) plan->from_below.push_back(input);
    if (sideways[static_cast<std::size_t>(input)]) plan->sideways.push_back(input);
  }
  plan->arriving = totals_of(plan->from_below);
  plan->staying = totals_of(plan->sideways);
  for (const Chain& chain : chains) {
    plan->chains.push_back(prepare(*plan, chain, is_entered));
    plan->most_terms = std::max(plan->most_terms, plan->chains.back().moves.most_terms);
  }
  return plan;
}

/// Whether the solver works without a prepared chain.
bool is_unprepared(Solver solver) { return solver == Solver::klu || solver == Solver::direct; }

void require_no_limit(const std::string& solver, const PredictOptions& options) {
  if (options.max_cells != 0)
    throw std::invalid_argument("predict: solver " + solver +
                                " takes no limit of cells, max_cells is " +
                                std::to_string(options.max_cells));
}

/// Runs the starts in groups of `size` side by side, the groups on all threads.
template <class Run>
MaybePredicted in_groups(const std::vector<Start>& starts, std::int64_t size, Run run) {
  MaybePredicted all(starts.size());
  const auto count = std::ssize(starts);
  tbb::parallel_for(std::int64_t{0}, (count + size - 1) / size, [&](std::int64_t g) {
    const auto first = starts.begin() + g * size;
    auto results = run(std::vector<Start>(first, first + std::min(size, count - g * size)));
    std::move(results.begin(), results.end(), all.begin() + g * size);
  });
  return all;
}

}  // namespace

std::vector<int> moves_of_exits(const std::vector<Move>& moves, const Chain& chain) {
  std::vector<int> numbers;
  for (const Exit& exit : chain.exits())
    numbers.push_back(static_cast<int>(number_of(moves, exit)));
  return numbers;
}

std::optional<FinalDistribution> solve_circles(const FieldChain& chain, const Field& field,
                                               const Start& start, double most_operations) {
  if (!fits_pair_by_pair(chain, field)) return {};
  if (auto direct = solve_directly(chain, field, start, most_operations)) return direct;
  constexpr double kMostNumbers = 2e8;  // about 3 GB, so only one start at a time
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
  try {
    return solve_by_klu(chain, field, start, kMostNumbers);
  } catch (const std::runtime_error&) {  // too few digits, or the factors are too large
    return {};
  }
}

Predictor::Predictor(FieldChain chain) : plan_(plan_of(std::move(chain))) {}

Predictor::~Predictor() = default;

bool Predictor::can_go_by_rows() const { return plan_->lowest >= 0; }

std::vector<FinalDistribution> Predictor::predict_all(const Field& field,
                                                      const std::vector<Start>& starts,
                                                      const PredictOptions& options) const {
  if (is_unprepared(options.solver))
    return markov::predict(plan_->field_chain, field, starts, options);
  for (const Start& s : starts) validate(plan_->field_chain, field, s, options.max_cells);
  const bool by_rows =
      options.solver == Solver::rows ||
      (options.solver == Solver::automatic && options.max_cells == 0 && can_go_by_rows());
  if (!(options.tolerance.value_or(0.0) >= 0.0) || options.max_steps < (by_rows ? 1 : 0))
    throw std::invalid_argument(
        "predict: tolerance and max_steps must not be negative, by rows max_steps be positive");
  if (by_rows) {
    require_no_limit("rows", options);
    if (!can_go_by_rows())
      throw std::invalid_argument(
          "predict: solver march goes from row to row upwards, and this chain has moves to a row "
          "below: solvers auto and klu take them");
  }
  // Measured: a few small fields together leave fewer lanes empty; more of them exceed the cache.
  const std::int64_t cells = std::int64_t{field.columns} * field.rows,
                     together =
                         std::clamp<std::int64_t>(by_rows ? 40 / field.columns : 400 / cells, 1, 4);
  const auto run = [&](const std::vector<Start>& some, bool may_stop) {
    return in_groups(some, together, [&](const auto& group) {
      return by_rows ? predict_by_rows(*plan_, field, group, options, may_stop)
                     : predict_by_steps(*plan_, field, group, options, may_stop);
    });
  };
  MaybePredicted found = run(starts, options.solver == Solver::automatic && options.max_cells == 0);
  tbb::parallel_for(std::size_t{0}, found.size(), [&](std::size_t k) {
    if (!found[k]) found[k] = solve_circles(plan_->field_chain, field, starts[k]);
    if (!found[k]) found[k] = std::move(run({starts[k]}, false).front());
  });
  std::vector<FinalDistribution> all;
  for (auto& one : found) all.push_back(*std::move(one));
  return all;
}

FinalDistribution Predictor::predict(const Field& field, const Start& start,
                                     const PredictOptions& options) const {
  return std::move(predict_all(field, {start}, options).front());
}

std::vector<FinalDistribution> predict(const FieldChain& chain, const Field& field,
                                       const std::vector<Start>& starts,
                                       const PredictOptions& options) {
  if (!is_unprepared(options.solver)) return Predictor(chain).predict_all(field, starts, options);
  require_no_limit(options.solver == Solver::klu ? "klu" : "direct", options);
  std::vector<FinalDistribution> all;
  for (const Start& s : starts) {
    if (options.solver == Solver::klu) {
      all.push_back(solve_absorption(chain, field, s));
    } else {
      auto one = solve_directly(chain, field, s);
      if (!one) throw std::runtime_error("predict: the field is too large for solver direct");
      all.push_back(*std::move(one));
    }
  }
  return all;
}

}  // namespace gatewalk::markov
