#include "cli/matrix.h"

#include "cli/render/report.h"
#include "cli/terminal/progress.h"

namespace gatewalk::cli {

void require_unbroken(const dynamics::Transitions& t) {
  if (t.health.broken > 0)
    throw std::runtime_error("matrix: " + std::to_string(t.health.broken) +
                             " gate runs stopped being finite numbers; no matrix is made from such "
                             "runs, try method stable or a smaller run.step_s");
}

dynamics::Transitions build_matrix(const lattice::Scene& scene, const States& states,
                                   std::int64_t trials, std::uint64_t seed, bool show_progress) {
  dynamics::Transitions t(states.space);
  run_in_batches("building matrix", trials, show_progress, [&](std::int64_t first, std::int64_t n) {
    dynamics::add_trials(t, scene.gate, seed, {first, n}, states.entries);
  });
  require_unbroken(t);
  return t;
}

std::string faults_recorded(const Json& status) {
  try {
    return complaint(health_from(status));
  } catch (const Json::exception&) {
    return "the record of numerical faults is missing or damaged.";
  }
}

MatrixAndScene read_matrix_and_scene(const std::string& matrix_path, const std::string& scene_path,
                                     const std::vector<std::string>& overrides) {
  lattice::MatrixFile file = lattice::read_matrix(matrix_path);
  const auto stored = file.text.find("scene");
  if (stored == file.text.end()) throw markov::BadFile(matrix_path + ": holds no scene");
  const lattice::Scene built_with =
      lattice::parse_scene(stored->second, matrix_path + " (its scene)");
  lattice::Scene scene =
      scene_path.empty()
          ? lattice::parse_scene(stored->second, matrix_path + " (its scene)", overrides)
          : lattice::read_scene(scene_path, overrides);
  auto differences = lattice::physics_differences(scene, built_with);
  // A matrix that was built with a method by name is not the one that "auto" stands for.
  if (scene.gate.run.method == "auto" && file.text.count("method") == 0)
    differences.push_back("run.method: auto here, " + built_with.gate.run.method +
                          " by name there");
  if (!differences.empty()) {
    std::string text = "the scene is not the one that " + matrix_path + " was built with:";
    for (const auto& line : differences) text += "\n  " + line;
    throw UsageError(text +
                     "\n(here: the scene given; there: the matrix). Build a matrix for this "
                     "scene, or give the matrix alone to use its own scene.");
  }
  scene.gate = built_with.gate;  // the same, or the method that "auto" was settled to
  const auto text = file.text.find("status");
  Json status = text == file.text.end() ? Json() : Json::parse(text->second, nullptr, false);
  if (const std::string faults = faults_recorded(status); !faults.empty())
    warn("the runs that made " + matrix_path + ": " + faults);
  return {std::move(file), std::move(scene), std::move(status)};
}

lattice::ChainStart start_in_bins(const dynamics::StateSpace& space,
                                  const lattice::FieldParams& field,
                                  const dynamics::BodyState& body, const std::string& name) {
  const lattice::ChainStart start = lattice::chain_start(space, field, body);
  if (!start.beyond) return start;
  const dynamics::Bins& enter = space.bins()[static_cast<int>(dynamics::Boundary::enter)];
  const auto range = [](const std::vector<double>& edges) {
    return std::array<double, 2>{edges.front(), edges.back()};
  };
  const std::string bins = text_of(
      dynamics::Cell{dynamics::Boundary::enter, range(enter.d), range(enter.vx), range(enter.vy)});
  if (start.clamped)
    throw UsageError(
        name + " lies outside the chain's bins, " + bins +
        ": take a start inside them, or other bins: gatewalk build --bins auto makes them "
        "for the scene's start, a table [bins] in the scene names their edges");
  warn(name + " lies beyond every entry that the bins were made from, " + bins +
       "; the prediction is that of the outermost bin. A matrix of a scene with this start suits "
       "it");
  return start;
}

ReadyStart ready_start(const Options& options, const MatrixAndScene& m,
                       const dynamics::BodyState& body, const std::string& name) {
  const dynamics::StateSpace& space = m.file.transitions.space;
  const lattice::ChainStart start = start_in_bins(space, m.scene.field, body, name);
  const dynamics::Cell cell = space.cell(start.start.input);
  const std::string text = text_of(cell);
  const auto on_edge = [](const std::array<double, 2>& edges, double v) {
    return edges[0] < edges[1] && (v == edges[0] || v == edges[1]);
  };
  if (on_edge(cell.d, body.x) || on_edge(cell.vx, body.vx) || on_edge(cell.vy, body.vy))
    remark(options, name + " lies on an edge of its bin, " + text +
                        "; its prediction is that of the whole bin");
  return {start, text};
}

ReadyChain ready_chain(const Options& options, const MatrixAndScene& m) {
  const auto [start, text] = ready_start(options, m, m.scene.start, "the start");
  return {lattice::make_chain(m.file.transitions), start, text};
}

}  // namespace gatewalk::cli
