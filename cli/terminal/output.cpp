// SPDX-License-Identifier: MIT
#include "cli/terminal/output.h"

#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <stdexcept>

#include "markov/formats/file.h"

namespace gatewalk::cli {
namespace {

namespace fs = std::filesystem;

std::atomic<bool> has_lost_reader{false};

void write_to_stdout(std::string_view text) {
  const markov::IgnoreBrokenPipe guard;
  errno = EIO;  // the error to report if std::cout had failed before
  // Flushes first, so that earlier output comes before `text`.
  if (std::cout.flush() && std::fflush(stdout) == 0 && markov::write_all(STDOUT_FILENO, text))
    return;
  const std::string reason =
      std::string("standard output: cannot be written: ") + std::strerror(errno);
  if (errno == EPIPE) throw markov::BrokenPipe(reason);
  throw std::runtime_error(reason);
}

}  // namespace

void require_writable(const std::string& path) {
  if (path != "-") markov::require_replaceable(path);
}

void write_text_atomically(const std::string& path, std::string_view text) try {
  if (path == "-") return write_to_stdout(text);
  markov::replace_file(path, text);
} catch (const markov::BrokenPipe&) {
  has_lost_reader = true;
}

bool reader_went_away() { return has_lost_reader; }

void require_possible_folder(const std::string& name) {
  fs::path folder = name;
  if (folder.empty()) throw std::runtime_error("\"\": the name of a folder is empty");
  std::error_code error;
  for (fs::file_status found; (found = fs::status(folder, error), !fs::is_directory(found));) {
    if (found.type() != fs::file_type::not_found)
      throw std::runtime_error(name + ": cannot be made: " +
                               (error ? error.message() : folder.string() + " is no folder"));
    const fs::path above = folder.has_parent_path() ? folder.parent_path() : fs::path(".");
    if (above == folder) break;
    if (folder.filename().string().size() > 255)
      throw std::runtime_error(name + ": cannot be made: " + std::strerror(ENAMETOOLONG));
    folder = above;
  }
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    throw std::runtime_error(name + ": cannot be written to: folder " + folder.string() + ": " +
                             std::strerror(errno));
}

void require_folder(const std::string& name) {
  std::error_code error;
  fs::create_directories(name, error);
  if (error) throw std::runtime_error(name + ": cannot be made: " + error.message());
  if (::access(name.c_str(), W_OK | X_OK) != 0)
    throw std::runtime_error(name + ": cannot be written to");
}

}  // namespace gatewalk::cli
