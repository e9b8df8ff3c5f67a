// SPDX-License-Identifier: MIT
#include "cli/render/plan.h"
#include "cli/arguments.h"
#include "cli/exchange/policy_file.h"
#include "cli/render/health.h"
#include "cli/render/json.h"
#include "cli/render/scene.h"
#include "cli/render/text.h"
#include "cli/subject.h"
#include "dynamics/base/work.h"

namespace gatewalk::cli {
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
  options.add_texts(
      "start", "D,VX,VY",
      "start at x = D m, y = 0 with this velocity in m/s (default: the scene's start)");
  options.add_number("accuracy", "A",
                     "half of the interval that a chance to cross may have (default: 0.02)");
  options.add_count(
      "gate-runs", "N",
      "no new round of choosing after so many gate runs (default: 2e7); one there always is");
  options.add_seed();
  options.add_kept();
  options.add_strict();
  options.output_file("policy", "FILE.json",
                      "write what to do in each gate, for gatewalk lattice --policy");
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
  if (options.has("policy")) require_file_for(*s.scene);
  std::vector<std::optional<lattice::Settled>> methods;
  const std::vector<lattice::Action> actions =
      actions_of(options, *s.scene, s.problem.start, methods);
  std::vector<std::string> names;
  for (const lattice::Action& action : actions) names.push_back(action.name);
  const dynamics::Stopwatch watch;
  lattice::Plan plan = lattice::make_plan(actions, how, options.work());
  const PlannedField planned{s.shown(), std::move(names), std::move(methods), std::move(plan),
                             watch.seconds()};
  Json json = to_json(planned);
  json["made_by"] = s.made_by(options);
  options.give_out(json, table_of(planned));
  if (options.has("policy"))
    options.write(options.text("policy"), policy_text(planned.plan.policy, *s.scene));
  options.warn(few_crossings(planned.plan.crossings));
  if (!planned.plan.settled)
    options.warn("choosing was not finished after " + std::to_string(planned.plan.gate_runs) +
                 " gate runs; --gate-runs allows more");
  options.warn(too_few_gates(s.shown()));
  const int exit = status_of(options, planned.plan.health);
  options.draw([&] { return figure_of(planned); });
  return exit;
}

}  // namespace gatewalk::cli
