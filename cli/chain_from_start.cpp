// SPDX-License-Identifier: MIT
#include "cli/chain_from_start.h"

#include "cli/arguments.h"
#include "cli/render/matrix.h"
#include "lattice/pool/tree_chain.h"

namespace gatewalk::cli {

StartedChain chain_from_start(const Options& options, lattice::Source& s) {
  if (s.is_recorded() && s.pool) {
    auto kernel = lattice::kernel_of(s.problem.map(), *s.pool, s.accuracy.per_leaf);
    const int row = kernel.space.size();  // the start's row stands behind the kernel's rows
    return {lattice::chain_of(
                kernel, s.problem.map(), s.problem.field,
                lattice::first_rows(kernel, s.problem.map(), *s.pool,
                                    {s.pool->first_row(s.starts.front())}, s.problem.start_type())),
            {s.problem.field.start_column(), s.problem.field.start_row, row},
            std::nullopt,
            true,
            std::move(kernel.space)};
  }
  if (s.scene) {
    lattice::SceneMatrix m = lattice::scene_matrix_of(s);
    add_starts(options, m, s.path, s.entries());
    s.file = std::move(m.file);
  }
  const std::vector<dynamics::Transitions> matrices = s.matrices();
  const dynamics::StateSpace& space = matrices.front().space;
  const lattice::ChainStart start =
      ready_start(options, matrices, s.problem, s.entries().front(), "the start");
  return {lattice::make_chain(s.problem.map(), matrices), start.start, shown_state(start, space),
          s.file->transitions.health.clean(), space};
}

}  // namespace gatewalk::cli
