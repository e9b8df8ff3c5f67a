// SPDX-License-Identifier: MIT
#include "markov/first_passage.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "markov/predict/block_elimination.h"
#include "markov/predict/large_totals.h"

namespace gatewalk::markov {
namespace {

/// The result of a draw: the target, another (cell, state) pair, an unsampled row, or an end.
enum class Lead : std::uint8_t { target, on, never_sampled, end };

class Passing {
 public:
  Passing(const FieldChain& chain, const Field& field, const PassageTarget& target, int max_cells,
          const Rewards& rewards)
      : chain_(chain),
        field_(field),
        target_(target),
        max_cells_(max_cells),
        rewards_(rewards),
        inputs_(chain.inputs()),
        pairs_(static_cast<std::size_t>(field.columns) * static_cast<std::size_t>(field.rows) *
               static_cast<std::size_t>(inputs_)),
        // The probability of the target, that of unsampled rows, draws, and the quantities of the
        // rewards.
        numbers_(3 + quantities_of(chain, rewards)) {
    constexpr double kMostNumbers = 4.0 * (1 << 30) / sizeof(double);
    double numbers = static_cast<double>(pairs_) * static_cast<double>(2 * numbers_ + 4);
    for (int row = 0; row < field.rows && max_cells == 0; ++row)
      for (int column = 0; column < field.columns; ++column)
        numbers += 2.0 * static_cast<double>(chain.at(column, row).matrix().nonZeros());
    if (numbers > kMostNumbers)
      throw std::invalid_argument("first passages: of " + std::to_string(field.columns) + " x " +
                                  std::to_string(field.rows) + " cells of " +
                                  std::to_string(inputs_) + " states they take more than 4 GiB");
    x_.assign(numbers_, std::vector<double>(pairs_, 0.0));
    each_pair([&](std::size_t pair, std::int64_t column, std::int64_t row, int input) {
      if (target_.holds(row * field_.columns + column, input))
        x_[kChance][pair] = 1.0;
      else if (!chain_.at(column, row).is_sampled(input))
        x_[kNeverSampled][pair] = 1.0;
    });
  }

  FirstPassages solve() && {
    if (max_cells_ > 0)
      by_layers();
    else
      without_limit();
    FirstPassages out{field_.columns, field_.rows, inputs_, {}, {}, {}, {}};
    for (std::size_t k = kDraws; k < numbers_; ++k)
      for (std::size_t pair = 0; pair < pairs_; ++pair)
        x_[k][pair] = x_[kChance][pair] > 0.0 ? x_[k][pair] / x_[kChance][pair]
                                              : std::numeric_limits<double>::quiet_NaN();
    out.chance = std::move(x_[kChance]);
    out.never_sampled = std::move(x_[kNeverSampled]);
    out.draws = std::move(x_[kDraws]);
    for (std::size_t k = kTotals; k < numbers_; ++k) out.totals.push_back(std::move(x_[k]));
    return out;
  }

 private:
  static constexpr std::size_t kChance = 0, kNeverSampled = 1, kDraws = 2, kTotals = 3;
  static constexpr double kTolerance = 1e-13;

  template <class Use>
  void each_pair(Use use) const {
    std::size_t pair = 0;
    for (int row = 0; row < field_.rows; ++row)
      for (int column = 0; column < field_.columns; ++column)
        for (int input = 0; input < inputs_; ++input) use(pair++, column, row, input);
  }
  /// Whether the numbers of a pair must be computed: the pair is neither in the target nor
  /// unsampled.
  [[nodiscard]] bool walks(std::size_t pair) const {
    const auto cell = static_cast<std::int64_t>(pair) / inputs_;
    const auto input = static_cast<int>(static_cast<std::int64_t>(pair) % inputs_);
    return !target_.holds(cell, input) &&
           chain_.at(cell % field_.columns, cell / field_.columns).is_sampled(input);
  }

