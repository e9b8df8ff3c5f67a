#include <filesystem>

#include "cli/arguments.h"
#include "cli/render/fidelity.h"
#include "cli/render/gnuplot.h"
#include "cli/render/report.h"
#include "cli/terminal/output.h"

namespace gatewalk::cli {

int run_chart_field(const std::vector<std::string>& arguments) {
  Options options(
      "chart-field SCENE -o DIR [options]",
      "Runs the full dynamics at every field.fidelity, with the same noise: what do beams that\n"
      "remember, and beams of neighbouring gates, change in the final gates, and what do they\n"
      "cost? Method moreau at the scene's run.step_s, which the text names; run.method and\n"
      "field.fidelity of the scene are not used. Also the default method, to show what another\n"
      "integrator changes. Long steps let moreau sink into beams: a warning says so, and a "
      "smaller\n"
      "run.step_s helps. Writes fidelity.csv, fidelity.json and, with gnuplot, fidelity.svg into "
      "DIR.",
      "gatewalk chart-field scenes/field.toml --trials 2000 --set run.step_s=0.001 -o "
      "results/fidelity");
  options.positional("scene", "scene file (TOML)", true);
  add_trials_and_seed(options, "trials per start and fidelity");
  options.output_folder("folder to write to; made if missing",
                        {"fidelity.csv", "fidelity.json", "fidelity.svg"});
  add_starts(options);
  add_strict(options);
  if (!options.parse(arguments)) return kFine;
  const std::string folder = options.text("output");
  const lattice::Scene scene = lattice::read_scene(options.text("scene"), options.overrides());
  if (scene.gate.run.method == "auto")
    throw UsageError(
        "run.method = \"auto\" is not permitted for chart-field, which runs method moreau: "
        "name a method, and give moreau's step as run.step_s");
  const std::vector<lattice::PaperStart> starts = starts_of(options, scene);
  lattice::require_inside(starts, scene);
  const auto variants = lattice::fidelity_variants(scene);
  const auto path = [&](const char* name) {
    return (std::filesystem::path(folder) / name).string();
  };
  const std::string csv_path = path("fidelity.csv"), json_path = path("fidelity.json"),
                    svg_path = path("fidelity.svg");
  require_folder(folder);

  const lattice::FidelityStudy study = lattice::compare_fidelities(
      variants, {starts, options.count("trials"), options.seed()}, options.work());
  Json json = to_json(study);
  json["made_by"] = manifest(options, scene);
  std::filesystem::remove(svg_path);  // an old figure shall not stand beside new numbers
  write_text_atomically(csv_path, csv_of(study));
  write_text_atomically(json_path, text_of(json) + "\n");
  options.give_out(json, table_of(study));
  for (const std::string& text : complaints(study)) warn(text);
  try {
    write_text_atomically(svg_path, drawn(figure_of(study)));
  } catch (const std::runtime_error& e) {
    throw std::runtime_error("no figure: " + std::string(e.what()) + "; " + csv_path + " and " +
                             json_path + " are written");
  }
  return exit_status(options, study.clean());
}

}  // namespace gatewalk::cli
