// SPDX-License-Identifier: MIT
// A map of terrain as a table, for a field of 4 x 3 gates.
#include "lattice/scene/scene.h"
#include "tests/fuzz/fuzz.h"

namespace gatewalk::fuzz {

void terrain_csv(std::string_view bytes) {
  const std::string text =
      "[field]\ncolumns = 4\nrows = 3\n[terrain]\nmap_file = \"" + file_of(bytes, ".csv") +
      "\"\n[terrain.types.s]\nforces.propulsion_N = 5.0\n[terrain.types.stiff]\n"
      "forces.propulsion_N = 6.0\n";
  const auto scene = accepted([&] { return lattice::parse_scene(text, "x.toml"); });
  if (!scene) return;
  require(scene->terrain && scene->terrain->type_of_cell.size() == 12, "every gate has a type");
  const lattice::Scene again = lattice::parse_scene(lattice::to_toml(*scene), "again.toml");
  require(again.terrain && again.terrain->type_of_cell == scene->terrain->type_of_cell,
          "a map printed and read is the same");
}

}  // namespace gatewalk::fuzz
