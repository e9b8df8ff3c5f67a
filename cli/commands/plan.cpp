// SPDX-License-Identifier: MIT
#include "cli/render/plan.h"

#include <fmt/core.h>

#include "cli/actions.h"
#include "cli/arguments.h"
#include "cli/choosing.h"
#include "cli/exchange/policy_file.h"
#include "cli/planned.h"
#include "cli/render/health.h"
#include "cli/render/scene.h"
#include "cli/render/text.h"
#include "dynamics/base/work.h"

namespace gatewalk::cli {

int run_plan(const Arguments& arguments) {
  Options options(
      "plan SCENE [options]",
      "What a body should do in each gate, by how it enters, to cross as often as it can.\n"
      "Its actions are tables of the scene, such as\n"
      "  [actions.push]\n"
      "  forces.propulsion_N = 9\n"
      "each with keys of forces and beams as they are while a body takes it, or parameters.KEY\n"
      "of a cell program; an empty table is the scene as it is. They are numbered in the order of\n"
      "their names. The best policy of chains of all actions is run in full, its trials are\n"
      "added, and so on; new trials say how often it crosses, beside each action all the time.\n"
      "Without actions: the start from which bodies cross most often, in a terrain in any column.",
      "gatewalk plan scenes/field.toml --set actions.slow.forces.propulsion_N=6 --set "
      "actions.fast.forces.propulsion_N=9");
  options.scene();
  add_choosing(options, "; of a cell program FACE:c1,c2,...");
  add_cell_program(options);
  options.add_texts(
      "over", "KEY=LOW:HIGH",
      "without actions: where bodies may start (start.x_m, start.vx_m_per_s, "
      "start.vy_m_per_s;\ndefault: a radius from the joints, up to the speed of an open "
      "gate; may be repeated)");
  options.output_file("policy", "FILE.json",
                      "write what to do in each gate, for --policy of gatewalk lattice and trace");
  options.output_file("gate-policy", "FILE.json",
                      "the same of the best that knows the gate alone, not the way in");
  options.add_text("least", "COST",
                   "also policies that cross less often and take less of this (time_s, work_J, "
                   "...), to that which takes least for each crossing");
  options.add_count("points", "N", "such policies, at most (default: 5)");
  options.add_number("chance", "P",
                     "--policy writes the one that takes least of those that cross so often");
  options.add_flag("robust",
                   "policies that are best where the chain is as bad as its runs leave possible");
  options.add_figure("the actions by gate, and how often bodies cross");
  if (!options.parse(arguments)) return kFine;
  lattice::PlanOptions how;
  take_choosing(options, how);
  Subject s = field_to_run(options, "a plan is made");
  if (!has_actions(s)) return plan_start(options, std::move(s));
  if (options.has("over"))
    throw UsageError(fmt::format("--over: is for a scene without actions; {} has some", s.path));
  how.thrift = thrift_of(options, s.shown());
  how.robust = options.has("robust");
  if (how.robust && how.thrift) throw UsageError("--robust: not with --least");
  if (options.has("policy") || options.has("gate-policy")) require_file_for(s);
  Actions all = actions_of(options, s);
  const dynamics::Stopwatch watch;
  lattice::Plan plan = lattice::make_plan(all.actions, how, options.work());
  const PlannedField planned{s.shown(),       all.names(), std::move(all.methods), std::move(plan),
                             watch.seconds(), how.thrift,  s.provenance(options)};
  options.give_out(planned, table_of(planned));
  if (options.has("policy"))
    options.write(options.text("policy"), policy_text(chosen_policy(planned), all.made_for));
  if (options.has("gate-policy")) {
    if (!planned.plan.by_cell)
      throw std::runtime_error("--gate-policy: there is none: no body crossed");
    options.write(options.text("gate-policy"),
                  policy_text(planned.plan.by_cell->policy, all.made_for));
  }
  options.warn(few_crossings(planned.plan.crossings));
  if (options.has("policy") && !cheapest(planned) && !gains(planned))
    options.warn(fmt::format(
        "--policy: {} is not shown to gain anything over {} all the time, which is simpler",
        options.text("policy"), planned.actions[best_alone(planned.plan)]));
  if (how.thrift && how.thrift->chance > 0.0 && !cheapest(planned))
    options.warn("--chance: none of these policies crosses so often; --policy is the plan's own");
  if (!planned.plan.front_refused.empty())
    options.warn("--least: " + planned.plan.front_refused);
  else if (how.thrift && !planned.plan.front_finished)
    options.warn("--least: the search was not finished; --gate-runs and --points allow more");
  warn_of_choosing(options, planned.plan.settled, planned.plan.gate_runs);
  options.warn(too_few_gates(s.shown()));
  const int exit = status_of(options, planned.plan.health);
  options.draw([&] { return figure_of(planned); });
  return exit;
}

}  // namespace gatewalk::cli
