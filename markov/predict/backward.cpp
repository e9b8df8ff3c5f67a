// SPDX-License-Identifier: MIT
#include <hwy/aligned_allocator.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <new>
#include <numeric>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

#include "markov/predict/ends.h"
#include "markov/predict/layout.h"

namespace gatewalk::markov {
namespace {

/// What a draw in a state may end with, as columns of shares: ...; gone by the first move, by the
/// second, ...
enum Share : int { kTrappedShare, kUnsampledShare, kDrawn, kMovedShare };

/// The chain as sums over what a draw leads to.
struct Sums {
  std::vector<Move> moves;
  std::vector<GatherTerm> terms;
  std::vector<int> ends{0};    // of each input's terms (inputs + 1)
  std::vector<double> shares;  // (inputs x Share)
  int widest = 0, lowest = 0, highest = 0;
  int most_terms = 0;  // of an input
  bool is_chequered = true, has_unsampled = false;

  explicit Sums(const Chain& chain) {
    std::vector<int> move_of;  // by output
    for (const Exit& exit : chain.exits()) {
      move_of.push_back(0);
      if (exit.next_input != Exit::kTrapped) move_of.back() = number_of({exit.di_x, exit.di_y});
    }
    shares.resize(static_cast<std::size_t>(chain.inputs()) * shares_each());
    for (int input = 0; input < chain.inputs(); ++input) {
      double* const own = shares.data() + static_cast<std::ptrdiff_t>(input) * shares_each();
      own[chain.is_sampled(input) ? kDrawn : kUnsampledShare] = 1.0;
      has_unsampled = has_unsampled || !chain.is_sampled(input);
      for (Probabilities::InnerIterator it(chain.matrix(), input); it; ++it) {
        const Exit& exit = chain.exits()[static_cast<std::size_t>(it.col())];
        if (exit.next_input == Exit::kTrapped) {
          own[kTrappedShare] += it.value();
          continue;
        }
        const int move = move_of[static_cast<std::size_t>(it.col())];
        own[kMovedShare + move] += it.value();
        terms.push_back({it.value(), exit.next_input, move});
      }
      most_terms = std::max(most_terms, static_cast<int>(terms.size()) - ends.back());
      ends.push_back(static_cast<int>(terms.size()));
    }
    terms.insert(terms.end(), kTermsAhead, {0.0, 0, 0});  // looked at ahead
  }
  [[nodiscard]] int shares_each() const { return kMovedShare + static_cast<int>(moves.size()); }

 private:
  int number_of(const Move& move) {
    const auto same = [&](const Move& m) { return m.di_x == move.di_x && m.di_y == move.di_y; };
    const auto known = std::find_if(moves.begin(), moves.end(), same);
    const auto number = static_cast<int>(known - moves.begin());
    if (known != moves.end()) return number;
    moves.push_back(move);
    widest = std::max(widest, std::abs(move.di_x));
    lowest = std::min(lowest, move.di_y);
    highest = std::max(highest, move.di_y);
    is_chequered = is_chequered && (move.di_x + move.di_y) % 2 != 0;
    return number;
  }
};

}  // namespace

/// All that the answers to different questions share.
struct AdjointPredictor::Plan {
  Sums sums;
  std::vector<Exit> exits;
  Field field;
  int column, row;
  int last;  // moves that a walk may make
};

namespace {

/// An end in one cell, or the number of draws.
struct Question {
  std::int64_t cell = 0;
  std::optional<Ending> why{};  // none: draws, in any cell
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

/// The answers to kLanes questions of walks about to draw, by cell of a box and input; zero in
/// all other cells. Those of an input lie side by side.
class Layer {
 public:
  explicit Layer(std::ptrdiff_t inputs) : each_(inputs * kLanes) {}

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

}  // namespace

/// The answers to kLanes questions at a time, from the last step back to the first.
class AdjointPredictor::Backward {
 public:
  explicit Backward(const Plan& plan)
      : plan_(plan),
        sums_(plan.sums),
        inputs_(std::ssize(sums_.ends) - 1),
        zeros_(1, inputs_ * kLanes),
        nothing_(zeros_.take(1).data()),
        now_(inputs_),
        next_(inputs_) {}

  /// Sets answers(output, question), of walks that draw this output first.
  template <class Answers>
  void answer(const std::vector<Question>& questions, Answers answers) {
    questions_ = questions;
    now_.clear();
    for (int moves = plan_.last; moves >= 1; --moves) step(moves);
    for (Eigen::Index output = 0; output < std::ssize(plan_.exits); ++output)
      for (std::size_t q = 0; q < questions_.size(); ++q)
        answers(output, q) = of_exit(plan_.exits[static_cast<std::size_t>(output)], q);
  }