  /// Calls use(chance, lead, next pair, nonzero of the chain) for each draw of a pair that walks.
  template <class Use>
  void each_draw(std::size_t pair, bool last, Use use) const {
    const auto cell = static_cast<std::int64_t>(pair) / inputs_;
    const auto input = static_cast<int>(static_cast<std::int64_t>(pair) % inputs_);
    const Chain& here = chain_.at(cell % field_.columns, cell / field_.columns);
    auto nonzero = static_cast<std::size_t>(here.matrix().outerIndexPtr()[input]);
    for (Probabilities::InnerIterator it(here.matrix(), input); it; ++it, ++nonzero) {
      const Exit& exit = here.exits()[static_cast<std::size_t>(it.col())];
      std::int64_t column = cell % field_.columns, row = cell / field_.columns;
      if (const auto ends = follow(field_, exit, last, column, row)) {
        use(it.value(), target_.ending == *ends ? Lead::target : Lead::end, pair, nonzero);
        continue;
      }
      const std::int64_t next = row * field_.columns + column;
      const bool sampled = chain_.at(column, row).is_sampled(exit.next_input);
      const Lead lead = target_.holds(next, exit.next_input)
                            ? Lead::target
                            : (sampled                               ? Lead::on
                               : target_.ending == Ending::unsampled ? Lead::target
                                                                     : Lead::never_sampled);
      use(it.value(), lead, static_cast<std::size_t>(next * inputs_ + exit.next_input), nonzero);
    }
  }

  /// The mean that a draw adds to quantity k.
  [[nodiscard]] double taken(std::size_t pair, std::size_t k, std::size_t nonzero) const {
    const auto cell = static_cast<std::int64_t>(pair) / inputs_;
    const int type = chain_.type_of(cell % field_.columns, cell / field_.columns);
    return rewards_[static_cast<std::size_t>(type)][k - kTotals].mean[nonzero];
  }

  /// Updates the numbers [from, to) of a pair from those of the pairs to which its draws lead:
  /// next(number, pair).
  template <class Next>
  void renew(std::size_t pair, std::size_t from, std::size_t to, bool last, Next next,
             double* x) const {
    std::fill(x + from, x + to, 0.0);
    each_draw(pair, last, [&](double p, Lead lead, std::size_t then, std::size_t nonzero) {
      if (lead == Lead::end) return;
      const bool on = lead == Lead::on;
      if (from <= kNeverSampled && kNeverSampled < to && lead != Lead::target)
        x[kNeverSampled] += p * (on ? next(kNeverSampled, then) : 1.0);
      if (lead == Lead::never_sampled) return;
      const double reaches = on ? next(kChance, then) : 1.0;
      if (from == kChance) x[kChance] += p * reaches;
      for (std::size_t k = std::max(from, kDraws); k < to; ++k) {
        const double more = on ? next(k, then) : 0.0;
        if (reaches > 0.0) x[k] += p * (k == kDraws ? reaches : reaches * taken(pair, k, nonzero));
        x[k] += p * more;
      }
    });
  }

  /// With a limit of cells: backward recursion from the last draw, after which nothing is entered.
  void by_layers() {
    std::vector<std::vector<double>> before = x_;  // numbers of the next draw
    for (int draw = max_cells_; draw >= 1; --draw) {
      x_.swap(before);
      const std::vector<std::vector<double>>& next = before;
      const auto inputs = static_cast<std::size_t>(inputs_);
      tbb::parallel_for(std::size_t{0}, pairs_ / inputs, [&](std::size_t cell) {
        std::vector<double> x(numbers_);
        for (std::size_t pair = cell * inputs; pair < (cell + 1) * inputs; ++pair) {
          if (!walks(pair)) continue;
          renew(
              pair, 0, numbers_, draw == max_cells_,
              [&](std::size_t k, std::size_t then) { return next[k][then]; }, x.data());
          for (std::size_t k = 0; k < numbers_; ++k) x_[k][pair] = x[k];
        }
      });
    }
  }

  void without_limit() {
    constexpr std::size_t kSoonEliminated = 20'000;
    constexpr double kFewOperations = 2e8, kMostOperations = 4e9;
    pass_on();
    if (pair_of_.empty()) return;
    if (pairs_ <= kSoonEliminated && by_elimination(kFewOperations)) return;
    if (by_sweeps() || by_elimination(kMostOperations)) return;
    throw std::runtime_error("first passages: walks circle so long that " +
                             std::to_string(kMostSteps) + " sweeps do not do");
  }

