// SPDX-License-Identifier: MIT
#include "dynamics/cells/state_space.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

namespace gatewalk::dynamics {
namespace {

int count(const std::vector<double>& edges) { return static_cast<int>(edges.size()) - 1; }

/// The bin of v. If v is outside all bins, the nearest bin, and `beyond` is set.
int bin_of(const std::vector<double>& edges, double v, bool& beyond) {
  if (v < edges.front() || v > edges.back()) beyond = true;
  const auto above = std::upper_bound(edges.begin() + 1, edges.end() - 1, v);
  return static_cast<int>(above - edges.begin()) - 1;
}

std::invalid_argument too_many_states(double factor) {
  return std::invalid_argument(
      fmt::format("bins: factor {:f} makes more than {} states", factor, kMostStates));
}

/// The range of `edges` in max(1, round(n * factor)) equal bins; `edges` themselves if that number
/// is n.
std::vector<double> rebinned(const std::vector<double>& edges, double factor) {
  const double wanted = std::max(1.0, std::round(count(edges) * factor));
  if (!(wanted <= kMostStates)) throw too_many_states(factor);
  const int n = static_cast<int>(wanted);
  if (n == count(edges)) return edges;
  std::vector<double> equal(n + 1);
  const double low = edges.front(), high = edges.back();
  for (int i = 0; i < n; ++i) equal[i] = low + (high - low) * i / n;
  equal[n] = high;
  return equal;
}

std::invalid_argument not_by_face(const std::string& what) {
  return std::invalid_argument("state space: not as many " + what + " as faces");
}

}  // namespace

StateSpace::StateSpace(Section section, std::vector<Bins> bins, bool open,
                       std::vector<Entry> points)
    : section_(std::move(section)),
      bins_(std::move(bins)),
      trees_(section_.faces.size()),
      next_(section_.faces.size()),
      offset_{0},
      open_(open),
      points_(std::move(points)) {
  section_.validate();
  if (bins_.size() != section_.faces.size()) throw not_by_face("bins");
  for (std::size_t f = 0; f < bins_.size(); ++f) {
    int states = 1;
    for (std::size_t axis = 0; axis < section_.coordinates.size(); ++axis) {
      const std::vector<double>& edges = bins_[f].edges[axis];
      const bool ascending =
          std::adjacent_find(edges.begin(), edges.end(), std::greater_equal<>()) == edges.end();
      if (edges.size() < 2 || !ascending ||
          !std::all_of(edges.begin(), edges.end(), [](double e) { return std::isfinite(e); }))
        throw std::invalid_argument("state space: boundary " + section_.faces[f].name +
                                    " needs at least two ascending, finite bin edges");
      states *= count(edges);
    }
    offset_.push_back(offset_.back() + states);
  }
  require_points();
}

namespace {

/// Reads a tree in preorder and collects the ranges of its leaves.
struct TreeReader {
  using Range = decltype(StateRange::at);

  const Tree& tree;
  const std::string& face;
  int coordinates;
  int first_state;
  std::vector<int> next{};                    // see StateSpace::next_
  std::vector<std::array<double, 2>>& sides;  // see StateSpace::sides_; leaves are appended

