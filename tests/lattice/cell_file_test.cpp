// SPDX-License-Identifier: MIT
// Cell files: reading, refusals by line and key, and writing text that reads back the same.
#include "lattice/scene/cell_file.h"

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "lattice/scene/scene.h"

namespace gatewalk::lattice {
namespace {

const std::string kTracks = R"([cell]
width_m = 0.1
length_m = 0.2
symmetric = true
trapped_after_s = 10.0
[[cell.faces]]
name = "S"
move = [0, 1]
mirror = "S"
odd = ["s", "vx"]
usual.s = [-0.05, 0.05]
usual.vy = [0, 1]
[[cell.faces]]
name = "W"
move = [1, 0]
mirror = "E"
odd = ["vx"]
from = "from the \"west\""
[[cell.faces]]
name = "E"
move = [-1, 0]
odd = ["vx"]
[[cell.coordinates]]
name = "s"
unit = "m"
scale = 0.1
[[cell.coordinates]]
name = "vx"
unit = "m s-1"
words = "lateral velocity"
[[cell.coordinates]]
name = "vy"
unit = "m/s"
[field]
columns = 3
rows = 2
max_gates = 0
)";
const std::string kStart =
    "[start]\nface = \"W\"\ns_cm = 1\nvx_m_per_s = 0.25\nvy_m_per_s = -0.5\n";
const std::string kTypes = R"([[cell.types]]
name = "a"
[[cell.types]]
name = "b"
symmetric = false
)";

CellFile parse(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return parse_cell_file(text, "x.toml", overrides);
}

std::string refused_as(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    (void)parse(text, overrides);
  } catch (const SceneError& error) {
    return error.what();
  }
  return "(accepted)";
}

/// `text` with `to` instead of the first `from`.
std::string with(const std::string& from, const std::string& to, std::string text = kTracks) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, text.npos) << from;
  return text.replace(at, from.size(), to);
}

std::string more_coordinates(int count) {
  std::string text;
  for (int c = 0; c < count; ++c)
    text += "[[cell.coordinates]]\nname = \"w" + std::to_string(c) + "\"\nunit = \"1\"\n";
  return text;
}

TEST(CellFile, MayHaveEightCoordinates) {
  const CellFile file = parse(with("[field]", more_coordinates(5) + "[field]"));
  ASSERT_EQ(file.map.section.coordinates.size(), 8u);
  EXPECT_EQ(file.map.section.coordinates[7].name, "w4");
  EXPECT_EQ(to_toml(parse(to_toml(file))), to_toml(file));
}

TEST(CellFile, TellsFacesCoordinatesAndField) {
  const CellFile file = parse(kTracks + kStart);
  EXPECT_EQ(file.source, "x.toml");
  EXPECT_EQ(file.width, 0.1);
  EXPECT_EQ(file.length, 0.2);
  EXPECT_EQ(file.trapped_after, 10.0);
  const dynamics::Section& section = file.map.section;
  ASSERT_EQ(section.faces.size(), 3u);
  const dynamics::Face &south = section.faces[0], &west = section.faces[1],
                       &east = section.faces[2];
  EXPECT_EQ(dynamics::names_of(section.faces), "S, W, E");
  EXPECT_EQ((std::array{south.di_x, south.di_y, west.di_x, west.di_y, east.di_x, east.di_y}),
            (std::array{0, 1, 1, 0, -1, 0}));
  EXPECT_EQ((std::array{south.mirror, west.mirror, east.mirror}), (std::array{0, 2, 1}));
  EXPECT_EQ((std::array<int, 3>{south.odd, west.odd, east.odd}), (std::array{0b011, 0b010, 0b010}));
  EXPECT_EQ(south.origin, "from below");
  EXPECT_EQ(west.origin, "from the \"west\"");
  EXPECT_EQ(east.origin, "from the right");
  EXPECT_EQ(south.usual[0], (std::array{-0.05, 0.05}));
  EXPECT_EQ(south.usual[1], (std::array{0.0, 0.0}));
  EXPECT_EQ(south.usual[2], (std::array{0.0, 1.0}));

  ASSERT_EQ(section.coordinates.size(), 3u);
  EXPECT_EQ(section.coordinates[0].key, "s_m");
  EXPECT_EQ(section.coordinates[0].scale, 0.1);
  EXPECT_EQ(section.coordinates[1].key, "vx_m_per_s");
  EXPECT_EQ(section.coordinates[1].unit, "m s-1");
  EXPECT_EQ(section.coordinates[1].words, "lateral velocity");
  EXPECT_EQ(section.coordinates[1].scale, 1.0);
  EXPECT_EQ(section.coordinates[2].key, "vy_m_per_s");
  EXPECT_EQ(section.coordinates[2].words, "vy");
  EXPECT_EQ(file.has_scale, (std::vector<bool>{true, false, false}));
  ASSERT_EQ(section.costs.size(), 1u);
  EXPECT_EQ(section.costs[0], (dynamics::CostInfo{"time_s", "s", "duration"}));

  EXPECT_EQ(file.types, std::vector<std::string>{"."});
  ASSERT_EQ(file.map.types.size(), 1u);
  EXPECT_TRUE(file.map.types[0].symmetric);
  EXPECT_TRUE(file.map.type_of_cell.empty());
  EXPECT_EQ(file.field.columns, 3);
  EXPECT_EQ(file.field.rows, 2);
  EXPECT_EQ(file.field.max_gates, 0);
  EXPECT_EQ(file.start, (dynamics::Entry{1, {0.01, 0.25, -0.5}}));
  EXPECT_FALSE(parse(kTracks).start);
  EXPECT_FALSE(parse(with("trapped_after_s = 10.0\n", "")).trapped_after);
}

