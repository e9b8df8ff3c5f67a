// SPDX-License-Identifier: MIT
#include "cli/render/first_passage.h"

#include <cmath>

#include "cli/render/final_gates.h"
#include "cli/render/json.h"
#include "cli/render/text.h"

namespace gatewalk::cli {
namespace {

Json limits_of(const std::array<double, 2>& i) { return std::isfinite(i[0]) ? Json(i) : Json(); }

/// (rows x columns x states), these in `order`; what is no number is null. A start's own row,
/// behind these, is not of any gate.
Json table(const std::vector<double>& values, const markov::FirstPassages& f,
           const std::vector<int>& order) {
  Json rows = Json::array();
  std::size_t at = 0;
  for (int row = 0; row < f.rows; ++row) {
    Json columns = Json::array();
    for (int column = 0; column < f.columns; ++column, at += static_cast<std::size_t>(f.inputs)) {
      Json cell = Json::array();
      for (const int s : order) cell.push_back(or_null(values[at + static_cast<std::size_t>(s)]));
      columns.push_back(std::move(cell));
    }
    rows.push_back(std::move(columns));
  }
  return rows;
}

std::string mean_text(const lattice::Mean95OfRuns& m, const char* unit) {
  const auto shown = [](double x) { return fixed(x, 3); };
  return shown(m.mean) + unit +
         (std::isfinite(m.interval[0])
              ? " [" + shown(m.interval[0]) + ", " + shown(m.interval[1]) + "]"
              : "");
}

}  // namespace

bool has_tables(const markov::FirstPassages& all, std::size_t states) {
  return static_cast<double>(all.columns) * all.rows * static_cast<double>(states) <= kMostOfStates;
}

Json to_json(const lattice::FirstPassage& f, const PassageAsked& asked,
             const std::vector<std::string>& names, const std::vector<int>& order) {
  Json json{{"target", asked.text},
            {"probability", f.chance.mean},
            {"probability_95", limits_of(f.chance.interval)},
            {"mean_gates", or_null(f.gates.mean)},
            {"mean_gates_95", limits_of(f.gates.interval)},
            {"mean_time_s", or_null(f.time.mean)},
            {"mean_time_s_95", limits_of(f.time.interval)},
            {"states", nullptr},
            {"of_states", nullptr}};
  if (!f.gates.why_none.empty()) json["why_no_interval"] = f.gates.why_none;
  if (!has_tables(f.all, order.size())) return json;
  for (const int s : order) json["states"].push_back(names[static_cast<std::size_t>(s)]);
  json["of_states"] = {
      {"probability", table(f.all.chance, f.all, order)},
      {"never_sampled", table(f.all.never_sampled, f.all, order)},
      {"mean_gates", table(f.all.draws, f.all, order)},
      {"mean_time_s", f.all.totals.empty() ? Json() : table(f.all.totals.front(), f.all, order)}};
  return json;
}

std::string text_of(const lattice::FirstPassage& f, const PassageAsked& asked) {
  std::string text = "first passage to " + asked.text + ": " + percents(f.chance.mean) + " %";
  if (std::isfinite(f.chance.interval[0]))
    text += " [" + percents(f.chance.interval[0]) + ", " + percents(f.chance.interval[1]) + "]";
  text += " of all bodies get there";
  if (std::isfinite(f.gates.mean)) {
    text += "; those that do take " + mean_text(f.gates, " gates");
    if (std::isfinite(f.time.mean)) text += " and " + mean_text(f.time, " s");
    text += " on average";
    if (!f.gates.why_none.empty()) text += " (no interval: " + f.gates.why_none + ")";
  }
  return text + "\n\n";
}

}  // namespace gatewalk::cli
