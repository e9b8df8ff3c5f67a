// SPDX-License-Identifier: MIT
#include "cli/render/plan.h"

#include <fmt/core.h>

#include <array>
#include <cmath>
#include <string_view>

#include "cli/actions.h"
#include "cli/arguments.h"
#include "cli/choice_rounds.h"
#include "cli/exchange/policy_file.h"
#include "cli/fields/text.h"
#include "cli/next.h"
#include "cli/render/best_start.h"
#include "cli/render/choice.h"
#include "cli/render/crossings.h"
#include "cli/render/health.h"
#include "cli/render/scene.h"
#include "cli/source_options.h"
#include "dynamics/base/work.h"
#include "dynamics/disc/disc_section.h"
#include "dynamics/disc/study/meaning.h"
#include "lattice/scene/cell_file.h"
#include "lattice/scene/ranges.h"
#include "lattice/scene/terrain.h"
#include "lattice/study/plan.h"
#include "lattice/text/digits.h"
#include "lattice/text/toml_text.h"

namespace gatewalk::cli {
namespace {

struct PlanCommand : Options {
  using Options::Options;
  TextOption path = scene();
  ChoiceRounds rounds = add_choice_rounds(*this, "; of a cell program FACE:c1,c2,...");
  AskedProgram program = add_cell_program(*this);
  TextsOption over =
      add_varied("over", "KEY=LOW:HIGH",
                 "without actions: range of the start to search (start.x_m, start.vx_m_per_s, "
                 "start.vy_m_per_s;\ndefault: x up to a body radius from the joints, speed up to "
                 "that of an open gate; may be repeated)");
  TextOption policy =
      output_file("policy", "FILE.json",
                  "write the policy, for --policy of gatewalk lattice and gatewalk trace");
  TextOption gate_policy =
      output_file("gate-policy", "FILE.json",
                  "write the best policy that knows the gate alone, not how the body enters");
  TextOption least =
      add_text("least", "COST",
               "also find policies that cross less often and take less of this cost (time_s, "
               "work_J, ...), down to the policy with the least cost per crossing");
  CountOption points = add_count("points", "N", "at most N policies of --least (default: 5)");
  NumberOption chance = add_number(
      "chance", "P",
      "of the policies of --least, --policy writes the cheapest one that crosses with at least P");
  Option robust = add_flag(
      "robust",
      "find the policy that is best in the worst chain that the sampled runs leave possible");
  TextOption figure = add_figure("the actions by gate, and how often bodies cross");
};

/// What --least, --points and --chance ask for; nullopt without --least. Throws UsageError.
std::optional<lattice::ThriftOptions> thrift_of(const PlanCommand& options,
                                                const ShownField& shown) {
  if (!options.least) {
    for (const Option& other : std::initializer_list<Option>{options.points, options.chance})
      if (other) throw UsageError(fmt::format("--{}: only with --least", other.name()));
    return {};
  }
  lattice::ThriftOptions thrift;
  const std::vector<dynamics::CostInfo>& costs = shown.map.section.costs;
  std::string known;
  while (thrift.cost < costs.size() && costs[thrift.cost].key != options.least.value())
    known += (known.empty() ? "" : ", ") + costs[thrift.cost++].key;
  if (thrift.cost == costs.size())
    throw UsageError(fmt::format("--least: '{}' is none of {}",
                                 lattice::printable(options.least.value()), known));
  // A passage through a gate can cost 0 or less, except in time and losses.
  const std::string& key = costs[thrift.cost].key;
  if (shown.mass && shown.field.max_gates == 0 && key != "time_s" && key != "lost_J")
    throw UsageError(fmt::format(
        "--least {}: a passage may take 0 or less of it, and without a limit of gates a body would "
        "go on for ever: give --set field.max_gates=N, or --least time_s or lost_J",
        key));
  if (options.points) thrift.points = static_cast<int>(options.points.value(2, 100));
  if (options.chance) thrift.chance = options.chance.value();
  if (options.chance && !(thrift.chance > 0.0 && thrift.chance < 1.0))
    throw UsageError("--chance: must lie between 0 and 1");
  return thrift;
}

/// The keys of a start, in the order of an entry's coordinates.
constexpr std::array<std::string_view, 3> kStartKeys{"start.x_m", "start.vx_m_per_s",
                                                     "start.vy_m_per_s"};

/// The ranges without --over: x up to a radius from the joints, and vy up to the speed that a body
/// reaches in a gate without beams.
std::vector<std::string> usual_ranges(const lattice::Scene& scene) {
  const double speed = dynamics::meaning_of(scene.gate, scene.start).passage_speed;
  if (!std::isfinite(speed))
    throw UsageError(
        fmt::format("--over: say where bodies may start, such as --over start.vy_m_per_s=0:1; {} "
                    "has no push through a gate that tells a speed",
                    scene.source));
  const std::string x = lattice::toml_float(scene.gate.beams.joint_x - scene.gate.body.radius);
  return {fmt::format("start.x_m=-{}:{}", x, x),
          "start.vy_m_per_s=0:" + lattice::toml_float(speed)};
}

/// The ranges of a start by `face`, in the coordinates of an entry. Throws UsageError for other
/// keys, and for starts by another face.
std::vector<lattice::CoordinateRange> ranges_in(const lattice::RangedScene& ranged, int face) {
  const std::vector<double> none(ranged.ranges().size(), 0.0), all(ranged.ranges().size(), 1.0);
  const auto entry_at = [&](const std::vector<double>& point) {
    const lattice::Scene scene = ranged.at(point);
    return dynamics::entry_of(scene.gate, scene.start);
  };
  const dynamics::Entry low = entry_at(none), high = entry_at(all);
  if (low.face != face || high.face != face)
    throw UsageError(
        "--over: bodies start by a side of the gate: give ranges of start.vx_m_per_s and "
        "start.vy_m_per_s alone, and the side in the scene");
  std::vector<lattice::CoordinateRange> ranges;
  for (std::size_t c = 0; c < kStartKeys.size(); ++c)
    if (low.at[c] < high.at[c]) ranges.push_back({c, low.at[c], high.at[c]});
  if (ranges.size() != ranged.ranges().size())
    throw UsageError(
        "--over: a start is planned over start.x_m, start.vx_m_per_s and "
        "start.vy_m_per_s alone");
  return ranges;
}

/// The ranges of --over for a start in a cell file. Throws UsageError and what the file's reader
/// throws.
std::vector<lattice::CoordinateRange> ranges_in(const std::vector<std::string>& given,
                                                const PlanCommand& options,
                                                const lattice::Source& s) {
  std::vector<lattice::CoordinateRange> ranges;
  const std::vector<dynamics::Coordinate>& coordinates = s.problem.map().section.coordinates;
  for (const std::string& text : given) {
    const lattice::NumberRange range = lattice::range_in(text, "--over");
    std::string known;
    std::size_t c = 0;
    while (c < coordinates.size() && "start." + coordinates[c].key != range.key)
      known += (known.empty() ? "start." : ", start.") + coordinates[c++].key;
    if (c == coordinates.size())
      throw UsageError(
          fmt::format("--over: {} is none of {}", lattice::printable(range.key), known));
    for (const double end : {range.low, range.high}) {  // throws for a start that is not permitted
      std::vector<std::string> overrides;
      for (const std::string& set : options.overrides())
        if (!set.starts_with(lattice::kParameters)) overrides.push_back(set);
      overrides.push_back(range.key + "=" + lattice::toml_float(end));
      (void)lattice::read_cell_file(options.file(s.path).toml(), overrides);
    }
    ranges.push_back({c, range.low, range.high});
  }
  if (ranges.empty())
    throw UsageError(fmt::format("--over: says where bodies may start, such as --over start.{}=0:1",
                                 coordinates.front().key));
  return ranges;
}

/// Commands to propose after the search for a best start: predict from there, if --start can name
/// it, and the map of starts.
std::vector<std::string> next_of(const Options& options, const lattice::Source& s,
                                 const FoundStart& found) {
  NextCommands next(options);
  const lattice::TrialStart& best = found.found.best;
  const dynamics::Face& by =
      s.problem.map().section.faces[static_cast<std::size_t>(best.entry.face)];
  const std::string face = best.entry.face == 0 ? "" : by.name + ":";
  if (s.scene && !s.starts_given && best.column == s.problem.field.start_column())
    next.add("predict",
             fmt::format("--start={}{},{},{}", face, digits(best.entry.at[0], 4),
                         digits(best.entry.at[1], 4), digits(best.entry.at[2], 4)),
             "predicts all endings from there");
  return next.again("figure", "starts.svg", "draws the chance to cross by start").lines();
}

/// Commands to propose after a plan: bodies that follow its policy, once the policy is in a file.
std::vector<std::string> next_of(const PlanCommand& options) {
  NextCommands next(options);
  if (options.policy && !options.cell() && !options.program.command)
    next.add("trace",
             fmt::format("--policy {} --trials 20 --replay runs.html",
                         shell_quoted(options.policy.value())),
             "shows 20 bodies that follow the policy");
  else if (!options.policy)
    next.again("policy", "policy.json",
               options.cell() || options.program.command
                   ? "writes the policy for gatewalk lattice"
                   : "writes the policy for gatewalk lattice and trace");
  return next.again("figure", "plan.svg", "draws the actions by gate").lines();
}

/// Plans the start of a scene without actions: the start from which bodies cross most often. `s`
/// comes from field_to_run. Returns the exit status. Throws UsageError.
int plan_start(const PlanCommand& options, lattice::Source s) {
  for (const Option& other :
       std::initializer_list<Option>{options.policy, options.gate_policy, options.least,
                                     options.points, options.chance, options.robust})
    if (other)
      throw UsageError(
          fmt::format("--{}: is for a scene with actions; {} has no tables [actions.NAME]",
                      other.name(), s.path));
  lattice::BestStartOptions how;
  take_choice_rounds(options, options.rounds, how);
  const auto given = options.over.values();
  if (s.scene)
    how.ranges = ranges_in({options.file(s.path).toml(), options.overrides(),
                            given.empty() ? usual_ranges(*s.scene) : given, "--over"},
                           s.problem.start.face);
  else
    how.ranges = ranges_in(given, options, s);
  if (s.starts_given && !given.empty())
    throw UsageError("--over: varies the scene's start, and --start gives another");
  const lattice::FieldParams& field = s.problem.field;
  if (s.problem.map().types.size() > 1)
    for (int column = 0; column < field.columns; ++column) how.columns.push_back(column);
  else
    how.columns = {field.start_column()};
  choose_method(options, s);
  const dynamics::Stopwatch watch;
  lattice::BestStart found = lattice::best_start(s.problem, how, options.work());
  const FoundStart shown{
      ShownField(s),   s.problem.start,        how.ranges,           how.columns, std::move(found),
      watch.seconds(), lattice::settled_of(s), options.provenance(s)};
  options.give_out(shown, {answer_text(shown) + beware_of(shown.found.health), details_text(shown),
                           next_of(options, s, shown)});
  options.warn(few_crossings(shown.found.crossings));
  warn_of_choice_rounds(options, shown.found);
  options.warn(too_few_gates(ShownField(s)));
  const int exit = status_of(options, shown.found.health);
  options.draw([&] { return figure_of(shown); });
  return exit;
}

}  // namespace

int run_plan(const Arguments& arguments) {
  PlanCommand options(
      "plan SCENE [options]",
      "Finds which action a body should take in each gate, by how it enters, to cross as often as\n"
      "possible. The actions are tables of the scene, such as\n"
      "  [actions.push]\n"
      "  forces.propulsion_N = 9\n"
      "An action sets keys of forces and beams while a body takes it, or parameters.KEY of a cell\n"
      "program. An empty table is the scene as it is. plan finds the best policy for a chain, "
      "simulates\n"
      "the policy in full, adds these trials to the chain, and repeats. New trials then measure "
      "how often\n"
      "the policy crosses, and how often each action crosses when bodies always take it.\n"
      "Of a scene without actions, plan finds the start from which bodies cross most often, in a "
      "terrain\n"
      "in any column.",
      "gatewalk plan scenes/field.toml --set actions.slow.forces.propulsion_N=6 \\\n"
      "    --set actions.fast.forces.propulsion_N=9 --accuracy 0.1");
  options.add_details("each action taken all the time, and what each column or method gives");
  options.most_used({"set", "policy", "accuracy", "figure", "json"});
  if (!options.parse(arguments)) return kFine;
  lattice::PlanOptions how;
  take_choice_rounds(options, options.rounds, how);
  lattice::Source s = field_to_run(options,
                                   {.path = options.path,
                                    .program = options.program,
                                    .starts = options.rounds.starts,
                                    .accuracy = options.rounds.accuracy},
                                   "a plan is made");
  if ((s.scene ? s.scene->actions : s.cells->actions).empty())
    return plan_start(options, std::move(s));
  if (options.over)
    throw UsageError(fmt::format("--over: is for a scene without actions; {} has some", s.path));
  how.thrift = thrift_of(options, ShownField(s));
  how.robust = static_cast<bool>(options.robust);
  if (how.robust && how.thrift) throw UsageError("--robust: not with --least");
  if (options.policy || options.gate_policy) require_file_for(s);
  Actions all = actions_of(options, s);
  const dynamics::Stopwatch watch;
  lattice::Plan plan = lattice::make_plan(all.actions, how, options.work());
  const PlannedField planned{ShownField(s),   all.names(), std::move(all.methods), std::move(plan),
                             watch.seconds(), how.thrift,  options.provenance(s)};
  options.give_out(planned, {answer_text(planned) + beware_of(planned.plan.health),
                             details_text(planned), next_of(options)});
  if (options.policy)
    options.write(options.policy.value(), policy_text(chosen_policy(planned), all.made_for));
  if (options.gate_policy) {
    if (!planned.plan.by_cell)
      throw std::runtime_error("--gate-policy: there is none: no body crossed");
    options.write(options.gate_policy.value(),
                  policy_text(planned.plan.by_cell->policy, all.made_for));
  }
  options.warn(few_crossings(planned.plan.crossings));
  if (options.policy && !cheapest(planned) && !gains(planned))
    options.warn(
        fmt::format("--policy: {} is not shown to be better than {} all the time, which is simpler",
                    options.policy.value(), planned.actions[best_alone(planned.plan)]));
  if (how.thrift && how.thrift->chance > 0.0 && !cheapest(planned))
    options.warn("--chance: none of these policies crosses so often; --policy is the plan's own");
  if (!planned.plan.front_refused.empty())
    options.warn("--least: " + planned.plan.front_refused);
  else if (how.thrift && !planned.plan.front_finished)
    options.warn("--least: the search was not finished; --gate-runs and --points allow more");
  warn_of_choice_rounds(options, planned.plan);
  options.warn(too_few_gates(ShownField(s)));
  const int exit = status_of(options, planned.plan.health);
  options.draw([&] { return figure_of(planned); });
  return exit;
}

}  // namespace gatewalk::cli