TEST(CellFile, FurtherCostsAreNamed) {
  const auto costs = parse(kTracks +
                           "[[cell.costs]]\nkey = \"work_J\"\nunit = \"J\"\n"
                           "[[cell.costs]]\nkey = \"hits\"\nunit = \"1\"\nwords = \"hits of a "
                           "pillar\"\n")
                         .map.section.costs;
  ASSERT_EQ(costs.size(), 3u);
  EXPECT_EQ(costs[1], (dynamics::CostInfo{"work_J", "J", "work"}));
  EXPECT_EQ(costs[2], (dynamics::CostInfo{"hits", "1", "hits of a pillar"}));
}

TEST(CellFile, UnitsAreLettersOfKeys) {
  for (const auto& [unit, key] :
       std::vector<std::pair<std::string, std::string>>{{"1", "s"},
                                                        {"m", "s_m"},
                                                        {"m s-1", "s_m_per_s"},
                                                        {"m s^-1", "s_m_per_s"},
                                                        {"m/s", "s_m_per_s"},
                                                        {"m / s", "s_m_per_s"},
                                                        {"m s-2", "s_m_per_s2"},
                                                        {"m/s^2", "s_m_per_s2"},
                                                        {"N m s/rad", "s_Nms_per_rad"},
                                                        {"kg*m2 s-2", "s_kgm2_per_s2"},
                                                        {"s-1", "s_per_s"},
                                                        {"1/s", "s_per_s"},
                                                        {"px/frame", "s_px_per_frame"}}) {
    const std::string text = with("unit = \"m\"", "unit = \"" + unit + "\"");
    EXPECT_EQ(parse(text).map.section.coordinates[0].key, key) << unit;
  }
  for (const char* wrong :
       {"", " ", "m-", "m//s", "/", "m s-", "metres per second!", "m^0", "m10", "%"})
    EXPECT_EQ(refused_as(with("unit = \"m\"", "unit = \"" + std::string(wrong) + "\"")),
              "x.toml:25: cell.coordinates.unit = \"" + std::string(wrong) +
                  "\" is not permitted: must be a unit, such as \"m\", \"m s-1\", \"m/s\", or "
                  "\"1\" for none");
}

