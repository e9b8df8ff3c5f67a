// SPDX-License-Identifier: MIT
#include "cli/render/rare.h"

#include <fmt/core.h>

#include "cli/arguments.h"
#include "cli/fields/text.h"
#include "cli/render/health.h"
#include "cli/source_options.h"
#include "lattice/study/trials.h"

namespace gatewalk::cli {
namespace {

/// The problem with so many rows, and no limit of gates.
lattice::Problem up_to_row(const lattice::Source& s, int row) {
  return s.scene ? lattice::problem_of(lattice::up_to_row(*s.scene, row))
                 : lattice::up_to_row(s.problem, row);
}

}  // namespace

int run_rare(const Arguments& arguments) {
  Options options(
      "rare SCENE [options]",
      "The chance that a body enters a far row of a field without limit of gates, however small: "
      "full trials of the\n"
      "dynamics, split into more bodies where they get far (importance splitting). How far a body "
      "is, a chain says\n"
      "that some gate runs make first; the estimate is unbiased whatever it says. Beside it stands "
      "the chain's own\n"
      "answer.",
      "gatewalk rare scenes/field.toml --row 20 --json rare.json");
  const TextOption path = options.scene();
  const CountOption row =
      options.add_count("row", "N",
                        "the row to enter, counted from 0 (default: one behind the field's "
                        "last: the field is crossed); at most the rows of a terrain");
  const NumberOption accuracy =
      options.add_number("accuracy", "R", "relative standard error to reach (default: 0.05)");
  const CountOption gate_runs = options.add_count(
      "gate-runs", "N",
      "at most so many gate runs, about (default: 2e7, and 100 000 trials as long as "
      "nobody gets there)");
  const CountOption trials =
      options.add_count("trials", "N", "also run N trials directly, to compare");
  const CountOption split_trials = options.add_count(
      "split-trials", "N", "exactly N split trials, whatever the accuracy (parts need it)");
  options.add_seed();
  options.add_kept({"split trials", "field trials"});
  options.add_strict();
  const AskedProgram program = add_cell_program(options);
  options.add_figure("the chance of every row up to N");
  if (!options.parse(arguments)) return kFine;
  lattice::SplittingOptions how{.accuracy = accuracy ? accuracy.value() : 0.05,
                                .seed = options.seed()};
  if (trials) (void)trials.value();  // they are run last
  if (split_trials) how.trials = split_trials.value(2);
  if (options.shard && !how.trials)
    throw UsageError("--shard needs --split-trials N: a part must know how many there are in all");
  if (gate_runs) {
    how.most_runs = gate_runs.value(1000);
    how.most_in_vain = how.most_runs;
  }
  if (!(how.accuracy > 0.0 && how.accuracy < 1.0))
    throw UsageError("--accuracy: must lie between 0 and 1");
  lattice::Source source =
      open_source(options, {.path = path, .program = program, .accuracy = {accuracy, gate_runs}});
  if (source.file)
    throw UsageError(source.path + ": is a matrix, and new bodies are to be run: give a scene");
  how.row = row ? static_cast<int>(row.value(1, 10001)) : source.problem.field.rows;
  if (source.scene) (void)lattice::up_to_row(*source.scene, how.row);  // refuses before a pilot
  choose_method(options, source);
  const lattice::Problem deep = up_to_row(source, how.row);
  RareResult result{.event = lattice::rare_event(deep, how, options.work()),
                    .direct = {},
                    .method = lattice::settled_of(source),
                    .made_by = options.provenance(source)};
  if (trials)
    result.direct = lattice::direct_rows(deep, trials.value(), options.seed(), options.work());
  options.work().end_part();

  options.give_out(result, table_of(result, source.problem.field));
  if (const lattice::Splitting& s = result.event.splitting; !(s.rows.back().probability > 0.0))
    options.warn(
        fmt::format("none of {} trials entered row {}; --gate-runs N goes on for so many gate runs",
                    s.trials, how.row));
  else if (!s.reached && !how.trials)
    options.warn(
        fmt::format("the relative standard error of {} was not reached with {} gate runs; "
                    "--gate-runs allows more",
                    digits(how.accuracy), how.most_runs));
  const int exit = status_of(options, result.event.splitting.health);
  options.draw([&] { return figure_of(result); });
  return exit;
}

}  // namespace gatewalk::cli
