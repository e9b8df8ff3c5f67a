// SPDX-License-Identifier: MIT
#include "cli/predicted.h"

#include <fmt/core.h>

#include <array>
#include <string>

#include "cli/answered.h"
#include "cli/arguments.h"
#include "cli/parsers.h"
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
        fmt::format("prediction, {} x {} {}{}", shown.field.columns, shown.field.rows,
                    s.scene ? "gates" : "cells",
                    s.given ? ", " + title_of(s.problem.map().section, s.starts[i]) : ""),
        answers[i].final, answers[i].*shares, answers[i].exits);
    arrays.push_back({pictures.back(), s.starts[i]});
    if (gates_95 != nullptr) arrays.back().gates_95 = answers[i].*gates_95;
  }
  if (options.has("netcdf"))
    options.write(options.text("netcdf"),
                  netcdf_of(arrays, s.problem.map().section, s.made_by(options)));
  options.draw([&] { return figure_of(pictures, shown); });
}

}  // namespace

int predict_from_runs(const Options& options, Subject& s) {
  const auto of_file = runs_of_file(options, s);
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
  json.update(
      json_of([&](Fields& out) { describe_left_out(out, shown.field.columns, shown.field.rows); }));
  json["made_by"] = s.made_by(options);
  options.give_out(json, table);
  options.warn(too_few_gates(shown));
  for (std::size_t k = 0; k < prediction.starts.size(); ++k)
    options.warn(rest_warning(rest_of(prediction.starts[k].final), s.where(k)));
  const int exit = status_of(options, prediction.health);
  write_page(options, s, of_file, page_starts(prediction));
  show(options, s, prediction.starts, &lattice::StartAnswer::endings,
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
  const auto prediction = lattice::predict(gates, field, starts, {.solver = solver_of(options)},
                                           options.seed(), options.work());
  options.warn(text_of(prediction.left_out));
  const ShownField field_shown = s.shown();
  const PredictedField shown{*s.file, field_shown, s.given ? s.starts : std::vector<Start>(),
                             others,  gates.exact, s.foreign};
  Json json = to_json(prediction, shown, solver);
  json.update(json_of([&](Fields& out) { describe_left_out(out, field.columns, field.rows); }));
  json["made_by"] = s.made_by(options);
  options.give_out(json, table_of(prediction, shown));
  options.warn(too_few_gates(field_shown));
  for (std::size_t k = 0; k < prediction.starts.size(); ++k)
    options.warn(rest_warning(rest_of(prediction.starts[k].final), s.where(k)));
  options.remark(fixed(1e3 * prediction.seconds, 3) + " ms");
  const int exit = exit_status(options, faults_recorded(recorded_status(*s.file)).empty());
  write_page(options, s, s.pool, page_starts(prediction, s));
  show(options, s, prediction.starts, &lattice::StartPrediction::shares);
  return exit;
}

}  // namespace gatewalk::cli
