// SPDX-License-Identifier: MIT
#include "diffusion.h"

#include <tbb/parallel_for.h>

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseLU>
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "lattice/field/gate_chain.h"
#include "lattice/pool/kernel.h"
#include "lattice/statistics/group_spread.h"

namespace lorentz {

using namespace dynamics;
using namespace gatewalk::lattice;
using markov::Chain;
using markov::Exit;
using markov::Probabilities;
using markov::Reward;

namespace {

using Columns = Eigen::SparseMatrix<double>;

/// All states from which `to` can be reached, `to` too, are marked.
void mark_those_before(const Columns& moves, int to, std::vector<char>& marked) {
  std::vector<int> open{to};
  marked[static_cast<std::size_t>(to)] = 1;
  while (!open.empty()) {
    const int state = open.back();
    open.pop_back();
    for (Columns::InnerIterator it(moves, state); it; ++it) {
      char& mark = marked[static_cast<std::size_t>(it.row())];
      if (mark != 0) continue;
      mark = 1;
      open.push_back(static_cast<int>(it.row()));
    }
  }
}

/// A state that can be reached from all. If there is one, it is the last that those before it do
/// not lead to.
int state_of_all(const Columns& moves) {
  const auto n = static_cast<std::size_t>(moves.cols());
  std::vector<char> marked(n, 0);
  int last = 0;
  for (int state = 0; state < moves.cols(); ++state)
    if (marked[static_cast<std::size_t>(state)] == 0)
      mark_those_before(moves, last = state, marked);
  marked.assign(n, 0);
  mark_those_before(moves, last, marked);
  for (std::size_t state = 0; state < n; ++state)
    if (marked[state] == 0)
      throw std::invalid_argument(
          "diffusion: it depends on the start where walks stay: from state " +
          std::to_string(state) + " (counted from 0) none gets to " + std::to_string(last));
  return last;
}

/// From state (row) to state (column).
Columns moves_of(const Chain& chain) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int input = 0; input < chain.inputs(); ++input) {
    const auto refuse = [&](const char* what) {
      throw std::invalid_argument("diffusion: state " + std::to_string(input) +
                                  " (counted from 0) " + what);
    };
    if (!chain.is_sampled(input)) refuse("was never sampled");
    for (Probabilities::InnerIterator it(chain.matrix(), input); it; ++it) {
      const Exit& exit = chain.exits()[static_cast<std::size_t>(it.col())];
      if (exit.next_input == Exit::kTrapped)
        refuse("traps walks: in the long run nobody is on the way");
      entries.emplace_back(input, exit.next_input, it.value());
    }
  }
  Columns moves(chain.inputs(), chain.inputs());
  moves.setFromTriplets(entries.begin(), entries.end());
  return moves;
}

/// Some x with a x = b for a singular matrix and right-hand sides in its range, to 9 digits of
/// `size`, that of the numbers behind b: by iteration, which stays in the range, or else by
/// elimination with x = 0 in state `zero`.
Eigen::MatrixXd solve(const Columns& a, const Eigen::MatrixXd& b, double size, int zero) {
  constexpr double kTolerance = 1e-12, kWorst = 1e-9;
  constexpr int kMostIterations = 2000, kMostEliminated = 20'000;
  const double all = size * std::sqrt(static_cast<double>(b.rows()));
  const auto is_good = [&](const Eigen::MatrixXd& x) {
    return (a * x - b).colwise().norm().maxCoeff() <= kWorst * all;
  };
  Eigen::MatrixXd x(b.rows(), b.cols());
  Eigen::BiCGSTAB<Columns> iteration(a);
  iteration.setMaxIterations(kMostIterations);
  for (Eigen::Index k = 0; k < b.cols(); ++k) {
    iteration.setTolerance(kTolerance * all / b.col(k).norm());
    x.col(k) = iteration.solve(b.col(k));
  }
  if (is_good(x)) return x;
  if (a.cols() <= kMostEliminated) {
    Columns grounded = a;
    grounded.prune([&](Eigen::Index row, Eigen::Index column, double) {
      return row != zero && column != zero;
    });
    grounded.coeffRef(zero, zero) = 1.0;
    Eigen::MatrixXd others = b;
    others.row(zero).setZero();
    Eigen::SparseLU<Columns> elimination(grounded);
    x = elimination.solve(others);
    if (elimination.info() == Eigen::Success && is_good(x)) return x;
  }
  throw std::runtime_error("diffusion: the linear solve does not settle, walks forget too slowly");
}

}  // namespace

