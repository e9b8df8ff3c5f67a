#include "cli/terminal/interrupt.h"

#include <unistd.h>

#include <atomic>
#include <csignal>

#include "markov/formats/file.h"

namespace gatewalk::cli {
namespace {

std::atomic<bool> asked_to_stop{false};
static_assert(std::atomic<bool>::is_always_lock_free, "touched from a signal handler");

void on_signal(int) {
  if (asked_to_stop.exchange(true)) {
    markov::remove_unfinished_file();
    ::_exit(130);
  }
  ::alarm(1);  // work that does not come in batches is given a second
}

void on_alarm(int) {
  // Only async-signal-safe calls here.
  markov::remove_unfinished_file();
  [[maybe_unused]] const auto written =
      ::write(STDERR_FILENO, kCutShortText, sizeof kCutShortText - 1);
  ::_exit(130);
}

}  // namespace

void install_interrupt_handler() {
  struct sigaction action = {};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART;  // a write under way goes on
  sigemptyset(&action.sa_mask);
  struct sigaction alarm_action = action;
  alarm_action.sa_handler = on_alarm;
  ::sigaction(SIGALRM, &alarm_action, nullptr);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    // What was ignored by whoever started us stays so: nohup, jobs in the background of a script.
    struct sigaction inherited = {};
    ::sigaction(signal, nullptr, &inherited);
    if (inherited.sa_handler != SIG_IGN) ::sigaction(signal, &action, nullptr);
  }
}

bool interrupted() { return asked_to_stop.load(); }

}  // namespace gatewalk::cli
