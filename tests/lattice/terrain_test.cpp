// SPDX-License-Identifier: MIT
// Gates of several types in one field: table [terrain], its runs and its chains.
#include "lattice/scene/terrain.h"
#include "lattice/pool/predict_pooled.h"
#include "lattice/scene/scene_keys.h"

#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include "lattice/pool/tree_chain.h"
#include "lattice/scene/scene.h"
#include "lattice/scene/scene_problem.h"
#include "lattice/source/source_file.h"
#include "lattice/statistics/compare.h"
#include "lattice/study/memory.h"
#include "lattice/study/plan.h"
#include "lattice/study/prediction.h"
#include "lattice/study/trials.h"
#include "lattice/study/validation.h"
#include "tests/support/disc_fields.h"
#include "tests/support/refusal.h"

namespace gatewalk::lattice {
namespace {

using test::scene_refusal;

using dynamics::StateSpace;

/// Two types in 3 x 2 gates.
const std::string kTypes = R"(
[terrain.types.s]
beams.stiffness_left_Nm_per_rad = 200.0
beams.stiffness_right_Nm_per_rad = 200.0

[terrain.types.t]
forces.propulsion_N = 6.0
)";
const std::string kField = "field = { columns = 3, rows = 2 }\nrun.method = \"moreau\"\n";

Scene with_map(const std::string& map, const std::string& types = kTypes,
               const std::string& keys = kField) {
  return parse_scene(keys + "[terrain]\n" + map + "\n" + types, "x.toml");
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

// ---- The table

TEST(Terrain, TheFirstRowOfTheMapIsTheFarSide) {
  const Scene scene = with_map(R"(map = ["s.t", "..s"])");
  ASSERT_TRUE(scene.terrain);
  EXPECT_EQ(scene.terrain->type_of_cell, (std::vector<int>{0, 0, 1, 1, 0, 2}));
  const FieldGates gates = gates_of(scene);
  EXPECT_EQ(gates.at(2, 0).beams.stiffness_left, 200.0);
  EXPECT_EQ(gates.at(2, 0).forces.propulsion, scene.gate.forces.propulsion);
  EXPECT_EQ(gates.at(2, 1).forces.propulsion, 6.0);
  EXPECT_EQ(gates.at(0, 0).beams.stiffness_left, scene.gate.beams.stiffness_left);
}

TEST(Terrain, ReadsBackTheSame) {
  for (const std::string map :
       {"map = [\"s.t\", \"..s\"]", "random = { s = 0.3, t = 0.2 }\nseed = 5",
        "random = { s = 0.25, t = 0.75 }"}) {
    const Scene scene = with_map(map);
    const Scene again = parse_scene(to_toml(scene), "again");
    EXPECT_EQ(to_toml(again), to_toml(scene));
    EXPECT_EQ(again.terrain->type_of_cell, scene.terrain->type_of_cell);
    EXPECT_TRUE(physics_differences(again, scene).empty());
  }
  const Scene named = with_map("map = [\"soft, ., soft\", \".,.,soft\"]",
                               "types.soft.beams.stiffness_left_Nm_per_rad = 200\n");
  EXPECT_EQ(map_rows(*named.terrain, named.field),
            (std::vector<std::string>{"soft,.,soft", ".,.,soft"}));
  EXPECT_EQ(to_toml(parse_scene(to_toml(named), "again")), to_toml(named));
}

TEST(Terrain, AMapMayBeAFileBesideTheScene) {
  const std::filesystem::path folder = testing::TempDir();
  std::ofstream(folder / "map.csv") << "s,.,t\r\n.,.,s\n\n";
  std::ofstream(folder / "letters.txt") << "s.t\n..s\n";
  std::ofstream(folder / "bad.csv") << "s,.,t\n.,q,s\n";
  const auto read = [&](const std::string& file) {
    std::ofstream(folder / "scene.toml") << kField << "[terrain]\nmap_file = \"" << file << "\"\n"
                                         << kTypes;
    return read_scene((folder / "scene.toml").string(), {});
  };
  for (const std::string file : {"map.csv", "letters.txt"})
    EXPECT_EQ(read(file).terrain->type_of_cell, (std::vector<int>{0, 0, 1, 1, 0, 2})) << file;
  const auto message = [&](const std::string& file) {
    try {
      (void)read(file);
    } catch (const SceneError& e) {
      return std::string(e.what());
    }
    return std::string("(accepted)");
  };
  EXPECT_TRUE(contains(message("bad.csv"),
                       "bad.csv:2: row 2 of the map, column 2: \"q\" is no type of gate: there are "
                       "., s, t"))
      << message("bad.csv");
  const std::string none = message("none.csv");
  EXPECT_TRUE(contains(none, "scene.toml:4: terrain.map_file: ") &&
              contains(none, "none.csv: cannot be read: No such file or directory"))
      << none;
  EXPECT_TRUE(contains(message("/dev/zero"), "terrain.map_file: /dev/zero is a device"))
      << message("/dev/zero");  // a device has no end
}

TEST(Terrain, TheFileThatASceneNamesIsKnownWithoutReadingIt) {
  const auto map_file_in = [](const std::string& text, const std::string& name) {
    return TomlFile(text, name).map_file();
  };
  EXPECT_EQ(map_file_in("[terrain]\nmap_file = \"map.csv\"\n", "scenes/a.toml"), "scenes/map.csv");
  EXPECT_EQ(map_file_in("terrain.map_file = '/a/map.csv'", "scenes/a.toml"), "/a/map.csv");
  EXPECT_EQ(map_file_in("terrain = { map_file = \"map.csv\" }", ""), "map.csv");
  for (const char* other : {"", "[terrain]\nmap = [\".\"]\n", "terrain.map_file = 3",
                            "map_file = \"map.csv\"", "terrain = 1", "no scene", "[[["})
    EXPECT_EQ(map_file_in(other, "scenes/a.toml"), "") << other;
}

// A pixel is a gate; the upper row is the far side.
TEST(Terrain, AMapMayBeAPicture) {
  const std::filesystem::path folder = testing::TempDir();
  const std::string grey = "grey = { s = 0, t = 128, \".\" = 255 }\n";
  const auto write = [&](png_uint_32 format, std::vector<png_byte> pixels, png_uint_32 columns) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = columns;
    image.height = 2;
    image.format = format;
    ASSERT_NE(0, png_image_write_to_file(&image, (folder / "map.png").c_str(), 0, pixels.data(), 0,
                                         nullptr));
  };
  const auto read = [&](const std::string& keys) {
    std::ofstream(folder / "scene.toml") << kField << "[terrain]\nmap_file = \"map.png\"\n"
                                         << keys << kTypes;
    return read_scene((folder / "scene.toml").string(), {});
  };
  const auto message = [&](const std::string& keys) {
    try {
      (void)read(keys);
    } catch (const SceneError& e) {
      return std::string(e.what());
    }
    return std::string("(accepted)");
  };
  const std::vector<png_byte> map{0, 255, 128, 255, 255, 0};
  const std::vector<int> cells{0, 0, 1, 1, 0, 2};
  write(PNG_FORMAT_GRAY, map, 3);
  EXPECT_EQ(read(grey).terrain->type_of_cell, cells);
  const Scene again = parse_scene(to_toml(read(grey)), "again");  // to_toml writes letters
  EXPECT_EQ(again.terrain->type_of_cell, cells);
  EXPECT_TRUE(contains(message(""), "a picture needs the grey value of each type"));
  EXPECT_TRUE(contains(message("grey = { s = 0, \".\" = 255 }\n"),
                       "map.png: row 1, column 3 has the grey value 128: terrain.grey has 0, 255"));
  EXPECT_TRUE(
      contains(message("grey = { s = 0, q = 3 }\n"),
               "scene.toml:5: terrain.grey.q = 3: q is no type of gate: there are ., s, t"));
  EXPECT_TRUE(contains(message("grey = { s = 0, t = 0 }\n"), "another type has it"));
  EXPECT_TRUE(contains(message("grey = { s = 0, t = 256 }\n"), "from 0 (black) to 255 (white)"));

  std::vector<png_byte> colours;
  for (const png_byte value : map) colours.insert(colours.end(), 3, value);
  write(PNG_FORMAT_RGB, colours, 3);
  EXPECT_EQ(read(grey).terrain->type_of_cell, cells);
  colours[4] = 254;
  write(PNG_FORMAT_RGB, colours, 3);
  EXPECT_TRUE(contains(message(grey), "row 1, column 2 has the colour 255, 254, 255"));
  write(PNG_FORMAT_GA, {0, 255, 0, 255, 0, 255, 0, 255, 0, 7, 0, 255}, 3);
  EXPECT_TRUE(contains(message(grey), "row 2, column 2 is not opaque"));
  write(PNG_FORMAT_GRAY, {0, 0, 0, 0}, 2);
  EXPECT_TRUE(
      contains(message(grey), "is 2 pixels wide and 2 high, the field has 3 columns and 2"));
  // A picture with a palette, of which the file then loses the last colour.
  const auto write_palette = [&](std::vector<png_byte> pixels, bool is_cut) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = 3;
    image.height = 2;
    image.format = PNG_FORMAT_GRAY | PNG_FORMAT_FLAG_COLORMAP;
    image.colormap_entries = 4;
    const std::array<png_byte, 4> palette{0, 128, 255, 7};
    ASSERT_NE(0, png_image_write_to_file(&image, (folder / "map.png").c_str(), 0, pixels.data(), 0,
                                         palette.data()));
    if (!is_cut) return;
    std::ifstream file(folder / "map.png", std::ios::binary);
    std::string bytes(std::istreambuf_iterator<char>(file), {});
    const auto at = bytes.find("PLTE");
    ASSERT_NE(at, bytes.npos);
    bytes.replace(at - 4, 24,
                  std::string("\0\0\0\x09PLTE\0\0\0\x80\x80\x80\xff\xff\xff\xc1\xd2\xdd\xa3", 21));
    std::ofstream(folder / "map.png", std::ios::binary) << bytes;
  };
  for (const bool is_cut : {false, true}) {
    write_palette({0, 2, 1, 2, 2, 0}, is_cut);
    EXPECT_EQ(read(grey).terrain->type_of_cell, cells);
  }
  write_palette({0, 2, 1, 2, 3, 0}, false);
  EXPECT_TRUE(contains(message(grey), "map.png: row 2, column 2 has the grey value 7"));
  write_palette({0, 2, 1, 2, 3, 0}, true);
  EXPECT_TRUE(contains(message(grey),
                       "map.png: row 2, column 2 has colour 3 of a palette of 3, counted from 0"))
      << message(grey);
  // A gamma in the file would silently change its values.
  write(PNG_FORMAT_GRAY, map, 3);
  std::ifstream plain(folder / "map.png", std::ios::binary);
  std::string bytes(std::istreambuf_iterator<char>(plain), {});
  plain.close();
  if (const auto old = bytes.find("gAMA"); old != bytes.npos) bytes.erase(old - 4, 16);
  bytes.insert(33, std::string("\0\0\0\4gAMA\0\1\x86\xa0\x31\xe8\x96\x5f", 16));  // 1.0
  std::ofstream(folder / "map.png", std::ios::binary) << bytes;
  EXPECT_TRUE(contains(message(grey), "has a gamma of its own")) << message(grey);
  write(PNG_FORMAT_GRAY, map, 3);
  std::filesystem::resize_file(folder / "map.png",
                               std::filesystem::file_size(folder / "map.png") - 20);
  EXPECT_TRUE(
      contains(message(grey), "map.png: cannot be read as a PNG: it is cut short or damaged"))
      << message(grey);
  std::ofstream(folder / "map.png") << "none";
  EXPECT_TRUE(contains(message(grey), "map.png: cannot be read as a PNG: it is none, or damaged"));
  std::filesystem::remove(folder / "map.png");
  EXPECT_TRUE(contains(message(grey), "map.png: cannot be read: No such file"));
  try {
    (void)with_map("map = [\"s.t\", \"..s\"]\n" + grey);
    FAIL();
  } catch (const SceneError& e) {
    EXPECT_TRUE(contains(e.what(), "has no meaning without a picture")) << e.what();
  }
}

