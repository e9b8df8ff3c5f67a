// SPDX-License-Identifier: MIT
#pragma once
/// Where many bodies end together that enter a field anywhere, at any number of cells visited, by
/// the field's chain.

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "dynamics/cells/state_space.h"
#include "lattice/field/field_params.h"
#include "markov/predict.h"

namespace gatewalk::lattice {

/// A body that is about to walk from here, in the field's cell `cell`.
struct Entering {
  std::int64_t cell = 0;
  dynamics::Entry entry{};
  int gates = 0;  // visited before
};

/// Where bodies ended.
struct Walked {
  Eigen::VectorXd ends;                 // final gates, then endings
  double gates = 0.0, remainder = 0.0;  // visited; left walking
};
[[nodiscard]] markov::FinalDistribution distribution_of(const Walked& walked,
                                                        const FieldParams& field);

/// Carries all bodies at once until they end in the field. markov::Predictor has one start at a
/// time, whose weight is 1 and which has visited no cell.
class FieldWalk {
 public:
  /// What is given outlives it. Throws std::invalid_argument where cells times states are too many.
  FieldWalk(const FieldParams& field, const dynamics::StateSpace& space);

  [[nodiscard]] std::int64_t cells() const { return std::int64_t{field_.columns} * field_.rows; }
  [[nodiscard]] Eigen::VectorXd no_ends() const {
    return Eigen::VectorXd::Zero(cells() + static_cast<Eigen::Index>(markov::kEndings));
  }
  void end(Eigen::VectorXd& ends, std::int64_t cell, markov::Ending ending, double weight) const {
    ends[cell] += weight;
    ends[cells() + static_cast<Eigen::Index>(ending)] += weight;
  }

  /// `weights`: of each body.
  [[nodiscard]] Walked walk(const markov::FieldChain& chain, const std::vector<Entering>& entering,
                            const std::vector<double>& weights) const;
  /// All with the same weight.
  [[nodiscard]] Walked walk(const markov::FieldChain& chain, const std::vector<Entering>& entering,
                            double weight) const {
    return walk(chain, entering, std::vector<double>(entering.size(), weight));
  }

 private:
  void draw(const markov::FieldChain& chain, std::int64_t cell, int step,
            const std::vector<double>& here, std::vector<double>& next, Walked& walked) const;

  const FieldParams& field_;
  const dynamics::StateSpace& space_;
};

}  // namespace gatewalk::lattice
