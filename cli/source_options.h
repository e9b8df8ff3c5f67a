// SPDX-License-Identifier: MIT
#pragma once
/// The options that say what a command asks about, opened as a lattice::Source.

#include <initializer_list>
#include <optional>
#include <string>

#include "cli/arguments.h"
#include "lattice/scene/cell_file.h"
#include "lattice/source/source_file.h"

namespace gatewalk::cli {

/// The options --cell-program and --cell-timeout.
struct AskedProgram {
  TextOption command;
  NumberOption timeout;
};
/// Declares --cell-program and --cell-timeout.
AskedProgram add_cell_program(Options& options);
/// Whether the user's own cells move the bodies: a program (--cell-program) or the caller's object.
[[nodiscard]] bool has_cell(const Options& options, const AskedProgram& program);

/// What a command asks about, by those of these options that the command has.
struct Asked {
  TextOption path;     // a scene, a matrix or a cell file
  TextOption scene{};  // another scene, for a matrix
  AskedProgram program{};
  TextsOption starts{};
  AskedAccuracy accuracy{};
};

/// Opens the scene, matrix or cell file with --set, and warns of what its runs cannot tell. Throws
/// UsageError and what lattice::Source::open throws.
[[nodiscard]] lattice::Source open_source(const Options& options, const Asked& asked);

/// Recorded runs with the cells that they went through.
struct RecordedCells {
  lattice::CellFile cells;
  lattice::RunPool pool;
  lattice::Problem problem;
};
/// Reads a table of recorded runs (runs.csv) and the file of --cell, with --set, and warns of what
/// they cannot tell. Throws SceneError and std::invalid_argument.
[[nodiscard]] RecordedCells read_recorded(const Options& options, const std::string& runs,
                                          const TextOption& cell_file);

/// Opens a scene of gates, or a program's cells, with one start. `made` completes the message for
/// several starts ("a plan is made"). Throws UsageError, also for a matrix.
[[nodiscard]] lattice::Source field_to_run(const Options& options, const Asked& asked,
                                           const std::string& made);

/// The scene or matrix that power --versus compares with; none without the option. Throws
/// UsageError.
[[nodiscard]] std::optional<lattice::Source> versus(const Options& options, const Asked& asked,
                                                    const TextsOption& versus,
                                                    const lattice::Source& s);

/// Chooses the numerical method if the scene asks for method = "auto", and warns of keys without
/// effect. To be called after all options have been read, because the choice runs a pilot.
void choose_method(const Options& options, lattice::Source& s);

/// lattice::predict. Warns if the accuracy was not reached.
[[nodiscard]] lattice::PooledPrediction predict(const Options& options, lattice::Source& s);

/// The beginning of a warning about one of several starts, "start d 0 m: "; empty for one start.
[[nodiscard]] std::string where(const lattice::Source& s, std::size_t start);

/// The cell's description of itself in one line: faces, coordinates, costs, parameters. Two cells
/// with different lines are different cells.
[[nodiscard]] std::string text_of(const dynamics::Cell& cell);

/// The message of a command that simulates new bodies, for a matrix at `path`, which it refuses.
[[nodiscard]] std::string needs_scene(const std::string& path);

/// Throws UsageError if one of these options is given; `where` completes the message ("for bins").
void refuse(std::initializer_list<Option> options, const std::string& where);

}  // namespace gatewalk::cli
