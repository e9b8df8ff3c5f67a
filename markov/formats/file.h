// SPDX-License-Identifier: MIT
#pragma once
/// Files that are replaced as a whole: a reader never sees half of one.

#include <csignal>
#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace gatewalk::markov {

/// The reader of a pipe went away before everything was written.
class BrokenPipe : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Replaces `path` by `bytes`, or leaves it as it was: a temporary file beside it is written,
/// synced and renamed, then the folder is synced. An existing file keeps its permissions, a new one
/// follows the umask. A pipe or a character device (/dev/null, >(command)) cannot be replaced and
/// is written into; links to anything else, folders, sockets and block devices are refused. Throws
/// std::runtime_error naming the file and the reason, BrokenPipe where a pipe has no reader any
/// more; no temporary file stays behind.
void replace_file(const std::string& path, std::string_view bytes);

/// Takes the next bytes of a file.
using WriteBytes = std::function<void(std::string_view bytes)>;
/// The same with bytes that `make` hands on piece by piece; what it throws leaves `path` as it was.
void replace_file(const std::string& path, const std::function<void(const WriteBytes&)>& make);

/// Throws std::runtime_error, as replace_file would, when `path` cannot be written: to be asked
/// before long work, not after it. Makes and removes a temporary file in its folder.
void require_replaceable(const std::string& path);

/// While it lives, a reader that went away is an error of write(), not the end of the process.
class IgnoreBrokenPipe {
 public:
  IgnoreBrokenPipe();
  ~IgnoreBrokenPipe();
  IgnoreBrokenPipe(const IgnoreBrokenPipe&) = delete;
  IgnoreBrokenPipe& operator=(const IgnoreBrokenPipe&) = delete;

 private:
  struct sigaction old_;
};

/// Writes all of `bytes`. False, with errno, when that fails.
[[nodiscard]] bool write_all(int descriptor, std::string_view bytes);

/// Removes the temporary file of a replace_file under way, if there is one. For signal handlers
/// that end the process: makes async-signal-safe calls only.
void remove_unfinished_file() noexcept;

}  // namespace gatewalk::markov
