#pragma once
/// The discrete states of the chain: how a body enters a gate, as data. A space is of one of two
/// kinds: bins on a grid of d, vx and vy (Table III's, or others), or the leaves of trees of cuts.
/// Who leaves a gate enters the next one; `index_of` turns an entry into a state, says so
/// when it lay outside every bin, and `sample` puts a body back into a state's range.

#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

#include "dynamics/gate.h"

namespace gatewalk::dynamics {

inline constexpr std::size_t kMostCoordinates = 3;

/// A body enters: through which face of a gate's border, and where and how fast, by the numbers of
/// that face's coordinates.
struct Entry {
  int face = 0;
  std::array<double, kMostCoordinates> at{};
  friend bool operator==(const Entry&, const Entry&) = default;
};

/// The faces of a gate. `right_*`: through the right side, coming from the right neighbour.
enum Boundary : int {
  enter,           // EN, from below; d = x
  right_deflect,   // RD, right side below the joint; d = joint_y - y
  left_deflect,    // LD
  right_traverse,  // RT, right side above the joint; d = y - joint_y
  left_traverse,   // LT
};
inline constexpr int kBoundaries = 5;
inline constexpr std::array<std::string_view, kBoundaries> kBoundaryNames{"EN", "RD", "LD", "RT",
                                                                          "LT"};
/// The coordinates of an entry into a gate: distance along the boundary (m), velocity (m/s).
inline constexpr std::size_t kEntryD = 0, kEntryVx = 1, kEntryVy = 2;

/// Step in gate indices that leads to entering at this boundary.
struct Move {
  int di_x = 0, di_y = 0;
};
[[nodiscard]] Move move_into(int face);

/// The entry into the next gate that ends a run. Only for runs that left the gate.
[[nodiscard]] Entry crossing_of(const GateParams& p, Ending ending, const BodyState& exit);

/// That of a body on the lower edge of its gate, y = 0.
[[nodiscard]] inline Entry entry_of(const BodyState& b) {
  return {Boundary::enter, {b.x, b.vx, b.vy}};
}

/// Body on the boundary of its new gate, in that gate's frame.
[[nodiscard]] BodyState entry_state(const GateParams& p, const Entry& entry);

/// The same body in the frame of the gate it has moved into: nothing is rounded to the boundary.
[[nodiscard]] BodyState shifted_into_next(const GateParams& p, Ending ending, BodyState exit);

/// Edges of the bins of one face by coordinate, ascending; n + 1 edges make n bins.
struct Bins {
  std::array<std::vector<double>, kMostCoordinates> edges;
  friend bool operator==(const Bins&, const Bins&) = default;
};

/// One state's range: its bin, or its leaf.
struct StateRange {
  int face = 0;
  std::array<std::array<double, 2>, kMostCoordinates> at{};  // by coordinate: from, to
  [[nodiscard]] Entry middle() const;
  friend bool operator==(const StateRange&, const StateRange&) = default;
};

/// A tree of cuts over the entries at one face (k-d tree); its leaves are states. Leaves at the
/// rim reach as far as entries may lie: nothing is outside.
struct Tree {
  static constexpr int kLeaf = -1;
  /// In preorder: behind a node comes the part up to its cut, then the part above.
  struct Node {
    int axis = kLeaf;  // number of a coordinate
    double cut = 0.0;  // 0 in a leaf
    friend bool operator==(const Node&, const Node&) = default;
  };
  std::vector<Node> nodes{Node{}};
  std::array<std::array<double, 2>, kMostCoordinates> seen{};  // between what entries lay
  friend bool operator==(const Tree&, const Tree&) = default;
};

inline constexpr int kMostStates = 1'000'000;

class StateSpace {
 public:
  /// States are the bins of every boundary (EN, RD, LD, RT, LT; within each by d, then vx, then
  /// vy), then `points`: single entries that are states of their own, such as where walks start.
  /// Open: the outermost bins take what lies beyond them, and their outer edges only say how far
  /// entries were seen; nothing is clamped. Throws std::invalid_argument unless every boundary has
  /// at least one bin and ascending edges, and all points are finite and different.
  explicit StateSpace(std::array<Bins, kBoundaries> bins, bool open = false,
                      std::vector<Entry> points = {});

  /// States are the leaves of every boundary's tree, within each in preorder, then `points`. Open.
  /// Throws std::invalid_argument unless every tree is complete with finite cuts that leave both
  /// sides room, and all points are finite and different.
  explicit StateSpace(std::array<Tree, kBoundaries> trees, std::vector<Entry> points = {});

  /// Table III: 25 EN, 30 RD, 30 LD, 1 RT, 1 LT. Distances follow the gate's size, velocities the
  /// scene's own unit of speed: the table's in the paper's scenes. RT and LT are one state each;
  /// their bin is what "Departures" in README.md says: y from joint + R up, velocities of RD and
  /// LD. Throws InvalidParameter when no disc can be ahead of the beams inside the gate.
  static StateSpace paper(const GateParams& p);

  [[nodiscard]] int size() const { return offset_[kBoundaries] + static_cast<int>(points_.size()); }
  /// Column of "trapped", one past the states.
  [[nodiscard]] int trapped() const { return size(); }
  [[nodiscard]] bool has_trees() const { return !ranges_.empty(); }
  /// Of a space of bins; else without any edges.
  [[nodiscard]] const std::array<Bins, kBoundaries>& bins() const { return bins_; }
  /// Of a space of trees; else trees of a single leaf.
  [[nodiscard]] const std::array<Tree, kBoundaries>& trees() const { return trees_; }
  [[nodiscard]] bool open() const { return open_; }
  [[nodiscard]] const std::vector<Entry>& points() const { return points_; }
  [[nodiscard]] int first(int face) const { return offset_[static_cast<std::size_t>(face)]; }

  struct Index {
    int state = 0;
    bool clamped = false;  // outside every bin of its boundary, put into the nearest
    bool beyond = false;   // clamped, or in an outermost bin that is open, beyond its outer edge
  };
  [[nodiscard]] Index index_of(const Entry& entry) const;
  [[nodiscard]] StateRange range(int state) const;
  [[nodiscard]] int face(int state) const;

  /// Uniform in the state's range; a point itself.
  [[nodiscard]] Entry sample(int state, Random& random) const;

  friend bool operator==(const StateSpace&, const StateSpace&) = default;

 private:
  void require_points() const;
  [[nodiscard]] int leaf_of(int face, const Entry& entry) const;

  std::array<Bins, kBoundaries> bins_;
  std::array<Tree, kBoundaries> trees_;
  std::array<std::vector<int>, kBoundaries> next_;  // of a tree's node: where the part above its
                                                    // cut is; of a leaf: its state
  std::vector<StateRange> ranges_;                  // of the leaves
  std::array<int, kBoundaries + 1> offset_{};
  bool open_ = false;
  std::vector<Entry> points_;
};

/// The ranges of bins in finer (factor > 1) or coarser bins: an axis of n bins gets
/// max(1, round(n * factor)) equal ones; where that is n again, its edges stay as they are, so
/// factor 1 is the same space bit for bit; open and points stay as they are. Throws
/// std::invalid_argument unless the space has bins, the factor is finite and > 0, and the result
/// has at most kMostStates states.
[[nodiscard]] StateSpace refined(const StateSpace& space, double factor);

/// "EN d [-5, 5] m, vx [-5, 5] m/s, vy [10, 20] m/s"
[[nodiscard]] std::string text_of(const StateRange& range);
/// "[-5, 5]", or "15" for a single value.
[[nodiscard]] std::string text_of(const std::array<double, 2>& range);

}  // namespace gatewalk::dynamics
