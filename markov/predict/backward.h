// SPDX-License-Identifier: MIT
#pragma once
/// How walks end, found backwards: from what the last draw leads to back to the first one, for all
/// states from which a walk can draw, and kLanes questions at a time.

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "markov/chain.h"
#include "markov/predict/layout.h"

namespace gatewalk::markov {

/// Whether a walk ends in this cell (none: in any) and in this way (none: in any). Neither cell nor
/// way: how often it draws.
struct Question {
  std::optional<std::int64_t> cell{};  // row * columns + column
  std::optional<Ending> why{};
};

/// Columns and rows, the last ones included; none where an end lies before its beginning.
struct Box {
  std::int64_t left, right, bottom, top;

  [[nodiscard]] bool is_empty() const { return left > right || bottom > top; }
  [[nodiscard]] bool holds(std::int64_t column, std::int64_t row) const {
    return column >= left && column <= right && row >= bottom && row <= top;
  }
  [[nodiscard]] std::int64_t columns() const { return right - left + 1; }
  [[nodiscard]] std::int64_t cells() const { return columns() * (top - bottom + 1); }
};

/// Answers of all inputs of some cells of a box, each to kLanes questions that lie side by side; in
/// all other cells they are zero.
class AnswerLayer {
 public:
  explicit AnswerLayer(std::ptrdiff_t inputs) : each_(inputs * kLanes) {}

  /// Calls use(column, row, its answers, not set) for those cells of the window that
  /// is_asked(column, row). All that was before is forgotten.
  template <class Is, class Use>
  void cover(const Box& window, Is is_asked, Use use) {
    window_ = window;
    places_.assign(window.is_empty() ? 0 : static_cast<std::size_t>(window.cells()), nullptr);
    std::vector<std::size_t> asked;
    for (std::size_t i = 0; i < places_.size(); ++i)
      if (is_asked(column_of(i), row_of(i))) asked.push_back(i);
    double* next = memory_.reserve(std::ssize(asked) * each_);
    for (const std::size_t i : asked) {
      use(column_of(i), row_of(i), places_[i] = next);
      next += each_;
    }
  }
  void clear() {
    window_ = {0, -1, 0, -1};
    places_.clear();
  }

  /// Null: all zero.
  [[nodiscard]] const double* at(std::int64_t column, std::int64_t row) const {
    if (!window_.holds(column, row)) return nullptr;
    return places_[static_cast<std::size_t>((row - window_.bottom) * window_.columns() + column -
                                            window_.left)];
  }

 private:
  [[nodiscard]] std::int64_t column_of(std::size_t i) const {
    return window_.left + static_cast<std::int64_t>(i) % window_.columns();
  }
  [[nodiscard]] std::int64_t row_of(std::size_t i) const {
    return window_.bottom + static_cast<std::int64_t>(i) / window_.columns();
  }

  std::ptrdiff_t each_;
  Box window_{0, -1, 0, -1};
  std::vector<double*> places_{};  // by cell of the window
  PlaneBuffer memory_{};
};

/// The recursion, of walks that begin in one cell. The same bits on any number of threads.
class Backward {
 public:
  /// `chain` and `field` must live as long. Checks nothing.
  Backward(const FieldChain& chain, const Field& field, int column, int row, int max_cells);

  [[nodiscard]] int last_move() const { return last_; }
  [[nodiscard]] int most_terms() const { return most_terms_; }
  [[nodiscard]] bool has_unsampled() const { return has_unsampled_; }
  [[nodiscard]] const std::vector<Move>& moves(std::int64_t column, std::int64_t row) const {
    return sums_at(column, row).moves;
  }
  /// Where walks may be after so many moves, if each move goes as far as any does.
  [[nodiscard]] Box reached(std::int64_t moves) const;
  /// Whether a walk that comes to this cell may have made so many moves: not if every move leads to
  /// the other colour of a chessboard, and the cell has the wrong one.
  [[nodiscard]] bool has_colour(std::int64_t column, std::int64_t row, std::int64_t moves) const;

  /// Calls use(numbers of the questions) for up to kLanes questions after the other, until all were
  /// asked. With a limit of cells `use` takes step(last_move()), step(last_move() - 1), ...;
  /// without, settle(). Neighbours are asked for together: of them the same cells matter. (Every
  /// other row backwards.)
  template <class Use>
  void ask(const std::vector<Question>& questions, Use use) {
    std::vector<std::size_t> order(questions.size());
    std::iota(order.begin(), order.end(), 0);
    const auto block = [&](std::size_t q) {
      const std::int64_t cell = questions[q].cell.value_or(0), c = cell % field_.columns,
                         r = cell / field_.columns;
      return std::pair(r / 2, r / 2 % 2 == 0 ? c / 2 : -c / 2);
    };
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return block(a) < block(b); });
    for (std::span left(order); !left.empty(); left = left.subspan(questions_.size())) {
      const auto some = left.first(std::min<std::size_t>(kLanes, left.size()));
      questions_.clear();
      for (const std::size_t q : some) questions_.push_back(questions[q]);
      now_.clear();
      use(some);
    }
  }
  /// From the answers of walks that have made one move more, those of walks about to draw after so
  /// many moves.
  void step(int moves);
  /// Row by row, until no answer changes by more than 1e-13. False where walks circle for too long.
  [[nodiscard]] bool settle();

  /// Of walks about to draw in this cell: (inputs x kLanes). Null: all zero.
  [[nodiscard]] const double* at(std::int64_t column, std::int64_t row) const {
    return now_.at(column, row);
  }
  /// Of walks whose first draw is this exit, once those that have made a move are answered.
  [[nodiscard]] double after(const Exit& exit, std::size_t question) const;

 private:
  /// A chain as sums over what a draw leads to.
  struct Sums {
    std::vector<Move> moves;
    std::vector<GatherTerm> terms;
    std::vector<int> ends{0};    // of each input's terms (inputs + 1)
    std::vector<double> shares;  // (inputs x Share)
    explicit Sums(const Chain& chain);
    [[nodiscard]] int shares_each() const;
  };
  struct Cell {
    std::int64_t column, row;
    double* to;
    std::vector<const double*> from;  // by move
  };

  [[nodiscard]] const Sums& sums_at(std::int64_t column, std::int64_t row) const {
    return sums_[static_cast<std::size_t>(chain_.type_of(column, row))];
  }
  /// Cells that can be reached in so many moves and from which a cell asked for still can.
  [[nodiscard]] Box window(std::int64_t moves) const;
  /// Finds where the answers lie that a draw in the cell leads to.
  void look(Cell& cell, const AnswerLayer& next) const;
  /// Renews up to kMostGathered cells of one type.
  void draw(std::span<const Cell> cells, bool is_last) const;
  /// Adds what one draw in the cell ends with.
  void reward(const Cell& cell, bool is_last) const;
  [[nodiscard]] std::optional<Ending> ends_by(const Move& m, std::int64_t column, std::int64_t row,
                                              bool is_last) const;

  const FieldChain& chain_;
  const Field& field_;
  std::int64_t column_, row_;
  int last_;                // moves that a walk may make; -1: any number
  std::vector<Sums> sums_;  // by type of cell
  int widest_ = 0, lowest_ = 0, highest_ = 0, most_terms_ = 0;
  bool is_chequered_ = true, has_unsampled_ = false;
  std::ptrdiff_t inputs_;
  PlaneBuffer zeros_;
  const double* nothing_;  // answers in cells that cannot be reached
  std::vector<Question> questions_{};
  AnswerLayer now_, next_;
};

}  // namespace gatewalk::markov
