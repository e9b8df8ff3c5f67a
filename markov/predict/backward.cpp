// SPDX-License-Identifier: MIT
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <stdexcept>
#include <string>

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

}  // namespace

/// The answer to a question, from the last step back to the first.
class AdjointPredictor::Backward {
 public:
  /// In the memory of `buffer`.
  Backward(const Plan& plan, const Question& question, PlaneBuffer& buffer)
      : plan_(plan),
        sums_(plan.sums),
        question_(question),
        box_(box()),
        layout_(box_.right - box_.left + 1 + 2 * std::int64_t{sums_.widest},
                box_.top - box_.bottom + 1, sums_.moves, sums_.is_chequered ? 2 : 1, {0}),
        colours_(layout_.colours()),
        inputs_(std::ssize(sums_.ends) - 1) {
    buffer.reset(2 * inputs_ + colours_, layout_.stride());
    mask_ = buffer.take(colours_);
    now_ = buffer.take(inputs_);
    next_ = buffer.take(inputs_);
    each_place(box_, [&](std::int64_t, std::int64_t, Layout::Place p) {
      mask_.data()[p.colour * layout_.stride() + p.at] = 1.0;
    });
  }

  /// Of walks that draw each output first.
  [[nodiscard]] Eigen::ArrayXd answer() {
    for (int moves = plan_.last; moves >= 1; --moves) step(moves);
    Eigen::ArrayXd by_output(std::ssize(plan_.exits));
    for (Eigen::Index output = 0; output < by_output.size(); ++output)
      by_output[output] = of_exit(plan_.exits[static_cast<std::size_t>(output)]);
    return by_output;
  }

 private:
  struct Window {
    std::int64_t left, right, bottom, top;
  };

  [[nodiscard]] Window reached(std::int64_t moves) const {
    return {std::max<std::int64_t>(0, plan_.column - sums_.widest * moves),
            std::min<std::int64_t>(plan_.field.columns - 1, plan_.column + sums_.widest * moves),
            std::max<std::int64_t>(0, plan_.row + sums_.lowest * moves),
            std::min<std::int64_t>(plan_.field.rows - 1, plan_.row + sums_.highest * moves)};
  }
  /// Cells that can be reached in so many moves and from which the cell asked for still can.
  [[nodiscard]] Window window(std::int64_t moves) const {
    const Window w = reached(moves);
    if (!question_.why) return w;
    const std::int64_t column = question_.cell % plan_.field.columns,
                       row = question_.cell / plan_.field.columns, more = plan_.last - moves;
    return {std::max(w.left, column - sums_.widest * more),
            std::min(w.right, column + sums_.widest * more),
            std::max(w.bottom, row - sums_.highest * more),
            std::min(w.top, row - sums_.lowest * more)};
  }
  /// All windows together.
  [[nodiscard]] Window box() const {
    Window all = window(0);
    for (int moves = 0; moves <= plan_.last; ++moves) {
      const Window w = window(moves);
      if (is_empty(w)) continue;
      if (is_empty(all)) all = w;
      all = {std::min(all.left, w.left), std::max(all.right, w.right),
             std::min(all.bottom, w.bottom), std::max(all.top, w.top)};
    }
    return is_empty(all) ? Window{0, 0, 0, 0} : all;
  }
  [[nodiscard]] static bool is_empty(const Window& w) {
    return w.left > w.right || w.bottom > w.top;
  }
  [[nodiscard]] Layout::Place place(std::int64_t column, std::int64_t row) const {
    return layout_.place(0, column - box_.left + sums_.widest, row - box_.bottom);
  }
  template <class Do>
  void each_place(const Window& w, Do act) const {
    for (std::int64_t row = w.bottom; row <= w.top; ++row)
      for (std::int64_t column = w.left; column <= w.right; ++column)
        act(column, row, place(column, row));
  }

  /// From the answers after one move more, those after so many. What lies outside a window is not
  /// always zero, but is never read from within.
  void step(int moves) {
    const Window w = window(moves);
    std::swap(now_, next_);
    if (is_empty(w)) return now_.clear();
    const int colour = (place(plan_.column, plan_.row).colour + moves) % colours_;
    std::vector<Range> ranges;
    layout_.cover(w.left - box_.left + sums_.widest, w.right - box_.left + sums_.widest,
                  w.bottom - box_.bottom, w.top - box_.bottom, ranges);
    gather({sums_.terms.data(), sums_.ends.data(), static_cast<int>(inputs_),
            layout_.shifts(colour), layout_.stride(), mask_.data() + colour * layout_.stride(),
            sums_.shares.data(), sums_.shares_each()},
           ranges, rewards(w, colour, moves == plan_.last), next_.data(), now_.data());
  }

  /// What one draw ends with in the cells of a colour.
  [[nodiscard]] std::vector<GatherReward> rewards(const Window& w, int colour, bool is_last) const {
    std::vector<GatherReward> all;
    each_place(w, [&](std::int64_t column, std::int64_t row, Layout::Place p) {
      if (p.colour != colour) return;
      if (!question_.why) all.push_back({p.at, kDrawn});
      if (!question_.why || row * plan_.field.columns + column != question_.cell) return;
      if (question_.why == Ending::trapped) all.push_back({p.at, kTrappedShare});
      if (question_.why == Ending::unsampled) all.push_back({p.at, kUnsampledShare});
      for (std::size_t m = 0; m < sums_.moves.size(); ++m)
        if (ends_by(sums_.moves[m], column, row, is_last) == question_.why)
          all.push_back({p.at, kMovedShare + static_cast<int>(m)});
    });
    return all;
  }
  [[nodiscard]] std::optional<Ending> ends_by(const Move& m, std::int64_t column, std::int64_t row,
                                              bool is_last) const {
    if (neighbour_cell(plan_.field, column, row, m.di_x, m.di_y) < 0)
      return edge_before(plan_.field, column + m.di_x, row + m.di_y);
    return is_last ? std::optional(Ending::cut_off) : std::nullopt;
  }

  [[nodiscard]] double of_exit(const Exit& exit) const {
    std::optional<Ending> why = Ending::trapped;
    if (exit.next_input != Exit::kTrapped)
      why = ends_by({exit.di_x, exit.di_y}, plan_.column, plan_.row, plan_.last == 0);
    const double first = question_.why ? 0.0 : 1.0;
    if (!why)
      return first + now_.data()[exit.next_input * layout_.stride() +
                                 place(plan_.column + exit.di_x, plan_.row + exit.di_y).at];
    const bool here =
        question_.cell == std::int64_t{plan_.row} * plan_.field.columns + plan_.column;
    return here && why == question_.why ? 1.0 : first;
  }

  const Plan& plan_;
  const Sums& sums_;
  Question question_;
  Window box_;
  Layout layout_;  // with columns beside the field, in which all is zero
  int colours_;
  std::ptrdiff_t inputs_;
  Planes mask_;        // (colours): 1 in cells of the field
  Planes now_, next_;  // by input: answers for walks about to draw in the cells of a colour
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
  answers_.resize(chain.outputs(), std::ssize(questions));
  tbb::enumerable_thread_specific<PlaneBuffer> buffers;
  tbb::parallel_for(std::size_t{0}, questions.size(), [&](std::size_t q) {
    answers_.col(static_cast<Eigen::Index>(q)) =
        Backward(*plan_, questions[q], buffers.local()).answer();
  });
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
