// SPDX-License-Identifier: MIT
#include "dynamics/cells/tree_space.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

namespace gatewalk::dynamics {
namespace {

/// Grows trees of entries with N coordinates, in preorder.
template <std::size_t N>
class Grower {
 public:
  /// An entry with its index among all entries. Sorting moves many of them, so the type is small.
  struct Seen {
    std::array<double, N> at;
    int place;
  };
  using Entries = std::span<Seen>;

  Grower(const Section& section, std::size_t per_leaf, std::vector<int>& state_of)
      : section_(section), per_leaf_(per_leaf), state_of_(state_of) {
    for (std::size_t axis = 0; axis < N; ++axis)
      per_unit_[axis] = 1.0 / section.coordinates[axis].scale;
  }

  [[nodiscard]] Tree grow(Entries entries) {
    tree_ = {.nodes = {}, .seen = {}};
    for (std::size_t axis = 0; axis < N; ++axis) {
      const auto [low, high] =
          std::minmax_element(entries.begin(), entries.end(), less_along(axis));
      tree_.seen[axis][0] = low->at[axis];
      tree_.seen[axis][1] = high->at[axis];
    }
    add(entries);
    return std::move(tree_);
  }
  /// A tree of a single state, for a face without observed entries.
  [[nodiscard]] Tree unseen(const Face& face) {
    ++states_;
    return {.nodes = {Tree::Node{}}, .seen = usual_at(section_, face)};
  }

 private:
  static auto less_along(std::size_t axis) {
    return [axis](const Seen& a, const Seen& b) { return a.at[axis] < b.at[axis]; };
  }

  /// The axes in order of the entries' spread along them, in units of the scales, largest first.
  [[nodiscard]] std::array<std::size_t, N> axes_by_spread(Entries entries) const {
    const auto n = static_cast<double>(entries.size());
    const std::array<double, N> origin = entries.front().at;
    std::array<double, N> sum{}, squares{};
    for (const Seen& e : entries)
      for (std::size_t axis = 0; axis < N; ++axis) {
        const double x = e.at[axis] - origin[axis];
        sum[axis] += x;
        squares[axis] += x * x;
      }
    std::array<double, N> variance{};
    for (std::size_t axis = 0; axis < N; ++axis)
      variance[axis] =
          (squares[axis] - sum[axis] * sum[axis] / n) * per_unit_[axis] * per_unit_[axis];
    std::array<std::size_t, N> axes;
    std::iota(axes.begin(), axes.end(), std::size_t{0});
    std::stable_sort(axes.begin(), axes.end(),
                     [&](std::size_t a, std::size_t b) { return variance[a] > variance[b]; });
    return axes;
  }

  struct Halves {
    std::size_t below = 0;        // number of entries below the cut; 0: there is no cut
    double from = 0.0, to = 0.0;  // largest value below, least value above
  };

  /// Partitions the entries at a cut near the median of an axis. There is no cut if equal values
  /// leave none with enough entries on both sides.
  [[nodiscard]] Halves halve(Entries entries, std::size_t axis) const {
    const std::size_t n = entries.size();
    const auto middle = entries.begin() + static_cast<std::ptrdiff_t>(n / 2);
    std::nth_element(entries.begin(), middle, entries.end(), less_along(axis));
    const double median = middle->at[axis];
    const auto largest = [&](auto end) {
      return std::max_element(entries.begin(), end, less_along(axis))->at[axis];
    };
    if (const double from = largest(middle); from < median) return {n / 2, from, median};
    // Entries at the median lie from `equal` to `above`.
    const auto equal =
        std::partition(entries.begin(), middle, [&](const Seen& e) { return e.at[axis] < median; });
    const auto above =
        std::partition(middle, entries.end(), [&](const Seen& e) { return e.at[axis] <= median; });
    const auto low = static_cast<std::size_t>(equal - entries.begin());
    const auto high = static_cast<std::size_t>(above - entries.begin());
    const auto fits = [&](std::size_t below) {
      return below >= per_leaf_ && n - below >= per_leaf_;
    };
    const bool low_is_nearer = n / 2 - low <= high - n / 2;
    if (fits(low) && (low_is_nearer || !fits(high))) return {low, largest(equal), median};
    if (!fits(high)) return {};
    return {high, median, std::min_element(above, entries.end(), less_along(axis))->at[axis]};
  }

  void add(Entries entries) {
    if (entries.size() >= 2 * per_leaf_)
      for (const std::size_t axis : axes_by_spread(entries)) {
        const auto [below, from, to] = halve(entries, axis);
        const double cut = 0.5 * from + 0.5 * to;
        // There is also no cut between adjacent doubles.
        if (below == 0 || !(from < cut && cut < to)) continue;
        tree_.nodes.push_back({static_cast<int>(axis), cut});
        add(entries.first(below));
        add(entries.subspan(below));
        return;
      }
    for (const Seen& e : entries) state_of_[static_cast<std::size_t>(e.place)] = states_;
    ++states_;
    tree_.nodes.push_back({});
  }

  const Section& section_;
  std::array<double, N> per_unit_{};
  std::size_t per_leaf_;
  std::vector<int>& state_of_;
  int states_ = 0;  // number of leaves so far, in all trees
  Tree tree_;
};

/// Grows one tree per face and writes the state of each entry into `states`.
template <std::size_t N>
std::vector<Tree> trees_of(const Section& section, const EntryTable& seen, std::size_t per_leaf,
                           std::vector<int>& states) {
  std::vector<std::size_t> count(section.faces.size());
  for (std::size_t i = 0; i < seen.size(); ++i) ++count[static_cast<std::size_t>(seen.face(i))];
  std::vector<std::vector<typename Grower<N>::Seen>> at(section.faces.size());
  for (std::size_t f = 0; f < at.size(); ++f) at[f].reserve(count[f]);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    auto& here = at[static_cast<std::size_t>(seen.face(i))].emplace_back();
    std::copy_n(seen.at(i), N, here.at.begin());
    here.place = static_cast<int>(i);
  }
  Grower<N> grower(section, per_leaf, states);
  std::vector<Tree> trees;
  for (std::size_t f = 0; f < at.size(); ++f)
    trees.push_back(at[f].empty() ? grower.unseen(section.faces[f]) : grower.grow(at[f]));
  return trees;
}

/// The instances of trees_of for 1, 2, ... coordinates.
template <std::size_t... I>
constexpr auto trees_of_each(std::index_sequence<I...>) {
  return std::array{&trees_of<I + 1>...};
}

}  // namespace

StateSpace tree_space(const Section& section, const EntryTable& seen, int per_leaf,
                      std::vector<Entry> points, std::vector<int>* state_of) {
  if (per_leaf < 1)
    throw std::invalid_argument("tree: " + std::to_string(per_leaf) +
                                " entries per leaf are not permitted: must be 1 or more");
  section.validate();
  static constexpr auto kTreesOf = trees_of_each(std::make_index_sequence<kMostCoordinates>());
  std::vector<int> states(seen.size());
  std::vector<Tree> trees = kTreesOf[section.coordinates.size() - 1](
      section, seen, static_cast<std::size_t>(per_leaf), states);
  if (state_of != nullptr) *state_of = std::move(states);
  return {section, std::move(trees), std::move(points)};
}

int coordinates_cut(const StateSpace& space) {
  std::set<int> axes;
  for (const Tree& tree : space.trees())
    for (const Tree::Node& node : tree.nodes)
      if (node.axis != Tree::kLeaf) axes.insert(node.axis);
  return static_cast<int>(axes.size());
}

}  // namespace gatewalk::dynamics
