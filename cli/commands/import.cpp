// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>

#include "cli/arguments.h"
#include "cli/exchange/imported.h"
#include "cli/render/matrix.h"
#include "cli/render/version.h"
#include "lattice/source/cell_matrix.h"

namespace gatewalk::cli {
namespace {

/// Calls `read` and turns an error in the user's file into a UsageError.
template <class Read>
auto read_file(const Read& read) {
  try {
    return read();
  } catch (const std::runtime_error& e) {
    throw UsageError(e.what());
  } catch (const std::invalid_argument& e) {
    throw UsageError(e.what());
  }
}

/// Commands to propose next. Those that predict need a chain with a start.
std::vector<std::string> next_of(const std::string& output, bool has_start) {
  const std::string file = shell_quoted(output);
  if (!has_start) return {"gatewalk show " + file + "  # shows states and rows"};
  return {"gatewalk predict " + file + "  # predicts how walks end",
          "gatewalk analyze " + file + "  # gives visits, paths and time scales"};
}

}  // namespace

int run_import(const Arguments& arguments) {
  Options options(
      "import FILE --states STATES.csv -o MATRIX.nc [options]",
      "Makes a matrix file from a Markov chain of yours, for predict, analyze, walk and export. "
      "FILE has\n"
      "counts or probabilities of one cell: .mtx; .csv with from,to,count or from,to,probability; "
      ".npz of\n"
      "scipy. The matrix is states x states, or states x (states + 1) with the last column "
      "trapped. FILE\n"
      "can also have trajectories: .dtrajs, a line each with blanks between states; or .npz, an "
      "array\n"
      "each. The last state of a trajectory may be the number of states, which means trapped; -1 "
      "is a\n"
      "gap. Whole numbers are counts and give error bars.\n"
      "STATES.csv has a line for each state, with the move by which the state is entered:\n"
      "state,move_x,move_y (columns to the right, rows ahead). Optional columns are name, face "
      "and\n"
      "counts_per_run: 2 where counts hold each run and its mirror image, as gatewalk export "
      "writes them\n"
      "for trees; error bars then count the run once.",
      "gatewalk export matrix.nc --gate --counts -o counts.mtx\n"
      "  gatewalk import counts.mtx --states counts.states.csv --start 0 --set field.rows=5 -o "
      "chain.nc");
  const TextOption file_given = options.positional("file", "the matrix, or the trajectories", true);
  const TextOption table_of_states =
      options.input_file("states", "the table of states, with the move that enters each");
  const TextOption output_given =
      options.main_output_file("MATRIX.nc", "the matrix file to write", Options::Content::binary);
  const TextOption start_given = options.add_text(
      "start", "STATE", "the state in which walks start: its name, or its number from 0");
  const NumberOption width = options.add_number("width", "M", "width of a cell, m (default: 1)");
  const NumberOption length =
      options.add_number("length", "M", "length of a cell along the way, m (default: 1)");
  options.most_used({"states", "output", "start", "set", "json"});
  if (!options.parse(arguments)) return kFine;
  if (!table_of_states)
    throw UsageError("missing --states STATES.csv: which move enters each state");
  std::vector<std::string> understood;
  auto states = read_file([&] { return read_states(table_of_states.value(), &understood); });
  const std::string path = file_given.value();
  const ForeignMatrix matrix = read_file([&] { return read_foreign(path, states); });
  // Only counts have runs. In trajectories each run counts once.
  if (matrix.trajectories || matrix.probabilities)
    for (ForeignState& s : states) s.counts_per_run = 0;
  lattice::CellFile cells = lattice::parse_cell_file(
      cell_text(states, width.within(1.0, 1e-9, 1e9), length.within(1.0, 1e-9, 1e9)),
      table_of_states.value(), options.overrides());
  if (start_given) {
    const std::string start = start_given.value();
    std::size_t k = 0;
    while (k < states.size() && start != states[k].name && start != std::to_string(k)) ++k;
    if (k == states.size())
      throw UsageError(
          fmt::format("--start {}: {} has no such state", start, table_of_states.value()));
    cells.start = entry_of(states, k, cells.map.section);
  }
  dynamics::Transitions t = transitions_of(matrix, states, cells);
  const StateRecord space{{.are_probabilities = matrix.probabilities}, t.space.size()};
  understood.insert(understood.end(), matrix.table.understood.begin(),
                    matrix.table.understood.end());
  lattice::MatrixFile file = matrix_file(std::move(t), states,
                                         {{"title", "gatewalk counts of a chain from elsewhere"},
                                          {"state_space", attribute_of(space)},
                                          {"program", std::string("gatewalk ") + kVersion},
                                          {"commit", kCommit},
                                          {"command", options.canonical()},
                                          {lattice::kCellText, lattice::to_toml(cells)}});
  std::string lines = fmt::format("{}", fmt::join(understood, "\n"));
  if (!lines.empty()) {
    file.text["understood"] = lines;
    lines += "\n";
  }
  const std::string output = output_given.value();
  options.keep_old(output);
  lattice::write_matrix(output, file);
  const std::vector<std::int64_t> per_run = lattice::counts_per_run(file);
  if (std::count(per_run.begin(), per_run.end(), 2) > 0)
    lines +=
        "Runs are counted with their mirror images (counts_per_run); intervals count each run "
        "once.\n";
  const std::string table = summary_table(file, output) + lines;
  options.give_out(
      ImportedMatrix{{output, std::move(file)}, std::move(understood), options.provenance()},
      {table, "", next_of(output, cells.start.has_value())});
  if (matrix.probabilities)
    options.warn(path + " has probabilities, not counts: predictions have no error bars");
  return kFine;
}

}  // namespace gatewalk::cli
