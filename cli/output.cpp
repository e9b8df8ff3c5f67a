#include "cli/output.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <optional>
#include <stdexcept>
#include <utility>

namespace gatewalk::cli {
namespace {

[[noreturn]] void fail(const std::string& name, const std::string& reason) {
  throw std::runtime_error(name + ": cannot be written: " + reason);
}

[[noreturn]] void fail_with_errno(const std::string& name) { fail(name, std::strerror(errno)); }

class FileDescriptor {
 public:
  explicit FileDescriptor(int fd) : fd_(fd) {}
  ~FileDescriptor() { (void)close(); }
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;

  [[nodiscard]] int get() const { return fd_; }
  /// False, with errno, when the file system reports a late error.
  [[nodiscard]] bool close() {
    if (fd_ < 0) return true;
    return ::close(std::exchange(fd_, -1)) == 0;
  }

 private:
  int fd_;
};

/// Leaves no temporary file behind; once it is renamed there is none to unlink.
class Unlinker {
 public:
  explicit Unlinker(std::string path) : path_(std::move(path)) {}
  ~Unlinker() { ::unlink(path_.c_str()); }
  Unlinker(const Unlinker&) = delete;
  Unlinker& operator=(const Unlinker&) = delete;

 private:
  std::string path_;
};

/// While it lives, a reader that went away is an error of write(), not the end of the process.
class IgnoreBrokenPipe {
 public:
  IgnoreBrokenPipe() {
    struct sigaction ignore = {};
    ignore.sa_handler = SIG_IGN;
    ::sigaction(SIGPIPE, &ignore, &old_);
  }
  ~IgnoreBrokenPipe() { ::sigaction(SIGPIPE, &old_, nullptr); }
  IgnoreBrokenPipe(const IgnoreBrokenPipe&) = delete;
  IgnoreBrokenPipe& operator=(const IgnoreBrokenPipe&) = delete;

 private:
  struct sigaction old_ = {};
};

bool write_all(int fd, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(fd, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

void write_to_stdout(std::string_view text) {
  const std::string name = "standard output";
  const IgnoreBrokenPipe guard;
  errno = EIO;  // stands when std::cout had failed before
  // Flush first: what was printed before comes before.
  if (!std::cout.flush() || std::fflush(stdout) != 0 || !write_all(STDOUT_FILENO, text)) {
    fail_with_errno(name);
  }
}

/// Permissions of the file at `path`, none if there is none. Throws unless it can be replaced.
std::optional<mode_t> old_permissions(const std::string& path) {
  if (path.empty()) fail("\"\"", "the name is empty");
  struct stat old = {};
  if (::lstat(path.c_str(), &old) == 0) {
    if (S_ISDIR(old.st_mode)) fail(path, "is a directory");
    if (S_ISLNK(old.st_mode)) fail(path, "is a symbolic link; name the file itself");
    if (!S_ISREG(old.st_mode)) fail(path, "is not a regular file");
    if (::faccessat(AT_FDCWD, path.c_str(), W_OK, AT_EACCESS) != 0) fail_with_errno(path);
    return old.st_mode & 07777;
  }
  if (errno != ENOENT) fail_with_errno(path);
  return std::nullopt;
}

std::string folder_of(const std::string& path) {
  const std::filesystem::path parent = std::filesystem::path(path).parent_path();
  return parent.empty() ? std::string(".") : parent.string();
}

}  // namespace

void require_writable(const std::string& path) {
  if (path == "-") return;
  old_permissions(path);
  const std::string folder = folder_of(path);
  struct stat found = {};
  if (::stat(folder.c_str(), &found) != 0) fail(path, "folder " + folder + ": " + std::strerror(errno));
  if (!S_ISDIR(found.st_mode)) fail(path, folder + " is no folder");
  if (::faccessat(AT_FDCWD, folder.c_str(), W_OK, AT_EACCESS) != 0)
    fail(path, "folder " + folder + ": " + std::strerror(errno));
}

void write_text_atomically(const std::string& path, std::string_view text) {
  if (path == "-") return write_to_stdout(text);
  const std::optional<mode_t> permissions = old_permissions(path);
  const std::string folder = folder_of(path);
  const FileDescriptor directory(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (directory.get() < 0) fail(path, "folder " + folder + ": " + std::strerror(errno));

  // A short name of its own: the target's may already be as long as a name can be. One that exists
  // was left by a process with our number that was killed; it is not ours to remove.
  static std::atomic<unsigned> counter{0};
  std::string temporary;
  int fd = -1;
  do {
    temporary = folder + "/.gatewalk-" + std::to_string(::getpid()) + "-"
                + std::to_string(counter++) + ".tmp";
    fd = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  } while (fd < 0 && errno == EEXIST);
  if (fd < 0) fail_with_errno(path);
  FileDescriptor file(fd);
  const Unlinker unlinker(temporary);

  if ((permissions && ::fchmod(file.get(), *permissions) != 0) || !write_all(file.get(), text)
      || ::fsync(file.get()) != 0 || !file.close()
      || ::rename(temporary.c_str(), path.c_str()) != 0) {
    fail_with_errno(path);
  }
  // Some file systems cannot sync a directory and say EINVAL; nothing is lost there.
  if (::fsync(directory.get()) != 0 && errno != EINVAL) {
    throw std::runtime_error(
        path + ": is written, but its folder could not be synced: " + std::strerror(errno));
  }
}

}  // namespace gatewalk::cli
