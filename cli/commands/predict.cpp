#include <charconv>

#include "cli/arguments.h"
#include "cli/render/json.h"
#include "cli/render/matrix.h"
#include "cli/render/prediction.h"
#include "cli/render/scene.h"
#include "cli/render/text.h"
#include "lattice/study/prediction.h"

namespace gatewalk::cli {
namespace {

/// "4-6=other.nc": rows whose gates are those of another matrix.
lattice::RowMatrix parse_rows(const Options& options, const std::string& text) {
  const auto wrong = [&] {
    return UsageError("--row " + text +
                      ": must be rows i_y and a matrix, e.g. 4-6=other.nc or 4=other.nc");
  };
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals + 1 == text.size()) throw wrong();
  const char *at = text.data(), *const end = text.data() + equals;
  int first = 0, last = 0;
  const auto number = [&](int& value) {
    const auto read = std::from_chars(at, end, value);
    if (read.ec != std::errc() || value < 0) throw wrong();
    at = read.ptr;
  };
  number(first);
  last = first;
  if (at != end) {
    if (*at++ != '-') throw wrong();
    number(last);
  }
  if (at != end) throw wrong();
  const std::string path = text.substr(equals + 1);
  return {first, last, path, read_matrix(options, path, "", {})};
}

std::vector<lattice::RowMatrix> other_rows(const Options& options) {
  std::vector<lattice::RowMatrix> rows;
  for (const std::string& text : options.texts("row")) rows.push_back(parse_rows(options, text));
  return rows;
}

/// By the names of --solver. Throws UsageError for any other.
markov::PredictOptions::Solver solver_of(const std::string& name) {
  using Solver = markov::PredictOptions::Solver;
  if (name == "auto") return Solver::automatic;
  if (name == "propagate") return Solver::steps;
  if (name == "march") return Solver::rows;
  if (name == "klu") return Solver::klu;
  throw UsageError("--solver " + name + ": must be auto, propagate, march or klu");
}

}  // namespace

int run_predict(const Arguments& arguments) {
  Options options(
      "predict MATRIX.nc [SCENE] [options]",
      "The exact distribution of endings and final gate: what infinitely many walks with this\n"
      "matrix would give. The 95 % intervals count that the matrix is a sample of gate runs;\n"
      "how far the chain itself (bins, memory) is off, gatewalk validate measures.",
      "gatewalk predict matrix.nc scenes/field.toml --start 0,0,15 --start 4,5,10 --json "
      "prediction.json");
  options.positional("matrix", "matrix file written by gatewalk build", true);
  options.positional("scene", "scene file; without it the matrix's own scene", false);
  add_starts(options, "the scene's start");
  options.add_texts("row", "A-B=FILE",
                    "gates of rows i_y = A to B as in another matrix of the same bins (may be "
                    "repeated)");
  options.add_text("solver", "NAME",
                   "propagate: step by step; for field.max_gates = 0 also march: row by row, and "
                   "klu: one sparse solve; auto: march without limit, else propagate",
                   "auto");
  options.add_strict();
  options.reads("row", [](const std::string& rows) { return rows.substr(rows.find('=') + 1); });
  options.add_seed("seed of the resampled matrices behind the intervals");
  if (!options.parse(arguments)) return kFine;
  const std::string solver = options.text("solver"), path = options.text("matrix");
  const markov::PredictOptions how{.solver = solver_of(solver)};
  const std::vector<lattice::PaperStart> given = given_starts(options);
  const std::vector<lattice::RowMatrix> others = other_rows(options);
  const lattice::SceneMatrix m = read_matrix(options);
  lattice::require_inside(given, m.scene);
  const lattice::CountedField gates = lattice::field_of(m, path, others);
  std::vector<lattice::ChainStart> starts;
  for (const lattice::PaperStart& s : given)
    starts.push_back(ready_start(options, m, s.body(), title_of(s)));
  if (given.empty()) starts.push_back(ready_start(options, m, m.scene.start, "the start"));
  if ((solver == "klu" || solver == "march") && m.scene.field.max_gates != 0)
    throw UsageError("--solver " + solver + " needs field.max_gates = 0 (no limit), it is " +
                     std::to_string(m.scene.field.max_gates));

  const auto prediction =
      lattice::predict(gates, m.scene.field, starts, how, options.seed(), options.work());
  if (prediction.failed)
    options.warn("no interval counts the sampling of the matrix: a resampled one fails: " +
                 *prediction.failed);

  const Json status = recorded_status(m.file);
  const PredictedField shown{m, given, others};
  Json json = to_json(prediction, shown, solver);
  json["made_by"] = to_json(options.provenance(m.scene));
  options.give_out(json, table_of(prediction, shown));
  options.warn(too_few_gates(m.scene));
  options.remark(fixed(1e3 * prediction.seconds, 3) + " ms");
  return exit_status(options, faults_recorded(status).empty());
}

}  // namespace gatewalk::cli
