// SPDX-License-Identifier: MIT
#include "cli/command.h"
#include "cli/render/matrix.h"
#include "lattice/source/cell_matrix.h"

namespace gatewalk::cli {

int run_show(const Arguments& arguments) {
  Options options(
      "show MATRIX.nc [options]",
      "Shows what a matrix file holds: size, counts, sparsity, clamped share, where it\n"
      "came from; with --rows every row, with --row I one row with all its outputs.",
      "gatewalk show matrix.nc --rows");
  const TextOption file_given =
      options.positional("matrix", "matrix file written by gatewalk build", true);
  const Option rows = options.add_flag("rows", "a line per input state");
  const CountOption row =
      options.add_count("row", "I", "all outputs of input state I; states count from 0");
  const TextOption type =
      options.add_text("type", "NAME", "the matrix of gates of that type of the table [terrain]");
  options.add_figure("the matrix, states grouped by boundary");
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

  options.give_out(matrix, table_of(matrix, shown));
  options.draw([&] { return figure_of(file.transitions); });
  return kFine;
}

}  // namespace gatewalk::cli
