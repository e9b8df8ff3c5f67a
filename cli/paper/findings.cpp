// SPDX-License-Identifier: MIT
#include "cli/paper/findings.h"
#include "cli/render/json.h"
#include "cli/render/text.h"

#include <algorithm>
#include <set>
#include <stdexcept>

namespace gatewalk::cli {
namespace {

/// A value of a file, and where in it.
class Reader {
 public:
  Reader(const Json& json, std::string place) : json_(json), place_(std::move(place)) {}

  [[nodiscard]] bool has(const std::string& key) const { return json_.contains(key); }
  [[nodiscard]] Reader operator[](const std::string& key) const {
    const std::string place = place_ + (place_.ends_with(": ") ? "" : ".") + key;
    if (!has(key)) throw std::runtime_error(place + " is missing");
    return {json_[key], place};
  }
  [[nodiscard]] std::vector<Reader> items() const {
    std::vector<Reader> list;
    for (const Json& item : as(json_.is_array(), "a list"))
      list.emplace_back(item, place_ + "[" + std::to_string(list.size()) + "]");
    return list;
  }
  [[nodiscard]] std::vector<Reader> some() const {
    std::vector<Reader> list = items();
    as(!list.empty(), "a list with entries");
    return list;
  }
  /// An entry of an object, by its key.
  [[nodiscard]] std::vector<std::pair<std::string, Reader>> entries() const {
    std::vector<std::pair<std::string, Reader>> list;
    for (const auto& [key, value] : as(json_.is_object(), "an object").items())
      list.emplace_back(key, Reader(value, place_ + "." + key));
    return list;
  }

  [[nodiscard]] double number() const { return as(json_.is_number(), "a number").get<double>(); }
  [[nodiscard]] double number_or_null() const { return json_.is_null() ? std::nan("") : number(); }
  [[nodiscard]] std::int64_t count() const {
    return as(json_.is_number_integer(), "a whole number").get<std::int64_t>();
  }
  [[nodiscard]] bool is_true() const { return as(json_.is_boolean(), "true or false").get<bool>(); }
  [[nodiscard]] std::string text() const {
    return as(json_.is_string(), "a text").get<std::string>();
  }
  [[nodiscard]] Setting setting() const {
    if (json_.is_string()) return {std::nan(""), text()};
    return {number(), json_.dump()};
  }
  /// So many of them, if said.
  [[nodiscard]] std::vector<double> numbers(std::size_t count = 0) const {
    as(count == 0 || json_.size() == count, "a list of so many numbers");
    std::vector<double> list;
    list.reserve(json_.size());
    for (const Json& item : as(json_.is_array(), "a list"))
      list.push_back(
          item.is_number()
              ? item.get<double>()
              : Reader(item, place_ + "[" + std::to_string(list.size()) + "]").number_or_null());
    return list;
  }
  [[nodiscard]] std::vector<std::vector<double>> rows() const {
    std::vector<std::vector<double>> list;
    for (const Reader& row : items()) list.push_back(row.numbers());
    return list;
  }
  [[nodiscard]] MeanAndSd mean_and_sd() const {
    return {(*this)["mean"].number_or_null(), (*this)["sd"].number_or_null()};
  }

 private:
  const Json& as(bool right, const char* kind) const {
    if (!right) throw std::runtime_error(place_ + " is not " + kind);
    return json_;
  }