TEST(CellFile, TypesStandWhereTheMapSays) {
  const CellFile file = parse(kTracks + kTypes + "[terrain]\nmap = [\"aab\", \"baa\"]\n");
  EXPECT_EQ(file.types, (std::vector<std::string>{"a", "b"}));
  EXPECT_TRUE(file.map.types[0].symmetric);
  EXPECT_FALSE(file.map.types[1].symmetric);
  EXPECT_EQ(file.map.columns, 3);
  EXPECT_EQ(file.map.type_of_cell, (std::vector<int>{1, 0, 0, 0, 0, 1}));

  const std::string path = testing::TempDir() + "cell_map.csv";
  std::ofstream(path) << "a,a,b\nb,a,a\n";
  const CellFile from_file = parse(kTracks + kTypes + "[terrain]\nmap_file = \"" + path + "\"\n");
  EXPECT_EQ(from_file.map.type_of_cell, file.map.type_of_cell);
  std::filesystem::remove(path);

  const CellFile drawn = parse(kTracks + kTypes + "[terrain]\nrandom = { b = 0.5 }\nseed = 3\n");
  EXPECT_EQ(drawn.map.type_of_cell.size(), 6u);
  EXPECT_EQ(refused_as(kTracks + kTypes + "[terrain]\nmap = [\"aab\", \"bac\"]\n"),
            "x.toml:44: terrain.map: row 2 of the map, column 3: \"c\" is no type of gate: there "
            "are a, b");
  EXPECT_EQ(refused_as(kTracks + kTypes + "[terrain.types.b]\n"),
            "x.toml:43: terrain.types is not permitted in a file of cells: its types are "
            "[[cell.types]]");
}

TEST(CellFile, WallsAreFacesOfATypeAndReadBack) {
  const auto with_walls = [](const std::string& of_a, const std::string& of_b) {
    return kTracks + "[[cell.types]]\nname = \"a\"\nwalls = " + of_a +
           "\n[[cell.types]]\nname = \"b\"\nsymmetric = false\nwalls = " + of_b + "\n";
  };
  const CellFile file = parse(with_walls("[\"W\", \"E\"]", "[\"W\"]"));
  EXPECT_EQ(file.walls, (std::vector<std::uint64_t>{0b110, 0b010}));
  EXPECT_TRUE(file.has_walls());
  const CellFile again = parse(to_toml(file));
  EXPECT_EQ(again.walls, file.walls);
  EXPECT_EQ(to_toml(again), to_toml(file));
  EXPECT_FALSE(parse(kTracks).has_walls());
  EXPECT_FALSE(parse(with_walls("[]", "[]")).has_walls());
  // What is a wall in the mirror must be one in a symmetric type.
  EXPECT_NE(refused_as(with_walls("[\"W\"]", "[]")).find("must have both W and its mirror image E"),
            std::string::npos);
  EXPECT_NE(refused_as(with_walls("\"W\"", "[]")).find("must be an array of faces"),
            std::string::npos);
  EXPECT_NE(refused_as(with_walls("[\"up\"]", "[]")).find("of S, W and E"), std::string::npos);
}

TEST(CellFile, ReadsBackTheSame) {
  const std::string costs =
      "[[cell.costs]]\nkey = \"work_J\"\nunit = \"J\"\nwords = \"a \\\\ and a \\\"\"\n";
  for (const std::string& text :
       {kTracks, kTracks + kStart, kTracks + costs, kTracks + kTypes,
        kTracks + costs + kTypes + kStart + "[terrain]\nmap = [\"aab\", \"baa\"]\n",
        kTracks + kTypes + "[terrain]\nrandom = { b = 0.5 }\nseed = 3\n"}) {
    const CellFile file = parse(text);
    const CellFile again = parse(to_toml(file));
    EXPECT_EQ(to_toml(again), to_toml(file));
    EXPECT_EQ(again.map.section, file.map.section);
    EXPECT_EQ(again.map.type_of_cell, file.map.type_of_cell);
    EXPECT_EQ(again.has_scale, file.has_scale);
    EXPECT_EQ(again.types, file.types);
    EXPECT_EQ(again.start, file.start);
    EXPECT_EQ(again.trapped_after, file.trapped_after);
    EXPECT_EQ(again.width, file.width);
    EXPECT_EQ(again.length, file.length);
    EXPECT_EQ(again.field.max_gates, file.field.max_gates);
    ASSERT_EQ(again.map.types.size(), file.map.types.size());
    for (std::size_t t = 0; t < file.map.types.size(); ++t)
      EXPECT_EQ(again.map.types[t].symmetric, file.map.types[t].symmetric);
    for (std::size_t f = 0; f < file.map.section.faces.size(); ++f)
      EXPECT_EQ(again.map.section.faces[f].usual, file.map.section.faces[f].usual);
    for (std::size_t c = 0; c < file.map.section.coordinates.size(); ++c)
      EXPECT_EQ(again.map.section.coordinates[c].scale, file.map.section.coordinates[c].scale);
  }
}

