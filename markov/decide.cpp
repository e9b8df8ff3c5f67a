// SPDX-License-Identifier: MIT
#include "markov/decide.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>

namespace gatewalk::markov {
namespace {

/// Values of all cells and states, within a border of cells beyond the field, whose values are
/// those of leaving it.
class Plane {
 public:
  Plane(const Field& field, int inputs, int border)
      : field_(field),
        inputs_(inputs),
        border_(border),
        pitch_(static_cast<std::ptrdiff_t>(field.columns) + 2 * border),
        values_(static_cast<std::size_t>(pitch_ * (field.rows + 2 * border) * inputs)) {}

  [[nodiscard]] double* cell(std::ptrdiff_t column, std::ptrdiff_t row) {
    return values_.data() + ((row + border_) * pitch_ + column + border_) * inputs_;
  }
  /// From a cell's values to those of an exit.
  [[nodiscard]] std::ptrdiff_t step(const Exit& exit) const {
    return (exit.di_y * pitch_ + exit.di_x) * inputs_ + exit.next_input;
  }
  void fill(const std::array<double, kEndings>& gains, double inside) {
    for (std::ptrdiff_t row = -border_; row < field_.rows + border_; ++row)
      for (std::ptrdiff_t column = -border_; column < field_.columns + border_; ++column) {
        const bool out = column < 0 || column >= field_.columns || row < 0 || row >= field_.rows;
        std::fill_n(
            cell(column, row), inputs_,
            out ? gains[static_cast<std::size_t>(edge_before(field_, column, row))] : inside);
      }
  }

 private:
  Field field_;
  int inputs_, border_;
  std::ptrdiff_t pitch_;
  std::vector<double> values_;
};

/// The rows of an action's chain for cells of one type.
struct Rows {
  struct Move {
    double p;
    std::ptrdiff_t step;
  };
  std::vector<double> at_once;     // (inputs) mean gain of a draw, and of being trapped by it
  std::vector<std::size_t> first;  // (inputs + 1)
  std::vector<Move> moves;

  Rows(const Chain& chain, const Gains& gains, const std::vector<double>* draw,
       const Plane& plane) {
    const auto gain = [&](Ending e) { return gains.ending[static_cast<std::size_t>(e)]; };
    for (int input = 0; input < chain.inputs(); ++input) {
      first.push_back(moves.size());
      double now = draw ? (*draw)[static_cast<std::size_t>(input)] : 0.0;
      if (!chain.is_sampled(input)) now = gain(Ending::unsampled);
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

  [[nodiscard]] double value(int input, const double* here) const {
    const auto i = static_cast<std::size_t>(input);
    double sum = at_once[i];
    for (std::size_t m = first[i]; m < first[i + 1]; ++m) sum += moves[m].p * here[moves[m].step];
    return sum;
  }
};

int widest_move(const std::vector<FieldChain>& actions) {
  int widest = 0;
  for (const FieldChain& action : actions)
    for (const Chain& chain : action.chains())
      for (const Exit& exit : chain.exits())
        widest = std::max({widest, std::abs(exit.di_x), std::abs(exit.di_y)});
  return widest;
}

void check(const std::vector<FieldChain>& actions, const Field& field, const Gains& gains,
           const DecideOptions& options) {
  const auto require = [](bool holds, const std::string& what) {
    if (!holds) throw std::invalid_argument(what);
  };
  require(!actions.empty() && actions.size() <= std::numeric_limits<std::uint16_t>::max(),
          "there must be 1 to 65535 actions");
  for (const FieldChain& action : actions) {
    require(action.inputs() == actions.front().inputs(), "actions have chains of other inputs");
    validate(action, field, {}, options.max_cells);
  }
  require(widest_move(actions) <= 10'000, "a move leads over more than 10000 cells");
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
                "without limit of cells each draw must cost something, or none must gain anything");
    }
  }
}

/// The largest gain of an ending or a draw: what rounding is measured by.
double scale_of(const Gains& gains) {
  double scale = std::numeric_limits<double>::min();
  for (const double gain : gains.ending) scale = std::max(scale, std::abs(gain));
  for (const auto& of_action : gains.draw)
    for (const auto& of_type : of_action)
      for (const double gain : of_type) scale = std::max(scale, std::abs(gain));
  return scale;
}

class Decider {
 public:
  Decider(const std::vector<FieldChain>& actions, const Field& field, const Gains& gains,
          const DecideOptions& options)
      : actions_(actions),
        options_(options),
        scale_(scale_of(gains)),
        plane_(field, actions.front().inputs(), widest_move(actions)),
        rows_(actions.size()) {
    for (std::size_t a = 0; a < actions.size(); ++a)
      for (std::size_t type = 0; type < actions[a].chains().size(); ++type)
        rows_[a].emplace_back(actions[a].chains()[type], gains,
                              gains.draw.empty() ? nullptr : &gains.draw[a][type], plane_);
    d_.field = field;
    d_.inputs = actions.front().inputs();
    d_.max_cells = options.max_cells;
    size_ = static_cast<std::size_t>(field.columns) * static_cast<std::size_t>(field.rows) *
            static_cast<std::size_t>(d_.inputs);
    d_.action.resize(size_ * static_cast<std::size_t>(std::max(1, options.max_cells)));
    d_.value.resize(size_);
    plane_.fill(gains.ending, options.max_cells > 0
                                  ? gains.ending[static_cast<std::size_t>(Ending::cut_off)]
                                  : 0.0);
  }

