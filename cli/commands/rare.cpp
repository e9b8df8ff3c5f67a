// SPDX-License-Identifier: MIT
#include "cli/render/rare.h"
#include "cli/next.h"

#include <fmt/core.h>

#include "cli/arguments.h"
#include "cli/fields/text.h"
#include "cli/render/health.h"
#include "cli/source_options.h"
#include "lattice/study/trials.h"

namespace gatewalk::cli {
namespace {

/// The problem with `row` rows and without a limit of gates.
lattice::Problem up_to_row(const lattice::Source& s, int row) {
  return s.scene ? lattice::problem_of(lattice::up_to_row(*s.scene, row))
                 : lattice::up_to_row(s.problem, row);
}

/// A sentence if the gate runs are too few for the accuracy asked for; else empty.
std::string too_few_runs(const lattice::Splitting& s, const lattice::SplittingOptions& how) {
  if (!(s.rows.back().probability > 0.0))
    return fmt::format("none of {} trials entered row {}; --gate-runs N allows more", s.trials,
                       how.row);
  if (s.reached || how.trials) return "";
  return fmt::format(
      "the relative standard error of {} needs more than {} gate runs; --gate-runs N allows more",
      digits(how.accuracy), how.most_runs);
}

/// A sentence if more gate runs were made than --gate-runs says; else empty.
std::string more_runs(const lattice::RareEvent& event, const lattice::SplittingOptions& how) {
  const lattice::Splitting& s = event.splitting;
  if (how.trials || s.trials > how.kFirst || s.gate_runs + event.pool_runs <= how.most_runs)
    return "";
  return wrapped(
      fmt::format("These are more than {} gate runs (--gate-runs): the first {} trials always run.",
                  how.most_runs, how.kFirst));
}

}  // namespace

int run_rare(const Arguments& arguments) {
  Options options(
      "rare SCENE [options]",
      "Estimates the chance that a body enters a far row of the field, however small, with a 95 %\n"
      "interval. The number of gates that a body may visit is not limited here.\n\n"
      "Trials of the full dynamics are split into copies when they get far (importance "
      "splitting).\n"
      "A chain that some gate runs make first says what is far. The estimate is unbiased even "
      "where\n"
      "that chain is wrong; the chain's own answer is shown beside it.",
      "gatewalk rare scenes/field.toml --row 20 --json rare.json");
  const TextOption path = options.scene();
  const CountOption row =
      options.add_count("row", "N",
                        "the row to enter, counted from 0; at most the rows of a terrain. The "
                        "default is one row beyond the field, so that the field is crossed");
  const NumberOption accuracy =
      options.add_number("accuracy", "R", "relative standard error to reach (default: 0.05)");
  const CountOption gate_runs = options.add_count(
      "gate-runs", "N",
      "about the largest number of gate runs (default: 2e7; as long as no body enters the row, "
      "those of 100 000 trials); the first 1000 trials always run");
  const CountOption trials =
      options.add_count("trials", "N", "also simulate N trials without splitting, to compare");
  const CountOption split_trials = options.add_count(
      "split-trials", "N", "exactly N split trials, whatever the accuracy (--shard needs it)");
  options.add_seed();
  options.add_kept({"split trials", "field trials"});
  options.add_strict();
  const AskedProgram program = add_cell_program(options);
  options.add_figure("the chance of every row up to N");
  options.add_details("the chance of every row and the time that it took");
  options.most_used({"row", "accuracy", "set", "figure", "json"});
  if (!options.parse(arguments)) return kFine;
  lattice::SplittingOptions how{.accuracy = accuracy ? accuracy.value() : 0.05,
                                .seed = options.seed()};
  if (trials) (void)trials.value();  // checks the value now, because these trials run last
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
  if (source.file) throw UsageError(needs_scene(source.path));
  how.row = row ? static_cast<int>(row.value(1, 10001)) : source.problem.field.rows;
  if (source.scene) (void)lattice::up_to_row(*source.scene, how.row);  // throws before a pilot runs
  choose_method(options, source);
  const lattice::Problem deep = up_to_row(source, how.row);
  RareResult result{.event = lattice::rare_event(deep, how, options.work()),
                    .direct = {},
                    .method = lattice::settled_of(source),
                    .made_by = options.provenance(source)};
  if (trials)
    result.direct = lattice::direct_rows(deep, trials.value(), options.seed(), options.work());
  options.work().end_part();

  NextCommands next(options);
  if (const lattice::Splitting& s = result.event.splitting;
      !how.trials && s.reached && s.rows.back().relative_standard_error > 0.0)
    next.again("accuracy", digits(0.5 * s.rows.back().relative_standard_error, 2),
               "halves the standard error");
  next.add("analyze", "", "which number of the scene matters most");
  const std::string too_few = too_few_runs(result.event.splitting, how);
  options.give_out(result, {answer_text(result) + more_runs(result.event, how) +
                                (too_few.empty() ? "" : wrapped("Beware: " + too_few + ".")) +
                                beware_of(result.event.splitting.health),
                            details_text(result, source.problem.field), next.lines()});
  options.warn(too_few);
  const int exit = status_of(options, result.event.splitting.health);
  options.draw([&] { return figure_of(result); });
  return exit;
}

}  // namespace gatewalk::cli
