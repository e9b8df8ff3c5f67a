// SPDX-License-Identifier: MIT
#include "markov/committor.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "markov/first_passage.h"
#include "markov/predict/moves.h"
#include "markov/predict/row_sweeps.h"

namespace gatewalk::markov {
namespace {

constexpr int kMostSweeps = 100'000;
constexpr double kMostRounding = 1e-9;  // share of the walks

std::vector<Moves> moves_by_type(const FieldChain& chain, Ending ending) {
  std::vector<Moves> moves;
  for (const Chain& c : chain.chains()) moves.emplace_back(c, ending);
  return moves;
}

bool goes_below(const FieldChain& chain) {
  for (const Chain& c : chain.chains())
    for (const Exit& exit : c.exits())
      if (exit.next_input != Exit::kTrapped && exit.di_y < 0) return true;
  return false;
}

[[noreturn]] void refuse_circles(const std::string& where) {
  throw std::runtime_error("committor: " + where + " does not settle in " +
                           std::to_string(kMostSweeps) + " sweeps: walks circle in it");
}
std::string name_of_row(int row) { return "row " + std::to_string(row) + " of the field"; }

/// For each type of cell, one exit for each move.
std::vector<std::vector<Exit>> exits_by_move(const FieldChain& chain) {
  std::vector<std::vector<Exit>> moves;
  for (const Chain& c : chain.chains()) {
    auto& own = moves.emplace_back();
    for (const Exit& exit : c.exits())
      if (exit.next_input != Exit::kTrapped &&
          std::none_of(own.begin(), own.end(),
                       [&](const Exit& e) { return e.di_x == exit.di_x && e.di_y == exit.di_y; }))
        own.push_back(exit);
  }
  return moves;
}

class CommittorRows {
 public:
  CommittorRows(const FieldChain& chain, const Field& field, Ending ending, double tolerance)
      : chain_(chain),
        field_(field),
        ending_(ending),
        tolerance_(tolerance),
        moves_(moves_by_type(chain, ending)),
        all_{field.columns, field.rows, chain.inputs(), {}},
        from_above_(static_cast<std::size_t>(field.columns) *
                    static_cast<std::size_t>(chain.inputs())) {
    all_.values.resize(from_above_.size() * static_cast<std::size_t>(field.rows));
    if (chain.has_uniform_rows())
      for (const Moves& m : moves_)
        sums_.emplace_back(m.within_row(), RowSweeps::Sums::led_to, field.columns, chain.inputs());
  }

  /// Returns nullopt if walks circle in a row.
  std::optional<Committor> solve() && {
    for (int row = field_.rows - 1; row >= 0; --row) {
      look_up(row);
      if (!sums_.empty() && sums_[type_of(0, row)].suits())
        sum(row);
      else if (!sweep(row))
        return {};
    }
    return std::move(all_);
  }

 private:
  [[nodiscard]] double* cell(std::int64_t column, std::int64_t row) {
    return all_.values.data() + (row * field_.columns + column) * all_.inputs;
  }
  [[nodiscard]] std::size_t type_of(int column, int row) const {
    return static_cast<std::size_t>(chain_.type_of(column, row));
  }
  [[nodiscard]] const Moves& moves_of(int column, int row) const {
    return moves_[type_of(column, row)];
  }

  [[nodiscard]] bool within(std::int64_t column) const {
    return column >= 0 && column < field_.columns;
  }
  [[nodiscard]] double ends_beyond(std::int64_t column, std::int64_t row) const {
    return edge_before(field_, column, row) == ending_ ? 1.0 : 0.0;
  }

  /// Sums the endings of the next draw and the contributions of the rows above, which are known;
  /// also makes the first guess.
  void look_up(int row) {
    for (int column = 0; column < field_.columns; ++column) {
      const Moves& m = moves_of(column, row);
      double* const sums = from_above_.data() + std::int64_t{column} * all_.inputs;
      for (int input = 0; input < all_.inputs; ++input) {
        double sum = m.ends[static_cast<std::size_t>(input)];
        for (std::size_t i = m.up[input]; i < m.side[input]; ++i) {
          const auto& [p, di_x, di_y, next] = m.entries[i];
          if (within(column + di_x) && row + di_y < field_.rows)
            sum += p * cell(column + di_x, row + di_y)[next];
          else
            sum += p * ends_beyond(column + di_x, row + di_y);
        }
        sums[input] = sum;
        cell(column, row)[input] = sum;
      }
    }
  }