Diffusion diffusion(const Chain& chain, const Eigen::Matrix2d& lattice, const Reward& time) {
  const Probabilities& p = chain.matrix();
  const bool timed = !time.mean.empty();
  if (timed && (std::ssize(time.mean) != p.nonZeros() || time.square.size() != time.mean.size()))
    throw std::invalid_argument("diffusion: a time for each of the chain's " +
                                std::to_string(p.nonZeros()) + " nonzeros is needed, not " +
                                std::to_string(time.mean.size()));
  const int n = chain.inputs();
  const Columns moves = moves_of(chain);
  const int zero = state_of_all(moves);
  Columns eye(n, n);
  eye.setIdentity();
  const Columns a = eye - moves;

  // The left null vector: where draws are made, from equal shares and what is missing of them.
  Eigen::VectorXd states = Eigen::VectorXd::Constant(n, 1.0 / n);
  const Columns transposed = a.transpose();
  states -= solve(transposed, transposed * states, 1.0 / n, zero);
  states = states.cwiseMax(0.0).eval();
  states /= states.sum();

  // Calls use(state, chance to make this draw there, its move, number of the nonzero, next state).
  const auto each_draw = [&](auto use) {
    for (int state = 0; state < n; ++state)
      for (Probabilities::InnerIterator it(p, state); it; ++it) {
        const Exit& exit = chain.exits()[static_cast<std::size_t>(it.col())];
        use(state, it.value(), lattice * Eigen::Vector2d(exit.di_x, exit.di_y),
            static_cast<std::size_t>(&it.value() - p.valuePtr()), exit.next_input);
      }
  };
  Diffusion out;
  Eigen::Vector2d mean_move = Eigen::Vector2d::Zero();
  double mean_time = 0.0, square = 0.0;
  each_draw([&](int state, double chance, const Eigen::Vector2d& move, std::size_t k, int) {
    mean_move += states[state] * chance * move;
    square += states[state] * chance * move.squaredNorm();
    mean_time += states[state] * chance * (timed ? time.mean[k] : 1.0);
  });
  if (!(mean_time > 0.0 && std::isfinite(mean_time)))
    throw std::invalid_argument("diffusion: the mean time of a draw must be finite and > 0");
  out.mean_time = mean_time;
  out.drift = mean_move / mean_time;
  const auto flow = [&](const Eigen::Vector2d& move, std::size_t k) -> Eigen::Vector2d {
    return move - out.drift * (timed ? time.mean[k] : 1.0);
  };

  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(n, 2);  // of a draw's flow, by state
  each_draw([&](int state, double chance, const Eigen::Vector2d& move, std::size_t k, int) {
    expected.row(state) += chance * flow(move, k).transpose();
  });
  const Eigen::MatrixXd h = solve(a, expected, std::sqrt(square), zero);
  double spread = 0.0;  // of times about the means of their nonzeros
  each_draw([&](int state, double chance, const Eigen::Vector2d& move, std::size_t k, int next) {
    const Eigen::Vector2d m = flow(move, k) + (h.row(next) - h.row(state)).transpose();
    out.tensor += states[state] * chance * m * m.transpose();
    if (timed) spread += states[state] * chance * (time.square[k] - time.mean[k] * time.mean[k]);
  });
  out.tensor += std::max(0.0, spread) * out.drift * out.drift.transpose();
  out.tensor /= 2.0 * mean_time;
  out.states.assign(states.data(), states.data() + n);
  return out;
}

RangeRuns endless_trials(const Cell& cell, const std::function<Entry(Random&)>& start,
                         std::int64_t trials, int passages, std::uint64_t seed, Health& health) {
  if (trials < 1 || passages < 1)
    throw std::invalid_argument("endless trials: trials and passages must be > 0, not " +
                                std::to_string(trials) + " and " + std::to_string(passages));
  RangeRuns all;
  all.starts.resize(static_cast<std::size_t>(trials));
  std::vector<PassageTable> runs(all.starts.size(), PassageTable(cell.section()));
  carry_out_trials(
      cell, trials,
      [&](Body& body) {
        const auto i = static_cast<std::size_t>(body.trial);
        body.random = Random(Purpose::field, {seed, 0, static_cast<std::uint64_t>(body.trial)});
        body.entry = all.starts[i] = start(body.random);
        cell.begin(body);
      },
      [&](Body& body, const Passage& passage) {
        auto& own = runs[static_cast<std::size_t>(body.trial)];
        own.push_back({passage.fate, 0, passage.next, passage.costs});
        return passage.fate == Fate::left && static_cast<int>(own.size()) < passages;
      },
      health);
  all.each.passages.begin(cell.section());
  for (const auto& own : runs) {
    all.each.passages.append(own);
    all.each.passed.push_back(std::ssize(all.each.passages));
  }
  return all;
}

TreeDiffusion tree_diffusion(const CellMap& map, const RunPool& pool,
                             const Eigen::Matrix2d& lattice, int per_leaf, TrialGroup group) {
  if (map.types.size() != 1)
    throw std::invalid_argument("diffusion: cells of several types are not permitted");
  Kernel kernel = kernel_of(map, pool, per_leaf, group);
  const markov::Counts& counts = kernel.counts.front();
  markov::Reward time;
  if (!map.section.costs.empty()) {
    const auto sums = cost_sums(kernel, map, pool, group);
    for (Eigen::Index k = 0; k < counts.nonZeros(); ++k) {
      const auto runs = static_cast<double>(counts.valuePtr()[k]);
      const CostSums& took = sums.front()[static_cast<std::size_t>(k)];
      time.mean.push_back(took.sum[0] / runs);
      time.square.push_back(took.squares[0] / runs);
    }
  }
  const markov::Chain chain = markov::Chain::from_counts(counts, exits_of(kernel.space));
  return {std::move(kernel.space), diffusion(chain, lattice, time)};
}

PooledDiffusion pooled_diffusion(const CellMap& map, const RunPool& pool,
                                 const Eigen::Matrix2d& lattice, int per_leaf) {
  std::array<std::optional<TreeDiffusion>, kTrialGroups> parts;
  tbb::parallel_for(0, kTrialGroups, [&](int g) {
    parts[static_cast<std::size_t>(g)] =
        tree_diffusion(map, pool, lattice, per_leaf, {g, kTrialGroups});
  });
  PooledDiffusion all{tree_diffusion(map, pool, lattice, per_leaf), {}, {}};
  std::vector<double> coefficients;
  for (auto& part : parts) {
    coefficients.push_back(part->walk.coefficient());
    all.groups.push_back(std::move(*part));
  }
  all.coefficient = mean_95(all.whole.walk.coefficient(), coefficients);
  return all;
}

}  // namespace lorentz
