// SPDX-License-Identifier: MIT
#include "cli/terminal/backup.h"

#include <fmt/core.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace gatewalk::cli {
namespace {

namespace fs = std::filesystem;

constexpr int kMostBackups = 99;

/// Keeps the file `from` also as `to`: by a hard link, or a copy if the file system has none.
/// Returns false if `to` exists already. Throws std::system_error.
bool kept_as(const std::string& from, const std::string& to) {
  if (::link(from.c_str(), to.c_str()) == 0) return true;
  if (errno == EEXIST) return false;
  if (errno != EPERM && errno != EOPNOTSUPP && errno != EMLINK)
    throw std::system_error(errno, std::generic_category());
  std::error_code error;
  if (fs::copy_file(from, to, error)) return true;
  if (error == std::errc::file_exists) return false;
  ::unlink(to.c_str());  // remove the incomplete copy
  throw std::system_error(error);
}

/// Whether two files hold the same bytes; false if one of them cannot be read.
bool have_same_bytes(const std::string& a, const std::string& b) {
  std::error_code error;
  if (fs::equivalent(a, b, error)) return true;
  if (error || fs::file_size(a, error) != fs::file_size(b, error) || error) return false;
  std::ifstream one(a, std::ios::binary), other(b, std::ios::binary);
  using Bytes = std::istreambuf_iterator<char>;
  return one && other && std::equal(Bytes(one), Bytes(), Bytes(other), Bytes());
}

}  // namespace

Backup::Backup(std::string path) : path_(std::move(path)) {
  struct stat old = {};
  if (::lstat(path_.c_str(), &old) != 0 || !S_ISREG(old.st_mode) || old.st_size == 0) return;
  for (int i = 1; i <= kMostBackups; ++i) {
    std::string name = fmt::format("{}.~{}~", path_, i);
    try {
      if (!kept_as(path_, name)) continue;
    } catch (const std::system_error& e) {
      throw std::runtime_error(
          fmt::format("{}: is there and cannot be kept as {}: {}; --force replaces it", path_, name,
                      e.code().message()));
    }
    name_ = std::move(name);
    return;
  }
  throw std::runtime_error(
      fmt::format("{}: is there, and so are {} backups of it, {}.~1~ and so on: remove some; "
                  "--force replaces it without a backup",
                  path_, kMostBackups, path_));
}

std::string Backup::settle() noexcept {
  if (name_.empty() || !have_same_bytes(path_, name_)) return std::exchange(name_, {});
  ::unlink(name_.c_str());
  name_.clear();
  return {};
}

}  // namespace gatewalk::cli
