#include <charconv>

#include "cli/arguments.h"
#include "cli/commands/recorded.h"
#include "cli/render/choice.h"
#include "cli/render/field_figure.h"
#include "cli/render/field_netcdf.h"
#include "cli/render/final_gates.h"
#include "cli/render/json.h"
#include "cli/render/matrix.h"
#include "cli/render/pooled_prediction.h"
#include "cli/render/prediction.h"
#include "cli/render/scene.h"
#include "cli/render/text.h"
#include "cli/terminal/output.h"
#include "lattice/cells/cell_matrix.h"
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

/// Starts given, else the scene's.
std::vector<dynamics::Entry> entries_of(const std::vector<lattice::PaperStart>& given,
                                        const lattice::Scene& scene) {
  lattice::require_inside(given, scene);
  return lattice::entries_at(given.empty() ? std::vector{lattice::own_start(scene)} : given);
}

/// A map for each start.
template <class Answer>
Figure figure_of(const std::vector<lattice::PaperStart>& given, const std::vector<Answer>& answers,
                 lattice::EndingShares Answer::*shares, const lattice::Scene& scene) {
  std::vector<FieldPicture> pictures;
  for (std::size_t i = 0; i < answers.size(); ++i)
    pictures.emplace_back("prediction, " + std::to_string(answers[i].final.final_cells.cols()) +
                              " x " + std::to_string(answers[i].final.final_cells.rows()) +
                              " gates" + (given.empty() ? "" : ", " + title_of(given[i])),
                          answers[i].final, answers[i].*shares, answers[i].exits);
  return cli::figure_of(pictures, scene);
}

/// The file of --netcdf, if it is asked for; `field_of` says what is known of an answer.
template <class Answer, class FieldOf>
void write_netcdf(const Options& options, const lattice::Scene& scene,
                  const std::vector<Answer>& answers, const FieldOf& field_of) {
  if (!options.has("netcdf")) return;
  std::vector<FieldArrays> fields;
  for (const Answer& answer : answers) fields.push_back(field_of(answer));
  options.write(options.text("netcdf"), netcdf_of(fields, to_json(options.provenance(scene))));
}

/// Until the error bar says enough, with the runs that a pool has already.
int predict_accurately(const Options& options, const lattice::Scene& scene,
                       const std::optional<lattice::Settled>& settled, lattice::RunPool pool,
                       const lattice::AccuracyOptions& how) {
  const std::vector<lattice::PaperStart> given = given_starts(options);
  const auto starts = entries_of(given, scene);
  const auto prediction =
      lattice::predict_pooled(lattice::problem_of(scene), pool, starts, how, options.work());
  Json json = to_json(prediction, scene, how.accuracy, !given.empty());
  if (settled) json["method"] = to_json(*settled);
  say_left_out(json, scene.field.columns, scene.field.rows);
  json["made_by"] = to_json(options.provenance(scene));
  write_netcdf(options, scene, prediction.starts, [](const lattice::StartAnswer& a) {
    return FieldArrays{FieldPicture("", a.final, a.endings, a.exits), lattice::start_at(a.start),
                       a.gates_95};
  });
  options.give_out(json, table_of(prediction, scene, !given.empty()) + method_line(settled));
  options.warn(too_few_gates(scene));
  warn_of(options, prediction, how.accuracy);
  const int exit = status_of(options, prediction.health);
  options.draw(
      [&] { return figure_of(given, prediction.starts, &lattice::StartAnswer::endings, scene); });
  return exit;
}

int predict_scene(const Options& options) {
  const std::string path = options.text("matrix");
  for (const char* other : {"scene", "row", "first-runs"})
    if (options.has(other))
      throw UsageError(path + ": is no matrix, so it is read as a scene; " +
                       (std::string_view(other) == "scene"
                            ? "a second one, \"" + options.text(other) + "\","
                            : std::string("--") + other) +
                       " has no meaning beside it");
  if (options.text("solver") != "auto")
    throw UsageError("--solver has no meaning for a scene: it is for a matrix");
  lattice::Scene scene = lattice::read_scene(path, options.overrides());
  const lattice::AccuracyOptions how = accuracy_of(options);
  (void)entries_of(given_starts(options), scene);
  require_active(options, scene);
  const auto settled = settle_method(options, scene, lattice::RunsFrom::everywhere);
  return predict_accurately(options, scene, settled, {}, how);
}

/// From the gate runs that a matrix file keeps, with first runs of starts that it does not know.
int predict_from_runs(const Options& options, const lattice::SceneMatrix& m) {
  lattice::AccuracyOptions how = accuracy_of(options);
  const std::string path = options.text("matrix");
  if (!options.has("accuracy")) how.accuracy = accuracy_of(m.file, path);
  how.per_leaf = entries_per_leaf(m.file, path);
  if (options.has("first-runs"))
    how.first_runs = options.count("first-runs", lattice::PoolRunner::kLeastTrials);
  return predict_accurately(options, m.scene, {},
                            lattice::pool_of(m.file, lattice::problem_of(m.scene), path), how);
}

}  // namespace

