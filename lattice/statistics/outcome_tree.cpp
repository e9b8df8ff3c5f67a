// SPDX-License-Identifier: MIT
#include "lattice/statistics/outcome_tree.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace gatewalk::lattice {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

using Model = std::shared_ptr<const OutcomeModel>;

/// The model of the degree with the smallest criterion; null if the points are too few.
Model best_model(const OutcomeCounts& seen, const VectorXd& shares,
                 const OutcomeTreeOptions& options) {
  Model best;
  for (int degree = 1; degree <= options.most_degree; ++degree) {
    const Index terms = OutcomeModel::terms(seen.points.cols(), degree);
    if (degree > 1 &&
        (2 * terms > seen.points.rows() ||
         static_cast<double>(terms * (seen.counts.cols() - 1)) > options.most_parameters))
      break;
    try {
      auto next = std::make_shared<const OutcomeModel>(seen, degree, shares);
      if (!best || next->criterion() < best->criterion()) best = std::move(next);
    } catch (const std::runtime_error&) {
      if (degree == 1) throw;
      break;
    }
  }
  return best;
}

/// The points on each side of the median of one number.
std::array<OutcomeCounts, 2> halves(const OutcomeCounts& seen, Index number, double* between) {
  std::vector<Index> order(static_cast<std::size_t>(seen.points.rows()));
  std::iota(order.begin(), order.end(), Index{0});
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) {
    return seen.points(a, number) < seen.points(b, number);
  });
  const auto middle = order.begin() + std::ssize(order) / 2;
  *between = 0.5 * (seen.points(*(middle - 1), number) + seen.points(*middle, number));
  const std::vector<Index> first(order.begin(), middle), second(middle, order.end());
  return {OutcomeCounts{seen.points(first, Eigen::all), seen.counts(first, Eigen::all)},
          OutcomeCounts{seen.points(second, Eigen::all), seen.counts(second, Eigen::all)}};
}

}  // namespace

OutcomeTree::OutcomeTree(const OutcomeCounts& seen, const OutcomeTreeOptions& options) {
  const VectorXd all = seen.counts.colwise().sum();
  const VectorXd shares = all / all.sum();
  grow(seen, best_model(seen, shares, options), shares, options);
  double chi_squared = 0.0, degrees_of_freedom = 0.0;
  for (const Model& model : models_) {
    chi_squared += model->chi_squared();
    degrees_of_freedom += model->degrees_of_freedom();
  }
  lack_of_fit_ = gatewalk::lattice::lack_of_fit(chi_squared, degrees_of_freedom, all.sum());
}

std::size_t OutcomeTree::grow(const OutcomeCounts& seen, const Model& model, const VectorXd& shares,
                              const OutcomeTreeOptions& options) {
  const std::size_t here = nodes_.size();
  nodes_.emplace_back();
  const Index numbers = seen.points.cols();
  struct Division {
    double criterion = 0.0;
    Node node;
    std::array<OutcomeCounts, 2> halves;
    std::array<Model, 2> models;
  } best{model->criterion(), {}, {}, {}};
  const bool may_divide = seen.points.rows() >= 4 * OutcomeModel::terms(numbers, 1) &&
                          model->parameters() <= options.most_divided &&
                          model->lack_of_fit() > options.lack_of_fit;
  for (Index number = 0; may_divide && number < numbers; ++number) try {
      Division next;
      next.node.number = number;
      next.halves = halves(seen, number, &next.node.between);
      for (const std::size_t half : {0U, 1U}) {
        next.models[half] = best_model(next.halves[half], shares, options);
        next.criterion += next.models[half]->criterion();
      }
      if (next.criterion < best.criterion) best = std::move(next);
    } catch (const std::exception&) {  // a half has no such model, so the node is not split
    }
  Node node = best.node;
  if (node.number < 0) {
    node.leaf = models_.size();
    models_.push_back(model);
  } else {
    node.first = grow(best.halves[0], best.models[0], shares, options);
    node.second = grow(best.halves[1], best.models[1], shares, options);
  }
  nodes_[here] = node;
  return here;
}

int OutcomeTree::degree() const {
  int most = 0;
  for (const Model& model : models_) most = std::max(most, model->degree());
  return most;
}

OutcomeTree::Coefficients OutcomeTree::best() const {
  Coefficients all;
  for (const Model& model : models_) all.push_back(model->best());
  return all;
}

OutcomeTree::Coefficients OutcomeTree::drawn(dynamics::Random& random) const {
  Coefficients all;
  for (const Model& model : models_) all.push_back(model->drawn(random));
  return all;
}

void OutcomeTree::log_chances(const Coefficients& coefficients, const VectorXd& point,
                              VectorXd& out) const {
  const Node* node = &nodes_.front();
  while (node->number >= 0)
    node = &nodes_[point[node->number] <= node->between ? node->first : node->second];
  models_[node->leaf]->log_chances(coefficients[node->leaf], point, out);
}

}  // namespace gatewalk::lattice
