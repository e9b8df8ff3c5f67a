// SPDX-License-Identifier: MIT
#pragma once
/// The discrete states of the chain: classes of entries into a cell. A state space consists either
/// of bins on a grid of the entries' coordinates, or of the leaves of trees of cuts. `index_of`
/// maps an entry to its state and reports entries outside every bin; `sample` draws an entry from a
/// state's range.

#include <array>
#include <string>
#include <vector>

#include "dynamics/base/random.h"
#include "dynamics/cells/section.h"

namespace gatewalk::dynamics {

/// The bin edges of one face for each coordinate, ascending. n + 1 edges make n bins.
struct Bins {
  std::array<std::vector<double>, kMostCoordinates> edges;
  friend bool operator==(const Bins&, const Bins&) = default;
};

/// The range of one state: its bin or its leaf.
struct StateRange {
  int face = 0;
  std::array<std::array<double, 2>, kMostCoordinates> at{};  // {from, to} by coordinate
  [[nodiscard]] Entry middle() const;
  friend bool operator==(const StateRange&, const StateRange&) = default;
};

/// A k-d tree of cuts over the entries at one face. The leaves of the tree are states. Outer leaves
/// extend without limit, so no entry is outside.
struct Tree {
  static constexpr int kLeaf = -1;
  /// A node, in preorder: a node is followed by the part up to its cut, then by the part above the
  /// cut.
  struct Node {
    int axis = kLeaf;  // number of a coordinate, or kLeaf
    double cut = 0.0;  // 0 in a leaf
    friend bool operator==(const Node&, const Node&) = default;
  };
  std::vector<Node> nodes{Node{}};
  std::array<std::array<double, 2>, kMostCoordinates> seen{};  // {lowest, highest} observed entry
  friend bool operator==(const Tree&, const Tree&) = default;
};

inline constexpr int kMostStates = 1'000'000;
/// The default for the least number of entries in a leaf. A leaf's row is noisy, but predictions
/// average over all leaves: sizes from 5 to 10 are about equally good.
inline constexpr int kEntriesPerLeaf = 7;

/// The states of a chain: bins or leaves of trees at every face, then single entries.
class StateSpace {
 public:
  /// Makes a space of bins. The states are the bins of every face (the last coordinate runs
  /// fastest), then `points`: single entries that are states of their own, such as starts of walks.
  /// If `open`, the outermost bins include all entries beyond them, so nothing is clamped; their
  /// outer edges record how far entries were observed. Throws std::invalid_argument unless the
  /// section is valid, every face has at least one bin and ascending edges, and all points are on a
  /// face, finite and different.
  StateSpace(Section section, std::vector<Bins> bins, bool open = false,
             std::vector<Entry> points = {});

  /// Makes an open space of trees. The states are the leaves of every face's tree in preorder, then
  /// `points`. Throws std::invalid_argument unless the section is valid, every face has a complete
  /// tree with finite cuts inside their ranges, and all points are on a face, finite and different.
  StateSpace(Section section, std::vector<Tree> trees, std::vector<Entry> points = {});

  [[nodiscard]] const Section& section() const { return section_; }
  [[nodiscard]] int size() const { return bins_and_leaves() + static_cast<int>(points_.size()); }
  /// The column of "trapped": one past the states.
  [[nodiscard]] int trapped() const { return size(); }
  [[nodiscard]] bool has_trees() const { return !sides_.empty(); }
  /// The bins of each face; without edges if the space has trees.
  [[nodiscard]] const std::vector<Bins>& bins() const { return bins_; }
  /// The tree of each face; a single leaf if the space has bins.
  [[nodiscard]] const std::vector<Tree>& trees() const { return trees_; }
  [[nodiscard]] bool open() const { return open_; }
  [[nodiscard]] const std::vector<Entry>& points() const { return points_; }
  /// The first state of a face.
  [[nodiscard]] int first(int face) const { return offset_[static_cast<std::size_t>(face)]; }

  /// The state that contains an entry.
  struct Index {
    int state = 0;
    bool clamped = false;  // the entry is outside every bin and was assigned to the nearest
    bool beyond = false;   // the entry is beyond the outer edges, clamped or in an open bin
  };
  /// Finds the state of an entry.
  [[nodiscard]] Index index_of(const Entry& entry) const;
  [[nodiscard]] StateRange range(int state) const;
  [[nodiscard]] int face(int state) const;

  /// Draws an entry uniformly from the state's range. A point gives itself.
  [[nodiscard]] Entry sample(int state, Random& random) const;

  friend bool operator==(const StateSpace&, const StateSpace&) = default;

 private:
  [[nodiscard]] int bins_and_leaves() const { return offset_.back(); }
  void require_points() const;
  [[nodiscard]] int leaf_of(int face, const Entry& entry) const;

  Section section_;
  std::vector<Bins> bins_;              // by face
  std::vector<Tree> trees_;             // by face
  std::vector<std::vector<int>> next_;  // (faces) by node: child above the cut; a leaf's state
  std::vector<std::array<double, 2>> sides_;  // (leaves x coordinates)
  std::vector<int> offset_;                   // (faces + 1)
  bool open_ = false;
  std::vector<Entry> points_;
};

/// The same space with finer (factor > 1) or coarser bins. An axis of n bins gets max(1, round(n *
/// factor)) equal bins; if that number is n, its edges stay as they are, so factor 1 gives the same
/// space bit for bit. `open` and points stay. Throws std::invalid_argument unless the space has
/// bins, the factor is finite and > 0, and the result has at most kMostStates states.
[[nodiscard]] StateSpace refined(const StateSpace& space, double factor);

/// The mirror image of a state's range.
[[nodiscard]] StateRange mirrored(const Section& section, const StateRange& range);

/// A range in words: "EN d [-5, 5] m, vx [-5, 5] m/s, vy [10, 20] m/s", or the name of its entries.
[[nodiscard]] std::string text_of(const Section& section, const StateRange& range);
/// A range in words: "[-5, 5]", or "15" for a single value.
[[nodiscard]] std::string text_of(const std::array<double, 2>& range);
/// A unit as written after a number: " m/s" for "m s-1", "" for "1".
[[nodiscard]] std::string behind_number(const std::string& unit);

}  // namespace gatewalk::dynamics
