// SPDX-License-Identifier: MIT
#include "cli/render/start.h"

#include <fmt/core.h>

#include <algorithm>

#include "cli/fields/text.h"
#include "dynamics/disc/disc_section.h"
#include "lattice/field/matrix_file.h"

namespace gatewalk::cli {

namespace {

/// `put` takes the key of a coordinate and its number.
template <class Put>
void describe_entry(Fields& out, const dynamics::Section& of, const dynamics::Entry& entry,
                    std::string_view what, Put put) {
  const dynamics::Section& section = out.is_schema() ? dynamics::disc_section() : of;
  const std::string name = out.is_schema() ? "" : name_of(section, entry);
  out.optional(!name.empty(), [&](Fields& f) {
    f.text({"name", "name of the state in which the body enters, where states have names"}, name);
  });
  out.optional(entry.face != 0, [&](Fields& f) {
    f.text({"face", "face by which the body enters the cell, if not the first face"},
           section.faces[static_cast<std::size_t>(entry.face)].name);
  });
  for (std::size_t axis = 0; axis < section.coordinates.size(); ++axis)
    put(Field(section.coordinates[axis].key, "its own", what).varying("<coordinate>"), axis);
}

}  // namespace

void describe(Fields& out, const dynamics::Section& section, const dynamics::Entry& entry) {
  describe_entry(out, section, entry,
                 "coordinate of the entry, a place or a velocity; the key names the unit",
                 [&](const Field& f, std::size_t axis) { out.number(f, entry.at[axis]); });
}

void describe(Fields& out, const dynamics::Section& section, const dynamics::StateRange& range) {
  describe_entry(out, section, range.middle(),
                 "range of a coordinate of the entries; the key names the unit",
                 [&](const Field& f, std::size_t axis) { out.range(f, range.at[axis]); });
}

void describe_start(Fields& out, const Label& l, const dynamics::Section& section,
                    const std::optional<dynamics::Entry>& start) {
  out.object_or_text(l.shared("start"),
                     start ? std::nullopt : std::optional<std::string>("as seen"),
                     [&](Fields& f) { describe(f, section, start.value_or(dynamics::Entry())); });
}

void describe_start(Fields& out, const dynamics::Section& section,
                    const std::optional<dynamics::Entry>& start) {
  describe_start(
      out,
      {"start",
       "how bodies enter the field; \"as seen\": by all first entries of the recorded runs"},
      section, start);
}

StartTexts::StartTexts(const dynamics::Section& section, const std::vector<dynamics::Entry>& starts)
    : texts(starts.size()) {
  const auto add = [&](const std::string& name, std::size_t least, std::size_t gap,
                       const auto& text_of_start) {
    std::size_t width = std::max(least, name.size() + gap);
    for (const dynamics::Entry& s : starts) width = std::max(width, text_of_start(s).size() + gap);
    header += fmt::format("{:>{}}", name, width);
    for (std::size_t k = 0; k < starts.size(); ++k)
      texts[k] += fmt::format("{:>{}}", text_of_start(starts[k]), width);
  };
  const auto face_of = [&](const dynamics::Entry& s) {
    return section.faces[static_cast<std::size_t>(s.face)].name;
  };
  if (std::any_of(starts.begin(), starts.end(), [](const auto& s) { return s.face != 0; }))
    add("face", 4, 1, face_of);
  for (std::size_t axis = 0; axis < section.coordinates.size(); ++axis)
    add(section.coordinates[axis].name, axis == 0 ? 4 : 5, axis == 0 ? 1 : 2,
        [&](const dynamics::Entry& s) { return digits(s.at[axis] + 0.0, 6); });  // turns -0 into 0
}

ShownState shown_state(const lattice::ChainStart& start, const dynamics::StateSpace& space) {
  const int state = start.start.input;
  return {lattice::shown_number(space, state), text_of(space.section(), space.range(state)),
          start.clamped};
}

void describe(Fields& out, const ShownState& state) {
  out.count({"input", "1",
             "number of the state, from 0; of a start with a state of its own the number of all "
             "other states"},
            state.number);
  out.text({"bin", "face and coordinate ranges of the state, in words"}, state.bin);
  out.flag({"clamped",
            "whether the start lies outside all bins, so that the chain starts in the nearest one"},
           state.clamped);
}

void describe_start_state(Fields& out, const ShownState& state) {
  out.object(Label("start_state", "state of the chain in which bodies start").shared(),
             [&](Fields& f) { describe(f, state); });
}

std::string start_text(const dynamics::Section& section, const dynamics::Entry& start) {
  return StartTexts(section, {start}).texts.front();
}

}  // namespace gatewalk::cli
