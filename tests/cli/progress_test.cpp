// SPDX-License-Identifier: MIT
#include "cli/terminal/progress.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <functional>
#include <limits>
#include <regex>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "cli/terminal/interrupt.h"

namespace gatewalk::cli {
namespace {

using std::chrono::milliseconds;

// ---- Stopping

TEST(WatchedWorkDeathTest, StopsBetweenBatchesAfterASignal) {
  EXPECT_EXIT(
      {
        install_interrupt_handler();
        int calls = 0;
        try {
          watched_work(false).in_pieces("test", 1000, [&](dynamics::TrialRange) {
            if (++calls == 3) std::raise(SIGINT);
          });
        } catch (const Interrupted&) {
          std::_Exit(calls == 3 ? 7 : 2);
        }
        std::_Exit(1);
      },
      testing::ExitedWithCode(7), "");
}

TEST(WatchedWorkDeathTest, WorkThatIsDoneStaysDone) {
  EXPECT_EXIT(
      {
        install_interrupt_handler();
        watched_work(false).in_pieces("test", 1, [](dynamics::TrialRange) { std::raise(SIGINT); });
        std::_Exit(7);
      },
      testing::ExitedWithCode(7), "");
}

// ---- The line at a terminal

/// What `work` writes to standard error if this is a terminal of `columns` columns.
std::string on_terminal(unsigned short columns, const std::function<void()>& work) {
  const int master = ::posix_openpt(O_RDWR | O_NOCTTY);
  if (master < 0 || ::grantpt(master) != 0 || ::unlockpt(master) != 0) return "(no terminal)";
  const int slave = ::open(::ptsname(master), O_RDWR | O_NOCTTY);
  const winsize size = {24, columns, 0, 0};
  ::ioctl(slave, TIOCSWINSZ, &size);
  const int saved = ::dup(STDERR_FILENO);
  ::dup2(slave, STDERR_FILENO);
  work();
  ::dup2(saved, STDERR_FILENO);
  ::close(saved);
  ::fcntl(master, F_SETFL, O_NONBLOCK);
  std::string text;
  char chunk[4096];
  for (ssize_t length; (length = ::read(master, chunk, sizeof chunk)) > 0;) {
    text.append(chunk, static_cast<std::size_t>(length));
  }
  ::close(slave);
  ::close(master);
  return text;
}

std::size_t times(const std::string& text, char c) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), c));
}

TEST(WatchedWork, APartThatBeginsAgainIsAnotherRound) {
  std::ostringstream out;
  const dynamics::Work work = watched_work(true, {&out, milliseconds(0)});
  for (int round = 0; round < 2; ++round)
    for (const int done : {0, 1, 2, 4}) work.tell("trials", done, 4);
  EXPECT_NE(out.str().find("gatewalk: trials: 50 %"), std::string::npos) << out.str();
  EXPECT_NE(out.str().find("gatewalk: trials, round 2: 50 %"), std::string::npos) << out.str();
}

TEST(Progress, SaysHowFarItIsAndClearsTheLine) {
  const std::string text = on_terminal(80, [] {
    Progress progress("runs", 400, true);
    std::this_thread::sleep_for(milliseconds(250));
    progress.update(100);
    progress.finish();
    progress.finish();  // the destructor does not clear the line again
  });
  EXPECT_TRUE(std::regex_match(
      text, std::regex(
                "\rruns  25%  [0-9.e+]+/s  0:[0-9]{2} elapsed, 0:[0-9]{2} left\x1b\\[K\r\x1b\\[K")))
      << text;
}

TEST(Progress, RedrawsAtMostFiveTimesASecond) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  const std::string text = on_terminal(80, [start] {
    Progress progress("runs", 1'000'000'000'000, true);
    for (std::int64_t i = 1; Clock::now() - start < milliseconds(700); ++i) progress.update(i);
  });
  EXPECT_GE(times(text, '%'), 1u) << text;
  EXPECT_LE(times(text, '%'), static_cast<std::size_t>((Clock::now() - start) / milliseconds(200)))
      << text;
  EXPECT_TRUE(text.ends_with("\r\x1b[K")) << text;
}

