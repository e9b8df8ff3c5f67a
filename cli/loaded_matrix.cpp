// SPDX-License-Identifier: MIT
#include "cli/loaded_matrix.h"

#include "lattice/cells/cell_matrix.h"
#include "lattice/pool/tree_chain.h"
#include "lattice/scene/matrix.h"
#include "lattice/scene/scene_problem.h"

namespace gatewalk::cli {

LoadedMatrix load_matrix(const std::string& path) {
  LoadedMatrix loaded{
      .path = path,
      .file = std::make_shared<const lattice::MatrixFile>(lattice::read_any_matrix(path))};
  if (loaded.file->text.contains(lattice::kCellText)) return loaded;
  loaded.scene = lattice::own_scene(*loaded.file, path);
  if (lattice::has_runs(*loaded.file))
    loaded.pool = lattice::pool_of(*loaded.file, lattice::problem_of(*loaded.scene), path);
  return loaded;
}

}  // namespace gatewalk::cli