int run_predict(const Arguments& arguments) {
  Options options(
      "predict SCENE|MATRIX.nc [SCENE] [options]",
      "The distribution of endings and final gate. From a scene: full trials are run, and their\n"
      "gate runs pooled into a chain, until the error bar keeps --accuracy (the trials' own "
      "shares\n"
      "are the answer where they are the more certain). From a matrix with trees: the same with\n"
      "the runs that it keeps, and first runs of a start that it does not know. From a matrix of\n"
      "bins: what infinitely many walks with it would give; its intervals count that the\n"
      "matrix is a sample of gate runs, the chain's own error gatewalk validate measures.",
      "gatewalk predict scenes/field.toml --accuracy 0.01 --json prediction.json");
  options.positional(
      "matrix", "a scene (-: standard input), or a matrix file written by gatewalk build", true);
  options.positional("scene", "of a matrix: another scene; without it the matrix's own", false);
  add_accuracy(options, "0.02; that of a matrix, or half of it if it is for any start");
  options.add_count(
      "first-runs", "N",
      "matrix of trees: N first runs (16 or more) of a start that it does not know, and "
      "no other trials; 0: none, it is taken for any other of its leaf, which says "
      "little");
  add_starts(options, "the scene's start");
  options.add_texts("row", "A-B=FILE",
                    "gates of rows i_y = A to B as in another matrix of the same bins (may be "
                    "repeated)");
  options.add_text("solver", "NAME",
                   "propagate: step by step; for field.max_gates = 0 also march: row by row, and "
                   "klu: one sparse solve; auto: march without limit, else propagate",
                   "auto");
  options.add_strict();
  add_cell_program(options);
  options.output_file("netcdf", "FILE.nc", kNetcdfHelp, Options::Content::binary);
  options.add_figure("where bodies end, and how; of up to " + std::to_string(kMostPictures) +
                     " starts");
  options.reads("row", [](const std::string& rows) { return rows.substr(rows.find('=') + 1); });
  options.add_seed(
      "seed of all trials; of a matrix of bins: of the resampled matrices behind the "
      "intervals");
  if (!options.parse(arguments)) return kFine;
  if (const auto starts = options.texts("start");
      options.has("figure") && starts.size() > kMostPictures)
    throw UsageError("--figure: shows at most " + std::to_string(kMostPictures) +
                     " starts, these are " + std::to_string(starts.size()));
  if (options.has("cell-program")) return predict_program(options);
  if (!is_matrix(options.text("matrix"))) return predict_scene(options);
  if (lattice::is_of_cells(options.text("matrix"))) return predict_recorded(options);
  const std::string solver = options.text("solver"), path = options.text("matrix");
  const markov::PredictOptions how{.solver = solver_of(solver)};
  const std::vector<lattice::PaperStart> given = given_starts(options);
  const std::vector<lattice::RowMatrix> others = other_rows(options);
  const lattice::SceneMatrix m = read_matrix(options);
  require_active(options, m.scene);
  lattice::require_inside(given, m.scene);
  warn_of_range(options, m.file, path, entries_of(given, m.scene));
  const bool no_runs = options.has("first-runs") && options.count("first-runs", 0) == 0;
  if (lattice::has_runs(m.file) && others.empty() && solver == "auto" && !no_runs)
    return predict_from_runs(options, m);
  for (const char* other : {"accuracy", "gate-runs", "first-runs"})
    if (options.has(other) && !(no_runs && std::string_view(other) == "first-runs"))
      throw UsageError(std::string("--") + other + ": " + path +
                       " keeps no gate runs that could be added to (or --row, --solver, "
                       "--first-runs 0 asks for the matrix as it is)");
  const lattice::CountedField gates = lattice::field_of(m, path, others);
  std::vector<lattice::ChainStart> starts;
  for (const lattice::PaperStart& s : given)
    starts.push_back(ready_start(options, m, s.entry(), title_of(s)));
  if (given.empty())
    starts.push_back(ready_start(options, m, lattice::own_start(m.scene).entry(), "the start"));
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
  say_left_out(json, m.scene.field.columns, m.scene.field.rows);
  json["made_by"] = to_json(options.provenance(m.scene));
  std::vector<lattice::PaperStart> begun = given;
  if (begun.empty()) begun.push_back(lattice::own_start(m.scene));
  write_netcdf(options, m.scene, prediction.starts, [&](const lattice::StartPrediction& s) {
    const auto k = static_cast<std::size_t>(&s - prediction.starts.data());
    return FieldArrays{FieldPicture("", s.final, s.shares, s.exits), begun[k]};
  });
  options.give_out(json, table_of(prediction, shown));
  options.warn(too_few_gates(m.scene));
  options.remark(fixed(1e3 * prediction.seconds, 3) + " ms");
  const int exit = exit_status(options, faults_recorded(status).empty());
  options.draw([&] {
    return figure_of(given, prediction.starts, &lattice::StartPrediction::shares, m.scene);
  });
  return exit;
}

}  // namespace gatewalk::cli
