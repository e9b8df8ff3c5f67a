// SPDX-License-Identifier: MIT
#include "cli/render/design.h"

#include <algorithm>

#include "cli/render/choice.h"
#include "cli/render/final_gates.h"
#include "cli/render/health.h"
#include "cli/render/json.h"
#include "cli/render/plan.h"
#include "cli/render/start.h"
#include "cli/render/text.h"

namespace gatewalk::cli {
namespace {

constexpr std::size_t kMostListed = 40;  // changes, and rows and columns of a map, in the table
constexpr std::size_t kMostOptima = 3;   // other maps in the table

const std::string& name_of(const lattice::Scene& scene, int type) {
  return type == 0 ? scene.terrain->own
                   : scene.terrain->types[static_cast<std::size_t>(type) - 1].name;
}

/// A gate whose type is another than before.
struct Changed {
  int x, y, from, to;
};
std::vector<Changed> changes_of(const DesignedScene& d, const std::vector<int>& map) {
  const std::vector<int>& before = d.before.terrain->type_of_cell;
  std::vector<Changed> changes;
  for (std::size_t cell = 0; cell < map.size(); ++cell)
    if (map[cell] != before[cell]) {
      const auto at = static_cast<int>(cell);
      changes.push_back({at % d.before.field.columns - d.before.field.start_column(),
                         at / d.before.field.columns, before[cell], map[cell]});
    }
  return changes;
}

Json to_json(const DesignedScene& d, const std::vector<Changed>& changes) {
  Json json = Json::array();
  for (const Changed& c : changes)
    json.push_back({{"gate_x", c.x},
                    {"gate_y", c.y},
                    {"from", name_of(d.before, c.from)},
                    {"to", name_of(d.before, c.to)}});
  return json;
}

/// "(0, 2) . to s, (1, 2) s to ."
std::string changes_text(const DesignedScene& d, const std::vector<Changed>& changes) {
  std::string text;
  for (std::size_t i = 0; i < std::min(changes.size(), kMostListed); ++i) {
    const Changed& c = changes[i];
    text += (i == 0 ? "(" : ", (") + std::to_string(c.x) + ", " + std::to_string(c.y) + ") " +
            name_of(d.before, c.from) + " to " + name_of(d.before, c.to);
  }
  return changes.size() > kMostListed ? text + ", ..." : text;
}

std::string verdict(const DesignedScene& d, std::size_t changes) {
  if (changes == 0)
    return "no change that was tried in full lets bodies cross " +
           std::string(d.options.least ? "more rarely\n" : "more often\n");
  const lattice::Gain& gain = d.design.gain;
  const std::string by = gain_text(gain) + " points by " + std::to_string(changes) +
                         (changes == 1 ? " changed gate" : " changed gates");
  const bool shown = d.options.least ? gain.interval_95[1] < 0.0 : gain.interval_95[0] > 0.0;
  return by +
         (shown ? "\n" : ": not shown to be a change; a smaller --accuracy shows a smaller one\n");
}

}  // namespace

lattice::Scene with_gates(lattice::Scene scene, std::vector<int> type_of_cell) {
  scene.terrain->type_of_cell = std::move(type_of_cell);
  scene.terrain->shares.clear();  // it is given now, not drawn
  return scene;
}

std::vector<double> best_changes(const DesignedScene& d) {
  const std::size_t cells = d.before.terrain->type_of_cell.size(),
                    types = d.before.terrain->types.size() + 1;
  std::vector<double> best(cells, 0.0);
  const std::vector<double>& gradient = d.design.by_chain.gradient;
  for (std::size_t i = 0; i < gradient.size(); ++i) {
    double& of_cell = best[i / types];
    of_cell = d.options.least ? std::min(of_cell, gradient[i]) : std::max(of_cell, gradient[i]);
  }
  return best;
}

Json to_json(const DesignedScene& d) {
  const lattice::DesignedField& design = d.design;
  Json json;
  json["crossed"] = design.crossings.share();
  json["interval_95"] = design.crossings.interval_95();
  json["before"] = {{"crossed", design.before.share()},
                    {"interval_95", design.before.interval_95()}};
  json["gain"] = design.gain.difference;
  json["gain_95"] = gain_95(design.gain);
  json["trials"] = design.crossings.trials;
  json["start"] = to_json(d.section, d.start);
  json["least"] = d.options.least;
  json["most_changes"] = d.options.most_changes;
  json["become"] = Json::array();
  for (const int type : d.options.become) json["become"].push_back(name_of(d.before, type));
  json["changes"] = to_json(d, changes_of(d, design.type_of_cell));
  json["map"] = lattice::map_rows(*d.after.terrain, d.after.field);
  json["by_chain"] = {{"before", design.by_chain.before}, {"solves", design.by_chain.solves}};
  json["by_chain"]["optima"] = Json::array();
  for (const markov::FieldDesign& optimum : design.by_chain.optima)
    json["by_chain"]["optima"].push_back(
        {{"crossed", optimum.gain},
         {"searches", optimum.searches},
         {"changes", to_json(d, changes_of(d, optimum.type_of_cell))}});
  const std::vector<double> best = best_changes(d);
  markov::CellProbabilities grid_of(d.before.field.rows, d.before.field.columns);
  for (std::size_t i = 0; i < best.size(); ++i) grid_of.data()[i] = best[i];
  json["by_chain"]["best_change"] = grid(grid_of);
  if (d.method) json["method"] = to_json(*d.method);
  json["rounds"] = design.rounds;
  json["settled"] = design.settled;
  json["gate_runs"] = design.gate_runs;
  json["seconds"] = d.seconds;
  json["status"] = to_json(design.health);
  return json;
}

std::string table_of(const DesignedScene& d) {
  const lattice::DesignedField& design = d.design;
  const std::vector<Changed> changes = changes_of(d, design.type_of_cell);
  std::string table = "chance to cross: " +
                      with_interval(design.crossings.share(), design.crossings.interval_95()) +
                      " %, " + with_interval(design.before.share(), design.before.interval_95()) +
                      " % as the field is, of " + std::to_string(design.crossings.trials) +
                      " trials by which nothing was chosen\n" + verdict(d, changes.size());
  if (!changes.empty()) table += "gates: " + changes_text(d, changes) + "\n";
  const markov::Designs& chain = design.by_chain;
  table += "by the chain, with its own error: " + fixed(100.0 * chain.before, 2) +
           " % as the field is; searches, whose results are too good besides, ended at\n";
  for (std::size_t i = 0; i < std::min(chain.optima.size(), kMostOptima); ++i) {
    const std::vector<Changed> to = changes_of(d, chain.optima[i].type_of_cell);
    table += "  " + fixed(100.0 * chain.optima[i].gain, 2) + " %, " +
             std::to_string(chain.optima[i].searches) +
             " times: " + (to.empty() ? "the field as it is" : changes_text(d, to)) + "\n";
  }
  const std::vector<std::string> rows = lattice::map_rows(*d.after.terrain, d.after.field);
  if (rows.size() <= kMostListed && d.after.field.columns <= static_cast<int>(kMostListed)) {
    table += "\nthe gates, far row first:\n";
    for (const std::string& row : rows) table += "  " + row + "\n";
  }
  return table + method_line(d.method) + std::to_string(design.gate_runs) + " gate runs in " +
         std::to_string(design.rounds) + (design.rounds == 1 ? " round, " : " rounds, ") +
         std::to_string(design.by_chain.solves) + " maps solved in all, " + fixed(d.seconds, 1) +
         " s\n";
}

}  // namespace gatewalk::cli
