#include "dynamics/tree_space.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>
#include <string>

namespace gatewalk::dynamics {
namespace {

using Entries = std::span<Crossing>;

auto less_along(std::size_t axis) {
  return [by = kCrossingAxes[axis]](const Crossing& a, const Crossing& b) { return a.*by < b.*by; };
}

/// Grows one tree, in preorder.
class Grower {
 public:
  Grower(const Scale& scale, std::size_t per_leaf)
      : unit_{scale.length, scale.speed(), scale.speed()}, per_leaf_(per_leaf) {}

  [[nodiscard]] Tree grow(Entries entries) {
    tree_ = {.nodes = {}, .seen = {}};
    for (std::size_t axis = 0; axis < kCrossingAxes.size(); ++axis) {
      const auto [low, high] =
          std::minmax_element(entries.begin(), entries.end(), less_along(axis));
      tree_.seen[axis][0] = (*low).*kCrossingAxes[axis];
      tree_.seen[axis][1] = (*high).*kCrossingAxes[axis];
    }
    add(entries);
    return std::move(tree_);
  }

 private:
  /// Axes by how far the entries spread along them, in the scene's own units, the most first.
  [[nodiscard]] std::array<std::size_t, 3> axes_by_spread(Entries entries) const {
    std::array<double, 3> squares{};
    for (std::size_t axis = 0; axis < squares.size(); ++axis) {
      double mean = 0.0;
      for (const Crossing& c : entries) mean += c.*kCrossingAxes[axis] / unit_[axis];
      mean /= static_cast<double>(entries.size());
      for (const Crossing& c : entries) {
        const double from_mean = c.*kCrossingAxes[axis] / unit_[axis] - mean;
        squares[axis] += from_mean * from_mean;
      }
    }
    std::array<std::size_t, 3> axes{0, 1, 2};
    std::stable_sort(axes.begin(), axes.end(),
                     [&](std::size_t a, std::size_t b) { return squares[a] > squares[b]; });
    return axes;
  }

  /// Puts entries below a cut near the median of an axis before those above it, and returns how
  /// many they are; 0 where equal values leave no cut with enough entries on both sides.
  [[nodiscard]] std::size_t halve(Entries entries, std::size_t axis) const {
    const auto middle = entries.begin() + std::ssize(entries) / 2;
    std::nth_element(entries.begin(), middle, entries.end(), less_along(axis));
    const double median = (*middle).*kCrossingAxes[axis];
    const auto equal = std::partition(entries.begin(), middle, [&](const Crossing& c) {
      return c.*kCrossingAxes[axis] < median;
    });
    const auto above = std::partition(
        middle, entries.end(), [&](const Crossing& c) { return c.*kCrossingAxes[axis] <= median; });
    const auto low = static_cast<std::size_t>(equal - entries.begin());
    const auto high = static_cast<std::size_t>(above - entries.begin());
    const std::size_t n = entries.size();
    const auto fits = [&](std::size_t below) {
      return below >= per_leaf_ && n - below >= per_leaf_;
    };
    const bool low_is_nearer = n / 2 - low <= high - n / 2;
    if (fits(low) && (low_is_nearer || !fits(high))) return low;
    return fits(high) ? high : 0;
  }

  void add(Entries entries) {
    if (entries.size() >= 2 * per_leaf_)
      for (const std::size_t axis : axes_by_spread(entries)) {
        const std::size_t below = halve(entries, axis);
        if (below == 0) continue;
        const Entries low = entries.first(below), high = entries.subspan(below);
        const double from = (*std::max_element(low.begin(), low.end(), less_along(axis))).*
                            kCrossingAxes[axis],
                     to = (*std::min_element(high.begin(), high.end(), less_along(axis))).*
                          kCrossingAxes[axis];
        const double cut = 0.5 * from + 0.5 * to;
        if (!(from < cut && cut < to)) continue;  // neighbours among the doubles
        tree_.nodes.push_back({static_cast<int>(axis), cut});
        add(low);
        add(high);
        return;
      }
    tree_.nodes.push_back({});
  }

  std::array<double, 3> unit_;
  std::size_t per_leaf_;
  Tree tree_;
};

}  // namespace

StateSpace tree_space(const GateParams& p, std::vector<Crossing> seen, int per_leaf,
                      std::vector<Crossing> points) {
  if (per_leaf < 1)
    throw std::invalid_argument("tree: " + std::to_string(per_leaf) +
                                " entries per leaf are not permitted: must be 1 or more");
  const StateSpace unseen = StateSpace::paper(p);
  std::stable_sort(seen.begin(), seen.end(),
                   [](const Crossing& a, const Crossing& b) { return a.boundary < b.boundary; });
  Grower grower(scale_of(p), static_cast<std::size_t>(per_leaf));
  std::array<Tree, kBoundaries> trees;
  auto first = seen.begin();
  for (int b = 0; b < kBoundaries; ++b) {
    const auto last = std::find_if(first, seen.end(), [&](const Crossing& c) {
      return c.boundary != static_cast<Boundary>(b);
    });
    const Bins& bins = unseen.bins()[b];
    if (first == last)
      trees[b].seen = {{{bins.d.front(), bins.d.back()},
                        {bins.vx.front(), bins.vx.back()},
                        {bins.vy.front(), bins.vy.back()}}};
    else
      trees[b] = grower.grow(Entries(first, last));
    first = last;
  }
  return StateSpace(std::move(trees), std::move(points));
}

}  // namespace gatewalk::dynamics
