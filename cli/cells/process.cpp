// SPDX-License-Identifier: MIT
#include "cli/cells/process.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstring>
#include <ctime>
#include <stdexcept>

namespace gatewalk::cli {
namespace {

constexpr std::size_t kKeptComplaints = 4000;  // bytes
constexpr int kToldComplaints = 12;            // lines
/// Time (s) that a program which closed its pipes gets to end by itself and to say why.
constexpr double kGrace = 0.5;

[[noreturn]] void refuse_start(const std::string& command, int error) {
  throw std::runtime_error(fmt::format("cell program '{}' cannot be started: {}", excerpt(command),
                                       std::strerror(error)));
}

struct Pipe {
  Descriptor read, write;
};

/// A pipe that child processes do not inherit, except where it is passed to them.
Pipe make_pipe(const std::string& command) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) refuse_start(command, errno);
  return {Descriptor(ends[0]), Descriptor(ends[1])};
}

void never_wait_at(const Descriptor& end) {
  ::fcntl(end.get(), F_SETFL, ::fcntl(end.get(), F_GETFL) | O_NONBLOCK);
}

/// Starts `/bin/sh -c SCRIPT` in a process group (0: a new one). `files` are its standard input,
/// output and error; -1 is /dev/null.
pid_t start_shell(const std::string& script, const std::array<int, 3>& files, pid_t group,
                  const std::string& command) {
  posix_spawn_file_actions_t actions;
  if (const int error = ::posix_spawn_file_actions_init(&actions); error != 0)
    refuse_start(command, error);
  posix_spawnattr_t attributes;
  if (const int error = ::posix_spawnattr_init(&attributes); error != 0) {
    ::posix_spawn_file_actions_destroy(&actions);
    refuse_start(command, error);
  }
  sigset_t none, broken_pipe;
  sigemptyset(&none);
  sigemptyset(&broken_pipe);
  sigaddset(&broken_pipe, SIGPIPE);
  ::posix_spawnattr_setpgroup(&attributes, group);
  ::posix_spawnattr_setsigmask(&attributes, &none);
  ::posix_spawnattr_setsigdefault(&attributes, &broken_pipe);
  int error = ::posix_spawnattr_setflags(
      &attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  for (int target = 0; target < 3 && error == 0; ++target)
    error = files[target] < 0
                ? ::posix_spawn_file_actions_addopen(&actions, target, "/dev/null", O_RDWR, 0)
                : ::posix_spawn_file_actions_adddup2(&actions, files[target], target);
  pid_t id = 0;
  // Decimal points in every program; text stays UTF-8 where that locale exists.
  std::string words[] = {"sh", "-c", "export LC_ALL=C.UTF-8; " + script};
  char* const arguments[] = {words[0].data(), words[1].data(), words[2].data(), nullptr};
  if (error == 0) error = ::posix_spawn(&id, "/bin/sh", &actions, &attributes, arguments, environ);
  ::posix_spawnattr_destroy(&attributes);
  ::posix_spawn_file_actions_destroy(&actions);
  if (error != 0) refuse_start(command, error);
  return id;
}

void collect(pid_t& id) {
  if (id == 0) return;
  while (::waitpid(id, nullptr, 0) < 0 && errno == EINTR) {
  }
  id = 0;
}

/// During the object's life, writing to a closed pipe fails in this thread's write() and does not
/// end the process. Signals of other threads are not touched.
class NoBrokenPipe {
 public:
  NoBrokenPipe() {
    sigemptyset(&signal_);
    sigaddset(&signal_, SIGPIPE);
    sigset_t pending;
    ::sigpending(&pending);
    was_pending_ = sigismember(&pending, SIGPIPE) == 1;
    ::pthread_sigmask(SIG_BLOCK, &signal_, &old_);
  }
  ~NoBrokenPipe() {
    const timespec at_once{};
    if (!was_pending_)
      while (::sigtimedwait(&signal_, nullptr, &at_once) < 0 && errno == EINTR) {
      }
    ::pthread_sigmask(SIG_SETMASK, &old_, nullptr);
  }
  NoBrokenPipe(const NoBrokenPipe&) = delete;
  NoBrokenPipe& operator=(const NoBrokenPipe&) = delete;

 private:
  sigset_t signal_, old_;
  bool was_pending_ = false;
};

/// The last lines of the text, indented, each on a line of its own.
std::string last_lines(std::string_view text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.remove_suffix(1);
  std::size_t from = text.size();
  for (int lines = 0; lines < kToldComplaints && from != text.npos && from > 0; ++lines)
    from = text.rfind('\n', from - 1);
  text.remove_prefix(from == text.npos || from == text.size() ? 0 : from);
  std::string lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    if (end > 0) lines += "\n  " + excerpt(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

}  // namespace

std::string excerpt(std::string_view text, std::size_t most) {
  std::string words(text.substr(0, most));
  for (char& c : words)
    if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') c = c == '\t' ? ' ' : '?';
  return text.size() > most ? words + "..." : words;
}

void Descriptor::close() {
  if (number_ >= 0) ::close(number_);
  number_ = -1;
}

Process::Process(std::string command, double timeout_s)
    : command_(std::move(command)), timeout_s_(timeout_s) {
  Pipe in = make_pipe(command_), output = make_pipe(command_), errors = make_pipe(command_),
       life = make_pipe(command_);
  try {
    watcher_ = start_shell("read _; kill -KILL 0", {life.read.get(), -1, -1}, 0, command_);
    program_ = start_shell(command_, {in.read.get(), output.write.get(), errors.write.get()},
                           watcher_, command_);
  } catch (...) {
    kill();
    throw;
  }
  in_ = std::move(in.write);
  output_ = std::move(output.read);
  errors_ = std::move(errors.read);
  life_ = std::move(life.write);
  for (const Descriptor* end : {&in_, &output_, &errors_}) never_wait_at(*end);
}

Process::~Process() {
  in_.close();
  if (program_ != 0) let_end(kGrace);
  kill();
}

void Process::kill() {
  if (watcher_ != 0) ::kill(-watcher_, SIGKILL);
  collect(program_);
  collect(watcher_);
}

std::optional<std::string> Process::ended() const {
  siginfo_t info = {};
  if (program_ == 0 ||
      ::waitid(P_PID, static_cast<id_t>(program_), &info, WEXITED | WNOHANG | WNOWAIT) != 0 ||
      info.si_pid == 0)
    return {};
  if (info.si_code == CLD_EXITED) return fmt::format("ended with status {}", info.si_status);
  return fmt::format("ended by signal {} ({})", info.si_status, ::strsignal(info.si_status));
}

std::optional<std::string> Process::let_end(double seconds) {
  const auto until = Clock::now() + std::chrono::duration<double>(seconds);
  std::string rest;  // read and thrown away
  for (;;) {
    const auto how = ended();  // asked first, so that all output before the end can be read below
    if (output_.get() >= 0 && !read_some(output_, rest)) output_.close();
    read_complaints();
    rest.clear();
    if (how || Clock::now() >= until) return how;
    pollfd files[] = {{output_.get(), POLLIN, 0}, {errors_.get(), POLLIN, 0}};
    ::poll(files, 2, 2);  // ms; poll() cannot also wait for the end of the process
  }
}

void Process::fail(const std::string& what) {
  read_complaints();
  kill();
  const std::string words = last_lines(complaints_);
  throw std::runtime_error(fmt::format("cell program '{}': {}{}", excerpt(command_), what,
                                       words.empty()
                                           ? "; it wrote nothing to standard error"
                                           : "; its last words on standard error:" + words));
}

void Process::fail_as_ended(const std::string& else_it) {
  fail(fmt::format("it {} while a line was awaited", let_end(kGrace).value_or(else_it)));
}

void Process::write_some() {
  const NoBrokenPipe guard;
  while (!out_.empty()) {
    const ssize_t n = ::write(in_.get(), out_.data(), out_.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0 && errno == EAGAIN) return;
    if (n < 0) fail_as_ended("closed its standard input");
    out_.erase(0, static_cast<std::size_t>(n));
  }
}

bool Process::read_some(Descriptor& from, std::string& text) {
  std::array<char, kMostLine> part;
  for (;;) {
    const ssize_t n = ::read(from.get(), part.data(), part.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return errno == EAGAIN;
    text.append(part.data(), static_cast<std::size_t>(n));
    return n > 0;
  }
}

void Process::read_complaints() {
  if (errors_.get() < 0) return;
  if (!read_some(errors_, complaints_)) errors_.close();
  if (complaints_.size() > kKeptComplaints)
    complaints_.erase(0, complaints_.size() - kKeptComplaints);
}

void Process::exchange() {
  text_.erase(0, taken_);
  taken_ = 0;
  const bool had_to_write = !out_.empty();
  for (;;) {
    const double waited = std::chrono::duration<double>(Clock::now() - waits_since_).count();
    const double left = std::clamp(timeout_s_ - waited, 0.0, 1e6);
    pollfd files[] = {{output_.get(), POLLIN, 0},
                      {errors_.get(), POLLIN, 0},
                      {in_.get(), static_cast<short>(out_.empty() ? 0 : POLLOUT), 0}};
    if (::poll(files, 3, static_cast<int>(std::ceil(1e3 * left))) < 0 && errno != EINTR)
      fail(std::string("it cannot be waited for: ") + std::strerror(errno));
    if (files[1].revents != 0) read_complaints();
    if ((files[2].revents & POLLERR) != 0) fail_as_ended("closed its standard input");
    if (files[2].revents != 0) write_some();
    if (files[0].revents != 0 && !read_some(output_, text_))
      fail_as_ended("closed its standard output");
    if (left == 0.0 && text_.find('\n') == text_.npos)
      fail(fmt::format("it wrote no line for {} s", std::lround(waited)));
    if (files[0].revents != 0 || (had_to_write && out_.empty())) return;
  }
}

std::optional<std::string_view> Process::line() {
  const std::string_view rest = std::string_view(text_).substr(taken_);
  const std::size_t end = rest.find('\n');
  if (std::min(end, rest.size()) > kMostLine)
    fail(fmt::format("it wrote a line of more than {} bytes: '{}'", kMostLine, excerpt(rest, 40)));
  if (end == rest.npos) return {};
  taken_ += end + 1;
  waits_since_ = Clock::now();
  return rest.substr(0, end > 0 && rest[end - 1] == '\r' ? end - 1 : end);
}

std::string_view Process::wait_for_line() {
  for (;;) {
    if (const auto found = line()) return *found;
    exchange();
  }
}

}  // namespace gatewalk::cli
