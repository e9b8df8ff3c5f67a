// SPDX-License-Identifier: MIT
#include "lattice/scene/scene.h"
#include "dynamics/disc/disc_section.h"
#include "lattice/scene/scene_keys.h"
#include "lattice/scene/table4.h"
#include "tests/support/refusal.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>

namespace gatewalk::lattice {
namespace {

using test::scene_refusal;

namespace fs = std::filesystem;

const fs::path kScenes = fs::path(__FILE__).parent_path() / ".." / ".." / "scenes";

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// A temporary folder, removed with its contents.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (fs::temp_directory_path() / "gatewalk-scene-XXXXXX").string();
    if (!::mkdtemp(name.data())) throw std::runtime_error("mkdtemp");
    path_ = name;
  }
  ~TemporaryFolder() { fs::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  [[nodiscard]] std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return (path_ / name).string();
  }
  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

// The scene contract, word for word: names, order, defaults.
const std::string kDefaultScene = R"([body]
mass_kg = 1.0
radius_m = 10.0

[beams]
length_m = 25.0
mass_kg = 0.1
stiffness_left_Nm_per_rad = 400.0
stiffness_right_Nm_per_rad = 400.0
damping_Nms_per_rad = 50.0
joint_x_m = 25.0
joint_y_m = 30.0

[forces]
propulsion_N = 8.0
random_N = 40.0
random_rate_Hz = 50.0
drag_Ns_per_m = 0.06

[contact]
restitution = 0.8
tip_restitution = 1.0
impulse_threshold_Ns = 0.04

[run]
method = "stable"
step_s = 0.02
time_limit_s = 12.0
traverse_y_m = 60.0
event_tolerance_m = 0.01
tolerance = 0.005

[field]
columns = 9
rows = 9
max_gates = 13
fidelity = "active"

[start]
x_m = 0.0
y_m = 0.0
vx_m_per_s = 0.0
vy_m_per_s = 15.0
)";

TEST(Scene, TheStepSuitsTheMethodUnlessItIsNamed) {
  const auto step = [](const char* text, std::vector<std::string> overrides = {}) {
    return parse_scene(text, "x.toml", overrides).gate.run.step;
  };
  EXPECT_EQ(step(""), 0.02);
  EXPECT_EQ(step("run.method = 'paper'"), 0.004);
  EXPECT_EQ(step("", {"run.method=moreau"}), 0.004);
  EXPECT_EQ(step("run.step_s = 0.01", {"run.method=paper"}), 0.01);
  EXPECT_EQ(step("", {"run.method=paper", "run.step_s=0.02"}), 0.02);
  // Steps that divide the hold evenly.
  EXPECT_EQ(step("forces.random_rate_Hz = 30"), 1.0 / 30);  // the unit of time is 5/3 s
  EXPECT_EQ(step("forces.random_rate_Hz = 5"), 0.04);       // 2 s is what the forces allow
  EXPECT_EQ(step("forces.random_rate_Hz = 1000"), 0.001);
  EXPECT_EQ(step("forces.random_rate_Hz = 30", {"run.method=paper"}), 1.0 / 150);
}

TEST(Scene, EmptyFileIsTheDefaultScene) {
  EXPECT_EQ(to_toml(parse_scene("", "empty.toml")), kDefaultScene);
  EXPECT_EQ(to_toml(Scene{}), kDefaultScene);
  EXPECT_EQ(parse_scene("", "empty.toml").source, "empty.toml");
}

