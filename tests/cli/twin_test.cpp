// SPDX-License-Identifier: MIT
#include "tests/support/twins.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <charconv>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "cli/commands.h"
#include "cli/fields/json_value.h"
#include "lattice/scene/scene.h"

namespace gatewalk::cli {
namespace {

namespace fs = std::filesystem;
using test::Twin;

const fs::path kScenes = fs::path(__FILE__).parent_path() / ".." / ".." / "scenes";

class TwinCommands : public testing::Test {
 protected:
  TwinCommands() {
    std::string name = (fs::temp_directory_path() / "gatewalk-twin-XXXXXX").string();
    if (!::mkdtemp(name.data())) throw std::runtime_error("mkdtemp");
    folder_ = name;
  }
  ~TwinCommands() override { fs::remove_all(folder_); }

  [[nodiscard]] std::string path(const std::string& name) const {
    return (folder_ / name).string();
  }

  /// Writes a rescaled scene, with every key that the file names; the other keys must follow.
  [[nodiscard]] std::string rescaled(const lattice::Scene& scene, const Twin& twin,
                                     const std::string& name) const {
    std::ofstream out(path(name));
    for (const lattice::KeyInfo& k : lattice::describe(scene)) {
      if (k.source == "derived" || k.source == "paper") continue;
      double number = 0.0;
      const bool numeric =
          std::from_chars(k.value.data(), k.value.data() + k.value.size(), number).ec ==
          std::errc();
      const double factor = twin.of(k.key);
      char text[40];
      if (numeric && factor != 1.0) std::snprintf(text, sizeof text, "%.17e", number * factor);
      out << k.key << " = " << (numeric && factor != 1.0 ? text : k.value.c_str()) << "\n";
    }
    return path(name);
  }

  Json result(int (*run)(const Arguments&), std::vector<std::string> words) const {
    const std::string file = path("result.json");
    words.insert(words.end(), {"--json", file, "--force", "--quiet"});
    EXPECT_EQ(run(words), 0);
    std::ifstream in(file);
    return Json::parse(in);
  }

  fs::path folder_;
};

/// Whether a key is not compared: its value is a clock's, or not computed from the scene.
bool is_told(const std::string& key) {
  for (const char* told :
       {"seconds", "made_by", "speed_ratio", "threads", "matrix", "microseconds", "work_per_trial"})
    if (key == told) return true;
  return false;
}

/// Checks that numbers of `b` are those of `a` times the factor of the unit in their key, also
/// numbers within texts.
void expect_twins(const Json& a, const Json& b, const Twin& twin, const std::string& key) {
  ASSERT_EQ(a.type(), b.type()) << key;
  if (a.is_object()) {
    ASSERT_EQ(a.size(), b.size()) << key;
    for (const auto& [name, value] : a.items()) {
      ASSERT_TRUE(b.contains(name)) << name;
      if (is_told(name) && !value.is_object()) continue;
      if (name == "made_by" || name == "speed_ratio" || name == "seconds") continue;
      expect_twins(value, b.at(name), twin, name);
    }
  } else if (a.is_array()) {
    ASSERT_EQ(a.size(), b.size()) << key;
    for (std::size_t i = 0; i < a.size(); ++i) expect_twins(a[i], b[i], twin, key);
  } else if (a.is_number()) {
    EXPECT_EQ(a.get<double>() * twin.of(key), b.get<double>()) << key;
  } else if (!a.is_string()) {
    EXPECT_EQ(a, b) << key;
  }
}

TEST_F(TwinCommands, GiveTheSameNumbersInOtherUnits) {
  const lattice::Scene scene = lattice::read_scene((kScenes / "field.toml").string(), {});
  const std::string paper = rescaled(scene, {}, "paper.toml");
  const std::string matrix = path("m.nc"), other_matrix = path("n.nc");
  struct Line {
    const char* name;
    int (*run)(const Arguments&);
    std::vector<std::string> words;  // words after the scene or matrix
    bool of_matrix;
  };
  const std::vector<Line> lines{
      {"gate", run_gate, {"--trials", "20"}, false},
      {"gate paper", run_gate, {"--trials", "20", "--set", "run.method=paper"}, false},
      {"gate moreau", run_gate, {"--trials", "20", "--set", "run.method=moreau"}, false},
      {"gate event", run_gate, {"--trials", "20", "--set", "run.method=event"}, false},
      {"lattice", run_lattice, {"--trials", "30"}, false},
      {"lattice moreau", run_lattice, {"--trials", "30", "--set", "run.method=moreau"}, false},
      {"lattice remember",
       run_lattice,
       {"--trials", "10", "--set", "run.method=moreau", "--set", "field.fidelity=remember"},
       false},
      {"walk", run_walk, {"--walks", "1000"}, true},
      {"predict", run_predict, {}, true},
      {"predict without limit", run_predict, {"--set", "field.max_gates=0"}, true},
      {"validate",
       run_validate,
       {"--trials", "20", "--matrix-trials", "2", "--null-draws", "19"},
       false},
      {"sweep", run_sweep, {"--vary", "contact.restitution=0.5:0.5:1", "--trials", "10"}, false}};
  const auto build = [&](const std::string& file, const std::string& to, const char* bins) {
    return result(run_build, {file, "-o", to, "--trials", "3", "--bins", bins});
  };
  const auto run = [&](const Line& line, const std::string& file, const std::string& from) {
    std::vector<std::string> words{line.of_matrix ? from : file};
    words.insert(words.end(), line.words.begin(), line.words.end());
    return result(line.run, words);
  };
  const Json built = build(paper, matrix, "paper");
  const Json automatic = build(paper, path("auto.nc"), "auto");
  std::vector<Json> results;
  for (const Line& line : lines) results.push_back(run(line, paper, matrix));
  std::size_t number = 0;
  for (const Twin& twin : test::twins()) {
    SCOPED_TRACE(testing::Message() << twin);
    const bool every = number++ % 5 == 0;  // slow commands run for one twin in five
    const std::string file = rescaled(scene, twin, "twin.toml");
    expect_twins(built, build(file, other_matrix, "paper"), twin, "build");
    // The pilot of 2000 trials runs for one twin only.
    if (number == 10)
      expect_twins(automatic, build(file, path("auto.nc"), "auto"), twin, "build auto");
    for (std::size_t i = 0; i < lines.size(); ++i) {
      if (!every && std::string(lines[i].name).starts_with("validate")) continue;
      SCOPED_TRACE(lines[i].name);
      expect_twins(results[i], run(lines[i], file, other_matrix), twin, lines[i].name);
    }
  }
}

}  // namespace
}  // namespace gatewalk::cli
