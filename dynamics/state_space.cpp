#include "dynamics/state_space.h"

#include <algorithm>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

namespace gatewalk::dynamics {
namespace {

int count(const std::vector<double>& edges) { return static_cast<int>(edges.size()) - 1; }

/// Bin of v; outside all bins the nearest one, and `beyond` is set.
int bin_of(const std::vector<double>& edges, double v, bool& beyond) {
  if (v < edges.front() || v > edges.back()) beyond = true;
  const auto above = std::upper_bound(edges.begin() + 1, edges.end() - 1, v);
  return static_cast<int>(above - edges.begin()) - 1;
}

std::invalid_argument too_many_states(double factor) {
  return std::invalid_argument("bins: factor " + std::to_string(factor) + " makes more than " +
                               std::to_string(kMostStates) + " states");
}

/// `edges` in max(1, round(n * factor)) equal bins; as they are if that is as many as now.
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

}  // namespace

Move move_into(int face) {
  switch (face) {
    case Boundary::enter:
      return {0, 1};
    case Boundary::right_deflect:
    case Boundary::right_traverse:
      return {-1, 0};
    case Boundary::left_deflect:
    case Boundary::left_traverse:
      return {1, 0};
  }
  throw std::logic_error("no such boundary");
}

Entry crossing_of(const GateParams& p, Ending ending, const BodyState& exit) {
  const bool below = exit.y < p.beams.joint_y;
  const double from_joint = std::abs(exit.y - p.beams.joint_y);
  switch (ending) {
    case Ending::traversed:
      return {Boundary::enter, {exit.x, exit.vx, exit.vy}};
    case Ending::exited_left:
      return {below ? Boundary::right_deflect : Boundary::right_traverse,
              {from_joint, exit.vx, exit.vy}};
    case Ending::exited_right:
      return {below ? Boundary::left_deflect : Boundary::left_traverse,
              {from_joint, exit.vx, exit.vy}};
    case Ending::trapped:
    case Ending::broken:
      break;
  }
  throw std::logic_error("this run did not leave its gate");
}

BodyState entry_state(const GateParams& p, const Entry& entry) {
  const double d = entry.at[kEntryD];
  BodyState b{0.0, 0.0, entry.at[kEntryVx], entry.at[kEntryVy]};
  switch (entry.face) {
    case Boundary::enter:
      b.x = d;
      return b;
    case Boundary::right_deflect:
      b.x = p.beams.joint_x;
      b.y = p.beams.joint_y - d;
      return b;
    case Boundary::left_deflect:
      b.x = -p.beams.joint_x;
      b.y = p.beams.joint_y - d;
      return b;
    case Boundary::right_traverse:
      b.x = p.beams.joint_x;
      b.y = p.beams.joint_y + d;
      return b;
    case Boundary::left_traverse:
      b.x = -p.beams.joint_x;
      b.y = p.beams.joint_y + d;
      return b;
  }
  throw std::logic_error("no such boundary");
}

BodyState shifted_into_next(const GateParams& p, Ending ending, BodyState exit) {
  const double width = p.gate_width();
  if (ending == Ending::traversed) exit.y -= p.run.traverse_y;
  if (ending == Ending::exited_left) exit.x += width;
  if (ending == Ending::exited_right) exit.x -= width;
  return exit;
}

StateSpace::StateSpace(std::array<Bins, kBoundaries> bins, bool open, std::vector<Entry> points)
    : bins_(std::move(bins)), open_(open), points_(std::move(points)) {
  for (int b = 0; b < kBoundaries; ++b) {
    const Bins& g = bins_[b];
    for (const std::vector<double>& edges : g.edges) {
      const bool ascending =
          std::adjacent_find(edges.begin(), edges.end(), std::greater_equal<>()) == edges.end();
      if (edges.size() < 2 || !ascending ||
          !std::all_of(edges.begin(), edges.end(), [](double e) { return std::isfinite(e); }))
        throw std::invalid_argument("state space: boundary " + std::string(kBoundaryNames[b]) +
                                    " needs at least two ascending, finite bin edges");
    }
    int states = 1;
    for (const std::vector<double>& edges : g.edges) states *= count(edges);
    offset_[b + 1] = offset_[b] + states;
  }
  require_points();
}

namespace {

/// Follows a tree in preorder.
struct TreeReader {
  const Tree& tree;
  int face;
  int first_state;
  std::vector<int> next{};          // as StateSpace::next_
  std::vector<StateRange>& ranges;  // of the leaves, appended

