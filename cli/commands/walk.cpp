#include "cli/arguments.h"
#include "cli/render/matrix.h"
#include "cli/render/report.h"
#include "cli/render/states.h"
#include "cli/terminal/progress.h"

namespace gatewalk::cli {

int run_walk(const std::vector<std::string>& arguments) {
  Options options(
      "walk MATRIX.nc [SCENE] [options]",
      "Walks the field by drawing every gate's outcome from the matrix (the paper's\n"
      "Markov chain Monte Carlo) and counts the final gates.",
      "gatewalk walk matrix.nc scenes/field.toml --walks 1e6 --seed 1 --json walks.json");
  options.positional("matrix", "matrix file written by gatewalk build", true);
  options.positional("scene", "scene file; without it the matrix's own scene", false);
  options.add()("walks", po::value<Count>()->default_value(Count{100}, "100")->value_name("N"),
                "number of walks");
  add_seed(options);
  add_strict(options);
  if (!options.parse(arguments)) return kFine;
  const auto m =
      read_matrix_and_scene(options.text("matrix"), options.text("scene"), options.overrides());
  const ReadyChain ready = ready_chain(options, m);
  const std::int64_t walks = options.count("walks");
  const markov::Field field{m.scene.field.columns, m.scene.field.rows};

  const Stopwatch watch;
  const markov::Walker walker(ready.chain);
  markov::WalkTally tally;
  run_in_batches("walks", walks, options.talk(), [&](std::int64_t first, std::int64_t n) {
    tally +=
        walker.walk(field, ready.start.start, m.scene.field.max_gates, options.seed(), {first, n});
  });
  const double seconds = watch.seconds();

  Json json;
  const EndingShares shares(tally.endings, tally.walks);
  json["endings"] = endings(tally.endings);
  json["endings_95"] = endings_95(shares);
  json["final_gates"] = grid(tally.final_cells);
  json["trapped_gates"] = grid(tally.trapped_cells);
  json["departed_gates"] = grid(tally.departed_cells);
  json["walks"] = tally.walks;
  json["trapped"] = tally.trapped;
  json["left_field"] = tally.left_field;
  json["cut_off"] = tally.cut_off;
  json["never_sampled"] = tally.unsampled;
  json["gates_visited"] = tally.steps;
  json["start_state"] = {{"input", ready.start.start.input + 1},
                         {"bin", ready.start_text},
                         {"clamped", ready.start.clamped}};
  json["matrix_status"] = m.status;
  json["made_by"] = manifest(options, m.scene);

  const auto n = static_cast<double>(tally.walks);
  std::string table =
      endings_text(shares, "of " + std::to_string(tally.walks) + " walks, 95 % intervals") +
      limits_text(m.scene) + map_of(tally.final_cells.cast<double>() / n) +
      map_of_trapped(tally.trapped_cells.cast<double>() / n) + "left the field " +
      percent(static_cast<double>(tally.left_field), n, 2) + "\nstart: " + ready.start_text +
      "\nThe intervals count chance in the walks alone: that of the matrix gatewalk predict has, "
      "the chain's own "
      "error (bins, memory) gatewalk validate measures.\n";
  if (tally.unsampled > 0)
    table += "reached a row that was never sampled: " +
             percent(static_cast<double>(tally.unsampled), n, 4) + "\n";
  options.give_out(json, table);
  warn_if_too_few_gates(m.scene);
  remark(options,
         fixed(seconds, 3) + " s, " + fixed(n / seconds / 1e6, 2) + " million walks a second");
  return exit_status(options, faults_recorded(m.status).empty());
}

}  // namespace gatewalk::cli
