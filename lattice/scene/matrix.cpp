// SPDX-License-Identifier: MIT
#include "lattice/scene/matrix.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <stdexcept>
#include <utility>

#include "dynamics/base/kept_pieces.h"
#include "dynamics/disc/row_trials.h"
#include "lattice/gates/gates.h"
#include "lattice/pool/predict_pooled.h"
#include "lattice/pool/states_info.h"
#include "lattice/scene/scene_keys.h"
#include "lattice/scene/scene_problem.h"
#include "lattice/scene/settle.h"
#include "lattice/scene/terrain.h"
#include "lattice/scene/toml_file.h"
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
    in_kept_pieces(
        work, stage, dynamics::RowTrials{},
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
  // "auto" does not stand for a matrix that was built with a named method.
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
  scene.gate = own.gate;  // equal, or with the method that "auto" chose
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

namespace {

std::string name_of(const RowMatrix& o) {
  return "--row " + std::to_string(o.first) +
         (o.last == o.first ? "" : "-" + std::to_string(o.last)) + "=" + o.path;
}

std::string metres(double x) { return fmt::format("{:.3f}", x); }

/// Throws std::invalid_argument unless gates of `other` fit into the field of `base`.
void require_same_kind(const RowMatrix& other, const SceneMatrix& base,
                       const std::string& base_path) {
  const dynamics::GateParams &a = other.matrix.scene.gate, &b = base.scene.gate;
  if (a.body.mass != b.body.mass || a.body.radius != b.body.radius)
    throw std::invalid_argument(name_of(other) + ": it was built with another body than " +
                                base_path);
  if (a.beams.joint_x != b.beams.joint_x || a.run.traverse_y != b.run.traverse_y)
    throw std::invalid_argument(name_of(other) + ": its gates are " + metres(a.gate_width()) +
                                " m wide and " + metres(a.gate_length()) + " m long, those of " +
                                base_path + " " + metres(b.gate_width()) + " and " +
                                metres(b.gate_length()) + " m: they make no field");
  if (other.matrix.file->transitions.space != base.file->transitions.space)
    throw std::invalid_argument(name_of(other) + ": its states are not those of " + base_path +
                                " (other bins): what leaves one row could not enter the next");
}

}  // namespace

CountedField field_of(const SceneMatrix& base, const std::string& base_path,
                      const std::vector<RowMatrix>& others) {
  if (others.empty())
    return counted_field(gates_of(base.scene).map(), matrices_of(*base.file, base.scene));
  for (const Scene* scene : {&base.scene, &others.front().matrix.scene})
    if (scene->terrain)
      throw std::invalid_argument(name_of(others.front()) +
                                  ": cannot be put into a field with a table [terrain], which says "
                                  "what stands where");
  const int rows = base.scene.field.rows;
  std::vector<int> type_of_row(static_cast<std::size_t>(rows), 0);
  std::vector<markov::Chain> chains{make_chain(base.file->transitions)};
  std::vector<markov::Counts> counts{base.file->transitions.counts()};
  std::map<std::string, int> known;  // index by matrix file
  for (const RowMatrix& o : others) {
    if (o.first > o.last) throw std::invalid_argument(name_of(o) + ": the lower row comes first");
    if (o.last >= rows)
      throw std::invalid_argument(name_of(o) + ": the rows of this field are 0 to " +
                                  std::to_string(rows - 1));
    for (int row = o.first; row <= o.last; ++row)
      if (type_of_row[static_cast<std::size_t>(row)] != 0)
        throw std::invalid_argument(name_of(o) + ": row " + std::to_string(row) +
                                    " is given twice");
    require_same_kind(o, base, base_path);
    const auto [type, is_new] = known.emplace(o.path, static_cast<int>(chains.size()));
    if (is_new) {
      chains.push_back(make_chain(o.matrix.file->transitions));
      counts.push_back(o.matrix.file->transitions.counts());
    }
    std::fill(type_of_row.begin() + o.first, type_of_row.begin() + o.last + 1, type->second);
  }
  return {markov::FieldChain::by_row(std::move(chains), std::move(type_of_row)), std::move(counts)};
}

}  // namespace gatewalk::lattice
