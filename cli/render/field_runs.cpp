// SPDX-License-Identifier: MIT
#include "cli/render/field_runs.h"

#include <fmt/core.h>

#include "cli/fields/text.h"
#include "cli/render/costs.h"
#include "cli/render/exits.h"
#include "cli/render/field_ends.h"
#include "cli/render/health.h"
#include "cli/render/matrix.h"
#include "cli/render/scene.h"
#include "dynamics/base/share.h"
#include "lattice/source/start_text.h"

namespace gatewalk::cli {
namespace {

/// The 95 % interval of walks under way; 0 with a limit of gates, which ends every walk.
Interval still_walking_95(const markov::WalkTally& tally, const lattice::FieldParams& field) {
  if (field.max_gates > 0) return {0.0, 0.0};
  return dynamics::share_interval(tally.still_walking, tally.walks);
}

}  // namespace

void describe(Fields& out, const FieldRun& run) {
  const lattice::FieldTally& tally = run.tally;
  const auto ends = ends_of(tally, run.shown.field);
  ends.describe_endings(out);
  ends.describe_gates(out);
  describe_left_out(out, run.shown.field.columns, run.shown.field.rows);
  out.count({"trials", "1", "number of trials through the field"}, tally.trials);
  ends.describe_sums(out, true);
  out.count({"not_finite", "1", "number of trials with a run that stopped being finite numbers"},
            tally.broken());
  out.object(
      {"entries_between_gates", "entries into gates after a body's first one, by face"},
      [&](Fields& faces) {
        for (std::size_t f = 0; f < run.shown.map.section.faces.size(); ++f)
          faces.object(
              Label(run.shown.map.section.faces[f].name, "entries through this face")
                  .varying("<face>"),
              [&](Fields& face) {
                face.count({"count", "1", "number of entries through this face"}, tally.entries[f]);
                face.optional(run.scene.has_value(), [&](Fields& of_scene) {
                  of_scene.count({"outside_bins", "1",
                                  "number of entries through this face that lie outside all bins"},
                                 tally.clamped[f]);
                });
              });
      });
  out.optional(run.scene.has_value(), [&](Fields& f) {
    f.text(Label("bins", "which bins outside_bins counts by: the scene's or the paper's")
               .one_of({"scene", "paper"}),
           run.scene && run.scene->scene.bins ? "scene" : "paper");
  });
  describe_method(out, run.scene ? run.scene->settled : std::nullopt);
  describe_status(out, tally.health);
  describe_exits(out, exits_of(run.tally), run.shown);
  describe_costs(out, run.costs, run.shown);
  out.optional(!run.may_do.actions.empty(), [&](Fields& f) {
    f.texts({"actions", "under a policy: names of the actions among which bodies choose"},
            run.may_do.actions);
    describe_methods(f, run.may_do);
  });
  describe_made_by(out, run.made_by);
}

std::string answer_text(const FieldRun& run) {
  return endings_text(ends_of(run.tally, run.shown.field).shares) + unequal_sides(run.shown) +
         fmt::format(
             "From {} of the full dynamics{}. The 95 % intervals count their sampling error.\n",
             counted(run.tally.trials, "trial", "trials"),
             run.may_do.actions.empty() ? "" : " under the policy");
}

std::string details_text(const FieldRun& run) {
  const lattice::FieldTally& tally = run.tally;
  std::string text = "\n" + limits_text(run.shown) +
                     ends_of(tally, run.shown.field).maps(run.shown.field, "% of trials") +
                     table_of(exits_of(tally), run.shown) + table_of(run.costs, run.shown);
  if (tally.broken() > 0)
    text += fmt::format(
        "Trials with a run that stopped being finite numbers: {}\n",
        percent(static_cast<double>(tally.broken()), static_cast<double>(tally.trials), 4));
  if (run.scene) text += scene_line(run.scene->scene) + method_line(run.scene->settled);
  return text + method_lines(run.may_do);
}

Rest rest_of(const markov::WalkTally& tally) {
  const auto n = static_cast<double>(tally.walks);
  return {static_cast<double>(tally.unsampled()) / n, static_cast<double>(tally.still_walking) / n,
          fmt::format("after {} gates, where walks are stopped", markov::Walker::kMostCells)};
}

void describe(Fields& out, const WalkResult& r) {
  const auto ends = ends_of(r.tally, r.shown.field);
  ends.describe_endings(out);
  ends.describe_gates(out);
  describe_left_out(out, r.shown.field.columns, r.shown.field.rows);
  out.count({"walks", "1", "number of walks through the field"}, r.tally.walks);
  ends.describe_sums(out);
  ends.describe_never_sampled(out);
  ends.describe_still_walking(out, still_walking_95(r.tally, r.shown.field));
  out.count({"gates_visited", "1", "number of gates visited by all walks together"}, r.tally.steps);
  const bool as_seen = !r.state && !r.start;
  out.object_or_text(
      {"start_state",
       "state in which walks start; recorded runs: their start, or \"as seen\" for all first "
       "entries"},
      as_seen ? std::optional<std::string>("as seen") : std::nullopt, [&](Fields& f) {
        f.optional(r.state.has_value(),
                   [&](Fields& of_chain) { describe(of_chain, r.state.value_or(ShownState())); });
        f.optional(r.start.has_value(), [&](Fields& recorded) {
          describe(recorded, r.shown.map.section, r.start.value_or(dynamics::Entry()));
        });
      });
  out.maybe(Label("matrix_status",
                  "numerical faults of the runs behind the matrix; null: none are "
                  "on record")
                .shared("status"),
            r.matrix_status, [](Fields& f, const dynamics::Health& h) { describe(f, h); });
  describe_made_by(out, r.made_by);
}

std::string answer_text(const WalkResult& r) {
  return endings_text(ends_of(r.tally, r.shown.field).shares, "", impossible_endings(r.shown)) +
         fmt::format("From {} through the chain.\n", counted(r.tally.walks, "walk", "walks")) +
         wrapped(std::string("Beware: the 95 % intervals count the sampling error of the walks "
                             "alone. gatewalk predict adds that of the matrix.") +
                 (r.foreign ? "" : " gatewalk validate measures the chain's own error.")) +
         (r.foreign ? "" : beware_of_recorded(r.matrix_status));
}

std::string details_text(const WalkResult& r) {
  const markov::WalkTally& tally = r.tally;
  const auto n = static_cast<double>(tally.walks);
  const std::string start =
      r.state ? "start: " + r.state->bin : lattice::title_of(r.shown.map.section, r.start);
  std::string text =
      fmt::format("\n{}{}State of the chain at the {}\n", limits_text(r.shown),
                  ends_of(tally, r.shown.field).maps(r.shown.field, "% of walks"), start);
  if (tally.unsampled() > 0)
    text += fmt::format("Walks that reach a state without any run: {}\n",
                        percent(static_cast<double>(tally.unsampled()), n, 4));
  if (tally.still_walking > 0)
    text += fmt::format("Walks stopped after {} gates, still walking: {} %\n",
                        markov::Walker::kMostCells,
                        with_interval(static_cast<double>(tally.still_walking) / n,
                                      still_walking_95(tally, r.shown.field)));
  return text;
}

}  // namespace gatewalk::cli
