// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include "cli/answered.h"
#include "cli/arguments.h"
#include "cli/parsers.h"
#include "cli/predicted.h"
#include "cli/render/field_figure.h"
#include "cli/render/field_netcdf.h"
#include "cli/subject.h"

namespace gatewalk::cli {

int run_predict(const Arguments& arguments) {
  Options options(
      "predict SCENE|MATRIX.nc [SCENE] [options]",
      "The distribution of endings and final gate. From a scene: full trials are run, and their\n"
      "gate runs pooled into a chain, until the error bar keeps --accuracy (the trials' own "
      "shares\n"
      "are the answer where they are the more certain). From a matrix with trees: the same with\n"
      "the runs that it keeps, and first runs of a start that it does not know. From a matrix of\n"
      "bins: what infinitely many walks with it would give; its intervals count that the\n"
      "matrix is a sample of gate runs, the chain's own error gatewalk validate measures.",
      "gatewalk predict scenes/field.toml --accuracy 0.01 --json prediction.json");
  options.positional(
      "matrix", "a scene (-: standard input), or a matrix file written by gatewalk build", true);
  options.positional("scene", "of a matrix: another scene; without it the matrix's own", false);
  add_accuracy(options, "0.02; that of a matrix, or half of it if it is for any start");
  options.add_count(
      "first-runs", "N",
      "matrix of trees: N first runs (16 or more) of a start that it does not know, and "
      "no other trials; 0: none, it is taken for any other of its leaf, which says "
      "little");
  add_starts(options, "the scene's start");
  options.add_texts("row", "A-B=FILE",
                    "gates of rows i_y = A to B as in another matrix of the same bins (may be "
                    "repeated)");
  options.add_text("solver", "NAME",
                   "propagate: step by step; for field.max_gates = 0 also march: row by row, and "
                   "klu: one sparse solve; auto: march without limit, else propagate",
                   "auto");
  options.add_kept();
  options.add_strict();
  add_cell_program(options);
  options.output_file("netcdf", "FILE.nc", kNetcdfHelp, Options::Content::binary);
  options.add_figure(fmt::format("where bodies end, and how; of up to {} starts", kMostPictures));
  add_page(options);
  options.reads("row", [](const std::string& rows) { return rows.substr(rows.find('=') + 1); });
  options.add_seed(
      "seed of all trials; of a matrix of bins: of the resampled matrices behind the "
      "intervals");
  if (!options.parse(arguments)) return kFine;
  if (const auto starts = options.texts("start");
      options.has("figure") && starts.size() > kMostPictures)
    throw UsageError(fmt::format("--figure: shows at most {} starts, these are {}", kMostPictures,
                                 starts.size()));
  (void)solver_of(options);
  Subject s = open_subject(options, "matrix");
  check_page(options, s);
  const bool no_runs = options.has("first-runs") && options.count("first-runs", 0) == 0,
             by_solver = options.text("solver") != "auto",
             as_it_is = !s.pool || by_solver || no_runs || options.has("row");
  // First runs are added to those of a file, by the scene's dynamics or by a program.
  if (!s.file || s.is_recorded() || (s.cells && no_runs))
    refuse(options, {"first-runs"},
           fmt::format("for {}: it is for a matrix of a scene, or (above 0) of a cell program",
                       s.path));
  if (!s.file || (!s.scene && !s.foreign)) {
    refuse(options, {"row"}, fmt::format("for {}: it is for a matrix of a scene", s.path));
    if (by_solver)
      throw UsageError(
          fmt::format("--solver has no meaning for {}: it is for a matrix of a scene", s.path));
  }
  if (s.foreign)
    refuse(options, {"row"}, fmt::format("for {}: it is for a matrix of a scene", s.path));
  if (s.file && s.scene) warn_of_range(options, *s.file, s.path, s.entries());
  if (s.file && (s.foreign || (s.scene && as_it_is))) {
    const std::string why = fmt::format(
        "for {}, which keeps no gate runs that could be added to (or --row, --solver, --first-runs "
        "0 asks for the matrix as it is)",
        s.path);
    refuse(options, {"accuracy", "gate-runs"}, why);
    if (!no_runs) refuse(options, {"first-runs"}, why);
    return predict_from_matrix(options, s, other_rows(options));
  }
  if (options.has("first-runs"))
    s.how.first_runs = options.count("first-runs", lattice::PoolRunner::kLeastTrials);
  s.settle(options);
  return predict_from_runs(options, s);
}

}  // namespace gatewalk::cli