TEST(Scene, EveryKeyReachesItsOwnField) {
  const Scene scene = parse_scene(R"(
[body]
mass_kg = 2
radius_m = 3
[beams]
length_m = 4
mass_kg = 5
stiffness_left_Nm_per_rad = 6
stiffness_right_Nm_per_rad = 7
damping_Nms_per_rad = 8
joint_x_m = 9
joint_y_m = 10
[forces]
propulsion_N = 11
random_N = 12
random_rate_Hz = 20
drag_Ns_per_m = 14
[contact]
restitution = 0.15
tip_restitution = 0.16
impulse_threshold_Ns = 17
[run]
method = "paper"
step_s = 0.01
time_limit_s = 19
traverse_y_m = 18
event_tolerance_m = 0.027
tolerance = 0.028
[field]
columns = 21
rows = 22
max_gates = 23
fidelity = "active"
[start]
x_m = 1.5
y_m = -24
vx_m_per_s = -25
vy_m_per_s = 26
)",
                                  "all.toml");
  EXPECT_EQ(scene.gate.body.mass, 2);
  EXPECT_EQ(scene.gate.body.radius, 3);
  EXPECT_EQ(scene.gate.beams.length, 4);
  EXPECT_EQ(scene.gate.beams.mass, 5);
  EXPECT_EQ(scene.gate.beams.stiffness_left, 6);
  EXPECT_EQ(scene.gate.beams.stiffness_right, 7);
  EXPECT_EQ(scene.gate.beams.damping, 8);
  EXPECT_EQ(scene.gate.beams.joint_x, 9);
  EXPECT_EQ(scene.gate.beams.joint_y, 10);
  EXPECT_EQ(scene.gate.forces.propulsion, 11);
  EXPECT_EQ(scene.gate.forces.random, 12);
  EXPECT_EQ(scene.gate.forces.random_rate, 20);
  EXPECT_EQ(scene.gate.forces.drag, 14);
  EXPECT_EQ(scene.gate.contact.restitution, 0.15);
  EXPECT_EQ(scene.gate.contact.tip_restitution, 0.16);
  EXPECT_EQ(scene.gate.contact.impulse_threshold, 17);
  EXPECT_EQ(scene.gate.run.method, "paper");
  EXPECT_EQ(scene.gate.run.step, 0.01);
  EXPECT_EQ(scene.gate.run.time_limit, 19);
  EXPECT_EQ(scene.gate.run.traverse_y, 18);
  EXPECT_EQ(scene.gate.run.event_tolerance, 0.027);
  EXPECT_EQ(scene.gate.run.tolerance, 0.028);
  EXPECT_EQ(scene.field.columns, 21);
  EXPECT_EQ(scene.field.rows, 22);
  EXPECT_EQ(scene.field.max_gates, 23);
  EXPECT_EQ(scene.start.x, 1.5);
  EXPECT_EQ(scene.start.y, -24);
  EXPECT_EQ(scene.start.vx, -25);
  EXPECT_EQ(scene.start.vy, 26);
}

TEST(Scene, StartsInTheCellThatItNames) {
  const Scene usual = parse_scene("", "x.toml");
  EXPECT_EQ(usual.field.start_column(), 4);
  EXPECT_EQ(usual.field.start_row, 0);
  // Without the key the column follows the size of the field; with it the text keeps the key.
  EXPECT_EQ(parse_scene("", "x.toml", {"field.columns=5"}).field.start_column(), 2);
  const Scene own = parse_scene("[field]\nstart_column = 0\nstart_row = 8\n", "x.toml");
  EXPECT_EQ(own.field.start_column(), 0);
  EXPECT_EQ(own.field.start_row, 8);
  const Scene back = parse_scene(to_toml(own), "back.toml", {"field.columns=5"});
  EXPECT_EQ(back.field.start_column(), 0);
  EXPECT_EQ(back.field.start_row, 8);
  EXPECT_EQ(to_toml(parse_scene(to_toml(own), "back.toml")), to_toml(own));
  for (const KeyInfo& key : describe(usual)) {
    if (key.key == "field.start_column") {
      EXPECT_EQ(key.value + " " + key.range, "4 [0, 8]");
    }
  }
  EXPECT_EQ(scene_refusal("[field]\nrows = 3\nstart_row = 3\n"),
            "bad.toml:3: field.start_row = 3 is not permitted: must lie in [0, 2]");
  EXPECT_EQ(scene_refusal("[field]\nstart_column = -1\n"),
            "bad.toml:2: field.start_column = -1 is not permitted: must lie in [0, 8]");
  EXPECT_EQ(
      scene_refusal("[field]\nstart_column = 1.5\n"),
      "bad.toml:2: field.start_column = 1.5 is not permitted: must be a whole number in [0, 8]");
}

TEST(Scene, ADiscMayEnterByASide) {
  const Scene left =
      parse_scene("[start]\nx_m = -25\ny_m = 12\nvx_m_per_s = 8\nvy_m_per_s = -2\n", "x.toml");
  EXPECT_EQ(own_start(left), (dynamics::Entry{dynamics::left_deflect, {18, 8, -2}}));
  const Scene right =
      parse_scene("[start]\nx_m = 25\ny_m = 45\nvx_m_per_s = -8\nvy_m_per_s = 2\n", "x.toml");
  EXPECT_EQ(own_start(right), (dynamics::Entry{dynamics::right_traverse, {15, -8, 2}}));
  const std::string at_side = "[start]\nx_m = 25\n";
  EXPECT_EQ(
      scene_refusal(at_side),
      "bad.toml:2: start.vx_m_per_s = 0 is not permitted: start.x_m = 25 is a side of the gate, "
      "which bodies enter by with start.vx_m_per_s < 0");
  EXPECT_TRUE(contains(scene_refusal(at_side + "vx_m_per_s = -1\ny_m = -1\n"), "start.y_m >= 0"));
  EXPECT_TRUE(contains(scene_refusal(at_side + "vx_m_per_s = -1\ny_m = 20.1\n"), "overlap a beam"));
}

