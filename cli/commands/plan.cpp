// SPDX-License-Identifier: MIT
#include "cli/render/plan.h"
#include "cli/arguments.h"
#include "cli/render/choice.h"
#include "cli/render/health.h"
#include "cli/render/json.h"
#include "cli/render/text.h"
#include "cli/subject.h"
#include "dynamics/base/work.h"
#include "lattice/scene/scene_problem.h"
#include "lattice/scene/terrain.h"

namespace gatewalk::cli {
namespace {

/// Those of table [actions], each with a method of its own where the scene leaves it to a pilot.
struct Actions {
  std::vector<std::string> names;
  std::vector<std::optional<lattice::Settled>> methods;
  std::vector<lattice::Action> of;
};
Actions actions_of(const Options& options, const Subject& s) {
  Actions actions;
  for (const lattice::Terrain::Type& action : s.scene->actions) {
    lattice::Scene taken = lattice::with_action(*s.scene, action);
    actions.names.push_back(action.name);
    const auto from = lattice::RunsFrom::everywhere;
    actions.methods.push_back(
        actions.of.empty() ? settle_method(options, taken, from)  // says what keys do, once
                           : lattice::settle_method(taken, from, options.seed(), options.work()));
    if (const auto& method = actions.methods.back(); method && !actions.of.empty())
      options.warn(complaint(*method));
    actions.of.push_back({action.name, lattice::problem_with_all_types(taken)});
    actions.of.back().problem.start = s.problem.start;
  }
  return actions;
}

}  // namespace

int run_plan(const Arguments& arguments) {
  Options options(
      "plan SCENE [options]",
      "What a body should do in each gate, by how it enters, to cross the field as often as it "
      "can.\n"
      "Its actions are tables of the scene, such as\n"
      "  [actions.push]\n"
      "  forces.propulsion_N = 9\n"
      "each with keys of forces and beams as they are while a body takes it; an empty table is the "
      "scene\n"
      "as it is. The best policy of chains of all actions is run in full, its trials are added, "
      "and so on;\n"
      "new trials say how often it crosses, beside each action all the time.",
      "gatewalk plan scenes/field.toml --set actions.slow.forces.propulsion_N=6 --set "
      "actions.fast.forces.propulsion_N=9");
  options.scene();
  add_starts(options, "the scene's start");
  options.add_number("accuracy", "A",
                     "half of the interval that a chance to cross may have (default: 0.02)");
  options.add_count("gate-runs", "N", "choose by at most so many gate runs, about (default: 2e7)");
  options.add_seed();
  options.add_kept();
  options.add_strict();
  options.add_figure("the actions by gate, and how often bodies cross");
  if (!options.parse(arguments)) return kFine;
  lattice::PlanOptions how{.seed = options.seed()};
  if (options.has("accuracy")) how.accuracy = options.number("accuracy");
  if (!(how.accuracy >= 0.001 && how.accuracy < 0.5))
    throw UsageError("--accuracy: must lie in [0.001, 0.5)");
  if (options.has("gate-runs")) how.most_runs = options.count("gate-runs", 1000);
  Subject s = open_subject(options, "scene");
  if (!s.scene || s.file)
    throw UsageError(s.path + ": is no scene of gates, and new bodies are to be run: give a scene");
  if (s.starts.size() > 1) throw UsageError("--start: a plan is made for one start");
  if (s.scene->actions.size() < 2)
    throw UsageError(s.path + ": has " + std::to_string(s.scene->actions.size()) +
                     " tables [actions.NAME]: a plan needs two at least; an empty one is the scene "
                     "as it is");
  Actions actions = actions_of(options, s);
  const dynamics::Stopwatch watch;
  lattice::Plan plan = lattice::make_plan(actions.of, how, options.work());
  const PlannedField planned{s.shown(), std::move(actions.names), std::move(actions.methods),
                             std::move(plan), watch.seconds()};

  Json json = to_json(planned);
  json["made_by"] = s.made_by(options);
  options.give_out(json, table_of(planned));
  if (planned.plan.crossings.crossed == 0)
    options.warn("none of " + std::to_string(planned.plan.crossings.trials) +
                 " trials crossed: too rare for a plan; a smaller field.rows asks for less, "
                 "gatewalk rare says how rare it is");
  else if (!planned.plan.settled)
    options.warn("rounds still gained something after " + std::to_string(how.most_runs) +
                 " gate runs; --gate-runs allows more");
  options.warn(too_few_gates(s.shown()));
  const int exit = status_of(options, planned.plan.health);
  options.draw([&] { return figure_of(planned); });
  return exit;
}

}  // namespace gatewalk::cli
