#include <array>
#include <charconv>

#include "cli/arguments.h"
#include "cli/render/analysis.h"
#include "cli/render/choice.h"
#include "cli/render/final_gates.h"
#include "cli/render/health.h"
#include "cli/render/json.h"
#include "cli/render/matrix.h"
#include "cli/render/prediction.h"
#include "cli/render/scene.h"
#include "lattice/scene/scene_trials.h"
#include "lattice/study/analysis.h"
#include "lattice/study/prediction.h"

namespace gatewalk::cli {
namespace {

/// By the names of JSON. Throws UsageError for any other.
markov::Ending target_of(const Options& options) {
  const std::string name = options.text("target");
  if (const auto ending = lattice::ending_named(name)) return *ending;
  std::string names;
  for (const EndingName& e : kEndingNames)
    names += (names.empty() ? "" : ", ") + std::string(e.key);
  throw UsageError("--target " + name + ": must be one of " + names);
}

/// "3,1,2". Throws UsageError for anything else.
lattice::LumpingParts lumping_of(const Options& options) {
  constexpr int kMost = 1000;
  lattice::LumpingParts parts(3);
  const std::string text = options.text("lump");
  const char *at = text.data(), *const end = at + text.size();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const auto [next, error] = std::from_chars(at, end, parts[i]);
    const bool ends_well = i + 1 < parts.size() ? next != end && *next == ',' : next == end;
    if (error != std::errc() || !ends_well || parts[i] < 1 || parts[i] > kMost)
      throw UsageError("--lump " + text + ": must be three whole numbers from 1 to " +
                       std::to_string(kMost) + ": parts of d, of vx and of vy, as in 3,1,2");
    at = next + 1;
  }
  return parts;
}

/// What is analysed, and what is said of how it ends.
struct Subject {
  lattice::Scene scene;
  std::optional<lattice::AnalysedChain> chain;
  std::optional<lattice::RunPool> pool{};  // none of bins
  lattice::EndingShares endings;
  Json status, settled;
  bool clean = true, from_trials = false, reached = true;
  std::int64_t gate_runs = 0;
  int per_leaf = 0;            // of the pool's trees, and ...
  std::int64_t most_runs = 0;  // ... how many gate runs may still be added to it
  int states = 0;
  double seconds = 0.0;
};

/// From gate runs, to which more are added until the error bar says enough.
Subject from_runs(const Options& options, lattice::Scene scene, lattice::RunPool pool,
                  const lattice::AccuracyOptions& how,
                  const std::optional<lattice::Settled>& settled) {
  const lattice::Problem problem = lattice::problem_of(scene);
  auto prediction = lattice::predict_pooled(problem, pool, {problem.start}, how, options.work());
  warn_of(options, prediction, how.accuracy);
  auto chain = lattice::analysed_chain(problem, pool, pool.starts[pool.place_of(problem.start)],
                                       how.per_leaf);
  return {.scene = std::move(scene),
          .chain = std::move(chain),
          .pool = std::move(pool),
          .endings = prediction.starts.front().endings,
          .status = to_json(prediction.health),
          .settled = settled ? to_json(*settled) : Json(),
          .clean = status_of(options, prediction.health) == kFine,
          .from_trials = prediction.starts.front().from_trials,
          .reached = prediction.reached,
          .gate_runs = prediction.gate_runs,
          .per_leaf = how.per_leaf,
          .most_runs = how.most_runs - prediction.gate_runs,
          .states = prediction.states,
          .seconds = prediction.seconds};
}

/// From a matrix of bins.
Subject from_bins(const Options& options, const lattice::SceneMatrix& m,
                  const std::vector<lattice::PaperStart>& given) {
  const std::string path = options.text("matrix");
  for (const char* other : {"accuracy", "gate-runs"})
    if (options.has(other))
      throw UsageError(std::string("--") + other + ": " + path +
                       " has bins and keeps no gate runs that could be added to");
  const auto start = ready_start(options, m, lattice::own_start(m.scene).entry(),
                                 given.empty() ? "the start" : title_of(given.front()));
  const auto prediction = lattice::predict(lattice::field_of(m, path, {}), m.scene.field, {start},
                                           {}, options.seed(), options.work());
  const Json status = recorded_status(m.file);
  return {.scene = m.scene,
          .chain = lattice::analysed_chain(lattice::problem_of(m.scene),
                                           lattice::matrices_of(m.file, m.scene), start.start),
          .endings = prediction.starts.front().shares,
          .status = status,
          .settled = recorded(m.file, path, "method"),
          .clean = faults_recorded(status).empty(),
          .states = m.file.transitions.space.size(),
          .seconds = prediction.seconds};
}

Subject subject_of(const Options& options, const std::vector<lattice::PaperStart>& given) {
  const std::string path = options.text("matrix");
  lattice::AccuracyOptions how = accuracy_of(options);
  const auto with_start = [&](lattice::Scene& scene) {
    lattice::require_inside(given, scene);
    if (!given.empty()) {
      (void)given.front().entry();  // refuses a start inside the gate
      scene.start = given.front().body();
    }
  };
  if (!is_matrix(path)) {
    if (options.has("scene"))
      throw UsageError(path + ": is no matrix, so it is read as a scene; a second one, \"" +
                       options.text("scene") + "\", has no meaning beside it");
    lattice::Scene scene = lattice::read_scene(path, options.overrides());
    with_start(scene);
    require_active(options, scene);
    const auto settled = settle_method(options, scene, lattice::RunsFrom::everywhere);
    return from_runs(options, std::move(scene), {}, how, settled);
  }
  lattice::SceneMatrix m = read_matrix(options);
  require_active(options, m.scene);
  with_start(m.scene);
  if (!lattice::has_runs(m.file)) return from_bins(options, m, given);
  if (!options.has("accuracy")) how.accuracy = accuracy_of(m.file, path);
  how.per_leaf = entries_per_leaf(m.file, path);
  lattice::RunPool pool = lattice::pool_of(m.file, lattice::problem_of(m.scene), path);
  return from_runs(options, std::move(m.scene), std::move(pool), how, {});
}

}  // namespace

