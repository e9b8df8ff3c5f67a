// SPDX-License-Identifier: MIT
#pragma once
/// A scene or cell file that is read and parsed only once.

#include <memory>
#include <string>

namespace gatewalk::lattice {

/// A TOML file in memory. Copies share its contents.
class TomlFile {
 public:
  /// Text in memory; `name` stands for the file in messages.
  TomlFile(std::string text, std::string name);
  /// Reads `path` (-: standard input, which a process reads only once). A file that cannot be read,
  /// and a matrix, are refused only when the text is asked for.
  [[nodiscard]] static TomlFile read(const std::string& path);

  /// The file's name in messages.
  [[nodiscard]] const std::string& name() const;
  /// True if the file begins as a matrix does (HDF5); then only its beginning was read.
  [[nodiscard]] bool is_matrix() const;
  /// The bytes that were read: the first ones of a matrix, one more than allowed of a file that is
  /// too large, none of a file that cannot be read.
  [[nodiscard]] const std::string& bytes() const;
  /// True if bytes() is the whole file.
  [[nodiscard]] bool is_whole() const;
  /// Path of the terrain map that the file names, relative to the working folder. Empty if there is
  /// none, or if the text is not TOML.
  [[nodiscard]] std::string map_file() const;

  struct Parsed;
  /// The parsed document. Throws SceneError if the file cannot be read, or is a matrix.
  [[nodiscard]] const Parsed& parsed() const;

 private:
  explicit TomlFile(std::shared_ptr<const Parsed> parsed);
  std::shared_ptr<const Parsed> parsed_;
};

}  // namespace gatewalk::lattice
