// SPDX-License-Identifier: MIT
#include "markov/decide.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>

namespace gatewalk::markov {
namespace {

/// The number of columns that are computed together, in registers.
constexpr int kColumns = 8;
using ColumnValues = std::array<double, kColumns>;

/// The farthest moves of any action, at most the size of the field.
struct Reach {
  int columns = 0, rows = 0;
};
/// Limits a move to the field's size, which does not change the edge that it crosses.
Exit within(const Field& field, Exit exit) {
  exit.di_x = std::clamp(exit.di_x, -field.columns, field.columns);
  exit.di_y = std::clamp(exit.di_y, -field.rows, field.rows);
  return exit;
}
Reach reach_of(const std::vector<FieldChain>& actions, const Field& field) {
  Reach reach;
  for (const FieldChain& action : actions)
    for (const Chain& chain : action.chains())
      for (const Exit& any : chain.exits()) {
        const Exit exit = within(field, any);
        reach.columns = std::max(reach.columns, std::abs(exit.di_x));
        reach.rows = std::max(reach.rows, std::abs(exit.di_y));
      }
  return reach;
}

/// The values of all cells and states. For each row of cells and each input, columns are stored
/// side by side. A border of cells beyond the field holds the values of leaving it.
class ValuePlane {
 public:
  ValuePlane(const Field& field, int inputs, const Reach& reach)
      : field_(field),
        inputs_(inputs),
        reach_(reach),
        pitch_((static_cast<std::ptrdiff_t>(field.columns) + kColumns - 1) / kColumns * kColumns +
               2 * static_cast<std::ptrdiff_t>(reach.columns)),
        values_(static_cast<std::size_t>(
            pitch_ * inputs * (static_cast<std::ptrdiff_t>(field.rows) + 2 * reach.rows))) {}

  /// The values of a row and input, from column 0 on.
  [[nodiscard]] double* columns(std::ptrdiff_t row, int input) {
    return values_.data() + ((row + reach_.rows) * inputs_ + input) * pitch_ + reach_.columns;
  }
  /// The distance from a row's columns for input 0 to the columns of an exit.
  [[nodiscard]] std::ptrdiff_t step(const Exit& any) const {
    const Exit exit = within(field_, any);
    return (static_cast<std::ptrdiff_t>(exit.di_y) * inputs_ + exit.next_input) * pitch_ +
           exit.di_x;
  }
  void fill(const std::array<double, kEndings>& gains, double inside) {
    for (std::ptrdiff_t row = -reach_.rows; row < field_.rows + reach_.rows; ++row)
      for (int input = 0; input < inputs_; ++input)
        for (std::ptrdiff_t column = -reach_.columns; column < pitch_ - reach_.columns; ++column) {
          const bool out = column < 0 || column >= field_.columns || row < 0 || row >= field_.rows;
          columns(row, input)[column] =
              out ? gains[static_cast<std::size_t>(edge_before(field_, column, row))] : inside;
        }
  }

 private:
  Field field_;
  int inputs_;
  Reach reach_;
  std::ptrdiff_t pitch_;
  std::vector<double> values_;
};

/// The rows of an action's chain, for cells of one type.
struct ActionRows {
  struct Move {
    double p;
    std::ptrdiff_t step;
  };
  /// The set of a row in doubt; a single row if `radius` is 0.
  struct Doubted {
    double radius = 0.0;   // largest sum (q - p)^2 / p
    double known = 0.0;    // mean gain of a draw
    double trapped = 0.0;  // probability of being trapped
  };
  std::vector<double> at_once;     // (inputs) mean gain of a draw, trapping included
  std::vector<std::size_t> first;  // (inputs + 1)
  std::vector<Move> moves;
  std::vector<Doubted> doubted;  // (inputs), or empty
  ColumnValues when_trapped{};   // the gain of trapping, in all columns

