// SPDX-License-Identifier: MIT
#include "cli/render/design.h"

#include <fmt/format.h>

#include "cli/arguments.h"
#include "cli/choice_rounds.h"
#include "cli/fields/text.h"
#include "cli/next.h"
#include "cli/render/crossings.h"
#include "cli/render/health.h"
#include "cli/render/scene.h"
#include "cli/source_options.h"
#include "dynamics/base/work.h"
#include "lattice/scene/scene_keys.h"
#include "lattice/scene/scene_problem.h"
#include "lattice/text/toml_text.h"

namespace gatewalk::cli {
namespace {

/// The terrain's types by their names, such as "s,w" or "."; all types for an empty text.
std::vector<int> types_named(const std::string& names, const lattice::Scene& scene) {
  std::vector<std::string> known{scene.terrain->own};
  for (const lattice::Terrain::Type& type : scene.terrain->types) known.push_back(type.name);
  std::vector<int> types;
  for (std::size_t from = 0; from <= names.size();) {
    const std::size_t end = std::min(names.find(',', from), names.size());
    const std::string name = names.substr(from, end - from);
    const auto at = std::find(known.begin(), known.end(), name);
    if (at == known.end())
      throw UsageError(fmt::format("--types: \"{}\" is no type of gate of {}: {}",
                                   lattice::printable(name), scene.source, fmt::join(known, ", ")));
    types.push_back(static_cast<int>(at - known.begin()));
    from = end + 1;
  }
  return types;
}

std::vector<std::string> next_of(const Options& options) {
  NextCommands next(options);
  if (!options.output) next.again("output", "changed.toml", "writes the changed scene");
  return next.again("figure", "design.svg", "draws what each change does").lines();
}

}  // namespace

int run_design(const Arguments& arguments) {
  Options options("design SCENE [options]",
                  "Finds which gates of a field to change into other types of its table [terrain], "
                  "so that bodies\n"
                  "cross as often as possible. design finds the best map for a chain, simulates "
                  "the map in full, adds\n"
                  "these trials to the chain, and repeats. New trials then measure how often "
                  "bodies cross the changed\n"
                  "field, and the field as it is.",
                  "gatewalk design scenes/mixed.toml --changes 3 --types s,.");
  const TextOption path = options.scene();
  const CountOption changes =
      options.add_count("changes", "N", "change at most so many gates", "1");
  const TextOption types = options.add_text(
      "types", "A,B",
      "change gates into these types of [terrain] only; . is the scene's own type (default: all)");
  const Option least = options.add_flag("least", "let bodies cross as rarely as possible instead");
  const ChoiceRounds rounds = add_choice_rounds(options);
  const TextOption output =
      options.output_file("output", "FILE.toml",
                          "write the scene with the gates changed, and with the start of --start");
  options.add_figure("what a change of each gate does, and which gates are changed");
  options.add_details("the maps that the chain preferred, and the time-stepping method");
  options.most_used({"changes", "types", "accuracy", "output", "figure"});
  if (!options.parse(arguments)) return kFine;
  lattice::FieldDesignOptions how{.least = static_cast<bool>(least)};
  take_choice_rounds(options, rounds, how);
  lattice::Source s =
      field_to_run(options, {.path = path, .starts = rounds.starts, .accuracy = rounds.accuracy},
                   "a field is designed");
  if (!s.scene) throw UsageError(s.path + ": is no scene of gates");
  if (!s.scene->terrain || s.scene->terrain->types.empty())
    throw UsageError(s.path +
                     ": has one type of gates: a table [terrain.types.NAME] makes another");
  const std::int64_t gates = std::int64_t{s.scene->field.columns} * s.scene->field.rows;
  const std::int64_t most = changes.value();
  if (most > gates) throw UsageError(fmt::format("--changes: the field has {} gates", gates));
  how.most_changes = static_cast<int>(most);
  if (types) how.become = types_named(types.value(), *s.scene);
  const auto settled = settle_method(options, *s.scene, lattice::RunsFrom::all_types);
  lattice::Problem problem = lattice::problem_with_all_types(*s.scene);
  problem.start = *s.starts.front();
  const dynamics::Stopwatch watch;
  lattice::DesignedField design = lattice::design_field(problem, how, options.work());
  lattice::Scene changed = with_gates(*s.scene, design.type_of_cell);
  if (s.starts_given) changed.start = dynamics::entry_state(changed.gate, problem.start);
  const DesignedScene designed{
      *s.scene, std::move(changed), problem.map().section, problem.start,        how,
      settled,  std::move(design),  watch.seconds(),       options.provenance(s)};
  options.give_out(designed, {answer_text(designed) + beware_of(designed.design.health),
                              details_text(designed), next_of(options)});
  if (output) options.write(output.value(), lattice::scene_file(designed.after));
  const lattice::Crossings &with = designed.design.crossings, &without = designed.design.before;
  options.warn(few_crossings(with.crossed > without.crossed ? with : without));
  warn_of_choice_rounds(options, designed.design);
  options.warn(too_few_gates(ShownField(s)));
  const int exit = status_of(options, designed.design.health);
  options.draw([&] { return figure_of(designed); });
  return exit;
}

}  // namespace gatewalk::cli