// Each type has the share asked for; the same seed gives the same map, and a gate's type depends on
// its place (counted from the start's column), not on the size of the field.
TEST(Terrain, DrawsAMapByShares) {
  const auto drawn = [](int columns, int rows, int seed) {
    return with_map("random = { s = 0.3, t = 0.2 }\nseed = " + std::to_string(seed), kTypes,
                    "field = { columns = " + std::to_string(columns) +
                        ", rows = " + std::to_string(rows) + " }\n")
        .terrain->type_of_cell;
  };
  const std::vector<int> large = drawn(101, 101, 5);
  for (const auto& [type, share] : {std::pair{0, 0.5}, {1, 0.3}, {2, 0.2}})
    EXPECT_NEAR(static_cast<double>(std::count(large.begin(), large.end(), type)) / 10201.0, share,
                4.0 * std::sqrt(share * (1.0 - share) / 10201.0));
  EXPECT_EQ(drawn(101, 101, 5), large);
  EXPECT_NE(drawn(101, 101, 6), large);
  const std::vector<int> small = drawn(9, 4, 5);
  for (int row = 0; row < 4; ++row)
    for (int i_x = -4; i_x <= 4; ++i_x)
      EXPECT_EQ(small[static_cast<std::size_t>(row * 9 + i_x + 4)],
                large[static_cast<std::size_t>(row * 101 + i_x + 50)]);
  // The map is the same wherever bodies start.
  const Scene elsewhere =
      with_map("random = { s = 0.3, t = 0.2 }\nseed = 5", kTypes,
               "field = { columns = 9, rows = 4, start_column = 1, start_row = 2 }\n");
  EXPECT_EQ(elsewhere.terrain->type_of_cell, small);
}

