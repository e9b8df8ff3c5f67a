#include "dynamics/state_space.h"

#include <algorithm>
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

Move move_into(Boundary b) {
  switch (b) {
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

Crossing crossing_of(const GateParams& p, Ending ending, const BodyState& exit) {
  const bool below = exit.y < p.beams.joint_y;
  const double from_joint = std::abs(exit.y - p.beams.joint_y);
  switch (ending) {
    case Ending::traversed:
      return {Boundary::enter, exit.x, exit.vx, exit.vy};
    case Ending::exited_left:
      return {below ? Boundary::right_deflect : Boundary::right_traverse, from_joint, exit.vx,
              exit.vy};
    case Ending::exited_right:
      return {below ? Boundary::left_deflect : Boundary::left_traverse, from_joint, exit.vx,
              exit.vy};
    case Ending::trapped:
    case Ending::broken:
      break;
  }
  throw std::logic_error("this run did not leave its gate");
}

BodyState entry_state(const GateParams& p, const Crossing& c) {
  BodyState b{0.0, 0.0, c.vx, c.vy};
  switch (c.boundary) {
    case Boundary::enter:
      b.x = c.d;
      return b;
    case Boundary::right_deflect:
      b.x = p.beams.joint_x;
      b.y = p.beams.joint_y - c.d;
      return b;
    case Boundary::left_deflect:
      b.x = -p.beams.joint_x;
      b.y = p.beams.joint_y - c.d;
      return b;
    case Boundary::right_traverse:
      b.x = p.beams.joint_x;
      b.y = p.beams.joint_y + c.d;
      return b;
    case Boundary::left_traverse:
      b.x = -p.beams.joint_x;
      b.y = p.beams.joint_y + c.d;
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

StateSpace::StateSpace(std::array<Bins, kBoundaries> bins, bool open, std::vector<Crossing> points)
    : bins_(std::move(bins)), open_(open), points_(std::move(points)) {
  for (int b = 0; b < kBoundaries; ++b) {
    const Bins& g = bins_[b];
    for (const auto* edges : {&g.d, &g.vx, &g.vy}) {
      const bool ascending =
          std::adjacent_find(edges->begin(), edges->end(), std::greater_equal<>()) == edges->end();
      if (edges->size() < 2 || !ascending ||
          !std::all_of(edges->begin(), edges->end(), [](double e) { return std::isfinite(e); }))
        throw std::invalid_argument("state space: boundary " + std::string(kBoundaryNames[b]) +
                                    " needs at least two ascending, finite bin edges");
    }
    offset_[b + 1] = offset_[b] + count(g.d) * count(g.vx) * count(g.vy);
  }
  require_points();
}

namespace {

/// Follows a tree in preorder.
struct TreeReader {
  const Tree& tree;
  Boundary boundary;
  int first_state;
  std::vector<int> next{};   // as StateSpace::next_
  std::vector<Cell>& cells;  // of the leaves, appended

  [[noreturn]] void refuse(const char* what) const {
    throw std::invalid_argument("state space: the tree of boundary " +
                                std::string(kBoundaryNames[static_cast<int>(boundary)]) + " " +
                                what);
  }
  /// Takes the nodes of one part, whose range is `cell`.
  void read(Cell cell, int depth = 0) {
    constexpr int kDeepest = 64;
    constexpr std::array<std::array<double, 2> Cell::*, 3> kRanges{&Cell::d, &Cell::vx, &Cell::vy};
    const std::size_t at = next.size();
    if (at >= tree.nodes.size()) refuse("is not complete");
    if (depth > kDeepest) refuse("is deeper than 64 cuts");
    const Tree::Node& node = tree.nodes[at];
    if (node.axis == Tree::kLeaf) {
      next.push_back(first_state++);
      cells.push_back(cell);
      return;
    }
    if (node.axis < 0 || node.axis >= std::ssize(kRanges) || !std::isfinite(node.cut))
      refuse("has a cut that is none");
    std::array<double, 2>& range = cell.*kRanges[static_cast<std::size_t>(node.axis)];
    if (!(range[0] < node.cut && node.cut < range[1])) refuse("has a cut outside its range");
    next.push_back(0);
    const double top = std::exchange(range[1], node.cut);
    read(cell, depth + 1);
    next[at] = static_cast<int>(next.size());
    range = {node.cut, top};
    read(cell, depth + 1);
  }
};

}  // namespace

StateSpace::StateSpace(std::array<Tree, kBoundaries> trees, std::vector<Crossing> points)
    : trees_(std::move(trees)), open_(true), points_(std::move(points)) {
  for (int b = 0; b < kBoundaries; ++b) {
    TreeReader reader{.tree = trees_[b],
                      .boundary = static_cast<Boundary>(b),
                      .first_state = offset_[b],
                      .cells = cells_};
    const auto& seen = trees_[b].seen;
    for (const auto& range : seen)
      if (!std::isfinite(range[1] - range[0]) || !(range[0] <= range[1]))
        reader.refuse("has no range");
    reader.read({static_cast<Boundary>(b), seen[0], seen[1], seen[2]});
    if (reader.next.size() != trees_[b].nodes.size()) reader.refuse("has nodes behind its end");
    next_[b] = std::move(reader.next);
    offset_[b + 1] = static_cast<int>(cells_.size());
  }
  if (cells_.size() > kMostStates)
    throw std::invalid_argument("state space: trees of more than " + std::to_string(kMostStates) +
                                " leaves");
  require_points();
}

void StateSpace::require_points() const {
  for (auto c = points_.begin(); c != points_.end(); ++c)
    if (!std::isfinite(c->d + c->vx + c->vy) || std::find(points_.begin(), c, *c) != c)
      throw std::invalid_argument("state space: single entries must be finite and different");
}

int StateSpace::leaf_of(int boundary, const Crossing& c) const {
  const std::vector<Tree::Node>& nodes = trees_[boundary].nodes;
  std::size_t at = 0;
  while (nodes[at].axis != Tree::kLeaf) {
    const double v = c.*kCrossingAxes[static_cast<std::size_t>(nodes[at].axis)];
    at = v <= nodes[at].cut ? at + 1 : static_cast<std::size_t>(next_[boundary][at]);
  }
  return next_[boundary][at];
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
  return StateSpace({Bins{{-w, -0.6 * w, -0.2 * w, 0.2 * w, 0.6 * w, w},
                          speeds({-25, -15, -5, 5, 15, 25}),
                          speeds({10, 20})},
                     Bins{below, leftward, side_vy}, Bins{below, rightward, side_vy},
                     Bins{above, speeds({-30, 0}), speeds({-20, 30})},
                     Bins{above, speeds({0, 30}), speeds({-20, 30})}});
}

StateSpace::Index StateSpace::index_of(const Crossing& c) const {
  const int b = static_cast<int>(c.boundary);
  Index index;
  if (const auto point = std::find(points_.begin(), points_.end(), c); point != points_.end()) {
    index.state = offset_[kBoundaries] + static_cast<int>(point - points_.begin());
    return index;
  }
  if (has_trees()) {
    for (std::size_t axis = 0; axis < kCrossingAxes.size(); ++axis) {
      const auto& [low, high] = trees_[b].seen[axis];
      const double v = c.*kCrossingAxes[axis];
      if (v < low || v > high) index.beyond = true;
    }
    index.state = leaf_of(b, c);
    return index;
  }
  const Bins& g = bins_[b];
  const int d = bin_of(g.d, c.d, index.beyond);
  const int vx = bin_of(g.vx, c.vx, index.beyond);
  const int vy = bin_of(g.vy, c.vy, index.beyond);
  index.state = offset_[b] + (d * count(g.vx) + vx) * count(g.vy) + vy;
  index.clamped = index.beyond && !open_;
  return index;
}

Boundary StateSpace::boundary(int state) const {
  if (state >= offset_[kBoundaries]) return points_.at(state - offset_[kBoundaries]).boundary;
  const auto above = std::upper_bound(offset_.begin(), offset_.end(), state);
  return static_cast<Boundary>(above - offset_.begin() - 1);
}

Cell StateSpace::cell(int state) const {
  const Boundary b = boundary(state);
  if (state >= offset_[kBoundaries]) {
    const Crossing& c = points_[state - offset_[kBoundaries]];
    return {b, {c.d, c.d}, {c.vx, c.vx}, {c.vy, c.vy}};
  }
  if (has_trees()) return cells_[static_cast<std::size_t>(state)];
  const Bins& g = bins_[static_cast<int>(b)];
  const int in_boundary = state - first(b);
  const int vy = in_boundary % count(g.vy);
  const int vx = in_boundary / count(g.vy) % count(g.vx);
  const int d = in_boundary / count(g.vy) / count(g.vx);
  return {b, {g.d[d], g.d[d + 1]}, {g.vx[vx], g.vx[vx + 1]}, {g.vy[vy], g.vy[vy + 1]}};
}

Crossing StateSpace::sample(int state, Random& random) const {
  const Cell c = cell(state);
  const auto inside = [&](const std::array<double, 2>& edge) {
    return edge[0] + (edge[1] - edge[0]) * random.uniform();
  };
  Crossing crossing{c.boundary, 0.0, 0.0, 0.0};
  crossing.d = inside(c.d);
  crossing.vx = inside(c.vx);
  crossing.vy = inside(c.vy);
  return crossing;
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
    for (auto* edges : {&b.d, &b.vx, &b.vy}) *edges = rebinned(*edges, factor);
    states += static_cast<double>(count(b.d)) * count(b.vx) * count(b.vy);
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

std::string text_of(const Cell& cell) {
  return std::string(kBoundaryNames[static_cast<int>(cell.boundary)]) + " d " + text_of(cell.d) +
         " m, vx " + text_of(cell.vx) + " m/s, vy " + text_of(cell.vy) + " m/s";
}

}  // namespace gatewalk::dynamics
