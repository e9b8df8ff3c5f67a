// SPDX-License-Identifier: MIT
#include "cli/render/prediction.h"

#include <algorithm>
#include <cmath>

#include "cli/render/exits.h"
#include "cli/render/final_gates.h"
#include "cli/render/json.h"
#include "cli/render/matrix.h"
#include "cli/render/scene.h"
#include "cli/render/start.h"
#include "cli/render/text.h"

namespace gatewalk::cli {
namespace {

/// What is predicted for one start.
void add_to(Json& json, const lattice::StartPrediction& s, const ShownField& shown_field) {
  const markov::FinalDistribution& f = s.final;
  const lattice::EndingShares shown = shown_endings(s.shares, f);
  json["endings"] = endings(shown.share);
  json["endings_95"] = endings_95(shown);
  json["matrix_sampling"] = {{"replicates", s.replicates},
                             {"total_variation_mean", s.mean_total_variation},
                             {"total_variation_95", s.total_variation_95}};
  json.update(json_of([&](Fields& out) { describe_final_gates(out, f); }));
  json["exits"] = cli::to_json(shown_exits(s.exits, f), shown_field);
  json["still_walking"] = f.remainder;
  json["rounding_at_most"] = f.rounding;
  json["error_at_most"] = f.remainder + f.rounding;
  json["steps"] = f.steps;
}

std::string table_of(const lattice::StartPrediction& s, const PredictedField& of) {
  const markov::FinalDistribution& f = s.final;
  const lattice::EndingShares shares = shown_endings(s.shares, f);
  const bool intervals = !std::isnan(shares.interval.front().front());
  const dynamics::StateSpace& space = of.matrix.transitions.space;
  std::string table =
      endings_text(shares,
                   intervals && s.replicates == 0
                       ? "of all walks, and what they may be, as some were not followed to an end"
                   : intervals ? "of all walks, 95 % intervals for the sampling of the matrix"
                   : of.probabilities
                       ? "of all walks; no intervals: the matrix holds probabilities, not counts"
                       : "of all walks; no intervals: the field is too large for many predictions, "
                         "rows have few runs each, "
                         "or resampled matrices fail") +
      limits_text(of.shown) + map_of(f.final_cells) + map_of_trapped(markov::trapped_cells(f)) +
      "departed " + percent(f.left_field, 1.0, 2) + "\n" +
      cli::table_of(shown_exits(s.exits, f), of.shown) +
      "start: " + text_of(space.section(), space.range(s.start.start.input)) + "\n";
  return table + rest_text(rest_of(f)) +
         (of.foreign
              ? ""
              : "The chain's own error (bins, memory, and with bins from a pilot where its rows "
                "start) is not in the intervals:\n"
                "gatewalk validate measures it.\n") +
         "Rounding and walks not finished, which are not the error of the prediction: at most " +
         digits(f.remainder + f.rounding, 2) + " in all shares together\n";
}

}  // namespace

Json to_json(const lattice::Prediction& prediction, const PredictedField& of,
             const std::string& solver) {
  const dynamics::StateSpace& space = of.matrix.transitions.space;
  Json json;
  json["left_out_matrices"] = prediction.left_out.matrices;
  if (of.starts.empty()) add_to(json, prediction.starts.front(), of.shown);
  for (std::size_t k = 0; k < of.starts.size(); ++k) {
    Json one;
    one["start"] = to_json(space.section(), of.starts[k]);
    add_to(one, prediction.starts[k], of.shown);
    one["start_state"] = to_json(prediction.starts[k].start, space);
    json["starts"].push_back(std::move(one));
  }
  json["solver"] = solver;
  if (of.starts.empty()) json["start_state"] = to_json(prediction.starts.front().start, space);
  json["matrix_status"] = recorded_status(of.matrix);
  for (const lattice::RowMatrix& o : of.other_rows)
    json["rows"].push_back({{"first", o.first},
                            {"last", o.last},
                            {"matrix", o.path},
                            {"matrix_status", recorded_status(*o.matrix.file)},
                            {"scene", lattice::to_toml(o.matrix.scene)}});
  return json;
}

std::string table_of(const lattice::Prediction& prediction, const PredictedField& of) {
  std::string table;
  if (of.starts.empty()) table = table_of(prediction.starts.front(), of);
  for (std::size_t k = 0; k < of.starts.size(); ++k)
    table += (k > 0 ? "\n" : "") + title_of(of.matrix.transitions.space.section(), of.starts[k]) +
             "\n" + table_of(prediction.starts[k], of);
  for (const lattice::RowMatrix& o : of.other_rows)
    table += "rows " + std::to_string(o.first) + " to " + std::to_string(o.last) + ": gates of " +
             o.path + "\n";
  return table;
}

std::string text_of(const lattice::LeftOut& left_out) {
  if (left_out.matrices == 0) return "";
  return (left_out.too_many() ? "no interval counts the sampling of the matrix: failed "
                              : "intervals leave out ") +
         std::to_string(left_out.matrices) + " of " + std::to_string(left_out.of) +
         " resampled matrices: " + left_out.why;
}

}  // namespace gatewalk::cli
