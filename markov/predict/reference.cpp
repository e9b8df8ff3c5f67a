// SPDX-License-Identifier: MIT
#include <fmt/core.h>
#include <klu.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "markov/predict/ends.h"
#include "markov/predict/transient.h"

namespace gatewalk::markov {
namespace {

// The chain seen from one cell: outputs that lead to the same neighbour together, so that the edge
// of the field is looked at once per neighbour.
struct Link {
  int output;
  int input;
};
struct Neighbour {
  int di_x;
  int di_y;
  std::vector<Link> links;
};
struct Outputs {
  std::vector<Neighbour> neighbours;
  std::vector<int> trapped;
};

Outputs outputs_of(const Chain& chain) {
  Outputs outputs;
  for (int output = 0; output < chain.outputs(); ++output) {
    const Exit& exit = chain.exits()[static_cast<std::size_t>(output)];
    if (exit.next_input == Exit::kTrapped) {
      outputs.trapped.push_back(output);
      continue;
    }
    auto& all = outputs.neighbours;
    auto it = std::find_if(all.begin(), all.end(), [&](const Neighbour& n) {
      return n.di_x == exit.di_x && n.di_y == exit.di_y;
    });
    if (it == all.end()) it = all.insert(it, {exit.di_x, exit.di_y, {}});
    it->links.push_back({output, exit.next_input});
  }
  return outputs;
}

// Walking mass per (cell, input), and which cells hold any.
class Mass {
 public:
  Mass(const Field& field, int inputs)
      : inputs_(static_cast<std::size_t>(inputs)),
        mass_(static_cast<std::size_t>(field.columns) * field.rows * inputs_),
        is_active_(static_cast<std::size_t>(field.columns) * field.rows) {}

  [[nodiscard]] const std::vector<std::int64_t>& active() const { return active_; }
  [[nodiscard]] double* at(std::int64_t cell) {
    return mass_.data() + static_cast<std::size_t>(cell) * inputs_;
  }
  void activate(std::int64_t cell) {
    char& is_active = is_active_[static_cast<std::size_t>(cell)];
    if (!is_active) active_.push_back(cell);
    is_active = 1;
  }
  void clear() {
    for (const std::int64_t cell : active_) {
      std::fill_n(at(cell), inputs_, 0.0);
      is_active_[static_cast<std::size_t>(cell)] = 0;
    }
    active_.clear();
  }

 private:
  std::size_t inputs_;
  std::vector<double> mass_;  // (cells x n_in)
  std::vector<char> is_active_;
  std::vector<std::int64_t> active_;
};

static_assert(sizeof(SuiteSparse_long) == sizeof(std::int64_t));

// One factorisation by KLU, freed with the object.
class Klu {
 public:
  explicit Klu(Transient& t) : t_(t), n_(static_cast<SuiteSparse_long>(t.states.size())) {
    klu_l_defaults(&common_);
    symbolic_ = klu_l_analyze(n_, t_.begin.data(), t_.index.data(), &common_);
    if (symbolic_) {
      numeric_ =
          klu_l_factor(t_.begin.data(), t_.index.data(), t_.value.data(), symbolic_, &common_);
    }
    if (numeric_) {
      klu_l_condest(t_.begin.data(), t_.value.data(), symbolic_, numeric_, &common_);
    }
  }
  ~Klu() {
    klu_l_free_numeric(&numeric_, &common_);
    klu_l_free_symbolic(&symbolic_, &common_);
  }
  Klu(const Klu&) = delete;
  Klu& operator=(const Klu&) = delete;

  [[nodiscard]] int status() const { return static_cast<int>(common_.status); }
  [[nodiscard]] double condition() const { return common_.condest; }

  // x = A \ x
  [[nodiscard]] bool solve(std::vector<double>& x) {
    return klu_l_solve(symbolic_, numeric_, n_, 1, x.data(), &common_) != 0;
  }

