// SPDX-License-Identifier: MIT
#pragma once
/// What a chain knows of a kind of cell, as data: the faces of its border through which bodies
/// enter, the coordinates of an entry, and what a passage takes; and which cells stand where. No
/// force, no beam.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace gatewalk::dynamics {

/// No more than are needed: a chain keeps two sums of each for every count (CostSums).
inline constexpr std::size_t kMostCosts = 5;

/// What a passage takes: its name in files, with the unit, and in words.
struct CostInfo {
  std::string key, unit, words;  // "time_s", "s", "duration"
  friend bool operator==(const CostInfo&, const CostInfo&) = default;
};

/// Of a passage, by Section::costs; 0 behind the last, NaN where nothing is known.
using Costs = std::array<double, kMostCosts>;

/// What passages took together, and the sum of the squares.
struct CostSums {
  Costs sum{}, squares{};
  void add(const Costs& costs);
  CostSums& operator+=(const CostSums& other);
  friend bool operator==(const CostSums&, const CostSums&) = default;
};

inline constexpr std::size_t kMostFaces = 64, kMostCoordinates = 8;

/// A body enters: through which face, and where and how fast.
struct Entry {
  int face = 0;
  std::array<double, kMostCoordinates> at{};  // by coordinate; 0 behind the last
  friend bool operator==(const Entry&, const Entry&) = default;
};

/// What is told of every entry; the first one is its place on the face.
struct Coordinate {
  std::string name;    // "vx", in tables
  std::string key;     // "vx_m_per_s", in JSON and scenes
  std::string unit;    // "m s-1"
  std::string words;   // "lateral velocity"
  double scale = 1.0;  // > 0, what spreads along coordinates are compared in

  /// The same one, on whatever scale.
  friend bool operator==(const Coordinate& a, const Coordinate& b) {
    return a.name == b.name && a.key == b.key && a.unit == b.unit && a.words == b.words;
  }
};

inline constexpr int kNoMirror = -1;

/// A part of a cell's border with coordinates of its own.
struct Face {
  std::string name;        // "EN"
  int di_x = 0, di_y = 0;  // the move from cell to cell that enters through it
  /// The face by which mirror images enter, itself in the middle (set_mirrors). Only symmetric
  /// cells need one; kNoMirror: there is none.
  int mirror = kNoMirror;
  std::uint8_t odd = 0;  // bit k: coordinate k changes its sign in the mirror
  std::string origin;    // where bodies come from: "from below"
  /// By coordinate, from and to: of its only state where no entry was seen.
  std::array<std::array<double, 2>, kMostCoordinates> usual{};

  [[nodiscard]] bool is_odd(std::size_t coordinate) const { return (odd >> coordinate & 1) != 0; }
  /// The same one, whatever is usual there.
  friend bool operator==(const Face& a, const Face& b) {
    return a.name == b.name && a.di_x == b.di_x && a.di_y == b.di_y && a.mirror == b.mirror &&
           a.odd == b.odd && a.origin == b.origin;
  }
};

/// Entries at a face that go by a name, from and to a place there: those of one state, where states
/// are kinds of things rather than places and speeds.
struct NamedEntries {
  int face = 0;
  double from = 0.0, to = 0.0;
  std::string name;
  int number = 0;  // among all that have names: theirs in the table that names them, from 0
};

/// The surface of section that all cells of a field share: entries are points on it.
struct Section {
  std::vector<Face> faces;              // 1 to kMostFaces
  std::vector<Coordinate> coordinates;  // 1 to kMostCoordinates
  std::vector<CostInfo> costs;          // up to kMostCosts
  std::vector<NamedEntries> named{};    // by face and place, no two overlap; mostly none

  /// Throws std::invalid_argument unless there are as many as that, all of a kind have different
  /// names (costs: keys), faces lead somewhere and are the mirror images of their mirror images (or
  /// have none),
  /// and scales are finite and > 0.
  void validate() const;
  /// The same one, whatever names its entries go by.
  friend bool operator==(const Section& a, const Section& b) {
    return a.faces == b.faces && a.coordinates == b.coordinates && a.costs == b.costs;
  }
};
/// The name that an entry goes by; empty where it has none.
[[nodiscard]] std::string name_of(const Section& section, const Entry& entry);

/// The names of faces or coordinates: "EN, RD, LD".
template <class Named>
[[nodiscard]] std::string names_of(const std::vector<Named>& all,
                                   const std::string& between = ", ") {
  std::string text;
  for (const Named& one : all) text += (text.empty() ? "" : between) + one.name;
  return text;
}
/// What their numbers in files mean: "0 EN, 1 RD, 2 LD".
template <class Named>
[[nodiscard]] std::string numbers_of(const std::vector<Named>& all) {
  std::string text;
  for (std::size_t i = 0; i < all.size(); ++i)
    text += (i > 0 ? ", " : "") + std::to_string(i) + " " + all[i].name;
  return text;
}

/// The face's usual ranges, for a state where no entry was seen. Throws std::invalid_argument
/// naming the face where it has none.
[[nodiscard]] const std::array<std::array<double, 2>, kMostCoordinates>& usual_at(
    const Section& section, const Face& face);

/// Gives each face its mirror image: the one that is `named` (by face, else kNoMirror), else the
/// face itself where its move does not go sideways, else the only face with the mirrored move. Of
/// cells that are not `symmetric`, which need none, faces that do not fit have none.
void set_mirrors(std::vector<Face>& faces, const std::vector<int>& named, bool symmetric);

/// The mirror image, left for right; of face kNoMirror where there is none.
[[nodiscard]] Entry mirrored(const Section& section, const Entry& entry);

/// What stands where in a field: enough for pools, chains and predictions.
struct CellMap {
  struct Type {
    bool symmetric = false;  // mirror images of its passages are passages through it
  };
  Section section;
  std::vector<Type> types;
  int columns = 0;                // 0: the first type everywhere
  std::vector<int> type_of_cell;  // (rows x columns) of types

  [[nodiscard]] int type_of(int column, int row) const {
    return type_of_cell.empty() ? 0
                                : type_of_cell[static_cast<std::size_t>(row * columns + column)];
  }
  /// Throws std::invalid_argument unless types are given for a field of this size, or one for all.
  void require_fits(int field_columns, int field_rows) const;
};

}  // namespace gatewalk::dynamics