  /// Updates all states of a cell from its neighbours in the row. Returns the largest relative
  /// change.
  double renew(int column, int row) {
    const Moves& m = moves_of(column, row);
    const double* const sums = from_above_.data() + std::int64_t{column} * all_.inputs;
    double change = 0.0;
    for (int input = 0; input < all_.inputs; ++input) {
      double sum = sums[input];
      for (std::size_t i = m.side[input]; i < m.up[input + 1]; ++i) {
        const auto& [p, di_x, di_y, next] = m.entries[i];
        sum += p * (within(column + di_x) ? cell(column + di_x, row)[next]
                                          : ends_beyond(column + di_x, row));
      }
      double& value = cell(column, row)[input];
      if (sum > 0.0) change = std::max(change, std::abs(sum - value) / sum);
      value = sum;
    }
    return change;
  }

  /// Solves a row in vector registers. Moves over the sides have known endings.
  void sum(int row) {
    const Moves& m = moves_of(0, row);
    for (int column = 0; column < field_.columns; ++column)
      for (int input = 0; input < all_.inputs && ends_at_a_side(m, column); ++input)
        for (std::size_t i = m.side[input]; i < m.up[input + 1]; ++i)
          if (const auto& [p, di_x, di_y, next] = m.entries[i]; !within(column + di_x))
            cell(column, row)[input] += p * ends_beyond(column + di_x, row);
    sums_[type_of(0, row)].solve(cell(0, row), RowSweeps::Of::each, tolerance_);
  }
  [[nodiscard]] bool ends_at_a_side(const Moves& m, int column) const {
    return !within(column - m.widest) || !within(column + m.widest);
  }

  /// Solves a row by sweeps. Returns whether they converge.
  bool sweep(int row) {
    for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
      double change = 0.0;
      for (int i = 0; i < field_.columns; ++i)
        change = std::max(change, renew(sweep % 2 == 0 ? i : field_.columns - 1 - i, row));
      if (change <= tolerance_) return true;
    }
    return false;
  }

  const FieldChain& chain_;
  const Field field_;
  const Ending ending_;
  const double tolerance_;
  std::vector<Moves> moves_;     // by type
  std::vector<RowSweeps> sums_;  // by type; empty if rows have several types
  Committor all_;
  std::vector<double> from_above_;  // (columns x inputs)
};

/// The committor of all cells at once, for any moves.
class CommittorOfAll {
 public:
  CommittorOfAll(const FieldChain& chain, const Field& field, Ending ending)
      : chain_(chain),
        field_(field),
        ending_(ending),
        inputs_(chain.inputs()),
        states_(static_cast<std::size_t>(field.columns) * static_cast<std::size_t>(field.rows) *
                static_cast<std::size_t>(inputs_)),
        can_end_(states_, 0) {
    std::vector<std::size_t> found;  // states that can end; then states that lead to them
    for (std::size_t state = 0; state < states_; ++state) {
      each_draw(state, [&](double p, std::size_t, bool ends, bool) {
        if (p > 0.0 && ends) can_end_[state] = 1;
      });
      if (can_end_[state]) found.push_back(state);
    }
    const std::vector<std::vector<Way>> ways = ways_into();
    while (!found.empty()) {
      const std::size_t state = found.back();
      found.pop_back();
      each_before(state, ways, [&](std::size_t from) {
        if (!std::exchange(can_end_[from], 1)) found.push_back(from);
      });
    }
  }
  [[nodiscard]] std::size_t states() const { return states_; }

