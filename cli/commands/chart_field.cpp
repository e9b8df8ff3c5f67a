// SPDX-License-Identifier: MIT
#include "cli/arguments.h"
#include "cli/render/fidelity.h"

namespace gatewalk::cli {

int run_chart_field(const Arguments& arguments) {
  Options options("chart field SCENE -o DIR [options]",
                  "Tests whether it is enough that only the beams of the body's own gate move "
                  "(field.fidelity =\n"
                  "active). chart field simulates the full dynamics at every field.fidelity with "
                  "the same noise, and\n"
                  "compares final gates and cost with beams that remember, and with the beams of "
                  "neighbouring gates.\n"
                  "It uses method moreau at the scene's run.step_s, and ignores run.method and "
                  "field.fidelity of the\n"
                  "scene. One more line has the default method. With a long step, moreau sinks "
                  "into beams; then a\n"
                  "warning asks for a smaller run.step_s. The command writes fidelity.csv, "
                  "fidelity.json and, with\n"
                  "gnuplot, fidelity.svg into DIR.",
                  "gatewalk chart field scenes/field.toml --trials 2000 --set run.step_s=0.001 -o "
                  "results/fidelity");
  options.scene();
  options.add_trials_and_seed("trials per start and fidelity");
  const std::vector<std::string> files{"fidelity.csv", "fidelity.json", "fidelity.svg"};
  options.output_folder("folder to write to; made if missing", files);
  const TextsOption given = add_starts(options);
  options.add_strict();
  options.add_figure("the figure of the folder");
  options.add_details("endings, times and changes for each start and fidelity");
  options.most_used({"output", "trials", "start", "set", "json"});
  if (!options.parse(arguments)) return kFine;
  const lattice::Scene scene = options.read_scene();
  if (scene.gate.run.method == "auto")
    throw UsageError(
        "run.method = \"auto\" is not permitted for chart field, which runs method moreau: "
        "name a method, and give moreau's step as run.step_s");
  // The scene's own start may lie inside the gate.
  std::vector<dynamics::BodyState> starts{scene.start};
  if (dynamics::on_boundary(scene.gate, scene.start) || given) {
    const std::vector<dynamics::Entry> entries = starts_of(given, scene);
    lattice::require_inside(entries, scene);
    starts = lattice::bodies_at(scene, entries);
  }
  const auto variants = lattice::fidelity_variants(scene);
  const lattice::FidelityOptions how{starts, options.trials.value(), options.seed()};
  const ResultFolder folder(options, files);

  const FidelityResult result{lattice::compare_fidelities(variants, how, options.work()),
                              options.provenance(scene)};
  const lattice::FidelityStudy& study = result.study;
  folder.write("fidelity.csv", csv_of(study), "fidelity.json", result);
  options.give_out(result, {answer_text(study), details_text(study)});
  for (const std::string& text : complaints(study)) options.warn(text);
  folder.draw("fidelity.svg", figure_of(study));
  const int exit = exit_status(options, study.clean());
  options.draw([&] { return figure_of(study); });
  return exit;
}

}  // namespace gatewalk::cli
