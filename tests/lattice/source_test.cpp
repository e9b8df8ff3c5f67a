// SPDX-License-Identifier: MIT
#include "lattice/source/source.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include "lattice/pool/states_info.h"
#include "lattice/source/source_file.h"
#include "lattice/source/start_text.h"
#include "lattice/text/json_text.h"
#include "tests/support/disc_fields.h"

namespace gatewalk::lattice {
namespace {

const std::string kField =
    "field = { rows = 2, columns = 3 }\nforces = { propulsion_N = 7.0, random_N = 20.0 }\n";

/// A file that is deleted after it was opened, so that nothing can open it again.
SourceFile opened(const std::string& text) {
  const std::string path = testing::TempDir() + "source.toml";
  std::ofstream(path) << text;
  SourceFile file(path);
  std::filesystem::remove(path);
  return file;
}

template <class Act>
std::string refusal(Act act) {
  try {
    act();
  } catch (const std::exception& e) {
    return e.what();
  }
  return "accepted";
}

TEST(Source, ASceneIsReadOnceWhateverIsAskedOfIt) {
  const SourceFile file = opened(kField + "start = { vy_m_per_s = 12.0 }\n");
  EXPECT_FALSE(file.is_matrix());
  EXPECT_EQ(Source::open(file).problem.field.rows, 2);
  const Source s = Source::open(file, {.overrides = {"field.rows=5"}});
  EXPECT_EQ(s.problem.field.rows, 5);
  ASSERT_EQ(s.starts.size(), 1U);
  EXPECT_EQ(s.starts[0], (dynamics::Entry{0, {0, 0, 12}}));
  EXPECT_EQ(s.name_of(0), "the start");
  EXPECT_TRUE(s.pool && s.pool->starts.empty() && !s.file && !s.is_recorded());
}

TEST(Source, StartsAreReadFromTextAndRefusedByIt) {
  Source s = Source::open(opened(kField));
  EXPECT_TRUE(s.start_from({"4,5,10", "-17, 13,12"}).empty());
  ASSERT_EQ(s.starts.size(), 2U);
  EXPECT_EQ(s.entries()[1], (dynamics::Entry{0, {-17, 13, 12}}));
  EXPECT_EQ(s.problem.start, s.entries()[0]);
  EXPECT_EQ(s.name_of(0), "start d 4 m, vx 5 m/s, vy 10 m/s");
  for (const char* text : {"", "1,2", "1,2,3,4", "SE:1,2,3", "seen", "1,2,nan", "1;2;3"})
    EXPECT_EQ(refusal([&] { (void)s.start_from({text}); }),
              "--start " + std::string(text) +
                  ": must be 3 numbers d,vx,vy (m, m/s, m/s), behind a face EN or RD or LD or RT "
                  "or LT and a colon unless it is the first");
  EXPECT_TRUE(s.start_from({"EN:1,2,3", "LD:18,8,10"}).empty());
  EXPECT_EQ(s.starts[0], (dynamics::Entry{0, {1, 2, 3}}));
  EXPECT_EQ(s.starts[1], (dynamics::Entry{dynamics::left_deflect, {18, 8, 10}}));
  EXPECT_NE(refusal([&] { (void)s.start_from({"99,0,1"}); }).find("must lie inside the gate"),
            std::string::npos);
}

TEST(Source, RefusalsNameFileLineAndKey) {
  const std::string path = testing::TempDir() + "source.toml";
  EXPECT_EQ(refusal([] { (void)Source::open(opened("[forces]\nrandom_N = -3\n")); }),
            path + ":2: forces.random_N = -3 is not permitted: must lie in [0, 1e+100] N");
  EXPECT_EQ(refusal([] { (void)Source::open("none.toml"); }),
            "none.toml: cannot be read: No such file or directory");
  const SourceFile other(TomlFile(kField, "other.toml"));
  EXPECT_EQ(
      refusal([&] { (void)Source::open(opened(kField), {.scene = &other}); }),
      path + ": is no matrix of a scene; a second one, \"other.toml\", has no meaning beside it");
  EXPECT_EQ(refusal([&] {
              (void)Source::open(opened("run.method = 'moreau'\nfield.fidelity = 'all'\n"));
            }),
            path +
                ":2: field.fidelity = \"all\" is not permitted for a chain: it has \"active\", "
                "gatewalk lattice the others");
}

// Before the method is chosen, a problem has no cells, and must not count as recorded runs.
TEST(Source, APredictionChoosesTheMethodThatTheSceneLeavesOpen) {
  Source s = Source::open(opened(kField + "run = { method = 'auto' }\n"));
  EXPECT_TRUE(s.problem.cells.cells.empty());
  EXPECT_FALSE(s.is_recorded());
  s.accuracy.accuracy = 0.3;
  const PooledPrediction prediction = predict(s);
  ASSERT_TRUE(s.pilot);
  EXPECT_NE(s.scene->gate.run.method, "auto");
  EXPECT_NEAR(prediction.starts[0].final.final_cells.sum(), 1.0, 1e-9);
}

TEST(Source, ACopyAddsRunsToItsOwn) {
  const Source s = Source::open(opened(kField));
  EXPECT_THROW((void)s.matrices(), std::invalid_argument);
  Source copy = s;
  copy.accuracy.accuracy = 0.3;
  (void)predict(copy);
  EXPECT_EQ(s.pool->gate_runs(), 0);
  EXPECT_GT(copy.pool->gate_runs(), 0);
  EXPECT_THROW((void)Source{}.matrices(), std::invalid_argument);
}

TEST(Source, AMatrixSaysWhatItsTreesWereMadeFor) {
  const Scene scene = parse_scene(kField, "a.toml");
  const TreeOptions how{.accuracy = {.accuracy = 0.2}, .starts = {own_start(scene)}};
  const TreeChain chain = make_tree_chain(problem_of(scene), how);
  MatrixFile file{
      chain.transitions.front(),
      {{"scene", to_toml(scene)},
       {kStatesText, R"({"bins":"tree","entries_per_leaf":9,"gate_runs":5,"accuracy":0.2,)"
                     R"("range":{"d_m":[-5,5],"vx_m_per_s":[-1,1],"vy_m_per_s":[10,20],)"
                     R"("tried_on_starts":7,"kernel_error_95":0.1,"worst_kernel_error_95":null},)"
                     R"("states_bias":0.0})"}},
      arrays_of(chain.pool, dynamics::disc_section())};
  put_matrices(file, scene, chain.transitions);
  const std::string path = testing::TempDir() + "source.nc";
  write_matrix(path, file);
  SourceFile kept(path);
  kept.keep_in_memory();
  std::filesystem::remove(path);
  Source s = Source::open(kept);
  EXPECT_EQ(s.accuracy.per_leaf, 9);
  EXPECT_EQ(s.accuracy.accuracy, 0.1);  // half of what was asked for a range
  EXPECT_EQ(s.pool->gate_runs(), chain.pool.gate_runs());
  s.accuracy.accuracy = 0.5;
  EXPECT_EQ(predict(s).gate_runs, 0);  // its runs suffice
  const TreeInfo trees = tree_info(*s.file, path);
  EXPECT_TRUE(std::isnan(trees.range->worst_kernel_error_95));
  const dynamics::Entry inside{0, {0, 0, 12}}, outside{0, {6, 0, 12}};
  EXPECT_EQ(trees.outside(s.file->transitions.space, {inside, outside, own_start(scene)}), 1);
  // Another field of the same gates; the runs are read again for it.
  EXPECT_EQ(Source::open(kept, {.overrides = {"field.rows=4"}}).problem.field.rows, 4);
}

TEST(StatesInfo, WhatIsDamagedIsRefused) {
  const std::string whole =
      R"({"bins":"tree","entries_per_leaf":7,"gate_runs":40,"range":null,"states_bias":0.0})";
  EXPECT_EQ(states_info(whole, dynamics::disc_section()).trees->gate_runs, 40);
  for (const std::string& damaged :
       {std::string(""), std::string("[]"), whole.substr(0, whole.size() - 1), whole + "}",
        std::string(R"({"bins":"tree"})"), std::string(R"({"bins":tree})"),
        std::string(R"({"bins" "tree"})")})
    EXPECT_THROW((void)states_info(damaged, dynamics::disc_section()), std::invalid_argument)
        << damaged;
}

TEST(JsonText, TakesValuesOfAnyKind) {
  const JsonObject json(R"( { "a" : [1, {"b": "]}"}, "x,\"y"] , "c":null,"d":-2.5e3 } )");
  const auto elements = json_elements(json.at("a"));
  ASSERT_EQ(elements.size(), 3U);
  EXPECT_EQ(elements[1], R"({"b": "]}"})");
  EXPECT_EQ(elements[2], R"("x,\"y")");
  EXPECT_TRUE(std::isnan(json.number("c")));
  EXPECT_EQ(json.number("d"), -2500.0);
  EXPECT_TRUE(json_elements("[]").empty());
  EXPECT_THROW((void)json.at("b"), std::invalid_argument);
}

}  // namespace
}  // namespace gatewalk::lattice