TEST(Scene, FidelityIsOneOfThree) {
  for (std::size_t i = 0; i < kFidelityNames.size(); ++i) {
    const std::string name(kFidelityNames[i]);
    const std::string text = "[run]\nmethod = \"moreau\"\n[field]\nfidelity = \"" + name + "\"\n";
    const Scene scene = parse_scene(text, "a.toml");
    EXPECT_EQ(static_cast<std::size_t>(scene.field.fidelity), i);
    EXPECT_TRUE(contains(to_toml(scene), "fidelity = \"" + name + "\"\n"));
    EXPECT_EQ(parse_scene(to_toml(scene), "b.toml").field.fidelity, scene.field.fidelity);
    EXPECT_EQ(
        parse_scene("", "c.toml", {"run.method=moreau", "field.fidelity=" + name}).field.fidelity,
        scene.field.fidelity);
  }
}

TEST(Scene, ShippedFieldIsTheDefaultSceneWithItsOwnForces) {
  const std::string path = (kScenes / "field.toml").string();
  EXPECT_EQ(to_toml(read_scene(path, {"forces.propulsion_N=8", "forces.random_N=40"})),
            kDefaultScene);
  const Scene scene = read_scene(path, {});
  EXPECT_EQ(scene.gate.forces.propulsion, 7.0);  // results/field_scan
  EXPECT_EQ(scene.gate.forces.random, 50.0);
}

TEST(Scene, ShippedSingleGateIsThePapersTableI) {
  const Scene scene = read_scene((kScenes / "single_gate.toml").string(), {});
  Scene expected;
  expected.gate.forces = {.propulsion = 7.0, .random = 10.0, .random_rate = 50.0, .drag = 0.0};
  expected.gate.run.traverse_y = 65.0;
  expected.start = {0.0, 0.0, 0.0, 0.0};
  EXPECT_EQ(to_toml(scene), to_toml(expected));
}

TEST(Scene, OtherSpellingsOfTheSameFile) {
  const std::string plain = to_toml(parse_scene("[forces]\nrandom_N = 20\n", "a.toml"));
  EXPECT_TRUE(contains(plain, "random_N = 20.0\n"));
  for (const char* text : {"\xEF\xBB\xBF[forces]\nrandom_N = 20\n", "[forces]\r\nrandom_N = 20\r\n",
                           "forces.random_N = 20.0", "forces = { random_N = 2e1 }",
                           "[forces]\nrandom_N = 0x14 # twenty", "[forces]\nrandom_N = 2_0"}) {
    EXPECT_EQ(to_toml(parse_scene(text, "b.toml")), plain) << text;
  }
}

TEST(Scene, CommentsMayHaveAsManyDotsAsTheyLike) {
  EXPECT_EQ(scene_refusal("# " + std::string(5000, '.') + "\n"), "(accepted)");
}

// ---- What is refused

struct Malformed {
  const char* name;
  std::string text;
  int line;
  const char* key;     // appears in the message
  const char* reason;  // also appears in the message
};

class MalformedScene : public testing::TestWithParam<Malformed> {};

TEST_P(MalformedScene, IsRefusedByFileLineKeyAndReason) {
  const Malformed& bad = GetParam();
  const std::string what = scene_refusal(bad.text);
  EXPECT_EQ(what.find("bad.toml:" + std::to_string(bad.line) + ": "), 0u) << what;
  EXPECT_TRUE(contains(what, bad.key)) << what;
  EXPECT_TRUE(contains(what, bad.reason)) << what;
  EXPECT_FALSE(contains(what, "\n")) << what;
  EXPECT_LT(what.size(), 400u) << what;
}

std::string nested(const std::string& open, const std::string& close, int depth) {
  std::string text;
  for (int i = 0; i < depth; ++i) text += open;
  text += "1";
  for (int i = 0; i < depth; ++i) text += close;
  return text;
}

std::string dotted(int depth) {
  std::string text = "a";
  for (int i = 1; i < depth; ++i) text += ".a";
  return text;
}

