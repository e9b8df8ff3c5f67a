#include "cli/arguments.h"
#include "cli/render/choice.h"
#include "cli/render/field_figure.h"
#include "cli/render/field_netcdf.h"
#include "cli/render/final_gates.h"
#include "cli/render/json.h"
#include "cli/render/matrix.h"
#include "cli/render/pooled_prediction.h"
#include "cli/render/prediction.h"
#include "cli/render/recorded.h"
#include "cli/render/scene.h"
#include "cli/render/text.h"
#include "cli/subject.h"
#include "cli/terminal/output.h"
#include "lattice/cells/recorded_pool.h"
#include "lattice/study/prediction.h"

namespace gatewalk::cli {
namespace {

/// The file of --netcdf and the figure, if they are asked for: a map for each start.
template <class Answer>
void show(const Options& options, const Subject& s, const std::vector<Answer>& answers,
          lattice::EndingShares Answer::*shares,
          std::array<markov::CellProbabilities, 2> Answer::*gates_95 = nullptr) {
  const ShownField shown = s.shown();
  std::vector<FieldPicture> pictures;
  std::vector<FieldArrays> arrays;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    pictures.emplace_back(
        "prediction, " + std::to_string(shown.field.columns) + " x " +
            std::to_string(shown.field.rows) + (s.scene ? " gates" : " cells") +
            (s.given ? ", " + title_of(s.problem.map().section, s.starts[i]) : ""),
        answers[i].final, answers[i].*shares, answers[i].exits);
    arrays.push_back({pictures.back(), s.starts[i]});
    if (gates_95 != nullptr) arrays.back().gates_95 = answers[i].*gates_95;
  }
  if (options.has("netcdf"))
    options.write(options.text("netcdf"),
                  netcdf_of(arrays, s.problem.map().section, s.made_by(options)));
  options.draw([&] { return figure_of(pictures, shown); });
}

/// Until the error bar says enough, with the runs that there are already; of recorded runs with
/// these alone.
int predict_from_runs(const Options& options, Subject& s) {
  const lattice::PooledPrediction prediction = predict(options, s);
  const ShownField shown = s.shown();
  Json json = to_json(prediction, shown, s.how.accuracy, s.given);
  std::string table = table_of(prediction, shown, s.given) + method_line(s.settled);
  if (s.settled) json["method"] = to_json(*s.settled);
  if (s.is_recorded()) {
    const lattice::LostBounds bounds =
        lattice::lost_bounds(s.problem, *s.pool, s.starts.front(), s.how.per_leaf, options.seed());
    json["recorded"] = to_json(*s.pool);
    if (bounds.lost > 0.0) json["recorded"]["lost_bounds"] = to_json(bounds);
    table += table_of(*s.pool) + table_of(bounds);
  }
  say_left_out(json, shown.field.columns, shown.field.rows);
  json["made_by"] = s.made_by(options);
  options.give_out(json, table);
  options.warn(too_few_gates(shown));
  const int exit = status_of(options, prediction.health);
  show(options, s, prediction.starts, &lattice::StartAnswer::endings,
       &lattice::StartAnswer::gates_95);
  return exit;
}

/// What infinitely many walks with the matrix as it is would give.
int predict_from_matrix(const Options& options, const Subject& s,
                        const std::vector<lattice::RowMatrix>& others) {
  const lattice::SceneMatrix m = s.matrix();
  const std::string solver = options.text("solver");
  const lattice::CountedField gates = lattice::field_of(m, s.path, others);
  std::vector<lattice::ChainStart> starts;
  for (std::size_t k = 0; k < s.starts.size(); ++k)
    starts.push_back(ready_start(options, m, *s.starts[k], s.name_of(k)));
  if ((solver == "klu" || solver == "march") && m.scene.field.max_gates != 0)
    throw UsageError("--solver " + solver + " needs field.max_gates = 0 (no limit), it is " +
                     std::to_string(m.scene.field.max_gates));
  const auto prediction = lattice::predict(
      gates, m.scene.field, starts, {.solver = solver_of(options)}, options.seed(), options.work());
  if (prediction.failed)
    options.warn("no interval counts the sampling of the matrix: a resampled one fails: " +
                 *prediction.failed);
  const PredictedField shown{m, s.given ? s.starts : std::vector<Start>(), others};
  Json json = to_json(prediction, shown, solver);
  say_left_out(json, m.scene.field.columns, m.scene.field.rows);
  json["made_by"] = s.made_by(options);
  options.give_out(json, table_of(prediction, shown));
  options.warn(too_few_gates(m.scene));
  options.remark(fixed(1e3 * prediction.seconds, 3) + " ms");
  const int exit = exit_status(options, faults_recorded(recorded_status(m.file)).empty());
  show(options, s, prediction.starts, &lattice::StartPrediction::shares);
  return exit;
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
  (void)solver_of(options);
  Subject s = open_subject(options, "matrix");
  const bool no_runs = options.has("first-runs") && options.count("first-runs", 0) == 0,
             by_solver = options.text("solver") != "auto",
             as_it_is = !s.pool || by_solver || no_runs || options.has("row");
  // First runs that are added to those of a file, by the scene's dynamics or by a program.
  if (!s.file || s.is_recorded())
    refuse(options, {"first-runs"}, s.path + ": it is for a matrix of a scene or a cell program");
  if (!s.file || !s.scene) {
    if (no_runs) refuse(options, {"first-runs"}, s.path + ": 0 is for a matrix of a scene");
    refuse(options, {"row"}, s.path + ": it is for a matrix of a scene");
    if (by_solver)
      throw UsageError("--solver has no meaning for " + s.path + ": it is for a matrix of a scene");
  }
  if (s.file && s.scene) warn_of_range(options, *s.file, s.path, s.entries());
  if (s.file && s.scene && as_it_is) {
    const std::string why = s.path + ", which keeps no gate runs that could be added to (or " +
                            "--row, --solver, --first-runs 0 asks for the matrix as it is)";
    refuse(options, {"accuracy", "gate-runs"}, why);
    if (!no_runs) refuse(options, {"first-runs"}, why);
    return predict_from_matrix(options, s, other_rows(options));
  }
  if (options.has("first-runs"))
    s.how.first_runs = options.count("first-runs", lattice::PoolRunner::kLeastTrials);
  s.settle(options);
  return predict_from_runs(options, s);
}

}  // namespace gatewalk::cli
