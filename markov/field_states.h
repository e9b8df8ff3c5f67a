// SPDX-License-Identifier: MIT
#pragma once
/// The walks over a small field, state by state: (cell, input) pairs as one absorbing chain, for
/// exact answers without limit of cells (absorbing.h).

#include <array>
#include <cstddef>
#include <vector>

#include "markov/absorbing.h"
#include "markov/chain.h"

namespace gatewalk::markov {

struct FieldStates {
  /// A way to end.
  struct End {
    Ending why = Ending::trapped;
    int column = 0, row = 0;  // the final cell
    Start beyond{};  // of a move over an edge: where it leads, a cell outside and the state there
  };
  /// An entry of a cell's chain.
  struct Draw {
    static constexpr int kNone = -1;
    int from = 0;         // of `states`
    bool is_end = false;  // whether `to` counts ends, not states
    int to = 0;
    int output = kNone;  // drawn; kNone in a state never sampled
    double p = 1.0;
  };
  Field field;
  std::vector<Start> states;  // reached from the starts, which are the first, each once
  std::vector<End> ends;
  std::vector<Draw> draws;
};

/// The n states of a dense chain at most: n x (n + ends) numbers, some n^3 / 3 operations.
inline constexpr int kMostDenseStates = 4000;

/// Throws std::invalid_argument when chain, field and starts cannot belong together, or more than
/// `most_states` are reached.
[[nodiscard]] FieldStates field_states(const FieldChain& chain, const Field& field,
                                       const std::vector<Start>& starts,
                                       int most_states = kMostDenseStates);

/// `chance(state, draw)` says how likely the draw is, as a Number: an exact fraction of counts,
/// say.
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

/// The same with the chain's own numbers.
template <class Number>
[[nodiscard]] AbsorbingChain<Number> absorbing_chain(const FieldStates& f) {
  return absorbing_chain<Number>(
      f, [](const Start&, const FieldStates::Draw& draw) { return Number(draw.p); });
}

/// What FinalDistribution says, as any kind of number.
template <class Number>
struct FieldAnswer {
  std::array<Number, kEndings> endings;  // by Ending
  Dense<Number> final_cells;             // (rows x columns)
};

/// From the start that is state `from`, by the chances of all ends (absorption, end_chances).
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