  ActionRows(const Chain& chain, const Gains& gains, const std::vector<double>* draw,
             const ValuePlane& plane) {
    const auto gain = [&](Ending e) { return gains.ending[static_cast<std::size_t>(e)]; };
    when_trapped.fill(gain(Ending::trapped));
    for (int input = 0; input < chain.inputs(); ++input) {
      first.push_back(moves.size());
      double now = draw ? (*draw)[static_cast<std::size_t>(input)] : 0.0;
      if (!chain.is_sampled(input)) now += gain(Ending::unsampled);
      for (Probabilities::InnerIterator it(chain.matrix(), input); it; ++it) {
        const Exit& exit = chain.exits()[static_cast<std::size_t>(it.col())];
        if (exit.next_input == Exit::kTrapped)
          now += it.value() * gain(Ending::trapped);
        else
          moves.push_back({it.value(), plane.step(exit)});
      }
      at_once.push_back(now);
    }
    first.push_back(moves.size());
  }

  void doubt(const Chain& chain, const std::vector<double>* draw, double deviations,
             const std::vector<double>& runs) {
    doubted.resize(at_once.size());
    for (std::size_t i = 0; i < doubted.size(); ++i) {
      const int input = static_cast<int>(i);
      if (!chain.is_sampled(input)) continue;
      doubted[i] = {.radius = deviations * deviations / runs[i], .known = draw ? (*draw)[i] : 0.0};
      for (Probabilities::InnerIterator it(chain.matrix(), input); it; ++it)
        if (chain.exits()[static_cast<std::size_t>(it.col())].next_input == Exit::kTrapped)
          doubted[i].trapped += it.value();
    }
  }

  /// The value of a draw in some columns; `here` points to the first column, for input 0.
  [[nodiscard]] ColumnValues value(int input, const double* here) const {
    const auto i = static_cast<std::size_t>(input);
    if (!doubted.empty() && doubted[i].radius > 0.0) return worst(i, here);
    ColumnValues sum;
    sum.fill(at_once[i]);
    for (std::size_t m = first[i]; m < first[i + 1]; ++m) {
      const double* const from = here + moves[m].step;
      for (std::size_t k = 0; k < kColumns; ++k) sum[k] += moves[m].p * from[k];
    }
    return sum;
  }

 private:
  template <class Do>
  void each_output(std::size_t i, const double* here, const Do& what) const {
    for (std::size_t m = first[i]; m < first[i + 1]; ++m) what(moves[m].p, here + moves[m].step);
    if (doubted[i].trapped > 0.0) what(doubted[i].trapped, when_trapped.data());
  }