  [[noreturn]] void refuse(const char* what) const {
    throw std::invalid_argument("state space: the tree of boundary " +
                                std::string(kBoundaryNames[face]) + " " + what);
  }
  /// Takes the nodes of one part, which has this range.
  void read(StateRange range, int depth = 0) {
    constexpr int kDeepest = 64;
    const std::size_t at = next.size();
    if (at >= tree.nodes.size()) refuse("is not complete");
    if (depth > kDeepest) refuse("is deeper than 64 cuts");
    const Tree::Node& node = tree.nodes[at];
    if (node.axis == Tree::kLeaf) {
      next.push_back(first_state++);
      ranges.push_back(range);
      return;
    }
    if (node.axis < 0 || node.axis >= std::ssize(range.at) || !std::isfinite(node.cut))
      refuse("has a cut that is none");
    std::array<double, 2>& side = range.at[static_cast<std::size_t>(node.axis)];
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

StateSpace::StateSpace(std::array<Tree, kBoundaries> trees, std::vector<Entry> points)
    : trees_(std::move(trees)), open_(true), points_(std::move(points)) {
  for (int b = 0; b < kBoundaries; ++b) {
    TreeReader reader{.tree = trees_[b], .face = b, .first_state = offset_[b], .ranges = ranges_};
    const auto& seen = trees_[b].seen;
    for (const auto& range : seen)
      if (!std::isfinite(range[1] - range[0]) || !(range[0] <= range[1]))
        reader.refuse("has no range");
    reader.read({b, seen});
    if (reader.next.size() != trees_[b].nodes.size()) reader.refuse("has nodes behind its end");
    next_[b] = std::move(reader.next);
    offset_[b + 1] = static_cast<int>(ranges_.size());
  }
  if (ranges_.size() > kMostStates)
    throw std::invalid_argument("state space: trees of more than " + std::to_string(kMostStates) +
                                " leaves");
  require_points();
}

void StateSpace::require_points() const {
  for (auto c = points_.begin(); c != points_.end(); ++c)
    if (!std::isfinite(std::accumulate(c->at.begin(), c->at.end(), 0.0)) ||
        std::find(points_.begin(), c, *c) != c)
      throw std::invalid_argument("state space: single entries must be finite and different");
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

StateSpace StateSpace::paper(const GateParams& p) {
  const double w = p.beams.joint_x, y = p.beams.joint_y, r = p.body.radius;
  if (!(p.run.traverse_y > y + r))
    throw InvalidParameter("run.traverse_y_m",
                           "run.traverse_y_m = " + std::to_string(p.run.traverse_y) +
                               " is not permitted for a chain or a field: it must exceed "
                               "beams.joint_y_m + body.radius_m = " +
                               std::to_string(y + r));
  const double unit = scale_of(p).speed();
  const auto speeds = [unit](std::vector<double> edges) {  // Table III's, in m/s
    for (double& v : edges) v *= unit;
    return edges;
  };
  const auto leftward = speeds({-30, -20, -10, 0}), rightward = speeds({0, 10, 20, 30});
  const auto side_vy = speeds({-20, -10, 0, 10, 20, 30});
  const std::vector<double> below{r, (r + y) / 2, y}, above{r, p.run.traverse_y - y};
  return StateSpace({Bins{{{{-w, -0.6 * w, -0.2 * w, 0.2 * w, 0.6 * w, w},
                            speeds({-25, -15, -5, 5, 15, 25}),
                            speeds({10, 20})}}},
                     Bins{{below, leftward, side_vy}}, Bins{{below, rightward, side_vy}},
                     Bins{{above, speeds({-30, 0}), speeds({-20, 30})}},
                     Bins{{above, speeds({0, 30}), speeds({-20, 30})}}});
}

StateSpace::Index StateSpace::index_of(const Entry& entry) const {
  Index index;
  if (const auto point = std::find(points_.begin(), points_.end(), entry); point != points_.end()) {
    index.state = offset_[kBoundaries] + static_cast<int>(point - points_.begin());
    return index;
  }
  if (has_trees()) {
    for (std::size_t axis = 0; axis < kMostCoordinates; ++axis) {
      const auto& [low, high] = trees_[entry.face].seen[axis];
      if (entry.at[axis] < low || entry.at[axis] > high) index.beyond = true;
    }
    index.state = leaf_of(entry.face, entry);
    return index;
  }
  int in_face = 0;
  for (std::size_t axis = 0; axis < kMostCoordinates; ++axis) {
    const std::vector<double>& edges = bins_[entry.face].edges[axis];
    in_face = in_face * count(edges) + bin_of(edges, entry.at[axis], index.beyond);
  }
  index.state = offset_[entry.face] + in_face;
  index.clamped = index.beyond && !open_;
  return index;
}

int StateSpace::face(int state) const {
  if (state >= offset_[kBoundaries]) return points_.at(state - offset_[kBoundaries]).face;
  const auto above = std::upper_bound(offset_.begin(), offset_.end(), state);
  return static_cast<int>(above - offset_.begin()) - 1;
}

StateRange StateSpace::range(int state) const {
  StateRange range{face(state)};
  if (state >= offset_[kBoundaries]) {
    const Entry& point = points_[state - offset_[kBoundaries]];
    for (std::size_t axis = 0; axis < kMostCoordinates; ++axis)
      range.at[axis] = {point.at[axis], point.at[axis]};
    return range;
  }
  if (has_trees()) return ranges_[static_cast<std::size_t>(state)];
  int in_face = state - first(range.face);
  for (std::size_t axis = kMostCoordinates; axis-- > 0;) {
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
  for (std::size_t axis = 0; axis < kMostCoordinates; ++axis) {  // one draw each, of points too
    const auto& [from, to] = range.at[axis];
    entry.at[axis] = from + (to - from) * random.uniform();
  }
  return entry;
}

StateSpace refined(const StateSpace& space, double factor) {
  if (!(factor > 0.0) || !std::isfinite(factor))
    throw std::invalid_argument("bins: factor " + std::to_string(factor) +
                                " is not permitted: must be finite and > 0");
  if (space.has_trees())
    throw std::invalid_argument("bins: a tree has none that a factor could refine");
  std::array<Bins, kBoundaries> bins = space.bins();
  double states = 0.0;
  for (Bins& b : bins) {
    double here = 1.0;
    for (std::vector<double>& edges : b.edges) {
      edges = rebinned(edges, factor);
      here *= count(edges);
    }
    states += here;
  }
  if (states > kMostStates) throw too_many_states(factor);
  return StateSpace(std::move(bins), space.open(), space.points());
}

std::string text_of(const std::array<double, 2>& range) {
  std::ostringstream text;
  if (range[0] == range[1])
    text << range[0];
  else
    text << "[" << range[0] << ", " << range[1] << "]";
  return text.str();
}

std::string text_of(const StateRange& range) {
  return std::string(kBoundaryNames[range.face]) + " d " + text_of(range.at[kEntryD]) + " m, vx " +
         text_of(range.at[kEntryVx]) + " m/s, vy " + text_of(range.at[kEntryVy]) + " m/s";
}

}  // namespace gatewalk::dynamics