  /// Solves by elimination, to some roundings of each value.
  [[nodiscard]] Committor by_elimination() const {
    Committor all{field_.columns, field_.rows, inputs_,
                  first_passages(chain_, field_, {.ending = ending_}, 0).chance};
    if (ending_ != Ending::unsampled) return all;
    for (std::size_t state = 0; state < states_; ++state)  // a walk in an unsampled state has ended
      each_draw(state, [&](double, std::size_t to, bool ends, bool so) {
        if (ends && so) all.values[to] = 1.0;
      });
    return all;
  }

  /// Solves by sweeps. Returns nullopt if walks circle for too long.
  [[nodiscard]] std::optional<Committor> by_sweeps(double tolerance) const {
    struct Value {
      double so = 0.0, ended = 0.0;  // probability of this ending; of any ending, or of none ever
    };
    std::vector<Value> values(states_);
    for (std::size_t state = 0; state < states_; ++state)
      if (!can_end_[state]) values[state].ended = 1.0;
    for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
      double change = 0.0, walking = 0.0, ended = 0.0;
      for (std::size_t i = 0; i < states_; ++i) {
        const std::size_t state = sweep % 2 == 0 ? states_ - 1 - i : i;
        if (!can_end_[state]) continue;
        Value sum;
        each_draw(state, [&](double p, std::size_t to, bool ends, bool so) {
          sum.so += p * (ends ? (so ? 1.0 : 0.0) : values[to].so);
          sum.ended += p * (ends ? 1.0 : values[to].ended);
        });
        if (sum.so > 0.0) change = std::max(change, std::abs(sum.so - values[state].so) / sum.so);
        walking = std::max(walking, 1.0 - sum.ended);
        ended = std::max(ended, sum.ended - values[state].ended);
        values[state] = sum;
      }
      // For long walks, rounding may leave more than the tolerance, and the remainder then stops
      // falling.
      const bool rounded =
          ended <= std::numeric_limits<double>::epsilon() && walking <= kMostRounding;
      if (change > tolerance || (walking > tolerance && !rounded)) continue;
      Committor all{field_.columns, field_.rows, inputs_, {}};
      for (const Value& v : values) all.values.push_back(v.so);
      return all;
    }
    return {};
  }

 private:
  /// A draw of `input` in a cell of a type that does not end the walk.
  struct Way {
    int type, input, di_x, di_y;
  };
  /// The draws, by the state to which they lead.
  [[nodiscard]] std::vector<std::vector<Way>> ways_into() const {
    std::vector<std::vector<Way>> ways(static_cast<std::size_t>(inputs_));
    for (int type = 0; type < std::ssize(chain_.chains()); ++type) {
      const Chain& c = chain_.chains()[static_cast<std::size_t>(type)];
      for (int input = 0; input < inputs_; ++input)
        for (Probabilities::InnerIterator it(c.matrix(), input); it; ++it) {
          const Exit& exit = c.exits()[static_cast<std::size_t>(it.col())];
          if (it.value() > 0.0 && exit.next_input != Exit::kTrapped)
            ways[static_cast<std::size_t>(exit.next_input)].push_back(
                {type, input, exit.di_x, exit.di_y});
        }
    }
    return ways;
  }
  /// Calls use(from) for each state that has a draw which leads to this one.
  template <class Use>
  void each_before(std::size_t state, const std::vector<std::vector<Way>>& ways, Use use) const {
    const auto at = static_cast<std::int64_t>(state);
    const std::int64_t cell = at / inputs_, column = cell % field_.columns,
                       row = cell / field_.columns;
    for (const Way& way : ways[static_cast<std::size_t>(at % inputs_)]) {
      const std::int64_t from_column = column - way.di_x, from_row = row - way.di_y;
      if (from_column >= 0 && from_column < field_.columns && from_row >= 0 &&
          from_row < field_.rows && chain_.type_of(from_column, from_row) == way.type)
        use(static_cast<std::size_t>((from_row * field_.columns + from_column) * inputs_ +
                                     way.input));
    }
  }
  /// Calls use(p, target state, whether the walk ends, whether it has this ending) for each draw of
  /// a state.
  template <class Use>
  void each_draw(std::size_t state, Use use) const {
    const auto at = static_cast<std::int64_t>(state);
    const std::int64_t cell = at / inputs_, column = cell % field_.columns,
                       row = cell / field_.columns;
    const auto input = static_cast<int>(at % inputs_);
    const Chain& here = chain_.at(column, row);
    if (!here.is_sampled(input)) {
      use(1.0, state, true, ending_ == Ending::unsampled);
      return;
    }
    for (Probabilities::InnerIterator it(here.matrix(), input); it; ++it) {
      const Exit& exit = here.exits()[static_cast<std::size_t>(it.col())];
      std::int64_t to_column = column, to_row = row;
      if (const auto ends = follow(field_, exit, false, to_column, to_row))
        use(it.value(), state, true, *ends == ending_);
      else
        use(it.value(),
            static_cast<std::size_t>((to_row * field_.columns + to_column) * inputs_ +
                                     exit.next_input),
            false, false);
    }
  }