  /// The least mean over the row's set. The minimising q is 0 above some limit, and below it p
  /// times a factor that falls with the value. If the outputs below the limit have the total
  /// probability P, the least mean is mean - sqrt(variance * (P radius - (1 - P))), from which a
  /// new limit follows. Starting with all outputs, the limit only falls, down to its fixed point,
  /// so no excluded output returns.
  [[nodiscard]] ColumnValues worst(std::size_t i, const double* here) const {
    constexpr double kAll = std::numeric_limits<double>::infinity();
    ColumnValues limit, least, value;
    limit.fill(kAll);
    least.fill(kAll);
    each_output(i, here, [&](double, const double* from) {
      for (std::size_t k = 0; k < kColumns; ++k) least[k] = std::min(least[k], from[k]);
    });
    for (bool finished = false; !finished;) {
      ColumnValues kept{}, left_out{}, mean{}, squares{}, most = least;
      each_output(i, here, [&](double p, const double* from) {
        for (std::size_t k = 0; k < kColumns; ++k) {
          const double part = from[k] <= limit[k] ? p : 0.0;
          kept[k] += part;
          left_out[k] += p - part;
          mean[k] += part * from[k];
        }
      });
      for (std::size_t k = 0; k < kColumns; ++k) mean[k] /= kept[k];
      each_output(i, here, [&](double p, const double* from) {
        for (std::size_t k = 0; k < kColumns; ++k) {
          const bool in = from[k] <= limit[k];
          const double off = from[k] - mean[k];
          squares[k] += in ? p * off * off : 0.0;
          most[k] = in ? std::max(most[k], from[k]) : most[k];
        }
      });
      finished = true;
      for (std::size_t k = 0; k < kColumns; ++k) {
        const double variance = squares[k] / kept[k];
        const double room = std::max(0.0, doubted[i].radius * kept[k] - left_out[k]);
        value[k] = std::max(least[k], mean[k] - std::sqrt(variance * room));
        // Rounding must not exclude the least value.
        limit[k] = room > 0.0 ? std::max(least[k], mean[k] + std::sqrt(variance / room)) : kAll;
        finished = finished && most[k] <= limit[k];
      }
    }
    for (double& v : value) v += doubted[i].known;
    return value;
  }
};

using Require = void (*)(bool holds, const std::string& what);

void check_doubt(const std::vector<FieldChain>& actions, const Gains& gains,
                 const DecideOptions& options, Require require) {
  const Doubt& doubt = options.doubt;
  require(std::isfinite(doubt.deviations) && doubt.deviations >= 0.0,
          "deviations of doubt must be at least 0");
  if (doubt.deviations == 0.0) return;
  require(options.max_cells > 0 || gains.draw.empty(),
          "without limit of cells there must be no gains of draws where rows are in doubt: walks "
          "could circle for ever");
  require(doubt.runs.size() == actions.size(), "runs of rows: one list for each action");
  for (std::size_t a = 0; a < actions.size(); ++a) {
    const std::vector<Chain>& chains = actions[a].chains();
    require(doubt.runs[a].size() == chains.size(), "runs of rows: one list for each type of cell");
    for (std::size_t type = 0; type < chains.size(); ++type) {
      const std::vector<double>& runs = doubt.runs[a][type];
      require(std::ssize(runs) == chains[type].inputs(), "runs of rows: one for each input");
      for (std::size_t i = 0; i < runs.size(); ++i)
        require(std::isfinite(runs[i]) && runs[i] >= 0.0 &&
                    (runs[i] > 0.0 || !chains[type].is_sampled(static_cast<int>(i))),
                "runs of rows must be more than 0, or 0 of one that is unsampled");
    }
  }
}

void check_actions(const std::vector<FieldChain>& actions, const Field& field, const Gains& gains,
                   const DecideOptions& options) {
  const Require require = [](bool holds, const std::string& what) {
    if (!holds) throw std::invalid_argument(what);
  };
  require(!actions.empty() && actions.size() <= std::numeric_limits<std::uint16_t>::max(),
          "there must be 1 to 65535 actions");
  for (const FieldChain& action : actions) {
    require(action.inputs() == actions.front().inputs(), "actions have chains of other inputs");
    validate(action, field, {}, options.max_cells);
  }
  require(options.tolerance > 0.0 && options.max_sweeps > 0,
          "tolerance and max_sweeps must be positive");
  for (const double gain : gains.ending)
    require(std::isfinite(gain) && (options.max_cells > 0 || gain >= 0.0),
            "without limit of cells what an ending gains must be at least 0");
  require(gains.draw.empty() || gains.draw.size() == actions.size(),
          "gains of draws: one list for each action");
  for (std::size_t a = 0; a < gains.draw.size(); ++a) {
    require(gains.draw[a].size() == actions[a].chains().size(),
            "gains of draws: one list for each type of cell");
    for (const std::vector<double>& of_type : gains.draw[a]) {
      require(std::ssize(of_type) == actions[a].inputs(), "gains of draws: one for each input");
      for (const double gain : of_type)
        require(std::isfinite(gain) && (options.max_cells > 0 || gain < 0.0),
                "without limit of cells each draw must cost something, or there must be no gains "
                "of draws");
    }
  }
  check_doubt(actions, gains, options, require);
}

/// The largest absolute gain of an ending or a draw.
double largest(const Gains& gains) {
  double most = 0.0;
  for (const double gain : gains.ending) most = std::max(most, std::abs(gain));
  for (const auto& of_action : gains.draw)
    for (const auto& of_type : of_action)
      for (const double gain : of_type) most = std::max(most, std::abs(gain));
  return most;
}

/// The relative rounding error of a value: the error of the sum over a row, and of the row's sum of
/// probabilities.
double rounding_of(const std::vector<FieldChain>& actions) {
  double most = 0.0;
  for (const FieldChain& action : actions)
    for (const Chain& chain : action.chains())
      for (int input = 0; input < chain.inputs(); ++input) {
        double sum = 0.0, terms = 2.0;
        for (Probabilities::InnerIterator it(chain.matrix(), input); it; ++it) {
          sum += it.value();
          terms += 1.0;
        }
        const double off = chain.is_sampled(input) ? std::abs(sum - 1.0) : 0.0;
        most = std::max(most, off + terms * std::numeric_limits<double>::epsilon());
      }
  return most;
}

class Decider {
 public:
  Decider(const std::vector<FieldChain>& actions, const Field& field, const Gains& gains,
          const DecideOptions& options)
      : actions_(actions),
        options_(options),
        costs_(!gains.draw.empty()),
        doubts_(options.doubt.deviations > 0.0),
        rounding_(rounding_of(actions)),
        tolerance_(std::max(options.tolerance, rounding_)),
        least_(costs_ ? largest(gains) : 0.0),
        reach_(reach_of(actions, field)),
        plane_(field, actions.front().inputs(), reach_),
        rows_(actions.size()) {
    for (std::size_t a = 0; a < actions.size(); ++a)
      for (std::size_t type = 0; type < actions[a].chains().size(); ++type) {
        const Chain& chain = actions[a].chains()[type];
        const std::vector<double>* const draw = costs_ ? &gains.draw[a][type] : nullptr;
        rows_[a].emplace_back(chain, gains, draw, plane_);
        if (doubts_)
          rows_[a].back().doubt(chain, draw, options.doubt.deviations, options.doubt.runs[a][type]);
      }
    d_.field = field;
    d_.inputs = actions.front().inputs();
    d_.max_cells = options.max_cells;
    size_ = static_cast<std::size_t>(field.columns) * static_cast<std::size_t>(field.rows) *
            static_cast<std::size_t>(d_.inputs);
    d_.value.resize(size_);
    plane_.fill(gains.ending, options.max_cells > 0
                                  ? gains.ending[static_cast<std::size_t>(Ending::cut_off)]
                                  : 0.0);
  }