TEST(CellFile, OverridesSetSingleKeys) {
  const CellFile file =
      parse(kTracks, {"field.rows=7", "cell.width_cm=25", "cell.symmetric=false", "start.face=E",
                      "start.s_m=0", "start.vx_m_per_s=1", "start.vy_m_per_s=2", "field.rows=5"});
  EXPECT_EQ(file.field.rows, 5);
  EXPECT_EQ(file.field.columns, 3);
  EXPECT_EQ(file.width, 0.25);
  EXPECT_FALSE(file.map.types[0].symmetric);
  EXPECT_EQ(file.start, (dynamics::Entry{2, {0.0, 1.0, 2.0}}));
  const CellFile mapped = parse(kTracks + kTypes + "[terrain]\nrandom = { b = 0.5 }\n",
                                {"terrain.seed=9", "field.rows=4"});
  EXPECT_EQ(mapped.map.type_of_cell.size(), 12u);
  EXPECT_EQ(refused_as(kTracks, {"cell.faces=[]"}),
            "--set cell.faces=[]: cell.faces can only be given in the file, not by --set");
  EXPECT_EQ(refused_as(kTracks, {"field.rows=0"}),
            "--set field.rows=0: field.rows = 0 is not permitted: must lie in [1, 10001]");
  EXPECT_EQ(refused_as(kTracks, {"field.row=1"}),
            "--set field.row=1: unknown key field.row (did you mean rows?); [field] has columns, "
            "rows, max_gates, start_column and start_row");
  const CellFile own = parse(kTracks, {"field.start_row=1", "field.start_column=0"});
  EXPECT_EQ(own.field.start_row, 1);
  EXPECT_EQ(own.field.start_column(), 0);
  EXPECT_EQ(parse(to_toml(own), {"field.columns=9"}).field.start_column(), 0);
  EXPECT_EQ(parse(to_toml(file), {"field.columns=9"}).field.start_column(), 4);
  EXPECT_EQ(to_toml(parse(to_toml(own))), to_toml(own));
  EXPECT_EQ(to_toml(file).find("start_"), std::string::npos);
  EXPECT_EQ(refused_as(kTracks, {"field.start_column=3"}),
            "--set field.start_column=3: field.start_column = 3 is not permitted: must lie in [0, "
            "2]");
}

const std::string kActions =
    "[actions.slow]\nparameters.push = 1\n[actions.fast.parameters]\npush = 3.25\n"
    "\"a.b \\u0022\" = -1e-3\n[actions.as_it_is]\n";

TEST(CellFile, ActionsAreNumbersOfAProgramByName) {
  // A blank is not part of the name of a program's number.
  const std::string text = with(" \\u0022", "\\u0022", kTracks + kActions);
  const CellFile file = parse(text, {"actions.slow.parameters.push=2"});
  ASSERT_EQ(file.actions.size(), 3u);
  EXPECT_EQ(file.actions[0].name, "as_it_is");
  EXPECT_TRUE(file.actions[0].keys.empty());
  EXPECT_EQ(file.actions[1].name, "fast");
  ASSERT_EQ(file.actions[1].keys.size(), 2u);
  EXPECT_EQ(file.actions[1].keys[0].name, "parameters.a.b\"");
  EXPECT_EQ(file.actions[1].keys[0].value, -1e-3);
  EXPECT_EQ(file.actions[1].keys[1].name, "parameters.push");
  EXPECT_EQ(file.actions[1].keys[1].value, 3.25);
  EXPECT_EQ(file.actions[1].keys[1].origin, "x.toml:41");
  EXPECT_EQ(file.actions[2].name, "slow");
  ASSERT_EQ(file.actions[2].keys.size(), 1u);
  EXPECT_EQ(file.actions[2].keys[0].value, 2.0);
  EXPECT_EQ(file.actions[2].keys[0].origin, "--set actions.slow.parameters.push=2");
  EXPECT_TRUE(parse(kTracks).actions.empty());

  const std::string printed = to_toml(file);
  EXPECT_NE(printed.find("\n[actions.as_it_is]\n\n[actions.fast]\n\"parameters.a.b\\\"\" = "
                         "-0.001\nparameters.push = 3.25\n\n[actions.slow]\nparameters.push = "
                         "2.0\n"),
            printed.npos)
      << printed;
  EXPECT_EQ(to_toml(parse(printed)), printed);
}

