// SPDX-License-Identifier: MIT
#include "cli/commands/recorded.h"

#include <fmt/core.h>

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "cli/arguments.h"
#include "cli/render/health.h"
#include "cli/render/matrix.h"
#include "cli/render/recorded.h"
#include "cli/render/states.h"
#include "cli/render/version.h"
#include "cli/subject.h"
#include "lattice/cells/cell_matrix.h"

namespace gatewalk::cli {

void add_cell(Options& options) {
  options.input_file("cell",
                     "SCENE is a table of recorded runs (runs.csv) through cells as this file "
                     "(cell.toml) says: lattice/cells/README.md");
}

namespace {

/// Writes the file of these matrices and runs, and says what was made.
void give_out(const Options& options, std::vector<dynamics::Transitions> matrices,
              const lattice::CellFile& cells, const lattice::RunPool& pool,
              const StateRecord& states, const std::optional<dynamics::Health>& health,
              const char* title) {
  std::map<std::string, std::string> text{{"title", title},
                                          {"state_space", attribute_of(states)},
                                          {"program", std::string("gatewalk ") + kVersion},
                                          {"commit", kCommit},
                                          {"command", options.canonical()}};
  if (health) text["status"] = attribute_of(*health);
  const std::string path = options.text("output");
  CellMatrixResult built{
      {path, lattice::cell_matrix_file(std::move(matrices), cells, pool, std::move(text))},
      counts_of(pool),
      options.provenance()};
  built.made_by.cell = lattice::to_toml(cells);
  options.keep_old(path);
  lattice::write_matrix(path,
                        std::move(built.matrix.file));  // takes the arrays, which no one shows
  options.give_out(built, summary_table(built.matrix.file, path) + table_of(pool));
}

}  // namespace

int build_recorded(const Options& options) {
  refuse(options,
         {"accuracy", "gate-runs", "starts", "start", "states", "trials", "first-trial", "bins",
          "strict", "shard", "part", "checkpoint", "resume", "max-time"},
         "for recorded runs");
  lattice::CellFile cells = lattice::read_cell_file(options.text("cell"), options.overrides());
  lattice::RecordedRuns runs = lattice::read_runs(options.text("scene"), cells);
  for (const std::string& text : runs.remarks) options.warn(options.text("scene") + ": " + text);
  const auto unknown = runs.unknown;
  const lattice::RunPool pool = lattice::pool_of(std::move(runs));
  const lattice::Problem problem = lattice::problem_of(cells, pool);
  for (const std::string& text : doubts(pool, problem)) options.warn(text);
  if (const std::string text = far_from_faces(pool, problem); !text.empty()) options.warn(text);
  const auto& costs = problem.map().section.costs;
  for (std::size_t c = 0; c < costs.size(); ++c)
    if (unknown[c] > 0)
      options.warn(fmt::format("{} is blank in {} passages: analyze gives none of it", costs[c].key,
                               unknown[c]));
  auto matrices = lattice::cell_matrices(problem, pool, dynamics::kEntriesPerLeaf);
  const StateRecord states{.kind = "tree",
                           .states = matrices.front().space.size(),
                           .trees = TreeRecord{.gate_runs = pool.gate_runs()}};
  give_out(options, std::move(matrices), cells, pool, states, {},
           "gatewalk counts of passages through recorded cells");
  return kFine;
}

int build_program(const Options& options) {
  refuse(options, {"cell", "first-trial", "bins", "starts"},
         "for cells that another program carries out");
  const Subject s = open_program(options, options.text("scene"));
  if (s.file) throw UsageError(s.path + ": is a matrix already");
  lattice::TreeOptions how{.accuracy = s.how, .starts = s.entries()};
  if (options.has("states"))
    how.most_states = static_cast<int>(options.count("states", 1, dynamics::kMostStates));
  fix_trials(options, how.accuracy, std::ssize(how.starts));
  lattice::TreeChain chain = lattice::make_tree_chain(s.problem, how, options.work());
  const dynamics::Health health = chain.transitions.front().health;
  const StateRecord states = record_of(chain, s.how.accuracy);
  give_out(options, std::move(chain.transitions), *s.cells, chain.pool, states, health,
           "gatewalk counts of passages through cells that another program carries out");
  warn_of(options, chain.own_trials);
  if (!how.accuracy.trials) warn_of(options, *chain.prediction, s.how.accuracy);
  return status_of(options, health);
}

}  // namespace gatewalk::cli