  /// Collects the pairs that walk, and what they pass on to each other.
  void pass_on() {
    number_.assign(pairs_, -1);
    for (std::size_t pair = 0; pair < pairs_; ++pair) {
      if (!walks(pair)) continue;
      number_[pair] = std::ssize(pair_of_);
      pair_of_.push_back(pair);
    }
    std::vector<std::int64_t> place(pair_of_.size(), -1);  // index in the column under construction
    const auto add = [&](std::int64_t to, double share) {
      std::int64_t& at = place[static_cast<std::size_t>(to)];
      if (at < passed_.begin.back()) {
        at = std::ssize(passed_.index);
        passed_.index.push_back(to);
        passed_.value.push_back(0.0);
      }
      passed_.value[static_cast<std::size_t>(at)] += share;
    };
    for (std::size_t s = 0; s < pair_of_.size(); ++s) {
      add(static_cast<std::int64_t>(s), 1.0);
      double ending = 0.0;
      each_draw(pair_of_[s], false, [&](double p, Lead lead, std::size_t then, std::size_t) {
        if (lead == Lead::on)
          add(number_[then], -p);
        else
          ending += p;
      });
      passed_.ends.push_back(ending);
      passed_.begin.push_back(std::ssize(passed_.index));
    }
    can_end_ = can_end(passed_);
  }

  /// Solves by elimination. Returns false if that takes more than `most_operations`.
  bool by_elimination(double most_operations) {
    const Blocks blocks = blocks_of(passed_);
    std::vector<std::size_t> block_of(pair_of_.size());
    for (std::size_t b = 0; b + 1 < blocks.begin.size(); ++b)
      for (std::int64_t i = blocks.begin[b]; i < blocks.begin[b + 1]; ++i)
        block_of[static_cast<std::size_t>(blocks.order[static_cast<std::size_t>(i)])] = b;
    BlockElimination elimination(pair_of_.size());
    std::vector<double> x(pair_of_.size()), one(numbers_);
    double left = most_operations - static_cast<double>(passed_.index.size());
    for (std::size_t b = 0; b + 1 < blocks.begin.size(); ++b) {
      const std::int64_t* const first = blocks.order.data() + blocks.begin[b];
      const std::int64_t* const last = blocks.order.data() + blocks.begin[b + 1];
      // If one state of a block cannot end, no state of the block can.
      if (!can_end_[static_cast<std::size_t>(*first)]) continue;
      if (!elimination.eliminate(passed_, first, last, left)) return false;
      for (std::size_t k = 0; k < numbers_; ++k) {
        // Numbers of the block's own pairs count as 0, because elimination is to find them.
        const auto outside = [&](std::size_t of, std::size_t then) {
          const auto to = static_cast<std::size_t>(number_[then]);
          return of == k && block_of[to] == b ? 0.0 : x_[of][then];
        };
        for (const std::int64_t* s = first; s != last; ++s) {
          renew(pair_of_[static_cast<std::size_t>(*s)], k, k + 1, false, outside, one.data());
          x[static_cast<std::size_t>(*s)] = one[k];
        }
        elimination.values(first, x);
        for (const std::int64_t* s = first; s != last; ++s)
          x_[k][pair_of_[static_cast<std::size_t>(*s)]] = x[static_cast<std::size_t>(*s)];
      }
    }
    return true;
  }

