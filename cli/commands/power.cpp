// SPDX-License-Identifier: MIT
#include "cli/render/power.h"
#include "cli/arguments.h"
#include "cli/render/final_gates.h"
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

}  // namespace

int run_power(const Arguments& arguments) {
  Options options(
      "power SCENE|MATRIX.nc [options]",
      "How many trials an experiment needs: to see that an ending is more or less often than the "
      "scene\n"
      "predicts (exact binomial test), or that the final gates differ by a total variation\n"
      "(simulated, by the test of gatewalk validate --observed); with --versus, to tell the scene\n"
      "from another one, or two groups of animals from each other, with so many trials of each. "
      "With --trials also\n"
      "what so many show.",
      "gatewalk power scenes/robot.toml --trials 60 --versus "
      "beams.stiffness_left_Nm_per_rad=0.3");
  const TextOption path = options.scene();
  const TextsOption other_given = options.add_varied(
      "versus", "KEY=VALUE",
      "the scene to tell this one from has this key otherwise (may be repeated); or "
      "a matrix of another group's recorded runs");
  options.reads(other_given, [&options](const std::string& given) {
    return options.file(given).is_matrix() ? given : lattice::TomlFile(given, "").map_file();
  });
  const CountOption trials = options.add_count(
      "trials", "N", "also: what N trials show (with --versus, N of each scene), at most 100000");
  const NumberOption power =
      options.add_number("power", "P", "how often a difference is to be found (default: 0.8)");
  const NumberOption level = options.add_number(
      "level", "A", "how often one may be found where there is none (default: 0.05)");
  const AskedAccuracy accuracy = add_accuracy(options);
  options.add_seed();
  options.add_strict();
  const AskedProgram program = add_cell_program(options);
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
  // What is to be said of a scene's keys has been said.
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
                     .made_by = options.provenance(s)};
  if (second) {
    const lattice::StartAnswer& versus = second->starts.front();
    result.versus = {other_given.values(), versus, lattice::tell_apart(answer, versus, how),
                     other->scene};
    result.health += second->health;
  }
  work.tell("power of experiments", 1, 1);
  options.give_out(result, table_of(result));
  options.warn(too_few_gates(ShownField(s)));
  options.warn(rest_warning(rest_of(answer.final)));
  if (result.versus)
    options.warn(rest_warning(rest_of(result.versus->prediction.final), "with --versus "));
  return status_of(options, result.health);
}

}  // namespace gatewalk::cli