TEST(Progress, NeverWraps) {
  const std::string text = on_terminal(20, [] {
    Progress progress("a label that alone is longer than the line", 4, true);
    std::this_thread::sleep_for(milliseconds(250));
    progress.update(1);
  });
  EXPECT_EQ(text, "\ra label that alone \x1b[K\r\x1b[K");
}

TEST(Progress, StaysSilentWhenShortOrUnwanted) {
  const auto silent = [](bool enabled, std::int64_t total, int wait_ms) {
    return on_terminal(80, [=] {
      Progress progress("runs", total, enabled);
      std::this_thread::sleep_for(milliseconds(wait_ms));
      progress.update(total / 2);
      progress.finish();
    });
  };
  EXPECT_EQ(silent(true, 10, 0), "");
  EXPECT_EQ(silent(false, 10, 250), "");
  EXPECT_EQ(silent(true, 0, 250), "");
}

TEST(Progress, StaysSilentWhereThereIsNoTerminal) {
  testing::internal::CaptureStderr();
  {
    Progress progress("runs", 10, true);
    std::this_thread::sleep_for(milliseconds(250));
    progress.update(5);
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

// ---- Lines, if standard error is no terminal

/// What `work` writes to its stream, with standard error in a file.
std::string in_lines(milliseconds every, const std::function<void(const Progress::Lines&)>& work) {
  std::ostringstream out;
  testing::internal::CaptureStderr();
  work({&out, every});
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  return out.str();
}

TEST(ProgressLines, SayHowLongAPartTakesThenHowFarItIs) {
  const std::string text = in_lines(milliseconds(300), [](const Progress::Lines& lines) {
    Progress progress("runs", 1000, true, lines);
    std::this_thread::sleep_for(milliseconds(20));
    progress.update(1);
    std::this_thread::sleep_for(milliseconds(310));
    progress.update(500);
  });
  EXPECT_TRUE(std::regex_match(text, std::regex("gatewalk: runs: some [0-9]+ s\n"
                                                "gatewalk: runs: 50 %, some [0-9]+ s left\n")))
      << text;
}

TEST(ProgressLines, SayNothingOfShortParts) {
  EXPECT_EQ(in_lines(milliseconds(60'000),
                     [](const Progress::Lines& lines) {
                       Progress progress("runs", 10, true, lines);
                       std::this_thread::sleep_for(milliseconds(50));
                       progress.update(5);
                     }),
            "");
}

TEST(ProgressLines, SayNothingWhereUnwanted) {
  EXPECT_EQ(in_lines(milliseconds(1),
                     [](const Progress::Lines& lines) {
                       Progress progress("runs", 1000, false, lines);
                       std::this_thread::sleep_for(milliseconds(20));
                       progress.update(1);
                     }),
            "");
}

// Many short parts also give lines in time. A part that comes again is timed anew.
TEST(ProgressLines, ComeInTimeAcrossShortParts) {
  const std::string text = in_lines(milliseconds(200), [](const Progress::Lines& lines) {
    const dynamics::Work work = watched_work(true, lines);
    for (int part = 0; part < 6; ++part) {
      work.tell("part " + std::to_string(part), 0, 2);
      std::this_thread::sleep_for(milliseconds(50));
      work.tell("part " + std::to_string(part), 1, 2);
      work.tell("part " + std::to_string(part), 2, 2);
    }
  });
  EXPECT_GE(times(text, '\n'), 1u) << text;
  EXPECT_TRUE(std::regex_search(text, std::regex("gatewalk: part [0-9]: (50 %, )?some [0-9]+ s")))
      << text;
}

TEST(ProgressLines, FollowATotalThatGrows) {
  const std::string text = in_lines(milliseconds(1), [](const Progress::Lines& lines) {
    const dynamics::Work work = watched_work(true, lines);
    work.tell("trials", 0, 10);
    std::this_thread::sleep_for(milliseconds(5));
    work.tell("trials", 9, 90);
    std::this_thread::sleep_for(milliseconds(5));
    work.tell("trials", 9, 90);
  });
  EXPECT_TRUE(text.find("trials: 10 %") != std::string::npos) << text;
}

}  // namespace
}  // namespace gatewalk::cli
