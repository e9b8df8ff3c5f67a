// SPDX-License-Identifier: MIT
#include "cli/render/rare.h"

#include <fmt/core.h>

#include "cli/arguments.h"
#include "cli/render/health.h"
#include "cli/render/text.h"
#include "cli/subject.h"
#include "lattice/study/trials.h"

namespace gatewalk::cli {
namespace {

/// How many of so many trials enter the rows; none without --trials.
DirectRows direct_rows(const Options& options, const lattice::Problem& deep, int row) {
  DirectRows direct;
  if (!options.has("trials")) return direct;
  direct.trials = options.trials();
  const dynamics::Stopwatch watch;
  const auto tally =
      lattice::field_trials(deep, {0, direct.trials}, options.seed(), options.work());
  direct.seconds = watch.seconds();
  direct.entered.assign(static_cast<std::size_t>(row),
                        tally.endings[static_cast<std::size_t>(markov::Ending::far_edge)]);
  std::int64_t behind = 0;  // last gates; those of bodies over the far edge are among them
  for (int r = row - 1; r > 0; --r) {
    behind += tally.final_cells.row(r).sum();
    direct.entered[static_cast<std::size_t>(r) - 1] = behind;
  }
  return direct;
}

/// The problem with so many rows, and no limit of gates.
lattice::Problem up_to_row(const Subject& s, int row) {
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
  options.scene();
  options.add_count("row", "N",
                    "the row to enter, counted from 0 (default: one behind the field's "
                    "last: the field is crossed); at most the rows of a terrain");
  options.add_number("accuracy", "R", "relative standard error to reach (default: 0.05)");
  options.add_count("gate-runs", "N",
                    "at most so many gate runs, about (default: 2e7, and 100 000 trials as long as "
                    "nobody gets there)");
  options.add_count("trials", "N", "also run N trials directly, to compare");
  options.add_count("split-trials", "N",
                    "exactly N split trials, whatever the accuracy (parts need it)");
  options.add_seed();
  options.add_kept({"split trials", "field trials"});
  options.add_strict();
  add_cell_program(options);
  options.add_figure("the chance of every row up to N");
  if (!options.parse(arguments)) return kFine;
  lattice::SplittingOptions how{
      .accuracy = options.has("accuracy") ? options.number("accuracy") : 0.05,
      .seed = options.seed()};
  if (options.has("trials")) (void)options.trials();  // they are run last
  if (options.has("split-trials")) how.trials = options.count("split-trials", 2);
  if (options.has("shard") && !how.trials)
    throw UsageError("--shard needs --split-trials N: a part must know how many there are in all");
  if (options.has("gate-runs")) {
    how.most_runs = options.count("gate-runs", 1000);
    how.most_in_vain = how.most_runs;
  }
  if (!(how.accuracy > 0.0 && how.accuracy < 1.0))
    throw UsageError("--accuracy: must lie between 0 and 1");
  Subject subject = open_subject(options, "scene");
  if (subject.file)
    throw UsageError(subject.path + ": is a matrix, and new bodies are to be run: give a scene");
  how.row = options.has("row") ? static_cast<int>(options.count("row", 1, 10001))
                               : subject.problem.field.rows;
  if (subject.scene) (void)lattice::up_to_row(*subject.scene, how.row);  // refuses before a pilot
  subject.settle(options);
  const lattice::Problem deep = up_to_row(subject, how.row);
  RareResult result{.event = lattice::rare_event(deep, how, options.work()),
                    .direct = direct_rows(options, deep, how.row),
                    .method = subject.settled,
                    .made_by = subject.provenance(options)};
  options.work().end_part();

  options.give_out(result, table_of(result, subject.problem.field));
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
