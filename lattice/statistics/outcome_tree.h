// SPDX-License-Identifier: MIT
#pragma once
/// Outcome probabilities where one polynomial is too smooth: the points are split in half along one
/// number, again and again, as long as two models fit better than one (model-based recursive
/// partitioning, Zeileis et al. 2008).

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "lattice/statistics/outcome_model.h"

namespace gatewalk::lattice {

struct OutcomeTreeOptions {
  int most_degree = 4;
  double most_parameters = 1200.0;  // per leaf; degree 1 may have more
  /// Parameters of a model that is split: larger models take too long.
  Eigen::Index most_divided = 150;
  double lack_of_fit = 0.0;  // nats per trial: a model with no more than this is not split
};

/// A tree of outcome models, one per leaf.
class OutcomeTree {
 public:
  using Coefficients = std::vector<OutcomeModel::Coefficients>;  // by leaf

  /// Fits the tree. Each leaf has the degree with the smallest criterion, and at least twice as
  /// many points as terms. Throws as OutcomeModel if no polynomial of degree 1 fits all points.
  OutcomeTree(const OutcomeCounts& seen, const OutcomeTreeOptions& options);

  [[nodiscard]] Eigen::Index leaves() const { return std::ssize(models_); }
  [[nodiscard]] int degree() const;                                  // the highest of all leaves
  [[nodiscard]] double lack_of_fit() const { return lack_of_fit_; }  // as OutcomeModel::lack_of_fit
  [[nodiscard]] Coefficients best() const;
  [[nodiscard]] Coefficients drawn(dynamics::Random& random) const;
  void log_chances(const Coefficients& coefficients, const Eigen::VectorXd& point,
                   Eigen::VectorXd& out) const;

 private:
  struct Node {
    Eigen::Index number = -1;  // -1: a leaf
    double between = 0.0;      // the first child has values up to here, the second the rest
    std::size_t first = 0, second = 0;
    std::size_t leaf = 0;
  };
  using Model = std::shared_ptr<const OutcomeModel>;
  std::size_t grow(const OutcomeCounts& seen, const Model& model, const Eigen::VectorXd& shares,
                   const OutcomeTreeOptions& options);

  std::vector<Node> nodes_;
  std::vector<Model> models_;  // by leaf
  double lack_of_fit_ = 0.0;
};

}  // namespace gatewalk::lattice
