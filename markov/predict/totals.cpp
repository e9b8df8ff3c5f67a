// SPDX-License-Identifier: MIT
#include "markov/totals.h"

#include <Random123/philox.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <boost/math/special_functions/erf.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <string>

#include "markov/first_passage.h"
#include "markov/predict/large_totals.h"
#include "markov/predict/transient.h"
#include "markov/walk.h"

namespace gatewalk::markov {
namespace {

/// The shares of the walks that are about to draw in each state, with the sums of their totals and
/// of the squares so far. The numbers of one state are adjacent.
class Wave {
 public:
  Wave(std::int64_t cells, int inputs, std::size_t quantities)
      : stride_(1 + 2 * quantities),
        numbers_of_cell_(static_cast<std::size_t>(inputs) * stride_),
        numbers_(static_cast<std::size_t>(cells)),
        reached_(static_cast<std::size_t>(cells), false) {}

  /// The numbers of a state in a reached cell.
  [[nodiscard]] double* at(std::int64_t cell, int input) {
    return numbers_[static_cast<std::size_t>(cell)].data() +
           static_cast<std::size_t>(input) * stride_;
  }
  double* reach(std::int64_t cell, int input) {
    reached_[static_cast<std::size_t>(cell)] = true;
    if (auto& numbers = numbers_[static_cast<std::size_t>(cell)]; numbers.empty())
      numbers.resize(numbers_of_cell_, 0.0);
    return at(cell, input);
  }
  [[nodiscard]] bool reached(std::int64_t cell) const {
    return reached_[static_cast<std::size_t>(cell)];
  }
  void clear() {
    for (std::size_t cell = 0; cell < reached_.size(); ++cell) {
      if (!reached_[cell]) continue;
      std::fill(numbers_[cell].begin(), numbers_[cell].end(), 0.0);
      reached_[cell] = false;
    }
  }

