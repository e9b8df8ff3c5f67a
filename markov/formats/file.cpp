// SPDX-License-Identifier: MIT
#include "markov/formats/file.h"

#include <fcntl.h>
#include <limits.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <utility>

namespace gatewalk::markov {
namespace {

[[noreturn]] void fail(const std::string& name, const std::string& reason) {
  throw std::runtime_error(name + ": cannot be written: " + reason);
}

[[noreturn]] void fail_with_errno(const std::string& name) {
  if (errno == EPIPE) throw BrokenPipe(name + ": cannot be written: " + std::strerror(errno));
  fail(name, std::strerror(errno));
}

class FileDescriptor {
 public:
  explicit FileDescriptor(int fd) : fd_(fd) {}
  ~FileDescriptor() { (void)close(); }
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;

  [[nodiscard]] int get() const { return fd_; }
  /// Closes the file. Returns false, with errno set, if the file system reports a late error.
  [[nodiscard]] bool close() {
    if (fd_ < 0) return true;
    return ::close(std::exchange(fd_, -1)) == 0;
  }

 private:
  int fd_;
};

// The temporary file in progress, for a signal handler.
char unfinished_name[PATH_MAX];
std::atomic<bool> is_unfinished{false};
static_assert(std::atomic<bool>::is_always_lock_free, "read in a signal handler");

std::string folder_of(const std::string& path) {
  const auto slash = path.find_last_of('/');
  if (slash == std::string::npos) return ".";
  return slash == 0 ? "/" : path.substr(0, slash);
}

/// A temporary file beside `path`, which its destructor removes unless it was renamed to `path`.
class Temporary {
 public:
  explicit Temporary(const std::string& path) {
    // The name is short, because the target's name may already have the largest length. A file of
    // this name is left over from a killed process with our number; it is not ours to remove.
    static std::atomic<unsigned> counter{0};
    do {
      name_ = folder_of(path) + "/.gatewalk-" + std::to_string(::getpid()) + "-" +
              std::to_string(counter++) + ".tmp";
      if (name_.size() >= sizeof unfinished_name) fail(path, std::strerror(ENAMETOOLONG));
      name_.copy(unfinished_name, name_.size());
      unfinished_name[name_.size()] = '\0';
      is_unfinished = true;
      fd_ = ::open(name_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
      if (fd_ < 0) is_unfinished = false;
    } while (fd_ < 0 && errno == EEXIST);
    if (fd_ < 0) fail_with_errno(path);
  }
  ~Temporary() {
    ::unlink(name_.c_str());  // fails after a rename, when the file is gone
    is_unfinished = false;
  }
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;

  /// The open file, which the caller closes.
  [[nodiscard]] int open_file() const { return fd_; }
  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  std::string name_;
  int fd_ = -1;
};

/// The kind of file at a writable path.
struct Target {
  bool is_stream = false;             // a pipe or a character device
  std::optional<mode_t> permissions;  // permissions of a regular file
};

Target target_at(const std::string& path) {
  if (path.empty()) fail("\"\"", "the name is empty");
  if (path.size() >= PATH_MAX) fail(path.substr(0, 60) + "...", std::strerror(ENAMETOOLONG));
  struct stat old = {};
  if (::lstat(path.c_str(), &old) != 0) {
    if (errno != ENOENT) fail_with_errno(path);
    return {};
  }
  const bool is_link = S_ISLNK(old.st_mode);
  if (is_link && ::stat(path.c_str(), &old) != 0) old.st_mode = S_IFREG;  // a dangling link
  const bool is_stream = S_ISFIFO(old.st_mode) || S_ISCHR(old.st_mode);
  if (is_link && !is_stream) fail(path, "is a symbolic link; name the file itself");
  if (S_ISDIR(old.st_mode)) fail(path, "is a directory");
  if (!is_stream && !S_ISREG(old.st_mode)) fail(path, "is not a regular file");
  if (::faccessat(AT_FDCWD, path.c_str(), W_OK, AT_EACCESS) != 0) fail_with_errno(path);
  if (is_stream) return {true, {}};
  // In a sticky folder such as /tmp, only the owner may replace a file.
  struct stat folder = {};
  const uid_t self = ::geteuid();
  if (::stat(folder_of(path).c_str(), &folder) == 0 && (folder.st_mode & S_ISVTX) && self != 0 &&
      self != old.st_uid && self != folder.st_uid)
    fail(path, std::strerror(EPERM));
  return {false, old.st_mode & 07777};
}

using MakeBytes = std::function<void(const WriteBytes&)>;

void write_made(const std::string& path, int descriptor, const MakeBytes& make) {
  make([&](std::string_view bytes) {
    if (!write_all(descriptor, bytes)) fail_with_errno(path);
  });
}

void write_into_stream(const std::string& path, const MakeBytes& make) {
  const IgnoreBrokenPipe guard;
  FileDescriptor stream(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
  if (stream.get() < 0) fail_with_errno(path);
  write_made(path, stream.get(), make);
  if (!stream.close()) fail_with_errno(path);
}

}  // namespace

IgnoreBrokenPipe::IgnoreBrokenPipe() {
  struct sigaction ignore = {};
  ignore.sa_handler = SIG_IGN;
  ::sigaction(SIGPIPE, &ignore, &old_);
}

IgnoreBrokenPipe::~IgnoreBrokenPipe() { ::sigaction(SIGPIPE, &old_, nullptr); }

bool write_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

void remove_unfinished_file() noexcept {
  if (is_unfinished) ::unlink(unfinished_name);
}

void require_replaceable(const std::string& path) {
  if (target_at(path).is_stream) return;
  const std::string folder = folder_of(path);
  struct stat found = {};
  if (::stat(folder.c_str(), &found) != 0)
    fail(path, "folder " + folder + ": " + std::strerror(errno));
  if (!S_ISDIR(found.st_mode)) fail(path, folder + " is no folder");
  // access() does not know all obstacles, such as read-only mounts and /proc.
  FileDescriptor(Temporary(path).open_file());
}

void replace_file(const std::string& path, std::string_view bytes) {
  replace_file(path, [bytes](const WriteBytes& write) { write(bytes); });
}

void replace_file(const std::string& path, const MakeBytes& make) {
  const Target target = target_at(path);
  if (target.is_stream) return write_into_stream(path, make);
  const std::string folder = folder_of(path);
  const FileDescriptor directory(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (directory.get() < 0) fail(path, "folder " + folder + ": " + std::strerror(errno));

  const Temporary temporary(path);
  FileDescriptor file(temporary.open_file());
  if (target.permissions && ::fchmod(file.get(), *target.permissions) != 0) fail_with_errno(path);
  write_made(path, file.get(), make);
  if (::fsync(file.get()) != 0 || !file.close() ||
      ::rename(temporary.name().c_str(), path.c_str()) != 0)
    fail_with_errno(path);
  // Some file systems cannot sync a folder and report EINVAL; nothing is lost there.
  if (::fsync(directory.get()) != 0 && errno != EINVAL)
    throw std::runtime_error(
        path + ": is written, but its folder could not be synced: " + std::strerror(errno));
}

}  // namespace gatewalk::markov
