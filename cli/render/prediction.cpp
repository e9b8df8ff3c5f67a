// SPDX-License-Identifier: MIT
#include "cli/render/prediction.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "cli/fields/text.h"
#include "cli/render/exits.h"
#include "cli/render/field_ends.h"
#include "cli/render/final_gates.h"
#include "cli/render/health.h"
#include "cli/render/matrix.h"
#include "cli/render/scene.h"
#include "lattice/source/start_text.h"

namespace gatewalk::cli {
namespace {

/// Describes the prediction for one start.
void describe(Fields& out, const lattice::StartPrediction& s, const ShownField& shown) {
  const markov::FinalDistribution& f = s.final;
  const auto ends = ends_of(f, s.shares);
  ends.describe_endings(out);
  out.object(
      {"matrix_sampling", "sampling error of the prediction, from resampled matrices"},
      [&](Fields& m) {
        m.count({"replicates", "1", "number of predictions from resampled matrices"}, s.replicates);
        m.number({"total_variation_mean", "1",
                  "mean total variation between their final gates and this prediction's; null: no "
                  "replicates"},
                 s.mean_total_variation);
        m.number({"total_variation_q95", "1",
                  "95 % of these total variations are at most this; null: no replicates"},
                 s.total_variation_95);
      });
  ends.describe_gates(out);
  ends.describe_sums(out);
  ends.describe_never_sampled(out);
  describe_exits(out, shown_exits(s.exits, f), shown);
  ends.describe_still_walking(out);
  out.number({"rounding_at_most", "1", "upper bound of the rounding error of all shares together"},
             f.rounding);
  out.number({"error_at_most", "1",
              "upper bound of the error of all shares from rounding and unfinished walks together"},
             f.remainder + f.rounding);
  out.count({"steps", "1", "propagation steps; 0: a linear solve instead"}, f.steps);
}

/// What the intervals of a matrix's answer include, or why there are none.
std::string intervals_text(const MatrixPrediction& of) {
  const lattice::StartPrediction& s = of.prediction.starts.front();
  if (std::isnan(s.shares.interval.front().front()))
    return of.probabilities
               ? "Without intervals: the matrix holds probabilities, not counts.\n"
               : "Without intervals: the field is too large for many predictions, rows have few "
                 "runs each,\nor resampled matrices fail.\n";
  return s.replicates == 0
             ? "The 95 % intervals count the walks that were not followed to an end.\n"
             : "The 95 % intervals count the sampling error of the matrix.\n";
}

std::string answer_text(const MatrixPrediction& of) {
  std::string text =
      fmt::format("From the matrix {} of {} states: the limit of infinitely many walks.\n{}",
                  of.path, of.matrix_states, intervals_text(of));
  if (!of.foreign)
    text +=
        "Beware: the chain's own error is left out. gatewalk validate SCENE --matrix FILE measures "
        "it.\n";
  return of.foreign ? text : text + beware_of_recorded(of.status);
}

std::string details_text(const lattice::StartPrediction& s, const std::string& bin,
                         const ShownField& shown) {
  const markov::FinalDistribution& f = s.final;
  return ends_of(f, s.shares).maps(shown.field, "% of all bodies") +
         table_of(shown_exits(s.exits, f), shown) +
         fmt::format(
             "State of the chain at the start: {}\n{}"
             "Rounding and unfinished walks change all shares together by at most {}.\n",
             bin, rest_text(rest_of(f)), digits(f.remainder + f.rounding, 2));
}

/// `describe_one` is called with the number of a start.
template <class Describe>
void describe_starts(Fields& out, const PredictResult& r, Describe describe_one) {
  out.optional(r.given.empty(), [&](Fields& f) { describe_one(f, 0); });
  out.optional(!r.given.empty(), [&](Fields& f) {
    f.list_of({"starts", "prediction for each --start"}, r.given.size(),
              [&](Fields& one, std::size_t k) {
                describe_start(one, r.shown.map.section, r.given[k]);
                describe_one(one, k);
              });
  });
}

void describe_status_of_matrix(Fields& out, const std::optional<dynamics::Health>& status) {
  out.maybe(
      Label("matrix_status", "numerical faults of the runs behind the matrix; null: not on record")
          .shared("status"),
      status, [](Fields& f, const dynamics::Health& h) { cli::describe(f, h); });
}

void describe(Fields& out, const MatrixPrediction& m, const PredictResult& r) {
  const bool given = !r.given.empty();
  const auto state_in_list = [&](Fields& f, std::size_t k) {
    f.optional(given, [&](Fields& s) { describe_start_state(s, m.states[k]); });
  };
  out.count({"left_out_matrices", "1",
             "resampled matrices left out of the intervals because bodies circle too long in them"},
            m.prediction.left_out.matrices);
  describe_starts(out, r, [&](Fields& f, std::size_t k) {
    describe(f, m.prediction.starts[k], r.shown);
    state_in_list(f, k);
  });
  out.text(Label("solver", "method for the sum over all walks, as given by --solver")
               .one_of({"auto", "propagate", "march", "klu"}),
           m.solver);
  out.optional(!given, [&](Fields& f) { describe_start_state(f, m.states.front()); });
  describe_status_of_matrix(out, m.status);
  out.optional(!m.rows.empty(), [&](Fields& f) {
    f.list({"rows", "rows of gates that have another matrix, a range each"}, m.rows,
           [](Fields& row, const OtherRows& o) {
             row.count({"first", "1", "i_y of the first row of the range"}, o.first);
             row.count({"last", "1", "i_y of the last row of the range"}, o.last);
             row.text({"matrix", "path of the matrix file of these rows"}, o.matrix);
             describe_status_of_matrix(row, o.status);
             row.text({"scene", "scene of this matrix, as TOML"}, o.scene);
           });
  });
}

}  // namespace

void describe(Fields& out, const PredictResult& r) {
  out.either(
      r.of_matrix.has_value(), [&](Fields& f) { describe(f, *r.of_matrix, r); },
      [&](Fields& f) {
        describe_starts(f, r, [&](Fields& one, std::size_t k) {
          describe(one, r.of_runs->prediction.starts[k], r.shown);
        });
        describe(f, *r.of_runs, !r.given.empty());
      });
  describe_left_out(out, r.shown.field.columns, r.shown.field.rows);
  describe_made_by(out, r.made_by);
}

namespace {

/// For each start, its title (if starts were given) and the text of `text_of`.
template <class Text>
std::string by_start(const PredictResult& r, Text text_of) {
  std::string text;
  const std::size_t starts = std::max<std::size_t>(1, r.given.size());
  for (std::size_t k = 0; k < starts; ++k) {
    if (!r.given.empty()) text += lattice::title_of(r.shown.map.section, r.given[k]) + "\n";
    text += text_of(k);
  }
  return text;
}

}  // namespace

std::string answer_text(const PredictResult& r) {
  return by_start(r,
                  [&](std::size_t k) {
                    if (r.of_runs) return answer_text(r.of_runs->prediction.starts[k]);
                    const lattice::StartPrediction& s = r.of_matrix->prediction.starts[k];
                    return endings_text(ends_of(s.final, s.shares).shares, "",
                                        impossible_endings(r.shown));
                  }) +
         unequal_sides(r.shown) + (r.of_runs ? answer_text(*r.of_runs) : answer_text(*r.of_matrix));
}

std::string details_text(const PredictResult& r) {
  std::string text = "\n" + limits_text(r.shown) + by_start(r, [&](std::size_t k) {
                       return r.of_runs ? details_text(r.of_runs->prediction.starts[k], r.shown)
                                        : details_text(r.of_matrix->prediction.starts[k],
                                                       r.of_matrix->states[k].bin, r.shown);
                     });
  if (r.of_runs) return text + details_text(*r.of_runs);
  if (!r.of_matrix->foreign)
    text +=
        "The chain's own error comes from the size of its states, from memory across gates, and,\n"
        "with bins from a pilot, from where its rows start. No interval above counts it.\n";
  for (const OtherRows& o : r.of_matrix->rows)
    text += fmt::format("Rows {} to {} have the gates of {}.\n", o.first, o.last, o.matrix);
  return text;
}

std::string text_of(const lattice::LeftOut& left_out) {
  if (left_out.matrices == 0) return "";
  return fmt::format("{}{} of {} resampled matrices: {}",
                     left_out.too_many() ? "no interval counts the matrix's sampling error: failed "
                                         : "intervals leave out ",
                     left_out.matrices, left_out.of, left_out.why);
}

}  // namespace gatewalk::cli
