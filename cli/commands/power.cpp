// SPDX-License-Identifier: MIT
#include "cli/render/power.h"
#include "cli/arguments.h"
#include "cli/next.h"
#include "cli/render/final_gates.h"
#include "cli/render/health.h"
#include "cli/render/pooled_prediction.h"
#include "cli/render/scene.h"
#include "cli/source_options.h"

namespace gatewalk::cli {
namespace {

void require_error_bars(const lattice::Source& s) {
  if (s.is_imported)
    throw UsageError(s.path +
                     ": is a chain that was made elsewhere: its error bars are of its "
                     "counts, not of trials, which plans of experiments are made with");
  if (!s.pool || (s.is_recorded() && s.pool->bodies() < lattice::kLeastBodies))
    throw UsageError(s.path + ": has no error bars, which plans are made with: power needs a " +
                     "chain of trees" + (s.pool ? ", of 16 bodies or more" : ""));
}

std::vector<std::string> next_of(const Options& options, const lattice::Source& s) {
  NextCommands next(options);
  if (!options.trials)
    next.again("trials", "100", "says what 100 trials detect");
  else if (s.is_recorded())
    next.add("validate", "", "tests whether half of the bodies predict the others");
  else if (!s.file) {
    const std::string trials = "--trials " + std::to_string(options.trials.value());
    std::string other;
    for (const std::string& set : TextsOption(options, "versus").values())
      other += "--set " + shell_quoted(set) + " ";
    next.add("lattice", trials,
             other.empty() ? "simulates one such experiment" : "simulates one group");
    if (!other.empty()) next.add("lattice", other + trials, "simulates the other group");
  }
  return next.lines();
}

}  // namespace

int run_power(const Arguments& arguments) {
  Options options(
      "power SCENE|MATRIX.nc [options]",
      "Says how many trials an experiment needs, or what N trials can show (--trials N).\n"
      "power predicts the endings and counts the trials that detect a shift of an ending (exact "
      "binomial\n"
      "test), or a total variation of the final gates (simulated experiments, with the test of "
      "gatewalk\n"
      "validate --observed). --versus compares two scenes, or two groups of animals, with equally "
      "many\n"
      "trials of each.",
      "gatewalk power scenes/robot.toml --trials 60 --versus "
      "beams.stiffness_left_Nm_per_rad=0.3");
  const TextOption path = options.scene();
  const TextsOption other_given =
      options.add_varied("versus", "KEY=VALUE",
                         "the other scene has this value of this key (may be repeated); or a "
                         "matrix of another group's "
                         "recorded runs");
  options.reads(other_given, [&options](const std::string& given) {
    return options.file(given).is_matrix() ? given : lattice::TomlFile(given, "").map_file();
  });
  const CountOption trials = options.add_count(
      "trials", "N", "say what N trials detect (with --versus, N of each scene), at most 100000");
  const NumberOption power = options.add_number(
      "power", "P", "share of experiments that are to detect a difference (default: 0.8)");
  const NumberOption level = options.add_number(
      "level", "A",
      "share of experiments that may report a difference where there is none (default: 0.05)");
  const AskedAccuracy accuracy = add_accuracy(options);
  options.add_seed();
  options.add_strict();
  const AskedProgram program = add_cell_program(options);
  options.add_details("tables for two groups, for single tests and for the power of each test");
  options.most_used({"trials", "versus", "power", "accuracy", "json"});
  if (!options.parse(arguments)) return kFine;
  lattice::ExperimentOptions how{
      .goal = {.power = power.within(0.8, 0.5, 0.99), .level = level.within(0.05, 0.01, 0.25)},
      .trials = {},
      .seed = options.seed()};
  if (trials) how.trials = trials.value(1, lattice::kMostPlanned);
  const Asked asked{.path = path, .program = program, .accuracy = accuracy};
  lattice::Source s = open_source(options, asked);
  require_error_bars(s);
  auto other = versus(options, asked, other_given, s);
  if (other) require_error_bars(*other);
  choose_method(options, s);
  // The warnings about the scene's keys have been given already.
  if (other) other->choose_method(options.seed(), options.work());
  const auto first = predict(options, s);
  const auto second = other ? std::optional(predict(options, *other)) : std::nullopt;
  const dynamics::Work work = options.work();
  work.tell("power of experiments", 0, 1);
  const lattice::StartAnswer& answer = first.starts.front();
  PowerResult result{.options = how,
                     .prediction = answer,
                     .plan = lattice::plan_experiment(answer, how),
                     .health = first.health,
                     .method = lattice::settled_of(s),
                     .made_by = options.provenance(s),
                     .recorded = s.is_recorded()};
  if (second) {
    const lattice::StartAnswer& versus = second->starts.front();
    result.versus = {other_given.values(), versus, lattice::tell_apart(answer, versus, how),
                     other->scene};
    result.health += second->health;
  }
  work.tell("power of experiments", 1, 1);
  options.give_out(result,
                   {answer_text(result) + beware_of(first, s.accuracy.accuracy, s.is_recorded()) +
                        beware_of(result.health),
                    details_text(result), next_of(options, s)});
  options.warn(too_few_gates(ShownField(s)));
  options.warn(rest_warning(rest_of(answer.final)));
  if (result.versus)
    options.warn(rest_warning(rest_of(result.versus->prediction.final), "with --versus "));
  return status_of(options, result.health);
}

}  // namespace gatewalk::cli
