// SPDX-License-Identifier: MIT
#include "cli/render/start.h"

#include <algorithm>
#include <charconv>

#include "cli/render/json.h"
#include "cli/render/text.h"

namespace gatewalk::cli {

namespace {

/// The name that an entry goes by; its face, but the first goes without saying.
Json with_face(const dynamics::Section& section, const dynamics::Entry& entry) {
  Json json = Json::object();
  if (const std::string name = name_of(section, entry); !name.empty()) json["name"] = name;
  if (entry.face != 0) json["face"] = section.faces[static_cast<std::size_t>(entry.face)].name;
  return json;
}

}  // namespace

Json to_json(const dynamics::Section& section, const Start& start) {
  if (!start) return "as seen";
  Json json = with_face(section, *start);
  for (std::size_t axis = 0; axis < section.coordinates.size(); ++axis)
    json[section.coordinates[axis].key] = start->at[axis];
  return json;
}

Json to_json(const dynamics::Section& section, const dynamics::StateRange& range) {
  Json json = with_face(section, range.middle());
  for (std::size_t axis = 0; axis < section.coordinates.size(); ++axis)
    json[section.coordinates[axis].key] = range.at[axis];
  return json;
}

std::string title_of(const dynamics::Section& section, const Start& start) {
  if (!start) return "start: all entries that were seen first";
  if (const std::string name = name_of(section, *start); !name.empty()) return "start " + name;
  std::string title = "start";
  if (start->face != 0) title += " " + section.faces[static_cast<std::size_t>(start->face)].name;
  for (std::size_t axis = 0; axis < section.coordinates.size(); ++axis) {
    const dynamics::Coordinate& c = section.coordinates[axis];
    title += (axis > 0 ? ", " : " ") + c.name + " " + digits(start->at[axis], 6) +
             dynamics::behind_number(c.unit);
  }
  return title;
}

StartTexts::StartTexts(const dynamics::Section& section, const std::vector<dynamics::Entry>& starts)
    : texts(starts.size()) {
  const auto add = [&](const std::string& name, std::size_t least, std::size_t gap,
                       const auto& text_of_start) {
    std::size_t width = std::max(least, name.size() + gap);
    for (const dynamics::Entry& s : starts) width = std::max(width, text_of_start(s).size() + gap);
    header += padded(name, static_cast<int>(width));
    for (std::size_t k = 0; k < starts.size(); ++k)
      texts[k] += padded(text_of_start(starts[k]), static_cast<int>(width));
  };
  const auto face_of = [&](const dynamics::Entry& s) {
    return section.faces[static_cast<std::size_t>(s.face)].name;
  };
  if (std::any_of(starts.begin(), starts.end(), [](const auto& s) { return s.face != 0; }))
    add("face", 4, 1, face_of);
  for (std::size_t axis = 0; axis < section.coordinates.size(); ++axis)
    add(section.coordinates[axis].name, axis == 0 ? 4 : 5, axis == 0 ? 1 : 2,
        [&](const dynamics::Entry& s) {
          char digits[32];
          const auto end =
              std::to_chars(digits, digits + sizeof digits, s.at[axis] + 0.0).ptr;  // -0 is 0
          return std::string(digits, end);
        });
}

Json to_json(const lattice::ChainStart& start, const dynamics::StateSpace& space) {
  return {{"input", lattice::shown_number(space, start.start.input) + 1},
          {"counted_from", 1},
          {"bin", text_of(space.section(), space.range(start.start.input))},
          {"clamped", start.clamped}};
}

std::string start_text(const dynamics::Section& section, const dynamics::Entry& start) {
  return StartTexts(section, {start}).texts.front();
}

}  // namespace gatewalk::cli