  /// Backward induction from the last draw to the first. A row of cells is skipped if nothing near
  /// it has changed since the draw before.
  Decisions limited() {
    const auto draws_in_all = static_cast<std::size_t>(options_.max_cells);
    d_.action.resize(size_ * draws_in_all);
    const int rows = d_.field.rows;
    ValuePlane next = plane_;
    std::vector<char> changed(static_cast<std::size_t>(rows), 1), changes(changed);
    for (int draws = options_.max_cells - 1; draws >= 0; --draws) {
      std::uint16_t* const chosen = d_.action.data() + static_cast<std::size_t>(draws) * size_;
      tbb::parallel_for(0, rows, [&](int row) {
        const auto near = changed.begin() + std::max(0, row - reach_.rows);
        const auto behind = changed.begin() + std::min(rows, row + reach_.rows + 1);
        char& of_row = changes[static_cast<std::size_t>(row)];
        of_row = std::find(near, behind, 1) != behind;
        if (!of_row) {
          std::copy(chosen + size_ + d_.at(0, row, 0), chosen + size_ + d_.at(0, row + 1, 0),
                    chosen + d_.at(0, row, 0));
          return;
        }
        of_row = 0;
        each_block([&](int input, int column, int count) {
          const double* const before = plane_.columns(row, input) + column;
          const Choices best =
              choose(row, column, count, input, plane_.columns(row, 0) + column, {});
          for (int k = 0; k < count; ++k) {
            const auto at = static_cast<std::size_t>(k);
            chosen[d_.at(column + k, row, input)] = best.action[at];
            next.columns(row, input)[column + k] = best.value[at];
            if (best.value[at] != before[k]) of_row = 1;
          }
        });
      });
      std::swap(plane_, next);
      // Skipped rows have the same values in both planes.
      std::swap(changed, changes);
    }
    d_.sweeps = options_.max_cells;
    return result();
  }