TEST(Terrain, OverridesChangeSingleKeys) {
  const std::string text = kField + "[terrain]\nmap = [\"s.t\", \"..s\"]\n" + kTypes;
  const Scene scene = parse_scene(text, "x.toml",
                                  {"terrain.types.s.beams.stiffness_left_Nm_per_rad=300",
                                   "terrain.map=[\"...\", \"tts\"]", "forces.drag_Ns_per_m=0.5"});
  const FieldGates gates = gates_of(scene);
  EXPECT_EQ(gates.at(2, 0).beams.stiffness_left, 300.0);
  EXPECT_EQ(gates.at(2, 0).beams.stiffness_right, 200.0);
  EXPECT_EQ(gates.at(2, 0).forces.drag, 0.5);  // a type has the scene's other keys
  EXPECT_EQ(gates.at(0, 0).forces.propulsion, 6.0);
}

TEST(Terrain, ErrorsNameFileLineKeyAndWhatIsAllowed) {
  const auto says = [](const std::string& table, const std::string& message,
                       const std::string& types = kTypes, const std::string& keys = kField) {
    const std::string text = scene_refusal(keys + "[terrain]\n" + table + "\n" + types);
    EXPECT_TRUE(contains(text, message)) << text;
  };
  says(
      "map = [\"s.t\", \".x.\"]",
      "bad.toml:4: terrain.map: row 2 of the map, column 2: \"x\" is no type of gate: there are ., "
      "s, "
      "t");
  says("map = [\"s.t\",\n \"..\"]",
       "bad.toml:5: terrain.map: row 2 of the map has 2 gates, field.columns = 3");
  says("map = [\"s.t\"]", "bad.toml:4: terrain.map: the map has 1 rows, field.rows = 2");
  says("map = \"s.t\"", "terrain.map = \"s.t\" is not permitted: must be an array of texts");
  says("random = { s = 0.7, t = 0.4 }",
       "bad.toml:4: terrain.random.t = 0.4: the shares of terrain.random sum up to 1.1, more than "
       "1");
  says("random = { s = -0.1 }", "must be a share in [0, 1]");
  says("random = { u = 0.1 }", "u is no type of gate: there are ., s, t");
  says("random = { s = 0.1 }\nseed = -1", "terrain.seed = -1 is not permitted");
  says("map = [\"s.t\", \"...\"]\nseed = 1", "terrain.seed = 1 has no meaning");
  says("map = [\"s.t\", \"...\"]\nrandom = { s = 0.1 }",
       "must have one of map, map_file and random");
  says("", "must have one of map, map_file and random");
  says("maps = 1",
       "bad.toml:4: unknown key terrain.maps; [terrain] has map, map_file, grey, random");
  const std::string map = "map = [\"...\", \"...\"]";
  says(map, "bad.toml:6: terrain.types.s.field.rows is not permitted: all gates of a field have it",
       "[terrain.types.s]\nfield.rows = 1\n");
  says(map, "terrain.types.s: unknown key beams.mass; the closest known key is beams.mass_kg",
       "[terrain.types.s]\nbeams.mass = 1\n");
  says(map, "bad.toml:6: terrain.types.s: ", "[terrain.types.s]\nforces.random_rate_Hz = 33.3\n");
  says(map, "a type's name must be letters", "[terrain.types.\"1 s\"]\nbeams.mass_kg = 1\n");
  says(map, "field.fidelity = \"all\" is not permitted with [terrain]", kTypes,
       "field = { columns = 3, rows = 2, fidelity = \"all\" }\nrun.method = \"moreau\"\n");
  EXPECT_TRUE(
      contains(scene_refusal("[terain]\nmap = []\n"), "the closest known table is terrain"));
  EXPECT_TRUE(contains(scene_refusal("terrain = 3\n"), "bad.toml:1: terrain = 3 is not permitted"));
}

