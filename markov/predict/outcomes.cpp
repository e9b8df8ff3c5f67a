// SPDX-License-Identifier: MIT
#include "markov/outcomes.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>

#include "markov/totals.h"

namespace gatewalk::markov {
namespace {

constexpr int kBlock = 8;  // ends that are followed together
using Block = std::array<double, kBlock>;

/// Shares of the walks by draw (without limit: all draws together), cell and state.
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
  /// Null where nobody passes at that draw.
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

/// Chances of kBlock ends from every state of every cell.
class Backward {
 public:
  /// `ends`: up to kBlock of them, as columns of EndTable.
  Backward(const FieldChain& chain, const Field& field, int max_cells,
           std::span<const Eigen::Index> ends)
      : chain_(chain),
        field_(field),
        cells_(std::int64_t{field.columns} * field.rows),
        inputs_(chain.inputs()),
        max_cells_(max_cells),
        now_(static_cast<std::size_t>(cells_ * inputs_), Block{}),
        paid_(static_cast<std::size_t>(cells_) * kEndings, Block{}) {
    for (std::int64_t cell = 0; cell < cells_; ++cell)
      for (std::size_t ending = 0; ending < kEndings; ++ending) {
        Block& paid = paid_[static_cast<std::size_t>(cell) * kEndings + ending];
        for (std::size_t b = 0; b < ends.size(); ++b)
          if (ends[b] == static_cast<Eigen::Index>(ending) ||
              ends[b] == static_cast<Eigen::Index>(kEndings) + cell)
            paid[b] = 1.0;
      }
  }

  /// With a limit: at this draw, from what is known of the one behind it, in the cells that are
  /// `reached` by it.
  void step(int draw, const std::vector<bool>& reached) {
    behind_.resize(now_.size());
    behind_.swap(now_);  // what is not reached is not looked at
    tbb::parallel_for(std::int64_t{0}, cells_, [&](std::int64_t cell) {
      if (reached[static_cast<std::size_t>(cell)])
        (void)draw_in(cell, draw == max_cells_, behind_.data(), now_.data());
    });
  }

  /// Without limit, row by row from the far edge.
  void settle() {
    constexpr int kMostPasses = 100'000;
    constexpr double kSettled = 1e-13;
    bool back = false;
    for (const Chain& c : chain_.chains())
      for (const Exit& exit : c.exits()) back = back || exit.di_y < 0;
    for (int whole = 0;; ++whole) {
      double changed = 0.0;
      for (int row = field_.rows - 1; row >= 0; --row) {
        for (int sweep = 0;; ++sweep) {
          double change = 0.0;
          for (int i = 0; i < field_.columns; ++i) {
            const int column = sweep % 2 == 0 ? i : field_.columns - 1 - i;
            change = std::max(change, draw_in(std::int64_t{row} * field_.columns + column, false,
                                              now_.data(), now_.data()));
          }
          changed = std::max(changed, change);
          if (change <= kSettled) break;
          if (sweep == kMostPasses) refuse();
        }
      }
      if (!back || changed <= kSettled) return;
      if (whole == kMostPasses) refuse();
    }
  }

  [[nodiscard]] const Block& at(std::int64_t cell, int input) const {
    return now_[static_cast<std::size_t>(cell * inputs_ + input)];
  }
  /// What follows each output drawn in this cell.
  [[nodiscard]] std::vector<const Block*> after(std::int64_t cell, bool last_draw,
                                                const Block* from) const {
    const Chain& c = chain_.at(cell % field_.columns, cell / field_.columns);
    std::vector<const Block*> next;
    next.reserve(c.exits().size());
    for (const Exit& exit : c.exits()) {
      std::int64_t column = cell % field_.columns, row = cell / field_.columns;
      if (const auto ending = follow(field_, exit, last_draw, column, row)) {
        next.push_back(&paid(cell, *ending));
        continue;
      }
      const std::int64_t to = row * field_.columns + column;
      next.push_back(chain_.at(column, row).is_sampled(exit.next_input)
                         ? from + to * inputs_ + exit.next_input
                         : &paid(to, Ending::unsampled));
    }
    return next;
  }
  [[nodiscard]] const Block* values() const { return now_.data(); }
  [[noreturn]] static void refuse() {
    throw std::runtime_error("outcomes: walks circle (almost) for ever");
  }

 private:
  [[nodiscard]] const Block& paid(std::int64_t cell, Ending ending) const {
    return paid_[static_cast<std::size_t>(cell) * kEndings + static_cast<std::size_t>(ending)];
  }
  /// The largest change.
  double draw_in(std::int64_t cell, bool last_draw, const Block* from, Block* to) const {
    const std::vector<const Block*> next = after(cell, last_draw, from);
    const Probabilities& p = chain_.at(cell % field_.columns, cell / field_.columns).matrix();
    double change = 0.0;
    for (int input = 0; input < inputs_; ++input) {
      Block sum{};
      for (Probabilities::InnerIterator it(p, input); it; ++it) {
        const Block& follows = *next[static_cast<std::size_t>(it.col())];
        for (std::size_t b = 0; b < kBlock; ++b) sum[b] += it.value() * follows[b];
      }
      Block& here = to[cell * inputs_ + input];
      for (std::size_t b = 0; b < kBlock; ++b)
        change = std::max(change, std::abs(sum[b] - here[b]));
      here = sum;
    }
    return change;
  }

