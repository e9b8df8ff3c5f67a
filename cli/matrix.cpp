#include "cli/matrix.h"

#include "cli/progress.h"
#include "cli/report.h"

namespace gatewalk::cli {

dynamics::Transitions build_matrix(const Scene& scene, std::int64_t trials, std::uint64_t seed,
                                   bool show_progress) {
  dynamics::Transitions t(dynamics::StateSpace::paper(scene.gate));
  run_in_batches("building matrix", trials, show_progress, [&](std::int64_t first, std::int64_t n) {
    dynamics::add_trials(t, scene.gate, seed, {first, n});
  });
  if (t.health.broken > 0)
    throw std::runtime_error("matrix: " + std::to_string(t.health.broken) +
                             " gate runs stopped being finite numbers; no matrix is made from such "
                             "runs, try method stable or a smaller run.step_s");
  return t;
}

MatrixAndScene read_matrix_and_scene(const std::string& matrix_path, const std::string& scene_path,
                                     const std::vector<std::string>& overrides) {
  lattice::MatrixFile file = lattice::read_matrix(matrix_path);
  const auto stored = file.text.find("scene");
  if (stored == file.text.end()) throw markov::BadFile(matrix_path + ": holds no scene");
  const Scene built_with = parse_scene(stored->second, matrix_path + " (its scene)");
  Scene scene = scene_path.empty()
                    ? parse_scene(stored->second, matrix_path + " (its scene)", overrides)
                    : read_scene(scene_path, overrides);
  const auto differences = physics_differences(scene, built_with);
  if (!differences.empty()) {
    std::string text = "the scene is not the one that " + matrix_path + " was built with:";
    for (const auto& line : differences) text += "\n  " + line;
    throw UsageError(text + "\n(here: the scene given; there: the matrix). Build a matrix for this "
                            "scene, or give the matrix alone to use its own scene.");
  }
  return {std::move(file), std::move(scene)};
}

ReadyChain ready_chain(const Options& options, const MatrixAndScene& m) {
  ReadyChain ready{
      lattice::make_chain(m.file.transitions),
      lattice::chain_start(m.file.transitions.space, m.scene.field, m.scene.start)};
  if (ready.start.clamped)
    remark(options, "the start lies outside the chain's bins and was put into the nearest one");
  return ready;
}

}  // namespace gatewalk::cli
