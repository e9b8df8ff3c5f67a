// SPDX-License-Identifier: MIT
#pragma once
/// Matrices of rows of a field beside those of its own gates.

#include <string>
#include <vector>

#include "lattice/scene/matrix.h"
#include "lattice/statistics/matrix_noise.h"

namespace gatewalk::lattice {

/// Rows i_y = first to last whose gates are those of another matrix.
struct RowMatrix {
  int first = 0, last = 0;
  std::string path;
  SceneMatrix matrix;
};

/// What the cells of base's field draw from: the matrices of its types of gates, or of these rows'
/// own. Throws std::invalid_argument, whose message begins
/// "--row FIRST-LAST=PATH", when rows lie outside the field or are given twice, or when a matrix
/// has another body, gates of another size or other states than `base`, which is called
/// `base_path`; and when there are rows and the base has a terrain.
[[nodiscard]] CountedField field_of(const SceneMatrix& base, const std::string& base_path,
                                    const std::vector<RowMatrix>& others);

}  // namespace gatewalk::lattice
