#include "cli/matrix.h"
#include "cli/report.h"
#include "markov/sweep.h"

namespace gatewalk::cli {

int run_predict(const std::vector<std::string>& arguments) {
  Options options("predict MATRIX.nc [SCENE] [options]",
                  "The exact distribution of the final gate: what infinitely many walks with this matrix\n"
                  "would give. How far the matrix itself can be trusted, gatewalk validate says.",
                  "gatewalk predict matrix.nc scenes/field.toml --json prediction.json");
  options.positional("matrix", "matrix file written by gatewalk build", true);
  options.positional("scene", "scene file; without it the matrix's own scene", false);
  options.add()("solver", po::value<std::string>()->default_value("auto")->value_name("NAME"),
                "propagate: step by step; for field.max_gates = 0 also march: row by row, and klu: one "
                "sparse solve; auto: march without limit, else propagate");
  if (!options.parse(arguments)) return kFine;
  const std::string& solver = options.get<std::string>("solver");
  if (solver != "auto" && solver != "propagate" && solver != "march" && solver != "klu")
    throw UsageError("--solver " + solver + ": must be auto, propagate, march or klu");
  require_different(options.text("matrix"), options.text("json"));
  const auto m = read_matrix_and_scene(options.text("matrix"), options.text("scene"), options.overrides());
  const auto [chain, start, start_text] = ready_chain(options, m);
  const markov::Field field{m.scene.field.columns, m.scene.field.rows};
  const int max_gates = m.scene.field.max_gates;
  if ((solver == "klu" || solver == "march") && max_gates != 0)
    throw UsageError("--solver " + solver + " needs field.max_gates = 0 (no limit), it is " +
                     std::to_string(max_gates));

  const markov::Sweeper sweeper(chain);
  const Stopwatch watch;
  const markov::FinalDistribution f =
      solver == "klu"         ? markov::solve_absorption(chain, field, start.start)
      : solver == "march"     ? sweeper.march(field, start.start)
      : solver == "propagate" ? sweeper.propagate(field, start.start, max_gates)
                              : sweeper.predict(field, start.start, max_gates);
  const double seconds = watch.seconds();

  Json json;
  json["final_gates"] = grid(f.final_cells);
  json["trapped"] = f.trapped;
  json["left_field"] = f.left_field;
  json["cut_off"] = f.cut_off;
  json["never_sampled"] = f.unsampled;
  json["still_walking"] = f.remainder;
  json["steps"] = f.steps;
  json["solver"] = solver;
  json["start_state"] = {{"input", start.start.input + 1}, {"bin", start_text},
                         {"clamped", start.clamped}};
  json["matrix_status"] = m.status;
  json["made_by"] = manifest(options, m.scene);

  std::string table = map_of(f.final_cells) + "trapped " + percent(f.trapped, 1.0, 2) +
                      ", left the field " + percent(f.left_field, 1.0, 2) + ", cut off " +
                      percent(f.cut_off, 1.0, 2) + "\nstart: " + start_text + "\n";
  if (f.unsampled > 0.0)
    table += "reaches a row that was never sampled: " + percent(f.unsampled, 1.0, 4) + "\n";
  if (f.remainder > 1e-12)
    table += "still walking when the sum was stopped: " + percent(f.remainder, 1.0, 6) + "\n";
  options.give_out(json, table);
  remark(options, fixed(1e3 * seconds, 3) + " ms");
  return kFine;
}

}  // namespace gatewalk::cli