TEST(Terrain, IsDescribedAndCompared) {
  const Scene scene = with_map("map = [\"s.t\", \"..s\"]");
  const auto keys = describe(scene);
  const auto last = keys.back();
  EXPECT_EQ(last.key, "terrain.types.t.forces.propulsion_N");
  EXPECT_EQ(last.value, "6.0");
  EXPECT_EQ(last.unit, "N");
  EXPECT_EQ(last.source, "x.toml:11");
  Scene other = scene;
  other.terrain->types[0].keys[0].value = 250.0;
  EXPECT_EQ(physics_differences(scene, other),
            (std::vector<std::string>{
                "terrain.types.s.beams.stiffness_left_Nm_per_rad: 200 here, 250 there"}));
  other = scene;
  other.terrain->types.pop_back();
  EXPECT_EQ(physics_differences(scene, other),
            (std::vector<std::string>{"terrain.types.t: none there"}));
  EXPECT_EQ(physics_differences(other, scene),
            (std::vector<std::string>{"terrain.types.t: none here"}));
  other = scene;
  other.terrain->type_of_cell.assign(6, 0);  // a map does not shape a matrix
  EXPECT_TRUE(physics_differences(scene, other).empty());
}

// ---- Types that are alike are one

const std::string kLarge = "field = { columns = 5, rows = 5 }\nrun = { method = \"moreau\" }\n";
const std::string kMap = "map = [\"a.b.a\", \".ab..\", \"ba.ab\", \"..a..\", \"ab.ba\"]";

