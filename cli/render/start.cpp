#include "cli/render/start.h"

#include <algorithm>
#include <charconv>
#include <sstream>

#include "cli/render/json.h"
#include "cli/render/text.h"

namespace gatewalk::cli {

Json to_json(const lattice::PaperStart& start) {
  return {{"d_m", start.d}, {"vx_m_per_s", start.vx}, {"vy_m_per_s", start.vy}};
}

Json to_json(const dynamics::Section& section, const dynamics::Entry& entry) {
  Json json = Json::object();
  if (entry.face != 0) json["face"] = section.faces[static_cast<std::size_t>(entry.face)].name;
  for (std::size_t axis = 0; axis < section.coordinates.size(); ++axis)
    json[section.coordinates[axis].key] = entry.at[axis];
  return json;
}

std::string title_of(const dynamics::Section& section, const dynamics::Entry& entry) {
  std::ostringstream title;
  title << "start";
  if (entry.face != 0) title << " " << section.faces[static_cast<std::size_t>(entry.face)].name;
  for (std::size_t axis = 0; axis < section.coordinates.size(); ++axis) {
    const dynamics::Coordinate& c = section.coordinates[axis];
    title << (axis > 0 ? ", " : " ") << c.name << " " << entry.at[axis]
          << dynamics::behind_number(c.unit);
  }
  return title.str();
}

StartTexts::StartTexts(const std::vector<lattice::PaperStart>& starts) : texts(starts.size()) {
  struct TextColumn {
    const char* name;
    double lattice::PaperStart::*value;
    int width;  // at least
  };
  for (const auto& [name, value, least] :
       {TextColumn{"d", &lattice::PaperStart::d, 4}, TextColumn{"vx", &lattice::PaperStart::vx, 5},
        TextColumn{"vy", &lattice::PaperStart::vy, 5}}) {
    std::vector<std::string> numbers;
    int width = least;
    for (const lattice::PaperStart& s : starts) {
      char digits[32];
      const auto end =
          std::to_chars(digits, digits + sizeof digits, s.*value + 0.0).ptr;  // -0 is 0
      numbers.emplace_back(digits, end);
      const int gap = least > 4 ? 2 : 1;
      width = std::max(width, static_cast<int>(numbers.back().size()) + gap);
    }
    header += padded(name, width);
    for (std::size_t k = 0; k < starts.size(); ++k) texts[k] += padded(numbers[k], width);
  }
}

Json to_json(const lattice::ChainStart& start, const dynamics::StateSpace& space) {
  return {{"input", start.start.input + 1},
          {"counted_from", 1},
          {"bin", text_of(space.section(), space.range(start.start.input))},
          {"clamped", start.clamped}};
}

std::string start_text(const lattice::PaperStart& s) { return StartTexts({s}).texts.front(); }

}  // namespace gatewalk::cli