const Malformed kMalformed[] = {
    // Text that is not TOML
    {"NoEquals", "[forces]\nrandom_N 20\n", 2, "random_N", "must be KEY = VALUE"},
    {"NoValue", "[forces]\nrandom_N =\n", 2, "random_N", "has no value"},
    {"OpenHeader", "\n[forces\nrandom_N = 20\n", 2, "forces", "its name in brackets"},
    {"OpenString", "[run]\nmethod = \"stable\n", 2, "method", "two quotation marks"},
    {"OpenArray", "[forces]\nrandom_N = [1, 2\n", 2, "random_N", "an array must stand in brackets"},
    {"BareWord", "[run]\nmethod = stable\n", 2, "method = stable", "between quotation marks"},
    {"TwoOnALine", "[forces]\nrandom_N = 1 drag_Ns_per_m = 2\n", 2, "random_N", "must stand alone"},
    {"Range", "[forces]\nrandom_N = 1:0.1:2\n", 2, "random_N", "a key has one value"},
    {"TwoPoints", "[run]\nstep_s = 0.0.4\n", 2, "step_s", "0.0.4"},
    {"Comma", "[run]\nstep_s = 0,004\n", 2, "step_s", "decimal point"},
    {"NoDigitBehindPoint", "[run]\nstep_s = 1.\n", 2, "step_s", "a digit behind its point"},
    {"LeadingZero", "[forces]\nrandom_N = 040\n", 2, "random_N", "must not begin with a 0"},
    {"FloatOverflow", "[forces]\nrandom_N = 1e999\n", 2, "random_N", "1e999"},
    {"IntegerOverflow", "[field]\nrows = 99999999999999999999\n", 2, "rows",
     "99999999999999999999"},
    {"DuplicateTable", "[forces]\nrandom_N = 1\n[forces]\ndrag_Ns_per_m = 0\n", 3, "forces",
     "is given in line 1 already"},
    {"ControlCharacter", "[run]\nmethod = \"a\x01\"\n", 2, "method", "control characters"},
    {"BadUtf8", "[run]\nmethod = \"\xff\"\n", 2, "method", "UTF-8"},
    {"Binary", std::string("\0\0\0\0", 4), 1, "bad", "control characters"},
    {"NestedArrays", "[forces]\nrandom_N = " + nested("[", "]", 100000) + "\n", 2, "random_N",
     "nest"},
    {"NestedTables", "[forces]\nrandom_N = " + nested("{a=", "}", 100000) + "\n", 2, "random_N",
     "nest"},
    {"NestedKeys", "\n" + dotted(100000) + " = 1\n", 2, "dotted keys", "too deep"},
    {"NestedHeaders", "[" + dotted(100000) + "]\n", 1, "dotted keys", "too deep"},
    {"NestedALittle", dotted(1000) + " = 1\n", 1, "unknown table a", "closest"},

    // Keys that no scene has
    {"UnknownTable", "[body]\n[forcs]\nrandom_N = 1\n", 2, "unknown table forcs",
     "known table is forces"},
    {"UnitForgotten", "[beams]\nlength = 25\n", 2, "beams.length", "known key is beams.length_m"},
    {"WrongTable", "[body]\nrandom_N = 1\n", 2, "body.random_N", "known key is forces.random_N"},
    {"NoTable", "random_N = 1\n", 1, "unknown key random_N", "known key is forces.random_N"},
    {"KeyWithNewline", "[forces]\n\"a\\nb\" = 1\n", 2, "forces.a?b", "unknown key"},
    {"LongKey", "[forces]\n" + std::string(100000, 'x') + " = 1\n", 2, "forces.xxx", "unknown key"},

    // Wrong types
    {"LongStringForNumber", "[forces]\nrandom_N = \"" + std::string(100000, 'x') + "\"\n", 2,
     "forces.random_N = \"xxx", "a number in"},
    {"TableForNumber", "[forces.random_N]\na = 20\n", 1, "forces.random_N (a table)",
     "a number in"},
    {"FidelityWithoutItsMethod", "[run]\nmethod = \"stable\"\n[field]\nfidelity = \"all\"\n", 4,
     "field.fidelity = \"all\" is not permitted with run.method = \"stable\"",
     "run.method must be \"moreau\""},
    {"NumberForTable", "\nforces = 3\n", 2, "forces = 3", "must be a table, written [forces]"},
    {"ListOfTables", "[[forces]]\nrandom_N = 3\n", 1, "forces (an array)", "must be a table"},

    // Out of range
    {"HugeInteger", "[run]\nstep_s = 9223372036854775807\n", 2, "run.step_s = 9223372036854775808",
     "must fit"},
    {"Vanishing", "[body]\nmass_kg = 5e-324\n", 2, "body.mass_kg = 5e-324", "leave [1e-60, 1e+60]"},
    {"Step", "[run]\nstep_s = 2\n", 2, "run.step_s = 2 ", "must fit"},

    // Several keys at once
    {"StartBesideNarrowGate", "[start]\nx_m = 15\n[beams]\njoint_x_m = 14\n", 2, "start.x_m = 15 ",
     "[-14, 14] m"},
    {"StartInBeam", "[start]\ny_m = 20.5\n", 2, "start.y_m = 20.5 ", "9.5 m from"},
    {"StartInBeamFromAbove", "[start]\ny_m = 39\n", 2, "start.y_m = 39 ", "9 m from"},
    {"StartOnTip", "[beams]\nlength_m = 10\n[start]\ny_m = 30\nx_m = 6\n", 4, "start.y_m = 30",
     "9 m from"},
    {"StepDoesNotFit", "[run]\n\nstep_s = 0.003\n", 3, "run.step_s = 0.003 ",
     "0.00333333333 and 0.00285714286"},
    {"RateDoesNotFit", "[run]\nstep_s = 0.02\n[forces]\nrandom_rate_Hz = 30\n", 2,
     "run.step_s = 0.02 ", "forces.random_rate_Hz = 30"},
    {"TooManySteps", "[run]\nstep_s = 1e-10\n", 2, "run.time_limit_s = 12 ", "run.step_s = 1e-10"},
    {"BigBody", "[body]\nradius_m = 30\n[beams]\njoint_y_m = 30\n", 2, "body.radius_m = 30 ",
     "beams.joint_y_m = 30"},
    {"LowJoint", "[beams]\njoint_y_m = 9\n", 2, "body.radius_m = 10 ", "beams.joint_y_m = 9"},
    {"LowExit", "[run]\ntraverse_y_m = 30\n", 2, "run.traverse_y_m = 30 ", "beams.joint_y_m = 30"},
};

