// SPDX-License-Identifier: MIT
#include "lattice/scene/matrix.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "dynamics/disc/row_trials.h"
#include "lattice/pool/states_info.h"
#include "lattice/scene/scene_problem.h"
#include "lattice/scene/settle.h"
#include "markov/formats/counts.h"

namespace gatewalk::lattice {

const dynamics::Section& scene_section() { return dynamics::disc_section(); }

void require_unbroken(const dynamics::Transitions& t) {
  if (t.health.broken > 0)
    throw std::runtime_error("matrix: " + std::to_string(t.health.broken) +
                             " gate runs stopped being finite numbers; no matrix is made from such "
                             "runs, try method stable or a smaller run.step_s");
}

std::vector<dynamics::Transitions> build_matrices(const Scene& scene, const States& states,
                                                  dynamics::TrialRange trials, std::uint64_t seed,
                                                  const dynamics::Work& work) {
  std::vector<dynamics::Transitions> matrices;
  const FieldGates gates = gates_of(scene);
  for (const dynamics::GateParams& gate : gates.types()) {
    dynamics::Transitions& t = matrices.emplace_back(states.space);
    const dynamics::Stage stage{"building matrix", trials,
                                std::ssize(matrices) * trials.count - trials.count,
                                std::ssize(gates.types()) * trials.count};
    work.in_kept_pieces(
        stage, dynamics::RowTrials{},
        [&](dynamics::TrialRange range) {
          return dynamics::row_trials(t.space, gate, seed, range, states.entries);
        },
        [&](const dynamics::RowTrials& piece) { dynamics::add(t, piece); });
    require_unbroken(t);
    if (matrices.size() > 1) matrices.front().health += std::exchange(t.health, dynamics::Health{});
  }
  dynamics::Transitions& first = matrices.front();
  check_outcomes(scene, RunsFrom::everywhere, seed, first.totals().runs, first.health, work);
  return matrices;
}

std::vector<dynamics::Transitions> matrices_of(const MatrixFile& file, const Scene& scene) {
  std::vector<dynamics::Transitions> matrices{file.transitions};
  const std::vector<int> types = gate_types(scene);
  for (std::size_t i = 0; i < types.size(); ++i) {
    if (types[i] < std::ssize(matrices)) continue;
    const auto found = file.types.find(scene.terrain->types[i].name);
    if (found == file.types.end())
      throw std::invalid_argument("the file has no matrix of type " + scene.terrain->types[i].name);
    matrices.push_back(found->second);
  }
  return matrices;
}

void put_matrices(MatrixFile& file, const Scene& scene,
                  std::vector<dynamics::Transitions> matrices) {
  const std::vector<int> types = gate_types(scene);
  file.types.clear();
  file.state_names.clear();
  for (std::size_t i = 0; i < types.size(); ++i)
    file.types.emplace(scene.terrain->types[i].name, matrices[static_cast<std::size_t>(types[i])]);
  file.transitions = std::move(matrices.front());
  const std::string comment = comment_on_counts(problem_of(scene).map(), file.transitions.space);
  file.text.erase(kCommentText);
  if (!comment.empty()) file.text[kCommentText] = comment;
}

Scene own_scene(const MatrixFile& file, const std::string& path) {
  const auto stored = file.text.find("scene");
  if (stored == file.text.end()) throw markov::BadFile(path + ": holds no scene");
  return parse_scene(stored->second, path + " (its scene)");
}

SceneMatrix scene_matrix(std::shared_ptr<const MatrixFile> file, const Scene& own,
                         const std::string& matrix_path, const TomlFile* other,
                         const std::vector<std::string>& overrides) {
  const auto wanted = [&] {
    if (other) return read_scene(*other, overrides);
    if (overrides.empty()) return own;
    return parse_scene(file->text.at("scene"), matrix_path + " (its scene)", overrides);
  };
  Scene scene = wanted();
  auto differences = physics_differences(scene, own);
  // A matrix that was built with a method by name is not the one that "auto" stands for.
  if (scene.gate.run.method == "auto" && file->text.count("method") == 0)
    differences.push_back("run.method: auto here, " + own.gate.run.method + " by name there");
  if (!differences.empty()) {
    std::string text = "the scene is not the one that " + matrix_path + " was built with:";
    for (const auto& line : differences) text += "\n  " + line;
    throw std::invalid_argument(
        text +
        "\n(here: the scene given; there: the matrix). Build a matrix for this "
        "scene, or give the matrix alone to use its own scene.");
  }
  scene.gate = own.gate;  // the same, or the method that "auto" was settled to
  return {std::move(file), std::move(scene)};
}

std::optional<PooledPrediction> add_starts(SceneMatrix& m, const std::string& path,
                                           const std::vector<dynamics::Entry>& starts,
                                           std::uint64_t seed, const dynamics::Work& work) {
  if (!has_runs(*m.file)) return {};
  const Problem problem = problem_of(m.scene);
  RunPool pool = pool_of(*m.file, problem, path);
  std::vector<dynamics::Entry> unknown;
  for (const dynamics::Entry& entry : starts)
    if (pool.place_of(entry) == pool.starts.size()) unknown.push_back(entry);
  if (unknown.empty()) return {};
  const TreeInfo trees = tree_info(*m.file, path);
  const AccuracyOptions how{.accuracy = trees.accuracy_of_one(),
                            .most_runs = std::max<std::int64_t>(100'000, pool.gate_runs()),
                            .per_leaf = trees.entries_per_leaf,
                            .seed = seed};
  PooledPrediction prediction = predict_pooled(problem, pool, unknown, how, work);
  std::vector<dynamics::Entry> all;
  for (const OwnRuns& s : pool.starts) all.push_back(s.start);
  MatrixFile file = *m.file;
  dynamics::Health health = file.transitions.health;
  health += prediction.health;
  put_matrices(file, m.scene, matrices_of(problem, pool, all, how.per_leaf));
  file.transitions.health = health;
  m.file = std::make_shared<const MatrixFile>(std::move(file));
  return prediction;
}

std::string entry_bins(const dynamics::StateSpace& space, int face) {
  const auto at = static_cast<std::size_t>(face);
  if (space.has_trees())
    return text_of(space.section(), dynamics::StateRange{face, space.trees()[at].seen});
  dynamics::StateRange range{face};
  for (std::size_t axis = 0; axis < space.section().coordinates.size(); ++axis) {
    const std::vector<double>& edges = space.bins()[at].edges[axis];
    range.at[axis] = {edges.front(), edges.back()};
  }
  return text_of(space.section(), range);
}

ChainStart start_in_bins(const dynamics::StateSpace& space, const FieldParams& field,
                         const dynamics::Entry& entry, const std::string& name) {
  const ChainStart start = chain_start(space, field, entry);
  if (start.clamped)
    throw std::invalid_argument(
        name + " lies outside the chain's bins, " + entry_bins(space, entry.face) +
        ": take a start inside them, or other bins: gatewalk build --bins auto makes them "
        "for the scene's start, a table [bins] in the scene names their edges");
  return start;
}

}  // namespace gatewalk::lattice
