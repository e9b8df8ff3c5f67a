// SPDX-License-Identifier: MIT
#include "cli/render/design.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/fields/text.h"
#include "cli/render/choice.h"
#include "cli/render/crossings.h"
#include "cli/render/field_figure.h"
#include "cli/render/final_gates.h"
#include "cli/render/shown_field.h"
#include "cli/render/start.h"
#include "cli/render/type_marks.h"
#include "lattice/scene/terrain.h"

namespace gatewalk::cli {
namespace {

constexpr std::size_t kMostListed = 12;  // changes on the screen
constexpr std::size_t kMostOptima = 3;   // other maps in the table

const std::string& name_of(const lattice::Scene& scene, int type) {
  return type == 0 ? scene.terrain->own
                   : scene.terrain->types[static_cast<std::size_t>(type) - 1].name;
}

/// A gate whose type was changed.
struct Changed {
  int x = 0, y = 0, from = 0, to = 0;
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

void describe_changes(Fields& out, const DesignedScene& d, std::string_view meaning,
                      const std::vector<int>& map) {
  out.list({"changes", meaning}, changes_of(d, map), [&](Fields& gate, const Changed& c) {
    gate.count(
        {"gate_x", "1", "column of the gate: 0 is the start's, columns to its left are negative"},
        c.x);
    gate.count({"gate_y", "1", "row of the gate: 0 is the near row"}, c.y);
    gate.text({"from", "type of the gate before the change"}, name_of(d.before, c.from));
    gate.text({"to", "type of the gate after the change"}, name_of(d.before, c.to));
  });
}

/// "(0, 2) . to s, (1, 2) s to ."
std::string changes_text(const DesignedScene& d, const std::vector<Changed>& changes) {
  std::vector<std::string> listed;
  for (const Changed& c : changes)
    if (listed.size() < kMostListed)
      listed.push_back(fmt::format("({}, {}) {} to {}", c.x, c.y, name_of(d.before, c.from),
                                   name_of(d.before, c.to)));
  return fmt::format("{}{}", fmt::join(listed, ", "), changes.size() > kMostListed ? ", ..." : "");
}

std::string gain_verdict(const DesignedScene& d, std::size_t changes) {
  if (changes == 0)
    return fmt::format("No change that was simulated in full lets bodies cross more {}.\n",
                       d.options.least ? "rarely" : "often");
  const lattice::Gain& gain = d.design.gain;
  const bool shown = d.options.least ? gain.interval_95[1] < 0.0 : gain.interval_95[0] > 0.0;
  return wrapped(fmt::format(
      "{} the chance by {} points.{}",
      counted(static_cast<std::int64_t>(changes), "changed gate changes", "changed gates change"),
      gain_text(gain),
      shown ? ""
            : " This is not shown to be more than chance; a smaller --accuracy can show a smaller "
              "gain."));
}

}  // namespace

lattice::Scene with_gates(lattice::Scene scene, std::vector<int> type_of_cell) {
  scene.terrain->type_of_cell = std::move(type_of_cell);
  scene.terrain->shares.clear();  // the map is given now, not drawn at random
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

void describe(Fields& out, const DesignedScene& d) {
  const lattice::DesignedField& design = d.design;
  describe_crossed(out,
                   "share of new trials, not used in the search, that crossed the changed field",
                   design.crossings);
  out.object(
      {"before", "the field before the change, with the same random numbers"}, [&](Fields& before) {
        describe_crossed(before, "share of new trials that crossed the field before the change",
                         design.before);
      });
  describe_gain(
      out, "difference of the shares that crossed: changed field minus field before the change",
      design.gain);
  out.count({"trials", "1", "number of new trials in each of the two fields"},
            design.crossings.trials);
  describe_start(out, d.section, d.start);
  out.flag({"least", "whether the aim was that as few bodies as possible cross"}, d.options.least);
  out.count({"most_changes", "1", "largest number of gates that could be changed"},
            d.options.most_changes);
  std::vector<std::string> become;
  for (const int type : d.options.become) become.push_back(name_of(d.before, type));
  out.texts({"become", "types to which gates could be changed; empty: all types"}, become);
  describe_changes(out, d, "the gates that are changed", design.type_of_cell);
  out.texts({"map", "terrain.map of the changed field, the far row first"},
            lattice::map_rows(*d.after.terrain, d.after.field));
  const std::vector<double> best = best_changes(d);
  const markov::CellProbabilities best_change = by_gate(best.data(), d.before.field);
  out.object(
      {"by_chain", "predictions of the chain that chose the map, which have the chain's own error"},
      [&](Fields& chain) {
        const markov::Designs& all = design.by_chain;
        chain.number(
            {"before", "1",
             "chance to cross the field before the change, by the chain with the largest leaves"},
            all.before);
        chain.count(
            {"solves", "1", "number of maps for which the chain was solved in all searches"},
            all.solves);
        chain.list({"optima", "maps at which searches ended, the best first"}, all.optima,
                   [&](Fields& map, const markov::FieldDesign& optimum) {
                     map.number({"crossed", "1",
                                 "chance to cross this map by the chain, biased to the aim: "
                                 "searches exploit the chain's sampling error"},
                                optimum.gain);
                     map.count({"searches", "1", "number of searches that ended at this map"},
                               optimum.searches);
                     describe_changes(map, d, "the gates that are changed in this map",
                                      optimum.type_of_cell);
                   });
        chain.grid({"best_change", "1",
                    "change of the chance to cross by the best change of each gate alone, to first "
                    "order; 0 if nobody comes"},
                   best_change);
      });
  describe_method(out, d.method);
  describe_search(out, design, d.seconds);
  describe_made_by(out, d.made_by);
}

std::string answer_text(const DesignedScene& d) {
  const lattice::DesignedField& design = d.design;
  const std::vector<Changed> changes = changes_of(d, design.type_of_cell);
  std::string text =
      chance_text(design.crossings, " the changed field") +
      fmt::format("The field as it is: {} % in as many trials.\n",
                  with_interval(design.before.share(), design.before.interval_95())) +
      gain_verdict(d, changes.size());
  if (!changes.empty())
    text +=
        wrapped(fmt::format("Gates to change, as (i_x, i_y): {}.", changes_text(d, changes)), "  ");
  text += basis_text(design);
  const std::vector<std::string> rows = lattice::map_rows(*d.after.terrain, d.after.field);
  if (d.after.field.rows <= kMostPrinted && d.after.field.columns <= kMostPrinted)
    text += fmt::format("Types of all gates after the change, far row first:\n  {}\n",
                        fmt::join(rows, "\n  "));
  return text;
}

std::string details_text(const DesignedScene& d) {
  const markov::Designs& chain = d.design.by_chain;
  std::string text = fmt::format(
      "\nThe chain that guided the search has errors of its own. It gives {} % for the field as it "
      "is.\nIts searches ended at these maps; their chances are too high, as a search exploits "
      "sampling errors:\n",
      fixed(100.0 * chain.before, 2));
  for (std::size_t i = 0; i < std::min(chain.optima.size(), kMostOptima); ++i) {
    const std::vector<Changed> to = changes_of(d, chain.optima[i].type_of_cell);
    text += wrapped(fmt::format("  {} %, {} times: {}", fixed(100.0 * chain.optima[i].gain, 2),
                                chain.optima[i].searches,
                                to.empty() ? "the field as it is" : changes_text(d, to)),
                    "    ");
  }
  return text + fmt::format("{}The chain was solved for {} maps. Time: {} s.\n",
                            method_line(d.method), chain.solves, fixed(d.seconds, 1));
}

Figure figure_of(const DesignedScene& d) {
  const std::vector<double> best = best_changes(d);
  const std::vector<int>&before = d.before.terrain->type_of_cell, &after = d.design.type_of_cell;
  const auto [map, box] = SmallMap(by_gate(best.data(), d.before.field).abs(), d.before.field);
  const ShownField shown(d.after);
  const TypeMarks types(shown);
  const double legend = box.bottom + 52, bars_top = legend + types.legend_height() + 30;

  Panels out;
  Rows &gains = out.data("$gains"), &changed = out.data("$changed");
  double range = 1e-6;
  for (Eigen::Index r = 0; r < map.rows.blocks(); ++r)
    for (Eigen::Index c = 0; c < map.columns.blocks(); ++c) {
      double largest = 0.0;  // stands for a block of several gates
      bool differs = false;
      for (const std::size_t gate : gates_in(map, r, c, d.before.field)) {
        if (std::abs(best[gate]) > std::abs(largest)) largest = best[gate];
        differs = differs || before[gate] != after[gate];
      }
      range = std::max(range, 100.0 * std::abs(largest));
      gains.add(c, r, 100.0 * largest);
      if (differs) changed.add(c, r, 1);
    }
  if (changed.empty()) changed.add(0, 0, "NaN");
  Panel& panel = add_map(out, map, box);
  panel.say("what the best change of a gate alone does, about, in % points", 8, 18);
  panel.colours = {d.options.least ? -range : 0.0, d.options.least ? 0.0 : range, box.beside(),
                   "autofreq scale 0"};
  panel.draw_cells(gains);
  const double cell = std::min(box.width() / static_cast<double>(map.columns.blocks()),
                               box.height() / static_cast<double>(map.rows.blocks()));
  panel.draw(changed, "1:($3 > 0 ? $2 : NaN)", "points",
             {kSecondColour, 2, 4, std::clamp(0.09 * cell, 0.4, 2.4)});
  types.add_legend(panel, legend, types.draw_on(out, panel, map, "design"));

  const double end =
      add_crossings(out, bars_top, "crossed, % (framed above: the gates that are changed)",
                    {{"as it is", d.design.before}, {"changed", d.design.crossings}});
  return out.figure(static_cast<int>(std::ceil(end + 12)));
}

}  // namespace gatewalk::cli
