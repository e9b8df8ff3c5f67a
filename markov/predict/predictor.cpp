#include "markov/predict/predictor.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "markov/predict/plan.h"

namespace gatewalk::markov {
namespace {

constexpr int kFarthest = 10'000;  // cells; planes have room for a move beyond each end

std::ptrdiff_t number_of(const std::vector<Move>& moves, const Exit& exit) {
  return std::find_if(moves.begin(), moves.end(),
                      [&](const Move& m) { return m.di_x == exit.di_x && m.di_y == exit.di_y; }) -
         moves.begin();
}

/// Prepares a chain; the plan knows what is entered already.
PreparedChain prepare(const PredictionPlan& plan, const Chain& chain,
                      const std::vector<char>& is_entered) {
  const auto is_in = [&](const std::vector<int>& inputs) {
    std::vector<char> in(static_cast<std::size_t>(plan.inputs));
    for (const int input : inputs) in[static_cast<std::size_t>(input)] = 1;
    return in;
  };
  const std::vector<char> from_below = is_in(plan.from_below), sideways = is_in(plan.sideways);
  PreparedChain prepared{chain, {}, {}, {}, {}, {}, {}, {}, {}, nullptr, 0.0};
  std::vector<Entry> moves, first_sideways, further_sideways, ends, walking;
  std::vector<std::vector<Entry>> upwards(static_cast<std::size_t>(plan.highest));
  std::vector<double> shares(kTallyMoved + plan.moves.size());  // of an input, by ending
  for (int input = 0; input < plan.inputs; ++input) {
    const auto i = static_cast<std::size_t>(input);
    std::fill(shares.begin(), shares.end(), 0.0);
    double stays = 0.0;
    if (!is_entered[i])
      continue;  // no mass but that of a start, of which the first draw is made apart
    if (chain.is_sampled(input)) {
      prepared.walking_inputs.push_back(input);
      walking.push_back({kTallyTotal, 0, input, 1.0});
    } else {
      prepared.unsampled.push_back(input);
      shares[kTallyUnsampled] = 1.0;
    }
    for (Probabilities::InnerIterator it(chain.matrix(), input); it; ++it) {
      const Exit& exit = chain.exits()[static_cast<std::size_t>(it.col())];
      if (exit.next_input == Exit::kTrapped) {
        shares[kTallyTrapped] += it.value();
        continue;
      }
      const auto move = static_cast<int>(number_of(plan.moves, exit));
      const Entry entry{exit.next_input, move, input, it.value()};
      shares[static_cast<std::size_t>(kTallyMoved + move)] += it.value();
      moves.push_back(entry);
      if (exit.di_y > 0) upwards[static_cast<std::size_t>(exit.di_y) - 1].push_back(entry);
      if (exit.di_y == 0 && from_below[i]) first_sideways.push_back(entry);
      if (exit.di_y == 0 && sideways[i]) {
        further_sideways.push_back(entry);
        stays += it.value();
      }
    }
    prepared.stays = std::max(prepared.stays, stays);
    for (std::size_t ending = 0; ending < shares.size(); ++ending)
      if (shares[ending] > 0.0)
        ends.push_back({static_cast<int>(ending), 0, input, shares[ending]});
  }
  prepared.moves = Stencil(moves);
  prepared.first_sideways = Stencil(first_sideways);
  prepared.sideways = Stencil(further_sideways);
  for (const auto& entries : upwards) prepared.upwards.emplace_back(entries);
  prepared.ends = Stencil(ends);
  prepared.walking = Stencil(walking);
  if (RowElimination::suits(chain))
    prepared.elimination = std::make_unique<const RowElimination>(chain);
  return prepared;
}

Stencil totals_of(const std::vector<int>& inputs) {
  std::vector<Entry> entries;
  for (const int input : inputs) entries.push_back({kTallyTotal, 0, input, 1.0});
  return Stencil(entries);
}

std::unique_ptr<const PredictionPlan> plan_of(const std::vector<Chain>& chains,
                                              std::vector<int> chain_of_row) {
  auto plan = std::make_unique<PredictionPlan>();
  plan->inputs = chains.front().inputs();
  plan->type_of_row = std::move(chain_of_row);
  std::vector<char> is_entered(static_cast<std::size_t>(plan->inputs)), from_below(is_entered),
      sideways(is_entered);
  for (const Chain& chain : chains) {
    plan->outputs = std::max(plan->outputs, chain.outputs());
    for (Eigen::Index k = 0; k < chain.matrix().nonZeros(); ++k) {
      const Exit& exit = chain.exits()[static_cast<std::size_t>(chain.matrix().innerIndexPtr()[k])];
      if (exit.next_input == Exit::kTrapped) continue;
      if (std::max(exit.di_x, exit.di_y) > kFarthest || std::min(exit.di_x, exit.di_y) < -kFarthest)
        throw std::invalid_argument("sweep: a move of (" + std::to_string(exit.di_x) + ", " +
                                    std::to_string(exit.di_y) + ") cells is more than " +
                                    std::to_string(kFarthest) + "; propagate (exact.h) takes it");
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

void validate_all(const PredictionPlan& plan, const Field& field, const std::vector<Start>& starts,
                  int max_cells) {
  for (const Start& s : starts) validate(plan.chains.front().chain, field, s, max_cells);
  if (!plan.type_of_row.empty() && std::ssize(plan.type_of_row) != field.rows)
    throw std::invalid_argument("rows: chains for " + std::to_string(plan.type_of_row.size()) +
                                " rows, the field has " + std::to_string(field.rows));
}

/// Starts side by side in groups of `size`, groups on all threads.
template <class Run>
std::vector<FinalDistribution> in_groups(const std::vector<Start>& starts, std::int64_t size,
                                         Run run) {
  std::vector<FinalDistribution> all(starts.size());
  const auto count = std::ssize(starts);
  tbb::parallel_for(std::int64_t{0}, (count + size - 1) / size, [&](std::int64_t g) {
    const auto first = starts.begin() + g * size;
    auto results = run(std::vector<Start>(first, first + std::min(size, count - g * size)));
    std::move(results.begin(), results.end(), all.begin() + g * size);
  });
  return all;
}

}  // namespace

Sweeper::Sweeper(const Chain& chain) : plan_(plan_of({chain}, {})) {}

Sweeper::Sweeper(const RowChains& rows) : plan_(plan_of(rows.chains, rows.chain_of_row)) {}

Sweeper::~Sweeper() = default;

bool Sweeper::can_march() const { return plan_->lowest >= 0; }

std::vector<FinalDistribution> Sweeper::propagate_all(const Field& field,
                                                      const std::vector<Start>& starts,
                                                      int max_cells, double tolerance,
                                                      int max_steps_without_limit) const {
  validate_all(*plan_, field, starts, max_cells);
  if (!(tolerance >= 0.0) || max_steps_without_limit < 0)
    throw std::invalid_argument("propagate: tolerance and step limit must not be negative");
  // Measured: a few small fields together leave fewer lanes empty, more of them leave the cache.
  const std::int64_t cells = std::int64_t{field.columns} * field.rows;
  return in_groups(starts, std::clamp<std::int64_t>(400 / cells, 1, 4), [&](const auto& group) {
    return predict_by_steps(*plan_, field, group, max_cells, tolerance, max_steps_without_limit);
  });
}

std::vector<FinalDistribution> Sweeper::march_all(const Field& field,
                                                  const std::vector<Start>& starts,
                                                  double tolerance, RowMethod method,
                                                  int most_sums) const {
  validate_all(*plan_, field, starts, 0);
  if (!can_march()) throw std::invalid_argument("march: an exit leads to a row below");
  if (!(tolerance >= 0.0) || most_sums < 1)
    throw std::invalid_argument("march: tolerance must not be negative, most_sums be positive");
  return in_groups(starts, std::clamp(40 / field.columns, 1, 4), [&](const auto& group) {
    return predict_by_rows(*plan_, field, group, tolerance, method, most_sums);
  });
}

std::vector<FinalDistribution> Sweeper::predict_all(const Field& field,
                                                    const std::vector<Start>& starts,
                                                    int max_cells) const {
  return max_cells == 0 && can_march() ? march_all(field, starts)
                                       : propagate_all(field, starts, max_cells);
}

FinalDistribution Sweeper::propagate(const Field& field, const Start& start, int max_cells,
                                     double tolerance, int max_steps_without_limit) const {
  return propagate_all(field, {start}, max_cells, tolerance, max_steps_without_limit).front();
}

FinalDistribution Sweeper::march(const Field& field, const Start& start, double tolerance,
                                 RowMethod method, int most_sums) const {
  return march_all(field, {start}, tolerance, method, most_sums).front();
}

FinalDistribution Sweeper::predict(const Field& field, const Start& start, int max_cells) const {
  return predict_all(field, {start}, max_cells).front();
}

}  // namespace gatewalk::markov
