// SPDX-License-Identifier: MIT
#pragma once
/// What a command works on, whatever file it comes from: a scene of gates, a matrix of a scene,
/// cells that another program simulates, recorded runs, or an imported chain.

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

// Types that only this library's sources need to know.
class SourceFile;
struct CellFile;
struct MatrixFile;
struct RunPool;
struct Settled;
class TomlFile;

struct SourceOptions {
  std::vector<std::string> overrides{};  // "forces.random_N=20", of the scene or the cell file
  const SourceFile* scene = nullptr;     // for a matrix: a scene to use instead of the matrix's own
  /// Makes the cell that carries bodies through. If given, the file must be a cell file, or a
  /// matrix of such cells; the function is called once the file has been read.
  std::function<std::shared_ptr<const dynamics::Cell>()> cell = nullptr;
};

/// A problem to predict: opened from a file, or made of the caller's own cells.
struct Source {
  std::string path;
  std::optional<Scene> scene{};              // only for gates
  std::shared_ptr<const CellFile> cells{};   // only for cells that are not gates
  std::shared_ptr<const MatrixFile> file{};  // the matrix file that was read, if any
  /// For chains of trees: the gate runs so far; none yet for a scene or a program. Null for chains
  /// of bins. Copies of a Source share the pool until one of them adds runs.
  std::shared_ptr<RunPool> pool{};
  /// The problem has no cells while the scene leaves its method to a pilot.
  Problem problem{};
  AccuracyOptions accuracy{};  // for chains of trees: as the matrix file was made
  /// Where bodies start; nullopt: by the first entries of recorded bodies.
  std::vector<std::optional<dynamics::Entry>> starts{};
  bool starts_given = false;               // set by start_from(), not by the file
  bool is_imported = false;                // a chain that was made elsewhere
  std::shared_ptr<const Settled> pilot{};  // the method that the pilot chose
  std::vector<std::string> doubts{};  // what the file or its runs cannot tell, one sentence each

  /// Opens a scene, a cell file or a matrix. A scene may leave its method to a pilot, which
  /// choose_method() or predict() runs. Throws SceneError (naming file, line and key),
  /// markov::BadFile or std::invalid_argument.
  [[nodiscard]] static Source open(const SourceFile& file, const SourceOptions& options = {});
  [[nodiscard]] static Source open(const std::string& path, const SourceOptions& options = {});
  /// A source made of the caller's own cells, without a file. predict() carries bodies through
  /// these cells from problem.start.
  [[nodiscard]] static Source of(Problem problem);
  /// Sets the starts: each text is "0,5,10" as --start takes it, or the name of a state; no text
  /// means the source's own start. Returns sentences on what is doubtful about these starts. Throws
  /// std::invalid_argument for a start that is malformed, outside the gates, or in a state without
  /// runs.
  [[nodiscard]] std::vector<std::string> start_from(const std::vector<std::string>& texts);
  /// Lets a pilot choose the numerical method, if the scene leaves the method open.
  void choose_method(std::uint64_t seed, const dynamics::Work& work = {});

  /// True for recorded runs, to which no new runs can be added.
  [[nodiscard]] bool is_recorded() const { return cells && problem.is_recorded(); }
  /// The starts as entries. Throws std::invalid_argument if a start is "as seen": new trials need a
  /// place to start from.
  [[nodiscard]] std::vector<dynamics::Entry> entries() const;
  /// The name of start number `start` in tables: "start d 4 m, ..." if it was given, else "the
  /// start".
  [[nodiscard]] std::string name_of(std::size_t start) const;
  /// Counts of transitions, one matrix per cell type: those of the matrix file, or else of the gate
  /// runs that predict() has made (states are leaves of trees). Throws std::invalid_argument if
  /// there are no runs yet.
  [[nodiscard]] std::vector<dynamics::Transitions> matrices() const;
};

/// Predicts where bodies end, by a chain of trees. New runs are added to the source until the
/// accuracy is reached; recorded runs are used as they are. Throws std::invalid_argument for a
/// chain without trees or an accuracy outside (0, 1), and std::runtime_error if a run broke.
[[nodiscard]] PooledPrediction predict(Source& source, const dynamics::Work& work = {});

}  // namespace gatewalk::lattice