  const Json& json_;
  std::string place_;  // "data/fig8.json: points[3].trials"
};

Outcomes outcomes_of(const Reader& from) {
  return {.trials = from["trials"].count(),
          .traversed = from["traversed"].count(),
          .traversed_left = from["traversed_left"].count(),
          .traversed_right = from["traversed_right"].count(),
          .exited_left = from["exited_left"].count(),
          .exited_right = from["exited_right"].count(),
          .trapped = from["trapped"].count(),
          .worst_penetration = from["status"]["worst_penetration_m"].number()};
}

LowestWay lowest_way(const Reader& pass) {
  const auto basin = pass["basin_m"].numbers(2);
  const bool downhill = pass["from_basin"]["way_m"].items().size() == 1;
  return {.above_start = pass["above_start_J"].number(),
          .above_basin = downhill ? 0.0 : pass["from_basin"]["barrier_J"].number(),
          .downhill = downhill,
          .basin = {basin.at(0), basin.at(1)}};
}

Repeats repeats_of(const Reader& from, const std::string& against) {
  return {.corrcoef = from[against + "_corrcoef"].mean_and_sd(),
          .rmse = from[against + "_rmse_per_100"].mean_and_sd(),
          .corrcoef_floor = from[against + "_corrcoef_floor"].number_or_null(),
          .rmse_floor = from[against + "_rmse_per_100_floor"].number_or_null()};
}

ValidatedStart start_of(const Reader& from) {
  ValidatedStart s;
  s.d = from["start"]["d_m"].number();
  s.vx = from["start"]["vx_m_per_s"].number();
  s.vy = from["start"]["vy_m_per_s"].number();
  s.paper_corrcoef = from.has("paper") ? from["paper"]["corrcoef"].number() : std::nan("");
  s.paper_rmse = from.has("paper") ? from["paper"]["rmse_per_100"].number() : std::nan("");
  s.repeats = from["at_100_trials"]["repeats"].count();
  s.exact = repeats_of(from["at_100_trials"], "exact");
  s.walks = repeats_of(from["at_100_trials"], "walks");
  const Reader all = from["exact"];
  s.corrcoef = all["corrcoef"].number_or_null();
  s.rmse = all["rmse_per_100"].number();
  s.total_variation = all["total_variation"].number();
  s.total_variation_floor = all["total_variation_floor"].number();
  s.finding = lattice::finding_of(from["trials_and_matrix"]["differs"].is_true(), s.total_variation,
                                  all["total_variation_floor_95"].number());
  s.counts = from["final_gates"]["dynamics"].rows();
  s.chain = from["final_gates"]["exact"].rows();
  s.departed_counts = from["departed_gates"]["dynamics"].rows();
  s.departed_chain = from["departed_gates"]["exact"].rows();
  s.cut_off = from["fates"]["dynamics"]["cut_off"].number();
  s.dynamics_seconds = from["seconds"]["dynamics"].number();
  s.walks_seconds = from["seconds"]["walks"].number();
  s.exact_seconds = from["seconds"]["exact"].number();
  return s;
}

}  // namespace

const Setting& SweepPoint::at(std::string_view key) const {
  const auto found = std::find_if(settings.begin(), settings.end(),
                                  [&](const auto& entry) { return entry.first == key; });
  if (found == settings.end())
    throw std::out_of_range("the sweep does not vary " + std::string(key));
  return found->second;
}

const SweepPoint& Sweep::at(const At& where) const {
  for (const SweepPoint& point : points)
    if (std::all_of(where.begin(), where.end(),
                    [&](const auto& wanted) { return point.at(wanted.first).is(wanted.second); }))
      return point;
  std::string text;
  for (const auto& [key, value] : where)
    text += " " + std::string(key) + "=" +
            (std::isnan(value.number) ? value.text : Json(value.number).dump());
  throw std::out_of_range("the sweep has no point at" + text);
}

std::vector<double> Sweep::values(std::string_view key) const {
  std::set<double> values;
  for (const SweepPoint& point : points) values.insert(point.at(key).number);
  return {values.begin(), values.end()};
}

std::string ValidatedStart::label() const {
  return "d = " + fixed(d, 0) + " m, v = (" + fixed(vx, 0) + ", " + fixed(vy, 0) + ") m/s";
}

namespace {
/// What one of `count` trials or walks per start took on average.
double seconds_per(const Validation& v, double ValidatedStart::*seconds, std::int64_t count) {
  double sum = 0.0;
  for (const ValidatedStart& s : v.starts) sum += s.*seconds;
  return sum / (static_cast<double>(v.starts.size()) * static_cast<double>(count));
}
}  // namespace

Share share_by_bodies(std::int64_t part, std::int64_t events, std::int64_t bodies) {
  if (events <= bodies) return share_of(part, events);
  const double value = static_cast<double>(part) / static_cast<double>(events);
  Share s = share_of(std::llround(value * static_cast<double>(bodies)), bodies);
  s.value = value;  // not as rounded
  return s;
}

double Validation::seconds_per_trial() const {
  return seconds_per(*this, &ValidatedStart::dynamics_seconds, trials);
}
double Validation::seconds_per_walk() const {
  return seconds_per(*this, &ValidatedStart::walks_seconds, walks);
}

Sweep sweep_of(const Json& json, const std::string& file) {
  Sweep sweep;
  for (const Reader& from : Reader(json, file + ": ")["points"].some()) {
    SweepPoint point{outcomes_of(from), {}};
    for (const auto& [key, value] : from["at"].entries())
      point.settings.emplace_back(key, value.setting());
    sweep.points.push_back(std::move(point));
  }
  return sweep;
}

Trace trace_of(const Json& json, const std::string& file) {
  const Reader all(json, file + ": ");
  Trace trace;
  trace.trials = all["trials"].count();
  for (const Reader& from : all["runs"].some()) {
    TracedRun run;
    run.label = from["label"].text();
    run.ending = from["ending"].text();
    run.trial = from["trial"].count();
    run.hits = from["hits"].count();
    run.t = from["t"].numbers();
    const std::pair<const char*, std::vector<double>*> arrays[] = {
        {"x", &run.x},
        {"y", &run.y},
        {"potential_J", &run.potential},
        {"elastic_left_J", &run.elastic_left},
        {"elastic_right_J", &run.elastic_right},
        {"landscape_J", &run.landscape},
        {"landscape_left_J", &run.landscape_left},
        {"landscape_right_J", &run.landscape_right}};
    for (const auto& [name, values] : arrays) {
      *values = from[name].numbers();
      if (values->size() != run.t.size() || values->empty())
        throw std::runtime_error(file + ": " + run.label + ": " + name + " is not as long as t");
    }
    trace.runs.push_back(std::move(run));
  }
  return trace;
}

LandscapeStudy landscape_of(const Json& json, const std::string& file) {
  const Reader all(json, file + ": ");
  const auto passes = all["passes"].some();
  LandscapeStudy study{lowest_way(passes.front()), lowest_way(passes.back()), {}};
  if (all.has("measured")) study.measured = outcomes_of(all["measured"]);
  return study;
}

Validation validation_of(const Json& json, const std::string& file) {
  const Reader all(json, file + ": ");
  Validation v;
  v.trials = all["trials"].count();
  v.walks = all["walks"].count();
  for (const Reader& start : all["starts"].some()) v.starts.push_back(start_of(start));
  const Reader crossings = all["crossings"];
  const std::int64_t between = crossings["between_gates"].count();
  const auto count_of = [&](const char* share) {
    return std::llround(crossings[share].number() * static_cast<double>(between));
  };
  v.crossings = {.rt_and_lt = count_of("RT_and_LT_share"),
                 .clamped = count_of("clamped_share"),
                 .between_gates = between,
                 .bodies = v.trials * static_cast<std::int64_t>(v.starts.size())};
  v.markov = all["markov"]["verdict"].text();
  v.matrix_seconds = all["matrix"]["seconds"].number();
  return v;
}

Findings::Findings(const std::map<std::string, Json>& data) {
  const auto read = [&](auto& into, auto of, const std::string& name) {
    const std::string file = "data/" + name + ".json";
    const auto found = data.find(name);
    if (found == data.end()) throw std::runtime_error(file + " is missing");
    into = of(found->second, file);
  };
  read(fig8, sweep_of, "fig8");
  read(fig12, sweep_of, "fig12");
  read(paper_method, sweep_of, "paper_method");
  read(tried_method, sweep_of, "tried_method");
  read(tried_step, sweep_of, "tried_step");
  read(tried_restitution, sweep_of, "tried_restitution");
  read(tried_rate, sweep_of, "tried_rate");
  read(tried_start, sweep_of, "tried_start");
  read(tried_random, sweep_of, "tried_random");
  read(tried_propulsion, sweep_of, "tried_propulsion");
  read(fig6, trace_of, "fig6");
  read(fig9_500, trace_of, "fig9_500");
  read(fig9_300, trace_of, "fig9_300");
  read(fig9_100, trace_of, "fig9_100");
  read(exits, trace_of, "exits");
  read(
      crossing, [](const Json& json, const std::string&) { return json; }, "crossing");
  read(fig5_symmetric, landscape_of, "fig5_symmetric");
  read(steep, landscape_of, "steep");
  for (int k = 100; k <= 500; k += 50)
    if (const std::string name = "barrier_" + std::to_string(k); data.contains(name))
      read(barriers[k], landscape_of, name);
  read(field, validation_of, "field");
  read(field_paper_method, validation_of, "field_paper_method");
  read(field_no_drag, validation_of, "field_no_drag");
  for (const int random : {10, 20, 40}) {
    Validation v;
    read(v, validation_of, "field_random_" + std::to_string(random));
    field_random[random] = v.crossings;
  }
}

}  // namespace gatewalk::cli
