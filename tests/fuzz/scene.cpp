// SPDX-License-Identifier: MIT
// A scene, and behind a line "---" overrides, a line each.
#include "lattice/scene/scene.h"

#include <vector>

#include "lattice/scene/scene_keys.h"
#include "lattice/scene/study/sweep.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/large_field.h"

namespace gatewalk::fuzz {

void scene(std::string_view bytes) {
  const std::string_view text = parted(bytes).first;
  std::string_view rest = parted(bytes).second;
  std::vector<std::string> overrides;
  while (!rest.empty()) overrides.emplace_back(take_line(rest));
  for (const std::string& given : overrides)
    (void)accepted([&] { return lattice::keys_set_by(given); });
  if (has_large_field(text, overrides)) return;
  const auto scene = accepted([&] { return lattice::parse_scene(text, "x.toml", overrides); });
  if (!scene) return;
  const std::string printed = lattice::to_toml(*scene);
  const lattice::Scene again = lattice::parse_scene(printed, "again.toml");
  require(lattice::to_toml(again) == printed, "a scene printed and read prints the same");
  require(lattice::physics_differences(*scene, again).empty(), "and has the same physics");
  require(!lattice::describe(*scene).empty(), "its keys are described");
  (void)accepted([&] { return lattice::sweep_axes(scene->sweep, {}); });
}

}  // namespace gatewalk::fuzz