 private:
  [[nodiscard]] Box reached(std::int64_t moves) const {
    return {std::max<std::int64_t>(0, plan_.column - sums_.widest * moves),
            std::min<std::int64_t>(plan_.field.columns - 1, plan_.column + sums_.widest * moves),
            std::max<std::int64_t>(0, plan_.row + sums_.lowest * moves),
            std::min<std::int64_t>(plan_.field.rows - 1, plan_.row + sums_.highest * moves)};
  }
  /// Cells that can be reached in so many moves and from which a cell asked for still can.
  [[nodiscard]] Box window(std::int64_t moves) const {
    const Box w = reached(moves);
    const std::int64_t more = plan_.last - moves;
    Box from{w.right + 1, w.left - 1, w.top + 1, w.bottom - 1};
    for (const Question& q : questions_) {
      if (!q.why) return w;
      const std::int64_t column = q.cell % plan_.field.columns, row = q.cell / plan_.field.columns;
      from = {std::min(from.left, column - sums_.widest * more),
              std::max(from.right, column + sums_.widest * more),
              std::min(from.bottom, row - sums_.highest * more),
              std::max(from.top, row - sums_.lowest * more)};
    }
    return {std::max(w.left, from.left), std::min(w.right, from.right),
            std::max(w.bottom, from.bottom), std::min(w.top, from.top)};
  }

  struct Cell {
    std::int64_t column, row;
    double* to;
    std::vector<const double*> from;  // by move
  };

  /// From the answers after one move more, those after so many.
  void step(int moves) {
    std::swap(now_, next_);
    std::vector<Cell> cells;
    now_.cover(
        window(moves),
        [&](std::int64_t column, std::int64_t row) {
          const std::int64_t way = column - plan_.column + row - plan_.row + moves;
          return !sums_.is_chequered || way % 2 == 0;
        },
        [&](std::int64_t column, std::int64_t row, double* to) {
          Cell& cell = cells.emplace_back(Cell{column, row, to, {}});
          for (const Move& m : sums_.moves) {
            const double* const there = next_.at(column + m.di_x, row + m.di_y);
            cell.from.push_back(there ? there : nothing_);
          }
        });
    const GatherPass pass{sums_.terms.data(), sums_.ends.data(), static_cast<int>(inputs_)};
    constexpr std::size_t kEach = kMostGathered;
    tbb::parallel_for(std::size_t{0}, (cells.size() + kEach - 1) / kEach, [&](std::size_t b) {
      const std::span some =
          std::span(cells).subspan(b * kEach).first(std::min(kEach, cells.size() - b * kEach));
      std::array<GatherCell, kEach> gathered;
      for (std::size_t i = 0; i < some.size(); ++i) gathered[i] = {some[i].from.data(), some[i].to};
      gather(pass, std::span(gathered).first(some.size()));
      for (const Cell& cell : some) reward(cell, moves == plan_.last);
    });
  }

  /// Adds what one draw in the cell ends with.
  void reward(const Cell& cell, bool is_last) const {
    const auto add = [&](std::size_t question, int share) {
      for (std::ptrdiff_t input = 0; input < inputs_; ++input)
        cell.to[input * kLanes + static_cast<std::ptrdiff_t>(question)] +=
            sums_.shares[static_cast<std::size_t>(input * sums_.shares_each() + share)];
    };
    for (std::size_t k = 0; k < questions_.size(); ++k) {
      const Question& q = questions_[k];
      if (!q.why) add(k, kDrawn);
      if (!q.why || cell.row * plan_.field.columns + cell.column != q.cell) continue;
      if (q.why == Ending::trapped) add(k, kTrappedShare);
      if (q.why == Ending::unsampled) add(k, kUnsampledShare);
      for (std::size_t m = 0; m < sums_.moves.size(); ++m)
        if (ends_by(sums_.moves[m], cell.column, cell.row, is_last) == q.why)
          add(k, kMovedShare + static_cast<int>(m));
    }
  }
  [[nodiscard]] std::optional<Ending> ends_by(const Move& m, std::int64_t column, std::int64_t row,
                                              bool is_last) const {
    if (neighbour_cell(plan_.field, column, row, m.di_x, m.di_y) < 0)
      return edge_before(plan_.field, column + m.di_x, row + m.di_y);
    return is_last ? std::optional(Ending::cut_off) : std::nullopt;
  }

  [[nodiscard]] double of_exit(const Exit& exit, std::size_t question) const {
    const Question& q = questions_[question];
    std::optional<Ending> why = Ending::trapped;
    if (exit.next_input != Exit::kTrapped)
      why = ends_by({exit.di_x, exit.di_y}, plan_.column, plan_.row, plan_.last == 0);
    const double first = q.why ? 0.0 : 1.0;
    if (!why) {
      const double* const there = now_.at(plan_.column + exit.di_x, plan_.row + exit.di_y);
      return there ? first + there[exit.next_input * kLanes + static_cast<std::ptrdiff_t>(question)]
                   : first;
    }
    const bool here = q.cell == std::int64_t{plan_.row} * plan_.field.columns + plan_.column;
    return here && why == q.why ? 1.0 : first;
  }

