// SPDX-License-Identifier: MIT
#include "markov/outcomes.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>

#include "markov/predict/backward.h"
#include "markov/totals.h"

namespace gatewalk::markov {
namespace {

[[noreturn]] void refuse_endless() {
  throw std::runtime_error("outcomes: walks circle (almost) for ever");
}

/// The shares of walks by draw (without a limit: all draws together), cell and state.
class Passed {
 public:
  Passed(const FieldChain& chain, const Field& field, const Start& start, int max_cells)
      : cells_(std::int64_t{field.columns} * field.rows), inputs_(chain.inputs()) {
    (void)walk_totals(chain, field, start, max_cells, {},
                      [&](int draw, std::int64_t cell, int input, double share) {
                        const auto layer = static_cast<std::size_t>(max_cells > 0 ? draw - 1 : 0);
                        if (layer >= shares_.size()) shares_.resize(layer + 1);
                        if (shares_[layer].empty())
                          shares_[layer].resize(static_cast<std::size_t>(cells_ * inputs_), 0.0);
                        shares_[layer][index(cell, input)] += share;
                      });
  }
  /// The shares of a cell at a draw; null if no walk passes.
  [[nodiscard]] const double* at(int draw, std::int64_t cell) const {
    const auto layer = static_cast<std::size_t>(draw - 1);
    if (layer >= shares_.size() || shares_[layer].empty()) return nullptr;
    return shares_[layer].data() + index(cell, 0);
  }
  [[nodiscard]] int layers() const { return static_cast<int>(shares_.size()); }

 private:
  [[nodiscard]] std::size_t index(std::int64_t cell, int input) const {
    return static_cast<std::size_t>(cell * inputs_ + input);
  }
  std::int64_t cells_, inputs_;
  std::vector<std::vector<double>> shares_;
};

void require_memory(std::int64_t cells, std::int64_t inputs, int layers) {
  constexpr double kMostBytes = 4.0 * (1 << 30);
  const double numbers = static_cast<double>(cells) * static_cast<double>(inputs) *
                         (2.0 * kLanes + std::max(1, layers));
  if (numbers * sizeof(double) > kMostBytes)
    throw std::invalid_argument("outcomes: the states of " + std::to_string(cells) +
                                " cells would take more than 4 GiB");
}

/// Computes how visits continue.
void add_next(Outcomes& out, const FieldChain& chain, const Field& field, const Passed& passed) {
  for (const Chain& c : chain.chains())
    for (const Exit& exit : c.exits()) {
      const std::array<int, 2> move{exit.di_x, exit.di_y};
      if (exit.next_input != Exit::kTrapped &&
          std::find(out.moves.begin(), out.moves.end(), move) == out.moves.end())
        out.moves.push_back(move);
    }
  const std::int64_t cells = out.by_cell.rows();
  out.next = EndTable::Zero(cells, std::ssize(out.moves) + 1);
  for (std::int64_t cell = 0; cell < cells; ++cell) {
    const Chain& c = chain.at(cell % field.columns, cell / field.columns);
    std::vector<Eigen::Index> column;
    for (const Exit& exit : c.exits())
      column.push_back(exit.next_input == Exit::kTrapped
                           ? std::ssize(out.moves)
                           : std::find(out.moves.begin(), out.moves.end(),
                                       std::array<int, 2>{exit.di_x, exit.di_y}) -
                                 out.moves.begin());
    for (int draw = 1; draw <= passed.layers(); ++draw) {
      const double* share = passed.at(draw, cell);
      for (int input = 0; share && input < chain.inputs(); ++input)
        if (share[input] > 0.0)
          for (Probabilities::InnerIterator it(c.matrix(), input); it; ++it)
            out.next(cell, column[static_cast<std::size_t>(it.col())]) += share[input] * it.value();
    }
  }
}

}  // namespace

Outcomes outcomes(const FieldChain& chain, const Field& field, const Start& start, int max_cells) {
  validate(chain, field, start, max_cells);
  const std::int64_t cells = std::int64_t{field.columns} * field.rows;
  constexpr auto kEnds = static_cast<Eigen::Index>(kEndings);
  require_memory(cells, chain.inputs(), max_cells);
  const Passed passed(chain, field, start, max_cells);
  const std::vector<Exit>& exits = chain.at(start.column, start.row).exits();
  Outcomes out{EndTable::Zero(std::ssize(exits), kEnds + cells),
               EndTable::Zero(cells, kEnds + cells),
               {},
               {}};
  add_next(out, chain, field, passed);

  Backward backward(chain, field, start.column, start.row, max_cells);
  std::vector<Question> questions;
  std::vector<Eigen::Index> column_of;  // by question
  for (Eigen::Index e = 0; e < kEnds; ++e) {
    questions.push_back({{}, static_cast<Ending>(e)});
    column_of.push_back(e);
  }
  const Box near = backward.reached(max_cells > 0 ? backward.last_move() : cells);
  for (std::int64_t cell = 0; cell < cells; ++cell) {
    if (!near.holds(cell % field.columns, cell / field.columns)) continue;
    questions.push_back({cell, {}});
    column_of.push_back(kEnds + cell);
  }
  backward.ask(questions, [&](std::span<const std::size_t> numbers) {
    const auto add_visits = [&](int draw) {
      tbb::parallel_for(std::int64_t{0}, cells, [&](std::int64_t cell) {
        const double *const share = passed.at(draw, cell), *const answers =
                                                               backward.at(cell % field.columns,
                                                                           cell / field.columns);
        for (int input = 0; share && answers && input < chain.inputs(); ++input)
          if (share[input] > 0.0)
            for (std::size_t k = 0; k < numbers.size(); ++k)
              out.by_cell(cell, column_of[numbers[k]]) +=
                  share[input] * answers[input * kLanes + static_cast<std::ptrdiff_t>(k)];
      });
    };
    for (int moves = backward.last_move(); moves >= 1; --moves) {
      backward.step(moves);
      add_visits(moves + 1);
    }
    if (max_cells == 0 && !backward.settle()) refuse_endless();
    for (std::size_t output = 0; output < exits.size(); ++output)
      for (std::size_t k = 0; k < numbers.size(); ++k)
        out.by_output(static_cast<Eigen::Index>(output), column_of[numbers[k]]) =
            backward.after(exits[output], k);
    if (max_cells > 0) backward.step(0);
    add_visits(1);
  });
  constexpr double kEnded = 1.0 - 1e-9;
  if (out.by_output.leftCols(kEnds).rowwise().sum().minCoeff() < kEnded) refuse_endless();
  return out;
}

}  // namespace gatewalk::markov
