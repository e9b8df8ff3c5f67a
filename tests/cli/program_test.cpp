// SPDX-License-Identifier: MIT
#include "cli/cells/program.h"
#include "cli/cells/hello.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "dynamics/cells/check_cell.h"
#include "dynamics/disc/disc_section.h"
#include "dynamics/disc/gate.h"
#include "tests/support/numbers.h"
#include "tests/support/threads.h"

namespace gatewalk::cli {
namespace {

using namespace dynamics;

// Most programs here are scripts of Debian's /bin/sh.

std::string saying(const std::string& more = "") {
  return R"(printf '%s\n' '{"gatewalk": 1, "coordinates": [{"name": "s", "unit": "m", "scale": 1}], )"
         R"("costs": [{"key": "time_s", "unit": "s"}], "faces": [{"name": "S", "move": [0, 1]}, )"
         R"({"name": "N", "move": [0, -1]}])" +
         more + "}'; ";
}
/// A program that answers every line with what a shell makes of `answer`.
std::string answering(const std::string& answer, const std::string& more = "") {
  return saying(more) + "while read -r id face s seed memory; do [ -z \"$id\" ] || " + answer +
         "; done";
}
const std::string kFine = answering("echo $id left S $s 1 -");

Body body_at(const Cell& cell, double s, std::uint64_t trial = 0) {
  Body body{.entry = {0, {s}},
            .random = Random(Purpose::field, {.seed = 1, .row = 2, .trial = trial})};
  cell.begin(body);
  return body;
}
Passage pass_at(const Cell& cell, double s) {
  Body body = body_at(cell, s);
  return cell.pass(body);
}

/// The first passages of 40 trials, computed on `threads` threads.
std::vector<Passage> passages_of(const Cell& cell, int threads = 1) {
  std::vector<Passage> all(40);
  test::on_threads(threads, [&] {
    Health health;
    carry_out_trials(
        cell, std::ssize(all),
        [&](Body& body) {
          body.entry = {0, {0.25}};
          body.random = Random(Purpose::field, {.trial = static_cast<std::uint64_t>(body.trial)});
          cell.begin(body);
        },
        [&](Body& body, const Passage& passage) {
          all[static_cast<std::size_t>(body.trial)] = passage;
          return false;
        },
        health);
  });
  return all;
}

/// The error message when the cell of this program is started and used.
std::string error_of(const std::string& command, const ProgramOptions& options = {}) {
  try {
    const ProgramCell cell(command, options);
    (void)passages_of(cell);
  } catch (const std::runtime_error& e) {
    return e.what();
  }
  return "nothing is wrong";
}
void expect_error(const std::string& command, const std::vector<std::string>& parts,
                  const ProgramOptions& options = {}) {
  const std::string error = error_of(command, options);
  for (const std::string& part : parts)
    EXPECT_NE(error.find(part), error.npos) << "no '" << part << "' in: " << error;
  // Neither a process nor a zombie is left.
  EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1);
  EXPECT_EQ(errno, ECHILD);
}

bool runs(pid_t id) {
  std::ifstream stat("/proc/" + std::to_string(id) + "/stat");
  std::string number, name, state;
  return stat >> number >> name >> state && state != "Z" && state != "X";
}
bool ends_soon(pid_t id) {
  for (int i = 0; i < 200 && runs(id); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  return !runs(id);
}
/// A file into which a program writes process ids.
class IdFile {
 public:
  IdFile()
      : path_(std::filesystem::temp_directory_path() /
              ("gatewalk-" + std::to_string(::getpid()) + ".ids")) {}
  ~IdFile() { std::filesystem::remove(path_); }
  [[nodiscard]] std::string path() const { return path_; }
  [[nodiscard]] std::vector<pid_t> ids() const {
    std::ifstream file(path_);
    std::vector<pid_t> all;
    for (pid_t id = 0; file >> id;) all.push_back(id);
    return all;
  }

 private:
  std::filesystem::path path_;
};

TEST(ProgramCell, SaysItsSection) {
  const ProgramCell cell(saying(R"(, "symmetric": true)") + "cat >/dev/null");
  ASSERT_EQ(cell.section().faces.size(), 2U);
  EXPECT_EQ(cell.section().faces[1].name, "N");
  EXPECT_EQ(cell.section().faces[1].di_y, -1);
  EXPECT_EQ(cell.section().faces[1].origin, "from above");
  EXPECT_EQ(cell.section().coordinates[0].key, "s_m");
  EXPECT_EQ(cell.section().costs[0].key, "time_s");
  EXPECT_TRUE(cell.is_symmetric());
}

TEST(ProgramCell, CarriesBodies) {
  const ProgramCell cell(
      answering("case $s in 0.5) echo $id trapped 7;; 0.75) echo $id broken;; "
                "*) echo $id left N -$s 0.125 -;; esac"));
  Body body = body_at(cell, 0.1);
  const Passage left = cell.pass(body);
  EXPECT_EQ(left.fate, Fate::left);
  EXPECT_EQ(left.next, (Entry{1, {-0.1}}));
  EXPECT_EQ(body.entry, left.next);
  EXPECT_EQ(left.costs[0], 0.125);
  EXPECT_EQ(pass_at(cell, 0.5).fate, Fate::trapped);
  EXPECT_EQ(pass_at(cell, 0.5).costs[0], 7.0);
  EXPECT_EQ(pass_at(cell, 0.75).fate, Fate::broken);
}

TEST(ProgramCell, NumbersReadBackTheSame) {
  const ProgramCell cell(kFine);
  for (const double s :
       {0.1, 1.0 / 3.0, -0.0, 5e-324, 1.7976931348623157e308, 1e22, -123456789.125})
    EXPECT_TRUE(test::same_bits(pass_at(cell, s).next.at[0], s)) << s;
}

TEST(ProgramCell, MemoryIsCarriedAndForgotten) {
  const ProgramCell cell(
      answering("if [ $memory = - ]; then echo $id left S $s 1 one; else echo $id left S $s 2 "
                "${memory}+1; fi"));
  Body body = body_at(cell, 0.0);
  EXPECT_EQ(cell.pass(body).costs[0], 1.0);
  EXPECT_EQ(cell.pass(body).costs[0], 2.0);
  cell.forget(body);
  EXPECT_EQ(cell.pass(body).costs[0], 1.0);
  // The longest memory that a body can carry comes back whole.
  const std::string longest(480, 'm');
  const ProgramCell full(answering("case $memory in -) echo $id left S 0 1 " + longest + ";; " +
                                   longest + ") echo $id left S 0 2 -;; *) exit 1;; esac"));
  body = body_at(full, 0.0);
  EXPECT_EQ(full.pass(body).costs[0], 1.0);
  EXPECT_EQ(full.pass(body).costs[0], 2.0);
}

TEST(ProgramCell, NoiseIsOurs) {
  const std::string keeps =
      "while read -r id face s seed a b memory; do [ -z \"$id\" ] || "
      "echo $id left S $a 1 $seed; done";
  for (const char* const kind : {"normals", "uniforms"}) {
    const ProgramCell cell(saying(R"(, ")" + std::string(kind) + R"(": 2)") + keeps);
    Body body = body_at(cell, 0.0, 5);
    Random random = body.random;
    for (int k = 0; k < 2; ++k) {
      Random::Normals normals;
      double expected = 0.0;
      if (kind == std::string("normals")) {
        random.normals(normals);
        expected = normals[0];
      } else {
        expected = random.uniform();
        (void)random.uniform();
      }
      (void)random.word();
      EXPECT_TRUE(test::same_bits(cell.pass(body).next.at[0], expected)) << kind << ' ' << k;
    }
    EXPECT_EQ(body.random.word(), random.word()) << "as much is drawn";
  }
}

TEST(ProgramCell, SameBitsHoweverItIsCarriedOut) {
  std::vector<Passage> first;
  for (const std::int64_t in_flight : {1, 2, 7, 64, 512}) {
    const ProgramCell cell(GATEWALK_ECHO, {.in_flight = in_flight});
    for (const int threads : {1, 2, 4}) {
      const std::vector<Passage> all = passages_of(cell, threads);
      if (first.empty()) first = all;
      for (std::size_t i = 0; i < all.size(); ++i) {
        EXPECT_EQ(all[i].fate, first[i].fate);
        EXPECT_EQ(all[i].next, first[i].next);
        EXPECT_EQ(all[i].costs, first[i].costs);
      }
    }
  }
  EXPECT_EQ(check_cell(ProgramCell(GATEWALK_ECHO), {{0, {0.1, 0.2}}, {1, {0.1, 0.2}}}),
            std::vector<std::string>{});
}

TEST(ProgramCell, AnswersMayComeInAnyOrder) {
  // This program answers a batch from its last line to its first, when the empty line asks for it.
  const ProgramCell backwards(saying() +
                              "all=; while read -r id face s seed memory; do if [ -n \"$id\" ]; "
                              "then all=\"$id left S $seed 1 -\n"
                              "$all\"; else printf %s \"$all\"; all=; fi; done");
  const ProgramCell forwards(answering("echo $id left S $seed 1 -"));
  const std::vector<Passage> a = passages_of(backwards), b = passages_of(forwards);
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a[i].next, b[i].next);
  EXPECT_NE(a[0].next, a[1].next);
}

TEST(ProgramCell, ParametersAreSet) {
  const std::string command =
      saying(R"(, "parameters": {"radius": [0.25, 0, 1], "speed": 2})") +
      "radius=0.25; while read -r id key value more; do case $id in set) eval \"$key=$value\";; "
      "'') ;; *) echo $id left S $radius ${speed-2} -;; esac; done";
  const ProgramCell cell(command);
  ASSERT_EQ(cell.numbers().size(), 2U);
  EXPECT_EQ(cell.numbers()[0].key, "radius");
  EXPECT_EQ(cell.numbers()[0].value, 0.25);
  EXPECT_EQ(pass_at(cell, 0.0).next.at[0], 0.25);

  const auto wider = cell.with(0, 1.5);
  ASSERT_NE(wider, nullptr);
  EXPECT_EQ(wider->numbers()[0].value, 0.375);
  EXPECT_EQ(pass_at(*wider, 0.0).next.at[0], 0.375);
  EXPECT_EQ(pass_at(*wider, 0.0).costs[0], 2.0);
  EXPECT_EQ(pass_at(cell, 0.0).next.at[0], 0.25);
  EXPECT_EQ(cell.with(0, 5.0), nullptr) << "1.25 is not permitted";

  const ProgramCell set(command, {}, {{"radius", 0.5}, {"speed", 0.1}});
  EXPECT_EQ(pass_at(set, 0.0).next.at[0], 0.5);
  EXPECT_EQ(pass_at(set, 0.0).costs[0], 0.1);
  EXPECT_EQ(pass_at(*set.with(0, 1.0), 0.0).costs[0], 0.1);
  const auto refused = [&](const Cell::Number& number) -> std::string {
    try {
      const ProgramCell none(command, {}, {number});
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(refused({"radius", 2.0}),
            "cell program: parameter 'radius' must be a number from 0.0 to 1.0");
  EXPECT_EQ(refused({"radios", 0.5}),
            "cell program: it has no parameter 'radios', but radius, speed");
  EXPECT_NE(refused({"speed", std::nan("")}), "");
}

// The rule of cell files (cli/site/reference/files.md#mirror-images).
TEST(ProgramCell, MirrorsFollowFromMoves) {
  const auto mirrors = [](const std::string& faces, const std::string& more = "") {
    const Hello hello = read_hello(
        R"({"gatewalk": 1, "coordinates": [{"name": "s", "scale": 1}], "costs": [{"key": "t"}], )"
        R"("faces": [)" +
        faces + "]" + more + "}");
    std::vector<int> all;
    for (const dynamics::Face& face : hello.section.faces) all.push_back(face.mirror);
    return all;
  };
  constexpr int kNone = dynamics::kNoMirror;
  const std::string s = R"({"name": "S", "move": [0, 1], "odd": ["s"]})",
                    w = R"({"name": "W", "move": [1, 0])", e = R"({"name": "E", "move": [-1, 0]})",
                    symmetric = R"(, "symmetric": true)";
  EXPECT_EQ(mirrors(s + "," + w + "}," + e, symmetric), (std::vector<int>{0, 2, 1}));
  EXPECT_EQ(mirrors(s + "," + w + "}," + e), (std::vector<int>{0, 2, 1}));
  EXPECT_EQ(mirrors(s + "," + w + "}"), (std::vector<int>{0, kNone}));
  EXPECT_EQ(mirrors(s + "," + w + R"(, "odd": ["s"]},)" + e), (std::vector<int>{0, kNone, kNone}));
  EXPECT_EQ(mirrors(s + "," + w + R"(, "mirror": "S"},)" + e), (std::vector<int>{0, kNone, kNone}));
}

TEST(ProgramCell, FirstLinesThatSayNoCell) {
  const auto refused = [](const std::string& line, const std::string& why) {
    expect_error("echo '" + line + "'; cat",
                 {"its first line says no cell: " + why, line.substr(0, 20)});
  };
  const std::string s = R"({"name": "s", "scale": 1})", t = R"({"key": "time_s"})",
                    up = R"({"name": "S", "move": [0, 1]})";
  const auto hello = [&](const std::string& coordinates, const std::string& costs,
                         const std::string& faces, const std::string& more = "") {
    return R"({"gatewalk": 1, "coordinates": [)" + coordinates + R"(], "costs": [)" + costs +
           R"(], "faces": [)" + faces + "]" + more + "}";
  };
  refused("hello", "it is not JSON");
  refused("[]", "it must be an object");
  refused(R"({"gatewalk": 2})", "'gatewalk' is the protocol, which must be 1");
  refused(R"({"gatewalk": 1, "face": []})", "it has no key 'face'; it has gatewalk, faces");
  refused(hello("", t, up), "section: 0 coordinates");
  std::string nine = s;
  for (int more = 0; more < 8; ++more) nine += "," + s;
  refused(hello(nine, t, up), "'coordinates' must be at most 8");
  refused(hello(R"({"name": "s"})", t, up), "coordinate 1: 'scale' is missing");
  refused(hello(R"({"name": "s", "scale": "big"})", t, up),
          "coordinate 1: 'scale' must be a finite number");
  refused(hello(R"({"name": "s x", "scale": 1})", t, up),
          "coordinate 1: 'name' must be a word without blanks");
  refused(hello(s, t, ""), "section: 0 faces");
  refused(hello(s, "", up), "'costs' must name at least one");
  refused(hello(s, t, R"({"name": "S", "move": [0, 2]})"),
          "face 1: 'move' must be two of -1, 0, 1");
  refused(hello(s, t, R"({"name": "S", "move": [0, 1], "mirror": "N"})"),
          "face 1: 'mirror' must name a face: S");
  refused(hello(s, t, R"({"name": "S", "move": [0, 1], "odd": ["v"]})"),
          "face 1: 'odd' must name coordinates: s");
  const std::string w = R"({"name": "W", "move": [1, 0])", symmetric = R"(, "symmetric": true)";
  refused(hello(s, t, w + "}", symmetric),
          "face W of symmetric cells needs 'mirror': 'mirror' must name a face: W");
  refused(hello(s, t, w + R"(, "mirror": "W"})", symmetric),
          "section: face W is not the mirror image of W");
  refused(hello(s, t, up + "," + up), "section: two faces are named S");
  refused(hello(s, t, up, R"(, "symmetric": 1)"), "it: 'symmetric' must be true or false");
  const auto remembers = [&](const std::string& keys) {
    return hello(s, t, up, R"(, "remembered": [)" + keys + "]");
  };
  refused(remembers(R"({"key": "a", "odd": 1})"),
          "remembered number 1: 'odd' must be true or false");
  refused(remembers(R"({"key": "a"}, {"key": "a"})"),
          "remembered number 2: 'a' is the name of another number");
  refused(remembers(R"({"key": "s"})"), "remembered number 1: 's' is the name of another number");
  refused(remembers(R"({"key": "a,b"})"),
          "remembered number 1: 'key' must be a word without commas");
  refused(remembers(R"({"key": "a"}, {"key": "b"}, {"key": "c"}, {"key": "d"}, {"key": "e"})"),
          "'remembered' must be at most 4 numbers, and 8 together with 'coordinates'");
  refused(hello(s, t, up, R"(, "normals": -1)"),
          "it: 'normals' must be a whole number from 0 to 10000");
  refused(hello(s, t, up, R"(, "normals": 1, "uniforms": 1)"),
          "it has 'normals' and 'uniforms'; use one");
  refused(hello(s, t, up, R"(, "parameters": {"a": "b"})"),
          "parameter 'a' must be a finite number");
  refused(hello(s, t, up, R"(, "parameters": {"a": [3, 0, 1]})"),
          "parameter 'a' must be a number from 0.0 to 1.0");
}

TEST(ProgramCell, AnswersThatAreNone) {
  const auto wrong = [](const std::string& answer, const std::string& why) {
    expect_error(answering("echo " + answer), {"it wrote a line that is no answer: " + why});
  };
  wrong("$id left S $s 1", "it has 5 words, not 6: ID left FACE s time_s MEMORY; the line is '");
  wrong("$id left S $s 1 - -", "it has 7 words, not 6");
  wrong("$id left S nan 1 -", "s 'nan' is not a finite number");
  wrong("$id left S $s inf -", "time_s 'inf' is not a finite number");
  wrong("$id left S 0.1x 1 -", "s '0.1x' is not a finite number");
  wrong("$id left W $s 1 -", "there is no face 'W' to enter the next cell by, but S, N");
  wrong("$id left S $s -1 -", "time_s is negative");
  wrong("$id trapped", "it has 2 words, not 3: ID trapped time_s");
  wrong("$id broken 1", "a broken passage has no more words");
  wrong("$id gone 1", "its second word must be left, trapped or broken");
  wrong("77777 left S $s 1 -", "its first word is not the id of a passage that is under way");
  wrong("", "its first word is not the id");
  wrong("Loading the model", "its first word is not the id");
  wrong("\"$id left S $s 1 -\n$id left S $s 1 -\"", "its first word is not the id");  // twice
  wrong("$id left S $s 1 " + std::string(481, 'm'),
        "its memory has 481 bytes; at most 480 are carried");
  expect_error(answering("head -c 100000 /dev/zero | tr '\\0' x"),
               {"it wrote a line of more than 65536 bytes: 'xxxx"});
}

TEST(ProgramCell, ProgramsThatEnd) {
  expect_error("no-such-program --here",
               {"it ended with status 127 while a line was awaited", "no-such-program: not found"});
  expect_error("exit 0", {"it ended with status 0", "it wrote nothing to standard error"});
  expect_error(answering("{ echo out of memory >&2; exit 3; }"),
               {"cell program '", "it ended with status 3", "\n  out of memory"});
  expect_error(answering("kill -SEGV $$"), {"ended by signal 11 (Segmentation fault)"});
  expect_error(saying() + "exec <&-; echo deaf >&2; sleep 1000",
               {"closed its standard input", "deaf"});
  expect_error(saying() + "exec >&-; sleep 1000", {"closed its standard output"});
  expect_error("exec >&-; sleep 1000", {"closed its standard output while a line was awaited"});
  // The message has only the last lines, and no control characters.
  const std::string error = error_of(
      "i=0; while [ $i -lt 1000 ]; do echo line $i >&2; i=$((i+1)); done; printf 'red\\033[31m' "
      ">&2; exit 1");
  EXPECT_NE(error.find("\n  line 999\n  red?[31m"), error.npos) << error;
  EXPECT_EQ(error.find("line 900"), error.npos) << error;
}

TEST(ProgramCell, ProgramsThatHang) {
  const ProgramOptions soon{.timeout_s = 0.3};
  const auto began = std::chrono::steady_clock::now();
  expect_error("sleep 1000", {"it wrote no line for 0"}, soon);
  expect_error(answering("sleep 1000"), {"it wrote no line for"}, soon);
  expect_error(answering("{ echo stuck >&2; trap '' TERM INT HUP; while :; do :; done; }"),
               {"it wrote no line for", "stuck"}, soon);
  // Output to standard error, or a line that never ends, does not count as a line.
  expect_error(saying() + "while :; do echo noise; done >&2", {"it wrote no line for", "noise"},
               soon);
  expect_error(saying() + "while :; do printf x; sleep 0.01; done", {"it wrote no line for"}, soon);
  EXPECT_LT(std::chrono::steady_clock::now() - began, std::chrono::seconds(10));
}

TEST(ProgramCell, ComplaintsOfAHealthyProgramDoNoHarm) {
  // The program writes more than a pipe holds, before and between answers.
  const ProgramCell cell("yes | head -c 300000 >&2; " +
                         answering("{ head -c 100000 /dev/zero >&2; echo $id left S $s 1 -; }"));
  for (const Passage& passage : passages_of(cell)) EXPECT_EQ(passage.next.at[0], 0.25);
}

TEST(ProgramCell, MoreThanPipesHoldIsUnderWayBothWays) {
  // The program does not read while it cannot write.
  const ProgramCell cell(saying(R"(, "uniforms": 50)") +
                             "while read -r id face s more; do [ -z \"$id\" ] || "
                             "echo $id left S $s 1 " +
                             std::string(480, 'm') + "; done",
                         {.in_flight = 512});
  Health health;
  std::int64_t begun = 0;
  cell.carry_out(
      [&](Body& body, const Passage* ended) {
        if (ended != nullptr || begun == 512) return false;
        body = body_at(cell, 0.5, static_cast<std::uint64_t>(begun++));
        return true;
      },
      health, 512);
  EXPECT_EQ(health.runs, 512);
}

TEST(ProgramCell, ARefusedParameterIsTold) {
  const ProgramCell cell(
      saying(R"(, "parameters": {"mass": 1})") +
          "while read -r id more; do [ $id = set ] && echo no $more >&2 && exit 2; done",
      {}, {{"mass", -1.0}});
  try {
    (void)pass_at(cell, 0.0);
    ADD_FAILURE() << "nothing is wrong";
  } catch (const std::runtime_error& e) {
    EXPECT_NE(std::string(e.what()).find("status 2"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("no mass -1"), std::string::npos) << e.what();
  }
}

TEST(ProgramCell, AnotherFirstLineAtTheNextStartIsRefused) {
  const ProgramCell cell(saying(R"(, "parameters": {"id": '$$'})") + "cat >/dev/null");
  const auto other = cell.with(0, 1.0);
  try {
    (void)pass_at(*other, 0.0);
    ADD_FAILURE() << "nothing is wrong";
  } catch (const std::runtime_error& e) {
    EXPECT_NE(std::string(e.what()).find("its first line is not the same at each start"),
              std::string::npos)
        << e.what();
  }
}

TEST(ProgramCell, AStopLeavesNothingBehindAndTheCellGoesOn) {
  const ProgramCell cell(kFine);
  struct Stop {};
  Health health;
  std::int64_t asked = 0;
  EXPECT_THROW(cell.carry_out(
                   [&](Body& body, const Passage* ended) {
                     if (ended != nullptr) throw Stop{};
                     body = body_at(cell, 0.5);
                     return ++asked < 100;
                   },
                   health, 100),
               Stop);
  EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1);
  EXPECT_EQ(pass_at(cell, 0.5).next.at[0], 0.5);
}

TEST(ProgramCell, OneOfManyFails) {
  const ProgramCell cell(answering(
      "if [ $((${seed%?????????} % 7)) = 0 ]; then exit 9; else echo $id left S $s 1 -; fi"));
  try {
    (void)passages_of(cell, 4);
    ADD_FAILURE() << "nothing is wrong";
  } catch (const std::runtime_error& e) {
    EXPECT_NE(std::string(e.what()).find("status 9"), std::string::npos) << e.what();
  }
}

TEST(ProgramCell, WhateverAProgramStartedEndsWithTheCell) {
  const IdFile file;
  {
    const ProgramCell cell("sleep 1000 & echo $! $$ >" + file.path() + "; " + kFine);
    (void)pass_at(cell, 0.0);
    ASSERT_EQ(file.ids().size(), 2U);
    for (const pid_t id : file.ids()) EXPECT_TRUE(runs(id));
  }
  for (const pid_t id : file.ids()) EXPECT_TRUE(ends_soon(id));
}

TEST(ProgramCellDeathTest, ProgramsEndWithUsHoweverWeEnd) {
  for (const int signal : {SIGKILL, SIGINT, SIGTERM}) {
    const IdFile file;
    EXPECT_EXIT(
        {
          // The program ignores all signals and never reads again.
          const ProgramCell cell("trap '' INT TERM HUP PIPE; echo $$ >" + file.path() + "; " +
                                 saying() + "while :; do :; done");
          std::raise(signal);
        },
        testing::KilledBySignal(signal), "");
    ASSERT_EQ(file.ids().size(), 1U);
    EXPECT_TRUE(ends_soon(file.ids()[0])) << "signal " << signal;
  }
}

TEST(ProgramCell, OptionsThatAreNone) {
  EXPECT_THROW(ProgramCell(kFine, {.timeout_s = 0.0}), std::invalid_argument);
  EXPECT_THROW(ProgramCell(kFine, {.in_flight = 0}), std::invalid_argument);
  EXPECT_THROW(ProgramCell(kFine, {.in_flight = 4097}), std::invalid_argument);
}

TEST(ProgramCell, TheExampleInPython) {
  if (std::system("python3 -c '' 2>/dev/null") != 0) GTEST_SKIP() << "python3 is not installed";
  const ProgramCell cell("python3 " GATEWALK_PROGRAMS "/pillars.py");
  EXPECT_EQ(check_cell(cell, {{0, {0.1, 0.3}}, {2, {-0.2, -0.4}}}, {.trials = 60, .cells = 4}),
            std::vector<std::string>{});
  // Pillars of radius 0 turn no body round.
  const ProgramCell open("python3 " GATEWALK_PROGRAMS "/pillars.py", {},
                         {{"radius_m", 0.0}, {"turning_rad_per_sqrt_s", 0.0}});
  const Passage straight = pass_at(open, 0.0);
  EXPECT_EQ(straight.next.face, 0);
  EXPECT_NEAR(straight.costs[0], 1.0, 1e-12);
}

TEST(ProgramCell, HasOtherValuesInProcessesOfItsOwn) {
  if (std::system("python3 -c '' 2>/dev/null") != 0) GTEST_SKIP() << "python3 is not installed";
  const ProgramCell cell("python3 " GATEWALK_PROGRAMS "/pillars.py", {}, {{"radius_m", 0.0}});
  const auto straight = cell.with({{"turning_rad_per_sqrt_s", 0.0}});
  ASSERT_EQ(straight->numbers().size(), 2u);
  EXPECT_EQ(straight->numbers()[0].value, 0.0);
  EXPECT_EQ(straight->numbers()[1].value, 0.0);
  EXPECT_NEAR(pass_at(*straight, 0.0).costs[0], 1.0, 1e-12);
  EXPECT_GT(std::abs(pass_at(cell, 0.0).costs[0] - 1.0), 1e-6);  // its own did not change
  EXPECT_THROW((void)cell.with({{"turning", 0.0}}), std::invalid_argument);
}

TEST(ProgramCell, TheGateInChipmunk) {
#ifdef GATEWALK_CHIPMUNK_GATE
  const ProgramCell cell(GATEWALK_CHIPMUNK_GATE);
  EXPECT_EQ(
      check_cell(cell, {{0, {0.0, 0.0, 15.0}}, {1, {15.0, -5.0, 5.0}}}, {.trials = 40, .cells = 3}),
      std::vector<std::string>{});
  // Our own gate with the same forces.
  GateParams p;
  p.forces.propulsion = 7.0;
  p.forces.random = 50.0;
  const auto method = make_method(p);
  ASSERT_EQ(names_of(cell.section().faces), names_of(disc_section().faces));
  int same = 0;
  constexpr int kTrials = 200;
  for (std::uint64_t trial = 0; trial < kTrials; ++trial) {
    const Random random(Purpose::gate, {.trial = trial});
    Body body{.entry = {enter, {0.0, 0.0, 15.0}}, .random = random};
    cell.begin(body);
    const Passage theirs = cell.pass(body);
    RandomForce force(p.forces, random);
    const GateRun ours = run_gate(p, *method, {0.0, 0.0, 0.0, 15.0}, force);
    same += ours.outcome == Outcome::trapped
                ? theirs.fate == Fate::trapped
                : theirs.fate == Fate::left &&
                      crossing_of(p, ours.outcome, ours.exit).face == theirs.next.face;
  }
  EXPECT_GE(same, 170) << "of 200 bodies that have the same forces";
#else
  GTEST_SKIP() << "libchipmunk-dev is not installed";
#endif
}

}  // namespace
}  // namespace gatewalk::cli
