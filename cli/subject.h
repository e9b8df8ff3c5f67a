// SPDX-License-Identifier: MIT
#pragma once
/// What a command is asked about, wherever it comes from: a scene, a matrix of one, cells that
/// another program carries out, or recorded runs.

#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/render/shown_field.h"
#include "cli/render/start.h"
#include "lattice/cells/cell_file.h"
#include "lattice/pool/pooled_prediction.h"
#include "lattice/problem.h"
#include "lattice/scene/matrix.h"
#include "lattice/scene/settle.h"

namespace gatewalk::cli {

struct Subject {
  std::string path;
  std::optional<lattice::Scene> scene{};              // of gates; else ...
  std::optional<lattice::CellFile> cells{};           // ... of cells that are not ours
  std::shared_ptr<const lattice::MatrixFile> file{};  // it was read from
  /// Of trees: the runs that there are, none yet of a scene or a program. Without: of bins.
  std::optional<lattice::RunPool> pool{};
  lattice::Problem problem{};
  lattice::AccuracyOptions how{};             // of trees: as asked for, else as the file was made
  std::vector<Start> starts{};                // those given, else its own
  bool given = false;                         // --start was
  bool foreign = false;                       // a chain that was made elsewhere
  std::optional<lattice::Settled> settled{};  // the method chosen for the scene
  [[nodiscard]] bool is_recorded() const { return problem.is_recorded(); }
  [[nodiscard]] ShownField shown() const { return scene ? ShownField(*scene) : ShownField(*cells); }
  /// Throws UsageError where one is "as seen", which is no place to start new trials at.
  [[nodiscard]] std::vector<dynamics::Entry> entries() const;
  /// "start d 4 m, ..." of a start that was given, else "the start".
  [[nodiscard]] std::string name_of(std::size_t start) const;
  /// Of what a warning is, where several starts are given: "start d 0 m: "; else nothing.
  [[nodiscard]] std::string where(std::size_t start) const;
  /// Of a matrix of a scene.
  [[nodiscard]] lattice::SceneMatrix matrix() const { return {file, *scene}; }
  /// Of a matrix: one for each type of cell.
  [[nodiscard]] std::vector<dynamics::Transitions> matrices() const;
  /// Of a matrix of bins, or one that was made elsewhere: what the cells draw from.
  [[nodiscard]] lattice::CountedField counted() const;

  /// So finely (s) durations of trials are kept: to a thousandth of the time after which a body is
  /// trapped, or else of the mean duration of some trials.
  [[nodiscard]] double bin_of_durations(const Options& options) const;

  /// Chooses the method that the scene leaves to a pilot, and says what the scene leaves out. To be
  /// called when all options have been looked at.
  void settle(const Options& options);
  /// Where the result comes from.
  [[nodiscard]] Provenance provenance(const Options& options) const;
};

/// Opens what the positional argument of this name says, with --cell-program, --start and --set,
/// and warns of what its file or its runs cannot tell. Throws UsageError and as what reads it.
[[nodiscard]] Subject open_subject(const Options& options, const std::string& name);

/// A cell file, or a matrix of such cells, and the program of --cell-program. As open_subject.
[[nodiscard]] Subject open_program(const Options& options, const std::string& path);

/// A scene of gates, or cells of a program, with one start: `made` ("a plan is made") is for it.
/// Throws UsageError.
[[nodiscard]] Subject field_to_run(const Options& options, const std::string& made);

/// What a program says of its cell: another one is told by it, mostly.
[[nodiscard]] std::string told_by(const dynamics::Cell& cell);

/// The scene of power --versus, as a subject of its own; none without it. Throws UsageError.
[[nodiscard]] std::optional<Subject> versus(const Options& options, const Subject& s);

/// Refuses these options, if they are given: they have no meaning `where` ("for bins: ...").
void refuse(const Options& options, std::initializer_list<const char*> names,
            const std::string& where);

/// The prediction of its chain of trees, from runs that are added until the accuracy is kept;
/// recorded runs as they are. Warns where it was not reached.
[[nodiscard]] lattice::PooledPrediction predict(const Options& options, Subject& s);

/// Whether bodies are carried by cells that are not ours: --cell-program, or a cell given.
[[nodiscard]] bool has_cell(const Options& options);
/// Declares --cell-program and --cell-timeout.
void add_cell_program(Options& options);

/// "0.01,0,0.2"; "W:0.01,0,0.2" where starts by any face are permitted, "seen" where runs were
/// recorded. Throws UsageError.
enum class StartsFrom { first_face, any_face, any_face_or_seen };
[[nodiscard]] Start parse_start(const std::string& text, const dynamics::Section& section,
                                StartsFrom from);

}  // namespace gatewalk::cli
