// SPDX-License-Identifier: MIT
#pragma once
/// Where bodies end that enter a field in any cells, after any number of cells visited, by the
/// field's chain.

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "dynamics/cells/state_space.h"
#include "lattice/field/field_params.h"
#include "markov/predict.h"

namespace gatewalk::lattice {

/// A body that enters cell `cell` of the field, and continues from there.
struct Entering {
  std::int64_t cell = 0;
  dynamics::Entry entry{};
  int gates = 0;  // number of gates visited before
};

/// Where bodies ended.
struct Walked {
  Eigen::VectorXd ends;                 // final gates, then endings
  double gates = 0.0, remainder = 0.0;  // gates visited, and bodies still walking, by weight
};
[[nodiscard]] markov::FinalDistribution distribution_of(const Walked& walked,
                                                        const FieldParams& field);

/// Carries many bodies at once until they end in the field. (markov::Predictor takes one start at a
/// time, with weight 1 and no cells visited.)
class FieldWalk {
 public:
  /// The arguments must outlive the object. Throws std::invalid_argument if cells times states are
  /// too many.
  FieldWalk(const FieldParams& field, const dynamics::StateSpace& space);

  [[nodiscard]] std::int64_t cells() const { return std::int64_t{field_.columns} * field_.rows; }
  [[nodiscard]] Eigen::VectorXd no_ends() const {
    return Eigen::VectorXd::Zero(cells() + static_cast<Eigen::Index>(markov::kEndings));
  }
  void end(Eigen::VectorXd& ends, std::int64_t cell, markov::Ending ending, double weight) const {
    ends[cell] += weight;
    ends[cells() + static_cast<Eigen::Index>(ending)] += weight;
  }

  /// Walks bodies with one weight each.
  [[nodiscard]] Walked walk(const markov::FieldChain& chain, const std::vector<Entering>& entering,
                            const std::vector<double>& weights) const;
  /// Walks bodies that all have the same weight.
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