int run_analyze(const Arguments& arguments) {
  Options options(
      "analyze SCENE|MATRIX.nc [SCENE] [options]",
      "What the chain of a field says beside its final gates: how long bodies take to cross, what "
      "work that is,\n"
      "how often they visit each gate, which ways lead across, how likely other starts are to get "
      "there, what\n"
      "becomes of those who go on for ever, and which numbers of the scene change that most. From "
      "a scene, or from\n"
      "the gate runs that a matrix of trees keeps; runs are added until the error bar keeps "
      "--accuracy. From a matrix\n"
      "of bins as it is, without error bars on times and works.",
      "gatewalk analyze scenes/field.toml --target left_side --json analysis.json");
  options.positional(
      "matrix", "a scene (-: standard input), or a matrix file written by gatewalk build", true);
  options.positional("scene", "of a matrix: another scene; without it the matrix's own", false);
  add_accuracy(options, "0.02; that of a matrix");
  options.add_texts("start", "D,VX,VY", "where a body starts (default: the scene's start)");
  options.add_text("target", "ENDING",
                   "what starts, paths and influences are of: crossed, left_side, right_side, "
                   "trapped or cut_off",
                   "crossed");
  options.add_count(
      "runs", "N",
      "gate runs with a little more, and as many with a little less of each number "
      "of the scene,\nand as many again for the intervals, on top of --gate-runs; 0: none",
      "20000");
  options.add_number("step", "PART", "how much more and less, as a part of it (default: 0.02)");
  options.add_text(
      "lump", "D,VX,VY",
      "into how many parts the states of each boundary are cut by d, vx and vy, to see "
      "what so few\nstates would cost",
      "1,1,1");
  options.add_count("paths", "N", "the most frequent ways through the field", "5");
  options.add_count("trials", "N", "also run N trials of the full dynamics, to compare");
  options.add_seed();
  options.add_strict();
  options.add_figure("visits and paths, durations, starts and influences");
  if (!options.parse(arguments)) return kFine;
  const lattice::AnalysisOptions how{
      .target = target_of(options),
      .paths = static_cast<std::size_t>(options.count("paths", 0, 1000)),
      .lumping = lumping_of(options),
      .seed = options.seed()};
  const lattice::ParameterOptions parameters{
      .runs = options.count("runs", 0, 1'000'000),
      .relative_step = options.has("step") ? options.number("step") : 0.02,
      .seed = options.seed()};
  if (parameters.runs > 0 && parameters.runs < 100)
    throw UsageError("--runs: must be 0, or 100 or more");
  if (!(parameters.relative_step > 0.0 && parameters.relative_step < 0.5))
    throw UsageError("--step: must lie between 0 and 0.5");
  const std::vector<lattice::PaperStart> given = given_starts(options);
  if (given.size() > 1) throw UsageError("--start: an analysis is of one start");
  Subject s = subject_of(options, given);
  const dynamics::Work work = options.work();
  const lattice::Problem problem = lattice::problem_of(s.scene);
  const auto analysis = lattice::analyze(problem, *s.chain, how, work);
  if (s.pool) s.chain.reset();  // that for parameters is larger
  lattice::ParameterEffects effects;
  if (parameters.runs > 0 && analysis.is_certain())
    effects.chance = analysis.target_chance;
  else if (parameters.runs > 0 && s.pool)
    effects = lattice::parameter_effects(problem, *s.pool, how.target, parameters, s.per_leaf,
                                         s.most_runs, work);
  else if (parameters.runs > 0)
    effects = lattice::parameter_effects(problem, *s.chain, how.target, parameters, work);
  std::optional<DirectTrials> direct;
  if (options.has("trials")) {
    lattice::FieldCosts costs(lattice::bin_of_durations(s.scene.gate));
    auto tally = lattice::field_trials(s.scene, options.trials(), options.seed(), work, &costs);
    direct = DirectTrials{std::move(tally), std::move(costs)};
  }

  const AnalysedField shown{s.scene,
                            s.endings,
                            analysis,
                            effects,
                            direct,
                            s.from_trials,
                            s.reached,
                            s.gate_runs,
                            s.states,
                            s.seconds,
                            parameters.relative_step};
  Json json = to_json(shown);
  json["status"] = s.status;
  json["sensitivities"]["status"] = to_json(effects.health);
  if (!s.settled.is_null()) json["method"] = s.settled;
  json["made_by"] = to_json(options.provenance(s.scene));
  options.give_out(json, table_of(shown));
  const bool clean_effects =
      status_of(options, effects.health, "in gates with changed numbers ") == kFine;
  const bool clean =
      clean_effects && (!direct || status_of(options, direct->tally.health) == kFine);
  options.draw([&] { return figure_of(shown); });
  return exit_status(options, s.clean && clean);
}

}  // namespace gatewalk::cli
