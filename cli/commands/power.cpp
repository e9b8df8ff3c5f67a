#include "cli/render/power.h"
#include "cli/arguments.h"
#include "cli/render/choice.h"
#include "cli/render/health.h"
#include "cli/render/json.h"
#include "cli/render/scene.h"
#include "cli/render/text.h"
#include "lattice/scene/map_file.h"

namespace gatewalk::cli {
namespace {

void require_chain(const Options& options, const lattice::Scene& scene) {
  (void)lattice::entries_at({lattice::own_start(scene)});
  require_active(options, scene);
}

double number_within(const Options& options, const char* name, double usual, double low,
                     double high) {
  if (!options.has(name)) return usual;
  const double value = options.number(name);
  if (!(value >= low && value <= high))
    throw UsageError(std::string("--") + name + " " + digits(value) + ": must lie in [" +
                     digits(low) + ", " + digits(high) + "]");
  return value;
}

/// The scene with --versus on top of --set.
lattice::Scene read_other(const Options& options) {
  std::vector<std::string> overrides = options.overrides();
  const std::vector<std::string> versus = options.texts("versus");
  overrides.insert(overrides.end(), versus.begin(), versus.end());
  try {
    return lattice::read_scene(options.text("scene"), overrides);
  } catch (const lattice::SceneError& e) {  // it names overrides as --set gives them
    const std::string what = e.what();
    for (const std::string& key : versus)
      if (what.starts_with("--set " + key))
        throw UsageError("--versus" + what.substr(what.find(' ')));
    throw;
  }
}

/// None without --versus.
std::optional<lattice::Scene> other_scene(const Options& options, const lattice::Scene& scene) {
  if (!options.has("versus")) return {};
  lattice::Scene other = read_other(options);
  require_chain(options, other);
  if (other.field.columns != scene.field.columns || other.field.rows != scene.field.rows)
    throw UsageError(
        "--versus: field.columns and field.rows must stay: final gates of fields of different "
        "sizes cannot be compared");
  return other;
}

struct Predicted {
  std::optional<lattice::Settled> settled;
  lattice::PooledPrediction prediction;
};

/// As gatewalk predict does. What is to be said of a scene's keys is said of the `first` one.
Predicted predicted(const Options& options, lattice::Scene& scene, bool first) {
  const lattice::AccuracyOptions how = accuracy_of(options);
  constexpr auto kFrom = lattice::RunsFrom::everywhere;
  Predicted p{first ? settle_method(options, scene, kFrom)
                    : lattice::settle_method(scene, kFrom, options.seed(), options.work()),
              {}};
  const lattice::Problem problem = lattice::problem_of(scene);
  lattice::RunPool pool;
  p.prediction = lattice::predict_pooled(problem, pool, {problem.start}, how, options.work());
  warn_of(options, p.prediction, how.accuracy);
  return p;
}

}  // namespace

int run_power(const Arguments& arguments) {
  Options options(
      "power SCENE [options]",
      "How many trials an experiment needs: to see that an ending is more or less often than the "
      "scene\n"
      "predicts (exact binomial test), or that the final gates differ by a total variation\n"
      "(simulated, by the test of gatewalk validate --observed); with --versus, to tell the scene\n"
      "from another one, with so many trials of each. With --trials also what so many show.",
      "gatewalk power scenes/robot.toml --trials 60 --versus "
      "beams.stiffness_left_Nm_per_rad=0.3");
  options.scene();
  options.add_texts("versus", "KEY=VALUE",
                    "the scene to tell this one from has this key otherwise (may be repeated)");
  options.reads("versus", [](const std::string& given) { return lattice::map_file_in(given, ""); });
  options.add_count("trials", "N",
                    "also: what N trials show (with --versus, N of each scene), at most 100000");
  options.add_number("power", "P", "how often a difference is to be found (default: 0.8)");
  options.add_number("level", "A",
                     "how often one may be found where there is none (default: 0.05)");
  add_accuracy(options);
  options.add_seed();
  options.add_strict();
  if (!options.parse(arguments)) return kFine;
  lattice::ExperimentOptions how{
      .goal = {.power = number_within(options, "power", 0.8, 0.5, 0.99),
               .level = number_within(options, "level", 0.05, 0.01, 0.25)},
      .trials = {},
      .seed = options.seed()};
  if (options.has("trials")) how.trials = options.count("trials", 1, lattice::kMostPlanned);
  lattice::Scene scene = options.read_scene();
  require_chain(options, scene);
  auto other = other_scene(options, scene);
  (void)accuracy_of(options);

  const Predicted first = predicted(options, scene, true);
  const auto second = other ? std::optional(predicted(options, *other, false)) : std::nullopt;
  const lattice::StartAnswer& answer = first.prediction.starts.front();
  const dynamics::Work work = options.work();
  work.tell("power of experiments", 0, 1);
  const lattice::ExperimentPlan plan = lattice::plan_experiment(answer, how);
  PlannedExperiment planned{how, answer, plan};
  dynamics::Health health = first.prediction.health;
  if (second) {
    planned.versus = options.texts("versus");
    planned.other_scene = other;
    planned.other = second->prediction.starts.front();
    planned.apart = lattice::tell_apart(answer, *planned.other, how);
    health += second->prediction.health;
  }
  work.tell("power of experiments", 1, 1);

  Json json = to_json(planned);
  json["status"] = to_json(health);
  if (first.settled) json["method"] = to_json(*first.settled);
  json["made_by"] = to_json(options.provenance(scene));
  options.give_out(json, table_of(planned) + method_line(first.settled));
  options.warn(too_few_gates(scene));
  return status_of(options, health);
}

}  // namespace gatewalk::cli
