// SPDX-License-Identifier: MIT
#include "cli/render/field_runs.h"

#include "cli/render/choice.h"
#include "cli/render/final_gates.h"
#include "cli/render/health.h"
#include "cli/render/json.h"
#include "cli/render/scene.h"
#include "cli/render/start.h"
#include "cli/render/text.h"
#include "dynamics/base/share.h"

namespace gatewalk::cli {

using dynamics::share_interval;

namespace {

/// A limit of gates ends every walk.
std::array<double, 2> still_walking_95(const markov::WalkTally& tally,
                                       const lattice::FieldParams& field) {
  if (field.max_gates > 0) return {0.0, 0.0};
  return share_interval(tally.still_walking, tally.walks);
}

/// Those who still walk may end in any way: the upper limits count them.
lattice::EndingShares shares_of(const markov::WalkTally& tally, const lattice::FieldParams& field) {
  lattice::EndingShares shares(tally.endings, tally.walks);
  for (std::size_t e = 0; e < markov::kEndings; ++e)
    shares.interval[e][1] = share_interval(tally.endings[e] + tally.still_walking, tally.walks)[1];
  return shares.with_limit(field.max_gates);
}

}  // namespace

Json to_json(const lattice::FieldTally& tally, const ShownField& shown,
             const std::optional<RunScene>& run) {
  const auto shares =
      lattice::EndingShares(tally.endings, tally.trials).with_limit(shown.field.max_gates);
  Json json;
  json["endings"] = endings(tally.endings);
  json["endings_95"] = endings_95(shares);
  json.update(json_of([&](Fields& out) {
    describe_gates(out, tally.final_gates, tally.trapped_gates, tally.departed_gates);
    describe_left_out(out, shown.field.columns, shown.field.rows);
  }));
  json["trials"] = tally.trials;
  json["trapped"] = tally.trapped;
  json["departed"] = tally.left_field;
  json["cut_off"] = tally.cut_off;
  json["not_finite"] = tally.broken;
  json["intervals_95"] = {
      {"trapped", share_interval(tally.trapped, tally.trials)},
      {"departed", share_interval(tally.left_field, tally.trials)},
      {"cut_off", shares.interval[static_cast<std::size_t>(markov::Ending::cut_off)]}};
  Json entries;
  const auto& faces = shown.map.section.faces;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    entries[faces[f].name]["count"] = tally.entries[f];
    if (run) entries[faces[f].name]["outside_bins"] = tally.clamped[f];
  }
  json["entries_between_gates"] = std::move(entries);
  if (run) json["bins"] = run->scene.bins ? "scene" : "paper";  // what outside_bins counts by
  if (run && run->settled) json["method"] = to_json(*run->settled);
  json["status"] = to_json(tally.health);
  return json;
}

std::string table_of(const lattice::FieldTally& tally, const ShownField& shown,
                     const std::optional<RunScene>& run) {
  const auto n = static_cast<double>(tally.trials);
  std::string table =
      endings_text(
          lattice::EndingShares(tally.endings, tally.trials).with_limit(shown.field.max_gates),
          "of " + std::to_string(tally.trials) + " trials, 95 % intervals") +
      limits_text(shown) + (run ? scene_line(run->scene) : "") +
      map_of(tally.final_gates.cast<double>() / n) +
      map_of_trapped(tally.trapped_gates.cast<double>() / n) + "departed " +
      percent(static_cast<double>(tally.left_field), n, 2) + "\n";
  if (tally.broken > 0)
    table +=
        "stopped being finite numbers: " + percent(static_cast<double>(tally.broken), n, 4) + "\n";
  return table + (run ? method_line(run->settled) : "");
}

Rest rest_of(const markov::WalkTally& tally) {
  const auto n = static_cast<double>(tally.walks);
  return {static_cast<double>(tally.unsampled) / n, static_cast<double>(tally.still_walking) / n,
          "after " + std::to_string(markov::Walker::kMostCells) +
              " gates, the most that a walk is followed where field.max_gates = 0 sets no limit"};
}

Json to_json(const ShownWalks& walks, const ShownField& shown) {
  const markov::WalkTally& tally = walks.tally;
  Json json;
  json["endings"] = endings(tally.endings);
  json["endings_95"] = endings_95(shares_of(tally, shown.field));
  json.update(json_of([&](Fields& out) {
    describe_gates(out, tally.final_cells, tally.trapped_cells, tally.departed_cells);
    describe_left_out(out, shown.field.columns, shown.field.rows);
  }));
  json["walks"] = tally.walks;
  json["trapped"] = tally.trapped;
  json["departed"] = tally.left_field;
  json["cut_off"] = tally.cut_off;
  json["never_sampled"] = tally.unsampled;
  json["still_walking"] = tally.still_walking;
  json["still_walking_95"] = still_walking_95(tally, shown.field);
  json["gates_visited"] = tally.steps;
  json["start_state"] = walks.start_state;
  return json;
}

std::string table_of(const ShownWalks& walks, const ShownField& shown) {
  const markov::WalkTally& tally = walks.tally;
  const auto n = static_cast<double>(tally.walks);
  std::string table =
      endings_text(shares_of(tally, shown.field),
                   "of " + std::to_string(tally.walks) + " walks, 95 % intervals") +
      limits_text(shown) + map_of(tally.final_cells.cast<double>() / n) +
      map_of_trapped(tally.trapped_cells.cast<double>() / n) + "departed " +
      percent(static_cast<double>(tally.left_field), n, 2) + "\nstart: " + walks.start +
      "\nThe intervals count chance in the walks alone: that of the matrix gatewalk predict has" +
      (walks.foreign ? ".\n"
                     : ", the chain's own error (bins, memory) gatewalk validate measures.\n");
  if (tally.unsampled > 0)
    table += "reach a state never sampled: " + percent(static_cast<double>(tally.unsampled), n, 4) +
             "\n";
  if (tally.still_walking > 0)
    table += "still walking after " + std::to_string(markov::Walker::kMostCells) +
             " gates, where walks are stopped: " +
             with_interval(static_cast<double>(tally.still_walking) / n,
                           still_walking_95(tally, shown.field)) +
             " %\n";
  return table;
}

}  // namespace gatewalk::cli