 private:
  std::size_t stride_, numbers_of_cell_;
  std::vector<std::vector<double>> numbers_;  // by cell; only of cells ever reached
  std::vector<bool> reached_;
};

WalkTotals totals_by_steps(const FieldChain& chain, const Field& field, const Start& start,
                           int max_cells, const Rewards& rewards, const EachState& each,
                           double tolerance) {
  const std::size_t quantities = quantities_of(chain, rewards);
  const std::int64_t cells = std::int64_t{field.columns} * field.rows;
  Wave now(cells, chain.inputs(), quantities), next(cells, chain.inputs(), quantities);
  WalkTotals out;
  out.visits = CellProbabilities::Zero(field.rows, field.columns);
  out.totals.resize(quantities);
  now.reach(std::int64_t{start.row} * field.columns + start.column, start.input)[0] = 1.0;

  // The numbers of a state: the share of walks, then sum and square of each quantity.
  std::vector<double> moved(1 + 2 * quantities);
  const int most = max_cells == 0 ? kMostSteps : max_cells;
  for (int draw = 1; draw <= most; ++draw) {
    const auto end = [&](Ending ending, const double* numbers, int draws) {
      const auto e = static_cast<std::size_t>(ending);
      const double share = numbers[0];
      out.endings[e] += share;
      out.draws[e].share += share;
      out.draws[e].sum += share * draws;
      out.draws[e].square += share * draws * draws;
      for (std::size_t q = 0; q < quantities; ++q) {
        out.totals[q][e].share += share;
        out.totals[q][e].sum += numbers[1 + 2 * q];
        out.totals[q][e].square += numbers[2 + 2 * q];
      }
    };
    double walking = 0.0;
    for (std::int64_t cell = 0; cell < cells; ++cell) {
      if (!now.reached(cell)) continue;
      const std::int64_t column = cell % field.columns, row = cell / field.columns;
      const int type = chain.type_of(column, row);
      const Chain& here = chain.chains()[static_cast<std::size_t>(type)];
      for (int input = 0; input < here.inputs(); ++input) {
        const double* const from = now.at(cell, input);
        if (from[0] == 0.0) continue;
        if (!here.is_sampled(input)) {
          end(Ending::unsampled, from, draw - 1);
          continue;
        }
        out.visits.data()[cell] += from[0];
        if (each) each(draw, cell, input, from[0]);
        auto nonzero = static_cast<std::size_t>(here.matrix().outerIndexPtr()[input]);
        for (Probabilities::InnerIterator it(here.matrix(), input); it; ++it, ++nonzero) {
          const double p = it.value();
          moved[0] = p * from[0];
          for (std::size_t q = 0; q < quantities; ++q) {
            const Reward& r = rewards[static_cast<std::size_t>(type)][q];
            const double sum = from[1 + 2 * q], square = from[2 + 2 * q];
            moved[1 + 2 * q] = p * (sum + from[0] * r.mean[nonzero]);
            moved[2 + 2 * q] =
                p * (square + 2.0 * sum * r.mean[nonzero] + from[0] * r.square[nonzero]);
          }
          const Exit& exit = here.exits()[static_cast<std::size_t>(it.col())];
          std::int64_t to_column = column, to_row = row;
          if (const auto ending = follow(field, exit, draw == max_cells, to_column, to_row)) {
            end(*ending, moved.data(), draw);
          } else {
            walking += moved[0];
            double* const to = next.reach(to_row * field.columns + to_column, exit.next_input);
            for (std::size_t k = 0; k < moved.size(); ++k) to[k] += moved[k];
          }
        }
      }
    }
    now.clear();
    std::swap(now, next);
    out.remainder = max_cells == 0 || draw < max_cells ? walking : 0.0;
    if (walking == 0.0 || (max_cells == 0 && walking <= tolerance)) break;
  }
  return out;
}

/// Totals without a limit of cells, row by row: the mass that enters a row is moved within the row
/// by sweeps to both sides until next to nothing is left.
class TotalsByRows {
 public:
  TotalsByRows(const FieldChain& chain, const Field& field, const Start& start,
               const Rewards& rewards, const EachState& each, const WalkTolerance& tolerance)
      : chain_(chain),
        field_(field),
        start_(start),
        each_(each),
        tolerance_(tolerance),
        inputs_(chain.inputs()),
        quantities_(1 + quantities_of(chain, rewards)),
        stride_(1 + 2 * quantities_) {
    for (std::size_t type = 0; type < chain.chains().size(); ++type)
      add_draws(chain.chains()[type], rewards.empty() ? std::vector<Reward>{} : rewards[type]);
    const double states =
        static_cast<double>(field.rows) * field.columns * static_cast<double>(inputs_);
    least_ = tolerance.all / states;
    if (tolerance.chance)
      least_to_target_ =
          tolerance.of_target *
          (*tolerance.chance)(1, std::int64_t{start.row} * field.columns + start.column,
                              start.input) /
          states;
    waiting_.resize(static_cast<std::size_t>(highest_) + 1);
    for (auto& row : waiting_) row.resize(numbers_of_row());
    visits_.resize(static_cast<std::size_t>(field.columns) * static_cast<std::size_t>(inputs_));
    out_.visits = CellProbabilities::Zero(field.rows, field.columns);
    ended_.resize(kEndings * stride_);
  }

  WalkTotals run() {
    at(0, start_.column, start_.input)[0] = 1.0;
    for (int row = start_.row; row < field_.rows; ++row) {
      leave(row);
      count(row);
      std::fill(waiting_.front().begin(), waiting_.front().end(), 0.0);
      std::rotate(waiting_.begin(), waiting_.begin() + 1, waiting_.end());
    }
    out_.totals.resize(quantities_ - 1);
    for (std::size_t e = 0; e < kEndings; ++e) {
      const double* const sums = ended_.data() + e * stride_;
      out_.endings[e] = sums[0];
      out_.draws[e] = moments(sums, 0);
      for (std::size_t q = 1; q < quantities_; ++q) out_.totals[q - 1][e] = moments(sums, q);
    }
    return std::move(out_);
  }