  /// Value iteration. Most moves lead ahead, so each row of the field is solved on its own, from
  /// the far end, before all rows together.
  ///
  /// Without costs, values rise from 0 and never exceed what the present decisions are worth; these
  /// decisions are evaluated fully before they are improved again. If draws cost, decisions may
  /// circle, and their value then falls for ever, so each sweep improves them.
  ///
  /// The same holds in doubt: the least mean of a row rises with the values, and by no more. From 0
  /// the values rise to those of the worst rows for ever. If these rows keep a walk from ending,
  /// its states have one value, 0, and are left for a better action.
  Decisions unlimited() {
    d_.action.resize(size_);
    for (int row = d_.field.rows - 1; row >= 0; --row)
      while (sweep(row, true))
        while (!costs_ && sweep(row, false)) {
        }
    const auto sweep_all = [&](bool improves) {
      bool changes = false;
      for (int row = d_.field.rows - 1; row >= 0; --row) changes |= sweep(row, improves);
      return changes;
    };
    while (sweep_all(true))
      while (!costs_ && sweep_all(false)) {
      }
    d_.sweeps = static_cast<int>(sweeps_ / d_.field.rows + 1);
    return result();
  }

 private:
  struct Choices {
    std::array<std::uint16_t, kColumns> action{};
    ColumnValues value{};
  };

  [[nodiscard]] std::size_t type_of(std::size_t action, int column, int row) const {
    return static_cast<std::size_t>(actions_[action].type_of(column, row));
  }

  /// The value of an action in each of some columns.
  [[nodiscard]] ColumnValues gained(std::size_t action, int row, int column, int count, int input,
                                    const double* here) const {
    const std::size_t type = type_of(action, column, row);
    ColumnValues gains = rows_[action][type].value(input, here);
    for (int k = 1; k < count; ++k)
      if (const std::size_t other = type_of(action, column + k, row); other != type)
        gains[static_cast<std::size_t>(k)] =
            rows_[action][other].value(input, here)[static_cast<std::size_t>(k)];
    return gains;
  }

  /// Chooses, in each column, the first action that is better by more than rounding than the kept
  /// one, or than all before it.
  [[nodiscard]] Choices choose(int row, int column, int count, int input, const double* here,
                               std::optional<Choices> kept) const {
    Choices best;
    if (kept)
      best = *kept;
    else
      best.value = gained(0, row, column, count, input, here);
    const double share = kept ? tolerance_ : rounding_, least = kept ? least_ : 0.0;
    for (std::size_t a = kept ? 0 : 1; a < actions_.size(); ++a) {
      const ColumnValues gains = gained(a, row, column, count, input, here);
      for (std::size_t k = 0; k < kColumns; ++k)
        if (gains[k] - best.value[k] >
            share * std::max({std::abs(gains[k]), std::abs(best.value[k]), least})) {
          best.action[k] = static_cast<std::uint16_t>(a);
          best.value[k] = gains[k];
        }
    }
    return best;
  }

  template <class Do>
  void each_block(const Do& what) const {
    for (int input = 0; input < d_.inputs; ++input)
      for (int column = 0; column < d_.field.columns; column += kColumns)
        what(input, column, std::min(kColumns, d_.field.columns - column));
  }

  /// Updates each value of a row from the newest values of all others (except within a block of
  /// columns). Returns whether any value changed. Either improves decisions or only evaluates the
  /// present ones, which takes less time.
  bool sweep(int row, bool improves) {
    if (++sweeps_ / d_.field.rows > options_.max_sweeps)
      throw std::runtime_error("decisions are not found in " + std::to_string(options_.max_sweeps) +
                               " sweeps of the field: walks can circle almost for ever");
    bool changes = false;
    each_block([&](int input, int column, int count) {
      const double* const here = plane_.columns(row, 0) + column;
      double* const values = plane_.columns(row, input) + column;
      Choices now;
      for (int k = 0; k < count; ++k) {
        const auto at = static_cast<std::size_t>(k);
        now.action[at] = d_.action[d_.at(column + k, row, input)];
      }
      const std::uint16_t first = now.action[0];
      now.value = gained(first, row, column, count, input, here);
      for (int k = 1; k < count; ++k)
        if (const auto at = static_cast<std::size_t>(k); now.action[at] != first)
          now.value[at] = gained(now.action[at], row, column, count, input, here)[at];
      if (improves) now = choose(row, column, count, input, here, now);
      for (int k = 0; k < count; ++k) {
        const auto at = static_cast<std::size_t>(k);
        // A least mean is a difference with more than its own rounding error. If such values could
        // fall, they might change for ever.
        if (doubts_) now.value[at] = std::max(now.value[at], values[k]);
        std::uint16_t& action = d_.action[d_.at(column + k, row, input)];
        const double size = std::max({std::abs(now.value[at]), std::abs(values[k]), least_});
        if (action == now.action[at] && std::abs(now.value[at] - values[k]) <= tolerance_ * size)
          continue;
        values[k] = now.value[at];
        action = now.action[at];
        changes = true;
      }
    });
    return changes;
  }

