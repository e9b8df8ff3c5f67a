// SPDX-License-Identifier: MIT
#include "cli/paper/studies.h"

#include <algorithm>
#include <cmath>

#include "cli/render/json.h"
#include "cli/web/embedded.h"
#include "lattice/scene/scene.h"

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

namespace {

constexpr char kSoft[] = "scenes/soft_left.toml", kGate[] = "scenes/single_gate.toml",
               kField[] = "scenes/field.toml";
using Words = std::vector<std::string>;

/// The studies so far, and how each kind of them is written down.
struct Studies {
  bool quick;
  std::vector<Study> list = {};

  void add(const std::string& name, int (*run)(const Arguments&), const std::string& command,
           const Words& arguments, double seconds) {
    list.push_back(
        {name, run, command, arguments, std::max<std::int64_t>(1, std::llround(100 * seconds))});
  }
  void sweep(const std::string& name, std::int64_t points, std::int64_t trials, Words arguments) {
    constexpr double kTrial = 70e-6;  // s, a gate run on two threads
    arguments.insert(arguments.end(), {"--trials", std::to_string(trials), "--seed", "1", "--csv",
                                       "data/" + name + ".csv"});
    add(name, run_sweep, "sweep", arguments, static_cast<double>(points * trials) * kTrial);
  }
  /// Of Fig. 9A's beams, over `more`.
  void tried(const std::string& name, std::int64_t points, const Words& more) {
    Words arguments{kSoft, "--set", set(kLeftStiffness, 500)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    sweep(name, points, quick ? 200 : 10000, arguments);
  }
  void trace(const std::string& name, std::int64_t trials, Words arguments) {
    arguments.insert(arguments.end(), {"--trials", std::to_string(trials), "--seed", "1"});
    add(name, run_trace, "trace", arguments, static_cast<double>(trials) * 1e-3);
  }
  void landscape(const std::string& name, Words arguments) {
    arguments.insert(arguments.end(), {"-o", "data/" + name});
    add(name, run_landscape, "landscape", arguments, 1.5);
  }
  void validate(const std::string& name, std::int64_t trials, Words arguments, double seconds) {
    arguments.insert(arguments.end(),
                     {"--bins", "paper", "--trials", std::to_string(trials), "--seed", "1"});
    add(name, run_validate, "validate", arguments, seconds);
  }
};

/// Figs. 8 and 12, the grids of Tables I and II, Fig. 8 further to the right; what could make 13 %
/// and 8 % of Fig. 9.
void add_sweeps(Studies& s) {
  const std::string damping = "beams.damping_Nms_per_rad=50,10";
  s.sweep("fig8", 84, s.quick ? 1000 : 10000,
          {"scenes/fig8.toml", "--vary", "forces.random_N=0:10:60"});
  if (s.quick)
    s.sweep("fig12", 120, 1000,
            {"scenes/fig12.toml", "--vary", std::string(kLeftStiffness) + "=100:100:500"});
  else
    s.sweep("fig12", 216, 5000, {"scenes/fig12.toml"});
  s.tried("tried_method", 12,
          {"--vary", "run.method=stable,event,moreau,paper", "--vary", damping + ",0"});
  s.tried("tried_step", 10,
          {"--set", "run.method=paper", "--vary", "run.step_s=0.02,0.01,0.004,0.002,0.001",
           "--vary", damping});
  s.tried("tried_restitution", 4, {"--vary", "contact.restitution=0.5,1", "--vary", damping});
  s.tried(
      "tried_rate", 4,
      {"--set", "run.step_s=0.004", "--vary", "forces.random_rate_Hz=10,250", "--vary", damping});
  s.tried("tried_start", 4, {"--vary", "start.vy_m_per_s=5,10", "--vary", damping});
  s.tried("tried_random", 6, {"--vary", "forces.random_N=20,40,60", "--vary", damping});
  s.tried("tried_propulsion", 14, {"--vary", "forces.propulsion_N=8:0.5:11", "--vary", damping});
  s.sweep("paper_method", 4, s.quick ? 4000 : 20000,
          {kSoft, "--vary", "run.method=paper,event", "--vary", damping});
}

/// Trajectories: with k_L = 500 hardly anybody gets through, so many are asked.
void add_traces(Studies& s) {
  s.trace("fig9_500", s.quick ? 3000 : 5000,
          {kSoft, "--set", set(kLeftStiffness, 500), "--set", set(kDamping, 50), "--only",
           "traversed"});
  s.trace("fig9_300", 100, {kSoft, "--only", "traversed"});
  s.trace("fig9_100", 100, {kSoft, "--set", set(kLeftStiffness, 100), "--only", "traversed"});
  s.trace("fig6", 100,
          {kGate, "--set", set(kPropulsion, 9), "--set", set(kRandom, 10), "--only",
           "traversed right"});
  s.trace("exits", 100,
          {kGate, "--set", set(kPropulsion, 8), "--set", set(kRandom, 40), "--only", "exited"});
  s.trace("crossing", 3, {kField, "--field", "--trial", "2"});
  s.trace("crossing_ways", 20, {kField, "--field", "--figure", "crossing.svg"});
}

/// Fig. 5, the barriers behind Fig. 9, and where the basin ends.
void add_landscapes(Studies& s) {
  s.landscape("fig5_symmetric", {kGate, "--set", set(kPropulsion, 7)});
  s.landscape("fig5_asymmetric", {kGate, "--set", set(kPropulsion, 7), "--set",
                                  set(kLeftStiffness, 500), "--set", set(kRightStiffness, 250)});
  for (int k = 100; k <= 500; k += s.quick ? 200 : 50)
    s.landscape("barrier_" + std::to_string(k), {kSoft, "--set", set(kLeftStiffness, k)});
  s.landscape("steep", {kGate, "--set", set(kPropulsion, 20), "--set", set(kRandom, 10), "--trials",
                        s.quick ? "500" : "10000"});
}

/// Fig. 11, Table IV, crossings, times; what the page begins with.
void add_validations(Studies& s) {
  s.add("prediction", run_predict, "predict",
        {kField, "--accuracy", s.quick ? "0.05" : "0.01", "--seed", "1", "--figure",
         "prediction.svg"},
        s.quick ? 1 : 5);
  s.validate("field", s.quick ? 5000 : 10000,
             s.quick ? Words{kField, "--null-draws", "99"} : Words{kField}, s.quick ? 5 : 20);
  s.validate("field_paper_method", s.quick ? 200 : 2000, {kField, "--set", "run.method=paper"},
             s.quick ? 3 : 10);
  const Words one_start{"--start", "0,0,15", "--null-draws", "99"};
  const auto with = [&](Words arguments) {
    arguments.insert(arguments.end(), one_start.begin(), one_start.end());
    return arguments;
  };
  s.validate("field_no_drag", s.quick ? 1000 : 3000,
             with({kField, "--set", "forces.drag_Ns_per_m=0", "--set", set(kDamping, 10)}), 2);
  for (const int random : {10, 20, 40})
    s.validate("field_random_" + std::to_string(random), s.quick ? 300 : 3000,
               with({kField, "--set", set(kRandom, random)}), 2);
}

}  // namespace

std::vector<Study> paper_studies(bool quick) {
  Studies studies{quick};
  add_sweeps(studies);
  add_traces(studies);
  add_landscapes(studies);
  add_validations(studies);
  return studies.list;
}

dynamics::GateParams gate_of(const char* scene, const std::vector<std::string>& overrides) {
  return lattice::parse_scene(carried_file(scene), scene, overrides).gate;
}

}  // namespace gatewalk::cli
