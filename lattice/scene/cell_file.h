// SPDX-License-Identifier: MIT
#pragma once
/// cell.toml: cells that are not gates, recorded or simulated by another program. The file has
/// their section, their types, and the field to predict.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dynamics/cells/section.h"
#include "lattice/field/field_params.h"
#include "lattice/scene/scene.h"

namespace gatewalk::lattice {

class TomlFile;

/// The contents of a cell file.
struct CellFile {
  std::string source;     // the file's name
  dynamics::CellMap map;  // section, types, and which type stands where
  /// Names, by map.types; without a map the first one stands everywhere.
  std::vector<std::string> types;
  /// By type: bit f is set if nothing crosses the border at face f, neither way.
  std::vector<std::uint64_t> walls;
  /// By coordinate: true if the file gives a scale. Other coordinates get the scale of the entries
  /// seen (1 until then).
  std::vector<bool> has_scale;
  double width = 0.0, length = 0.0;       // of a cell, m
  std::optional<double> trapped_after{};  // s
  FieldParams field;
  bool has_field = false;                  // true if the file gives columns and rows
  std::optional<dynamics::Entry> start{};  // nullopt: all observed first entries
  /// Table [actions]: each action of a body, as the program's numbers ("parameters.KEY") that
  /// differ during the action; in the order of their names.
  std::vector<Terrain::Type> actions{};

  [[nodiscard]] bool has_walls() const;
};

/// Reads the file `path` and applies `overrides` ("field.rows=5"), as for a scene. Throws
/// SceneError naming file, line, key and what is allowed.
[[nodiscard]] CellFile read_cell_file(const std::string& path,
                                      const std::vector<std::string>& overrides = {});
/// Reads a cell file that is already open. Throws SceneError.
[[nodiscard]] CellFile read_cell_file(const TomlFile& file,
                                      const std::vector<std::string>& overrides = {});
/// Reads a cell file from text in memory; `name` stands for the file in messages. Throws
/// SceneError.
[[nodiscard]] CellFile parse_cell_file(std::string_view text, const std::string& name,
                                       const std::vector<std::string>& overrides = {});
/// The complete file as TOML, every key in a fixed order. Numbers have the digits that read back as
/// the same number.
[[nodiscard]] std::string to_toml(const CellFile& file);

}  // namespace gatewalk::lattice
