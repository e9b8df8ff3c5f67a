// SPDX-License-Identifier: MIT
#include "cli/arguments.h"
#include "cli/exported.h"
#include "cli/subject.h"

namespace gatewalk::cli {

int run_export(const Arguments& arguments) {
  Options options(
      "export MATRIX.nc [SCENE] -o FILE [options]",
      "Writes a chain for other programs, by the ending of FILE:\n"
      "  .umb              PRISM (from 4.10), Storm (from 1.12)\n"
      "  .drn              Storm\n"
      "  .tra              PRISM, with .sta and .lab beside it\n"
      "  .mtx              Matrix Market, with .states.csv beside it, as of all below\n"
      "  .csv              from,to,probability, by names of states\n"
      "  .npz              compressed rows, for scipy.sparse.load_npz\n"
      "  .dtrajs           a line for each trial, the states that it went through (deeptime, "
      "PyEMMA)\n"
      "  .dtrajs.npz       the same as arrays of numpy\n"
      "All but the last two are of the whole field. A state is a gate, the state in which it is\n"
      "entered and, where field.max_gates limits them, how many were entered before. Endings are\n"
      "states that are never left: trapped, crossed, left_side, right_side, went_back, cut_off,\n"
      "never_sampled. With --gate the matrix of one gate is written. All count from 0 (.mtx: 1).",
      "gatewalk export matrix.nc --set field.max_gates=0 -o field.umb");
  options.positional("matrix", "matrix file written by gatewalk build", true);
  options.positional("scene", "of a matrix: another scene; without it the matrix's own", false);
  options.main_output_file("FILE", "what to write", Options::Content::binary);
  options.add_flag("gate", ".mtx, .csv, .npz: the matrix of one gate; its last column is trapped");
  options.add_flag("counts", "with --gate: numbers of runs, not probabilities");
  options.add_text("type", "NAME", "with --gate: of gates of that type of the table [terrain]");
  add_starts(options, "the scene's start");
  options.add_seed("seed of trials of a start that a matrix of trees does not know");
  if (!options.parse(arguments)) return kFine;
  const ExportForm form = export_form(options.text("output"));
  check_files_beside(options, form);
  const bool sparse =
      form == ExportForm::matrix_market || form == ExportForm::csv || form == ExportForm::npz;
  if (form == ExportForm::trajectories) {
    refuse(options, {"start", "set"}, "for trajectories, which are the trials as they were run");
    if (!options.text("scene").empty())
      throw UsageError(
          "SCENE has no meaning for trajectories, which are the trials as they were run");
  }
  if (!options.has("gate")) {
    refuse(options, {"counts", "type"}, "without --gate");
  } else {
    if (!sparse) throw UsageError("--gate: is for .mtx, .csv and .npz");
    refuse(options, {"start", "set"}, "beside --gate: a gate's matrix knows no field");
    if (!options.text("scene").empty())
      throw UsageError("SCENE has no meaning beside --gate: a gate's matrix knows no field");
  }
  if (!is_matrix(options.text("matrix"))) (void)read_matrix(options);  // says what it is instead
  const Exported exported = options.has("gate")                ? export_gate(options, form)
                            : form == ExportForm::trajectories ? export_trials(options)
                                                               : export_field(options, form);
  options.give_out(exported.result, exported.text);
  return kFine;
}

}  // namespace gatewalk::cli
