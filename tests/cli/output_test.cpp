// SPDX-License-Identifier: MIT
#include "cli/terminal/output.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "cli/terminal/backup.h"
#include "cli/terminal/interrupt.h"

// In this test program these functions replace the C library's, so that the k-th call can fail.
namespace {
struct Faults {
  int fsync = 0, rename = 0;       // 0: none fails; k: the k-th from now fails
  int link = 0;                    // calls that fail: no hard links
  std::function<void()> at_fsync;  // called before a sync
} faults;

bool strikes(int& countdown, int error) {
  if (countdown == 0 || --countdown > 0) return false;
  errno = error;
  return true;
}
}  // namespace

extern "C" int fsync(int fd) {
  if (faults.at_fsync) faults.at_fsync();
  return strikes(faults.fsync, EIO) ? -1 : static_cast<int>(::syscall(SYS_fsync, fd));
}

extern "C" int rename(const char* from, const char* to) noexcept {
  if (strikes(faults.rename, EIO)) return -1;
  return static_cast<int>(::syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0));
}

extern "C" int link(const char* from, const char* to) noexcept {
  if (faults.link > 0) {
    --faults.link;
    errno = EPERM;
    return -1;
  }
  return static_cast<int>(::syscall(SYS_linkat, AT_FDCWD, from, AT_FDCWD, to, 0));
}

namespace gatewalk::cli {
namespace {

namespace fs = std::filesystem;

class Output : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "gatewalk-output-XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    folder_ = name;
    faults = {};
  }
  void TearDown() override {
    faults = {};
    ::chmod(folder_.c_str(), 0700);
    fs::remove_all(folder_);
  }

  [[nodiscard]] std::string path(const std::string& name) const {
    return (folder_ / name).string();
  }

  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> found;
    for (const auto& entry : fs::directory_iterator(folder_))
      found.push_back(entry.path().filename());
    std::sort(found.begin(), found.end());
    return found;
  }

  fs::path folder_;
};

