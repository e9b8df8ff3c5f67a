#include <algorithm>

#include "cli/arguments.h"
#include "cli/render/choice.h"
#include "cli/render/health.h"
#include "cli/render/json.h"
#include "cli/render/matrix.h"
#include "cli/render/observed.h"
#include "cli/render/states.h"
#include "cli/render/validation.h"
#include "cli/subject.h"

namespace gatewalk::cli {
namespace {

/// Of an experiment's trials: so many of the dynamics, and the chance in these is small beside its
/// own. And at least so many.
constexpr std::int64_t kTrialsPerObserved = 20, kLeastBesideObserved = 10'000;

/// Matrices to validate, by type of cell, and what their file or their making says of them.
struct Validated {
  lattice::Problem problem;
  std::vector<dynamics::Transitions> matrices{};
  std::vector<dynamics::Entry> starts{};
  std::optional<lattice::Observed> observed{};
  Json status{}, settled{}, states{};
  std::optional<lattice::Scene> scene{};      // of gates, and ...
  std::vector<lattice::PaperStart> papers{};  // ... the starts with what the paper prints of them
  std::optional<ShownField> shown{};
  Json made_by{};
};

Validated of_scene(const Options& options, lattice::Scene scene,
                   std::vector<lattice::PaperStart> papers,
                   std::vector<dynamics::Transitions> matrices) {
  Validated v{.problem = lattice::problem_of(scene),
              .matrices = std::move(matrices),
              .starts = lattice::entries_at(papers),
              .papers = std::move(papers),
              .shown = ShownField(scene),
              .made_by = to_json(options.provenance(scene))};
  v.scene = std::move(scene);
  return v;
}

/// An experiment is of the scene's start, or of the one that is given.
std::vector<lattice::PaperStart> starts_for(const Options& options, const lattice::Scene& scene) {
  if (!options.has("observed")) return starts_of(options, scene);
  auto starts = options.has("start") ? given_starts(options)
                                     : std::vector<lattice::PaperStart>{lattice::own_start(scene)};
  if (starts.size() > 1)
    throw UsageError("--observed: the counts belong to one start, --start gives " +
                     std::to_string(starts.size()));
  return starts;
}

/// Before any run: what so many trials cannot show, and who is left out.
void warn_of_trials(const Options& options, const lattice::Observed& observed) {
  const std::int64_t n = observed.seen.trials();
  options.warn(who_went_back(observed));
  options.warn(too_few_observed(observed));
  if (options.has("trials") && options.trials() < kTrialsPerObserved * n)
    options.warn("--trials " + std::to_string(options.trials()) + " for " + std::to_string(n) +
                 " observed: chance in the dynamics' own trials hides differences too; take " +
                 std::to_string(kTrialsPerObserved * n) + " or more");
}

std::optional<lattice::Observed> experiment_of(const Options& options,
                                               const lattice::FieldParams& field) {
  if (!options.has("observed")) return {};
  auto observed = lattice::read_observed(options.texts("observed"), field);
  warn_of_trials(options, observed);
  return observed;
}

Validated read_subject(const Options& options) {
  const std::string path = options.text("matrix");
  lattice::SceneMatrix m = read_matrix(options, path, options.text("scene"), options.overrides());
  auto papers = starts_for(options, m.scene);
  lattice::require_inside(papers, m.scene);
  const auto starts = lattice::entries_at(papers);
  auto observed = experiment_of(options, m.scene.field);
  add_starts_to(m, path, options, starts);
  require_inside_bins(options, papers, m.scene, m.file.transitions.space);
  Validated v =
      of_scene(options, m.scene, std::move(papers), lattice::matrices_of(m.file, m.scene));
  v.observed = std::move(observed);
  v.status = recorded_status(m.file);
  v.settled = recorded(m.file, path, "method");
  v.states = recorded(m.file, path, "state_space");
  return v;
}

/// A chain of trees, grown for this.
void put_tree(Validated& v, const Options& options) {
  const lattice::TreeOptions how{.accuracy = accuracy_of(options), .starts = v.starts};
  lattice::TreeChain chain = lattice::make_tree_chain(v.problem, how, options.work());
  warn_of(options, *chain.prediction, how.accuracy.accuracy);
  v.status = to_json(chain.transitions.front().health);
  v.states = to_json(chain, how.accuracy.accuracy);
  v.matrices = std::move(chain.transitions);
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
  if (!tree) refuse(options, {"accuracy", "gate-runs"}, "bins: it is for --bins tree");
  if (!tree && choice.kind != lattice::BinsChoice::Kind::automatic)
    require_inside_bins(options, papers, scene, lattice::fixed_space(scene));
  const auto settled = settle_method(options, scene, lattice::RunsFrom::everywhere);
  Validated v = of_scene(options, std::move(scene), std::move(papers), {});
  v.observed = std::move(observed);
  v.settled = settled ? to_json(*settled) : Json();
  if (tree) {
    put_tree(v, options);
    return v;
  }
  const lattice::States states = states_of(options, *v.scene, choice, bodies);
  for (const std::string& text : complaints(states)) options.warn(text);
  v.matrices = lattice::build_matrices(*v.scene, states, trials, options.seed(), options.work());
  v.status = to_json(v.matrices.front().health);
  v.states = to_json(states);
  return v;
}

/// Cells that another program carries out.
Validated program_subject(const Options& options) {
  refuse(options, {"bins", "matrix", "matrix-trials"}, "cells that another program carries out");
  Subject s = open_program(options, options.text("scene"));
  Validated v{.problem = s.problem,
              .starts = s.entries(),
              .shown = s.shown(),
              .made_by = s.made_by(options)};
  if (options.has("observed") && v.starts.size() > 1)
    throw UsageError("--observed: the counts belong to one start");
  v.observed = experiment_of(options, v.problem.field);
  put_tree(v, options);
  return v;
}

}  // namespace

int run_validate(const Arguments& arguments) {
  Options options(
      "validate SCENE [options]",
      "Compares the chain with the full dynamics: for the scene's start (in the paper's field the\n"
      "four of Table IV), or those given, the endings with 95 % intervals and one verdict on "
      "endings\n"
      "and final gates that counts chance in trials and matrix together; corrcoef, RMSE and total\n"
      "variation of walks and of the exact chain, each beside its noise floor; the time each "
      "takes.\n"
      "In JSON, trials_and_matrix is that verdict; p_values count chance in the trials (and "
      "walks)\n"
      "alone. Last it asks whether the gate before, the visit or the row tell more than the "
      "state.\n"
      "With --observed, counts of an experiment are held against both, and the smallest "
      "differences\n"
      "are said that so many trials could have shown.",
      "gatewalk validate scenes/field.toml --trials 10000 --json validation.json");
  options.scene();
  options.add_count("trials", "N",
                    "trials of the full dynamics per start (default: 100; with --observed 10000, "
                    "or 20 times as many as were observed)");
  options.add_seed();
  options.add_strict();
  options.add_texts("observed", "FILE.csv",
                    "an experiment from this start, to hold against both: a line per trial, "
                    "trial,ending (crossed, left side, right side, trapped, cut off, or went back, "
                    "which the model does not have: left out) with or without gate_x,gate_y (the "
                    "final gate's i_x and i_y); or counts, gate_x,gate_y,count or ending,count, a "
                    "file of each may be given");
  options.reads("observed", [](const std::string& file) { return file; });
  options.input_file("matrix", "matrix to validate; without it one is built from the scene");
  options.add_count("matrix-trials", "N",
                    "bins: runs per input state of the matrix that is built (default: 100)");
  add_accuracy(options);
  options.add_count("walks", "N", "walks per start (default: as many as trials)");
  options.add_count("null-draws", "N",
                    "draws behind each p-value (default: 999 to 9999, by the size of the work)");
  options.add_flag("memory",
                   "also run the trials with the random force drawn anew at every crossing");
  add_starts(options);
  add_bins(options);
  add_cell_program(options);
  options.add_figure("final gates of dynamics and chain, and their difference");
  if (!options.parse(arguments)) return kFine;
  constexpr std::int64_t kMostNullDraws = 100'000;  // some 20 MB
  lattice::ValidationOptions how{.trials = options.has("trials") ? options.trials() : 100,
                                 .walks = {},
                                 .null_draws = {},
                                 .seed = options.seed(),
                                 .force_memory = options.has("memory"),
                                 .observed = {}};
  if (options.has("walks")) how.walks = options.count("walks");
  if (options.has("null-draws")) how.null_draws = options.count("null-draws", 1, kMostNullDraws);
  if (const auto starts = options.texts("start").size();
      options.has("figure") && starts > kMostValidated)
    throw UsageError("--figure: shows at most " + std::to_string(kMostValidated) +
                     " starts, these are " + std::to_string(starts));
  if (options.has("matrix"))
    for (const char* other : {"bins", "matrix-trials", "accuracy", "gate-runs"})
      if (options.has(other))
        throw UsageError(
            std::string("--") + other + " has no meaning beside --matrix: that one " +
            (std::string_view(other) == "bins" ? "has its states already" : "is built already"));
  const dynamics::Stopwatch watch;
  const Validated subject = options.has("cell-program") ? program_subject(options)
                            : options.has("matrix")     ? read_subject(options)
                                                        : build_subject(options);
  if (const auto& observed = subject.observed) {
    how.observed = observed->seen;
    if (!options.has("trials"))
      how.trials = std::max(kLeastBesideObserved, kTrialsPerObserved * observed->seen.trials());
  }
  const ValidatedMatrix matrix{subject.matrices,
                               subject.papers,
                               subject.scene && lattice::like_table4(*subject.scene),
                               options.text("matrix"),
                               watch.seconds(),
                               subject.status,
                               subject.settled,
                               subject.states};
  const auto result = lattice::validate_chain(subject.problem, subject.matrices, subject.starts,
                                              how, options.work());

  Json json = to_json(result, *subject.shown, matrix);
  std::string table = table_of(result, *subject.shown, matrix);
  if (const auto& experiment = result.starts.front().observed) {
    json["observed"] = to_json(*experiment, result.starts.front(), options.texts("observed"));
    json["observed"]["went_back"] = subject.observed->went_back;
    table = table_of(*experiment, result.starts.front());
  }
  json["made_by"] = subject.made_by;
  options.give_out(json, table);
  if (subject.observed) options.warn(endings_not_listed(*subject.observed, result.starts.front()));
  const int exit = status_of(options, result.health);
  options.draw([&] { return figure_of(result, *subject.shown); });
  return exit;
}

}  // namespace gatewalk::cli