  const FieldChain& chain_;
  const Field& field_;
  std::int64_t cells_, inputs_;
  int max_cells_;
  std::vector<Block> now_, behind_;  // (cells x inputs)
  std::vector<Block> paid_;          // (cells x endings)
};

void require_memory(std::int64_t cells, std::int64_t inputs, int layers) {
  constexpr double kMostBytes = 4.0 * (1 << 30);
  const double numbers = static_cast<double>(cells) * static_cast<double>(inputs) *
                         (2.0 * kBlock + std::max(1, layers));
  if (numbers * sizeof(double) > kMostBytes)
    throw std::invalid_argument("outcomes: the states of " + std::to_string(cells) +
                                " cells would take more than 4 GiB");
}

/// Cells in which walks from the start can make each draw, from 1, whatever they draw.
std::vector<std::vector<bool>> reached_by_draw(const FieldChain& chain, const Field& field,
                                               const Start& start, int max_cells) {
  const auto cells = static_cast<std::size_t>(std::int64_t{field.columns} * field.rows);
  std::vector<std::vector<bool>> reached(static_cast<std::size_t>(max_cells) + 1,
                                         std::vector<bool>(cells, false));
  if (max_cells > 0)
    reached[1][static_cast<std::size_t>(std::int64_t{start.row} * field.columns + start.column)] =
        true;
  for (std::size_t draw = 1; draw + 1 < reached.size(); ++draw)
    for (std::size_t cell = 0; cell < cells; ++cell) {
      if (!reached[draw][cell]) continue;
      const std::int64_t column = static_cast<std::int64_t>(cell) % field.columns,
                         row = static_cast<std::int64_t>(cell) / field.columns;
      for (const Exit& exit : chain.at(column, row).exits()) {
        std::int64_t to_column = column, to_row = row;
        if (!follow(field, exit, false, to_column, to_row))
          reached[draw + 1][static_cast<std::size_t>(to_row * field.columns + to_column)] = true;
      }
    }
  return reached;
}

/// Where visits go next.
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
  const Eigen::Index ends = static_cast<Eigen::Index>(kEndings) + cells;
  require_memory(cells, chain.inputs(), max_cells);
  const Passed passed(chain, field, start, max_cells);
  const std::int64_t first = std::int64_t{start.row} * field.columns + start.column;
  const std::int64_t outputs = std::ssize(chain.at(start.column, start.row).exits());
  Outcomes out{EndTable::Zero(outputs, ends), EndTable::Zero(cells, ends), {}, {}};
  add_next(out, chain, field, passed);
  const auto reached = reached_by_draw(chain, field, start, max_cells);
  std::vector<Eigen::Index> followed;  // ends
  for (Eigen::Index end = 0; end < ends; ++end) {
    const auto cell = static_cast<std::size_t>(end - static_cast<Eigen::Index>(kEndings));
    if (end < static_cast<Eigen::Index>(kEndings) || max_cells == 0 ||
        std::any_of(reached.begin(), reached.end(), [&](const auto& at) { return at[cell]; }))
      followed.push_back(end);
  }
  for (std::size_t begin = 0; begin < followed.size(); begin += kBlock) {
    const std::span<const Eigen::Index> block =
        std::span(followed).subspan(begin, std::min<std::size_t>(kBlock, followed.size() - begin));
    Backward backward(chain, field, max_cells, block);
    const auto add_visits = [&](int draw) {
      tbb::parallel_for(std::int64_t{0}, cells, [&](std::int64_t cell) {
        const double* share = passed.at(draw, cell);
        for (int input = 0; share && input < chain.inputs(); ++input)
          if (share[input] > 0.0)
            for (std::size_t b = 0; b < block.size(); ++b)
              out.by_cell(cell, block[b]) += share[input] * backward.at(cell, input)[b];
      });
    };
    const auto add_outputs = [&](bool last_draw) {
      const auto after = backward.after(first, last_draw, backward.values());
      for (std::int64_t output = 0; output < outputs; ++output)
        for (std::size_t b = 0; b < block.size(); ++b)
          out.by_output(output, block[b]) = (*after[static_cast<std::size_t>(output)])[b];
    };
    if (max_cells == 0) {
      backward.settle();
      add_visits(1);
      add_outputs(false);
      continue;
    }
    for (int draw = max_cells; draw >= 2; --draw) {
      backward.step(draw, reached[static_cast<std::size_t>(draw)]);
      add_visits(draw);
    }
    add_outputs(max_cells == 1);
    backward.step(1, reached[1]);
    add_visits(1);
  }
  constexpr double kEnded = 1.0 - 1e-9;
  if (out.by_output.leftCols(static_cast<Eigen::Index>(kEndings)).rowwise().sum().minCoeff() <
      kEnded)
    Backward::refuse();
  return out;
}

}  // namespace gatewalk::markov
