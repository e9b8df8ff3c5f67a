// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include <algorithm>
#include <set>
#include <utility>

#include "cli/arguments.h"
#include "cli/next.h"
#include "cli/render/choice.h"
#include "cli/render/health.h"
#include "cli/render/sweep.h"
#include "cli/terminal/output.h"
#include "dynamics/base/work.h"
#include "lattice/scene/scene_keys.h"
#include "lattice/scene/units.h"
#include "lattice/source/source.h"
#include "lattice/source/source_file.h"

namespace gatewalk::cli {
namespace {

/// Throws UsageError if an override sets a key that is varied.
void refuse_overridden(const std::vector<lattice::SweepAxis>& axes,
                       const std::vector<std::string>& overrides) {
  for (const std::string& set : overrides)
    for (const std::string& key : lattice::keys_set_by(set))
      for (const lattice::SweepAxis& axis : axes)
        if (key == lattice::known_key(axis.key, "--vary"))
          throw UsageError(fmt::format(
              "--set {} has no effect: {} is varied; --vary {}=VALUE fixes it", set, key, key));
}

/// The warnings about the scenes of all points, each once.
std::vector<std::string> remarks_on(const Options& options,
                                    const std::vector<lattice::SweepAxis>& axes,
                                    const std::vector<lattice::SweepPoint>& points) {
  const bool talk = options.talk();
  const bool with_push =
      replaces_push(options) || std::ranges::any_of(axes, [](const lattice::SweepAxis& axis) {
        return lattice::known_key(axis.key, "--vary") == "forces.propulsion_N";
      });
  std::set<std::string> texts;
  for (const lattice::SweepPoint& p : points) {
    for (const std::string& text : lattice::keys_without_effect(p.scene, lattice::RunsFrom::start))
      texts.insert(text);
    if (talk) texts.insert(lattice::derived_keys(p.scene));
    if (talk && with_push) texts.insert(push_alone_changes(p.scene));
  }
  texts.erase("");
  return {texts.begin(), texts.end()};
}

std::vector<std::string> next_of(const Options& options, const SweepResult& result) {
  NextCommands next(options);
  constexpr std::size_t kMostDrawn = 2;  // keys
  if (result.axes.size() <= kMostDrawn) next.again("figure", "sweep.svg", "draws all points");
  return next.again("csv", "sweep.csv", "writes all points as a table").lines();
}

}  // namespace

int run_sweep(const Arguments& arguments) {
  Options options(
      "sweep SCENE [options]",
      "Shows how the runs through one gate end when numbers of the scene change.\n"
      "sweep simulates the gate many times at every point of a grid over any keys, and counts how "
      "the\n"
      "runs end. Values are from:step:to or a list; the grid has all combinations. A scene may "
      "bring a\n"
      "grid in a table [sweep]; --vary adds a key to that grid, or replaces the values of a key.",
      "gatewalk sweep scenes/single_gate.toml --vary forces.propulsion_N=4:1:9 --trials 1000");
  const TextOption path = options.scene();
  options.add_trials_and_seed("runs through the gate at each point");
  options.add_first_trial();
  options.add_kept({"gate runs"});
  options.add_strict();
  const TextsOption vary = options.add_texts(
      "vary", "KEY=VALUES",
      "a key and its values, e.g. forces.random_N=0:10:40 or run.method=stable,paper "
      "(may be repeated)");
  const TextOption table =
      options.output_file("csv", "FILE", "write the grid as CSV; - is standard output");
  const TextOption figure = options.add_figure("shares over one key, a map over two");
  options.add_details("the table of all points, and the numbers that stay fixed");
  options.most_used({"vary", "trials", "figure", "csv", "json"});
  if (!options.parse(arguments)) return kFine;
  const std::string csv = table.value();
  const dynamics::TrialRange trials = options.trial_range();
  const lattice::TomlFile& file = options.file(path.value()).toml();
  const lattice::Scene scene = lattice::read_scene(file, options.overrides());
  const auto axes = lattice::sweep_axes(scene.sweep, vary.values());
  refuse_overridden(axes, options.overrides());
  if (figure && axes.size() > 2)
    throw UsageError(fmt::format("--figure: shows one key or two, {} are varied", axes.size()));
  auto points = lattice::sweep_points({file, options.overrides(), axes});
  for (const std::string& remark : remarks_on(options, axes, points)) options.warn(remark);

  lattice::run_sweep(points, trials, options.seed(), options.work(),
                     [&](const auto& p) { options.warn(complaint(*p.settled)); });
  options.work().end_part();

  const SweepResult result{axes, std::move(points), options.provenance(scene)};
  dynamics::Health health;
  for (const lattice::SweepPoint& p : result.points) health += p.tally.health;
  if (csv == "-") {
    write_text_atomically("-", csv_of(result));
    if (!options.json.value().empty()) options.give_out(result, std::string());
  } else {
    if (!csv.empty()) options.write(csv, csv_of(result));
    options.give_out(result, {answer_text(result) + beware_of(health), details_text(result, scene),
                              next_of(options, result)});
  }
  options.warn(complaint(health));
  const int status =
      exit_status(options, std::all_of(result.points.begin(), result.points.end(),
                                       [](const auto& p) { return p.tally.health.clean(); }));
  options.draw([&] { return figure_of(axes, result.points); });
  return status;
}

}  // namespace gatewalk::cli
