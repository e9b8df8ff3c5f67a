// SPDX-License-Identifier: MIT
#include "cli/terminal/child.h"

#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <stdexcept>
#include <string_view>

namespace gatewalk::cli {
namespace {

/// Reads a whole file into `text`; returns false, with errno set, when it cannot be read.
bool read_all(std::FILE* file, std::string& text) {
  std::rewind(file);
  char part[4096];
  for (std::size_t n; (n = std::fread(part, 1, sizeof part, file)) > 0;) text.append(part, n);
  return std::ferror(file) == 0;
}

/// This program's environment with the C locale, in which numbers have a decimal point, as
/// gnuplot's scripts and ffmpeg's arguments need.
std::vector<char*> plain_environment() {
  static char locale[] = "LC_ALL=C";  // LC_ALL overrides all other locale variables
  std::vector<char*> all{locale};
  for (char* const* at = environ; *at != nullptr; ++at)
    if (!std::string_view(*at).starts_with("LC_ALL=")) all.push_back(*at);
  all.push_back(nullptr);
  return all;
}

}  // namespace

File scratch_file() {
  // A file in memory, so that gnuplot and ffmpeg can finish even when the disk is full.
  const int id = ::memfd_create("gatewalk", MFD_CLOEXEC);
  File file(id < 0 ? nullptr : ::fdopen(id, "w+b"), std::fclose);
  if (!file && id >= 0) ::close(id);
  if (!file) throw std::runtime_error(std::string("no temporary file: ") + std::strerror(errno));
  return file;
}

Child::Child(std::vector<std::string> arguments, int in, const std::string& missing)
    : name_(arguments.at(0)), out_(scratch_file()), errors_(scratch_file()) {
  std::vector<char*> words;
  for (std::string& argument : arguments) words.push_back(argument.data());
  words.push_back(nullptr);

  posix_spawn_file_actions_t files;
  if (const int error = ::posix_spawn_file_actions_init(&files); error != 0)
    fail("no memory", error);
  posix_spawnattr_t attributes;
  if (const int error = ::posix_spawnattr_init(&attributes); error != 0) {
    ::posix_spawn_file_actions_destroy(&files);
    fail("no memory", error);
  }
  int error = ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  const int wanted[] = {in, ::fileno(out_.get()), ::fileno(errors_.get())};
  for (int target = 0; target < 3 && error == 0; ++target)
    error = ::posix_spawn_file_actions_adddup2(&files, wanted[target], target);
  if (error == 0)
    error = ::posix_spawnp(&id_, words[0], &files, &attributes, words.data(),
                           plain_environment().data());
  ::posix_spawnattr_destroy(&attributes);
  ::posix_spawn_file_actions_destroy(&files);
  if (error != 0) id_ = 0;  // posix_spawnp may leave it undefined
  if (error == ENOENT) throw std::runtime_error(missing);
  if (error != 0) fail("it does not start", error);
}

Child::~Child() {
  if (id_ == 0) return;
  ::kill(id_, SIGKILL);
  while (::waitpid(id_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

void Child::fail(const std::string& what, int error) const {
  throw std::runtime_error(name_ + " cannot be run: " + what + ": " + std::strerror(error));
}

void Child::collect(int options) {
  while (id_ != 0) {
    const pid_t ended = ::waitpid(id_, &status_, options);
    if (ended == 0) return;
    if (ended < 0 && errno == EINTR) continue;
    id_ = 0;
    if (ended < 0) fail("it was lost", errno);
  }
}

bool Child::runs() {
  collect(WNOHANG);
  return id_ != 0;
}

std::string Child::output() {
  collect(0);
  std::string text;
  if (!WIFEXITED(status_) || WEXITSTATUS(status_) != 0) {
    if (!read_all(errors_.get(), text)) fail("its words cannot be read", errno);
    text.erase(text.find_last_not_of(" \t\n") + 1);
    text.erase(0, text.find_first_not_of(" \t\n"));
    throw std::runtime_error(name_ + " failed: " + (text.empty() ? "it said nothing" : text));
  }
  if (!read_all(out_.get(), text)) fail("its output cannot be read", errno);
  return text;
}

}  // namespace gatewalk::cli
