#include "cli/arguments.h"
#include "cli/render/field_figure.h"
#include "cli/render/field_netcdf.h"
#include "cli/render/field_runs.h"
#include "cli/render/json.h"
#include "cli/render/matrix.h"
#include "cli/render/scene.h"
#include "cli/render/text.h"
#include "cli/terminal/output.h"
#include "lattice/study/trials.h"

namespace gatewalk::cli {

int run_walk(const Arguments& arguments) {
  Options options(
      "walk MATRIX.nc [SCENE] [options]",
      "Walks the field by drawing every gate's outcome from the matrix (the paper's\n"
      "Markov chain Monte Carlo) and counts the final gates.",
      "gatewalk walk matrix.nc scenes/field.toml --walks 1e6 --seed 1 --json walks.json");
  options.positional("matrix", "matrix file written by gatewalk build", true);
  options.positional("scene", "scene file (-: standard input); without it the matrix's own scene",
                     false);
  options.add_count("walks", "N", "number of walks", "100");
  options.add_seed();
  options.add_strict();
  options.output_file("netcdf", "FILE.nc", kNetcdfHelp, Options::Content::binary);
  options.add_figure("where walks end, and how");
  if (!options.parse(arguments)) return kFine;
  lattice::SceneMatrix m = read_matrix(options);
  require_active(options, m.scene);
  const dynamics::Entry own = lattice::own_start(m.scene).entry();
  add_starts_to(m, options.text("matrix"), options, {own});
  const dynamics::Transitions& t = m.file.transitions;
  const lattice::ChainStart start = ready_start(options, m, own, "the start");
  const std::int64_t walks = options.count("walks");

  const markov::FieldChain chain =
      lattice::make_chain(lattice::gates_of(m.scene).map(), lattice::matrices_of(m.file, m.scene));
  const dynamics::Stopwatch watch;
  const auto tally =
      lattice::walks(chain, m.scene.field, start, walks, options.seed(), options.work());
  const double seconds = watch.seconds();

  const Json status = recorded_status(m.file);
  Json json = to_json(tally, start, t.space, m.scene);
  json["matrix_status"] = status;
  json["made_by"] = to_json(options.provenance(m.scene));
  if (options.has("netcdf"))
    options.write(
        options.text("netcdf"),
        netcdf_of({{FieldPicture("", tally), lattice::own_start(m.scene)}}, json["made_by"]));
  options.give_out(json, table_of(tally, start, t.space, m.scene));
  options.warn(too_few_gates(m.scene));
  options.remark(fixed(seconds, 3) + " s, " + fixed(static_cast<double>(walks) / seconds / 1e6, 2) +
                 " million walks a second");
  const int exit = exit_status(options, faults_recorded(status).empty() && t.health.clean());
  options.draw([&] {
    return figure_of({{"chain, " + std::to_string(walks) + " walks", tally}}, m.scene);
  });
  return exit;
}

}  // namespace gatewalk::cli