INSTANTIATE_TEST_SUITE_P(Scene, MalformedScene, testing::ValuesIn(kMalformed),
                         [](const auto& bad) { return std::string(bad.param.name); });

TEST(Scene, StartMayTouchButNotOverlap) {
  EXPECT_EQ(scene_refusal("[start]\ny_m = 20\n"), "(accepted)");
  EXPECT_EQ(scene_refusal("[start]\ny_m = 40\n"), "(accepted)");
  EXPECT_EQ(scene_refusal("[beams]\nlength_m = 10\n[start]\nx_m = 5\ny_m = 30\n"), "(accepted)");
  EXPECT_TRUE(contains(scene_refusal("[start]\ny_m = 20.000001\n"), "start.y_m"));
}

TEST(Scene, TooLargeTextIsRefusedUnread) {
  const std::string million(1 << 20, '\n');
  EXPECT_EQ(scene_refusal(million), "(accepted)");
  EXPECT_EQ(scene_refusal(million + "\n"),
            "bad.toml: is too large for a scene: more than 1048576 bytes");
}

TEST(ReadScene, NamesFilesItCannotRead) {
  const TemporaryFolder folder;
  const auto refused = [](const std::string& path) -> std::string {
    try {
      (void)read_scene(path, {});
    } catch (const SceneError& error) {
      return error.what();
    }
    return "(accepted)";
  };
  const std::string missing = (folder.path() / "missing.toml").string();
  EXPECT_EQ(refused(missing), missing + ": cannot be read: No such file or directory");
  EXPECT_EQ(refused(folder.path().string()),
            folder.path().string() + ": cannot be read: Is a directory");
  EXPECT_EQ(refused(""), ": cannot be read: No such file or directory");
  EXPECT_EQ(refused("/dev/zero"), "/dev/zero: is too large for a scene: more than 1048576 bytes");
  const std::string large = folder.write("large.toml", std::string((1 << 20) + 1, '\n'));
  EXPECT_TRUE(contains(refused(large), "too large"));
  const std::string bad = folder.write("bad.toml", "[forces]\n# comment\nrandom_N = -3\n");
  EXPECT_EQ(refused(bad),
            bad + ":3: forces.random_N = -3 is not permitted: must lie in [0, 1e+100] N");
}

// ---- Overrides

TEST(Overrides, ReplaceWhatTheFileSays) {
  const Scene scene = parse_scene("[forces]\nrandom_N = 1\n", "a.toml",
                                  {"forces.random_N=2", "forces.random_N = 20", "run.method=paper",
                                   "field.rows=3", "start.vy_m_per_s=-1e1"});
  EXPECT_EQ(scene.gate.forces.random, 20.0);
  EXPECT_EQ(scene.gate.run.method, "paper");
  EXPECT_EQ(scene.field.rows, 3);
  EXPECT_EQ(scene.start.vy, -10.0);
  for (const char* quoted : {"run.method=\"paper\"", "run.method = 'paper' # ours"}) {
    EXPECT_EQ(parse_scene("", "a.toml", {quoted}).gate.run.method, "paper") << quoted;
  }
}

TEST(Overrides, MayMendAFile) {
  EXPECT_EQ(scene_refusal("[forces]\nrandom_N = -3\n", {"forces.random_N=3"}), "(accepted)");
  EXPECT_EQ(
      scene_refusal("[run]\nstep_s = 0.003\n", {"forces.random_rate_Hz=100", "run.step_s=0.005"}),
      "(accepted)");
}