  const Plan& plan_;
  const Sums& sums_;
  std::ptrdiff_t inputs_;
  PlaneBuffer zeros_;
  const double* nothing_;  // answers in cells that cannot be reached
  std::vector<Question> questions_{};
  Layer now_, next_;
};

AdjointPredictor::AdjointPredictor(const Chain& chain, const Field& field, int column, int row,
                                   int max_cells)
    : plan_(std::make_unique<const Plan>(
          Plan{Sums(chain), chain.exits(), field, column, row, max_cells - 1})) {
  if (max_cells < 1)
    throw std::invalid_argument("adjoint: needs a limit of cells, max_cells is " +
                                std::to_string(max_cells));
  validate(chain, field, {column, row, 0}, max_cells);
  std::vector<Question> questions{{}};
  const Sums& sums = plan_->sums;
  const auto is_near = [&](std::int64_t c, std::int64_t r) {  // enough to be reached
    const std::int64_t moves = max_cells - 1;
    return std::abs(c - column) <= sums.widest * moves && r - row >= sums.lowest * moves &&
           r - row <= sums.highest * moves;
  };
  const auto ask = [&](std::int64_t cell, Ending why) {
    questions.push_back({cell, why});
    ends_.push_back({cell, why});
  };
  for (std::int64_t r = 0; r < field.rows; ++r)
    for (std::int64_t c = 0; c < field.columns; ++c) {
      if (!is_near(c, r)) continue;
      const std::int64_t cell = r * field.columns + c;
      ask(cell, Ending::trapped);
      if (sums.has_unsampled) ask(cell, Ending::unsampled);
      const bool is_last = !sums.is_chequered || (c + r + column + row + max_cells - 1) % 2 == 0;
      if (is_last) ask(cell, Ending::cut_off);
      for (const Ending edge : kEdges)
        if (std::any_of(sums.moves.begin(), sums.moves.end(), [&](const Move& m) {
              return neighbour_cell(field, c, r, m.di_x, m.di_y) < 0 &&
                     edge_before(field, c + m.di_x, r + m.di_y) == edge;
            }))
          ask(cell, edge);
    }
  // Neighbours are asked for together: of them the same cells matter. (Every other row backwards.)
  std::vector<std::size_t> order(questions.size());
  std::iota(order.begin(), order.end(), 0);
  const auto block = [&](std::size_t q) {
    const std::int64_t c = questions[q].cell % field.columns, r = questions[q].cell / field.columns;
    return std::pair(r / 2, r / 2 % 2 == 0 ? c / 2 : -c / 2);
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return block(a) < block(b); });
  answers_.resize(chain.outputs(), std::ssize(questions));
  Backward backward(*plan_);
  for (std::size_t first = 0; first < order.size(); first += kLanes) {
    const std::size_t last = std::min<std::size_t>(order.size(), first + kLanes);
    std::vector<Question> some;
    for (std::size_t k = first; k < last; ++k) some.push_back(questions[order[k]]);
    backward.answer(some, [&](Eigen::Index output, std::size_t k) -> double& {
      return answers_(output, static_cast<Eigen::Index>(order[first + k]));
    });
  }
}

AdjointPredictor::~AdjointPredictor() = default;
AdjointPredictor::AdjointPredictor(AdjointPredictor&&) noexcept = default;
AdjointPredictor& AdjointPredictor::operator=(AdjointPredictor&&) noexcept = default;

FinalDistribution AdjointPredictor::predict(const std::vector<std::int64_t>& counts) const {
  if (std::ssize(counts) != answers_.rows())
    throw std::invalid_argument("adjoint: " + std::to_string(counts.size()) + " counts for " +
                                std::to_string(answers_.rows()) + " outputs");
  Eigen::ArrayXd answers = Eigen::ArrayXd::Zero(answers_.cols());
  std::int64_t sum = 0;
  for (std::size_t output = 0; output < counts.size(); ++output) {
    if (counts[output] == 0) continue;
    sum += counts[output];
    answers += static_cast<double>(counts[output]) *
               answers_.row(static_cast<Eigen::Index>(output)).transpose();
  }
  Ends ends(plan_->field);
  if (sum == 0)
    ends.add(Ending::unsampled, std::int64_t{plan_->row} * plan_->field.columns + plan_->column,
             1.0);
  else
    answers /= static_cast<double>(sum);
  for (std::size_t k = 0; k < ends_.size(); ++k)
    if (const double p = answers[static_cast<Eigen::Index>(k) + 1]; p > 0.0)
      ends.add(ends_[k].why, ends_[k].cell, p);
  FinalDistribution d = ends.result();
  d.mean_steps = answers[0];
  d.steps = plan_->last + 1;
  d.rounding = rounding_bound(d.mean_steps, plan_->sums.most_terms + 3,
                              d.steps + static_cast<double>(counts.size()) + 8);
  return d;
}

}  // namespace gatewalk::markov