TEST(CellFile, RefusesOtherActions) {
  const std::string numbers =
      " is not permitted: an action of cells has numbers of the program that carries bodies "
      "through, parameters.KEY";
  EXPECT_EQ(refused_as(kTracks + kActions), "x.toml:42: actions.fast.parameters.a.b \"" + numbers);
  EXPECT_EQ(refused_as(kTracks + "[actions.slow]\nforces.propulsion_N = 6\n"),
            "x.toml:39: actions.slow.forces.propulsion_N" + numbers);
  EXPECT_EQ(refused_as(kTracks + "[actions.slow]\nparameters = 6\n"),
            "x.toml:39: actions.slow.parameters" + numbers);
  EXPECT_EQ(refused_as(kTracks + "[actions.slow]\nparameters.push = \"1\"\n"),
            "x.toml:39: actions.slow.parameters.push = \"1\" is not permitted: must be a number in "
            "[-1e+300, 1e+300]");
  EXPECT_EQ(refused_as(kTracks, {"actions.slow.parameters.push=inf"}),
            "--set actions.slow.parameters.push=inf: actions.slow.parameters.push = inf is not "
            "permitted: must lie in [-1e+300, 1e+300]");
  EXPECT_EQ(refused_as(kTracks, {"actions.slow=1"}),
            "--set actions.slow=1: actions.slow = 1 is not permitted: must be a table");
  EXPECT_EQ(
      refused_as(kTracks, {"actions.2nd={}"}),
      "--set actions.2nd={}: actions.2nd: an action's name must be letters, digits and _, and "
      "begin with a letter");
}

TEST(CellFile, ACellThatIsNotSymmetricNeedsNoOddCoordinates) {
  std::string text = with("symmetric = true", "symmetric = false");
  for (const char* odd : {"odd = [\"s\", \"vx\"]\n", "odd = [\"vx\"]\n", "odd = [\"vx\"]\n"})
    text = with(odd, "", text);
  EXPECT_EQ(parse(text).map.section.faces[0].odd, 0);
  EXPECT_EQ(refused_as(text + "[[cell.types]]\nname = \"a\"\nsymmetric = true\n"),
            "x.toml:6: [[cell.faces]] has no key odd: it must say which coordinates change their "
            "sign in the mirror, [] for none, as a type of cell is symmetric");
}

// Only symmetric cells use `mirror`: for other cells any value, and any odd coordinates, are
// accepted.
TEST(CellFile, ACellThatIsNotSymmetricNeedsNoMirror) {
  const std::string text = with("symmetric = true", "symmetric = false");
  const auto mirrors = [](const std::string& file) {
    std::vector<int> all;
    for (const dynamics::Face& face : parse(file).map.section.faces) all.push_back(face.mirror);
    return all;
  };
  using dynamics::kNoMirror;
  EXPECT_EQ(mirrors(text), (std::vector<int>{0, 2, 1}));
  EXPECT_EQ(mirrors(with("mirror = \"E\"", "mirror = \"W\"", text)),
            (std::vector<int>{0, kNoMirror, kNoMirror}));
  EXPECT_EQ(mirrors(with("move = [-1, 0]", "move = [-2, 0]", text)),
            (std::vector<int>{0, kNoMirror, kNoMirror}));
  EXPECT_EQ(mirrors(with("odd = [\"vx\"]", "odd = [\"s\", \"vx\"]", text)),
            (std::vector<int>{0, kNoMirror, kNoMirror}));
}

