#include "cli/render/landscape.h"

#include "cli/command.h"
#include "cli/render/choice.h"
#include "cli/render/drawing.h"
#include "cli/render/report.h"
#include "cli/terminal/output.h"
#include "dynamics/study/accuracy.h"

namespace gatewalk::cli {
namespace {

dynamics::BeamsThatPush beams_of(const std::string& name) {
  if (name != "both" && name != "left" && name != "right")
    throw UsageError("--beam " + name + ": must be both, left or right");
  return {name != "right", name != "left"};
}

double spacing_for(const Options& options, const lattice::Scene& scene) {
  const auto [least, usual, most] = dynamics::spacings_for(scene.gate, scene.start);
  const double spacing = options.has("spacing") ? options.get<double>("spacing") : usual;
  if (!(spacing >= least && spacing <= most))
    throw UsageError("--spacing " + digits(spacing) + ": must lie in [" + digits(least) + ", " +
                     digits(most) + "] m");
  return spacing;
}

}  // namespace

int run_landscape(const std::vector<std::string>& arguments) {
  Options options("landscape SCENE -o DIR [options]",
                  "The potential energy of body and beams over the gate, Eqs. (14) and (15) of the "
                  "paper, with beams\n"
                  "deflected forward; the way through whose highest point is lowest, and how far "
                  "that lies above the\n"
                  "energy of the start and above the basin on the way. Writes landscape.csv, "
                  "landscape.json, landscape.svg.",
                  "gatewalk landscape scenes/single_gate.toml -o landscape --trials 1000");
  options.positional("scene", "scene file (TOML)", true);
  options.output_folder("folder to write to", {"landscape.csv", "landscape.json", "landscape.svg"});
  options.add()("spacing", po::value<double>()->value_name("M"),
                "of the grid, in m (default: a twentieth of body.radius_m, as in the paper)")(
      "beam", po::value<std::string>()->default_value("both")->value_name("WHICH"),
      "beams that resist: both, left or right (the other swings free: Fig. 6C)")(
      "trials", po::value<Count>()->default_value(Count{0}, "0")->value_name("N"),
      "also run the gate N times: who passes, beside who should");
  add_seed(options);
  add_strict(options);
  if (!options.parse(arguments)) return kFine;
  const std::string folder = options.text("output");
  const auto beams = beams_of(options.get<std::string>("beam"));
  const std::int64_t trials = options.count("trials", 0);
  lattice::Scene scene = lattice::read_scene(options.text("scene"), options.overrides());
  const double spacing = spacing_for(options, scene);
  require_folder(folder);

  const dynamics::Passes passes = dynamics::passes(scene.gate, scene.start, spacing, beams);
  Json json = to_json(passes);
  std::string table = scene_line(scene) + table_of(passes, scene.gate);
  bool clean = true;
  if (trials > 0) {
    const Json settled = settle_method(options, scene, lattice::RunsFrom::start);
    const auto tally = dynamics::run_checked_trials(scene.gate, scene.start, options.seed(), trials,
                                                    options.work());
    json["measured"] = to_json(tally);
    if (!settled.is_null()) json["measured"]["method"] = settled;
    json["measured"]["status"] = to_json(tally.health);
    table += measured_line(tally);
    clean = tally.health.clean();
    if (!clean) warn(complaint(tally.health));
  }
  json["made_by"] = manifest(options, scene);
  write_text_atomically(folder + "/landscape.csv", csv_of(passes.coarse.landscape));
  write_text_atomically(folder + "/landscape.json", text_of(json) + "\n");
  draw(folder + "/landscape.svg", passes, scene.gate);
  options.give_out(json, table);
  return exit_status(options, clean);
}

}  // namespace gatewalk::cli
