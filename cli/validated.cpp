// SPDX-License-Identifier: MIT
#include "cli/validated.h"

#include <fmt/core.h>

#include <algorithm>
#include <string>
#include <utility>

#include "cli/arguments.h"
#include "cli/render/matrix.h"
#include "cli/subject.h"

namespace gatewalk::cli {
namespace {

/// Of an experiment's trials: so many of the dynamics, and the chance in these is small beside its
/// own. And at least so many.
constexpr std::int64_t kTrialsPerObserved = 20, kLeastBesideObserved = 10'000;

Validated of_scene(const Options& options, lattice::Scene scene,
                   std::vector<lattice::PaperStart> papers) {
  Validated v{.problem = lattice::problem_of(scene),
              .starts = lattice::entries_at(papers),
              .result = {.shown = scene,
                         .papers = std::move(papers),
                         .like_table4 = lattice::like_table4(scene),
                         .made_by = options.provenance(scene)}};
  v.scene = std::move(scene);
  return v;
}

/// An experiment is of the scene's start, or of the one that is given.
std::vector<lattice::PaperStart> starts_for(const Options& options, const lattice::Scene& scene) {
  if (!options.has("observed")) return starts_of(options, scene);
  auto starts = options.has("start") ? given_starts(options)
                                     : std::vector<lattice::PaperStart>{lattice::own_start(scene)};
  if (starts.size() > 1)
    throw UsageError(
        fmt::format("--observed: the counts belong to one start, --start gives {}", starts.size()));
  return starts;
}

/// Before any run: what so many trials cannot show, and who is left out.
void warn_of_trials(const Options& options, const lattice::Observed& observed) {
  const std::int64_t n = observed.seen.trials();
  for (const std::string& text : observed.remarks) options.warn(text);
  options.warn(who_went_back(observed));
  options.warn(too_few_observed(observed));
  if (!observed.timed.empty())
    options.warn("--observed: times are not looked at here; gatewalk fit does");
  if (options.has("trials") && options.trials() < kTrialsPerObserved * n)
    options.warn(
        fmt::format("--trials {} for {} observed: chance in the dynamics' own trials hides "
                    "differences too; take {} or more",
                    options.trials(), n, kTrialsPerObserved * n));
}

std::optional<lattice::Observed> experiment_of(const Options& options,
                                               const lattice::FieldParams& field) {
  if (!options.has("observed")) return {};
  auto observed = lattice::read_observed(options.texts("observed"), field);
  warn_of_trials(options, observed);
  return observed;
}

void put_observed(Validated& v, const Options& options, std::optional<lattice::Observed> observed) {
  if (observed) v.result.observed = {options.texts("observed"), observed->went_back};
  v.observed = std::move(observed);
}

Validated read_subject(const Options& options) {
  const std::string path = options.text("matrix");
  lattice::SceneMatrix m = read_matrix(options, path, options.text("scene"), options.overrides());
  auto papers = starts_for(options, m.scene);
  lattice::require_inside(papers, m.scene);
  const auto starts = lattice::entries_at(papers);
  auto observed = experiment_of(options, m.scene.field);
  add_starts_to(m, path, options, starts);
  require_inside_bins(options, papers, m.scene, m.file->transitions.space);
  Validated v = of_scene(options, m.scene, std::move(papers));
  put_observed(v, options, std::move(observed));
  v.result.matrix = {.matrices = lattice::matrices_of(*m.file, m.scene),
                     .path = path,
                     .health = recorded_health(*m.file),
                     .method = recorded_method(*m.file, path),
                     .states = recorded_states(*m.file, path)};
  return v;
}

/// A chain of trees, grown for this.
void put_tree(Validated& v, const Options& options) {
  const lattice::TreeOptions how{.accuracy = accuracy_of(options), .starts = v.starts};
  lattice::TreeChain chain = lattice::make_tree_chain(v.problem, how, options.work());
  warn_of(options, *chain.prediction, how.accuracy.accuracy);
  ValidatedMatrix& matrix = v.result.matrix;
  matrix.health = chain.transitions.front().health;
  matrix.states = record_of(chain, how.accuracy.accuracy);
  matrix.matrices = std::move(chain.transitions);
}

Validated build_subject(const Options& options) {
  const std::int64_t trials = options.has("matrix-trials") ? options.count("matrix-trials") : 100;
  lattice::Scene scene = options.read_scene();
  const lattice::BinsChoice choice = bins_choice(options, scene, options.has("matrix-trials"));
  auto papers = starts_for(options, scene);
  lattice::require_inside(papers, scene);
  const auto bodies = lattice::bodies_at(papers);
  (void)lattice::entries_at(papers);
  auto observed = experiment_of(options, scene.field);
  const bool tree = choice.kind == lattice::BinsChoice::Kind::tree;
  if (tree && options.has("matrix-trials"))
    throw UsageError("--matrix-trials is of runs per state of bins: --bins tree takes --accuracy");
  if (!tree) refuse(options, {"accuracy", "gate-runs"}, "for bins: it is for --bins tree");
  if (!tree && choice.kind != lattice::BinsChoice::Kind::automatic)
    require_inside_bins(options, papers, scene, lattice::fixed_space(scene));
  auto settled = settle_method(options, scene, lattice::RunsFrom::everywhere);
  Validated v = of_scene(options, std::move(scene), std::move(papers));
  put_observed(v, options, std::move(observed));
  ValidatedMatrix& matrix = v.result.matrix;
  matrix.method = std::move(settled);
  if (tree) {
    put_tree(v, options);
    return v;
  }
  const lattice::States states = states_of(options, *v.scene, choice, bodies);
  for (const std::string& text : complaints(states)) options.warn(text);
  matrix.matrices =
      lattice::build_matrices(*v.scene, states, {0, trials}, options.seed(), options.work());
  matrix.health = matrix.matrices.front().health;
  matrix.states = record_of(states);
  return v;
}

/// Cells that another program carries out.
Validated program_subject(const Options& options) {
  refuse(options, {"bins", "matrix", "matrix-trials"},
         "for cells that another program carries out");
  Subject s = open_program(options, options.text("scene"));
  Validated v{.problem = s.problem,
              .starts = s.entries(),
              .result = {.shown = s.shown(), .made_by = s.provenance(options)}};
  if (options.has("observed") && v.starts.size() > 1)
    throw UsageError("--observed: the counts belong to one start");
  put_observed(v, options, experiment_of(options, v.problem.field));
  put_tree(v, options);
  return v;
}

}  // namespace

Validated validated(const Options& options) {
  if (has_cell(options)) return program_subject(options);
  return options.has("matrix") ? read_subject(options) : build_subject(options);
}

std::int64_t trials_beside(const lattice::Observed& observed) {
  return std::max(kLeastBesideObserved, kTrialsPerObserved * observed.seen.trials());
}

}  // namespace gatewalk::cli