TEST(Overrides, AreRefusedByName) {
  struct Bad {
    const char* given;
    const char* reason;
  };
  for (const Bad& bad :
       {Bad{"forces.random_N", "must be KEY=VALUE"}, Bad{"", "must be KEY=VALUE"},
        Bad{"=3", "must be KEY = VALUE"}, Bad{"forces.random_N=", "forces.random_N ="},
        Bad{"forces.random_N=abc", "forces.random_N = abc"},
        Bad{"forces.random_N=20 30", "forces.random_N = 20 30"},
        Bad{"forces.random_N.x=20", "forces.random_N (a table) is not permitted"},
        Bad{"forces=20", "must be a table"}, Bad{"forces={}", "sets no key"},
        Bad{"#forces.random_N=20", "sets no key"},
        Bad{"random_N=20", "unknown key random_N; the closest known key is forces.random_N"},
        Bad{"beams.stiffness_mNm_per_rad=20",
            "unknown key beams.stiffness_mNm_per_rad; the closest known keys are "
            "beams.stiffness_left_Nm_per_rad and beams.stiffness_right_Nm_per_rad"},
        Bad{"beams.stifness_right_Nm_per_rad=20",
            "the closest known key is beams.stiffness_right_Nm_per_rad"},
        Bad{"body.length_cm=3",
            "unknown key body.length_cm; the closest known key is body.radius_m"},
        Bad{"body.weight_g=4", "unknown key body.weight_g; the closest known key is body.mass_kg"},
        Bad{"body.random_N=4",
            "unknown key body.random_N; the closest known key is forces.random_N"},
        Bad{"forcs.random_N=20", "unknown table forcs; the closest known table is forces"},
        Bad{"run.step_s=0.003", "run.step_s = 0.003 is not permitted: must fit"},
        Bad{"start.y_m=25", "would overlap a beam at rest"}}) {
    const std::string what = scene_refusal("", {bad.given});
    EXPECT_EQ(what.find("--set " + std::string(bad.given) + ": "), 0u) << what;
    EXPECT_TRUE(contains(what, bad.reason)) << what;
  }
}

TEST(Overrides, CannotSmuggleASecondLine) {
  EXPECT_TRUE(
      contains(scene_refusal("", {"forces.random_N=2\nrun.step_s=0.02"}), "must be KEY=VALUE"));
}

// ---- Out and in again

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

TEST(Sweep, IsATableOfKeysAndValues) {
  const Scene scene = parse_scene(R"([sweep]
forces.propulsion_N = "4:1:9"
beams.damping_Nms_per_rad = [50, 1.5]
"run.method" = ["stable", "paper"]
field.columns = 3
)",
                                  "a.toml");
  ASSERT_EQ(scene.sweep.size(), 4u);
  EXPECT_EQ(scene.sweep[0].key, "forces.propulsion_N");
  EXPECT_EQ(scene.sweep[0].values, "4:1:9");
  EXPECT_EQ(scene.sweep[1].key, "beams.damping_Nms_per_rad");
  EXPECT_EQ(scene.sweep[1].values, "50,1.5");
  EXPECT_EQ(scene.sweep[2].key, "run.method");
  EXPECT_EQ(scene.sweep[2].values, "stable,paper");
  EXPECT_EQ(scene.sweep[3].values, "3");
  EXPECT_TRUE(scene.named.empty());  // the scene itself has the defaults
  EXPECT_EQ(to_toml(scene), kDefaultScene);
}

