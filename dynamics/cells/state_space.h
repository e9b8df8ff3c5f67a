// SPDX-License-Identifier: MIT
#pragma once
/// The discrete states of the chain: how a body enters a cell, as data. A space is of one of two
/// kinds: bins on a grid of the entries' coordinates, or the leaves of trees of cuts.
/// `index_of` turns an entry into a state and says so when it lay outside every bin, and `sample`
/// puts a body back into a state's range.

#include <array>
#include <string>
#include <vector>

#include "dynamics/base/random.h"
#include "dynamics/cells/section.h"

namespace gatewalk::dynamics {

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
/// Entries in a leaf, at least, unless somebody says otherwise. A leaf's row is noisy, but
/// predictions average over all leaves: from 5 to 20 all are as good (markov/README.md).
inline constexpr int kEntriesPerLeaf = 7;

class StateSpace {
 public:
  /// States are the bins of every face (within each by the first coordinate, then the next), then
  /// `points`: single entries that are states of their own, such as where walks start. Open: the
  /// outermost bins take what lies beyond them, and their outer edges only say how far entries were
  /// seen; nothing is clamped. Throws std::invalid_argument unless the section is valid, every face
  /// has at least one bin and ascending edges, and all points are on a face, finite and different.
  StateSpace(Section section, std::vector<Bins> bins, bool open = false,
             std::vector<Entry> points = {});

  /// States are the leaves of every face's tree, within each in preorder, then `points`. Open.
  /// Throws std::invalid_argument unless the section is valid, every face has a tree, complete with
  /// finite cuts that leave both sides room, and all points are on a face, finite and different.
  StateSpace(Section section, std::vector<Tree> trees, std::vector<Entry> points = {});

  [[nodiscard]] const Section& section() const { return section_; }
  [[nodiscard]] int size() const { return bins_and_leaves() + static_cast<int>(points_.size()); }
  /// Column of "trapped", one past the states.
  [[nodiscard]] int trapped() const { return size(); }
  [[nodiscard]] bool has_trees() const { return !sides_.empty(); }
  /// By face, of a space of bins; else without any edges.
  [[nodiscard]] const std::vector<Bins>& bins() const { return bins_; }
  /// By face, of a space of trees; else trees of a single leaf.
  [[nodiscard]] const std::vector<Tree>& trees() const { return trees_; }
  [[nodiscard]] bool open() const { return open_; }
  [[nodiscard]] const std::vector<Entry>& points() const { return points_; }
  /// The face's first state.
  [[nodiscard]] int first(int face) const { return offset_[static_cast<std::size_t>(face)]; }

  struct Index {
    int state = 0;
    bool clamped = false;  // outside every bin of its face, put into the nearest
    bool beyond = false;   // clamped, or in an outermost bin that is open, beyond its outer edge
  };
  [[nodiscard]] Index index_of(const Entry& entry) const;
  [[nodiscard]] StateRange range(int state) const;
  [[nodiscard]] int face(int state) const;

  /// Uniform in the state's range; a point itself.
  [[nodiscard]] Entry sample(int state, Random& random) const;

  friend bool operator==(const StateSpace&, const StateSpace&) = default;

 private:
  [[nodiscard]] int bins_and_leaves() const { return offset_.back(); }
  void require_points() const;
  [[nodiscard]] int leaf_of(int face, const Entry& entry) const;

  Section section_;
  std::vector<Bins> bins_;              // by face
  std::vector<Tree> trees_;             // by face
  std::vector<std::vector<int>> next_;  // by face; of a tree's node: where the part above its cut
                                        // is; of a leaf: its state
  std::vector<std::array<double, 2>> sides_;  // (leaves x coordinates)
  std::vector<int> offset_;                   // (faces + 1)
  bool open_ = false;
  std::vector<Entry> points_;
};

/// The ranges of bins in finer (factor > 1) or coarser bins: an axis of n bins gets
/// max(1, round(n * factor)) equal ones; where that is n again, its edges stay as they are, so
/// factor 1 is the same space bit for bit; open and points stay as they are. Throws
/// std::invalid_argument unless the space has bins, the factor is finite and > 0, and the result
/// has at most kMostStates states.
[[nodiscard]] StateSpace refined(const StateSpace& space, double factor);

/// The mirror image of a state's range.
[[nodiscard]] StateRange mirrored(const Section& section, const StateRange& range);

/// "EN d [-5, 5] m, vx [-5, 5] m/s, vy [10, 20] m/s"
[[nodiscard]] std::string text_of(const Section& section, const StateRange& range);
/// "[-5, 5]", or "15" for a single value.
[[nodiscard]] std::string text_of(const std::array<double, 2>& range);
/// A unit behind a number: " m/s" for "m s-1", nothing for "1".
[[nodiscard]] std::string behind_number(const std::string& unit);

}  // namespace gatewalk::dynamics
