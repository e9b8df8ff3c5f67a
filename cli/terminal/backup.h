// SPDX-License-Identifier: MIT
#pragma once
/// Keeps a copy of a file that an output replaces.

#include <string>

namespace gatewalk::cli {

/// The file at a path before it is replaced, kept beside it as PATH.~1~ or under the first free
/// number up to 99. An empty file, a pipe or a device is not kept.
class Backup {
 public:
  /// Throws std::runtime_error naming the file when it cannot be kept.
  explicit Backup(std::string path);
  ~Backup() { (void)settle(); }
  Backup(const Backup&) = delete;
  Backup& operator=(const Backup&) = delete;

  /// Ends the backup; to be called when the path has been written, or could not be. Returns the
  /// backup's name. If the path holds the same bytes as before, removes the backup and returns an
  /// empty text.
  std::string settle() noexcept;

 private:
  std::string path_, name_;
};

}  // namespace gatewalk::cli
