// SPDX-License-Identifier: MIT
#include "cli/render/analysis.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "cli/render/costs.h"
#include "cli/render/final_gates.h"
#include "cli/render/health.h"
#include "cli/render/json.h"
#include "cli/render/scene.h"
#include "cli/render/start.h"
#include "cli/render/text.h"
#include "dynamics/disc/gate.h"

namespace gatewalk::cli {
namespace {

using dynamics::Cost;
using lattice::FieldCosts;
using lattice::Mean95;

constexpr std::int64_t kFew = 50;  // walks or trials

Json interval(const std::array<double, 2>& i) { return std::isfinite(i[0]) ? Json(i) : Json(); }

const std::vector<dynamics::CostInfo>& costs_of(const ShownField& shown) {
  return shown.map.section.costs;
}

/// Durations of walks with these endings, ascending; none where they are too few to say much.
std::vector<double> durations_of(const lattice::Analysis& a, std::optional<markov::Ending> ending) {
  std::vector<double> out;
  for (const markov::TimedWalk& w : a.walks)
    if (!ending || w.ending == *ending) out.push_back(w.total);
  if (std::ssize(out) < kFew) out.clear();
  std::sort(out.begin(), out.end());
  return out;
}

double quantile(const std::vector<double>& sorted, double level) {
  if (sorted.empty()) return std::nan("");
  const auto at = static_cast<std::size_t>(level * static_cast<double>(sorted.size()));
  return sorted[std::min(at, sorted.size() - 1)];
}

Spent spent(const lattice::Analysis& a, std::optional<markov::Ending> ending) {
  Spent s;
  for (std::size_t c = 0; c < a.totals.totals.size(); ++c) {
    const auto& by_ending = a.totals.totals[c];
    const markov::Moments m =
        ending ? by_ending[static_cast<std::size_t>(*ending)] : markov::WalkTotals::all(by_ending);
    s.share = m.share;
    s.mean[c] = m.mean();
    s.sd[c] = m.sd();
  }
  const std::vector<double> walks = durations_of(a, ending);
  for (std::size_t q = 0; q < s.quantiles.size(); ++q)
    s.quantiles[q] = quantile(walks, Spent::kLevels[q]);
  return s;
}

std::string with_interval(const Mean95& m, int decimals) {
  if (std::isnan(m.interval[0])) return fixed(m.mean, decimals);
  return fixed(m.mean, decimals) + " [" + fixed(m.interval[0], decimals) + ", " +
         fixed(m.interval[1], decimals) + "]";
}

const char* target_word(markov::Ending ending) {
  return std::find_if(kAllEndingNames.begin(), kAllEndingNames.end(),
                      [&](const EndingName& e) { return e.ending == ending; })
      ->name;
}
const char* key_of(markov::Ending ending) {
  return std::find_if(kAllEndingNames.begin(), kAllEndingNames.end(),
                      [&](const EndingName& e) { return e.ending == ending; })
      ->key;
}

/// ". 1.20, s 0.44"
template <class Number>
std::string by_type(const std::vector<std::string>& names, Number number) {
  std::string text;
  for (std::size_t t = 0; t < names.size(); ++t)
    text += (t == 0 ? "" : ", ") + names[t] + " " + fixed(number(t), 2);
  return text;
}

/// Endings whose mean time has no interval, and why: such a mean is to be read with care.
std::string few_runs_text(const lattice::Analysis& a) {
  std::string text;
  for (const EndingName& e : kAllEndingNames) {
    const auto& costs = a.costs_of[static_cast<std::size_t>(e.ending)];
    if (costs.empty() || costs.front().why_none.empty() || !std::isfinite(costs.front().mean))
      continue;
    text += (text.empty() ? "(means without an interval: " : "; ") + std::string(e.name) + ", " +
            costs.front().why_none;
  }
  return text.empty() ? "" : text + ")\n";
}

/// "5.55, 1.99, 1.20"
std::string time_scales_text(const markov::QuasiStationary& q) {
  std::string text;
  for (const double modulus : q.moduli)
    text += (text.empty() ? "" : ", ") + fixed(markov::implied_time_scale(modulus), 2);
  return text;
}

/// {"i_x": ..., "i_y": ...}
Json gate_json(std::int64_t cell, const lattice::FieldParams& field) {
  return {{"i_x", cell % field.columns - field.start_column()}, {"i_y", cell / field.columns}};
}

}  // namespace

const char* target_name(const AnalysedField& f) { return target_word(f.analysis.target); }

DurationCurve duration_curve(const lattice::Analysis& a, markov::Ending ending) {
  constexpr std::size_t kPoints = 200;
  DurationCurve curve;
  const std::vector<double> walks = durations_of(a, ending);
  const std::size_t step = std::max<std::size_t>(1, walks.size() / kPoints);
  const auto add = [&](std::size_t i) {
    curve.seconds.push_back(walks[i]);
    curve.share.push_back(static_cast<double>(i + 1) / static_cast<double>(walks.size()));
  };
  for (std::size_t i = 0; i + 1 < walks.size(); i += step) add(i);
  if (!walks.empty()) add(walks.size() - 1);
  return curve;
}

double most_of_starts(const lattice::Analysis& a) {
  double most = 0.0;
  for (const lattice::StartChance& s : a.starts) most = std::max(most, s.chance.mean);
  return most;
}

std::vector<lattice::ParameterEffect> sorted_effects(const AnalysedField& f) {
  std::vector<lattice::ParameterEffect> effects = f.parameters.effects;
  std::stable_sort(effects.begin(), effects.end(), [](const auto& x, const auto& y) {
    return std::abs(x.elasticity.mean) > std::abs(y.elasticity.mean);
  });
  return effects;
}

KolmogorovDistance duration_distance(const lattice::Analysis& a, const FieldCosts& costs,
                                     std::optional<markov::Ending> ending) {
  const std::vector<double> walks = durations_of(a, ending);
  const auto steps = ending ? costs.durations(*ending) : costs.durations();
  if (walks.empty() || steps.empty() || steps.back().trials < kFew)
    return {std::nan(""), std::nan("")};
  // Trials are known to a bin, by its middle: walks are counted to the same. Between two bins the
  // trials' function stays, and the walks' grows.
  const double half = 0.5 * costs.bin();
  const auto n = static_cast<double>(steps.back().trials), m = static_cast<double>(walks.size());
  const auto walks_until = [&](double seconds) {
    return static_cast<double>(std::upper_bound(walks.begin(), walks.end(), seconds) -
                               walks.begin()) /
           m;
  };
  double distance = 0.0, before = 0.0;
  for (const FieldCosts::Step& s : steps) {
    const double trials = static_cast<double>(s.trials) / n;
    distance = std::max({distance, std::abs(before - walks_until(s.seconds - half)),
                         std::abs(trials - walks_until(s.seconds + half))});
    before = trials;
  }
  constexpr double kSmirnov95 = 1.358;  // of the distance times sqrt(n m / (n + m))
  return {distance, kSmirnov95 * std::sqrt(1.0 / n + 1.0 / m)};
}

Json to_json(const AnalysedField& f) {
  const lattice::Analysis& a = f.analysis;
  Json json;
  for (const EndingName& e : kAllEndingNames) {
    const auto at = static_cast<std::size_t>(e.ending);
    if (e.ending == lattice::kWentBack.ending && f.endings.rules_out(e.ending)) continue;
    json["endings"][e.key] = {{"probability", f.endings.share[at]},
                              {"interval_95", interval(f.endings.interval[at])}};
  }
  const auto add_interval = [](Json& to, const std::string& key, const lattice::Mean95OfRuns& m) {
    to[key + "_95"] = interval(m.interval);
    if (!m.why_none.empty()) to["why_no_interval"][key] = m.why_none;
  };
  json["expected_gates"] = a.gates.mean;
  add_interval(json, "expected_gates", a.gates);
  const auto expected = [&](const std::string& key, std::size_t cost) {
    json["expected_" + key] = or_null(a.costs[cost].mean);
    add_interval(json, "expected_" + key, a.costs[cost]);
  };
  if (f.shown.mass) {
    expected("seconds", static_cast<std::size_t>(Cost::seconds));
    expected("work_J", static_cast<std::size_t>(Cost::propulsion_work));
    expected("random_work_J", static_cast<std::size_t>(Cost::random_work));
    expected("lost_J", static_cast<std::size_t>(Cost::lost));
    json["cost_of_transport_J_per_kg_m"] = or_null(spent(a, {}).cost_of_transport(*f.shown.mass));
  } else {
    for (std::size_t c = 0; c < a.costs.size(); ++c) expected(costs_of(f.shown)[c].key, c);
  }
  json["expected_visits"] = grid(a.totals.visits);
  json["never_sampled"] = f.rest.never_sampled;
  json["still_walking"] = f.rest.still_walking;
  json["drawn_walks"] = a.totals.drawn_walks;
  json["by_ending"] = Json::object();
  const auto add = [&](const char* key, std::optional<markov::Ending> ending) {
    const Spent s = spent(a, ending);
    if (!(s.share > 0.0)) return;
    json["by_ending"][key] = json_of([&](Fields& out) { describe(out, s, f.shown); });
    json["by_ending"][key]["probability"] = s.share;
    for (std::size_t c = 0; c < costs_of(f.shown).size() && ending; ++c)
      add_interval(json["by_ending"][key], "mean_" + costs_of(f.shown)[c].key,
                   a.costs_of[static_cast<std::size_t>(*ending)][c]);
    if (!f.direct) return;
    const KolmogorovDistance d = duration_distance(a, f.direct->costs, ending);
    json["by_ending"][key]["kolmogorov_distance"] = or_null(d.distance);
    json["by_ending"][key]["kolmogorov_chance_95"] = or_null(d.chance_95);
  };
  add("all", {});
  for (const EndingName& e : kAllEndingNames) add(e.key, e.ending);

  json["quasi_stationary"] = Json();
  if (!a.endless) json["why_not_quasi_stationary"] = a.why_not_endless;
  if (a.endless) {
    Json& q = json["quasi_stationary"] = Json::object();
    q["survival_per_gate"] = a.endless->survival;
    q["second_eigenvalue"] = a.endless->second;
    q["spectral_gap"] = a.endless->spectral_gap();
    q["kept_per_gate"] = a.endless->second / a.endless->survival;
    q["rows_per_gate"] = a.endless->rows_per_cell;
    q["eigenvalues"] = a.endless->moduli;
    for (const double modulus : a.endless->moduli)
      q["time_scales_gates"].push_back(or_null(markov::implied_time_scale(modulus)));
    for (std::size_t b = 0; b < a.endless_boundaries.size(); ++b)
      q["boundaries"][a.space.section().faces[b].name] = a.endless_boundaries[b];
    for (const int s : lattice::shown_order(a.space))
      q["states"].push_back(a.endless->states[static_cast<std::size_t>(s)]);
  }
  json["answer_from"] = f.from_trials ? "trials" : "chain";
  json["lumping"] = Json();
  if (a.lumped)
    json["lumping"] = {
        {"states",
         std::all_of(a.lumping.begin(), a.lumping.end(), [](int parts) { return parts == 1; })
             ? Json("one for each boundary")
             : Json("parts of each boundary")},
        {"parts", a.lumping},
        {"count", a.lumped->states},
        {"largest_difference", a.lumped->largest},
        {"error", {{"endings", a.lumped->endings}, {"final_gates", a.lumped->final_gates}}}};
  json["target"] = key_of(a.target);
  json["target_probability"] = a.target_chance;
  json["starts"] = Json::array();
  json["starts_in_all"] = a.starts.size();
  for (const lattice::StartChance& s :
       std::span(a.starts).first(static_cast<std::size_t>(a.told_starts()))) {
    Json one = to_json(a.space.section(), s.range);
    one["probability"] = or_null(s.chance.mean);
    one["interval_95"] = interval(s.chance.interval);
    one["runs"] = s.runs;
    json["starts"].push_back(std::move(one));
  }
  json["paths"] = Json::array();
  for (const markov::CellPath& path : a.paths.paths) {
    Json gates = Json::array();
    for (const std::int64_t cell : path.cells) gates.push_back(gate_json(cell, f.shown.field));
    json["paths"].push_back({{"probability", path.share}, {"gates", std::move(gates)}});
  }
  json["paths_complete"] = !a.paths.gave_up;
  Json& s = json["sensitivities"] = Json::object();
  s["of"] = key_of(a.target);
  s["passed_gates"] = grid(a.passed);
  s["less_trapping"] = a.trapping.size() > 0 ? grid(a.trapping) : Json();
  s["less_trapping_by_state"] = a.state_trapping.empty() ? Json() : Json(a.state_trapping);
  const std::vector<std::string>& types = f.shown.types;
  s["less_trapping_by_type"] = Json();
  for (std::size_t t = 0; t < types.size() && !a.type_trapping.empty(); ++t)
    s["less_trapping_by_type"][types[t]] = a.type_trapping[t];
  json["types"] = Json();
  for (std::size_t t = 0; t < types.size(); ++t)
    json["types"][types[t]] = {
        {"visits", a.types[t].visits},
        {"trapped", a.types[t].trapped},
        {"trapped_per_visit", or_null(a.types[t].trapped / a.types[t].visits)}};
  s["parameters"] = Json::array();
  for (const lattice::ParameterEffect& e : sorted_effects(f)) {
    const double unit = f.parameters.chance / e.value;
    Json of_type;
    for (std::size_t t = 0; t < e.of_type.size(); ++t)
      of_type[types[t]] = {{"elasticity", e.of_type[t].mean},
                           {"interval_95", interval(e.of_type[t].interval)}};
    s["parameters"].push_back({{"key", e.key},
                               {"value", or_null(e.value)},
                               {"elasticity", e.elasticity.mean},
                               {"interval_95", interval(e.elasticity.interval)},
                               {"with_more", or_null(e.more)},
                               {"with_less", or_null(e.less)},
                               {"bends", e.bends},
                               {"left_out", e.left_out},
                               {"of_type", std::move(of_type)},
                               {"derivative", or_null(e.elasticity.mean * unit)},
                               {"derivative_95", interval({e.elasticity.interval[0] * unit,
                                                           e.elasticity.interval[1] * unit})}});
  }
  s["probability"] = f.parameters.chance;
  s["gate_runs"] = f.parameters.health.runs;
  s["chain_gate_runs"] = f.parameters.pool_runs;
  s["seconds"] = f.parameters.seconds;
  s["added_gate_runs"] = f.parameters.added_runs;
  if (f.direct) {
    json["direct"] = {{"trials", f.direct->tally.trials},
                      {"endings", endings(f.direct->tally.endings)},
                      {"costs", to_json(f.direct->costs, f.shown)}};
  }
  json["states"] = f.states;
  json["gate_runs"] = f.gate_runs + f.parameters.health.runs;
  json["accuracy_reached"] = f.reached;
  json["seconds"] = f.seconds + a.seconds + f.parameters.seconds;
  return json;
}

std::string table_of(const AnalysedField& f) {
  const lattice::Analysis& a = f.analysis;
  const lattice::FieldParams& field = f.shown.field;
  std::string table =
      endings_text(f.endings,
                   f.analysis.by_groups ? "of all bodies, 95 % intervals that count everything"
                   : std::isnan(f.endings.interval.front().front())
                       ? "of all bodies; no intervals"
                       : "of all bodies; 95 % intervals that count the sampling of the matrix") +
      limits_text(f.shown) + rest_text(f.rest) + "\ngates visited  " +
      (std::isnan(a.gates.mean) ? "-" : with_interval(a.gates, 3)) +
      (a.gates.why_none.empty()   ? ""
       : std::isnan(a.gates.mean) ? " (nor visits, times and costs: " + a.gates.why_none + ")"
                                  : " (no interval: " + a.gates.why_none + ")") +
      "\n\nby the chain\n";
  CostTable costs(f.shown);
  const auto add = [&](const char* name, std::optional<markov::Ending> ending) {
    const Spent s = spent(a, ending);
    if (s.share > 0.0) costs.add(name, s);
  };
  add("all", {});
  for (const EndingName& e : kAllEndingNames) add(e.name, e.ending);
  table += costs.text() + few_runs_text(a);
  if (!std::isfinite(a.costs.front().mean) && !std::isnan(a.gates.mean))
    table += f.shown.mass
                 ? "(the file is of an older version, which kept no durations: build it again)\n"
                 : "(the durations of some passages are not known)\n";
  if (a.totals.drawn_walks > 0)
    table += "(a large field: times and work by ending are those of " +
             std::to_string(a.totals.drawn_walks) +
             " walks with the chain; none of them: no line)\n";
  if (f.direct) {
    const KolmogorovDistance d = duration_distance(a, f.direct->costs, {});
    table += "by " + std::to_string(f.direct->tally.trials) + " trials of the full dynamics\n" +
             table_of(f.direct->costs, f.shown) +
             "largest difference of the two distributions of time: " + fixed(d.distance, 4) +
             " (chance: " + fixed(d.chance_95, 4) + ", 95 %)\n";
  }
  if (f.shown.mass)
    table +=
        "work: of the propulsion and of the random force; lost: to hits, dampers and drag, and "
        "left "
        "in the beams;\nJ/(kg m): cost of transport, work of both forces per mass and way "
        "forward\n";
  if (!std::isnan(a.gates.mean))
    table += "\n" + map_of(a.totals.visits, "visits of each gate", "per 100 bodies");
  if (a.endless)
    table += "\nbodies that go on for ever: " + percent(a.endless->survival, 1.0) +
             " of them get through or out of each further gate; " +
             fixed(a.endless->rows_per_cell, 2) + " rows a gate; from gate to gate " +
             percent(a.endless->second / a.endless->survival, 1.0) +
             " is left of what tells where they started\nimplied time scales (gates): " +
             time_scales_text(*a.endless) + "\n";
  const std::string target = std::string("\"") + target_word(a.target) + "\"";
  const std::vector<std::string>& types = f.shown.types;
  if (f.from_trials)
    table +=
        "\nthe endings above are the trials' own shares, which are more certain here; the chain's "
        "are behind all else (" +
        target + ": " + percents(a.target_chance) + " %)\n";
  table += "\nmost frequent ways to " + target +
           ", by the columns i_x of their gates (>: in the same row)\n";
  for (const markov::CellPath& path : a.paths.paths) {
    table += padded(percents(path.share) + " %", 11) + " ";
    std::int64_t row = -1;
    for (const std::int64_t cell : path.cells) {
      table += cell / field.columns == row ? ">" : " ";
      row = cell / field.columns;
      table += std::to_string(cell % field.columns - field.start_column());
    }
    table += "\n";
  }
  if (a.paths.gave_up)
    table += "  (the search for more was given up: there are very many ways)\n";
  else if (a.paths.paths.empty())
    table += "  (none)\n";
  if (std::ssize(a.starts) > a.told_starts())
    table += "other starts: --json has the " + std::to_string(a.told_starts()) + " of " +
             std::to_string(a.starts.size()) +
             " ways to enter that were entered most; --figure draws all\n";
  if (a.is_certain() && f.parameters.effects.empty())
    table += std::string(a.target_chance > 0.5 ? "everybody" : "nobody") +
             " ends so in these runs: they cannot tell what a little more or less of a number "
             "changes; --set KEY=VALUE tries more\n";
  if (!f.parameters.effects.empty()) {
    // The chain behind these has more runs than that behind the endings above.
    const std::string chance = percents(f.parameters.chance),
                      answer = percents(f.endings.share[static_cast<std::size_t>(a.target)]);
    table +=
        "\nper cent that the chance of " + target + " (" + chance + " %" +
        (chance == answer || f.parameters.pool_runs == 0
             ? ""
             : " by the chain of " + std::to_string(f.parameters.pool_runs) +
                   " gate runs behind these numbers; the answer is the " + answer + " % above") +
        ") grows for 1 % more of each number, 95 %\n";
    const bool of_bins = !a.by_groups;
    for (const lattice::ParameterEffect& e : sorted_effects(f))
      table +=
          padded(std::string(e.key), -34) + with_interval(e.elasticity, 2) +
          (std::isnan(e.elasticity.interval[0]) && !of_bins ? " (no interval: too few runs make it)"
                                                            : "") +
          (e.of_type.empty()
               ? ""
               : "  of it: " + by_type(types, [&](std::size_t t) { return e.of_type[t].mean; })) +
          (e.bends
               ? " (with more of it " + fixed(e.more, 2) + ", with less " + fixed(e.less, 2) + ")"
               : "") +
          "\n";
    table += of_bins
                 ? "a matrix of bins does not tell how far off these are, and its states are "
                   "coarse: a scene tells more\n"
                 : "one number at a time, in gates of all types; intervals count chance and the "
                   "chain's own error; --set KEY=VALUE\nsays what a large change does\n";
    const double largest = std::abs(sorted_effects(f).front().elasticity.mean) * f.step;
    constexpr double kSmall = 0.3;
    if (largest > kSmall)
      table += "the chance changes by " + percent(largest, 1.0, 0) + " in a step of " +
               percent(f.step, 1.0) + ", so the first are rough: a smaller --step is more exact\n";
  }
  if (!types.empty() && !std::isnan(a.gates.mean)) {
    table += "\nby type of the gate: visits per body " +
             by_type(types, [&](std::size_t t) { return a.types[t].visits; }) +
             "; trapped there, % of these visits " + by_type(types, [&](std::size_t t) {
               return 100.0 * a.types[t].trapped / a.types[t].visits;
             });
    if (!a.type_trapping.empty())
      table += ";\nper cent that \"" + std::string(target_word(a.target)) +
               "\" grows for 1 % fewer of these " +
               by_type(types, [&](std::size_t t) { return a.type_trapping[t]; });
    table += "\n";
  }
  if (a.lumped)
    table += "\nwith " + std::to_string(a.lumped->states) +
             " states (--lump), total variation to this chain: endings " +
             fixed(a.lumped->endings, 4) + ", final gates " + fixed(a.lumped->final_gates, 4) +
             "\n";
  return table + std::to_string(f.gate_runs + f.parameters.health.runs) + " gate runs, " +
         std::to_string(f.states) + " states, " +
         fixed(f.seconds + a.seconds + f.parameters.seconds, 2) + " s\n";
}

}  // namespace gatewalk::cli
