// SPDX-License-Identifier: MIT
#pragma once
/// How walks end, by backward recursion: from the last draw back to the first, for all states from
/// which a walk can draw, and for kLanes questions at a time.

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

/// A question about a walk: does it end in this cell (none: in any) with this ending (none: any)?
/// Without cell and ending: how often does it draw?
struct Question {
  std::optional<std::int64_t> cell{};  // row * columns + column
  std::optional<Ending> why{};
};

/// A rectangle of cells, last columns and rows included; empty if an end lies before its beginning.
struct Box {
  std::int64_t left, right, bottom, top;

  [[nodiscard]] bool is_empty() const { return left > right || bottom > top; }
  [[nodiscard]] bool holds(std::int64_t column, std::int64_t row) const {
    return column >= left && column <= right && row >= bottom && row <= top;
  }
  [[nodiscard]] std::int64_t columns() const { return right - left + 1; }
  [[nodiscard]] std::int64_t cells() const { return columns() * (top - bottom + 1); }
};

/// The answers of all inputs in some cells of a box, each to kLanes questions side by side. In all
/// other cells the answers are zero.
class AnswerLayer {
 public:
  explicit AnswerLayer(std::ptrdiff_t inputs) : each_(inputs * kLanes) {}

  /// Calls use(column, row, answers) for the cells of the window for which is_asked(column, row) is
  /// true; the answers are not initialised. Earlier content is lost.
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

  /// The answers of a cell; null: all zero.
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
  std::vector<double*> places_{};
  PlaneBuffer memory_{};
};

/// The backward recursion for walks that begin in one cell. The bits are the same for any number of
/// threads.
class Backward {
 public:
  /// Prepares the recursion without checking the arguments. `chain` and `field` must outlive it.
  Backward(const FieldChain& chain, const Field& field, int column, int row, int max_cells);

  [[nodiscard]] int last_move() const { return last_; }
  [[nodiscard]] int most_terms() const { return most_terms_; }
  [[nodiscard]] bool has_unsampled() const { return has_unsampled_; }
  [[nodiscard]] const std::vector<Move>& moves(std::int64_t column, std::int64_t row) const {
    return sums_at(column, row).moves;
  }
  /// The cells where walks may be after `moves` moves if each move goes as far as any move does.
  [[nodiscard]] Box reached(std::int64_t moves) const;
  /// Whether a walk can be in this cell after `moves` moves: false if every move changes the colour
  /// of a chessboard and the cell has the wrong colour.
  [[nodiscard]] bool has_colour(std::int64_t column, std::int64_t row, std::int64_t moves) const;

  /// Calls use(indices of the questions) for groups of up to kLanes questions until all are asked.
  /// With a limit of cells `use` calls step(last_move()), step(last_move() - 1), ...; without one,
  /// settle(). Neighbouring cells are grouped, because they depend on the same cells; every other
  /// row of blocks goes backwards.
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
  /// Computes the answers of walks about to draw after `moves` moves from those after one move
  /// more.
  void step(int moves);
  /// Iterates row by row until no answer changes by more than 1e-13. Returns false if walks circle
  /// for too long.
  [[nodiscard]] bool settle();

  /// The answers of walks about to draw in this cell: (inputs x kLanes). Null: all zero.
  [[nodiscard]] const double* at(std::int64_t column, std::int64_t row) const {
    return now_.at(column, row);
  }
  /// The answer for walks whose first draw is this exit, once the answers after one move are known.
  [[nodiscard]] double after(const Exit& exit, std::size_t question) const;

 private:
  /// A chain as sums over the results of a draw.
  struct Sums {
    std::vector<Move> moves;
    std::vector<GatherTerm> terms;
    std::vector<int> ends{0};    // end of each input's terms (inputs + 1)
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
  /// The cells that can be reached in `moves` moves and from which a cell of a question can still
  /// be reached.
  [[nodiscard]] Box window(std::int64_t moves) const;
  /// Finds the answers of the cells to which a draw in this cell leads.
  void look(Cell& cell, const AnswerLayer& next) const;
  /// Computes the answers of up to kMostGathered cells of one type.
  void draw(std::span<const Cell> cells, bool is_last) const;
  /// Adds the contribution of walks that end with a draw in the cell.
  void reward(const Cell& cell, bool is_last) const;
  [[nodiscard]] std::optional<Ending> ends_by(const Move& m, std::int64_t column, std::int64_t row,
                                              bool is_last) const;

  const FieldChain& chain_;
  const Field& field_;
  std::int64_t column_, row_;
  int last_;                // most moves of a walk; -1: no limit
  std::vector<Sums> sums_;  // by type of cell
  int widest_ = 0, lowest_ = 0, highest_ = 0, most_terms_ = 0;
  bool is_chequered_ = true, has_unsampled_ = false;
  std::ptrdiff_t inputs_;
  PlaneBuffer zeros_;
  const double* nothing_;  // zero answers, for cells that cannot be reached
  std::vector<Question> questions_{};
  AnswerLayer now_, next_;
};

}  // namespace gatewalk::markov
