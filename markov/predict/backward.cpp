// SPDX-License-Identifier: MIT
#include "markov/predict/backward.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "markov/predict/end_sums.h"

namespace gatewalk::markov {
namespace {

/// The columns of the shares of a draw's results: trapped, unsampled, drawn; then moved by the
/// first move, by the second, ...
enum Share : int { kTrappedShare, kUnsampledShare, kDrawn, kMovedShare };

}  // namespace

Backward::Sums::Sums(const Chain& chain) {
  const auto number_of = [&](const Exit& exit) {
    const auto known = std::find_if(moves.begin(), moves.end(), [&](const Move& m) {
      return m.di_x == exit.di_x && m.di_y == exit.di_y;
    });
    const auto number = static_cast<int>(known - moves.begin());
    if (known == moves.end()) moves.push_back({exit.di_x, exit.di_y});
    return number;
  };
  std::vector<int> move_of;  // by output
  for (const Exit& exit : chain.exits())
    move_of.push_back(exit.next_input == Exit::kTrapped ? 0 : number_of(exit));
  shares.resize(static_cast<std::size_t>(chain.inputs()) * static_cast<std::size_t>(shares_each()));
  for (int input = 0; input < chain.inputs(); ++input) {
    double* const own = shares.data() + static_cast<std::ptrdiff_t>(input) * shares_each();
    own[chain.is_sampled(input) ? kDrawn : kUnsampledShare] = 1.0;
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
    ends.push_back(static_cast<int>(terms.size()));
  }
  terms.insert(terms.end(), kTermsAhead, {0.0, 0, 0});  // for prefetching
}

int Backward::Sums::shares_each() const { return kMovedShare + static_cast<int>(moves.size()); }

Backward::Backward(const FieldChain& chain, const Field& field, int column, int row, int max_cells)
    : chain_(chain),
      field_(field),
      column_(column),
      row_(row),
      last_(max_cells - 1),
      inputs_(chain.inputs()),
      zeros_(1, inputs_ * kLanes),
      nothing_(zeros_.take(1).data()),
      now_(inputs_),
      next_(inputs_) {
  for (const Chain& c : chain.chains()) {
    const Sums& sums = sums_.emplace_back(c);
    has_unsampled_ = has_unsampled_ || c.unsampled_rows() > 0;
    for (std::size_t input = 0; input + 1 < sums.ends.size(); ++input)
      most_terms_ = std::max(most_terms_, sums.ends[input + 1] - sums.ends[input]);
    for (const Move& m : sums.moves) {
      widest_ = std::max(widest_, std::abs(m.di_x));
      lowest_ = std::min(lowest_, m.di_y);
      highest_ = std::max(highest_, m.di_y);
      is_chequered_ = is_chequered_ && (m.di_x + m.di_y) % 2 != 0;
    }
  }
}

Box Backward::reached(std::int64_t moves) const {
  return {std::max<std::int64_t>(0, column_ - widest_ * moves),
          std::min<std::int64_t>(field_.columns - 1, column_ + widest_ * moves),
          std::max<std::int64_t>(0, row_ + lowest_ * moves),
          std::min<std::int64_t>(field_.rows - 1, row_ + highest_ * moves)};
}

bool Backward::has_colour(std::int64_t column, std::int64_t row, std::int64_t moves) const {
  return !is_chequered_ || (column - column_ + row - row_ + moves) % 2 == 0;
}

Box Backward::window(std::int64_t moves) const {
  const Box w = reached(moves);
  const std::int64_t more = last_ - moves;
  Box from{w.right + 1, w.left - 1, w.top + 1, w.bottom - 1};
  for (const Question& q : questions_) {
    if (!q.cell) return w;
    const std::int64_t column = *q.cell % field_.columns, row = *q.cell / field_.columns;
    from = {std::min(from.left, column - widest_ * more),
            std::max(from.right, column + widest_ * more),
            std::min(from.bottom, row - highest_ * more), std::max(from.top, row - lowest_ * more)};
  }
  return {std::max(w.left, from.left), std::min(w.right, from.right),
          std::max(w.bottom, from.bottom), std::min(w.top, from.top)};
}

void Backward::look(Cell& cell, const AnswerLayer& next) const {
  for (const Move& m : moves(cell.column, cell.row)) {
    const double* const there = next.at(cell.column + m.di_x, cell.row + m.di_y);
    cell.from.push_back(there ? there : nothing_);
  }
}

void Backward::draw(std::span<const Cell> cells, bool is_last) const {
  const Sums& sums = sums_at(cells.front().column, cells.front().row);
  std::array<GatherCell, kMostGathered> gathered;
  for (std::size_t i = 0; i < cells.size(); ++i) gathered[i] = {cells[i].from.data(), cells[i].to};
  gather({sums.terms.data(), sums.ends.data(), static_cast<int>(inputs_)},
         std::span(gathered).first(cells.size()));
  for (const Cell& cell : cells) reward(cell, is_last);
}

void Backward::step(int moves) {
  std::swap(now_, next_);
  std::vector<std::vector<Cell>> cells(sums_.size());  // by type
  now_.cover(
      window(moves),
      [&](std::int64_t column, std::int64_t row) { return has_colour(column, row, moves); },
      [&](std::int64_t column, std::int64_t row, double* to) {
        auto& of_type = cells[static_cast<std::size_t>(chain_.type_of(column, row))];
        look(of_type.emplace_back(Cell{column, row, to, {}}), next_);
      });
  constexpr std::size_t kEach = kMostGathered;
  for (const std::span<const Cell> all : cells)
    tbb::parallel_for(std::size_t{0}, (all.size() + kEach - 1) / kEach, [&](std::size_t b) {
      draw(all.subspan(b * kEach).first(std::min(kEach, all.size() - b * kEach)), moves == last_);
    });
}

bool Backward::settle() {
  constexpr int kMostSweeps = 100'000;
  constexpr double kSettled = 1e-13;
  const std::ptrdiff_t numbers = inputs_ * kLanes;
  PlaneBuffer buffer(1, numbers);
  double* const renewed = buffer.take(1).data();
  std::vector<Cell> cells;
  std::vector<double*> answers;  // by cell
  const auto is_in = [](std::int64_t, std::int64_t) { return true; };
  now_.cover({0, field_.columns - 1, 0, field_.rows - 1}, is_in,
             [&](std::int64_t column, std::int64_t row, double* to) {
               std::fill_n(to, numbers, 0.0);
               answers.push_back(to);
               cells.push_back({column, row, renewed, {}});
             });
  for (Cell& cell : cells) look(cell, now_);
  // Row by row from the far edge; all rows together if moves lead to a row below.
  const std::size_t together =
      lowest_ < 0 ? cells.size() : static_cast<std::size_t>(field_.columns);
  for (std::size_t end = cells.size(); end > 0; end -= together) {
    double change = 1.0;
    for (int sweep = 0; change > kSettled; ++sweep) {
      if (sweep == kMostSweeps) return false;
      change = 0.0;
      for (std::size_t i = 0; i < together; ++i) {
        const std::size_t k = sweep % 2 == 0 ? end - 1 - i : end - together + i;
        draw(std::span(cells).subspan(k, 1), false);
        for (std::ptrdiff_t n = 0; n < numbers; ++n)
          change = std::max(change, std::abs(renewed[n] - answers[k][n]));
        std::copy_n(renewed, numbers, answers[k]);
      }
    }
  }
  return true;
}

void Backward::reward(const Cell& cell, bool is_last) const {
  const Sums& sums = sums_at(cell.column, cell.row);
  const auto add = [&](std::size_t question, int share) {
    for (std::ptrdiff_t input = 0; input < inputs_; ++input)
      cell.to[input * kLanes + static_cast<std::ptrdiff_t>(question)] +=
          sums.shares[static_cast<std::size_t>(input * sums.shares_each() + share)];
  };
  for (std::size_t k = 0; k < questions_.size(); ++k) {
    const Question& q = questions_[k];
    const auto is_asked = [&](std::optional<Ending> why) {
      return why && q.why.value_or(*why) == why;
    };
    if (!q.cell && !q.why) {
      add(k, kDrawn);
      continue;
    }
    if (q.cell.value_or(cell.row * field_.columns + cell.column) !=
        cell.row * field_.columns + cell.column)
      continue;
    if (is_asked(Ending::trapped)) add(k, kTrappedShare);
    if (is_asked(Ending::unsampled)) add(k, kUnsampledShare);
    for (std::size_t m = 0; m < sums.moves.size(); ++m)
      if (is_asked(ends_by(sums.moves[m], cell.column, cell.row, is_last)))
        add(k, kMovedShare + static_cast<int>(m));
  }
}

std::optional<Ending> Backward::ends_by(const Move& m, std::int64_t column, std::int64_t row,
                                        bool is_last) const {
  if (neighbour_cell(field_, column, row, m.di_x, m.di_y) < 0)
    return edge_before(field_, column + m.di_x, row + m.di_y);
  return is_last ? std::optional(Ending::cut_off) : std::nullopt;
}

double Backward::after(const Exit& exit, std::size_t question) const {
  const Question& q = questions_[question];
  const double first = !q.cell && !q.why ? 1.0 : 0.0;
  std::optional<Ending> why = Ending::trapped;
  if (exit.next_input != Exit::kTrapped)
    why = ends_by({exit.di_x, exit.di_y}, column_, row_, last_ == 0);
  if (!why) {
    const double* const there = now_.at(column_ + exit.di_x, row_ + exit.di_y);
    return there ? first + there[exit.next_input * kLanes + static_cast<std::ptrdiff_t>(question)]
                 : first;
  }
  if (first > 0.0) return first;
  const std::int64_t here = row_ * field_.columns + column_;
  return q.cell.value_or(here) == here && q.why.value_or(*why) == why ? 1.0 : 0.0;
}

}  // namespace gatewalk::markov
