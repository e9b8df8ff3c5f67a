// SPDX-License-Identifier: MIT
#include "cli/predicted.h"

#include <fmt/core.h>

#include <array>
#include <string>
#include <utility>

#include "cli/answered.h"
#include "cli/arguments.h"
#include "cli/parsers.h"
#include "cli/render/field_ends.h"
#include "cli/render/field_figure.h"
#include "cli/render/field_netcdf.h"
#include "cli/render/final_gates.h"
#include "cli/render/matrix.h"
#include "cli/render/prediction.h"
#include "cli/render/scene.h"
#include "cli/render/text.h"
#include "lattice/cells/recorded_pool.h"
#include "lattice/study/prediction.h"

namespace gatewalk::cli {
namespace {

/// Gives out the result, and warns of what its endings leave out.
template <class Answer>
void tell(const Options& options, const Subject& s, const PredictResult& result,
          const std::vector<Answer>& answers) {
  options.give_out(result, table_of(result));
  options.warn(too_few_gates(result.shown));
  for (std::size_t k = 0; k < answers.size(); ++k)
    options.warn(rest_warning(rest_of(answers[k].final), s.where(k)));
}

/// The file of --netcdf and the figure, if they are asked for: a map for each start.
template <class Answer>
void show(const Options& options, const Subject& s, const PredictResult& result,
          const std::vector<Answer>& answers, lattice::EndingShares Answer::*shares,
          std::array<markov::CellProbabilities, 2> Answer::*gates_95 = nullptr) {
  const auto& [columns, rows, max_gates, fidelity] = result.shown.field;
  std::vector<FieldPicture> pictures;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    pictures.emplace_back(
        fmt::format("prediction, {} x {} {}{}", columns, rows, s.scene ? "gates" : "cells",
                    s.given ? ", " + title_of(s.problem.map().section, s.starts[i]) : ""),
        ends_of(answers[i].final, answers[i].*shares), answers[i].exits, s.starts[i]);
    if (gates_95 != nullptr) pictures.back().gates_95 = answers[i].*gates_95;
  }
  if (options.has("netcdf"))
    options.write(options.text("netcdf"),
                  netcdf_of(pictures, s.problem.map().section, result.made_by));
  options.draw([&] { return figure_of(pictures, result.shown); });
}

PredictResult empty_result(const Options& options, const Subject& s) {
  return {.shown = s.shown(),
          .given = s.given ? s.starts : std::vector<Start>(),
          .made_by = s.provenance(options)};
}

}  // namespace

int predict_from_runs(const Options& options, Subject& s) {
  const auto of_file = runs_of_file(options, s);
  lattice::PooledPrediction made = predict(options, s);
  PredictResult result = empty_result(options, s);
  result.of_runs = {.prediction = std::move(made), .accuracy = s.how.accuracy, .method = s.settled};
  const lattice::PooledPrediction& prediction = result.of_runs->prediction;
  if (s.is_recorded())
    result.of_runs->recorded = {
        counts_of(*s.pool),
        lattice::lost_bounds(s.problem, *s.pool, s.starts.front(), s.how.per_leaf, options.seed())};
  tell(options, s, result, prediction.starts);
  const int exit = status_of(options, prediction.health);
  write_page(options, s, of_file, page_starts(prediction));
  show(options, s, result, prediction.starts, &lattice::StartAnswer::endings,
       &lattice::StartAnswer::gates_95);
  return exit;
}

int predict_from_matrix(const Options& options, const Subject& s,
                        const std::vector<lattice::RowMatrix>& others) {
  const std::string solver = options.text("solver");
  const lattice::CountedField gates =
      others.empty() ? s.counted() : lattice::field_of(s.matrix(), s.path, others);
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
        .solver = solver,
        .status = recorded_health(*s.file),
        .probabilities = gates.exact,
        .foreign = s.foreign};
  const lattice::Prediction& prediction = of.prediction;
  for (const lattice::ChainStart& start : starts)
    of.states.push_back(shown_state(start, s.file->transitions.space));
  for (const auto& [first, last, path, matrix] : others)
    of.rows.push_back(
        {first, last, path, recorded_health(*matrix.file), lattice::to_toml(matrix.scene)});
  tell(options, s, result, prediction.starts);
  options.remark(fixed(1e3 * prediction.seconds, 3) + " ms");
  const int exit = exit_status(options, faults_recorded(of.status).empty());
  write_page(options, s, s.pool, page_starts(prediction, s));
  show(options, s, result, prediction.starts, &lattice::StartPrediction::shares);
  return exit;
}

}  // namespace gatewalk::cli
