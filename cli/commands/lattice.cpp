// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include "cli/arguments.h"
#include "cli/field_run.h"
#include "cli/render/field_figure.h"
#include "cli/render/field_netcdf.h"
#include "cli/render/scene.h"
#include "cli/render/text.h"
#include "cli/subject.h"
#include "dynamics/base/work.h"

namespace gatewalk::cli {

int run_lattice(const Arguments& arguments) {
  Options options(
      "lattice SCENE [options]",
      "Simulates the field: the full dynamics, gate by gate. Counts the final gates. `gatewalk\n"
      "simulate` is another name of this command.",
      "gatewalk lattice scenes/field.toml --trials 10000 --seed 1 --json lattice.json");
  options.scene();
  options.add_trials_and_seed("trials through the field");
  options.add_first_trial();
  options.add_kept({"field trials"});
  options.add_strict();
  add_cell_program(options);
  options.output_file("passages", "FILE.csv",
                      "write every passage through a gate as a table of recorded runs "
                      "(lattice/cells/README.md)");
  options.output_file("cell-file", "FILE.toml", "write what such a table's cells are (cell.toml)");
  options.output_file("netcdf", "FILE.nc", kNetcdfHelp, Options::Content::binary);
  options.input_file("policy", "bodies do what this file of gatewalk plan says (FILE.json)");
  options.add_figure("where bodies end, and how");
  if (!options.parse(arguments)) return kFine;
  const dynamics::Stopwatch watch;
  const FieldRun run = field_run(options);
  const double seconds = watch.seconds();
  const FieldPicture picture(fmt::format("full dynamics, {} trials", run.tally.trials),
                             ends_of(run.tally, run.shown.field), lattice::exits_of(run.exits),
                             run.start);
  if (options.has("netcdf"))
    options.write(options.text("netcdf"), netcdf_of({picture}, run.shown.map.section, run.made_by));
  options.give_out(run, table_of(run));
  options.remark(fixed(seconds, 2) + " s");
  options.warn(too_few_gates(run.shown));
  const int exit = status_of(options, run.tally.health);
  options.draw([&] { return figure_of({picture}, run.shown); });
  return exit;
}

}  // namespace gatewalk::cli
