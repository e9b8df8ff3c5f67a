// SPDX-License-Identifier: MIT
#include <algorithm>
#include <stdexcept>
#include <string>

#include "markov/predict/backward.h"
#include "markov/predict/end_sums.h"
#include "markov/solvers.h"

namespace gatewalk::markov {
namespace {

void require_limit(int max_cells) {
  if (max_cells < 1)
    throw std::invalid_argument("adjoint: needs a limit of cells, max_cells is " +
                                std::to_string(max_cells));
}

/// (outputs x questions) The answers of walks whose first draw gives this output.
EndTable answers_after(const Chain& chain, Backward& backward,
                       const std::vector<Question>& questions) {
  EndTable answers(chain.outputs(), std::ssize(questions));
  backward.ask(questions, [&](std::span<const std::size_t> numbers) {
    for (int moves = backward.last_move(); moves >= 1; --moves) backward.step(moves);
    for (Eigen::Index output = 0; output < answers.rows(); ++output)
      for (std::size_t k = 0; k < numbers.size(); ++k)
        answers(output, static_cast<Eigen::Index>(numbers[k])) =
            backward.after(chain.exits()[static_cast<std::size_t>(output)], k);
  });
  return answers;
}

}  // namespace

EndTable ending_chances(const Chain& chain, const Field& field, int column, int row,
                        int max_cells) {
  require_limit(max_cells);
  validate(chain, field, {column, row, 0}, max_cells);
  const FieldChain everywhere(chain);
  Backward backward(everywhere, field, column, row, max_cells);
  std::vector<Question> questions;
  for (std::size_t e = 0; e < kEndings; ++e) questions.push_back({.why = static_cast<Ending>(e)});
  return answers_after(chain, backward, questions);
}

AdjointPredictor::AdjointPredictor(const Chain& chain, const Field& field, int column, int row,
                                   int max_cells)
    : field_(field), start_{column, row, 0}, max_cells_(max_cells) {
  require_limit(max_cells);
  validate(chain, field, start_, max_cells);
  const FieldChain everywhere(chain);
  Backward backward(everywhere, field, column, row, max_cells);
  most_terms_ = backward.most_terms();
  std::vector<Question> questions{{}};
  const auto ask = [&](std::int64_t cell, Ending why) {
    questions.push_back({cell, why});
    ends_.push_back({cell, why});
  };
  const Box near = backward.reached(backward.last_move());
  for (std::int64_t r = near.bottom; r <= near.top; ++r)
    for (std::int64_t c = near.left; c <= near.right; ++c) {
      const std::int64_t cell = r * field.columns + c;
      const std::vector<Move>& moves = backward.moves(c, r);
      ask(cell, Ending::trapped);
      if (backward.has_unsampled()) ask(cell, Ending::unsampled);
      if (backward.has_colour(c, r, backward.last_move())) ask(cell, Ending::cut_off);
      for (const Ending edge : kEdges)
        if (std::any_of(moves.begin(), moves.end(), [&](const Move& m) {
              return neighbour_cell(field, c, r, m.di_x, m.di_y) < 0 &&
                     edge_before(field, c + m.di_x, r + m.di_y) == edge;
            }))
          ask(cell, edge);
    }
  answers_ = answers_after(chain, backward, questions);
}

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
  EndSums ends(field_);
  if (sum == 0)
    ends.add(Ending::unsampled, std::int64_t{start_.row} * field_.columns + start_.column, 1.0);
  else
    answers /= static_cast<double>(sum);
  for (std::size_t k = 0; k < ends_.size(); ++k)
    if (const double p = answers[static_cast<Eigen::Index>(k) + 1]; p > 0.0)
      ends.add(ends_[k].why, ends_[k].cell, p);
  FinalDistribution d = ends.result();
  d.mean_steps = answers[0];
  d.steps = max_cells_;
  d.rounding = rounding_bound(d.mean_steps, most_terms_ + 3,
                              d.steps + static_cast<double>(counts.size()) + 8);
  return d;
}

}  // namespace gatewalk::markov
