#include "cli/paper/studies.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "cli/render/report.h"
#include "cli/web/embedded.h"

namespace gatewalk::cli {

std::string set(const char* key, double value) {
  Json number = value;
  if (value == std::floor(value)) number = static_cast<std::int64_t>(value);
  return std::string(key) + "=" + number.dump();
}

std::string Study::text() const {
  std::string text = "gatewalk " + command;
  for (const std::string& word : arguments) {
    const bool plain = word.find_first_of(" '\"") == word.npos;
    text += " " + (plain ? word : "'" + word + "'");
  }
  return text;
}

std::vector<Study> paper_studies(bool quick) {
  std::vector<Study> list;
  const auto add = [&](const std::string& name, auto run, const std::string& command,
                       const std::vector<std::string>& arguments, double seconds) {
    list.push_back(
        {name, run, command, arguments, std::max<std::int64_t>(1, std::llround(100 * seconds))});
  };
  constexpr double kTrial = 70e-6;  // s, a gate run on two threads
  const auto sweep = [&](const std::string& name, std::int64_t points, std::int64_t trials,
                         std::vector<std::string> arguments) {
    for (const char* word : {"--trials", "--seed", "--csv"}) {
      arguments.emplace_back(word);
      arguments.push_back(word == std::string("--trials") ? std::to_string(trials)
                          : word == std::string("--seed") ? "1"
                                                          : "data/" + name + ".csv");
    }
    add(name, run_sweep, "sweep", arguments, static_cast<double>(points * trials) * kTrial);
  };

  // Figs. 8 and 12, the grids of Tables I and II; Fig. 8 further to the right.
  sweep("fig8", 84, quick ? 200 : 10000, {"scenes/fig8.toml", "--vary", "forces.random_N=0:10:60"});
  sweep("fig12", 216, quick ? 100 : 5000, {"scenes/fig12.toml"});

  // Fig. 9 and what could make 13 % and 8 % of it.
  const std::string soft = "scenes/soft_left.toml";
  const std::vector<std::string> equal{soft, "--set", set(kLeftStiffness, 500)};
  const auto tried = [&](const std::string& name, std::int64_t points,
                         std::vector<std::string> more) {
    std::vector<std::string> arguments = equal;
    arguments.insert(arguments.end(), more.begin(), more.end());
    sweep(name, points, quick ? 200 : 10000, arguments);
  };
  tried("tried_method", 12,
        {"--vary", "run.method=stable,event,moreau,paper", "--vary",
         "beams.damping_Nms_per_rad=50,10,0"});
  tried("tried_step", 10,
        {"--set", "run.method=paper", "--vary", "run.step_s=0.02,0.01,0.004,0.002,0.001", "--vary",
         "beams.damping_Nms_per_rad=50,10"});
  tried("tried_restitution", 4,
        {"--vary", "contact.restitution=0.5,1", "--vary", "beams.damping_Nms_per_rad=50,10"});
  tried("tried_rate", 4,
        {"--set", "run.step_s=0.004", "--vary", "forces.random_rate_Hz=10,250", "--vary",
         "beams.damping_Nms_per_rad=50,10"});
  tried("tried_start", 4,
        {"--vary", "start.vy_m_per_s=5,10", "--vary", "beams.damping_Nms_per_rad=50,10"});
  tried("tried_random", 6,
        {"--vary", "forces.random_N=20,40,60", "--vary", "beams.damping_Nms_per_rad=50,10"});
  tried("tried_propulsion", 14,
        {"--vary", "forces.propulsion_N=8:0.5:11", "--vary", "beams.damping_Nms_per_rad=50,10"});
  sweep("paper_method", 4, quick ? 500 : 20000,
        {soft, "--vary", "run.method=paper,event", "--vary", "beams.damping_Nms_per_rad=50,10"});

  // Trajectories: with k_L = 500 hardly anybody gets through, so many are asked.
  const auto trace = [&](const std::string& name, std::int64_t trials,
                         std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--trials", std::to_string(trials), "--seed", "1"});
    add(name, run_trace, "trace", arguments, static_cast<double>(trials) * 1e-3);
  };
  trace(
      "fig9_500", quick ? 3000 : 5000,
      {soft, "--set", set(kLeftStiffness, 500), "--set", set(kDamping, 50), "--only", "traversed"});
  trace("fig9_300", 100, {soft, "--only", "traversed"});
  trace("fig9_100", 100, {soft, "--set", set(kLeftStiffness, 100), "--only", "traversed"});
  trace("fig6", 100,
        {"scenes/single_gate.toml", "--set", set(kPropulsion, 9), "--set", set(kRandom, 10),
         "--only", "traversed right"});
  trace("exits", 100,
        {"scenes/single_gate.toml", "--set", set(kPropulsion, 8), "--set", set(kRandom, 40),
         "--only", "exited"});
  trace("crossing", 3, {"scenes/field.toml", "--field", "--trial", "2"});

  // Landscapes: Fig. 5, the barriers behind Fig. 9, and where the basin ends.
  const auto landscape = [&](const std::string& name, std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"-o", "data/" + name});
    add(name, run_landscape, "landscape", arguments, 1.5);
  };
  landscape("fig5_symmetric", {"scenes/single_gate.toml", "--set", set(kPropulsion, 7)});
  landscape("fig5_asymmetric", {"scenes/single_gate.toml", "--set", set(kPropulsion, 7), "--set",
                                set(kLeftStiffness, 500), "--set", set(kRightStiffness, 250)});
  for (int k = 100; k <= 500; k += quick ? 200 : 50)
    landscape("barrier_" + std::to_string(k), {soft, "--set", set(kLeftStiffness, k)});
  landscape("steep", {"scenes/single_gate.toml", "--set", set(kPropulsion, 20), "--set",
                      set(kRandom, 10), "--trials", quick ? "500" : "10000"});

  // Fig. 11, Table IV, crossings, times.
  const auto validate = [&](const std::string& name, std::int64_t trials,
                            std::vector<std::string> arguments, double seconds) {
    arguments.insert(arguments.end(), {"--trials", std::to_string(trials), "--seed", "1"});
    add(name, run_validate, "validate", arguments, seconds);
  };
  validate("field", quick ? 1000 : 10000, {"scenes/field.toml"}, quick ? 4 : 20);
  validate("field_paper_method", quick ? 200 : 2000,
           {"scenes/field.toml", "--set", "run.method=paper"}, quick ? 3 : 10);
  validate("field_no_drag", quick ? 300 : 3000,
           {"scenes/field.toml", "--set", "forces.drag_Ns_per_m=0", "--set", set(kDamping, 10),
            "--start", "0,0,15", "--null-draws", "99"},
           2);
  for (const int random : {10, 20, 40})
    validate("field_random_" + std::to_string(random), quick ? 300 : 3000,
             {"scenes/field.toml", "--set", set(kRandom, random), "--start", "0,0,15",
              "--null-draws", "99"},
             2);
  return list;
}

