// SPDX-License-Identifier: MIT
#pragma once
/// What is asked about, wherever it comes from: a scene of gates, a matrix of one, cells that
/// another program carries out, recorded runs, or a chain that was made elsewhere.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/base/work.h"
#include "dynamics/cells/cell.h"
#include "dynamics/cells/transitions.h"
#include "lattice/field/problem.h"
#include "lattice/pool/pooled_prediction.h"
#include "lattice/scene/scene.h"

namespace gatewalk::lattice {

// What a source keeps that only the sources of this library look into.
class SourceFile;
struct CellFile;
struct MatrixFile;
struct RunPool;
struct Settled;
class TomlFile;

struct SourceOptions {
  std::vector<std::string> overrides{};  // "forces.random_N=20", of the scene or the cell file
  const SourceFile* scene = nullptr;     // of a matrix: another scene than its own
  /// The file is a cell file, or a matrix of such cells, and bodies are carried through them by the
  /// cell that this makes; called when the file has been read.
  std::function<std::shared_ptr<const dynamics::Cell>()> cell = nullptr;
};

struct Source {
  std::string path;
  std::optional<Scene> scene{};              // of gates; else ...
  std::shared_ptr<const CellFile> cells{};   // ... of cells that are not ours
  std::shared_ptr<const MatrixFile> file{};  // it was read from
  /// Of trees: the gate runs that there are, none yet of a scene or a program. Without: of bins.
  /// Copies share them until one of them adds to its own.
  std::shared_ptr<RunPool> pool{};
  /// While the scene leaves its method to a pilot, the problem has no cells.
  Problem problem{};
  AccuracyOptions accuracy{};  // of trees: as their file was made for
  /// Where bodies start, or (none) as recorded bodies were seen to enter first.
  std::vector<std::optional<dynamics::Entry>> starts{};
  bool starts_given = false;               // by start_from(); else they are its own
  bool is_imported = false;                // a chain that was made elsewhere
  std::shared_ptr<const Settled> pilot{};  // what it chose
  std::vector<std::string> doubts{};       // what the file or its runs cannot tell, a sentence each

  /// Opens a scene, a cell file or a matrix. A scene's method may be left to a pilot, which
  /// choose_method() or predict() runs. Throws SceneError naming file, line and key,
  /// markov::BadFile, and std::invalid_argument.
  [[nodiscard]] static Source open(const SourceFile& file, const SourceOptions& options = {});
  [[nodiscard]] static Source open(const std::string& path, const SourceOptions& options = {});
  /// Cells of one's own, without a file: predict() carries bodies through them from problem.start.
  [[nodiscard]] static Source of(Problem problem);
  /// Bodies start as these texts say, "0,5,10" as --start takes them, or by a state's name; without
  /// any at its own start. Returns what is doubtful about these starts. Throws
  /// std::invalid_argument where they are malformed, outside the gates, or of no state with runs.
  [[nodiscard]] std::vector<std::string> start_from(const std::vector<std::string>& texts);
  /// Chooses the method that a scene leaves to a pilot, if it does.
  void choose_method(std::uint64_t seed, const dynamics::Work& work = {});

  [[nodiscard]] bool is_recorded() const { return cells && problem.is_recorded(); }
  /// Throws std::invalid_argument where one is "as seen", which is no place to start new trials at.
  [[nodiscard]] std::vector<dynamics::Entry> entries() const;
  /// "start d 4 m, ..." of a start that was given, else "the start".
  [[nodiscard]] std::string name_of(std::size_t start) const;
  /// One for each type of cell: those of the file, if it is a matrix; else of the gate runs that
  /// predict() has made, whose states are the leaves of trees. Throws std::invalid_argument where
  /// there are none yet.
  [[nodiscard]] std::vector<dynamics::Transitions> matrices() const;
};

/// The prediction of a chain of trees: by its runs, to which others are added until the accuracy is
/// kept; by recorded runs as they are. Throws std::invalid_argument where there are no trees, or
/// for an accuracy outside (0, 1); std::runtime_error when a run broke.
[[nodiscard]] PooledPrediction predict(Source& source, const dynamics::Work& work = {});

}  // namespace gatewalk::lattice