  Decisions result() {
    for (int row = 0; row < d_.field.rows; ++row)
      for (int input = 0; input < d_.inputs; ++input)
        for (int column = 0; column < d_.field.columns; ++column)
          d_.value[d_.at(column, row, input)] = plane_.columns(row, input)[column];
    return std::move(d_);
  }

  const std::vector<FieldChain>& actions_;
  DecideOptions options_;
  bool costs_;        // draws have gains
  bool doubts_;       // rows are in doubt
  double rounding_;   // relative rounding error of a value
  double tolerance_;  // smallest relative change that counts
  double least_;      // smallest value to which changes are compared
  Reach reach_;
  ValuePlane plane_;
  std::vector<std::vector<ActionRows>> rows_;  // [action][type of cell]
  Decisions d_;
  std::size_t size_ = 0;  // cells x inputs
  std::int64_t sweeps_ = 0;
};

}  // namespace

Decisions decide(const std::vector<FieldChain>& actions, const Field& field, const Gains& gains,
                 const DecideOptions& options) {
  check_actions(actions, field, gains, options);
  Decider decider(actions, field, gains, options);
  return options.max_cells > 0 ? decider.limited() : decider.unlimited();
}

FieldChain decided(const std::vector<FieldChain>& actions, const Decisions& d, int draws) {
  const auto require = [](bool holds) {
    if (!holds) throw std::invalid_argument("decisions are of other actions");
  };
  require(!actions.empty() && (draws == 0 || (draws > 0 && draws < d.max_cells)));
  for (const FieldChain& action : actions) {
    require(action.inputs() == d.inputs);
    validate(action, d.field, {}, 0);
  }
  require(d.action.size() == d.at(0, d.field.rows, 0, std::max(1, d.max_cells) - 1));
  // The outputs of all actions are numbered one after the other, so a cell's chain can take each
  // row from the chosen action.
  std::vector<Chain> chains;
  std::vector<int> types;
  std::map<std::pair<std::vector<int>, std::vector<std::uint16_t>>, int> known;
  for (int row = 0; row < d.field.rows; ++row)
    for (int column = 0; column < d.field.columns; ++column) {
      std::vector<int> of_action;
      for (const FieldChain& action : actions) of_action.push_back(action.type_of(column, row));
      const auto* const chosen = d.action.data() + d.at(column, row, 0, draws);
      const auto [at, is_new] = known.try_emplace({of_action, {chosen, chosen + d.inputs}},
                                                  static_cast<int>(chains.size()));
      types.push_back(at->second);
      if (!is_new) continue;
      std::vector<Exit> exits;
      std::vector<int> begin;
      for (const FieldChain& action : actions) {
        const auto& more = action.at(column, row).exits();
        begin.push_back(static_cast<int>(exits.size()));
        exits.insert(exits.end(), more.begin(), more.end());
      }
      std::vector<Eigen::Triplet<double>> entries;
      for (int input = 0; input < d.inputs; ++input) {
        require(chosen[input] < actions.size());
        const Chain& chain = actions[chosen[input]].at(column, row);
        for (Probabilities::InnerIterator it(chain.matrix(), input); it; ++it)
          entries.emplace_back(input, begin[chosen[input]] + static_cast<int>(it.col()),
                               it.value());
      }
      Probabilities matrix(d.inputs, static_cast<Eigen::Index>(exits.size()));
      matrix.setFromTriplets(entries.begin(), entries.end());
      chains.push_back(Chain::from_probabilities(std::move(matrix), std::move(exits)));
    }
  return FieldChain::by_cell(std::move(chains), d.field.columns, std::move(types));
}

}  // namespace gatewalk::markov