std::string read(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

std::string refusal(const std::string& path, std::string_view text) {
  try {
    write_text_atomically(path, text);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "(written)";
}

/// During the object's life, files of root are out of reach, even if root runs the test.
class Unprivileged {
 public:
  Unprivileged() : old_(::geteuid()) {
    if (old_ == 0) dropped_ = ::seteuid(65534) == 0;
  }
  ~Unprivileged() {
    if (old_ == 0 && ::seteuid(old_) != 0) std::abort();
  }
  [[nodiscard]] bool holds() const { return old_ != 0 || dropped_; }

 private:
  uid_t old_;
  bool dropped_ = false;
};

TEST_F(Output, WritesEveryByte) {
  std::string text(3'000'000, 'x');
  for (std::size_t i = 0; i < text.size(); ++i) text[i] = static_cast<char>(i * i % 251);
  write_text_atomically(path("a"), text);
  EXPECT_EQ(read(path("a")), text);
  write_text_atomically(path("a"), "");
  EXPECT_EQ(read(path("a")), "");
  EXPECT_EQ(names(), std::vector<std::string>{"a"});
}

TEST_F(Output, TakesANameAsLongAsAFileCanHave) {
  const std::string name(255, 'n');
  write_text_atomically(path(name), "text");
  EXPECT_EQ(read(path(name)), "text");
}

TEST_F(Output, IsNotStoppedByWhatAKilledProcessLeft) {
  for (int i = 0; i < 200; ++i) {  // takes all names that this program tries first
    const std::string name = std::to_string(::getpid()) + "-" + std::to_string(i);
    std::ofstream(path(".gatewalk-" + name + ".tmp")) << "left";
  }
  write_text_atomically(path("a"), "text");
  EXPECT_EQ(read(path("a")), "text");
  EXPECT_EQ(names().size(), 201u);
}

TEST_F(Output, WritesInTheWorkingFolder) {
  const fs::path before = fs::current_path();
  fs::current_path(folder_);
  const std::string what = refusal("plain", "text");
  fs::current_path(before);
  EXPECT_EQ(what, "(written)");
  EXPECT_EQ(read(path("plain")), "text");
}

TEST_F(Output, NewFileFollowsTheUmaskAndAnOldOneKeepsItsPermissions) {
  const mode_t before = ::umask(027);
  write_text_atomically(path("a"), "one");
  ::umask(before);
  struct stat status = {};
  ASSERT_EQ(::stat(path("a").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 07777, 0640u);

  for (const mode_t mode : {0606u, 0200u}) {
    ASSERT_EQ(::chmod(path("a").c_str(), mode), 0);
    write_text_atomically(path("a"), "two");
    ASSERT_EQ(::stat(path("a").c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 07777, mode);
  }
  ::chmod(path("a").c_str(), 0600);
  EXPECT_EQ(read(path("a")), "two");
}

TEST_F(Output, AReaderOfTheOldFileKeepsTheOldText) {
  write_text_atomically(path("a"), "old");
  std::ifstream reader(path("a"));
  write_text_atomically(path("a"), "new and longer");
  std::string text;
  reader >> text;
  EXPECT_EQ(text, "old");
}

TEST_F(Output, RefusesTargetsThatAreNoRegularFile) {
  fs::create_directory(path("folder"));
  fs::create_symlink("nowhere", path("dangling"));
  std::ofstream(path("regular")) << "old";
  fs::create_symlink("regular", path("link"));
  const auto before = names();
  EXPECT_EQ(refusal(path("folder"), "x"), path("folder") + ": cannot be written: is a directory");
  EXPECT_NE(refusal(path("folder/"), "x").find("is a directory"), std::string::npos);
  EXPECT_NE(
      refusal(path("link"), "x").find(path("link") + ": cannot be written: is a symbolic link"),
      std::string::npos);
  EXPECT_NE(refusal(path("dangling"), "x").find("is a symbolic link"), std::string::npos);
  EXPECT_EQ(refusal("", "x"), "\"\": cannot be written: the name is empty");
  EXPECT_EQ(names(), before);
  EXPECT_EQ(read(path("regular")), "old");
}

TEST_F(Output, WritesIntoAPipe) {
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  fs::create_symlink("pipe", path("link"));  // as /dev/fd/63 of a shell's >(command)
  const std::string text(200'000, 'x');      // more than a pipe holds
  for (const char* name : {"pipe", "link"}) {
    std::string seen;
    std::thread reader([&] { seen = read(path("pipe")); });
    EXPECT_EQ(refusal(path(name), text), "(written)");
    reader.join();
    EXPECT_TRUE(seen == text) << name;
    EXPECT_EQ(names(), (std::vector<std::string>{"link", "pipe"}));
  }
}

TEST_F(Output, WritesIntoADevice) {
  EXPECT_EQ(refusal("/dev/null", "x"), "(written)");
  EXPECT_EQ(refusal("/dev/full", "x"), "/dev/full: cannot be written: No space left on device");
}

TEST_F(Output, SaysBeforehandWhatCannotBeWritten) {
  const auto complaint = [](const std::string& name) {
    try {
      require_writable(name);
    } catch (const std::runtime_error& error) {
      return std::string(error.what());
    }
    return std::string("(fine)");
  };
  std::ofstream(path("a")) << "old";
  fs::create_directory(path("folder"));
  EXPECT_EQ(complaint(path("a")), "(fine)");
  EXPECT_EQ(complaint(path("new")), "(fine)");
  EXPECT_EQ(complaint("-"), "(fine)");
  EXPECT_EQ(complaint("/dev/null"), "(fine)");
  EXPECT_EQ(complaint(path("folder")), path("folder") + ": cannot be written: is a directory");
  EXPECT_NE(complaint(path("missing/a")).find("No such file"), std::string::npos);
  EXPECT_NE(complaint(path("a/b")).find("Not a directory"), std::string::npos);
  EXPECT_NE(complaint(path(std::string(256, 'n'))).find("File name too long"), std::string::npos);
  std::string deep = folder_.string();
  while (deep.size() < 5000) deep += "/deep";
  EXPECT_NE(complaint(deep).find("File name too long"), std::string::npos);
  EXPECT_NE(complaint("/proc/gatewalk").find("/proc/gatewalk: cannot be written"),
            std::string::npos);
  EXPECT_EQ(names(), (std::vector<std::string>{"a", "folder"}));  // no temporary file stays behind
}

TEST_F(Output, AFolderIsPossibleWhereItCanBeMade) {
  const auto complaint = [](const std::string& name) {
    try {
      require_possible_folder(name);
    } catch (const std::runtime_error& error) {
      return std::string(error.what());
    }
    return std::string("(fine)");
  };
  std::ofstream(path("file")) << "old";
  EXPECT_EQ(complaint(folder_.string()), "(fine)");
  EXPECT_EQ(complaint(path("a/b/c/")), "(fine)");
  EXPECT_EQ(complaint("relative"), "(fine)");
  EXPECT_NE(complaint(path("file")).find("is no folder"), std::string::npos);
  EXPECT_NE(complaint(path("file/a/b")).find("cannot be made"), std::string::npos);
  EXPECT_NE(complaint(path("a/" + std::string(256, 'n') + "/b")).find("cannot be made"),
            std::string::npos);
  EXPECT_NE(complaint("").find("empty"), std::string::npos);
  EXPECT_EQ(names(), std::vector<std::string>{"file"});  // no folder was made
}

TEST_F(Output, NamesAFolderThatIsMissing) {
  const std::string what = refusal(path("missing/a"), "x");
  EXPECT_EQ(what.find(path("missing/a") + ": cannot be written: "), 0u) << what;
  EXPECT_NE(what.find("No such file or directory"), std::string::npos) << what;
  EXPECT_NE(refusal(path("missing/"), "x").find("No such file or directory"), std::string::npos);
  write_text_atomically(path("file"), "old");
  EXPECT_NE(refusal(path("file/a"), "x").find("Not a directory"), std::string::npos);
  EXPECT_EQ(names(), std::vector<std::string>{"file"});
}

TEST_F(Output, RefusesAReadOnlyFolderAndAReadOnlyFile) {
  write_text_atomically(path("a"), "old");
  ::chmod(path("a").c_str(), 0666);
  ::chmod(folder_.c_str(), 0555);
  std::string new_file, old_file;
  {
    const Unprivileged nobody;
    if (!nobody.holds()) GTEST_SKIP() << "root that cannot become somebody else";
    new_file = refusal(path("b"), "x");
    old_file = refusal(path("a"), "x");
  }
  EXPECT_EQ(new_file, path("b") + ": cannot be written: Permission denied");
  EXPECT_EQ(old_file, path("a") + ": cannot be written: Permission denied");

  ::chmod(folder_.c_str(), 0777);
  ::chmod(path("a").c_str(), 0444);
  {
    const Unprivileged nobody;
    old_file = refusal(path("a"), "x");
  }
  EXPECT_EQ(old_file, path("a") + ": cannot be written: Permission denied");
  EXPECT_EQ(read(path("a")), "old");
  EXPECT_EQ(names(), std::vector<std::string>{"a"});
}

TEST_F(Output, AWriteThatFailsHalfwayLeavesTheOldFile) {
  write_text_atomically(path("a"), "old");
  rlimit before = {};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const rlimit tight = {100'000, before.rlim_max};
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &tight), 0);
  const std::string what = refusal(path("a"), std::string(200'000, 'x'));
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_EQ(what, path("a") + ": cannot be written: File too large");
  EXPECT_EQ(read(path("a")), "old");
  EXPECT_EQ(names(), std::vector<std::string>{"a"});
}

TEST_F(Output, ASyncOrRenameThatFailsLeavesTheOldFile) {
  write_text_atomically(path("a"), "old");
  for (int* fault : {&faults.fsync, &faults.rename}) {
    *fault = 1;
    EXPECT_EQ(refusal(path("a"), "new"), path("a") + ": cannot be written: Input/output error");
    EXPECT_EQ(*fault, 0);
    EXPECT_EQ(read(path("a")), "old");
    EXPECT_EQ(names(), std::vector<std::string>{"a"});
  }
}

TEST_F(Output, AFolderThatCannotBeSyncedIsNoSilentSuccess) {
  faults.fsync = 2;
  EXPECT_EQ(refusal(path("a"), "new"),
            path("a") + ": is written, but its folder could not be synced: Input/output error");
  EXPECT_EQ(read(path("a")), "new");
  EXPECT_EQ(names(), std::vector<std::string>{"a"});
}

// ---- Backups of files that an output replaces

TEST_F(Output, WhatIsReplacedIsKeptUnderTheFirstFreeNumber) {
  for (const std::string text : {"first", "second", "third"}) {
    Backup old(path("a"));
    write_text_atomically(path("a"), text);
    const std::string kept = old.settle();
    EXPECT_EQ(kept, text == "first" ? "" : path(text == "second" ? "a.~1~" : "a.~2~"));
  }
  EXPECT_EQ(read(path("a")) + read(path("a.~1~")) + read(path("a.~2~")), "thirdfirstsecond");
  fs::remove(path("a.~1~"));
  Backup old(path("a"));
  fs::remove(path("a"));
  EXPECT_EQ(old.settle(), path("a.~1~"));
  EXPECT_EQ(read(path("a.~1~")), "third");
  EXPECT_EQ(old.settle(), "");
  EXPECT_EQ(names(), (std::vector<std::string>{"a.~1~", "a.~2~"}));
}

TEST_F(Output, WhatStaysAsItWasNeedsNoBackup) {
  write_text_atomically(path("a"), "text");
  ::chmod(path("a").c_str(), 0600);
  { const Backup unused(path("a")); }
  for (const std::string text : {"text", "texts"}) {
    Backup old(path("a"));
    write_text_atomically(path("a"), text);
    EXPECT_EQ(old.settle(), text == "text" ? "" : path("a.~1~"));
  }
  struct stat status = {};
  ASSERT_EQ(::stat(path("a.~1~").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 07777, 0600u);
  EXPECT_EQ(names(), (std::vector<std::string>{"a", "a.~1~"}));
}

TEST_F(Output, AWriteThatFailsLeavesNoBackup) {
  write_text_atomically(path("a"), "old");
  {
    const Backup old(path("a"));
    faults.rename = 1;
    EXPECT_NE(refusal(path("a"), "new"), "(written)");
  }
  EXPECT_EQ(read(path("a")), "old");
  EXPECT_EQ(names(), std::vector<std::string>{"a"});
}

TEST_F(Output, NothingIsKeptOfWhatCannotBeLost) {
  std::ofstream(path("empty"));
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  for (const std::string& name :
       {path("none"), path("empty"), path("pipe"), std::string("/dev/null")}) {
    Backup old(name);
    EXPECT_EQ(old.settle(), "") << name;
  }
  EXPECT_EQ(names(), (std::vector<std::string>{"empty", "pipe"}));
}

TEST_F(Output, WhatCannotBeKeptIsRefused) {
  const auto refused = [](const std::string& name) {
    try {
      const Backup old(name);
    } catch (const std::runtime_error& error) {
      return std::string(error.what());
    }
    return std::string("(kept)");
  };
  const std::string longest(255, 'n');
  write_text_atomically(path(longest), "old");
  EXPECT_NE(refused(path(longest)).find("File name too long; --force replaces it"),
            std::string::npos);
  write_text_atomically(path("a"), "old");
  for (int i = 1; i <= 99; ++i) {
    EXPECT_EQ(refused(path("a")), "(kept)") << i;
    write_text_atomically(path("a.~" + std::to_string(i) + "~"), "older");
  }
  EXPECT_NE(refused(path("a")).find("99 backups of it"), std::string::npos) << refused(path("a"));
  EXPECT_EQ(names().size(), 101u);
}

TEST_F(Output, AFileThatMayHaveNoSecondNameIsCopied) {
  write_text_atomically(path("a"), "old");
  faults.link = 3;  // first backup, then the second's two names
  Backup old(path("a"));
  Backup another(path("a"));
  write_text_atomically(path("a"), "new");
  EXPECT_EQ(old.settle(), path("a.~1~"));
  EXPECT_EQ(another.settle(), path("a.~2~"));
  EXPECT_EQ(read(path("a.~1~")) + read(path("a.~2~")), "oldold");
}

// ---- Signals in the middle of a write, in a child process

using UnfinishedDeathTest = Output;

TEST_F(UnfinishedDeathTest, AnEndByASignalLeavesTheOldFileAlone) {
  std::ofstream(path("a")) << "old";
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    EXPECT_EXIT(
        {
          install_interrupt_handler();
          faults.at_fsync = [&] {
            if (names().size() != 2) std::_Exit(1);  // the temporary file is there
            std::raise(signal);
            std::raise(signal);
          };
          write_text_atomically(path("a"), "new");
          std::_Exit(2);
        },
        testing::ExitedWithCode(130), "");
    EXPECT_EQ(read(path("a")), "old");
    EXPECT_EQ(names(), std::vector<std::string>{"a"});
  }
}

TEST_F(UnfinishedDeathTest, AWriteThatTakesTooLongAfterASignalLeavesTheOldFileAlone) {
  std::ofstream(path("a")) << "old";
  EXPECT_EXIT(
      {
        install_interrupt_handler();
        faults.at_fsync = [] {
          std::raise(SIGTERM);
          for (int i = 0; i < 60; ++i) ::usleep(50'000);
        };
        write_text_atomically(path("a"), "new");
        std::_Exit(2);
      },
      testing::ExitedWithCode(130), "every file is whole");
  EXPECT_EQ(read(path("a")), "old");
  EXPECT_EQ(names(), std::vector<std::string>{"a"});
}

// ---- Standard output, in a child process

/// Writes the text to descriptor `out` and exits with 0, or with 3 and the reason on standard
/// error.
[[noreturn]] void child_writes_to(int out, std::string_view text) {
  ::dup2(out, STDOUT_FILENO);
  const std::string what = refusal("-", text);
  std::cerr << what;
  ::_exit(what == "(written)" ? 0 : 3);
}

using OutputDeathTest = Output;

TEST_F(OutputDeathTest, DashIsStandardOutput) {
  EXPECT_EXIT(
      {
        const int out = ::open(path("out").c_str(), O_WRONLY | O_CREAT, 0600);
        ::dup2(out, STDOUT_FILENO);
        std::cout << "before ";
        child_writes_to(out, "text");
      },
      testing::ExitedWithCode(0), "");
  EXPECT_EQ(read(path("out")), "before text");
  EXPECT_FALSE(fs::exists("-"));
}

TEST_F(OutputDeathTest, FullStandardOutputIsAnError) {
  EXPECT_EXIT(child_writes_to(::open("/dev/full", O_WRONLY), "text"), testing::ExitedWithCode(3),
              "standard output: cannot be written: No space left on device");
}

TEST_F(OutputDeathTest, ClosedStandardOutputIsAnError) {
  EXPECT_EXIT(
      {
        ::close(STDOUT_FILENO);
        child_writes_to(-1, "text");
      },
      testing::ExitedWithCode(3), "standard output: cannot be written: Bad file descriptor");
}

TEST_F(OutputDeathTest, AReaderThatWentAwayIsRememberedAndNoSignal) {
  EXPECT_EXIT(
      {
        int ends[2];
        if (::pipe(ends) != 0) std::abort();
        ::close(ends[0]);
        ::dup2(ends[1], STDOUT_FILENO);
        const bool before = reader_went_away();
        write_text_atomically("-", "text");
        ::_exit(!before && reader_went_away() ? 7 : 0);
      },
      testing::ExitedWithCode(7), "^$");
}

}  // namespace
}  // namespace gatewalk::cli
