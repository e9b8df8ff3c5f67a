#include "cli/arguments.h"
#include "cli/render/analysis.h"
#include "cli/render/choice.h"
#include "cli/render/final_gates.h"
#include "cli/render/json.h"
#include "cli/render/matrix.h"
#include "cli/render/prediction.h"
#include "cli/render/scene.h"
#include "lattice/study/trials.h"

namespace gatewalk::cli {
namespace {

/// By the names of JSON. Throws UsageError for any other.
markov::Ending target_of(const Options& options) {
  const std::string name = options.text("target");
  std::string names;
  for (const EndingName& e : kEndingNames) {
    if (name == e.key) return e.ending;
    names += (names.empty() ? "" : ", ") + std::string(e.key);
  }
  throw UsageError("--target " + name + ": must be one of " + names);
}

/// What is analysed: gate runs of a scene, and how they are added to.
struct Subject {
  lattice::Scene scene;
  lattice::RunPool pool;
  lattice::AccuracyOptions how;
  std::optional<lattice::Settled> settled;
};

Subject subject_of(const Options& options) {
  const std::string path = options.text("matrix");
  lattice::AccuracyOptions how = accuracy_of(options);
  if (!is_matrix(path)) {
    if (options.has("scene"))
      throw UsageError(path +
                       ": is no matrix, so it is read as a scene; a second one has no "
                       "meaning beside it");
    lattice::Scene scene = lattice::read_scene(path, options.overrides());
    if (scene.field.fidelity != lattice::Fidelity::active)
      throw UsageError(path + ": field.fidelity = \"" +
                       std::string(lattice::name_of(scene.field.fidelity)) +
                       "\" is not permitted for a chain: it has \"active\"");
    auto settled = settle_method(options, scene, lattice::RunsFrom::everywhere);
    return {std::move(scene), {}, how, std::move(settled)};
  }
  lattice::SceneMatrix m = read_matrix(options);
  if (!lattice::has_runs(m.file))
    throw UsageError(path +
                     ": has bins and keeps no gate runs; an analysis needs those of a matrix of "
                     "trees (gatewalk build without --bins)");
  if (!options.has("accuracy")) how.accuracy = accuracy_of(m.file, path);
  how.per_leaf = entries_per_leaf(m.file, path);
  lattice::RunPool pool = lattice::pool_of(m.file, m.scene, path);
  return {std::move(m.scene), std::move(pool), how, {}};
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
      "--accuracy.",
      "gatewalk analyze scenes/field.toml --target left_side --json analysis.json");
  options.positional("matrix", "a scene, or a matrix file written by gatewalk build", true);
  options.positional("scene", "of a matrix: another scene; without it the matrix's own", false);
  add_accuracy(options, "0.02; that of a matrix");
  add_starts(options, "the scene's start; one at most");
  options.add_text("target", "ENDING",
                   "what starts, paths and influences are of: crossed, left_side, right_side, "
                   "trapped or cut_off",
                   "crossed");
  options.add_count("runs", "N",
                    "gate runs with a little more, and as many with a little less of each number "
                    "of the scene; 0: none",
                    "20000");
  options.add_number("step", "PART", "how much more and less, as a part of it (default: 0.05)");
  options.add_count("paths", "N", "the most frequent ways through the field", "5");
  options.add_count("trials", "N", "also run N trials of the full dynamics, to compare");
  options.add_seed();
  options.add_strict();
  options.add_figure("visits and paths, durations, starts and influences");
  if (!options.parse(arguments)) return kFine;
  lattice::AnalysisOptions how{.target = target_of(options),
                               .paths = static_cast<std::size_t>(options.count("paths", 0, 1000)),
                               .runs = options.count("runs", 0, 10'000'000),
                               .relative_step = options.has("step") ? options.number("step") : 0.05,
                               .seed = options.seed()};
  if (!(how.relative_step > 0.0 && how.relative_step < 0.5))
    throw UsageError("--step: must lie between 0 and 0.5");
  const std::vector<lattice::PaperStart> given = given_starts(options);
  if (given.size() > 1) throw UsageError("--start: an analysis is of one start");
  Subject s = subject_of(options);
  lattice::require_inside(given, s.scene);
  if (!given.empty()) s.scene.start = lattice::entries_at(given).front();

  const dynamics::Work work = options.work();
  const auto prediction = lattice::predict_pooled(s.scene, s.pool, {s.scene.start}, s.how, work);
  how.per_leaf = s.how.per_leaf;
  const auto analysis =
      lattice::analyze(s.scene, s.pool, lattice::entry_of(s.scene.start), how, work);
  std::optional<DirectTrials> direct;
  if (options.has("trials")) {
    lattice::FieldCosts costs(s.scene.gate);
    auto tally = lattice::field_trials(s.scene, options.trials(), options.seed(), work, &costs);
    direct = DirectTrials{std::move(tally), std::move(costs)};
  }

  const AnalysedField shown{s.scene, prediction, analysis, direct};
  Json json = to_json(shown);
  if (s.settled) json["method"] = to_json(*s.settled);
  json["made_by"] = to_json(options.provenance(s.scene));
  options.give_out(json, table_of(shown) + method_line(s.settled));
  warn_of(options, prediction, s.how.accuracy);
  dynamics::Health health = prediction.health;
  if (direct) health += direct->tally.health;
  const int exit = status_of(options, health);
  options.draw([&] { return figure_of(shown); });
  return exit;
}

}  // namespace gatewalk::cli