/// Two types with the scene's own values.
Scene alike() {
  return with_map(kMap,
                  "[terrain.types.a]\nforces.propulsion_N = 8\n"
                  "[terrain.types.b]\nbeams.damping_Nms_per_rad = 70\n",
                  kLarge + "beams.damping_Nms_per_rad = 70\nforces.propulsion_N = 8\n");
}
Scene plain() {
  return parse_scene(kLarge + "beams.damping_Nms_per_rad = 70\nforces.propulsion_N = 8\n", "plain");
}
/// Three different types; no trial starts in the scene's own gate.
Scene mixed() {
  return with_map(kMap,
                  "[terrain.types.a]\nbeams.stiffness_left_Nm_per_rad = 250\n"
                  "beams.stiffness_right_Nm_per_rad = 250\n"
                  "[terrain.types.b]\nbeams.stiffness_left_Nm_per_rad = 300\n"
                  "forces.propulsion_N = 9.5\n",
                  kLarge);
}

constexpr dynamics::BodyState kStart{4, 0, 5, 10};

TEST(Terrain, TypesThatAreAlikeGiveTheBitsOfOne) {
  const Scene several = alike(), one = plain();
  EXPECT_EQ(gates_of(several).types().size(), 1U);
  const FieldTally a = field_trials(several, {0, 300}, 3), b = field_trials(one, {0, 300}, 3);
  EXPECT_TRUE((a.final_cells == b.final_cells).all());
  EXPECT_EQ(a.endings, b.endings);
  RunPool here, there;
  const auto p = predict_pooled(problem_of(several), here, {dynamics::entry_of(kStart)},
                                {.accuracy = 0.08}),
             q = predict_pooled(problem_of(one), there, {dynamics::entry_of(kStart)},
                                {.accuracy = 0.08});
  EXPECT_TRUE((p.starts[0].final.final_cells == q.starts[0].final.final_cells).all());
  EXPECT_EQ(p.starts[0].error.total_variation, q.starts[0].error.total_variation);
}

// Other types that stand nowhere change no bit either.
TEST(Terrain, AMapOfOneTypeIsThePlainScene) {
  const Scene one = plain();
  Scene other = mixed();
  other.gate = one.gate;
  other.terrain->type_of_cell.assign(25, 0);
  ASSERT_EQ(gates_of(other).types().size(), 3U);
  const FieldTally a = field_trials(other, {0, 300}, 3), b = field_trials(one, {0, 300}, 3);
  EXPECT_TRUE((a.final_cells == b.final_cells).all());
  RunPool here, there;
  const auto p = predict_pooled(problem_of(other), here, {dynamics::entry_of(kStart)},
                                {.accuracy = 0.08}),
             q = predict_pooled(problem_of(one), there, {dynamics::entry_of(kStart)},
                                {.accuracy = 0.08});
  EXPECT_TRUE((p.starts[0].final.final_cells == q.starts[0].final.final_cells).all());
  EXPECT_EQ(p.starts[0].error.total_variation, q.starts[0].error.total_variation);
}

// ---- Kernels

