// SPDX-License-Identifier: MIT
#pragma once
/// The surface of section of a kind of cell, as data: the faces of its border through which bodies
/// enter, the coordinates of an entry, and the costs of a passage; also the map of which cell type
/// stands where. The chain needs no more: no forces and no beams.

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace gatewalk::dynamics {

class Words;

/// The largest number of costs. The number is small because a chain keeps two sums of each cost for
/// every count (CostSums).
inline constexpr std::size_t kMostCosts = 5;

/// A cost, that is, a quantity that a passage takes: its key in files (ending in the unit), its
/// unit, and its name in words.
struct CostInfo {
  std::string key, unit, words;  // "time_s", "s", "duration"
  friend bool operator==(const CostInfo&, const CostInfo&) = default;
};

/// The costs of one passage, in the order of Section::costs; 0 beyond the last cost, NaN where a
/// cost is unknown.
using Costs = std::array<double, kMostCosts>;

/// The sums of the costs of several passages, and the sums of their squares.
struct CostSums {
  Costs sum{}, squares{};
  void add(const Costs& costs);
  CostSums& operator+=(const CostSums& other);
  friend bool operator==(const CostSums&, const CostSums&) = default;
};

/// Limits of cells. Chains that remember have up to Words::kMostLabels faces.
inline constexpr std::size_t kMostFaces = 64, kMostCoordinates = 8;

/// An entry of a body into a cell: the face, and the place and velocity there.
struct Entry {
  int face = 0;
  std::array<double, kMostCoordinates> at{};  // by coordinate; 0 beyond the last
  friend bool operator==(const Entry&, const Entry&) = default;
};

/// A coordinate of every entry. The first coordinate is the place along the face.
struct Coordinate {
  std::string name;    // "vx", in tables
  std::string key;     // "vx_m_per_s", in JSON and scenes
  std::string unit;    // "m s-1"
  std::string words;   // "lateral velocity"
  double scale = 1.0;  // > 0; the unit in which spreads along coordinates are compared

  /// Coordinates are equal if all but their scales are.
  friend bool operator==(const Coordinate& a, const Coordinate& b) {
    return a.name == b.name && a.key == b.key && a.unit == b.unit && a.words == b.words;
  }
};

/// The value of Face::mirror for a face without a mirror image.
inline constexpr int kNoMirror = -1;

/// A part of a cell's border, with coordinates of its own.
struct Face {
  std::string name;        // "EN"
  int di_x = 0, di_y = 0;  // the move between cells that enters here
  /// The face through which mirror images enter: the face itself in the middle (set_mirrors). Only
  /// symmetric cells need one; kNoMirror: there is none.
  int mirror = kNoMirror;
  std::uint8_t odd = 0;  // bit k: coordinate k changes its sign in the mirror
  std::string origin;    // "from below": where bodies come from
  /// Usual range {from, to} of each coordinate: the range of the face's only state if no entry was
  /// observed there.
  std::array<std::array<double, 2>, kMostCoordinates> usual{};

  [[nodiscard]] bool is_odd(std::size_t coordinate) const { return (odd >> coordinate & 1) != 0; }
  /// Faces are equal if all but their usual ranges are.
  friend bool operator==(const Face& a, const Face& b) {
    return a.name == b.name && a.di_x == b.di_x && a.di_y == b.di_y && a.mirror == b.mirror &&
           a.odd == b.odd && a.origin == b.origin;
  }
};

/// Entries at a face that have a name: those with a first coordinate in [from, to]. They make one
/// state where states are kinds of things rather than places and velocities.
struct NamedEntries {
  int face = 0;
  double from = 0.0, to = 0.0;
  std::string name;
  int number = 0;  // number in the table that names these entries, from 0
};

/// The surface of section that all cells of a field share. Entries are points on this surface.
struct Section {
  std::vector<Face> faces;              // 1 to kMostFaces
  std::vector<Coordinate> coordinates;  // 1 to kMostCoordinates
  std::vector<CostInfo> costs;          // up to kMostCosts
  std::vector<NamedEntries> named{};    // sorted by face and place, none overlap; usually empty
  /// What a chain remembers beside the face, if anything: then `faces` has its labels.
  std::shared_ptr<const Words> words{};

  /// Throws std::invalid_argument unless the numbers of faces, coordinates and costs are within
  /// their limits, the names within each kind differ (of costs: the keys), every face has a move,
  /// mirror images of faces are mutual (or absent), and scales are finite and > 0.
  void validate() const;
  /// Sections are equal if all but the names of their entries are.
  friend bool operator==(const Section& a, const Section& b) {
    return a.faces == b.faces && a.coordinates == b.coordinates && a.costs == b.costs;
  }
};
/// The name of an entry; empty if it has none.
[[nodiscard]] std::string name_of(const Section& section, const Entry& entry);

/// The names of faces or coordinates in one string: "EN, RD, LD".
template <class Named>
[[nodiscard]] std::string names_of(const std::vector<Named>& all,
                                   const std::string& between = ", ") {
  std::string text;
  for (const Named& one : all) text += (text.empty() ? "" : between) + one.name;
  return text;
}
/// The names of faces or coordinates with their numbers in files: "0 EN, 1 RD, 2 LD".
template <class Named>
[[nodiscard]] std::string numbers_of(const std::vector<Named>& all) {
  std::string text;
  for (std::size_t i = 0; i < all.size(); ++i)
    text += (i > 0 ? ", " : "") + std::to_string(i) + " " + all[i].name;
  return text;
}

/// The usual ranges of a face, for a state in which no entry was observed. Throws
/// std::invalid_argument naming the face if a usual range is missing.
[[nodiscard]] const std::array<std::array<double, 2>, kMostCoordinates>& usual_at(
    const Section& section, const Face& face);

/// Sets the mirror image of each face: `named` if given (by face, else kNoMirror); else the face
/// itself if its move does not go sideways; else the only face with the mirrored move. If the cell
/// is not `symmetric`, a face that does not match its image gets kNoMirror.
void set_mirrors(std::vector<Face>& faces, const std::vector<int>& named, bool symmetric);

/// The mirror image of an entry, left for right. Its face is kNoMirror if the face has no mirror
/// image.
[[nodiscard]] Entry mirrored(const Section& section, const Entry& entry);

/// The layout of a field: which type of cell stands where. Pools, chains and predictions need no
/// more.
struct CellMap {
  struct Type {
    bool symmetric = false;  // whether mirror images of passages are passages too
  };
  Section section;
  std::vector<Type> types;
  int columns = 0;                // 0: type 0 in every cell
  std::vector<int> type_of_cell;  // (rows x columns) numbers of types

  [[nodiscard]] int type_of(int column, int row) const {
    return type_of_cell.empty() ? 0
                                : type_of_cell[static_cast<std::size_t>(row * columns + column)];
  }
  /// Throws std::invalid_argument unless the map is for a field of this size or has one type
  /// everywhere.
  void require_fits(int field_columns, int field_rows) const;
};

}  // namespace gatewalk::dynamics
