// SPDX-License-Identifier: MIT
#include "cli/terminal/interrupt.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>

namespace gatewalk::cli {
namespace {

// Each test runs in a child process, because the flag of a signal stays set.

TEST(InterruptDeathTest, FirstSignalIsOnlyNoted) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    EXPECT_EXIT(
        {
          install_interrupt_handler();
          if (interrupted()) std::_Exit(1);
          std::raise(signal);
          std::_Exit(interrupted() ? 7 : 2);
        },
        testing::ExitedWithCode(7), "");
  }
}

TEST(InterruptDeathTest, WorkWithoutASafePointEndsWithinTwoSeconds) {
  EXPECT_EXIT(
      {
        install_interrupt_handler();
        std::raise(SIGINT);
        for (int i = 0; i < 40; ++i) ::usleep(50'000);
        std::_Exit(1);
      },
      testing::ExitedWithCode(130), "stopped before the end");
}

TEST(InterruptDeathTest, SecondSignalEndsAtOnce) {
  for (const int first : {SIGINT, SIGTERM, SIGHUP}) {
    for (const int second : {SIGINT, SIGTERM, SIGHUP}) {
      EXPECT_EXIT(
          {
            install_interrupt_handler();
            std::raise(first);
            std::raise(second);
            std::_Exit(1);
          },
          testing::ExitedWithCode(130), "");
    }
  }
}

TEST(InterruptDeathTest, AnInheritedIgnoredSignalStaysIgnored) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    EXPECT_EXIT(
        {
          std::signal(signal, SIG_IGN);
          install_interrupt_handler();
          std::raise(signal);
          std::raise(signal);
          std::_Exit(interrupted() ? 1 : 7);
        },
        testing::ExitedWithCode(7), "");
  }
}

}  // namespace
}  // namespace gatewalk::cli
