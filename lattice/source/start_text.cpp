// SPDX-License-Identifier: MIT
#include "lattice/source/start_text.h"

#include <fmt/core.h>

#include <cmath>
#include <stdexcept>
#include <string_view>

#include "dynamics/cells/state_space.h"
#include "lattice/text/digits.h"

namespace gatewalk::lattice {

std::optional<dynamics::Entry> start_in(const std::string& text, const dynamics::Section& section,
                                        StartsBy by) {
  const bool seen = by == StartsBy::any_face_or_seen;
  if (seen && text == "seen") return {};
  const auto wrong = [&] {
    std::string units;
    for (const dynamics::Coordinate& c : section.coordinates)
      units += (units.empty() ? "" : ", ") + (c.unit == "m s-1" ? "m/s" : c.unit);
    return std::invalid_argument(
        fmt::format("--start {}: must be {}{} numbers {} ({}), behind a face {} and a colon unless "
                    "it is the first",
                    text, seen ? "seen, or " : "", section.coordinates.size(),
                    names_of(section.coordinates, ","), units, names_of(section.faces, " or ")));
  };
  dynamics::Entry entry;
  std::string_view rest = text;
  if (const std::size_t colon = text.find(':'); colon != text.npos) {
    while (entry.face < std::ssize(section.faces) &&
           section.faces[static_cast<std::size_t>(entry.face)].name != rest.substr(0, colon))
      ++entry.face;
    if (entry.face == std::ssize(section.faces)) throw wrong();
    rest.remove_prefix(colon + 1);
  }
  for (std::size_t axis = 0; axis < section.coordinates.size(); ++axis) {
    if (axis > 0 && !take_mark(rest, ',')) throw wrong();
    const auto number = take_number(rest);
    if (!number || !std::isfinite(*number)) throw wrong();
    entry.at[axis] = *number;
  }
  if (!rest.empty()) throw wrong();
  return entry;
}

std::string title_of(const dynamics::Section& section,
                     const std::optional<dynamics::Entry>& start) {
  if (!start) return "start: all entries that were seen first";
  if (const std::string name = name_of(section, *start); !name.empty()) return "start " + name;
  std::string title = "start";
  if (start->face != 0) title += " " + section.faces[static_cast<std::size_t>(start->face)].name;
  for (std::size_t axis = 0; axis < section.coordinates.size(); ++axis) {
    const dynamics::Coordinate& c = section.coordinates[axis];
    title += fmt::format("{}{} {}{}", axis > 0 ? ", " : " ", c.name, rounded(start->at[axis]),
                         dynamics::behind_number(c.unit));
  }
  return title;
}

}  // namespace gatewalk::lattice
