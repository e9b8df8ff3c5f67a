#include "cli/walked.h"

#include "cli/arguments.h"
#include "cli/render/json.h"
#include "cli/render/matrix.h"
#include "cli/render/text.h"
#include "lattice/pool/tree_chain.h"

namespace gatewalk::cli {

Walked walked_chain(const Options& options, Subject& s) {
  if (s.is_recorded()) {
    const auto kernel = lattice::kernel_of(s.problem.map(), *s.pool, s.how.per_leaf);
    const int row = kernel.space.size();  // of the start, behind those of the kernel
    return {lattice::chain_of(
                kernel, s.problem.map(), s.problem.field,
                {lattice::first_row(kernel, s.problem.map(), *s.pool,
                                    s.pool->begin(s.starts.front()), s.problem.start_type())}),
            {s.problem.field.start_column(), 0, row},
            to_json(s.problem.map().section, s.starts.front()),
            title_of(s.problem.map().section, s.starts.front())};
  }
  lattice::SceneMatrix m = s.matrix();
  add_starts_to(m, s.path, options, s.entries());
  const dynamics::Transitions& t = m.file.transitions;
  const lattice::ChainStart start = ready_start(options, m, s.entries().front(), "the start");
  return {lattice::make_chain(s.problem.map(), lattice::matrices_of(m.file, m.scene)), start.start,
          to_json(start, t.space), text_of(t.space.section(), t.space.range(start.start.input)),
          t.health.clean()};
}

}  // namespace gatewalk::cli