  const FieldChain& chain_;
  const Field field_;
  const Ending ending_;
  const int inputs_;
  const std::size_t states_;  // (rows x columns x inputs)
  std::vector<char> can_end_;
};

}  // namespace

Committor committor(const FieldChain& chain, const Field& field, Ending ending, double tolerance) {
  validate(chain, field, {}, 0);
  const bool below = goes_below(chain);
  if (!below)
    if (auto rows = CommittorRows(chain, field, ending, tolerance).solve()) return *std::move(rows);
  // Measured: with more states, sweeps that converge take a hundredth of the time of elimination.
  constexpr std::size_t kSoonEliminated = 1000;
  const CommittorOfAll all(chain, field, ending);
  if (below && all.states() > kSoonEliminated)
    if (auto swept = all.by_sweeps(tolerance)) return *std::move(swept);
  return all.by_elimination();
}

EndingChance::EndingChance(const FieldChain& chain, const Field& field, Ending ending,
                           int max_cells, double tolerance, const std::optional<Start>& from)
    : ending_(ending),
      max_cells_(max_cells),
      cells_(std::int64_t{field.columns} * field.rows),
      inputs_(chain.inputs()),
      layers_(max_cells == 0 ? 1 : max_cells),
      begin_(static_cast<std::size_t>(layers_ * cells_), -1) {
  validate(chain, field, from.value_or(Start{}), max_cells);
  if (max_cells == 0) {
    for (std::int64_t cell = 0; cell < cells_; ++cell)
      begin_[static_cast<std::size_t>(cell)] = cell * inputs_;
    values_ = committor(chain, field, ending, tolerance).values;
    return;
  }
  std::vector<std::vector<std::int64_t>> reached(static_cast<std::size_t>(layers_));  // by layer
  std::int64_t count = 0;
  const auto reach = [&](std::int64_t layer, std::int64_t cell) {
    std::int64_t& begin = begin_[static_cast<std::size_t>(layer * cells_ + cell)];
    if (begin >= 0) return;
    begin = count++ * inputs_;
    reached[static_cast<std::size_t>(layer)].push_back(cell);
  };
  if (from) reach(0, std::int64_t{from->row} * field.columns + from->column);
  const std::vector<std::vector<Exit>> moves = exits_by_move(chain);
  for (std::int64_t layer = 0; layer < layers_; ++layer) {
    for (std::int64_t cell = 0; cell < cells_ && !from; ++cell) reach(layer, cell);
    if (!from || layer + 1 == layers_) continue;
    for (const std::int64_t cell : reached[static_cast<std::size_t>(layer)])
      for (const Exit& move : moves[static_cast<std::size_t>(
               chain.type_of(cell % field.columns, cell / field.columns))]) {
        std::int64_t column = cell % field.columns, row = cell / field.columns;
        if (!follow(field, move, false, column, row))
          reach(layer + 1, row * field.columns + column);
      }
  }
  constexpr double kMostNumbers = 4.0 * (1 << 30) / sizeof(double);
  const double numbers = static_cast<double>(count) * static_cast<double>(inputs_);
  if (numbers > kMostNumbers)
    throw std::invalid_argument("the chance of an ending from every state of " +
                                std::to_string(cells_) + " cells, " + std::to_string(layers_) +
                                " draws each, takes more than 4 GiB");
  values_.resize(static_cast<std::size_t>(numbers));
  for (std::int64_t layer = layers_ - 1; layer >= 0; --layer) {
    const std::vector<std::int64_t>& here = reached[static_cast<std::size_t>(layer)];
    tbb::parallel_for(std::size_t{0}, here.size(), [&](std::size_t k) {
      const std::int64_t cell = here[k];
      const Chain& c = chain.at(cell % field.columns, cell / field.columns);
      std::vector<double> follows;  // by output
      follows.reserve(c.exits().size());
      for (const Exit& exit : c.exits()) {
        std::int64_t column = cell % field.columns, row = cell / field.columns;
        const auto ends = follow(field, exit, layer + 1 == layers_, column, row);
        follows.push_back(ends ? (*ends == ending ? 1.0 : 0.0)
                               : values_[static_cast<std::size_t>(
                                     begin_[static_cast<std::size_t>(
                                         (layer + 1) * cells_ + row * field.columns + column)] +
                                     exit.next_input)]);
      }
      double* const out = values_.data() + begin_[static_cast<std::size_t>(layer * cells_ + cell)];
      for (int input = 0; input < c.inputs(); ++input) {
        double sum = !c.is_sampled(input) && ending == Ending::unsampled ? 1.0 : 0.0;
        for (Probabilities::InnerIterator it(c.matrix(), input); it; ++it)
          sum += it.value() * follows[static_cast<std::size_t>(it.col())];
        out[input] = sum;
      }
    });
  }
}