 private:
  /// A nonzero of the matrix: its probability and target. `Draws::rewards` holds its means and mean
  /// squares, draws first.
  struct Draw {
    double p;
    int next, di_x, di_y;
  };
  struct Draws {
    std::vector<Draw> all;
    std::vector<double> rewards;     // (draws x 2 x quantities)
    std::vector<std::size_t> first;  // (inputs + 1)
  };

  void add_draws(const Chain& chain, const std::vector<Reward>& rewards) {
    Draws draws;
    std::size_t nonzero = 0;
    for (int input = 0; input < chain.inputs(); ++input) {
      draws.first.push_back(draws.all.size());
      for (Probabilities::InnerIterator it(chain.matrix(), input); it; ++it, ++nonzero) {
        const Exit& exit = chain.exits()[static_cast<std::size_t>(it.col())];
        draws.all.push_back({it.value(), exit.next_input, exit.di_x, exit.di_y});
        highest_ = std::max(highest_, exit.di_y);
        draws.rewards.push_back(1.0);
        for (const Reward& r : rewards) draws.rewards.push_back(r.mean[nonzero]);
        draws.rewards.push_back(1.0);
        for (const Reward& r : rewards) draws.rewards.push_back(r.square[nonzero]);
      }
    }
    draws.first.push_back(draws.all.size());
    draws_.push_back(std::move(draws));
  }
  [[nodiscard]] std::size_t numbers_of_row() const {
    return static_cast<std::size_t>(field_.columns) * static_cast<std::size_t>(inputs_) * stride_;
  }
  /// The numbers of walks that are about to draw in a row above the present one: their share, and
  /// the sums of their totals and of the squares so far.
  [[nodiscard]] double* at(int above, std::int64_t column, std::int64_t input) {
    return waiting_[static_cast<std::size_t>(above)].data() +
           static_cast<std::size_t>(column * inputs_ + input) * stride_;
  }
  [[nodiscard]] Moments moments(const double* sums, std::size_t q) const {
    return {sums[0], sums[1 + q], sums[1 + quantities_ + q]};
  }
  [[nodiscard]] bool is_little(double share, std::int64_t cell, int input) const {
    return share <= least_ &&
           (!tolerance_.chance || share * (*tolerance_.chance)(1, cell, input) <= least_to_target_);
  }

  /// Moves on all mass that waits in the row, except shares so small that they are negligible even
  /// together.
  void leave(int row) {
    bool any = true;
    for (int sweep = 0; any && sweep < kMostSteps; ++sweep) {
      any = false;
      for (int i = 0; i < field_.columns; ++i)
        any = draw(sweep % 2 == 0 ? i : field_.columns - 1 - i, row) || any;
    }
    for (std::int64_t state = 0; state < field_.columns * inputs_; ++state)
      out_.remainder += waiting_.front()[static_cast<std::size_t>(state) * stride_];
  }

