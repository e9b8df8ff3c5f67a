// SPDX-License-Identifier: MIT
// A cell file, and behind a line "---" overrides, a line each.
#include "lattice/scene/cell_file.h"

#include <vector>

#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/large_field.h"

namespace gatewalk::fuzz {

void cells(std::string_view bytes) {
  const std::string_view text = parted(bytes).first;
  std::string_view rest = parted(bytes).second;
  std::vector<std::string> overrides;
  while (!rest.empty()) overrides.emplace_back(take_line(rest));
  if (has_large_field(text, overrides)) return;
  const auto cells = accepted([&] { return lattice::parse_cell_file(text, "x.toml", overrides); });
  if (!cells) return;
  cells->map.section.validate();
  const std::string printed = lattice::to_toml(*cells);
  const lattice::CellFile again = lattice::parse_cell_file(printed, "again.toml");
  require(lattice::to_toml(again) == printed, "a cell file printed and read prints the same");
  require(again.map.section == cells->map.section, "and has the same section");
}

}  // namespace gatewalk::fuzz