 private:
  Transient& t_;
  SuiteSparse_long n_;
  klu_l_common common_{};
  klu_l_symbolic* symbolic_ = nullptr;
  klu_l_numeric* numeric_ = nullptr;
};

// Mean number of draws made in each transient state.
std::vector<double> visits(Transient& t) {
  constexpr double kWorstCondition = 1e-6 / std::numeric_limits<double>::epsilon();
  Klu klu(t);
  if (klu.status() == KLU_OUT_OF_MEMORY || klu.status() == KLU_TOO_LARGE) {
    throw std::runtime_error("absorption: no memory to factor I - Q of " +
                             std::to_string(t.states.size()) + " states; propagate instead");
  }
  if (klu.status() == KLU_SINGULAR) {
    throw std::runtime_error(
        "absorption: I - Q is singular: from the start a walk can get into a "
        "closed loop and never end");
  }
  if (klu.status() != KLU_OK) {
    throw std::runtime_error("absorption: KLU fails with status " + std::to_string(klu.status()));
  }
  if (!(klu.condition() <= kWorstCondition)) {
    throw std::runtime_error(
        fmt::format("absorption: I - Q is singular or nearly so (condition about {:.6g}): a walk "
                    "can circle (almost) for ever, fewer than 6 digits hold",
                    klu.condition()));
  }
  std::vector<double> x(t.states.size(), 0.0);
  x.front() = 1.0;
  if (!klu.solve(x)) throw std::runtime_error("absorption: KLU cannot solve");
  return x;
}

// start - (I - Q)^T draws, in magnitude: what the draws do not account for and would walk on.
double missing(const Transient& t, const std::vector<double>& draws) {
  std::vector<double> left(draws.size(), 0.0);
  left.front() = 1.0;
  for (std::size_t s = 0; s < draws.size(); ++s)
    for (auto k = static_cast<std::size_t>(t.begin[s]);
         k < static_cast<std::size_t>(t.begin[s + 1]); ++k)
      left[static_cast<std::size_t>(t.index[k])] -= t.value[k] * draws[s];
  CompensatedSum sum;
  for (const double mass : left) sum += std::abs(mass);
  return sum.value();
}

}  // namespace

CellProbabilities trapped_cells(const FinalDistribution& d) {
  CellProbabilities cells = d.final_cells;
  for (const CellEndings& c : d.mixed_cells)
    cells.data()[c.cell] = c.by_ending[static_cast<std::size_t>(Ending::trapped)];
  return cells;
}

CellProbabilities departed_cells(const FinalDistribution& d) {
  CellProbabilities cells = CellProbabilities::Zero(d.final_cells.rows(), d.final_cells.cols());
  for (const CellEndings& c : d.mixed_cells)
    for (const Ending edge : kEdges)
      cells.data()[c.cell] += c.by_ending[static_cast<std::size_t>(edge)];
  return cells;
}

FinalDistribution propagate(const FieldChain& field_chain, const Field& field, const Start& start,
                            const PredictOptions& options) {
  const int max_cells = options.max_cells;
  const double tolerance = options.tolerance_of(PredictOptions::Solver::plain);
  validate(field_chain, field, start, max_cells);
  if (!(tolerance >= 0.0) || options.max_steps < 0) {
    throw std::invalid_argument("propagate: tolerance and step limit must not be negative");
  }
  const int n_in = field_chain.inputs();
  int n_out = 0;
  std::vector<Outputs> outputs_of_type;
  for (const Chain& chain : field_chain.chains()) {
    outputs_of_type.push_back(outputs_of(chain));
    n_out = std::max(n_out, chain.outputs());
  }

  Ends ends(field);
  Mass now(field, n_in);
  Mass next(field, n_in);
  std::vector<double> out(static_cast<std::size_t>(n_out));  // mass per output of a cell
  CompensatedSum draws;

  double walking = 1.0;
  const std::int64_t start_cell = std::int64_t{start.row} * field.columns + start.column;
  if (field_chain.at(start.column, start.row).is_sampled(start.input)) {
    now.activate(start_cell);
    now.at(start_cell)[start.input] = walking;
  } else {
    ends.add(Ending::unsampled, start_cell, walking);
    walking = 0.0;
  }

  int steps = 0;
  while (max_cells > 0 ? steps < max_cells && walking > 0.0
                       : steps < options.max_steps && walking > tolerance) {
    ++steps;
    draws += walking;
    const bool is_last = steps == max_cells;
    CompensatedSum walks_on;
    for (const std::int64_t cell : now.active()) {
      const std::int64_t column = cell % field.columns, row = cell / field.columns;
      const Probabilities& p = field_chain.at(column, row).matrix();
      const Outputs& of_cell =
          outputs_of_type[static_cast<std::size_t>(field_chain.type_of(column, row))];
      std::fill(out.begin(), out.end(), 0.0);
      const double* const mass = now.at(cell);
      for (int input = 0; input < n_in; ++input) {  // out = mass P, Eq. (16)
        if (mass[input] == 0.0) continue;
        for (Probabilities::InnerIterator it(p, input); it; ++it)
          out[static_cast<std::size_t>(it.col())] += mass[input] * it.value();
      }
      const auto mass_of = [&out](int o) { return out[static_cast<std::size_t>(o)]; };

      double trapped = 0.0;
      for (const int o : of_cell.trapped) trapped += mass_of(o);
      ends.add(Ending::trapped, cell, trapped);

      for (const Neighbour& n : of_cell.neighbours) {
        double moves = 0.0;
        for (const Link& link : n.links) moves += mass_of(link.output);
        if (moves == 0.0) continue;
        const std::int64_t target = neighbour_cell(field, column, row, n.di_x, n.di_y);
        if (target < 0) {
          ends.depart(cell, column + n.di_x, row + n.di_y, moves);
        } else if (is_last) {
          ends.add(Ending::cut_off, cell, moves);
        } else {
          const Chain& there = field_chain.at(target % field.columns, target / field.columns);
          double* const entering = next.at(target);
          for (const Link& link : n.links) {
            const double m = mass_of(link.output);
            if (m == 0.0) continue;
            if (there.is_sampled(link.input)) {
              next.activate(target);
              entering[link.input] += m;
              walks_on += m;
            } else {
              ends.add(Ending::unsampled, target, m);
            }
          }
        }
      }
    }
    now.clear();
    std::swap(now, next);
    walking = walks_on.value();
  }

  FinalDistribution result = ends.result();
  result.remainder = walking;
  result.mean_steps = draws.value();
  result.rounding = rounding_bound(result.mean_steps, n_in + n_out + 2, n_in + n_out + 8);
  result.steps = steps;
  return result;
}

FinalDistribution solve_absorption(const FieldChain& field_chain, const Field& field,
                                   const Start& start) {
  validate(field_chain, field, start, 0);
  if (!field_chain.at(start.column, start.row).is_sampled(start.input)) {
    Ends ends(field);
    ends.add(Ending::unsampled, std::int64_t{start.row} * field.columns + start.column, 1.0);
    return ends.result();
  }
  Transient t(field_chain, field, start);
  const std::vector<double> draws = visits(t);

  FinalDistribution result = t.ended(draws, field_chain, field);
  result.remainder = missing(t, draws);
  int n_out = 0;
  for (const Chain& chain : field_chain.chains()) n_out = std::max(n_out, chain.outputs());
  result.rounding = rounding_bound(
      result.mean_steps, 2.0 * static_cast<double>(field_chain.inputs() + n_out + 4), n_out + 8);
  // A condition estimate does not see a closed loop of one state.
  const double total = result.trapped + result.left_field + result.unsampled + result.remainder;
  if (!(std::abs(total - 1.0) <= 1e-6) || !(result.rounding >= 0.0))
    throw std::runtime_error(
        "absorption: I - Q is singular or nearly so: a walk can circle (almost) for ever, "
        "fewer than 6 digits hold");
  return result;
}

}  // namespace gatewalk::markov