  /// Makes one draw of all walks in a cell. Returns whether there were any.
  bool draw(int column, int row) {
    const std::int64_t cell = std::int64_t{row} * field_.columns + column;
    const auto type = static_cast<std::size_t>(chain_.type_of(column, row));
    const Draws& draws = draws_[type];
    bool any = false;
    std::vector<double>& from = from_;
    for (int input = 0; input < inputs_; ++input) {
      double* const here = at(0, column, input);
      if (here[0] == 0.0 || is_little(here[0], cell, input)) continue;
      any = true;
      from.assign(here, here + stride_);
      std::fill_n(here, stride_, 0.0);
      const auto first = draws.first[static_cast<std::size_t>(input)],
                 last = draws.first[static_cast<std::size_t>(input) + 1];
      if (first == last) {
        double* const ended = ended_.data() + static_cast<std::size_t>(Ending::unsampled) * stride_;
        for (std::size_t k = 0; k < stride_; ++k) ended[k] += from[k];
        continue;
      }
      visits_[static_cast<std::size_t>(column * inputs_ + input)] += from[0];
      for (std::size_t i = first; i < last; ++i) {
        const Draw& d = draws.all[i];
        std::int64_t to_column = column, to_row = row;
        const auto ending = follow(field_, {d.next, d.di_x, d.di_y}, false, to_column, to_row);
        add(d.p, draws.rewards.data() + i * 2 * quantities_,
            ending ? ended_.data() + static_cast<std::size_t>(*ending) * stride_
                   : at(d.di_y, to_column, d.next));
      }
    }
    return any;
  }
  /// Adds to `to` the walks of `from_` that take a draw of probability p with these rewards.
  void add(double p, const double* rewards, double* to) const {
    const double share = p * from_[0];
    const double *const sum = from_.data() + 1, *const square = sum + quantities_,
                        *const mean = rewards, *const mean_square = rewards + quantities_;
    double *const to_sum = to + 1, *const to_square = to_sum + quantities_;
    to[0] += share;
    for (std::size_t q = 0; q < quantities_; ++q) {
      to_sum[q] += p * sum[q] + share * mean[q];
      to_square[q] += p * (square[q] + 2.0 * sum[q] * mean[q]) + share * mean_square[q];
    }
  }

  /// Counts the visits of the row's states.
  void count(int row) {
    for (std::int64_t column = 0; column < field_.columns; ++column) {
      const std::int64_t cell = row * field_.columns + column;
      for (int input = 0; input < inputs_; ++input) {
        double& share = visits_[static_cast<std::size_t>(column * inputs_ + input)];
        if (share == 0.0) continue;
        out_.visits.data()[cell] += share;
        if (each_) each_(1, cell, input, share);
        share = 0.0;
      }
    }
  }