// For every line of a file with all keys: the key misspelled, given twice, of another type, left
// out. The message names file, line and key, and what is allowed.
TEST(CellFile, EveryKeyIsRefusedByFileLineAndKey) {
  const std::string text = kTracks + "[[cell.costs]]\nkey = \"work_J\"\nunit = \"J\"\n" + kTypes +
                           with("s_cm = 1", "s_m = 0.01", kStart) +
                           "[terrain]\nrandom = { b = 0.5 }\nseed = 3\n";
  ASSERT_NO_THROW((void)parse(text));
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < text.size(); at = text.find('\n', at) + 1)
    lines.push_back(text.substr(at, text.find('\n', at) - at));
  const auto with_line = [&](std::size_t i, const std::string& line) {
    std::string other;
    for (std::size_t k = 0; k < lines.size(); ++k) other += (k == i ? line : lines[k]) + "\n";
    return refused_as(other);
  };
  std::string table, optional;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::string& line = lines[i];
    const std::size_t equals = line.find(" = ");
    if (equals == line.npos) {
      table = line.substr(line.find_first_not_of('['), line.find(']') - line.rfind('[') - 1);
      continue;
    }
    SCOPED_TRACE(line);
    const std::string key = line.substr(0, equals), value = line.substr(equals + 3),
                      begin = "x.toml:" + std::to_string(i + 1) + ": ";
    const auto expect_refused = [&](const std::string& given, const std::string& with) {
      const std::string what = with_line(i, given);
      EXPECT_TRUE(what.starts_with(begin)) << what;
      EXPECT_NE(what.find(with), what.npos) << what;
    };
    EXPECT_EQ(with_line(i, line + "\n" + line), "x.toml:" + std::to_string(i + 2) + ": " + line +
                                                    ": is given in line " + std::to_string(i + 1) +
                                                    " already");
    const bool is_text = value[0] == '"', is_array = value[0] == '[', is_table = value[0] == '{',
               is_number = std::isdigit(static_cast<unsigned char>(value[0])) || value[0] == '-';
    const std::string named = table + "." + key;
    if (!is_text)
      expect_refused(key + " = \"wide\"", named + " = \"wide\" is not permitted: must ");
    if (!is_array) expect_refused(key + " = [3]", named + " (an array) is not permitted: must ");
    if (!is_table) expect_refused(key + " = { a = 3 }", named);
    if (!is_number) expect_refused(key + " = 3", named + " = 3 is not permitted: must ");
    if (!value.starts_with("true") && !value.starts_with("false"))
      expect_refused(key + " = true", named + " = true is not permitted: must ");
    for (const std::string beyond : {"nan", "inf", "-inf", "-1e305"})
      if (is_number) expect_refused(key + " = " + beyond, named + " = ");
    if (key.find('.') == key.npos)
      expect_refused(key[0] + line, "unknown key " + table + "." + key[0] + key);
    const std::string without = with_line(i, "");
    if (without == "(accepted)")
      optional += (optional.empty() ? "" : " ") + key;
    else
      EXPECT_TRUE(without.find("] has no key " + key + ": it must ") != without.npos ||
                  without.ends_with("[terrain] must have one of map, map_file and random"))
          << without;
  }
  EXPECT_EQ(
      optional,
      "symmetric trapped_after_s mirror usual.s usual.vy mirror from scale words columns rows "
      "max_gates symmetric seed");
}

struct WrongFile {
  std::string from, to, message;
};

