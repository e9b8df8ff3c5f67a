// SPDX-License-Identifier: MIT
#pragma once
/// Which gate of a field is of which type, marked in maps.

#include <string>
#include <vector>

#include "cli/render/figure.h"
#include "cli/render/final_gates.h"
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

  /// For `plot`: its data, to be defined before, and what it adds behind a map whose gates are so
  /// many points wide and high; both empty where gates are too small for marks. `tag` tells the
  /// data of one map from another's.
  struct Drawn {
    std::string data, plot;
    bool fits = false;  // there is room for them
  };
  [[nodiscard]] Drawn on(const FieldMap& map, double width, double height,
                         const std::string& tag) const;

  /// Height of the legend, 0 for none, and the legend from this height on; until "unset label".
  /// `marked`: whether a map had room for marks.
  [[nodiscard]] double legend_height() const;
  [[nodiscard]] std::string legend(const Sheet& sheet, double top, bool marked) const;

 private:
  struct Entry {
    std::string name;
    double left, top;  // in the legend
  };
  dynamics::CellMap map_;
  std::vector<Entry> entries_;  // the title, then a type each, the scene's own last
};

}  // namespace gatewalk::cli