  Decisions limited() {
    for (int draws = options_.max_cells - 1; draws >= 0; --draws) {
      std::uint16_t* const chosen = d_.action.data() + static_cast<std::size_t>(draws) * size_;
      each_cell([&](std::size_t at, int column, int row) {
        const double* const here = plane_.cell(column, row);
        for (int input = 0; input < d_.inputs; ++input) {
          const auto [action, value] = best(column, row, input, here, 0, no_value());
          chosen[at + static_cast<std::size_t>(input)] = action;
          d_.value[at + static_cast<std::size_t>(input)] = value;
        }
      });
      if (draws > 0)
        each_cell([&](std::size_t at, int column, int row) {
          std::copy_n(d_.value.data() + at, d_.inputs, plane_.cell(column, row));
        });
    }
    d_.sweeps = options_.max_cells;
    return std::move(d_);
  }

  /// Values rise from 0, or fall where draws cost. Most moves lead ahead: each row of the field is
  /// done for itself, from the far end, before all are done together.
  Decisions unlimited() {
    for (int row = d_.field.rows - 1; row >= 0; --row)
      while (sweep(row, true))
        while (sweep(row, false)) {
        }
    const auto sweep_all = [&](bool improves) {
      bool changes = false;
      for (int row = d_.field.rows - 1; row >= 0; --row) changes |= sweep(row, improves);
      return changes;
    };
    while (sweep_all(true))
      while (sweep_all(false)) {
      }
    each_cell([&](std::size_t at, int column, int row) {
      std::copy_n(plane_.cell(column, row), d_.inputs, d_.value.data() + at);
    });
    d_.sweeps = static_cast<int>(sweeps_ / d_.field.rows + 1);
    return std::move(d_);
  }

 private:
  struct Choice {
    std::uint16_t action;
    double value;
  };
  static constexpr double no_value() { return -std::numeric_limits<double>::infinity(); }

  /// The first action that is better than `action` is, or than all before it, by more than
  /// rounding.
  Choice best(int column, int row, int input, const double* here, std::uint16_t action,
              double value) const {
    for (std::size_t a = 0; a < actions_.size(); ++a) {
      const auto type = static_cast<std::size_t>(actions_[a].type_of(column, row));
      const double gain = rows_[a][type].value(input, here);
      if (gain > value + options_.tolerance * scale_ || value == no_value()) {
        action = static_cast<std::uint16_t>(a);
        value = gain;
      }
    }
    return {action, value};
  }

  template <class Do>
  void each_cell(const Do& what) {
    std::size_t at = 0;
    for (int row = 0; row < d_.field.rows; ++row)
      for (int column = 0; column < d_.field.columns; ++column) {
        what(at, column, row);
        at += static_cast<std::size_t>(d_.inputs);
      }
  }

  /// Once there and back over a row, each value from the newest of all others; whether any changed.
  /// Improves decisions, or only finds what those that there are gain, which takes less time.
  bool sweep(int row, bool improves) {
    if (++sweeps_ / d_.field.rows > options_.max_sweeps)
      throw std::runtime_error("decisions are not found in " + std::to_string(options_.max_sweeps) +
                               " sweeps of the field: walks can circle almost for ever");
    bool changes = false;
    const int columns = d_.field.columns;
    for (int i = 0; i < 2 * columns; ++i) {
      const int column = i < columns ? i : 2 * columns - 1 - i;
      double* const here = plane_.cell(column, row);
      std::uint16_t* const chosen = d_.action.data() + d_.at(column, row, 0);
      for (int input = 0; input < d_.inputs; ++input) {
        const auto type = static_cast<std::size_t>(actions_[chosen[input]].type_of(column, row));
        const double kept = rows_[chosen[input]][type].value(input, here);
        const Choice choice = improves ? best(column, row, input, here, chosen[input], kept)
                                       : Choice{chosen[input], kept};
        if (std::abs(choice.value - here[input]) <= options_.tolerance * scale_) continue;
        here[input] = choice.value;
        chosen[input] = choice.action;
        changes = true;
      }
    }
    return changes;
  }

  const std::vector<FieldChain>& actions_;
  DecideOptions options_;
  double scale_;
  Plane plane_;
  std::vector<std::vector<Rows>> rows_;  // by action and type of cell
  Decisions d_;
  std::size_t size_ = 0;  // cells x inputs
  std::int64_t sweeps_ = 0;
};

}  // namespace

Decisions decide(const std::vector<FieldChain>& actions, const Field& field, const Gains& gains,
                 const DecideOptions& options) {
  check(actions, field, gains, options);
  Decider decider(actions, field, gains, options);
  return options.max_cells > 0 ? decider.limited() : decider.unlimited();
}

FieldChain decided(const std::vector<FieldChain>& actions, const Decisions& d, int draws) {
  if (actions.empty() || actions.front().inputs() != d.inputs ||
      (draws != 0 && (draws < 0 || draws >= d.max_cells)))
    throw std::invalid_argument("decisions are of other actions");
  // Outputs of all actions side by side: a cell's chain has each row from the action chosen there.
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
        if (chosen[input] >= actions.size())
          throw std::invalid_argument("decisions are of other actions");
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
