// SPDX-License-Identifier: MIT
#pragma once
/// A file that sources are opened from, read only once; and questions about a source that only the
/// commands of this program ask.

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

/// A file that is read once, at first use. Only one thread at a time may use it.
class SourceFile {
 public:
  /// `path`: "-" is standard input, which is read at first use; a file is read at once. A file with
  /// bad contents is refused when its contents are asked for.
  explicit SourceFile(std::string path) : path_(std::move(path)) {
    if (path_ != "-") toml_ = TomlFile::read(path_);
  }
  /// A scene or cell file in memory.
  explicit SourceFile(TomlFile text) : path_(text.name()), toml_(std::move(text)) {}

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] const TomlFile& toml() const;
  /// False for standard input, which is not read for this.
  [[nodiscard]] bool is_matrix() const { return path_ != "-" && toml().is_matrix(); }
  /// The matrix, read at first use. Throws markov::BadFile.
  [[nodiscard]] const std::shared_ptr<const MatrixFile>& matrix() const;
  /// True for a matrix of cells that are not gates. Throws as matrix().
  [[nodiscard]] bool is_of_cells() const;
  /// The scene that a matrix of gates keeps. Throws markov::BadFile.
  [[nodiscard]] const Scene& own_scene() const;
  /// Reads the whole matrix now, with its gate runs, and keeps it in memory; each Source copies the
  /// runs. Throws markov::BadFile and SceneError.
  void keep_in_memory();
  /// The gate runs in the field of own_scene(), if keep_in_memory() has read them.
  [[nodiscard]] const std::optional<RunPool>& runs() const { return runs_; }

 private:
  std::string path_;
  mutable std::optional<TomlFile> toml_;
  mutable std::shared_ptr<const MatrixFile> matrix_;
  mutable std::optional<Scene> own_scene_;
  std::optional<RunPool> runs_;
};

/// The method that a pilot chose for the scene, if the scene left it open.
[[nodiscard]] std::optional<Settled> settled_of(const Source& source);
/// The matrix and scene of a source that is a matrix of a scene.
[[nodiscard]] SceneMatrix scene_matrix_of(const Source& source);
/// The counts and chain of a matrix of bins, or of an imported chain.
[[nodiscard]] CountedField counted_of(const Source& source);
/// Resolution (s) to which durations of trials are kept: a thousandth of the time after which a
/// body is trapped, or of the mean duration of some trials.
[[nodiscard]] double bin_of_durations(const Source& source, std::uint64_t seed);

}  // namespace gatewalk::lattice
