#include "cli/interrupt.h"

#include <unistd.h>

#include <atomic>
#include <csignal>

namespace gatewalk::cli {
namespace {

std::atomic<bool> asked_to_stop{false};
static_assert(std::atomic<bool>::is_always_lock_free, "touched from a signal handler");

void on_signal(int) {
  if (asked_to_stop.exchange(true)) ::_exit(130);
}

}  // namespace

void install_interrupt_handler() {
  struct sigaction action = {};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART;  // a write under way goes on
  sigemptyset(&action.sa_mask);
  for (const int signal : {SIGINT, SIGTERM}) ::sigaction(signal, &action, nullptr);
}

bool interrupted() { return asked_to_stop.load(); }

}  // namespace gatewalk::cli