  [[noreturn]] void refuse(const char* what) const {
    throw std::invalid_argument("state space: the tree of boundary " + face + " " + what);
  }
  /// Reads the nodes of one part of the tree, whose range is `range`.
  void read(Range range, int depth = 0) {
    constexpr int kDeepest = 64;
    const std::size_t at = next.size();
    if (at >= tree.nodes.size()) refuse("is not complete");
    if (depth > kDeepest) refuse("is deeper than 64 cuts");
    const Tree::Node& node = tree.nodes[at];
    if (node.axis == Tree::kLeaf) {
      next.push_back(first_state++);
      sides.insert(sides.end(), range.begin(), range.begin() + coordinates);
      return;
    }
    if (node.axis < 0 || node.axis >= coordinates || !std::isfinite(node.cut))
      refuse("has a cut that is none");
    std::array<double, 2>& side = range[static_cast<std::size_t>(node.axis)];
    if (!(side[0] < node.cut && node.cut < side[1])) refuse("has a cut outside its range");
    next.push_back(0);
    const double top = std::exchange(side[1], node.cut);
    read(range, depth + 1);
    next[at] = static_cast<int>(next.size());
    side = {node.cut, top};
    read(range, depth + 1);
  }
};

}  // namespace

StateSpace::StateSpace(Section section, std::vector<Tree> trees, std::vector<Entry> points)
    : section_(std::move(section)),
      bins_(section_.faces.size()),
      trees_(std::move(trees)),
      offset_{0},
      open_(true),
      points_(std::move(points)) {
  section_.validate();
  if (trees_.size() != section_.faces.size()) throw not_by_face("trees");
  const auto coordinates = static_cast<int>(section_.coordinates.size());
  for (std::size_t f = 0; f < trees_.size(); ++f) {
    TreeReader reader{.tree = trees_[f],
                      .face = section_.faces[f].name,
                      .coordinates = coordinates,
                      .first_state = offset_.back(),
                      .sides = sides_};
    for (const auto& range : trees_[f].seen)
      if (!std::isfinite(range[1] - range[0]) || !(range[0] <= range[1]))
        reader.refuse("has no range");
    reader.read(trees_[f].seen);
    if (reader.next.size() != trees_[f].nodes.size()) reader.refuse("has nodes behind its end");
    next_.push_back(std::move(reader.next));
    offset_.push_back(static_cast<int>(sides_.size()) / coordinates);
  }
  if (bins_and_leaves() > kMostStates)
    throw std::invalid_argument("state space: trees of more than " + std::to_string(kMostStates) +
                                " leaves");
  require_points();
}

void StateSpace::require_points() const {
  for (auto c = points_.begin(); c != points_.end(); ++c)
    if (c->face < 0 || c->face >= std::ssize(section_.faces) ||
        !std::isfinite(std::accumulate(c->at.begin(), c->at.end(), 0.0)) ||
        std::find(points_.begin(), c, *c) != c)
      throw std::invalid_argument(
          "state space: single entries must be on a face, finite and different");
}

int StateSpace::leaf_of(int face, const Entry& entry) const {
  const std::vector<Tree::Node>& nodes = trees_[face].nodes;
  std::size_t at = 0;
  while (nodes[at].axis != Tree::kLeaf) {
    const double v = entry.at[static_cast<std::size_t>(nodes[at].axis)];
    at = v <= nodes[at].cut ? at + 1 : static_cast<std::size_t>(next_[face][at]);
  }
  return next_[face][at];
}

Entry StateRange::middle() const {
  Entry entry{face};
  for (std::size_t axis = 0; axis < kMostCoordinates; ++axis)
    entry.at[axis] = std::midpoint(at[axis][0], at[axis][1]);
  return entry;
}

StateSpace::Index StateSpace::index_of(const Entry& entry) const {
  Index index;
  if (const auto point = std::find(points_.begin(), points_.end(), entry); point != points_.end()) {
    index.state = bins_and_leaves() + static_cast<int>(point - points_.begin());
    return index;
  }
  if (has_trees()) {
    for (std::size_t axis = 0; axis < section_.coordinates.size(); ++axis) {
      const auto& [low, high] = trees_[entry.face].seen[axis];
      if (entry.at[axis] < low || entry.at[axis] > high) index.beyond = true;
    }
    index.state = leaf_of(entry.face, entry);
    return index;
  }
  int in_face = 0;
  for (std::size_t axis = 0; axis < section_.coordinates.size(); ++axis) {
    const std::vector<double>& edges = bins_[entry.face].edges[axis];
    in_face = in_face * count(edges) + bin_of(edges, entry.at[axis], index.beyond);
  }
  index.state = offset_[entry.face] + in_face;
  index.clamped = index.beyond && !open_;
  return index;
}

int StateSpace::face(int state) const {
  if (state >= bins_and_leaves()) return points_.at(state - bins_and_leaves()).face;
  const auto above = std::upper_bound(offset_.begin(), offset_.end(), state);
  return static_cast<int>(above - offset_.begin()) - 1;
}

StateRange StateSpace::range(int state) const {
  StateRange range{face(state)};
  const std::size_t coordinates = section_.coordinates.size();
  if (state >= bins_and_leaves()) {
    const Entry& point = points_[state - bins_and_leaves()];
    for (std::size_t axis = 0; axis < coordinates; ++axis)
      range.at[axis] = {point.at[axis], point.at[axis]};
    return range;
  }
  if (has_trees()) {
    const auto* const sides = sides_.data() + static_cast<std::size_t>(state) * coordinates;
    std::copy(sides, sides + coordinates, range.at.begin());
    return range;
  }
  int in_face = state - first(range.face);
  for (std::size_t axis = coordinates; axis-- > 0;) {
    const std::vector<double>& edges = bins_[range.face].edges[axis];
    const int bin = in_face % count(edges);
    range.at[axis] = {edges[bin], edges[bin + 1]};
    in_face /= count(edges);
  }
  return range;
}

Entry StateSpace::sample(int state, Random& random) const {
  const StateRange range = this->range(state);
  Entry entry{range.face};
  // Draws for points too, so that the stream does not depend on the state.
  for (std::size_t axis = 0; axis < section_.coordinates.size(); ++axis) {
    const auto& [from, to] = range.at[axis];
    entry.at[axis] = from + (to - from) * random.uniform();
  }
  return entry;
}

StateSpace refined(const StateSpace& space, double factor) {
  if (!(factor > 0.0) || !std::isfinite(factor))
    throw std::invalid_argument("bins: factor " + fmt::format("{:f}", factor) +
                                " is not permitted: must be finite and > 0");
  if (space.has_trees())
    throw std::invalid_argument("bins: a tree has none that a factor could refine");
  std::vector<Bins> bins = space.bins();
  double states = 0.0;
  for (Bins& b : bins) {
    double here = 1.0;
    for (std::size_t axis = 0; axis < space.section().coordinates.size(); ++axis) {
      b.edges[axis] = rebinned(b.edges[axis], factor);
      here *= count(b.edges[axis]);
    }
    states += here;
  }
  if (states > kMostStates) throw too_many_states(factor);
  return {space.section(), std::move(bins), space.open(), space.points()};
}

std::string text_of(const std::array<double, 2>& range) {
  return range[0] == range[1] ? fmt::format("{:.6g}", range[0])
                              : fmt::format("[{:.6g}, {:.6g}]", range[0], range[1]);
}

std::string behind_number(const std::string& unit) {
  std::string text;
  std::istringstream words(unit == "1" ? "" : unit);
  words.exceptions(std::ios_base::badbit);
  for (std::string word; words >> word;)
    text += word.ends_with("-1") ? "/" + word.substr(0, word.size() - 2) : " " + word;
  return text;
}

StateRange mirrored(const Section& section, const StateRange& range) {
  const Face& face = section.faces[range.face];
  StateRange image{face.mirror, range.at};
  for (std::size_t axis = 0; axis < section.coordinates.size(); ++axis)
    if (face.is_odd(axis)) image.at[axis] = {-range.at[axis][1], -range.at[axis][0]};
  return image;
}

std::string text_of(const Section& section, const StateRange& range) {
  if (std::string name = name_of(section, range.middle()); !name.empty()) return name;
  std::string text = section.faces[range.face].name;
  for (std::size_t axis = 0; axis < section.coordinates.size(); ++axis) {
    const Coordinate& c = section.coordinates[axis];
    text +=
        (axis > 0 ? ", " : " ") + c.name + " " + text_of(range.at[axis]) + behind_number(c.unit);
  }
  return text;
}

}  // namespace gatewalk::dynamics
