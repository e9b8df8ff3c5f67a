// SPDX-License-Identifier: MIT
#pragma once
/// Which gate of a field is of which type, marked in maps.

#include <string>
#include <vector>

#include "cli/render/final_gates.h"
#include "cli/render/panel.h"
#include "cli/render/shown_field.h"

namespace gatewalk::cli {

/// By type of gates_of(scene).types(): its names in the terrain, "s/t" where two are alike; empty
/// where there is one.
[[nodiscard]] std::vector<std::string> type_names(const lattice::Scene& scene);

/// A mark in each gate that is not the scene's own, by its type; a legend names them. Nothing where
/// all gates are alike.
class TypeMarks {
 public:
  explicit TypeMarks(const ShownField& shown);

  /// Marks the gates on a panel with this map, above what is drawn there so far; false where gates
  /// are too small for marks. `tag` tells the data of one map from another's.
  bool draw_on(Panels& out, Panel& panel, const FieldMap& map, const std::string& tag) const;

  /// Height of the legend, 0 for none, and the legend from this height on. `marked`: whether a map
  /// had room for marks.
  [[nodiscard]] double legend_height() const;
  void add_legend(Panel& panel, double top, bool marked) const;

 private:
  struct Entry {
    std::string name;
    double left, top;  // in the legend
  };
  dynamics::CellMap map_;
  std::vector<Entry> entries_;  // the title, then a type each, the scene's own last
};

}  // namespace gatewalk::cli