const Json& point_at(const Json& sweep, const At& at) {
  for (const Json& point : sweep.at("points")) {
    bool here = true;
    for (const auto& [key, value] : at) here = here && point.at("at").at(key) == value;
    if (here) return point;
  }
  std::string text;
  for (const auto& [key, value] : at) text += " " + key + "=" + value.dump();
  throw std::out_of_range("the sweep has no point at" + text);
}

Share traversed_at(const Json& sweep, const At& at) {
  const Json& p = point_at(sweep, at);
  return share_of(p.at("traversed"), p.at("trials"));
}

Share right_at(const Json& sweep, const At& at) {
  const Json& p = point_at(sweep, at);
  const std::int64_t right = p.at("traversed_right"), left = p.at("traversed_left");
  return share_of(right, right + left);
}

dynamics::GateParams gate_of(const char* scene, const std::vector<std::string>& overrides) {
  return lattice::parse_scene(carried_file(scene), scene, overrides).gate;
}

std::string start_label(const Json& start) {
  const Json& s = start.at("start");
  const auto number = [&](const char* key) { return fixed(s.at(key).get<double>(), 0); };
  return "d = " + number("d_m") + " m, v = (" + number("vx_m_per_s") + ", " + number("vy_m_per_s") +
         ") m/s";
}

double seconds_per(const Json& validation, const char* what, const char* count) {
  double seconds = 0.0;
  for (const Json& s : validation.at("starts")) seconds += s.at("seconds").at(what).get<double>();
  return seconds /
         (static_cast<double>(validation.at("starts").size()) * validation.at(count).get<double>());
}

}  // namespace gatewalk::cli
