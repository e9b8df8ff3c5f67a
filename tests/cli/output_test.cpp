#include "cli/output.h"

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
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

// These stand in front of the C library's in this test program: the k-th call can be made to fail.
namespace {
struct Faults {
  int fsync = 0, rename = 0;  // 0: none, k: the k-th from now
} faults;

bool strikes(int& countdown, int error) {
  if (countdown == 0 || --countdown > 0) return false;
  errno = error;
  return true;
}
}  // namespace

extern "C" int fsync(int fd) {
  return strikes(faults.fsync, EIO) ? -1 : static_cast<int>(::syscall(SYS_fsync, fd));
}

extern "C" int rename(const char* from, const char* to) noexcept {
  if (strikes(faults.rename, EIO)) return -1;
  return static_cast<int>(::syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0));
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

/// Files of root are out of reach while it lives, also for root.
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
  for (int i = 0; i < 200; ++i) {  // all names that this program takes first
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
  fs::create_symlink("/dev/full", path("link"));
  fs::create_symlink("nowhere", path("dangling"));
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  const auto before = names();
  EXPECT_EQ(refusal(path("folder"), "x"), path("folder") + ": cannot be written: is a directory");
  EXPECT_NE(refusal(path("folder/"), "x").find("is a directory"), std::string::npos);
  EXPECT_NE(
      refusal(path("link"), "x").find(path("link") + ": cannot be written: is a symbolic link"),
      std::string::npos);
  EXPECT_NE(refusal(path("dangling"), "x").find("is a symbolic link"), std::string::npos);
  EXPECT_EQ(refusal(path("pipe"), "x"),
            path("pipe") + ": cannot be written: is not a regular file");
  EXPECT_EQ(refusal("/dev/full", "x"), "/dev/full: cannot be written: is not a regular file");
  EXPECT_EQ(refusal("", "x"), "\"\": cannot be written: the name is empty");
  EXPECT_EQ(names(), before);
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

// ---- Standard output, in a child process

/// Ends with 0 and the text on descriptor `out`, or with 3 and the reason on standard error.
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

TEST_F(OutputDeathTest, AReaderThatWentAwayIsAnErrorAndNoSignal) {
  EXPECT_EXIT(
      {
        int ends[2];
        if (::pipe(ends) != 0) std::abort();
        ::close(ends[0]);
        child_writes_to(ends[1], "text");
      },
      testing::ExitedWithCode(3), "standard output: cannot be written: Broken pipe");
}

}  // namespace
}  // namespace gatewalk::cli