std::vector<double> row_chances(const FieldChain& chain, const Field& field, const Start& start) {
  validate(chain, field, start, 0);
  if (goes_below(chain)) throw std::invalid_argument("committor: a move leads to a row below");
  const std::vector<Moves> moves = moves_by_type(chain, Ending::far_edge);
  for (const Moves& m : moves)
    for (const Moves::Entry& e : m.entries)
      if (e.di_y > 1) throw std::invalid_argument("committor: a move leads over a row");
  const auto inputs = static_cast<std::size_t>(chain.inputs());
  const auto at = [&](int column) { return static_cast<std::size_t>(column) * inputs; };
  // (columns x inputs) shares of walks that have entered a row and not gone on yet: of this row, of
  // the next row.
  std::vector<double> waiting(at(field.columns), 0.0), above(waiting.size()), here(inputs);
  waiting[at(start.column) + static_cast<std::size_t>(start.input)] = 1.0;
  std::vector<double> chances;
  for (int row = start.row; row < field.rows; ++row) {
    double up = 0.0;
    std::fill(above.begin(), above.end(), 0.0);
    const auto pass_on = [&](int column) {
      const Moves& m = moves[static_cast<std::size_t>(chain.type_of(column, row))];
      const auto begin = waiting.begin() + static_cast<std::ptrdiff_t>(at(column));
      std::copy_n(begin, inputs, here.begin());
      std::fill_n(begin, inputs, 0.0);
      for (std::size_t input = 0; input < inputs; ++input) {
        if (here[input] == 0.0) continue;
        for (std::size_t i = m.up[input]; i < m.up[input + 1]; ++i) {
          const auto& [p, di_x, di_y, next] = m.entries[i];
          const double share = here[input] * p;
          if (di_y > 0) up += share;
          if (column + di_x >= 0 && column + di_x < field.columns)
            (di_y > 0 ? above : waiting)[at(column + di_x) + static_cast<std::size_t>(next)] +=
                share;
        }
      }
    };
    double left = 1.0;
    for (int sweep = 0; left > kRowTolerance * up; ++sweep) {
      if (sweep == kMostSweeps) refuse_circles(name_of_row(row));
      for (int i = 0; i < field.columns; ++i) pass_on(sweep % 2 == 0 ? i : field.columns - 1 - i);
      left = std::accumulate(waiting.begin(), waiting.end(), 0.0);
    }
    chances.push_back(up);
    waiting.swap(above);
  }
  return chances;
}

}  // namespace gatewalk::markov