TEST(CellFile, RefusesByFileLineAndKey) {
  const std::vector<WrongFile> all{
      {"[cell]\nwidth_m = 0.1", "[cel]\nwidth_m = 0.1",
       "x.toml:1: unknown table cel (did you mean cell?); a file of cells has the tables cell, "
       "field, start, terrain and actions"},
      {"[field]", "[sweep]",
       "x.toml:34: unknown table sweep; a file of cells has the tables cell, field, start, terrain "
       "and actions"},
      {"width_m = 0.1", "width_in = 0.1",
       "x.toml:2: unknown key cell.width_in (did you mean width_m?); [cell] has width_m, "
       "length_m, symmetric, trapped_after_s, faces, coordinates, costs and types; width_m may end "
       "in _km, _m, _cm, _mm, _um or _nm instead"},
      {"width_m = 0.1", "width_m = 0.1\nwidth_cm = 10",
       "x.toml:3: cell.width_cm = 10 is the same quantity as cell.width_m = 0.1 (x.toml:2): give "
       "one of them"},
      {"width_m = 0.1", "width_m = 0",
       "x.toml:2: cell.width_m = 0 is not permitted: must lie in (0, 1e+300] m"},
      {"trapped_after_s = 10.0", "trapped_after_s = -1",
       "x.toml:5: cell.trapped_after_s = -1 is not permitted: must lie in (0, 1e+300] s"},
      {"name = \"S\"", "name = \"South side\"",
       "x.toml:7: cell.faces.name = \"South side\" is not permitted: must be letters, digits and "
       "_, at most 60, and begin with a letter, such as \"S\""},
      {"name = \"W\"", "name = \"S\"",
       "x.toml:14: cell.faces.name = \"S\" is not permitted: must be another name than S, trapped "
       "and lost"},
      {"name = \"W\"", "name = \"lost\"",
       "x.toml:14: cell.faces.name = \"lost\" is not permitted: must be another name than S, "
       "trapped and lost"},
      {"move = [0, 1]", "move = [0, 0]",
       "x.toml:8: cell.faces.move (an array) is not permitted: must be the move to the neighbour "
       "that is entered, two whole numbers from -1000 to 1000, not both 0: [0, 1] for one row "
       "further"},
      {"mirror = \"E\"", "mirror = \"X\"",
       "x.toml:16: cell.faces.mirror = \"X\" is not permitted: must be the face by which mirror "
       "images enter, one of S, W and E"},
      {"mirror = \"E\"", "mirror = \"W\"",
       "x.toml:16: cell.faces.mirror = \"W\" of face W is not permitted: the move of W must be "
       "[-1, 0], it is [1, 0]"},
      {"move = [-1, 0]", "move = [-1, 1]\nmirror = \"W\"",
       "x.toml:16: cell.faces.mirror = \"E\" of face W is not permitted: the move of E must be "
       "[-1, 0], it is [-1, 1]"},
      {"move = [-1, 0]", "move = [-2, 0]",
       "x.toml:19: [[cell.faces]] has no key mirror: it must be the face by which mirror images "
       "enter, one of S, W and E"},
      {"[[cell.faces]]\nname = \"E\"",
       "[[cell.faces]]\nname = \"F\"\nmove = [-1, 0]\nmirror = \"W\"\nodd = "
       "[\"vx\"]\n[[cell.faces]]\nname = \"E\"",
       "x.toml:22: cell.faces.mirror = \"W\" of face F is not permitted: the mirror of W must be "
       "F, it is E"},
      {"odd = [\"vx\"]", "odd = [\"s\", \"vx\"]",
       "x.toml:16: cell.faces.mirror = \"E\" of face W is not permitted: both must have the same "
       "odd coordinates"},
      {"odd = [\"s\", \"vx\"]", "odd = [\"s\", \"v\"]",
       "x.toml:10: cell.faces.odd = \"v\" is not permitted: must be an array of coordinates that "
       "change their sign in the mirror, of s, vx and vy; [] for none"},
      {"odd = [\"s\", \"vx\"]\n", "",
       "x.toml:6: [[cell.faces]] has no key odd: it must say which coordinates change their sign "
       "in the mirror, [] for none, as a type of cell is symmetric"},
      {"usual.s", "usual.x",
       "x.toml:11: unknown key cell.faces.usual.x (did you mean s?); [cell.faces.usual] has s, vx "
       "and vy"},
      {"usual.s = [-0.05, 0.05]", "usual.s = [0.05, -0.05]",
       "x.toml:11: cell.faces.usual.s (an array) is not permitted: must be two numbers, from and "
       "to, the smaller first"},
      {"usual.s = [-0.05, 0.05]", "usual.s = [-inf, inf]",
       "x.toml:11: cell.faces.usual.s (an array) is not permitted: must be two numbers, from and "
       "to, the smaller first"},
      {"name = \"vx\"", "name = \"out\"",
       "x.toml:28: cell.coordinates.name = \"out\" is not permitted: must be a name that nothing "
       "else in a table of runs has"},
      {"name = \"vy\"", "name = \"vx\"",
       "x.toml:32: cell.coordinates.name = \"vx\" is not permitted: must be a name that nothing "
       "else in a table of runs has"},
      {"name = \"vx\"", "name = \"out_s\"",
       "x.toml:28: cell.coordinates.name = \"out_s\" is not permitted: must not begin with out_, "
       "as columns of runs do that tell how bodies left"},
      {"scale = 0.1", "scale = 0",
       "x.toml:26: cell.coordinates.scale = 0 is not permitted: must lie in (0, 1e+300]"},
      {"[field]", more_coordinates(6) + "[field]",  // besides three others
       "x.toml:49: [[cell.coordinates]]: more than 8 are not permitted"},
      {"[field]", "[[cell.costs]]\nkey = \"work\"\nunit = \"J\"\n[field]",
       "x.toml:35: cell.costs.key = \"work\" is not permitted: must end in its unit, _J"},
      {"[field]", "[[cell.costs]]\nkey = \"time_s\"\nunit = \"s\"\n[field]",
       "x.toml:35: cell.costs.key = \"time_s\" is not permitted: must be a name that nothing else "
       "in a table of runs has"},
      {"[field]", "[[cell.types]]\nname = \"a\"\n[[cell.types]]\nname = \"a\"\n[field]",
       "x.toml:37: cell.types.name = \"a\" is not permitted: must be another name than a"},
      {"rows = 2", "rows = 0",
       "x.toml:36: field.rows = 0 is not permitted: must lie in [1, 10001]"},
      {"max_gates = 0", "fidelity = \"all\"",
       "x.toml:37: unknown key field.fidelity; [field] has columns, rows, max_gates, start_column "
       "and start_row"},
      {"max_gates = 0", "max_gates = 0\n[start]\nface = \"N\"",
       "x.toml:39: start.face = \"N\" is not permitted: must be one of S, W and E"},
      {"max_gates = 0", "max_gates = 0\n[start]\nface = \"S\"\ns_m = inf",
       "x.toml:40: start.s_m = inf is not permitted: must lie in [-1e+300, 1e+300] m"},
      {"max_gates = 0", "max_gates = 0\n[start]\nx_m = 0",
       "x.toml:39: unknown key start.x_m (did you mean s_m?); [start] has face, s_m, vx_m_per_s "
       "and vy_m_per_s"},
      {"width_m = 0.1", "width_m = 0,1",
       "x.toml:2: width_m = 0,1: a number has a decimal point, "
       "as in 0.25"}};
  for (const WrongFile& wrong : all)
    EXPECT_EQ(refused_as(with(wrong.from, wrong.to)), wrong.message) << wrong.to;
  EXPECT_EQ(refused_as(""), "x.toml: has no table [cell]");
  EXPECT_EQ(refused_as("cell = 3\n"),
            "x.toml:1: cell = 3 is not permitted: must be a table, written [cell]");
  EXPECT_EQ(refused_as("[cell]\nwidth_m = 1\n"),
            "x.toml:1: [cell] has no key coordinates: it must have what is told of every entry, "
            "each a [[cell.coordinates]]");
  EXPECT_EQ(refused_as("[cell]\ncoordinates = 3\n"),
            "x.toml:2: cell.coordinates = 3 is not permitted: must be one or more tables, each "
            "written [[cell.coordinates]], its keys below it");
  EXPECT_EQ(refused_as("[[cell.coordinates]]\nname = \"s\"\nunit = \"m\"\n"),
            "x.toml:1: [cell] has no key faces: it must have the parts of a cell's border that "
            "bodies enter by, each a [[cell.faces]]");
  EXPECT_EQ(refused_as(kTracks + std::string(1 << 20, '#')),
            "x.toml: is too large for a file of cells: more than 1048576 bytes");
  EXPECT_THROW((void)read_cell_file(testing::TempDir() + "none.toml"), SceneError);
}

}  // namespace
}  // namespace gatewalk::lattice
