// SPDX-License-Identifier: MIT
#include "cli/command.h"
#include "cli/next.h"
#include "cli/render/matrix.h"
#include "cli/render/states.h"
#include "cli/source_options.h"
#include "lattice/scene/cell_file.h"
#include "lattice/source/cell_matrix.h"

namespace gatewalk::cli {

int run_show(const Arguments& arguments) {
  Options options(
      "show MATRIX.nc [options]",
      "Shows what a matrix file holds: its size, the runs behind it and how it was made. --rows\n"
      "shows a line for each state, and --row I all outcomes of one state.",
      "gatewalk show matrix.nc --rows");
  const TextOption file_given =
      options.positional("matrix", "matrix file written by gatewalk build", true);
  const Option rows = options.add_flag("rows", "show a line for each state: runs and outcomes");
  const CountOption row =
      options.add_count("row", "I", "show all outcomes of state I; states count from 0");
  const TextOption type =
      options.add_text("type", "NAME", "show the matrix of this type of gates ([terrain.types])");
  options.add_figure("the matrix, states grouped by boundary");
  options.add_details("how the matrix was made, its states and its scene");
  options.most_used({"rows", "row", "figure", "json"});
  options.without_scene("a matrix keeps its scene");
  if (!options.parse(arguments)) return kFine;
  const std::string path = file_given.value();
  ShownMatrix matrix{path, lattice::read_matrix(path)};
  lattice::MatrixFile& file = matrix.file;
  if (type) {
    const auto found = file.types.find(type.value());
    if (found == file.types.end())
      throw UsageError("--type " + type.value() + ": " + path + " has no such type");
    file.transitions = found->second;
  }
  ShownRows shown{.all = static_cast<bool>(rows), .one = {}};
  if (row) shown.one = static_cast<int>(row.value(0, file.transitions.space.size() - 1));

  NextCommands next(options);
  if (!shown.all && !shown.one) next.add("show", "--rows", "a line for each state");
  // A prediction needs a start, which an imported chain may lack.
  const auto states = recorded_states(file, path);
  const bool lacks_start = states && states->is_imported() &&
                           !lattice::parse_cell_file(file.text.at(lattice::kCellText), path).start;
  next.add("predict", lacks_start ? "--start 0" : "", "how bodies cross the field");
  options.give_out(matrix, {answer_text(matrix, shown), details_text(matrix), next.lines()});
  options.draw([&] { return figure_of(file.transitions); });
  return kFine;
}

}  // namespace gatewalk::cli
