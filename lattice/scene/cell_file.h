// SPDX-License-Identifier: MIT
#pragma once
/// cell.toml: cells that are not ours, recorded or carried out by another program: their section,
/// which types there are, and the field that is to be predicted.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dynamics/cells/section.h"
#include "lattice/field/field_params.h"
#include "lattice/scene/scene.h"

namespace gatewalk::lattice {

class TomlFile;

struct CellFile {
  std::string source;              // the file it came from
  dynamics::CellMap map;           // section, types, which stands where
  std::vector<std::string> types;  // names, by map.types; the first one is everywhere without a map
  /// By coordinate: a scale was given; the others have that of what was seen (scale 1 until then).
  std::vector<bool> has_scale;
  double width = 0.0, length = 0.0;       // m, of a cell
  std::optional<double> trapped_after{};  // s
  FieldParams field;
  bool has_field = false;                  // its columns and rows were given
  std::optional<dynamics::Entry> start{};  // none: everything that was seen to enter first
  /// Table [actions]: what a body may do, numbers of the program ("parameters.KEY") that are other
  /// while it does. By name.
  std::vector<Terrain::Type> actions{};
};

/// Reads `path`, applies `overrides` ("field.rows=5") as for a scene. Throws SceneError naming
/// file, line, key and what is allowed.
[[nodiscard]] CellFile read_cell_file(const std::string& path,
                                      const std::vector<std::string>& overrides = {});
/// The same of a file that is open already.
[[nodiscard]] CellFile read_cell_file(const TomlFile& file,
                                      const std::vector<std::string>& overrides = {});
/// The same of text already in memory; `name` stands for the file in messages.
[[nodiscard]] CellFile parse_cell_file(std::string_view text, const std::string& name,
                                       const std::vector<std::string>& overrides = {});
/// The complete file, every key in a fixed order; numbers with the digits that read back the same.
[[nodiscard]] std::string to_toml(const CellFile& file);

}  // namespace gatewalk::lattice
