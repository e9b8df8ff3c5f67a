// SPDX-License-Identifier: MIT
#include "dynamics/cells/section.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "dynamics/cells/words.h"

namespace gatewalk::dynamics {
namespace {

/// Whether face f and its mirror face are mirror images of each other.
bool are_images(const std::vector<Face>& faces, std::size_t f) {
  const Face &face = faces[f], &image = faces[static_cast<std::size_t>(face.mirror)];
  return image.mirror == static_cast<int>(f) && image.odd == face.odd && image.di_x == -face.di_x &&
         image.di_y == face.di_y;
}

}  // namespace

void CostSums::add(const Costs& costs) {
  for (std::size_t c = 0; c < kMostCosts; ++c) {
    sum[c] += costs[c];
    squares[c] += costs[c] * costs[c];
  }
}
CostSums& CostSums::operator+=(const CostSums& other) {
  for (std::size_t c = 0; c < kMostCosts; ++c) {
    sum[c] += other.sum[c];
    squares[c] += other.squares[c];
  }
  return *this;
}

void Section::validate() const {
  const auto refuse = [](const std::string& what) {
    throw std::invalid_argument("section: " + what);
  };
  const std::size_t most_faces = words ? Words::kMostLabels : kMostFaces;
  if (faces.empty() || faces.size() > most_faces)
    refuse(std::to_string(faces.size()) + " faces are not permitted: must be 1 to " +
           std::to_string(most_faces));
  if (coordinates.empty() || coordinates.size() > kMostCoordinates)
    refuse(std::to_string(coordinates.size()) + " coordinates are not permitted: must be 1 to " +
           std::to_string(kMostCoordinates));
  if (costs.size() > kMostCosts)
    refuse(std::to_string(costs.size()) + " costs are not permitted: must be at most " +
           std::to_string(kMostCosts));
  const auto require_names = [&](const auto& all, auto name, const std::string& what) {
    std::set<std::string_view> before;
    for (const auto& one : all) {
      if ((one.*name).empty()) refuse("a " + what + " has no name");
      if (!before.insert(one.*name).second) refuse("two " + what + "s are named " + one.*name);
    }
  };
  require_names(faces, &Face::name, "face");
  require_names(coordinates, &Coordinate::name, "coordinate");
  require_names(costs, &CostInfo::key, "cost");
  for (int f = 0; f < std::ssize(faces); ++f) {
    const Face& face = faces[f];
    if (face.di_x == 0 && face.di_y == 0) refuse("face " + face.name + " leads nowhere");
    if (face.odd >> coordinates.size() != 0)
      refuse("face " + face.name + " has an odd coordinate that is none");
    if (face.mirror == kNoMirror) continue;
    if (face.mirror < 0 || face.mirror >= std::ssize(faces))
      refuse("face " + face.name + " has no mirror image");
    if (!are_images(faces, static_cast<std::size_t>(f)))
      refuse("face " + face.name + " is not the mirror image of " + faces[face.mirror].name);
  }
  for (const Coordinate& c : coordinates)
    if (!(std::isfinite(c.scale) && c.scale > 0.0))
      refuse("the scale of coordinate " + c.name + " must be finite and > 0");
}

std::string name_of(const Section& section, const Entry& entry) {
  const auto behind = std::upper_bound(
      section.named.begin(), section.named.end(), entry, [](const Entry& e, const NamedEntries& n) {
        return std::pair(e.face, e.at[0]) < std::pair(n.face, n.from);
      });
  if (behind == section.named.begin()) return "";
  const NamedEntries& named = *std::prev(behind);
  return named.face == entry.face && entry.at[0] <= named.to ? named.name : "";
}

const std::array<std::array<double, 2>, kMostCoordinates>& usual_at(const Section& section,
                                                                    const Face& face) {
  for (std::size_t axis = 0; axis < section.coordinates.size(); ++axis)
    if (!(face.usual[axis][0] < face.usual[axis][1]))
      throw std::invalid_argument("section: nothing was seen to enter by face " + face.name +
                                  ", and no usual range of " + section.coordinates[axis].name +
                                  " is given there");
  return face.usual;
}

void set_mirrors(std::vector<Face>& faces, const std::vector<int>& named, bool symmetric) {
  for (std::size_t f = 0; f < faces.size(); ++f) {
    std::vector<int> images;
    for (std::size_t other = 0; other < faces.size(); ++other)
      if (faces[other].di_x == -faces[f].di_x && faces[other].di_y == faces[f].di_y)
        images.push_back(static_cast<int>(other));
    faces[f].mirror = named[f] != kNoMirror ? named[f]
                      : faces[f].di_x == 0  ? static_cast<int>(f)
                      : images.size() == 1  ? images.front()
                                            : kNoMirror;
  }
  if (symmetric) return;
  const std::vector<Face> all = faces;
  for (std::size_t f = 0; f < faces.size(); ++f)
    if (all[f].mirror != kNoMirror && !are_images(all, f)) faces[f].mirror = kNoMirror;
}

Entry mirrored(const Section& section, const Entry& entry) {
  const Face& face = section.faces[entry.face];
  Entry image{face.mirror, entry.at};
  for (std::size_t axis = 0; axis < section.coordinates.size(); ++axis)
    if (face.is_odd(axis)) image.at[axis] = -entry.at[axis];
  return image;
}

void CellMap::require_fits(int field_columns, int field_rows) const {
  if (type_of_cell.empty()) return;
  if (columns != field_columns || std::ssize(type_of_cell) != std::int64_t{columns} * field_rows)
    throw std::invalid_argument("field: types for " + std::to_string(columns) + " columns and " +
                                std::to_string(std::ssize(type_of_cell) / columns) +
                                " rows, the field has " + std::to_string(field_columns) + " and " +
                                std::to_string(field_rows));
}

}  // namespace gatewalk::dynamics
