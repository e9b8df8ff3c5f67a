// SPDX-License-Identifier: MIT
#pragma once
/// Files that are replaced as a whole, so that a reader never sees half of one.

#include <csignal>
#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace gatewalk::markov {

/// Thrown when the reader of a pipe is gone before everything is written.
class BrokenPipe : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Replaces the file `path` by `bytes`, or leaves it as it was: writes, syncs and renames a
/// temporary file in the same folder, then syncs the folder. An existing file keeps its
/// permissions; a new one follows the umask. Pipes and character devices (/dev/null, >(command))
/// cannot be replaced and are written into. Links to anything else, folders, sockets and block
/// devices are refused. Throws std::runtime_error naming the file and the reason, BrokenPipe for a
/// pipe without a reader. No temporary file stays behind.
void replace_file(const std::string& path, std::string_view bytes);

/// Receives the next bytes of a file.
using WriteBytes = std::function<void(std::string_view bytes)>;
/// As replace_file with bytes that `make` writes piece by piece. If `make` throws, `path` stays as
/// it was.
void replace_file(const std::string& path, const std::function<void(const WriteBytes&)>& make);

/// Throws std::runtime_error, as replace_file would, if `path` cannot be written; call it before
/// long work. Makes and removes a temporary file in the folder.
void require_replaceable(const std::string& path);

/// While an IgnoreBrokenPipe exists, a pipe without a reader makes write() fail instead of ending
/// the process.
class IgnoreBrokenPipe {
 public:
  IgnoreBrokenPipe();
  ~IgnoreBrokenPipe();
  IgnoreBrokenPipe(const IgnoreBrokenPipe&) = delete;
  IgnoreBrokenPipe& operator=(const IgnoreBrokenPipe&) = delete;

 private:
  struct sigaction old_;
};

/// Writes all of `bytes`. Returns false, with errno set, if that fails.
[[nodiscard]] bool write_all(int descriptor, std::string_view bytes);

/// Removes the temporary file of a replace_file in progress, if there is one. For signal handlers
/// that end the process: all calls are async-signal-safe.
void remove_unfinished_file() noexcept;

}  // namespace gatewalk::markov
