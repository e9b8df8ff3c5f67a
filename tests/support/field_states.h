// SPDX-License-Identifier: MIT
#pragma once
/// The walks over a small field as one absorbing chain of (cell, input) pairs, for exact answers
/// without a limit of cells (absorbing.h).

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "markov/chain.h"
#include "tests/support/absorbing.h"

namespace gatewalk::markov {

struct FieldStates {
  /// A way in which walks end.
  struct End {
    Ending why = Ending::trapped;
    int column = 0, row = 0;  // the final cell
    Start beyond{};           // after a move over an edge: the cell outside, and the state there
  };
  /// A draw from a cell's chain.
  struct Draw {
    static constexpr int kNone = -1;
    int from = 0;         // index into `states`
    bool is_end = false;  // whether `to` is an index of ends, not of states
    int to = 0;
    int output = kNone;  // the output drawn; kNone in a state that was never sampled
    double p = 1.0;
  };
  Field field;
  std::vector<Start> states;  // reached from the starts; these come first, each once
  std::vector<End> ends;
  std::vector<Draw> draws;
};

/// The largest number n of states of a dense chain: n x (n + ends) numbers, about n^3 / 3
/// operations.
inline constexpr int kMostDenseStates = 4000;

namespace states_of_fields {
class Reached {
 public:
  Reached(const FieldChain& chain, const Field& field, int most_states)
      : chain_(chain), most_states_(most_states), f_{field, {}, {}, {}} {}

  FieldStates from(const std::vector<Start>& starts) && {
    for (const Start& s : starts) {
      validate(chain_, f_.field, s, 0);
      state(s);
    }
    for (std::size_t i = 0; i < f_.states.size(); ++i) draw(static_cast<int>(i));
    return std::move(f_);
  }

 private:
  [[nodiscard]] bool is_sampled(const Start& s) const {
    return chain_.at(s.column, s.row).is_sampled(s.input);
  }

  /// The index of a state; adds the state if it is reached for the first time.
  int state(const Start& s) {
    const std::int64_t cell = std::int64_t{s.row} * f_.field.columns + s.column;
    const auto [it, is_new] =
        states_.try_emplace(cell * chain_.inputs() + s.input, static_cast<int>(f_.states.size()));
    if (is_new) {
      if (static_cast<int>(f_.states.size()) == most_states_)
        throw std::invalid_argument(
            "field: more than " + std::to_string(most_states_) + " states of " +
            std::to_string(f_.field.columns) + " x " + std::to_string(f_.field.rows) +
            " cells can be reached; take fewer cells, or a chain of fewer states");
      f_.states.push_back(s);
    }
    return it->second;
  }

  int end(Ending why, int column, int row, const Start& beyond) {
    const auto [it, is_new] = ends_.try_emplace(
        {static_cast<int>(why), column, row, beyond.column, beyond.row, beyond.input},
        static_cast<int>(f_.ends.size()));
    if (is_new) f_.ends.push_back({why, column, row, beyond});
    return it->second;
  }

  void draw(int from) {
    const Start s = f_.states[static_cast<std::size_t>(from)];
    if (!is_sampled(s)) {
      f_.draws.push_back({from, true, end(Ending::unsampled, s.column, s.row, {})});
      return;
    }
    const Chain& chain = chain_.at(s.column, s.row);
    for (Probabilities::InnerIterator it(chain.matrix(), s.input); it; ++it) {
      const Exit& exit = chain.exits()[static_cast<std::size_t>(it.col())];
      const auto output = static_cast<int>(it.col());
      const auto ends = [&](Ending why, int column, int row, const Start& beyond) {
        f_.draws.push_back({from, true, end(why, column, row, beyond), output, it.value()});
      };
      const Start next{s.column + exit.di_x, s.row + exit.di_y, exit.next_input};
      const Field& field = f_.field;
      if (exit.next_input == Exit::kTrapped)
        ends(Ending::trapped, s.column, s.row, {});
      else if (next.column < 0 || next.column >= field.columns || next.row < 0 ||
               next.row >= field.rows)
        ends(edge_before(field, next.column, next.row), s.column, s.row, next);
      else if (!is_sampled(next))
        ends(Ending::unsampled, next.column, next.row, {});
      else
        f_.draws.push_back({from, false, state(next), output, it.value()});
    }
  }

  const FieldChain& chain_;
  const int most_states_;
  FieldStates f_;
  std::unordered_map<std::int64_t, int> states_;  // by cell * inputs + input
  std::map<std::array<int, 6>, int> ends_;        // by all properties of an end
};

}  // namespace states_of_fields

/// Collects the states. Throws std::invalid_argument if chain, field and starts do not belong
/// together, or if more than `most_states` are reached.
[[nodiscard]] inline FieldStates field_states(const FieldChain& chain, const Field& field,
                                              const std::vector<Start>& starts,
                                              int most_states = kMostDenseStates) {
  if (starts.empty()) throw std::invalid_argument("field: no start is given");
  return states_of_fields::Reached(chain, field, most_states).from(starts);
}

/// The absorbing chain. `chance(state, draw)` returns the probability of the draw as a Number, for
/// example an exact fraction of counts.
template <class Number, class Chance>
[[nodiscard]] AbsorbingChain<Number> absorbing_chain(const FieldStates& f, Chance chance) {
  AbsorbingChain<Number> chain(std::ssize(f.states), std::ssize(f.ends));
  for (const FieldStates::Draw& draw : f.draws) {
    Number& p = (draw.is_end ? chain.ends : chain.moves)(draw.from, draw.to);
    if (draw.output == FieldStates::Draw::kNone)
      p += Number(1);
    else
      p += chance(f.states[static_cast<std::size_t>(draw.from)], draw);
  }
  return chain;
}

/// The absorbing chain with the probabilities of the field's own chain.
template <class Number>
[[nodiscard]] AbsorbingChain<Number> absorbing_chain(const FieldStates& f) {
  return absorbing_chain<Number>(
      f, [](const Start&, const FieldStates::Draw& draw) { return Number(draw.p); });
}

/// The contents of a FinalDistribution, as any kind of number.
template <class Number>
struct FieldAnswer {
  std::array<Number, kEndings> endings;  // by Ending
  Dense<Number> final_cells;             // (rows x columns)
};

/// The answer from the start that is state `from`, by the probabilities of all ends (absorption,
/// end_chances).
template <class Number>
[[nodiscard]] FieldAnswer<Number> field_answer(const FieldStates& f, const Dense<Number>& chances,
                                               Eigen::Index from = 0) {
  FieldAnswer<Number> answer{{}, Dense<Number>(f.field.rows, f.field.columns)};
  answer.endings.fill(Number(0));
  for (std::size_t e = 0; e < f.ends.size(); ++e) {
    const FieldStates::End& end = f.ends[e];
    const Number& p = chances(from, static_cast<Eigen::Index>(e));
    answer.endings[static_cast<std::size_t>(end.why)] += p;
    answer.final_cells(end.row, end.column) += p;
  }
  return answer;
}

}  // namespace gatewalk::markov