TEST(Sweep, RefusesWhatIsNoKeyOrNoValue) {
  const auto message = [](const std::string& text) {
    try {
      (void)parse_scene(text, "bad.toml");
    } catch (const SceneError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_EQ(message("[sweep]\nforces.randm_N = 3"),
            "bad.toml:2: unknown key forces.randm_N; the closest known key is forces.random_N");
  EXPECT_TRUE(message("[sweep]\nforces.random_N = true")
                  .starts_with("bad.toml:2: sweep.forces.random_N = true"));
  EXPECT_EQ(message("[sweep]\n\"forces.random_N\" = 1\nforces.random_N = 2"),
            "bad.toml:3: sweep.forces.random_N is there twice");
  EXPECT_TRUE(message("sweep = 3").starts_with("bad.toml:1: sweep = 3"));
}

TEST(SceneBins, AreEdgesOfOnesOwn) {
  EXPECT_FALSE(parse_scene("", "x.toml").bins);
  const Scene scene =
      parse_scene("[bins]\nEN_d_m = [-20, 0, 0.1, 20]\nRD_vy_m_per_s = [-5, 5.5]\n", "x.toml");
  ASSERT_TRUE(scene.bins);
  const auto paper = dynamics::table3_space(scene.gate).bins();
  EXPECT_EQ((*scene.bins)[0].edges[0], (std::vector<double>{-20, 0, 0.1, 20}));
  EXPECT_EQ((*scene.bins)[0].edges[1], paper[0].edges[1]);
  EXPECT_EQ((*scene.bins)[1].edges[2], (std::vector<double>{-5, 5.5}));
  EXPECT_EQ((*scene.bins)[2], paper[2]);
  EXPECT_EQ(dynamics::StateSpace(dynamics::disc_section(), *scene.bins).size(), 15 + 6 + 30 + 2);

  const Scene again = parse_scene(to_toml(scene), "again.toml");
  EXPECT_EQ(again.bins, scene.bins);
  EXPECT_TRUE(physics_differences(scene, again).empty());
  EXPECT_EQ(physics_differences(scene, parse_scene("", "y.toml")),
            std::vector<std::string>{"[bins]: edges of its own here, none there"});
  const Scene other = parse_scene("[bins]\nEN_d_m = [-20, 20]\n", "z.toml");
  EXPECT_EQ(physics_differences(other, scene),
            std::vector<std::string>{"[bins]: other edges here than there"});

  const Scene set = parse_scene("[bins]\nEN_d_m = [-20, 20]", "x.toml",
                                {"bins.EN_d_m=[-9, 1, 9]", "bins.LT_d_m=[0, 30]"});
  EXPECT_EQ((*set.bins)[0].edges[0], (std::vector<double>{-9, 1, 9}));
  EXPECT_EQ((*set.bins)[4].edges[0], (std::vector<double>{0, 30}));
}

TEST(SceneBins, AreRefusedByFileAndLine) {
  const auto expect = [](const std::string& text, const std::string& part,
                         const std::vector<std::string>& set = {}) {
    const std::string said = scene_refusal(text, set);
    EXPECT_TRUE(contains(said, part)) << said;
  };
  const std::string begin = "[bins]\nEN_vx_m_per_s = [-1, 1]\n",
                    list = "bad.toml:3: bins.EN_d_m is not permitted: must be two or more numbers";
  for (const char* value :
       {"1", "[]", "[1]", "[1, 1]", "[2, 1]", "[0, inf]", "[nan, 1]", "['a', 'b']", "true"})
    expect(begin + "EN_d_m = " + value, list);
  expect(begin + "EN_d_m = [-26, 0]",
         "bad.toml:3: bins.EN_d_m = [-26.0, 0.0] is not permitted: must lie in [-25.0, 25.0] m");
  expect(begin + "RD_d_m = [-1, 10]",
         "bad.toml:3: bins.RD_d_m = [-1.0, 10.0] is not permitted: must lie in [0.0, 30.0] m");
  expect(begin + "RT_d_m = [1, 31]", "must lie in [0.0, 30.0] m");
  expect(begin + "EN_x_m = [0, 1]",
         "bad.toml:3: unknown key in [bins]; its keys are EN_d_m, EN_vx_m_per_s,");
  expect("bins = 3", "bad.toml:1: bins is not permitted: must be a table");
  expect(begin, "--set bins.EN_d_m=[5, -5]: bins.EN_d_m is not permitted", {"bins.EN_d_m=[5, -5]"});
  expect(begin + "[run]\ntraverse_y_m = 35", "run.traverse_y_m = 35");
}

TEST(ToToml, ReadsBackBitForBit) {
  std::mt19937_64 random(7);  // reproducible numbers
  const auto spread = [&](double low_power, double high_power) {
    return std::pow(10.0, low_power + (high_power - low_power) *
                                          std::ldexp(static_cast<double>(random() >> 11), -53));
  };
  for (int trial = 0; trial < 500; ++trial) {
    Scene scene;
    scene.gate.run.method = trial % 2 ? "paper" : "stable";
    for (const dynamics::ParamInfo& info : dynamics::gate_param_table()) {
      // Any permitted number, except for keys that restrict others.
      const bool tied = info.key.starts_with("run.") || info.key.find("joint") != info.key.npos ||
                        info.key == "body.radius_m" || info.key == "forces.random_rate_Hz" ||
                        // Method stable has limits.
                        (trial % 2 == 0 && info.key.starts_with("beams."));
      if (!tied) info.ref(scene.gate) = spread(-5.0, std::min(5.0, std::log10(info.high)));
    }
    scene.gate.run.step = 0.02 / static_cast<double>(1 + random() % 50);
    scene.field = {1 + trial, 2 + trial, trial};
    scene.start = {-spread(-300.0, 1.0), -spread(-300.0, 3.0), -spread(-300.0, 3.0),
                   spread(-300.0, 3.0)};
    if (trial == 0) scene.start.x = -0.0;

    const std::string text = to_toml(scene);
    const Scene back = parse_scene(text, "back.toml");
    EXPECT_EQ(to_toml(back), text);
    for (const dynamics::ParamInfo& info : dynamics::gate_param_table()) {
      EXPECT_TRUE(same_bits(info.get(back.gate), info.get(scene.gate))) << info.key << "\n" << text;
    }
    EXPECT_EQ(back.gate.run.method, scene.gate.run.method);
    EXPECT_EQ(back.field.columns, scene.field.columns);
    EXPECT_EQ(back.field.rows, scene.field.rows);
    EXPECT_EQ(back.field.max_gates, scene.field.max_gates);
    EXPECT_TRUE(same_bits(back.start.x, scene.start.x));
    EXPECT_TRUE(same_bits(back.start.y, scene.start.y));
    EXPECT_TRUE(same_bits(back.start.vx, scene.start.vx));
    EXPECT_TRUE(same_bits(back.start.vy, scene.start.vy));
  }
}

TEST(PhysicsDifferences, NamesEachKeyOfAGate) {
  EXPECT_TRUE(physics_differences(Scene{}, Scene{}).empty());

  Scene here, there;
  there.gate.forces.random = 20.0;
  there.gate.run.method = "paper";
  EXPECT_EQ(physics_differences(here, there),
            (std::vector<std::string>{"forces.random_N: 40 here, 20 there",
                                      "run.method: stable here, paper there"}));

  for (const dynamics::ParamInfo& info : dynamics::gate_param_table()) {
    Scene other;
    info.ref(other.gate) = std::nextafter(info.get(here.gate), 1e30);
    const auto lines = physics_differences(here, other);
    if (info.key == "run.tolerance" || info.key == "run.event_tolerance_m") {
      EXPECT_TRUE(lines.empty()) << "`stable` does not use it";
      continue;
    }
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_EQ(lines[0].find(std::string(info.key) + ": "), 0u) << lines[0];
  }
}

TEST(PhysicsDifferences, AsksForTolerancesWhereTheyShapeTheMatrix) {
  Scene here, there;
  here.gate.run.method = there.gate.run.method = "event";
  there.gate.run.event_tolerance = 1e-3;
  EXPECT_EQ(physics_differences(here, there),
            (std::vector<std::string>{"run.event_tolerance_m: 0.01 here, 0.001 there"}));
  // Agrees with the chosen method, if it was chosen for the same tolerance.
  here.gate.run.method = "auto";
  EXPECT_TRUE(physics_differences(here, there).empty());
  there.gate.run.tolerance = 0.01;
  EXPECT_EQ(physics_differences(here, there).size(), 1u);
}

TEST(PhysicsDifferences, LeavesOutWhatShapesNoMatrix) {
  Scene other;
  other.field = {3, 4, 5};
  other.start = {1.0, 2.0, 3.0, 4.0};
  other.source = "elsewhere.toml";
  EXPECT_TRUE(physics_differences(Scene{}, other).empty());
}

// Text that is not TOML: the message uses none of the parser's words, and says what is allowed.
TEST(Scene, TextThatIsNoToml) {
  struct Mistake {
    const char *text, *said;
  };
  for (const auto& [text, said] : {
           Mistake{"body.mass_kg = 0,25",
                   "1: body.mass_kg = 0,25: a number has a decimal point, as "
                   "in 0.25"},
           {"body.mass_kg =", "1: body.mass_kg =: has no value"},
           {"[terrain]\ntypes.a = { stiffness_left_Nm_per_rad = 1,\n  damping_Nms_per_rad = 2 }",
            "2: types.a = { stiffness_left_Nm_per_rad = 1,: an inline table { } must stand on one "
            "line: close it here, or write it as a table [NAME] with a line for each key"},
           {"body = { mass_kg = 1.0 # a comment }\n}",
            "1: body = { mass_kg = 1.0 # a comment }: an inline table { } must stand on one line: "
            "close it here, or write it as a table [NAME] with a line for each key"},
           {"cell = [\n  { name = \"{S\", move = [\n0, 1],\n    odd = [] } ]",
            "3: 0, 1],: an inline table { } must stand on one line: close it here, or write it as "
            "a table [NAME] with a line for each key"},
           {"body = { mass_kg = [\n1, ,2] }",
            "2: 1, ,2] }: must be KEY = VALUE, as in "
            "body.mass_kg = 0.25"},
           {"\n[body\nmass_kg = 1", "2: [body: a table must be its name in brackets, as in [body]"},
           {"body.mass_kg = 1\nbody.radius_m = 2\nbody.mass_kg = 2",
            "3: body.mass_kg = 2: is given in line 1 already"},
           {"[body]\nmass_kg = 1\nmass_kg = 2", "3: mass_kg = 2: is given in line 2 already"},
           {"[body]\nmass_kg = 1\n[forces]\nrandom_N = 2\n[body]\nradius_m = 2",
            "5: [body]: is given in line 1 already"},
           {"run.method = stable",
            "1: run.method = stable: text must stand between quotation marks, as in \"auto\""},
           {"run.method = \"stable",
            "1: run.method = \"stable: text must stand between two quotation "
            "marks, as in \"auto\""},
           {"body.mass_kg = 10 g",
            "1: body.mass_kg = 10 g: a number must stand alone: its unit is in "
            "the key's name"},
           {"body.mass_kg: 10",
            "1: body.mass_kg: 10: must be KEY = VALUE, as in body.mass_kg = 0.25"},
           {"bins.EN_d_m = [1 2]",
            "1: bins.EN_d_m = [1 2]: an array must stand in brackets, with "
            "commas between, as in [1, 2]"},
           {"body.mass_kg = 1e999",
            "1: body.mass_kg = 1e999: is no number, or too large for one: must "
            "be as in 0.25 or 2.5e-1"},
       })
    EXPECT_EQ(scene_refusal(text), std::string("bad.toml:") + said);
  EXPECT_TRUE(scene_refusal("body.mass_kg = 1.0\nx = \xff")
                  .ends_with("has letters that are not UTF-8, or control characters"));
}

}  // namespace
}  // namespace gatewalk::lattice