  /// Solves by sweeps. Returns false if walks circle for too long.
  bool by_sweeps() {
    bool below = false;
    for (const Chain& c : chain_.chains())
      for (const Exit& exit : c.exits())
        below = below || (exit.next_input != Exit::kTrapped && exit.di_y < 0);
    std::vector<double> ended(pair_of_.size());  // share of walks that have ended or never will
    for (std::size_t s = 0; s < pair_of_.size(); ++s) {
      ended[s] = can_end_[s] != 0 ? 0.0 : 1.0;
      for (std::size_t k = 0; k < numbers_; ++k) x_[k][pair_of_[s]] = 0.0;
    }
    if (below) return sweep(0, pair_of_.size(), ended);
    const auto row_of_pairs =
        static_cast<std::size_t>(field_.columns) * static_cast<std::size_t>(inputs_);
    for (std::size_t last = pair_of_.size(), first; last > 0; last = first) {
      const std::size_t row = pair_of_[last - 1] / row_of_pairs;
      for (first = last; first > 0 && pair_of_[first - 1] / row_of_pairs == row;) --first;
      if (!sweep(first, last, ended)) return false;
    }
    return true;
  }

  /// Sweeps over the pairs [first, last) that walk until they converge. Returns false if they do
  /// not.
  bool sweep(std::size_t first, std::size_t last, std::vector<double>& ended) {
    const auto known = [&](std::size_t k, std::size_t then) { return x_[k][then]; };
    std::vector<double> x(numbers_);
    for (int sweep = 0; sweep < kMostSteps; ++sweep) {
      double change = 0.0, on_their_way = 0.0, more_ended = 0.0;
      for (std::size_t i = first; i < last; ++i) {
        const std::size_t s = sweep % 2 == 0 ? first + last - 1 - i : i, pair = pair_of_[s];
        if (!can_end_[s]) continue;
        renew(pair, 0, numbers_, false, known, x.data());
        for (std::size_t k = 0; k < numbers_; ++k) {
          if (x[k] > 0.0) change = std::max(change, std::abs(x[k] - x_[k][pair]) / x[k]);
          x_[k][pair] = x[k];
        }
        double sum = passed_.ends[s];
        for (auto i_to = static_cast<std::size_t>(passed_.begin[s]) + 1;
             i_to < static_cast<std::size_t>(passed_.begin[s + 1]); ++i_to)
          sum -= passed_.value[i_to] * ended[static_cast<std::size_t>(passed_.index[i_to])];
        more_ended = std::max(more_ended, sum - ended[s]);
        on_their_way = std::max(on_their_way, 1.0 - sum);
        ended[s] = sum;
      }
      // For long walks, rounding may leave more than the tolerance, and the remainder then stops
      // falling.
      constexpr double kRoundingOfWalks = 1e-9;
      const bool rounded =
          more_ended <= std::numeric_limits<double>::epsilon() && on_their_way <= kRoundingOfWalks;
      if (change <= kTolerance && (on_their_way <= kTolerance || rounded)) return true;
    }
    return false;
  }

  const FieldChain& chain_;
  const Field field_;
  const PassageTarget target_;
  const int max_cells_;
  const Rewards& rewards_;
  const int inputs_;
  const std::size_t pairs_, numbers_;
  // (numbers x pairs) means over all walks, not only those that arrive.
  std::vector<std::vector<double>> x_;
  // Without a limit: the index of each pair among those that walk (-1: it does not), and the pair
  // of each index.
  std::vector<std::int64_t> number_;
  std::vector<std::size_t> pair_of_;
  PassedOn passed_;
  std::vector<char> can_end_;
};

}  // namespace

FirstPassages first_passages(const FieldChain& chain, const Field& field,
                             const PassageTarget& target, int max_cells, const Rewards& rewards) {
  validate(chain, field, {}, max_cells);
  const std::int64_t cells = std::int64_t{field.columns} * field.rows;
  if (target.ending && (target.cell || target.input))
    throw std::invalid_argument("first passages: the target is an ending, or a place");
  if (!target.ending && !target.cell && !target.input)
    throw std::invalid_argument("first passages: there is no target");
  if (target.cell && (*target.cell < 0 || *target.cell >= cells))
    throw std::invalid_argument("first passages: cell " + std::to_string(*target.cell) +
                                " is not in the field");
  if (target.input && (*target.input < 0 || *target.input >= chain.inputs()))
    throw std::invalid_argument("first passages: there is no state " +
                                std::to_string(*target.input));
  return Passing(chain, field, target, max_cells, rewards).solve();
}

}  // namespace gatewalk::markov
