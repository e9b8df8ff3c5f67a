// SPDX-License-Identifier: MIT
#pragma once
/// The options of a command that say what is asked about, as a lattice::Source.

#include <initializer_list>
#include <optional>
#include <string>

#include "cli/arguments.h"
#include "lattice/source/source_file.h"

namespace gatewalk::cli {

/// --cell-program and --cell-timeout.
struct AskedProgram {
  TextOption command;
  NumberOption timeout;
};
/// Declares them.
AskedProgram add_cell_program(Options& options);
/// Whether bodies are carried by cells that are not ours: --cell-program, or a cell given.
[[nodiscard]] bool has_cell(const Options& options, const AskedProgram& program);

/// What a command asks about, by those options that it has.
struct Asked {
  TextOption path;     // a scene, a matrix, ...
  TextOption scene{};  // of a matrix: another one
  AskedProgram program{};
  TextsOption starts{};
  AskedAccuracy accuracy{};
};

/// Opens it, with --set, and warns of what its file or its runs cannot tell. Throws UsageError and
/// as what reads it.
[[nodiscard]] lattice::Source open_source(const Options& options, const Asked& asked);

/// A scene of gates, or cells of a program, with one start: `made` ("a plan is made") is for it.
/// Throws UsageError.
[[nodiscard]] lattice::Source field_to_run(const Options& options, const Asked& asked,
                                           const std::string& made);

/// The scene or matrix of power --versus; none without it. Throws UsageError.
[[nodiscard]] std::optional<lattice::Source> versus(const Options& options, const Asked& asked,
                                                    const TextsOption& versus,
                                                    const lattice::Source& s);

/// Chooses the method that a scene leaves to a pilot, and says what the scene leaves out. To be
/// called when all options have been looked at.
void choose_method(const Options& options, lattice::Source& s);

/// lattice::predict; warns where the accuracy was not reached.
[[nodiscard]] lattice::PooledPrediction predict(const Options& options, lattice::Source& s);

/// Of what a warning is, where several starts are given: "start d 0 m: "; else nothing.
[[nodiscard]] std::string where(const lattice::Source& s, std::size_t start);

/// What a program says of its cell, in one line, by which cells are told apart.
[[nodiscard]] std::string text_of(const dynamics::Cell& cell);

/// "scenes/field.toml --set forces.random_N=20": the words that ask another command about the same.
/// Empty for standard input, which cannot be read again.
[[nodiscard]] std::string asked_again(const Options& options, const Asked& asked);
/// A line of Screen::next: "gatewalk predict scenes/field.toml  # WHAT_FOR", which a shell runs as
/// it stands. Without WHAT_FOR where the line would be longer than 100 characters.
[[nodiscard]] std::string next_step(const std::string& command, const std::string& what_for);

/// Why a command that simulates new bodies refuses the matrix at `path`.
[[nodiscard]] std::string needs_scene(const std::string& path);

/// Refuses these options, if they are given: they have no meaning `where` ("for bins: ...").
void refuse(std::initializer_list<Option> options, const std::string& where);

}  // namespace gatewalk::cli