  const FieldChain& chain_;
  const Field field_;
  const Start start_;
  const EachState& each_;
  const WalkTolerance& tolerance_;
  const std::int64_t inputs_;
  const std::size_t quantities_, stride_;  // the first quantity is the number of draws
  int highest_ = 0;                        // di_y
  double least_ = 0.0, least_to_target_ = 0.0;
  std::vector<Draws> draws_;                  // by type
  std::vector<std::vector<double>> waiting_;  // this row, the row above, ...
  std::vector<double> from_;                  // the walks being moved
  std::vector<double> visits_;                // (columns x inputs) of the row
  std::vector<double> ended_;                 // (endings x stride)
  WalkTotals out_;
};

bool is_large(const FieldChain& chain, const Field& field, double large) {
  double nonzeros = 0.0;
  for (const Chain& c : chain.chains())
    nonzeros = std::max(nonzeros, static_cast<double>(c.matrix().nonZeros()));
  return static_cast<double>(field.columns) * field.rows * nonzeros > large;
}

/// Exact totals without a limit for few states, however long walks circle. Returns nullopt if some
/// walks never end, or if it takes too long.
std::optional<WalkTotals> totals_by_elimination(const FieldChain& chain, const Field& field,
                                                const Start& start, const Rewards& rewards,
                                                const EachState& each) {
  constexpr double kMostOperations = 2e9;
  Transient t(chain, field, start);
  const auto draws = expected_draws(t, kMostOperations);
  if (!draws || draws->endless > 0.0) return {};
  WalkTotals out;
  out.visits = CellProbabilities::Zero(field.rows, field.columns);
  const std::int64_t inputs = chain.inputs();
  for (std::size_t s = 0; s < t.states.size(); ++s) {
    const std::int64_t cell = t.states[s] / inputs;
    out.visits.data()[cell] += draws->by_state[s];
  }
  out.totals.resize(quantities_of(chain, rewards));
  for (std::size_t e = 0; e < kEndings; ++e) {
    const auto ending = static_cast<Ending>(e);
    const FirstPassages ends = first_passages(chain, field, {.ending = ending}, 0, rewards);
    out.endings[e] = ends.chance[ends.at(start)];
    if (out.endings[e] == 0.0) continue;
    // The expected total of the walks from a (cell, state) pair that have this ending; without q,
    // of their draws.
    const auto taken = [&](std::optional<std::size_t> q, std::size_t pair) {
      if (!(ends.chance[pair] > 0.0)) return 0.0;
      return ends.chance[pair] * (q ? ends.totals[*q] : ends.draws)[pair];
    };
    const auto moments = [&](std::optional<std::size_t> q) {
      double square = 0.0;
      for (std::size_t s = 0; s < t.states.size(); ++s) {
        const std::int64_t cell = t.states[s] / inputs;
        const int type = chain.type_of(cell % field.columns, cell / field.columns);
        const Chain& here = chain.chains()[static_cast<std::size_t>(type)];
        const std::int64_t input = t.states[s] % inputs;
        auto nonzero = static_cast<std::size_t>(here.matrix().outerIndexPtr()[input]);
        for (Probabilities::InnerIterator it(here.matrix(), input); it; ++it, ++nonzero) {
          const Exit& exit = here.exits()[static_cast<std::size_t>(it.col())];
          std::int64_t column = cell % field.columns, row = cell / field.columns;
          auto why = follow(field, exit, false, column, row);
          if (!why && !chain.at(column, row).is_sampled(exit.next_input)) why = Ending::unsampled;
          const auto next = static_cast<std::size_t>((row * field.columns + column) * inputs +
                                                     std::max(exit.next_input, 0));
          const double so = why ? (*why == ending ? 1.0 : 0.0) : ends.chance[next],
                       later = why ? 0.0 : taken(q, next);
          const Reward* const r = q ? &rewards[static_cast<std::size_t>(type)][*q] : nullptr;
          const double mean = r ? r->mean[nonzero] : 1.0,
                       mean_square = r ? r->square[nonzero] : 1.0;
          square += draws->by_state[s] * it.value() * (mean_square * so + 2.0 * mean * later);
        }
      }
      return Moments{out.endings[e], taken(q, ends.at(start)), square};
    };
    out.draws[e] = moments({});
    for (std::size_t q = 0; q < out.totals.size(); ++q) out.totals[q][e] = moments(q);
  }
  for (std::size_t s = 0; each && s < t.states.size(); ++s)
    each(1, t.states[s] / inputs, static_cast<int>(t.states[s] % inputs), draws->by_state[s]);
  return out;
}

bool goes_down(const FieldChain& chain) {
  for (const Chain& c : chain.chains())
    for (const Exit& exit : c.exits())
      if (exit.di_y < 0) return true;
  return false;
}

}  // namespace

double Moments::sd() const {  // in this order std::max returns NaN for unknown moments
  return std::sqrt(std::max(square / share - mean() * mean(), 0.0));
}

Moments WalkTotals::all(const std::array<Moments, kEndings>& by_ending) {
  Moments sum;
  for (const Moments& m : by_ending) {
    sum.share += m.share;
    sum.sum += m.sum;
    sum.square += m.square;
  }
  return sum;
}

WalkTotals walk_totals(const FieldChain& chain, const Field& field, const Start& start,
                       int max_cells, const Rewards& rewards, const EachState& each,
                       const WalkTolerance& tolerance, std::uint64_t seed) {
  validate(chain, field, start, max_cells);
  if (max_cells > 0)
    return totals_by_steps(chain, field, start, max_cells, rewards, each, tolerance.all);
  const bool down = goes_down(chain);
  if (!down && is_large(chain, field, tolerance.large))
    if (auto large = totals_of_large(chain, field, start, rewards, each, tolerance, seed))
      return *std::move(large);
  const auto summed = [&](const EachState& use) {
    return down ? totals_by_steps(chain, field, start, 0, rewards, use, tolerance.all)
                : TotalsByRows(chain, field, start, rewards, use, tolerance).run();
  };
  constexpr std::int64_t kSoonEliminated = 1000;
  const std::int64_t inputs = chain.inputs(),
                     states = std::int64_t{field.columns} * field.rows * inputs;
  if (states > kSoonEliminated) return summed(each);
  std::vector<double> passed(static_cast<std::size_t>(states), 0.0);  // reported once all is known
  WalkTotals out = summed([&](int, std::int64_t cell, int input, double share) {
    passed[static_cast<std::size_t>(cell * inputs + input)] += share;
  });
  if (out.remainder > tolerance.all) {
    try {
      if (auto exact = totals_by_elimination(chain, field, start, rewards, each))
        return *std::move(exact);
    } catch (const std::runtime_error&) {  // walks circle too long: the sums so far stand
    }
  }
  for (std::int64_t state = 0; each && state < states; ++state)
    if (const double share = passed[static_cast<std::size_t>(state)]; share > 0.0)
      each(1, state / inputs, static_cast<int>(state % inputs), share);
  return out;
}

namespace {

/// The second key word of these walks' streams: "time", version 1.
constexpr std::uint64_t kTimedStream = 0x74696d65'00000001;

double gamma_quantile(double mean, double square, double u) {
  const double variance = square - mean * mean;
  if (!(mean > 0.0) || variance <= 1e-12 * mean * mean) return mean;
  const double shape = mean * mean / variance;
  constexpr double kNearlyNormal = 1e4;
  if (shape > kNearlyNormal)
    return mean + std::sqrt(2.0 * variance) * boost::math::erf_inv(2.0 * u - 1.0);
  return boost::math::gamma_p_inv(shape, u) * (variance / mean);
}

}  // namespace

std::vector<TimedWalk> timed_walks(const FieldChain& chain, const Field& field, const Start& start,
                                   int max_cells, const Rewards& rewards, std::int64_t count,
                                   std::uint64_t seed) {
  validate(chain, field, start, max_cells);
  if (quantities_of(chain, rewards) == 0)
    throw std::invalid_argument("timed walks: there is no quantity to add up");
  const int most = max_cells == 0 ? kMostSteps : max_cells;
  std::vector<Walker> walkers;
  for (const Chain& c : chain.chains()) walkers.emplace_back(FieldChain(c));
  std::vector<TimedWalk> walks(static_cast<std::size_t>(count));
  tbb::parallel_for(std::int64_t{0}, count, [&](std::int64_t number) {
    TimedWalk& walk = walks[static_cast<std::size_t>(number)];
    std::int64_t column = start.column, row = start.row;
    int input = start.input;
    for (int draw = 1;; ++draw) {
      const auto type = static_cast<std::size_t>(chain.type_of(column, row));
      const Chain& here = chain.chains()[type];
      if (!here.is_sampled(input)) {
        walk.ending = Ending::unsampled;
        return;
      }
      const auto words = r123::Philox4x64()(
          {{static_cast<std::uint64_t>(draw), static_cast<std::uint64_t>(number), 0, 0}},
          {{seed, kTimedStream}});
      const int output = walkers[type].draw(input, words[0]);
      const auto *const begin =
                            here.matrix().innerIndexPtr() + here.matrix().outerIndexPtr()[input],
                        *const end = here.matrix().innerIndexPtr() +
                                     here.matrix().outerIndexPtr()[input + 1];
      const auto nonzero = static_cast<std::size_t>(std::lower_bound(begin, end, output) -
                                                    here.matrix().innerIndexPtr());
      const Reward& r = rewards[type].front();
      walk.total += gamma_quantile(r.mean[nonzero], r.square[nonzero], uniform(words[1]));
      const Exit& exit = here.exits()[static_cast<std::size_t>(output)];
      if (const auto ending = follow(field, exit, draw == most, column, row)) {
        walk.ending = *ending;
        return;
      }
      input = exit.next_input;
    }
  });
  return walks;
}

}  // namespace gatewalk::markov
