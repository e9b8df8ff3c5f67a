// SPDX-License-Identifier: MIT
#include "cli/paper/findings.h"

#include <algorithm>
#include <set>
#include <stdexcept>

#include "cli/fields/text.h"

namespace gatewalk::cli {
namespace {

double number_or_nan(const Json& json) {
  return json.is_null() ? std::nan("") : json.get<double>();
}
std::vector<double> numbers(const Json& json) {
  std::vector<double> list;
  for (const Json& item : json) list.push_back(number_or_nan(item));
  return list;
}

void read(Outcomes& tally, const Json& json) {
  tally.trials = json.at("trials");
  for (const auto& [outcome, key, words] : dynamics::kOutcomeNames)
    tally.counts[static_cast<std::size_t>(outcome)] = json.at(std::string(key));
  tally.health.worst_penetration = json.at("status").at("worst_penetration_m");
}

void read(PaperPoint& point, const Json& json) {
  read(static_cast<Outcomes&>(point), json);
  point.place = json.at("at");
}

void read(TracedRun& run, const Json& json) {
  run.label = json.at("label");
  run.ending = json.at("ending");
  run.trial = json.at("trial");
  run.hits = json.at("hits");
  const std::pair<const char*, std::vector<double>*> arrays[] = {
      {"t", &run.t},
      {"x", &run.x},
      {"y", &run.y},
      {"potential_J", &run.potential},
      {"elastic_left_J", &run.elastic_left},
      {"elastic_right_J", &run.elastic_right},
      {"landscape_J", &run.landscape},
      {"landscape_left_J", &run.landscape_left},
      {"landscape_right_J", &run.landscape_right}};
  for (const auto& [name, values] : arrays) {
    *values = numbers(json.at(name));
    if (values->empty() || values->size() != run.t.size())
      throw std::runtime_error(run.label + ": " + name + " has not an entry for every step");
  }
}

void read(dynamics::Pass& pass, const Json& json) {
  pass.x = json.at("x_m");
  pass.y = json.at("y_m");
  pass.energy = json.at("energy_J");
  pass.start_energy = json.at("begins_at_J");
  pass.way = json.at("way_m");
}

void read(dynamics::GridPasses& grid, const Json& json) {
  grid.spacing = json.at("grid_m");
  read(grid.from_start, json.at("from_start"));
  read(grid.from_basin, json.at("from_basin"));
}

/// Reads the repeats of Table IV, `against` the exact chain or walks.
void read(Repeats& repeats, const Json& json, const std::string& against) {
  const auto mean_and_sd = [&](const std::string& key) {
    return MeanAndSd{number_or_nan(json.at(against + key).at("mean")),
                     number_or_nan(json.at(against + key).at("sd"))};
  };
  repeats = {.corrcoef = mean_and_sd("_corrcoef"),
             .rmse = mean_and_sd("_rmse_per_100"),
             .corrcoef_floor = number_or_nan(json.at(against + "_corrcoef_floor")),
             .rmse_floor = number_or_nan(json.at(against + "_rmse_per_100_floor"))};
}

void read(ValidatedStart& s, const Json& json) {
  const Json &start = json.at("start"), &repeated = json.at("at_100_trials"),
             &all = json.at("exact"), &seconds = json.at("seconds");
  s.d = start.at("d_m");
  s.vx = start.at("vx_m_per_s");
  s.vy = start.at("vy_m_per_s");
  if (json.contains("paper")) {
    s.paper_corrcoef = json.at("paper").at("corrcoef");
    s.paper_rmse = json.at("paper").at("rmse_per_100");
  }
  s.repeats = repeated.at("repeats");
  read(s.exact, repeated, "exact");
  read(s.walks, repeated, "walks");
  s.corrcoef = number_or_nan(all.at("corrcoef"));
  s.rmse = all.at("rmse_per_100");
  s.total_variation = all.at("total_variation");
  s.total_variation_floor = all.at("total_variation_floor");
  s.finding = lattice::finding_of(json.at("trials_and_matrix").at("differs"), s.total_variation,
                                  all.at("total_variation_floor_q95"));
  s.counts = json.at("final_gates").at("dynamics");
  s.chain = json.at("final_gates").at("exact");
  s.departed_counts = json.at("departed_gates").at("dynamics");
  s.departed_chain = json.at("departed_gates").at("exact");
  s.cut_off = json.at("fates").at("dynamics").at("cut_off");
  s.dynamics_seconds = seconds.at("dynamics");
  s.walks_seconds = seconds.at("walks");
  s.exact_seconds = seconds.at("exact");
}

/// Reads a list of at least one item.
template <class Item>
void read_some(std::vector<Item>& items, const Json& json) {
  for (const Json& item : json) read(items.emplace_back(), item);
  (void)json.at(0);
}

/// Mean time (s) of one of `count` trials or walks per start.
double seconds_per(const Validation& v, double ValidatedStart::*seconds, std::int64_t count) {
  double sum = 0.0;
  for (const ValidatedStart& s : v.starts) sum += s.*seconds;
  return sum / (static_cast<double>(v.starts.size()) * static_cast<double>(count));
}

}  // namespace

std::string PaperPoint::text(const char* key) const {
  const Json& value = place.at(key);
  return value.is_string() ? value.get<std::string>() : value.dump();
}

const PaperPoint& Sweep::at(const Json& where) const {
  for (const PaperPoint& point : points)
    if (std::all_of(where.items().begin(), where.items().end(), [&](const auto& wanted) {
          return point.place.value(wanted.key(), Json()) == wanted.value();
        }))
      return point;
  throw std::out_of_range("the sweep has no point at " + where.dump());
}

std::vector<double> Sweep::values(const char* key) const {
  std::set<double> values;
  for (const PaperPoint& point : points) values.insert(point.number(key));
  return {values.begin(), values.end()};
}

std::string ValidatedStart::label() const {
  return "d = " + fixed(d, 0) + " m, v = (" + fixed(vx, 0) + ", " + fixed(vy, 0) + ") m/s";
}

Share share_by_bodies(std::int64_t part, std::int64_t events, std::int64_t bodies) {
  if (events <= bodies) return share_of(part, events);
  const double value = static_cast<double>(part) / static_cast<double>(events);
  Share s = share_of(std::llround(value * static_cast<double>(bodies)), bodies);
  s.value = value;  // from the counts, not the rounded value of the JSON
  return s;
}

double Validation::seconds_per_trial() const {
  return seconds_per(*this, &ValidatedStart::dynamics_seconds, trials);
}
double Validation::seconds_per_walk() const {
  return seconds_per(*this, &ValidatedStart::walks_seconds, walks);
}

void read(Sweep& sweep, const Json& json) { read_some(sweep.points, json.at("points")); }

void read(Trace& trace, const Json& json) {
  trace.trials = json.at("trials");
  read_some(trace.runs, json.at("runs"));
}

void read(LandscapeStudy& study, const Json& json) {
  const Json& passes = json.at("passes");
  read(study.coarse, passes.at(0));
  read(study.fine, passes.at(1));
  if (json.contains("measured")) read(study.measured, json.at("measured"));
}

void read(Validation& v, const Json& json) {
  v.trials = json.at("trials");
  v.walks = json.at("walks");
  read_some(v.starts, json.at("starts"));
  const Json& crossings = json.at("crossings");
  const std::int64_t between = crossings.at("between_gates");
  const auto count_of = [&](const char* share) {
    return std::llround(crossings.at(share).get<double>() * static_cast<double>(between));
  };
  v.crossings = {.rt_and_lt = count_of("RT_and_LT_share"),
                 .clamped = count_of("clamped_share"),
                 .between_gates = between,
                 .bodies = v.trials * std::ssize(v.starts)};
  v.markov = json.at("markov").at("verdict");
  v.matrix_seconds = json.at("matrix").at("seconds");
}

}  // namespace gatewalk::cli
