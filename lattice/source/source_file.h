// SPDX-License-Identifier: MIT
#pragma once
/// A file that sources are opened from, read once whatever is asked of it; and what only the
/// commands of this program ask of a source.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "lattice/field/matrix_file.h"
#include "lattice/pool/run_pool.h"
#include "lattice/scene/matrix.h"
#include "lattice/scene/scene.h"
#include "lattice/scene/settle.h"
#include "lattice/scene/toml_file.h"
#include "lattice/source/source.h"
#include "lattice/statistics/matrix_noise.h"

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

/// The method that was chosen for the scene, if it left that to a pilot.
[[nodiscard]] std::optional<Settled> settled_of(const Source& source);
/// Of a matrix of a scene.
[[nodiscard]] SceneMatrix scene_matrix_of(const Source& source);
/// Of a matrix of bins, or one that was made elsewhere: what the cells draw from.
[[nodiscard]] CountedField counted_of(const Source& source);
/// So finely (s) durations of trials are kept: to a thousandth of the time after which a body is
/// trapped, or else of the mean duration of some trials.
[[nodiscard]] double bin_of_durations(const Source& source, std::uint64_t seed);

}  // namespace gatewalk::lattice
