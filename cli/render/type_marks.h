// SPDX-License-Identifier: MIT
#pragma once
/// Marks in maps that show the types of a field's gates.

#include <string>
#include <vector>

#include "cli/render/final_gates.h"
#include "cli/render/panel.h"
#include "cli/render/shown_field.h"

namespace gatewalk::cli {

/// The names of the types of gates_of(scene).types() in the terrain, "s/t" for equal types; empty
/// if all gates are alike.
[[nodiscard]] std::vector<std::string> type_names(const lattice::Scene& scene);

/// A mark in each gate that is not of the scene's own type, with a legend. Nothing if all gates are
/// alike.
class TypeMarks {
 public:
  explicit TypeMarks(const ShownField& shown);

  /// Marks the gates on a panel with this map, above what is drawn there. Returns false if gates
  /// are too small for marks. `tag` distinguishes the data of several maps.
  bool draw_on(Panels& out, Panel& panel, const FieldMap& map, const std::string& tag) const;

  /// The height of the legend (0: none); and the legend from a height on. `marked`: whether a map
  /// had room for marks.
  [[nodiscard]] double legend_height() const;
  void add_legend(Panel& panel, double top, bool marked) const;

 private:
  struct Entry {
    std::string name;
    double left, top;  // in the legend
  };
  dynamics::CellMap map_;
  std::vector<Entry> entries_;  // the title, then an entry for each type, the scene's own last
};

}  // namespace gatewalk::cli
