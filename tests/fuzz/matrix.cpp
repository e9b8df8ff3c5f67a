// SPDX-License-Identifier: MIT
// A matrix file as it is: nearly all that is not one is refused by its checksum, before HDF5 sees
// it. matrix_content has what a good checksum lets through.
#include "lattice/scene/matrix.h"

#include <memory>

#include "lattice/pool/tree_chain.h"
#include "lattice/scene/scene_problem.h"
#include "lattice/source/cell_matrix.h"
#include "markov/formats/counts.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/use_matrix.h"

namespace gatewalk::fuzz {

void use_matrix(const std::string& path) {
  const auto file = accepted([&] { return lattice::read_matrix(path); });
  if (!file) return;
  const dynamics::Transitions& t = file->transitions;
  for (std::size_t row = 0; row < t.rows.size(); ++row) {
    std::int64_t sum = 0;
    for (const auto& [column, n] : t.rows[row]) sum += n;
    require(sum == t.trials[row] && t.clamped[row] <= sum, "counts of a row add up to its trials");
  }
  if (file->text.contains(lattice::kCellText)) {
    const auto shared = std::make_shared<const lattice::MatrixFile>(*file);
    (void)accepted([&] { return lattice::cell_matrix(shared, path).problem.field.rows; });
  } else {
    (void)accepted([&] {
      const lattice::Scene scene = lattice::own_scene(*file, path);
      if (lattice::has_runs(*file)) (void)lattice::pool_of(*file, lattice::problem_of(scene), path);
      return lattice::matrices_of(*file, scene).size();
    });
  }
  const std::string again = file_of("", ".again.nc");
  lattice::write_matrix(again, *file);
  const lattice::MatrixFile other = lattice::read_matrix(again);
  require(other.transitions.rows == t.rows && other.transitions.trials == t.trials &&
              other.text == file->text && other.types.size() == file->types.size(),
          "a matrix that was written and read is the same");
}

void matrix(std::string_view bytes) {
  const std::string path = file_of(bytes, ".nc");
  // First without read_matrix, which would look for the fault in a child process.
  if (accepted([&] { return markov::read_counts(path); })) use_matrix(path);
}

}  // namespace gatewalk::fuzz
