// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include "cli/arguments.h"
#include "cli/chain_from_start.h"
#include "cli/fields/text.h"
#include "cli/next.h"
#include "cli/render/field_figure.h"
#include "cli/render/field_netcdf.h"
#include "cli/render/field_runs.h"
#include "cli/render/matrix.h"
#include "cli/render/scene.h"
#include "lattice/source/source_file.h"
#include "lattice/study/trials.h"

namespace gatewalk::cli {

int run_walk(const Arguments& arguments) {
  Options options(
      "walk MATRIX.nc [SCENE] [options]",
      "Simulates walks of the Markov chain through the field and counts how and in which gate "
      "they\n"
      "end. Each step draws the outcome of a gate from the matrix, as the paper does (Markov "
      "chain\n"
      "Monte Carlo). gatewalk predict gives exact shares, with intervals.",
      "gatewalk walk matrix.nc scenes/field.toml --walks 1e6 --seed 1 --json walks.json");
  const TextOption matrix =
      options.positional("matrix", "matrix file written by gatewalk build", true);
  const TextOption scene = options.positional(
      "scene", "scene file (-: standard input); without it the matrix's own scene", false);
  const CountOption walks_given = options.add_count("walks", "N", "number of walks", "100");
  options.add_seed();
  options.add_strict();
  const TextOption netcdf =
      options.output_file("netcdf", "FILE.nc", kNetcdfHelp, Options::Content::binary);
  options.add_figure("where walks end, and how");
  options.add_details("maps of the final gates, and the state in which walks begin");
  options.most_used({"walks", "seed", "set", "figure", "json"});
  if (!options.parse(arguments)) return kFine;
  const std::string path = matrix.value();
  if (!options.file(path).is_matrix())
    (void)options.file(path).matrix();  // throws an error that says what the file is
  lattice::Source s = open_source(options, {.path = matrix, .scene = scene});
  const StartedChain from = chain_from_start(options, s);
  const std::int64_t walks = walks_given.value();
  const ShownField shown = ShownField(s);
  const dynamics::Stopwatch watch;
  const auto tally =
      lattice::walks(from.chain, shown.field, from.start, walks, options.seed(), options.work());
  const double seconds = watch.seconds();

  const WalkResult result{.shown = shown,
                          .tally = tally,
                          .state = from.state,
                          .start = from.state ? std::nullopt : s.starts.front(),
                          .foreign = s.is_imported,
                          .matrix_status = recorded_health(*s.file),
                          .made_by = options.provenance(s)};
  const FieldPicture picture(fmt::format("chain, {} walks", walks), ends_of(tally, shown.field), {},
                             s.starts.front());
  if (netcdf) options.write(netcdf.value(), netcdf_of({picture}, result.shown, result.made_by));
  options.give_out(
      result, {answer_text(result), details_text(result),
               NextCommands(options).add("predict", "", "exact shares, with intervals").lines()});
  options.warn(too_few_gates(shown));
  options.warn(rest_warning(rest_of(tally)));
  options.remark(fmt::format("{} s, {} million walks a second", fixed(seconds, 3),
                             fixed(static_cast<double>(walks) / seconds / 1e6, 2)));
  const int exit =
      exit_status(options, faults_recorded(result.matrix_status).empty() && from.clean);
  options.draw([&] { return figure_of({picture}, shown); });
  return exit;
}

}  // namespace gatewalk::cli
