// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include "cli/arguments.h"
#include "cli/field_run.h"
#include "cli/render/costs.h"
#include "cli/render/exits.h"
#include "cli/render/field_figure.h"
#include "cli/render/field_netcdf.h"
#include "cli/render/json.h"
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
  const lattice::FieldExits exits = lattice::exits_of(run.exits);

  Json json = to_json(run.tally, run.shown, run.scene);
  json["exits"] = to_json(exits, run.shown);
  json["costs"] = to_json(run.costs, run.shown);
  if (!run.may_do.actions.empty()) {
    json["actions"] = run.may_do.actions;
    json["methods"] = to_json(run.may_do);
  }
  json["made_by"] = run.made_by;
  const FieldPicture picture(fmt::format("full dynamics, {} trials", run.tally.trials), run.tally,
                             exits);
  if (options.has("netcdf"))
    options.write(options.text("netcdf"),
                  netcdf_of({{picture, run.start}}, run.shown.map.section, json["made_by"]));
  options.give_out(json, table_of(run.tally, run.shown, run.scene) + table_of(exits, run.shown) +
                             table_of(run.costs, run.shown) + method_lines(run.may_do));
  options.remark(fixed(seconds, 2) + " s");
  options.warn(too_few_gates(run.shown));
  const int exit = status_of(options, run.tally.health);
  options.draw([&] { return figure_of({picture}, run.shown); });
  return exit;
}

}  // namespace gatewalk::cli
