// SPDX-License-Identifier: MIT
#include "cli/terminal/interrupt.h"

#include <fmt/core.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <cstring>

#include "markov/formats/file.h"

namespace gatewalk::cli {
namespace {

std::atomic<bool> asked_to_stop{false};
static_assert(std::atomic<bool>::is_always_lock_free, "touched from a signal handler");

// The signal handler reads this text, so it is written before is_kept is set.
std::array<char, 4608> kept_text{};
std::atomic<bool> is_kept{false};

void on_signal(int) {
  if (asked_to_stop.exchange(true)) {
    markov::remove_unfinished_file();
    ::_exit(stopped_status());
  }
  ::alarm(1);  // a second for work that does not come in batches
}

void on_alarm(int) {
  // Only async-signal-safe calls are allowed here.
  markov::remove_unfinished_file();
  const char* const text = is_kept ? kept_text.data() : kCutShortText;
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, text, std::strlen(text));
  ::_exit(stopped_status());
}

}  // namespace

void install_interrupt_handler() {
  struct sigaction action = {};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART;  // a write under way continues
  sigemptyset(&action.sa_mask);
  struct sigaction alarm_action = action;
  alarm_action.sa_handler = on_alarm;
  ::sigaction(SIGALRM, &alarm_action, nullptr);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGUSR1}) {
    // A signal that was ignored at the start stays ignored: nohup, background jobs of a script.
    struct sigaction inherited = {};
    ::sigaction(signal, nullptr, &inherited);
    if (inherited.sa_handler != SIG_IGN) ::sigaction(signal, &action, nullptr);
  }
}

void set_kept_file(const std::string& file) {
  is_kept = false;
  if (file.empty()) return;
  const std::string text = fmt::format(
      "gatewalk: stopped before the end; what is done is kept in {}: the same command with "
      "--resume goes on\n",
      file);
  kept_text[text.copy(kept_text.data(), kept_text.size() - 1)] = '\0';
  is_kept = true;
}

const char* stopped_text() noexcept { return is_kept ? kept_text.data() : kStoppedText; }

int stopped_status() noexcept { return is_kept ? 75 : 130; }

bool interrupted() { return asked_to_stop.load(); }

}  // namespace gatewalk::cli
