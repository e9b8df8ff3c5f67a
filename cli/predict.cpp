#include <sstream>

#include "cli/matrix.h"
#include "cli/report.h"
#include "cli/starts.h"
#include "markov/sweep.h"

namespace gatewalk::cli {
namespace {

using markov::FinalDistribution;

std::vector<FinalDistribution> solve(const markov::Chain& chain, const std::string& solver,
                                     const markov::Field& field,
                                     const std::vector<markov::Start>& starts, int max_gates) {
  if (solver == "klu") {
    std::vector<FinalDistribution> all;
    for (const markov::Start& s : starts) all.push_back(markov::solve_absorption(chain, field, s));
    return all;
  }
  const markov::Sweeper sweeper(chain);
  return solver == "march"       ? sweeper.march_all(field, starts)
         : solver == "propagate" ? sweeper.propagate_all(field, starts, max_gates)
                                 : sweeper.predict_all(field, starts, max_gates);
}

/// What is predicted for one start.
void add_to(Json& json, const FinalDistribution& f) {
  json["final_gates"] = grid(f.final_cells);
  json["trapped"] = f.trapped;
  json["left_field"] = f.left_field;
  json["cut_off"] = f.cut_off;
  json["never_sampled"] = f.unsampled;
  json["still_walking"] = f.remainder;
  json["steps"] = f.steps;
}

Json start_state(const ReadyStart& s) {
  return {{"input", s.start.start.input + 1}, {"bin", s.text}, {"clamped", s.start.clamped}};
}

std::string title_of(const PaperStart& s) {
  std::ostringstream title;
  title << "start d " << s.d << " m, vx " << s.vx << " m/s, vy " << s.vy << " m/s";
  return title.str();
}

std::string table_of(const FinalDistribution& f, const ReadyStart& start) {
  std::string table = map_of(f.final_cells) + "trapped " + percent(f.trapped, 1.0, 2) +
                      ", left the field " + percent(f.left_field, 1.0, 2) + ", cut off " +
                      percent(f.cut_off, 1.0, 2) + "\nstart: " + start.text + "\n";
  if (f.unsampled > 0.0)
    table += "reaches a row that was never sampled: " + percent(f.unsampled, 1.0, 4) + "\n";
  if (f.remainder > 1e-12)
    table += "still walking when the sum was stopped: " + percent(f.remainder, 1.0, 6) + "\n";
  return table;
}

}  // namespace

int run_predict(const std::vector<std::string>& arguments) {
  Options options("predict MATRIX.nc [SCENE] [options]",
                  "The exact distribution of the final gate: what infinitely many walks with this matrix\n"
                  "would give. How far the matrix itself can be trusted, gatewalk validate says.",
                  "gatewalk predict matrix.nc scenes/field.toml --start 0,0,15 --start 4,5,10 --json "
                  "prediction.json");
  options.positional("matrix", "matrix file written by gatewalk build", true);
  options.positional("scene", "scene file; without it the matrix's own scene", false);
  add_starts(options, "the scene's start");
  options.add()("solver", po::value<std::string>()->default_value("auto")->value_name("NAME"),
                "propagate: step by step; for field.max_gates = 0 also march: row by row, and klu: one "
                "sparse solve; auto: march without limit, else propagate");
  if (!options.parse(arguments)) return kFine;
  const std::string& solver = options.get<std::string>("solver");
  if (solver != "auto" && solver != "propagate" && solver != "march" && solver != "klu")
    throw UsageError("--solver " + solver + ": must be auto, propagate, march or klu");
  require_different(options.text("matrix"), options.text("json"));
  const std::vector<PaperStart> given = options.has("start") ? starts_of(options) : std::vector<PaperStart>{};
  const auto m = read_matrix_and_scene(options.text("matrix"), options.text("scene"), options.overrides());
  require_inside(given, m.scene);
  const markov::Chain chain = lattice::make_chain(m.file.transitions);
  std::vector<ReadyStart> starts;
  for (const PaperStart& s : given)
    starts.push_back(ready_start(options, m, s.body(), title_of(s)));
  if (given.empty()) starts.push_back(ready_start(options, m, m.scene.start, "the start"));
  std::vector<markov::Start> places;
  for (const ReadyStart& s : starts) places.push_back(s.start.start);
  const markov::Field field{m.scene.field.columns, m.scene.field.rows};
  const int max_gates = m.scene.field.max_gates;
  if ((solver == "klu" || solver == "march") && max_gates != 0)
    throw UsageError("--solver " + solver + " needs field.max_gates = 0 (no limit), it is " +
                     std::to_string(max_gates));

  const Stopwatch watch;
  const std::vector<FinalDistribution> found = solve(chain, solver, field, places, max_gates);
  const double seconds = watch.seconds();

  Json json;
  std::string table;
  if (given.empty()) {
    add_to(json, found.front());
    table = table_of(found.front(), starts.front());
  }
  for (std::size_t k = 0; k < given.size(); ++k) {
    Json one;
    one["start"] = {{"d_m", given[k].d}, {"vx_m_per_s", given[k].vx}, {"vy_m_per_s", given[k].vy}};
    add_to(one, found[k]);
    one["start_state"] = start_state(starts[k]);
    json["starts"].push_back(std::move(one));
    table += (k > 0 ? "\n" : "") + title_of(given[k]) + "\n" + table_of(found[k], starts[k]);
  }
  json["solver"] = solver;
  if (given.empty()) json["start_state"] = start_state(starts.front());
  json["matrix_status"] = m.status;
  json["made_by"] = manifest(options, m.scene);
  options.give_out(json, table);
  remark(options, fixed(1e3 * seconds, 3) + " ms");
  return kFine;
}

}  // namespace gatewalk::cli
