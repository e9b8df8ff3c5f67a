// SPDX-License-Identifier: MIT
#pragma once
/// Chances of several outcomes where one polynomial is too smooth: the points are halved along one
/// number, and the halves again, as long as models of the halves are better than one of both
/// (model-based recursive partitioning, Zeileis et al. 2008).

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "lattice/statistics/outcome_model.h"

namespace gatewalk::lattice {

struct OutcomeTreeOptions {
  int most_degree = 4;
  double most_parameters = 1200.0;  // of a leaf; degree 1 may have more
  Eigen::Index most_divided = 150;  // parameters of a model that is: more take too long
  double lack_of_fit = 0.0;         // nats a trial: a model that lacks no more is not divided
};

class OutcomeTree {
 public:
  using Coefficients = std::vector<OutcomeModel::Coefficients>;  // by leaf

  /// Each leaf has the degree of the least criterion, and at least twice as many points as terms.
  /// Throws as OutcomeModel where no polynomial of degree 1 is found for all points.
  OutcomeTree(const OutcomeCounts& seen, const OutcomeTreeOptions& options);

  [[nodiscard]] Eigen::Index leaves() const { return std::ssize(models_); }
  [[nodiscard]] int degree() const;                                  // the highest
  [[nodiscard]] double lack_of_fit() const { return lack_of_fit_; }  // as OutcomeModel's
  [[nodiscard]] Coefficients best() const;
  [[nodiscard]] Coefficients drawn(dynamics::Random& random) const;
  void log_chances(const Coefficients& coefficients, const Eigen::VectorXd& point,
                   Eigen::VectorXd& out) const;

 private:
  struct Node {
    Eigen::Index number = -1;  // -1: a leaf
    double between = 0.0;      // up to here the first child, beyond it the second
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
