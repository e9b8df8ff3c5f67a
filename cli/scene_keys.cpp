// SPDX-License-Identifier: MIT
#include "cli/scene_keys.h"

#include <fmt/core.h>
#include <fmt/format.h>

#include <map>
#include <vector>

#include "cli/fields/text.h"
#include "lattice/scene/scene.h"
#include "lattice/scene/terrain.h"
#include "lattice/text/digits.h"

namespace gatewalk::cli {
namespace {

using lattice::KeyInfo;
using Settings = std::map<std::string, std::string>;  // by key: values as TOML

constexpr const char* kBeginOfPage = R"(# Scenes: the keys

Made by `gatewalk help --write`. A scene is a TOML file with tables such as `[body]`, and keys in them such as
`mass_kg = 0.25`. You may leave out any key. `gatewalk scene FILE` shows all keys of a file with their values,
`gatewalk sample NAME` writes a scene to begin with, and `--set body.mass_kg=0.3` changes a key on the command line.

- **Unit.** A key ends in its unit. It may end in a multiple of this unit: `radius_cm`, `mass_g`,
  `stiffness_left_mNm_per_rad`. The prefixes are k, m, u and n; lengths and speeds take c too.
- **Range.** ( and ) exclude the end. A range with a * depends on other keys; the table shows that of the defaults.
- **Default.** The value in a file that gives neither `body.mass_kg` nor `body.radius_m`. It is that of the paper (Zheng,
  Xuan and Li, 2022).
- **Follows from.** In a file that gives `body.mass_kg` or `body.radius_m`, a key that you leave out follows from these
  keys by the paper's proportions. Without `forces.propulsion_N`, the first of these keys that the file gives sets the
  time scale: `forces.random_N`, a stiffness, `forces.random_rate_Hz`. In every file `contact.impulse_threshold_Ns`,
  `run.step_s` and `run.event_tolerance_m` follow, and `run.traverse_y_m` follows from a given `beams.joint_y_m`.
- **Type.** A dot marks the keys that a type of gate may change (`[terrain.types.NAME]`). An action (`[actions.NAME]`)
  may change them too, except those of `contact`.
)";

constexpr const char* kOtherTables = R"(
## Other tables

| table | keys | meaning |
|---|---|---|
| `[bins]` | `EN_d_m`, `EN_vx_m_per_s`, `EN_vy_m_per_s`; the same for `RD`, `LD`, `RT`, `LT` | the states of a chain of bins: for each boundary of a gate and each coordinate an ascending list of edges |
| `[terrain]` | `map` | which type of gate stands where: a text for each row, the far side first, with a letter for each gate, or names with commas |
| | `map_file` | instead of `map`, a file beside the scene: letters, names with commas, or a picture with a pixel for each gate |
| | `grey` | the grey value of each type in the picture: `{ s = 0, "." = 255 }` |
| | `random`, `seed` | instead of a map, the share of each type, `{ s = 0.3 }`: the type of each gate is drawn at random |
| `[terrain.types.NAME]` | keys with a dot above | a type of gate: the keys in which it differs from the gate of the scene, which is `.` in the map |
| `[actions.NAME]` | keys with a dot above, except `contact` | an action of a body: the values of these keys while it takes the action; an empty table leaves the scene as it is |
| `[sweep]` | any key | values for `gatewalk sweep`: `"4:1:9"` (from, step, to) or a list |
)";

std::vector<KeyInfo> keys_of_scene(const Settings& settings) {
  std::string text;
  for (const auto& [key, value] : settings) text += fmt::format("{} = {}\n", key, value);
  return lattice::describe(lattice::parse_scene(text, "scene"));
}

/// Settings of a scene with its own body and field, from which all other keys follow.
Settings own_body() {
  return {{"body.mass_kg", "1.0"},
          {"body.radius_m", "1.0"},
          {"forces.propulsion_N", "1.0"},
          {"field.columns", "5"},
          {"field.rows", "5"}};
}

/// For each key that follows from others, these other keys.
std::map<std::string, std::vector<std::string>> origins_of_keys() {
  const Settings given = own_body();
  const std::vector<KeyInfo> here = keys_of_scene(given);
  std::map<std::string, std::vector<std::string>> origins;
  for (const KeyInfo& changed : here) {
    if (changed.key.starts_with("field.") || changed.key.starts_with("start.") ||
        changed.key == "run.step_s")
      continue;
    Settings other = given;
    other[changed.key] = changed.value == "\"stable\""
                             ? "\"event\""
                             : fmt::format("{}", 0.9 * lattice::number_of(changed.value));
    const std::vector<KeyInfo> there = keys_of_scene(other);
    for (std::size_t k = 0; k < here.size(); ++k)
      if (here[k].source == "derived" && there[k].source == "derived" &&
          here[k].value != there[k].value)
        origins[here[k].key].push_back(changed.key);
  }
  return origins;
}

/// The range on the page: "> 0" for "(0, 1e+100]", whose upper end limits nobody.
std::string range_on_page(const std::string& range) {
  constexpr std::string_view kNoLimit = ", 1e+100]";
  if (!range.ends_with(kNoLimit)) return range;
  const std::string low = range.substr(1, range.size() - 1 - kNoLimit.size());
  return (range.front() == '(' ? "> " : ">= ") + low;
}

}  // namespace

std::string scene_keys_in_markdown() {
  const std::vector<KeyInfo> keys = keys_of_scene({}), others = keys_of_scene(own_body());
  const auto origins = origins_of_keys();
  std::string page = kBeginOfPage, section;
  for (std::size_t k = 0; k < keys.size(); ++k) {
    const KeyInfo& key = keys[k];
    if (const std::string own = key.key.substr(0, key.key.find('.')); own != section)
      page += fmt::format(
          "\n## {}\n\n| key | unit | range | default | follows from | type | meaning |\n"
          "|---|---|---|---|---|---|---|\n",
          section = own);
    const bool range_follows = key.range != others[k].range;
    std::string from;
    if (const auto found = origins.find(key.key); found != origins.end())
      for (const std::string& other : found->second)
        from += fmt::format("{}`{}`", from.empty() ? "" : ", ", other);
    page += fmt::format("| `{}` | {} | {}{} | {} | {} | {} | {} |\n", key.key, key.unit,
                        range_on_page(key.range), range_follows ? " \\*" : "", key.value, from,
                        lattice::may_differ(key.key) ? "•" : "", key.meaning);
  }
  return page + kOtherTables;
}

}  // namespace gatewalk::cli