TEST(Terrain, KernelsCountTheRunsOfEachType) {
  const Scene scene = mixed();
  const FieldGates gates = gates_of(scene);
  OwnRuns s;
  s.start = dynamics::entry_of(kStart);
  (void)run_field(gates, scene.field, kStart, 9, {0, 400}, &s.full);
  RunPool pool;
  pool.starts.push_back(std::move(s));
  constexpr int kPerLeaf = 7;
  const Kernel kernel = kernel_of(gates.map(), pool, kPerLeaf);
  ASSERT_EQ(kernel.counts.size(), 3U);
  std::vector<std::int64_t> runs(3, 0);
  for (std::size_t i = 0; i < 400; ++i) {
    const auto passages = pool.starts[0].full.of_trial(i);
    EXPECT_EQ(passages.front().type, gates.type_of(2, 0));
    for (std::size_t k = 1; k < passages.size(); ++k)
      runs[passages[k].type] +=
          symmetric(gates.types()[passages[k].type]) ? 2 : 1;  // mirror images
  }
  for (std::size_t type = 0; type < 3; ++type) {
    const markov::Counts& counts = kernel.counts[type];
    for (int b = 0; b < dynamics::kBoundaries; ++b) {
      const int first = kernel.space.first(b);
      const auto leaves = static_cast<int>(
          (kernel.space.trees()[static_cast<std::size_t>(b)].nodes.size() + 1) / 2);
      // Neighbours with the same row share their runs.
      std::int64_t in_parts = 0, parts = 0, least = std::numeric_limits<std::int64_t>::max();
      for (int leaf = first; leaf < first + leaves; ++leaf) {
        const Eigen::SparseVector<std::int64_t> row = counts.row(leaf).transpose();
        if (leaf > first) {
          const Eigen::SparseVector<std::int64_t> before = counts.row(leaf - 1).transpose();
          if (Eigen::VectorX<std::int64_t>(row) == Eigen::VectorX<std::int64_t>(before)) continue;
        }
        in_parts += row.sum();
        ++parts;
        least = std::min(least, row.sum());
      }
      if (parts > 1) {
        EXPECT_GE(least, kPerLeaf) << type << " " << b;
      }
      runs[type] -= in_parts;
    }
    EXPECT_EQ(runs[type], 0) << type;
  }
}

// ---- The chain and the dynamics of a mixed field

