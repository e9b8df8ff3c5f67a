#include <algorithm>

#include "cli/arguments.h"
#include "cli/render/choice.h"
#include "cli/render/health.h"
#include "cli/render/json.h"
#include "cli/render/matrix.h"
#include "cli/render/observed.h"
#include "cli/render/states.h"
#include "cli/render/validation.h"

namespace gatewalk::cli {
namespace {

/// Of an experiment's trials: so many of the dynamics, and the chance in these is small beside its
/// own. And at least so many.
constexpr std::int64_t kTrialsPerObserved = 20, kLeastBesideObserved = 10'000;

/// A matrix to validate, and what its file or its making says of it.
struct Validated {
  lattice::SceneMatrix matrix;
  std::vector<lattice::PaperStart> starts;
  std::optional<lattice::Observed> observed;
  Json status, settled, states;
};

lattice::SceneMatrix matrix_of(lattice::Scene scene, std::vector<dynamics::Transitions> matrices) {
  lattice::SceneMatrix m{{dynamics::Transitions(matrices.front().space), {}}, std::move(scene)};
  lattice::put_matrices(m.file, m.scene, std::move(matrices));
  return m;
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
                                               const lattice::Scene& scene) {
  if (!options.has("observed")) return {};
  auto observed = lattice::read_observed(options.texts("observed"), scene.field);
  warn_of_trials(options, observed);
  return observed;
}

Validated read_subject(const Options& options) {
  const std::string path = options.text("matrix");
  lattice::SceneMatrix m = read_matrix(options, path, options.text("scene"), options.overrides());
  auto starts = starts_for(options, m.scene);
  lattice::require_inside(starts, m.scene);
  (void)lattice::entries_at(starts);
  auto observed = experiment_of(options, m.scene);
  add_starts_to(m, path, options, lattice::entries_at(starts));
  require_inside_bins(options, starts, m.scene, m.file.transitions.space);
  Json status = recorded_status(m.file), settled = recorded(m.file, path, "method"),
       states = recorded(m.file, path, "state_space");
  return {std::move(m),      std::move(starts),  std::move(observed),
          std::move(status), std::move(settled), std::move(states)};
}

Validated build_subject(const Options& options) {
  const std::int64_t trials = options.has("matrix-trials") ? options.count("matrix-trials") : 100;
  lattice::Scene scene = options.read_scene();
  const lattice::BinsChoice choice = bins_choice(options, scene, options.has("matrix-trials"));
  auto starts = starts_for(options, scene);
  lattice::require_inside(starts, scene);
  const auto entries = lattice::entries_at(starts);
  auto observed = experiment_of(options, scene);
  const bool tree = choice.kind == lattice::BinsChoice::Kind::tree;
  if (tree && options.has("matrix-trials"))
    throw UsageError("--matrix-trials is of runs per state of bins: --bins tree takes --accuracy");
  for (const char* other : {"accuracy", "gate-runs"})
    if (!tree && options.has(other))
      throw UsageError(std::string("--") + other +
                       " has no meaning for bins: it is for --bins tree");
  if (!tree && choice.kind != lattice::BinsChoice::Kind::automatic)
    require_inside_bins(options, starts, scene, lattice::fixed_space(scene));
  const auto settled = settle_method(options, scene, lattice::RunsFrom::everywhere);
  if (tree) {
    lattice::TreeOptions how{.accuracy = accuracy_of(options), .starts = entries};
    lattice::TreeChain chain =
        lattice::make_tree_chain(lattice::problem_of(scene), how, options.work());
    warn_of(options, *chain.prediction, how.accuracy.accuracy);
    Json status = to_json(chain.transitions.front().health),
         states = to_json(chain, how.accuracy.accuracy);
    return {matrix_of(std::move(scene), std::move(chain.transitions)),
            std::move(starts),
            std::move(observed),
            std::move(status),
            settled ? to_json(*settled) : Json(),
            std::move(states)};
  }
  const lattice::States states = states_of(options, scene, choice, lattice::bodies_at(starts));
  for (const std::string& text : complaints(states)) options.warn(text);
  auto built = lattice::build_matrices(scene, states, trials, options.seed(), options.work());
  Json status = to_json(built.front().health);
  return {matrix_of(std::move(scene), std::move(built)),
          std::move(starts),
          std::move(observed),
          std::move(status),
          settled ? to_json(*settled) : Json(),
          to_json(states)};
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
  if (const auto starts = given_starts(options);
      options.has("figure") && starts.size() > kMostValidated)
    throw UsageError("--figure: shows at most " + std::to_string(kMostValidated) +
                     " starts, these are " + std::to_string(starts.size()));
  if (options.has("matrix"))
    for (const char* other : {"bins", "matrix-trials", "accuracy", "gate-runs"})
      if (options.has(other))
        throw UsageError(
            std::string("--") + other + " has no meaning beside --matrix: that one " +
            (std::string_view(other) == "bins" ? "has its states already" : "is built already"));
  const dynamics::Stopwatch watch;
  const Validated subject = options.has("matrix") ? read_subject(options) : build_subject(options);
  if (const auto& observed = subject.observed) {
    how.observed = observed->seen;
    if (!options.has("trials"))
      how.trials = std::max(kLeastBesideObserved, kTrialsPerObserved * observed->seen.trials());
  }
  const lattice::Scene& scene = subject.matrix.scene;
  const auto matrices = lattice::matrices_of(subject.matrix.file, scene);
  const ValidatedMatrix matrix{matrices,        subject.starts, options.text("matrix"),
                               watch.seconds(), subject.status, subject.settled,
                               subject.states};

  const auto result =
      lattice::validate_chain(lattice::problem_of(scene), matrices,
                              lattice::entries_at(subject.starts), how, options.work());

  Json json = to_json(result, scene, matrix);
  std::string table = table_of(result, scene, matrix);
  if (const auto& experiment = result.starts.front().observed) {
    json["observed"] = to_json(*experiment, result.starts.front(), options.texts("observed"));
    json["observed"]["went_back"] = subject.observed->went_back;
    table = table_of(*experiment, result.starts.front());
  }
  json["made_by"] = to_json(options.provenance(scene));
  options.give_out(json, table);
  if (subject.observed) options.warn(endings_not_listed(*subject.observed, result.starts.front()));
  const int exit = status_of(options, result.health);
  options.draw([&] { return figure_of(result, scene); });
  return exit;
}

}  // namespace gatewalk::cli
