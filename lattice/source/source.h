// SPDX-License-Identifier: MIT
#pragma once
/// What is asked about, wherever it comes from: a scene of gates, a matrix of one, cells that
/// another program carries out, recorded runs, or a chain that was made elsewhere.

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/base/work.h"
#include "dynamics/cells/cell.h"
#include "lattice/field/problem.h"
#include "lattice/pool/pooled_prediction.h"
#include "lattice/scene/cell_file.h"
#include "lattice/scene/matrix.h"
#include "lattice/scene/settle.h"
#include "lattice/scene/toml_file.h"

namespace gatewalk::lattice {

/// A file, opened once by all that ask for it. One thread at a time may ask.
class SourceFile {
 public:
  /// "-": standard input. What cannot be read is refused by whoever asks for what it holds.
  /// Standard input is read when it is asked for first, a file now.
  explicit SourceFile(std::string path) : path_(std::move(path)) {
    if (path_ != "-") toml_ = TomlFile::read(path_);
  }
  /// A scene or cell file in memory.
  explicit SourceFile(TomlFile text) : path_(text.name()), toml_(std::move(text)) {}

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] const TomlFile& toml() const;
  /// Standard input is none, and is not read to say so.
  [[nodiscard]] bool is_matrix() const { return path_ != "-" && toml().is_matrix(); }
  /// The matrix, read when it is asked for first. Throws markov::BadFile.
  [[nodiscard]] const std::shared_ptr<const MatrixFile>& matrix() const;
  /// Whether it is a matrix of cells that are not ours. Throws as matrix().
  [[nodiscard]] bool is_of_cells() const;
  /// The scene that a matrix of gates keeps. Throws markov::BadFile.
  [[nodiscard]] const Scene& own_scene() const;
  /// Reads all of a matrix now, also the gate runs that it keeps, and keeps it in memory: each
  /// Source copies the runs. Throws markov::BadFile and SceneError.
  void keep_in_memory();
  /// These runs, in the field of own_scene(), if they are in memory.
  [[nodiscard]] const std::optional<RunPool>& runs() const { return runs_; }

 private:
  std::string path_;
  mutable std::optional<TomlFile> toml_;
  mutable std::shared_ptr<const MatrixFile> matrix_;
  mutable std::optional<Scene> own_scene_;
  std::optional<RunPool> runs_;
};

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
  std::optional<CellFile> cells{};           // ... of cells that are not ours
  std::shared_ptr<const MatrixFile> file{};  // it was read from
  /// Of trees: the gate runs that there are, none yet of a scene or a program. Without: of bins.
  std::optional<RunPool> pool{};
  /// While the scene leaves its method to a pilot, the problem has no cells.
  Problem problem{};
  AccuracyOptions accuracy{};  // of trees: as their file was made for
  /// Where bodies start, or (none) as recorded bodies were seen to enter first.
  std::vector<std::optional<dynamics::Entry>> starts{};
  bool starts_given = false;          // by start_from(); else they are its own
  bool is_imported = false;           // a chain that was made elsewhere
  std::optional<Settled> settled{};   // the method that was chosen for the scene
  std::vector<std::string> doubts{};  // what the file or its runs cannot tell, a sentence each

  /// Opens a scene, a cell file or a matrix. A scene's method may be left to a pilot, which
  /// choose_method() or predict() runs. Throws SceneError naming file, line and key,
  /// markov::BadFile, and std::invalid_argument.
  [[nodiscard]] static Source open(const SourceFile& file, const SourceOptions& options = {});
  [[nodiscard]] static Source open(const std::string& path, const SourceOptions& options = {}) {
    return open(SourceFile(path), options);
  }
  /// Bodies start as these texts say (start_text.h), or its states by name or number; without any
  /// at its own start. Returns what is doubtful about these starts. Throws std::invalid_argument
  /// where they are malformed, outside the gates, or of no state with runs.
  [[nodiscard]] std::vector<std::string> start_from(const std::vector<std::string>& texts);
  /// Chooses the method that a scene leaves to a pilot, if it does.
  void choose_method(std::uint64_t seed, const dynamics::Work& work = {});

  [[nodiscard]] bool is_recorded() const { return cells && problem.is_recorded(); }
  /// Throws std::invalid_argument where one is "as seen", which is no place to start new trials at.
  [[nodiscard]] std::vector<dynamics::Entry> entries() const;
  /// "start d 4 m, ..." of a start that was given, else "the start".
  [[nodiscard]] std::string name_of(std::size_t start) const;
  /// Of a matrix of a scene.
  [[nodiscard]] SceneMatrix matrix() const { return {file, *scene}; }
  /// Of a matrix: one for each type of cell.
  [[nodiscard]] std::vector<dynamics::Transitions> matrices() const;
  /// Of a matrix of bins, or one that was made elsewhere: what the cells draw from.
  [[nodiscard]] CountedField counted() const;
  /// So finely (s) durations of trials are kept: to a thousandth of the time after which a body is
  /// trapped, or else of the mean duration of some trials.
  [[nodiscard]] double bin_of_durations(std::uint64_t seed) const;
};

/// The prediction of a chain of trees: by its runs, to which others are added until the accuracy is
/// kept; by recorded runs as they are. Throws std::invalid_argument where there are no trees, and
/// as predict_pooled.
[[nodiscard]] PooledPrediction predict(Source& source, const dynamics::Work& work = {});

}  // namespace gatewalk::lattice
