// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include "cli/arguments.h"
#include "cli/commands/recorded.h"
#include "cli/render/halves.h"
#include "cli/subject.h"

namespace gatewalk::cli {

int validate_recorded(const Options& options) {
  const std::string path = options.text("scene");
  refuse(options,
         {"matrix", "matrix-trials", "observed", "trials", "walks", "accuracy", "gate-runs",
          "start", "bins", "memory", "strict", "shard", "part", "checkpoint", "resume", "max-time"},
         fmt::format("for {}, of whose bodies one half is held against the other", path));
  const Subject s = open_subject(options, "scene");
  if (s.foreign)
    throw UsageError(path +
                     ": is a chain that was made elsewhere: there are no trials to hold it "
                     "against, and no bodies whose steps could be told apart");
  if (s.pool->scattered.each.bodies.empty())
    throw UsageError(path + ": its runs were not recorded: --cell-program says who makes more");
  lattice::HalvesOptions how{.null_draws = {}, .seed = options.seed(), .per_leaf = s.how.per_leaf};
  if (options.has("null-draws")) how.null_draws = options.count("null-draws", 1, 100'000);
  const HalvesResult result{
      .halves = lattice::validate_halves(s.problem, *s.pool, how, options.work()),
      .memory = lattice::body_memory(s.problem, *s.pool, how.per_leaf, how.null_draws.value_or(999),
                                     how.seed),
      .section = s.problem.map().section,
      .recorded = counts_of(*s.pool),
      .made_by = s.provenance(options)};
  constexpr std::int64_t kChecked = 200;  // results/tracks
  if (s.pool->bodies() < kChecked)
    options.warn(fmt::format("these are {} bodies: of fewer than {} p may come out too small",
                             s.pool->bodies(), kChecked));
  options.give_out(result, table_of(result) + table_of(*s.pool));
  for (const std::string& rest : rest_warnings(result.halves)) options.warn(rest);
  options.draw([&] { return figure_of(result.halves, s.shown()); });
  return kFine;
}

}  // namespace gatewalk::cli
