#include <tbb/global_control.h>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <string>
#include "cli/commands.h"
#include "cli/loaded_matrix.h"
#include "cli/render/json.h"
#include "cli/render/matrix.h"
#include "lattice/cells/cell_matrix.h"
#include "lattice/pool/tree_chain.h"
#include "lattice/scene/disc_field.h"
#include "lattice/scene/matrix.h"
#include "lattice/scene/scene_problem.h"
#include "lattice/study/prediction.h"
using namespace gatewalk;
template <class F>
void best(const char* name, const F& f, int n = 30) {
  double least = 1e9;
  f();
  for (int i = 0; i < n; ++i) {
    const auto b = std::chrono::steady_clock::now();
    f();
    least = std::min(
        least,
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - b).count());
  }
  std::printf("%-24s %.4f ms\n", name, least);
}
int main(int, char** argv) {
  const tbb::global_control allow(tbb::global_control::max_allowed_parallelism, 1);
  const std::string path = argv[1];
  best("is_of_cells", [&] { (void)lattice::is_of_cells(path); });
  best("read_matrix", [&] { (void)lattice::read_matrix(path); });
  const auto file = lattice::read_matrix(path);
  best("copy file", [&] { auto c = file; });
  best("parse_scene", [&] { (void)lattice::parse_scene(file.text.at("scene"), "x"); });
  const auto scene = lattice::parse_scene(file.text.at("scene"), "x");
  best("copy scene", [&] { auto c = scene; });
  best("physics_differences", [&] { (void)lattice::physics_differences(scene, scene); });
  best("to_toml", [&] { (void)lattice::to_toml(scene); });
  best("problem_of", [&] { (void)lattice::problem_of(scene); });
  const auto problem = lattice::problem_of(scene);
  best("recorded", [&] { (void)cli::recorded(file, path, "state_space"); });
  best("read_scene_matrix", [&] { (void)lattice::read_scene_matrix(path, "", {}); });
  if (lattice::has_runs(file)) {
    best("pool_of", [&] { (void)lattice::pool_of(file, problem, path); });
    const auto pool = lattice::pool_of(file, problem, path);
    best("copy pool", [&] { auto c = pool; });
    lattice::AccuracyOptions how;
    how.accuracy = 0.1;
    auto p = pool;
    best("predict_pooled",
         [&] { (void)lattice::predict_pooled(problem, p, {problem.start}, how); });
  } else {
    best("predict", [&] {
      (void)lattice::predict(
          lattice::counted_field(file.transitions), scene.field,
          {lattice::chain_start(file.transitions.space, scene.field, problem.start)}, {}, 1);
    });
  }
  const auto l = std::make_shared<const cli::LoadedMatrix>(cli::load_matrix(path));
  best(
      "command",
      [&] {
        cli::Arguments a{path, "--quiet", "--json=-"};
        a.loaded = {l};
        a.given_out = [](const cli::Json&) {};
        a.work = dynamics::Work{};
        (void)cli::run_predict(a);
      },
      3000);
}