TEST(Terrain, TheChainIsThatOfItsOwnDynamics) {
  const Scene scene = mixed();
  RunPool pool;
  const auto p =
      predict_pooled(problem_of(scene), pool, {dynamics::entry_of(kStart)}, {.accuracy = 0.03});
  ASSERT_TRUE(p.reached);
  const FieldTally truth = run_field(gates_of(scene), scene.field, kStart, 77, {0, 20'000});
  const double tv = total_variation(p.starts[0].final.final_cells, shares(truth.final_cells));
  const double floor = expected_total_variation(p.starts[0].final.final_cells, truth.trials);
  EXPECT_LT(tv, floor + p.starts[0].error.total_variation);
  // The field of the plain scene differs.
  EXPECT_GT(total_variation(shares(field_trials(plain(), {0, 5000}, 1).final_cells),
                            shares(truth.final_cells)),
            0.1);
}

TEST(Terrain, AFileHoldsAMatrixForEachType) {
  const Scene scene = mixed();
  const TreeChain chain = make_tree_chain(
      problem_of(scene), {.accuracy = {.accuracy = 0.08}, .starts = {dynamics::entry_of(kStart)}});
  ASSERT_EQ(chain.transitions.size(), 3U);
  const std::string path = testing::TempDir() + "terrain.nc";
  MatrixFile file{chain.transitions.front(),
                  {{"scene", to_toml(scene)}},
                  arrays_of(chain.pool, dynamics::disc_section())};
  put_matrices(file, scene, chain.transitions);
  write_matrix(path, file);

  const SourceFile source(path);
  const SceneMatrix m = scene_matrix(source.matrix(), source.own_scene(), path, nullptr, {});
  EXPECT_EQ(m.file->types.size(), 2U);
  const auto matrices = matrices_of(*m.file, m.scene);
  for (std::size_t type = 0; type < 3; ++type)
    EXPECT_EQ(matrices[type].rows, chain.transitions[type].rows) << type;
  RunPool pool = pool_of(*m.file, problem_of(m.scene), path);
  EXPECT_EQ(std::ssize(pool.starts[0].full.endings), std::ssize(pool.starts[0].full.passed));
  EXPECT_EQ(pool.starts[0].full.final_gates, chain.pool.starts[0].full.final_gates);
  const auto p =
      predict_pooled(problem_of(m.scene), pool, {dynamics::entry_of(kStart)}, {.accuracy = 0.08});
  EXPECT_EQ(p.gate_runs, 0);
  EXPECT_LT(
      total_variation(p.starts[0].final.final_cells, chain.prediction->starts[0].final.final_cells),
      1e-12);
  // Walks with the matrices end as the prediction from the matrices says.
  const ChainStart start =
      chain_start(matrices[0].space, m.scene.field, dynamics::entry_of(kStart));
  const auto walked =
      walks(make_chain(gates_of(m.scene).map(), matrices), m.scene.field, start.start, 100'000, 4);
  const auto exact = predict(field_of(m, path, {}), m.scene.field, {start}, {}, 1);
  const auto& final = exact.starts[0].final.final_cells;
  EXPECT_LT(total_variation(shares(walked.final_cells), final),
            1.5 * expected_total_variation(final, 100'000));
  EXPECT_EQ(walked.unsampled(), 0);

  // In a field with another gate at the start, its own first runs do not count.
  Scene moved = m.scene;
  moved.terrain->type_of_cell[2] = 1;
  RunPool others = pool_of(*m.file, problem_of(moved), path);
  EXPECT_TRUE(others.starts.empty());
  EXPECT_EQ(others.gate_runs(), chain.pool.gate_runs());

  // Types of another scene are refused by name.
  const SourceFile other(TomlFile(to_toml(scene), "terrain.toml"));
  const auto message = [&](const std::string& override) {
    try {
      (void)Source::open(source, {.overrides = {override}, .scene = &other});
    } catch (const std::invalid_argument& e) {
      return std::string(e.what());
    }
    return std::string("(accepted)");
  };
  EXPECT_EQ(message("terrain.map=[\"a.b.a\", \".....\", \".....\", \".....\", \"bbbbb\"]"),
            "(accepted)");
  EXPECT_TRUE(contains(message("terrain.types.b.forces.propulsion_N=9"),
                       "terrain.types.b.forces.propulsion_N: 9 here, 9.5 there"));
  EXPECT_TRUE(
      contains(message("terrain.types.c.forces.propulsion_N=9"), "terrain.types.c: none there"));
}

TEST(Terrain, BinsHaveAMatrixForEachType) {
  const Scene scene = mixed();
  const States states = states_of(scene, {BinsChoice::Kind::paper}, {kStart}, 1);
  const auto matrices = build_matrices(scene, states, {0, 20}, 1);
  ASSERT_EQ(matrices.size(), 3U);
  // Each matrix equals that of a scene whose own gate is of the type.
  for (std::size_t type = 0; type < 2; ++type) {
    Scene own = scene;
    own.gate = gate_of(scene, scene.terrain->types[type]);
    own.terrain.reset();
    EXPECT_EQ(build_matrices(own, states, {0, 20}, 1).front().rows, matrices[type + 1].rows);
  }
  const Validation v = validate_chain(problem_of(scene), matrices, {dynamics::entry_of(kStart)},
                                      {.trials = 200, .walks = {}, .null_draws = 19});
  EXPECT_EQ(v.starts[0].dynamics.trials, 200);
  EXPECT_TRUE(v.memory->ahead.steps.empty());
  EXPECT_GT(v.memory->runs, 200);
  EXPECT_THROW(
      (void)validate_chain(problem_of(scene), {matrices[0]}, {dynamics::entry_of(kStart)}, {}),
      std::invalid_argument);
}

// ---- What a body may do: table [actions]

const std::string kActions = R"([actions.push]
forces.propulsion_mN = 9000.0
[actions.soften]
"beams.stiffness_left_Nm_per_rad" = 300.0
forces.random_N = 20.0
[actions.wait]
)";

TEST(Actions, AreTheSceneWithSomeKeysOtherwise) {
  const Scene scene = parse_scene(kField + kActions, "x.toml");
  ASSERT_EQ(scene.actions.size(), 3U);
  EXPECT_EQ(scene.actions[0].name, "push");
  const Scene push = with_action(scene, scene.actions[0]),
              soften = with_action(scene, scene.actions[1]),
              wait = with_action(scene, scene.actions[2]);
  EXPECT_EQ(push.gate.forces.propulsion, 9.0);
  EXPECT_EQ(push.gate.beams.stiffness_left, scene.gate.beams.stiffness_left);
  EXPECT_EQ(soften.gate.beams.stiffness_left, 300.0);
  EXPECT_EQ(soften.gate.beams.stiffness_right, scene.gate.beams.stiffness_right);
  EXPECT_EQ(soften.gate.forces.random, 20.0);
  EXPECT_TRUE(physics_differences(wait, scene).empty());
  EXPECT_EQ(physics_differences(push, scene).size(), 1U);
  // The scene itself stays unchanged.
  EXPECT_TRUE(physics_differences(scene, parse_scene(kField, "x.toml")).empty());
}

TEST(Actions, ReadBackTheSame) {
  const Scene scene = parse_scene(kField + kActions, "x.toml");
  const Scene again = parse_scene(to_toml(scene), "again");
  EXPECT_EQ(to_toml(again), to_toml(scene));
  ASSERT_EQ(again.actions.size(), 3U);
  EXPECT_EQ(with_action(again, again.actions[0]).gate.forces.propulsion, 9.0);
  const std::vector<KeyInfo> keys = describe(scene);
  EXPECT_EQ(keys.back().key, "actions.soften.forces.random_N");
  EXPECT_EQ(keys.back().source, "x.toml:7");
}

TEST(Actions, OverridesAddAndReplace) {
  const Scene scene =
      parse_scene(kField + kActions, "x.toml",
                  {"actions.push.forces.propulsion_N=7", "actions.rush.forces.propulsion_N = 12"});
  ASSERT_EQ(scene.actions.size(), 4U);
  EXPECT_EQ(with_action(scene, scene.actions[0]).gate.forces.propulsion, 7.0);
  EXPECT_EQ(scene.actions[1].name, "rush");
  EXPECT_EQ(with_action(scene, scene.actions[1]).gate.forces.propulsion, 12.0);
}

TEST(Actions, RefuseWhatABodyCannotChoose) {
  EXPECT_EQ(scene_refusal(kField + "[actions.a]\nfield.rows = 3\n"),
            "bad.toml:4: actions.a.field.rows is not permitted: a body cannot choose it; an action "
            "has forces and beams (but their joints) of its own");
  EXPECT_NE(scene_refusal(kField + "[actions.a]\nforces.propulsoin_N = 1.0").find("unknown key"),
            std::string::npos);
  EXPECT_NE(scene_refusal(kField + "[actions.\"1\"]\n")
                .find("bad.toml:3: actions.1: an action's name must"),
            std::string::npos);
  EXPECT_NE(
      scene_refusal(kField + "actions = 3\n").find("bad.toml:3: actions = 3 is not permitted"),
      std::string::npos);
  EXPECT_NE(
      scene_refusal(kField, {"actions.a.run.step_s=0.1"}).find("--set actions.a.run.step_s=0.1"),
      std::string::npos);
  EXPECT_NE(scene_refusal(kField + "[actions.a]\nforces = { random_N = 1.0, random_mN = 1000.0 }")
                .find("bad.toml:4: actions.a.forces.random"),
            std::string::npos);
}

// The action's number applies to gates of all types. Types that become equal stay separate, so that
// all actions have the same map.
TEST(Actions, GoBeforeTheTypesOfTheTerrain) {
  const Scene scene = parse_scene(kField + R"([terrain]
map = ["s.s", "..s"]
[terrain.types.s]
forces.propulsion_N = 6.0
beams.stiffness_left_Nm_per_rad = 200.0
[terrain.types.t]
forces.propulsion_N = 6.0
[actions.push]
forces.propulsion_N = 9.0
[actions.wait]
)",
                                  "x.toml");
  std::vector<Action> actions;
  for (const Terrain::Type& action : scene.actions)
    actions.push_back({action.name, problem_with_all_types(with_action(scene, action))});
  const FieldGates push = all_gates_of(with_action(scene, scene.actions[0])),
                   wait = all_gates_of(with_action(scene, scene.actions[1]));
  ASSERT_EQ(push.types().size(), 3U);
  EXPECT_EQ(push.types()[1].forces.propulsion, 9.0);
  EXPECT_EQ(push.types()[1].beams.stiffness_left, 200.0);
  EXPECT_EQ(wait.types()[1].forces.propulsion, 6.0);
  EXPECT_EQ(actions[0].problem.types, (std::vector<std::string>{".", "s", "t"}));
  const dynamics::CellField cells = cells_of(actions);
  ASSERT_EQ(cells.map.types.size(), 6U);
  EXPECT_EQ(cells.map.type_of(2, 0), 2);  // type s, the first action
}

}  // namespace
}  // namespace gatewalk::lattice
