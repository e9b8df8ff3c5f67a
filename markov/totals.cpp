#include "markov/totals.h"

#include <Random123/philox.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <boost/math/special_functions/erf.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <stdexcept>
#include <string>

#include "markov/walk.h"

namespace gatewalk::markov {
namespace {

std::size_t quantities_of(const FieldChain& chain, const Rewards& rewards) {
  if (rewards.empty()) return 0;
  bool fits = rewards.size() == chain.chains().size();
  for (std::size_t c = 0; fits && c < rewards.size(); ++c) {
    const auto nonzeros = static_cast<std::size_t>(chain.chains()[c].matrix().nonZeros());
    fits = rewards[c].size() == rewards.front().size();
    for (const Reward& r : rewards[c])
      fits = fits && r.mean.size() == nonzeros && r.square.size() == nonzeros;
  }
  if (!fits) throw std::invalid_argument("walk totals: rewards are not those of the chain");
  return rewards.front().size();
}

/// Shares of the walks that are about to draw in each state, with the sums of their totals so far
/// and of the squares: numbers of one state side by side.
class Wave {
 public:
  Wave(std::int64_t cells, int inputs, std::size_t quantities)
      : inputs_(inputs),
        stride_(1 + 2 * quantities),
        numbers_(static_cast<std::size_t>(cells) * static_cast<std::size_t>(inputs) * stride_),
        reached_(static_cast<std::size_t>(cells), false) {}

  [[nodiscard]] double* at(std::int64_t cell, int input) {
    return numbers_.data() + static_cast<std::size_t>(cell * inputs_ + input) * stride_;
  }
  double* reach(std::int64_t cell, int input) {
    reached_[static_cast<std::size_t>(cell)] = true;
    return at(cell, input);
  }
  [[nodiscard]] bool reached(std::int64_t cell) const {
    return reached_[static_cast<std::size_t>(cell)];
  }
  void clear() {
    for (std::int64_t cell = 0; cell < std::ssize(reached_); ++cell) {
      if (!reached(cell)) continue;
      double* const begin = at(cell, 0);
      std::fill(begin, begin + static_cast<std::size_t>(inputs_) * stride_, 0.0);
      reached_[static_cast<std::size_t>(cell)] = false;
    }
  }

 private:
  int inputs_;
  std::size_t stride_;
  std::vector<double> numbers_;
  std::vector<bool> reached_;
};

constexpr int kMostSteps = 100'000;

}  // namespace

double Moments::sd() const { return std::sqrt(std::max(0.0, square / share - mean() * mean())); }

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
                       double tolerance) {
  validate(chain, field, start, max_cells);
  const std::size_t quantities = quantities_of(chain, rewards);
  const std::int64_t cells = std::int64_t{field.columns} * field.rows;
  Wave now(cells, chain.inputs(), quantities), next(cells, chain.inputs(), quantities);
  WalkTotals out;
  out.visits = CellProbabilities::Zero(field.rows, field.columns);
  out.totals.resize(quantities);
  now.reach(std::int64_t{start.row} * field.columns + start.column, start.input)[0] = 1.0;

  // A state's numbers: the share of the walks, then sum and square of each quantity.
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

namespace {

/// "time", version 1: the second key word of these walks' streams.
constexpr std::uint64_t kTimedStream = 0x74696d65'00000001;

double uniform(std::uint64_t word) { return (static_cast<double>(word >> 12) + 0.5) * 0x1p-52; }

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
