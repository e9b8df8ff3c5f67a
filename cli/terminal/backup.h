// SPDX-License-Identifier: MIT
#pragma once
/// What an output replaces is kept.

#include <string>

namespace gatewalk::cli {

/// The file at a path that is about to be replaced, kept beside it as PATH.~1~: under the first of
/// 99 numbers that is free. Nothing is kept of an empty file, a pipe or a device.
class Backup {
 public:
  /// Throws std::runtime_error naming the file when it cannot be kept.
  explicit Backup(std::string path);
  ~Backup() { (void)settle(); }
  Backup(const Backup&) = delete;
  Backup& operator=(const Backup&) = delete;

  /// To be called when the path has been written, or could not be. Returns the backup's name; empty
  /// when there is none, and when the path holds the same bytes as before: then the backup goes.
  std::string settle() noexcept;

 private:
  std::string path_, name_;
};

}  // namespace gatewalk::cli
