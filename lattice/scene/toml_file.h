// SPDX-License-Identifier: MIT
#pragma once
/// A scene or cell file, read once and parsed once, whatever is asked of it.

#include <memory>
#include <string>

namespace gatewalk::lattice {

/// Copies share what was read.
class TomlFile {
 public:
  /// Text in memory; `name` stands for the file in messages.
  TomlFile(std::string text, std::string name);
  /// Opens and reads `path` (-: standard input, which a process reads but once). A file that cannot
  /// be read, and a matrix, are refused by whoever asks for the text.
  [[nodiscard]] static TomlFile read(const std::string& path);

  /// The file as messages call it.
  [[nodiscard]] const std::string& name() const;
  /// Whether the file begins as a matrix does (HDF5). Then no more of it was read.
  [[nodiscard]] bool is_matrix() const;
  /// What was read: of a matrix its first bytes, of a file that is too large for a scene what
  /// shows that, nothing of a file that cannot be read.
  [[nodiscard]] const std::string& bytes() const;
  /// Whether that is the whole file.
  [[nodiscard]] bool is_whole() const;
  /// The terrain map that the file names, its path as seen from here. Empty when it names none, and
  /// for text that is no TOML.
  [[nodiscard]] std::string map_file() const;

  struct Parsed;
  /// Throws SceneError where the file cannot be read, or is a matrix.
  [[nodiscard]] const Parsed& parsed() const;

 private:
  explicit TomlFile(std::shared_ptr<const Parsed> parsed);
  std::shared_ptr<const Parsed> parsed_;
};

}  // namespace gatewalk::lattice
