#include "cli/figure.h"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <stdexcept>

namespace gatewalk::cli {
namespace {

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

[[noreturn]] void fail(const std::string& what, int error) {
  throw std::runtime_error("gnuplot cannot be run: " + what + ": " + std::strerror(error));
}

/// A file without a name: nothing to clean up, and unlike a pipe it never blocks or breaks.
File scratch_file() {
  File file(std::tmpfile(), std::fclose);
  if (!file) fail("no temporary file", errno);
  return file;
}

std::string text_of(std::FILE* file) {
  std::rewind(file);
  std::string text;
  char part[4096];
  for (std::size_t n; (n = std::fread(part, 1, sizeof part, file)) > 0;) text.append(part, n);
  if (std::ferror(file) != 0) fail("its output cannot be read", errno);
  return text;
}

}  // namespace

std::string drawn(const std::string& script) {
  const File in = scratch_file(), out = scratch_file(), errors = scratch_file();
  if (std::fwrite(script.data(), 1, script.size(), in.get()) != script.size() ||
      std::fflush(in.get()) != 0)
    fail("its script cannot be written", errno);
  std::rewind(in.get());

  posix_spawn_file_actions_t files;
  if (const int error = ::posix_spawn_file_actions_init(&files); error != 0)
    fail("no memory", error);
  int error = 0;
  std::FILE* const wanted[] = {in.get(), out.get(), errors.get()};
  for (int target = 0; target < 3 && error == 0; ++target)
    error = ::posix_spawn_file_actions_adddup2(&files, ::fileno(wanted[target]), target);
  // As a named file, so that gnuplot's complaints have line numbers and any error ends it.
  char name[] = "gnuplot", script_name[] = "/dev/stdin";
  char* const arguments[] = {name, script_name, nullptr};
  pid_t child = 0;
  if (error == 0) error = ::posix_spawnp(&child, name, &files, nullptr, arguments, environ);
  ::posix_spawn_file_actions_destroy(&files);
  if (error == ENOENT)
    throw std::runtime_error("gnuplot was not found; it draws the figures (Debian: gnuplot-nox)");
  if (error != 0) fail("it does not start", error);

  int status = 0;
  while (::waitpid(child, &status, 0) < 0)
    if (errno != EINTR) fail("it was lost", errno);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    std::string words = text_of(errors.get());
    words.erase(words.find_last_not_of(" \t\n") + 1);
    words.erase(0, words.find_first_not_of(" \t\n"));
    throw std::runtime_error("gnuplot failed: " + (words.empty() ? "it said nothing" : words));
  }
  return text_of(out.get());
}

}  // namespace gatewalk::cli
