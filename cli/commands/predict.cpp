// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include <array>
#include <charconv>
#include <utility>

#include "cli/arguments.h"
#include "cli/fields/text.h"
#include "cli/next.h"
#include "cli/page.h"
#include "cli/render/field_ends.h"
#include "cli/render/field_figure.h"
#include "cli/render/field_netcdf.h"
#include "cli/render/final_gates.h"
#include "cli/render/matrix.h"
#include "cli/render/prediction.h"
#include "cli/render/scene.h"
#include "cli/source_options.h"
#include "lattice/recorded/recorded_pool.h"
#include "lattice/scene/matrix.h"
#include "lattice/source/start_text.h"
#include "lattice/study/prediction.h"

namespace gatewalk::cli {
namespace {

struct PredictCommand : Options {
  using Options::Options;
  TextOption matrix = positional(
      "matrix", "a scene (-: standard input), or a matrix file written by gatewalk build", true);
  TextOption second = second_scene();
  AskedAccuracy accuracy =
      add_accuracy(*this, "0.02; that of a matrix, or half of it if it is for any start");
  CountOption first_runs =
      add_count("first-runs", "N",
                "for a matrix of trees: simulate N runs (16 or more) through the first gate from a "
                "start that the file does not know, and no other trials; 0: none, and the row of "
                "the start's leaf is used, which is noisy");
  TextsOption start = add_starts(*this, "the scene's start");
  TextsOption row =
      add_texts("row", "A-B=FILE",
                "use another matrix of the same bins for the gates in rows i_y = A to B (may be "
                "repeated)");
  TextOption solver =
      add_text("solver", "NAME",
               "how the chain is solved: propagate (step by step), or, if field.max_gates = 0, "
               "march (row by row) or klu (one sparse solve); auto takes march without a limit, "
               "else propagate",
               "auto");
  TextOption checkpoint = add_kept();
  Option strict = add_strict();
  AskedProgram program = add_cell_program(*this);
  TextOption netcdf = output_file("netcdf", "FILE.nc", kNetcdfHelp, Options::Content::binary);
  TextOption figure =
      add_figure(fmt::format("where bodies end, and how, for up to {} starts", kMostPictures));
  TextOption page = add_page(*this);
  Option seed_given = add_seed(
      "seed of all trials; for a matrix of bins, seed of the resampled matrices that make the "
      "intervals");
  Asked asked{matrix, second, program, start, accuracy};
};

/// Reads "4-6=other.nc": the rows whose gates have another matrix.
lattice::RowMatrix parse_rows(const PredictCommand& options, const std::string& text) {
  const auto wrong = [&] {
    return UsageError(fmt::format(
        "--row {}: must be rows i_y and a matrix, e.g. 4-6=other.nc or 4=other.nc", text));
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
  return {first, last, path, read_matrix(options, path, nullptr, {})};
}

/// The rows whose gates have other matrices, as --row says. Throws UsageError.
std::vector<lattice::RowMatrix> other_rows(const PredictCommand& options) {
  std::vector<lattice::RowMatrix> rows;
  for (const std::string& text : options.row.values()) rows.push_back(parse_rows(options, text));
  return rows;
}

/// The solver that --solver names. Throws UsageError for an unknown name.
markov::PredictOptions::Solver solver_of(const PredictCommand& options) {
  using Solver = markov::PredictOptions::Solver;
  const std::string name = options.solver.value();
  if (name == "auto") return Solver::automatic;
  if (name == "propagate") return Solver::steps;
  if (name == "march") return Solver::rows;
  if (name == "klu") return Solver::klu;
  throw UsageError(fmt::format("--solver {}: must be auto, propagate, march or klu", name));
}

/// Commands to propose next.
std::vector<std::string> next_of(const PredictCommand& options, const lattice::Source& s,
                                 const PredictResult& result) {
  NextCommands next(options);
  next.keeping({"accuracy", "gate-runs", "seed"});
  if (s.is_recorded() && !s.is_imported && s.pool->bodies() >= 2 * lattice::kLeastBodies)
    next.of(options.matrix.value(), "validate", "does one half of the bodies predict the other?");
  if (s.starts.size() == 1 && !options.row)  // an analysis is of one start and one matrix
    next.add("analyze", "",
             s.file ? "times, visits of gates, and what the chain remembers"
                    : "which number of the scene matters most");
  if (result.of_runs && !s.is_recorded() && result.of_runs->prediction.reached) {
    double error = 0.0;
    for (const lattice::StartAnswer& a : result.of_runs->prediction.starts)
      error = std::max(error, a.error.total_variation);
    next.again("accuracy", digits(0.5 * error, 2), "halves the error bar of the final gates");
  }
  return next.lines();
}

/// Gives out the result, and warns of bodies that the endings leave out.
template <class Answer>
void tell(const PredictCommand& options, const lattice::Source& s, const PredictResult& result,
          const std::vector<Answer>& answers) {
  options.give_out(result,
                   {answer_text(result), details_text(result), next_of(options, s, result)});
  options.warn(too_few_gates(result.shown));
  for (std::size_t k = 0; k < answers.size(); ++k)
    options.warn(rest_warning(rest_of(answers[k].final), where(s, k)));
}

/// Writes the file of --netcdf and draws the figure, if asked for: a map for each start.
template <class Answer>
void show(const PredictCommand& options, const lattice::Source& s, const PredictResult& result,
          const std::vector<Answer>& answers, lattice::EndingShares Answer::*shares,
          std::array<markov::CellProbabilities, 2> Answer::*gates_95 = nullptr) {
  const lattice::FieldParams& field = result.shown.field;
  std::vector<FieldPicture> pictures;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    pictures.emplace_back(
        fmt::format(
            "prediction, {} x {} {}{}", field.columns, field.rows, s.scene ? "gates" : "cells",
            s.starts_given ? ", " + lattice::title_of(s.problem.map().section, s.starts[i]) : ""),
        ends_of(answers[i].final, answers[i].*shares), answers[i].exits, s.starts[i]);
    if (gates_95 != nullptr) pictures.back().gates_95 = answers[i].*gates_95;
  }
  if (options.netcdf)
    options.write(options.netcdf.value(), netcdf_of(pictures, result.shown, result.made_by));
  options.draw([&] { return figure_of(pictures, result.shown); });
}

PredictResult empty_result(const PredictCommand& options, const lattice::Source& s) {
  return {.shown = ShownField(s),
          .given = s.starts_given ? s.starts : std::vector<std::optional<dynamics::Entry>>(),
          .made_by = options.provenance(s)};
}

/// Predicts from gate runs. Unless the runs were recorded, adds runs until the prediction reaches
/// the accuracy. Returns the exit status.
int predict_from_runs(const PredictCommand& options, lattice::Source& s) {
  const auto of_file = runs_of_file(options.page, s);
  lattice::PooledPrediction made = predict(options, s);
  PredictResult result = empty_result(options, s);
  result.of_runs = {.prediction = std::move(made),
                    .accuracy = s.accuracy.accuracy,
                    .method = lattice::settled_of(s)};
  const lattice::PooledPrediction& prediction = result.of_runs->prediction;
  if (s.is_recorded())
    result.of_runs->recorded = {counts_of(*s.pool),
                                lattice::lost_bounds(s.problem, *s.pool, s.starts.front(),
                                                     s.accuracy.per_leaf, options.seed())};
  tell(options, s, result, prediction.starts);
  const int exit = status_of(options, prediction.health);
  write_page(options, options.page, s, of_file, page_answers(prediction));
  show(options, s, result, prediction.starts, &lattice::StartAnswer::endings,
       &lattice::StartAnswer::gates_95);
  return exit;
}

/// Predicts exactly, as infinitely many walks would, from a matrix without adding runs. Rows in
/// `others` have other matrices. Returns the exit status.
int predict_from_matrix(const PredictCommand& options, const lattice::Source& s,
                        const std::vector<lattice::RowMatrix>& others) {
  const std::string solver = options.solver.value();
  const lattice::CountedField gates =
      others.empty() ? lattice::counted_of(s)
                     : lattice::field_of(lattice::scene_matrix_of(s), s.path, others);
  const lattice::FieldParams& field = s.problem.field;
  std::vector<lattice::ChainStart> starts;
  const std::vector<dynamics::Transitions> matrices = s.matrices();
  for (std::size_t k = 0; k < s.starts.size(); ++k)
    starts.push_back(ready_start(options, matrices, s.problem, *s.starts[k], s.name_of(k)));
  if ((solver == "klu" || solver == "march") && field.max_gates != 0)
    throw UsageError(fmt::format("--solver {} needs field.max_gates = 0 (no limit), it is {}",
                                 solver, field.max_gates));
  auto made = lattice::predict(gates, field, starts, {.solver = solver_of(options)}, options.seed(),
                               options.work());
  options.warn(text_of(made.left_out));
  PredictResult result = empty_result(options, s);
  MatrixPrediction& of = result.of_matrix.emplace();
  of = {.prediction = std::move(made),
        .path = s.path,
        .matrix_states = s.file->transitions.space.size(),
        .solver = solver,
        .status = recorded_health(*s.file),
        .probabilities = gates.exact,
        .foreign = s.is_imported};
  const lattice::Prediction& prediction = of.prediction;
  for (const lattice::ChainStart& start : starts)
    of.states.push_back(shown_state(start, s.file->transitions.space));
  for (const auto& [first, last, path, matrix] : others)
    of.rows.push_back(
        {first, last, path, recorded_health(*matrix.file), lattice::to_toml(matrix.scene)});
  tell(options, s, result, prediction.starts);
  options.remark(fixed(1e3 * prediction.seconds, 3) + " ms");
  const int exit = exit_status(options, faults_recorded(of.status).empty());
  write_page(options, options.page, s, runs_of_file(options.page, s), page_answers(prediction, s));
  show(options, s, result, prediction.starts, &lattice::StartPrediction::shares);
  return exit;
}

}  // namespace

int run_predict(const Arguments& arguments) {
  PredictCommand options(
      "predict SCENE|MATRIX.nc [SCENE] [options]",
      "Predicts how often bodies cross the field, leave it by a side or are trapped, and in which\n"
      "gate they end, with 95 % intervals.\n\n"
      "From a scene, predict simulates trials until the error bar is as small as --accuracy asks,\n"
      "pools their runs through single gates into a Markov chain, and answers from the chain. If\n"
      "the shares of the trials are more precise than the chain, they are the answer.\n"
      "From a matrix of trees (gatewalk build), predict uses the gate runs that the file keeps. "
      "It\n"
      "adds runs only for a start that the file does not know.\n"
      "From a matrix of bins, predict gives what infinitely many walks would give. The intervals\n"
      "then count the sampling error of the matrix; gatewalk validate measures the chain's own.",
      "gatewalk predict scenes/field.toml --accuracy 0.01 --json prediction.json");
  options.reads(options.row,
                [](const std::string& rows) { return rows.substr(rows.find('=') + 1); });
  options.add_details("maps of the final gates, where bodies leave, and how the error bar is made");
  options.most_used({"accuracy", "start", "set", "figure", "json"});
  if (!options.parse(arguments)) return kFine;
  if (const auto starts = options.start.values(); options.figure && starts.size() > kMostPictures)
    throw UsageError(fmt::format("--figure: shows at most {} starts, these are {}", kMostPictures,
                                 starts.size()));
  (void)solver_of(options);
  lattice::Source s = open_source(options, options.asked);
  if (options.page) refuse({options.row}, "beside --page");
  check_page(options.page, s);
  const bool no_runs = options.first_runs && options.first_runs.value(0) == 0,
             by_solver = options.solver.value() != "auto",
             as_it_is = !s.pool || by_solver || no_runs || options.row;
  // The scene's dynamics, or a program, add first runs to those of a file.
  if (!s.file || s.is_recorded() || (s.cells && no_runs))
    refuse({options.first_runs},
           fmt::format("for {}: it is for a matrix of a scene, or (above 0) of a cell program",
                       s.path));
  if (!s.file || (!s.scene && !s.is_imported)) {
    refuse({options.row}, fmt::format("for {}: it is for a matrix of a scene", s.path));
    if (by_solver)
      throw UsageError(
          fmt::format("--solver has no meaning for {}: it is for a matrix of a scene", s.path));
  }
  if (s.is_imported)
    refuse({options.row}, fmt::format("for {}: it is for a matrix of a scene", s.path));
  if (s.file && s.scene) warn_of_range(options, *s.file, s.path, s.entries());
  if (s.file && (s.is_imported || (s.scene && as_it_is))) {
    const std::string why = fmt::format(
        "for {}, which keeps no gate runs that could be added to (or --row, --solver, --first-runs "
        "0 asks for the matrix as it is)",
        s.path);
    refuse({options.accuracy.accuracy, options.accuracy.gate_runs}, why);
    if (!no_runs) refuse({options.first_runs}, why);
    return predict_from_matrix(options, s, other_rows(options));
  }
  if (options.first_runs)
    s.accuracy.first_runs = options.first_runs.value(lattice::PoolRunner::kLeastTrials);
  choose_method(options, s);
  return predict_from_runs(options, s);
}

}  // namespace gatewalk::cli
