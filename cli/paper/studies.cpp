// SPDX-License-Identifier: MIT
#include "cli/paper/studies.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "cli/web/embedded.h"
#include "lattice/scene/scene.h"

namespace gatewalk::cli {

std::string set(const char* key, double value) { return fmt::format("{}={}", key, value); }

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

using Take = std::function<void(Findings&, const Json&)>;

/// Puts a study's result into a member of the findings, or into an entry of a map there.
template <class Finding>
Take into(Finding Findings::*member) {
  return [member](Findings& f, const Json& json) { f.*member = found_in<Finding>(json); };
}
template <class Finding>
Take into(std::map<int, Finding> Findings::*member, int key) {
  return
      [member, key](Findings& f, const Json& json) { (f.*member)[key] = found_in<Finding>(json); };
}

Words operator+(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

/// A list of studies, with functions that add each kind of study.
struct Studies {
  bool quick;
  std::vector<Study> list = {};

  void add(const std::string& name, int (*run)(const Arguments&), const std::string& command,
           const Words& arguments, double seconds, const Take& take = nullptr) {
    list.push_back({name, run, command, arguments,
                    std::max<std::int64_t>(1, std::llround(100 * seconds)), take});
  }
  void sweep(const std::string& name, Sweep Findings::*member, std::int64_t points,
             std::int64_t trials, const Words& arguments) {
    constexpr double kTrial = 70e-6;  // s, a gate run on two threads
    add(name, run_sweep, "sweep",
        arguments + Words{"--trials", std::to_string(trials), "--seed", "1", "--csv",
                          "data/" + name + ".csv"},
        static_cast<double>(points * trials) * kTrial, into(member));
  }
  /// Adds a sweep over `more` with the beams of Fig. 9A.
  void tried(const std::string& name, Sweep Findings::*member, std::int64_t points,
             const Words& more) {
    sweep(name, member, points, quick ? 200 : 10000,
          Words{kSoft, "--set", set(kLeftStiffness, 500)} + more);
  }
  void trace(const std::string& name, const Take& take, std::int64_t trials,
             const Words& arguments) {
    add(name, run_trace, "trace",
        arguments + Words{"--trials", std::to_string(trials), "--seed", "1"},
        static_cast<double>(trials) * 1e-3, take);
  }
  void landscape(const std::string& name, const Take& take, const Words& arguments) {
    add(name, run_landscape, "landscape", arguments + Words{"-o", "data/" + name}, 1.5, take);
  }
  void validate(const std::string& name, const Take& take, std::int64_t trials,
                const Words& arguments, double seconds) {
    add(name, run_validate, "validate",
        arguments + Words{"--bins", "paper", "--trials", std::to_string(trials), "--seed", "1"},
        seconds, take);
  }
};

/// Adds the sweeps: the grids of Tables I and II for Figs. 8 and 12, with larger random forces for
/// Fig. 8, and what could explain the 13 % and 8 % of Fig. 9.
void add_sweeps(Studies& s) {
  const Words damping{"--vary", "beams.damping_Nms_per_rad=50,10"};
  s.sweep("fig8", &Findings::fig8, 84, s.quick ? 1000 : 10000,
          {"scenes/fig8.toml", "--vary", "forces.random_N=0:10:60"});
  if (s.quick)
    s.sweep("fig12", &Findings::fig12, 120, 1000,
            {"scenes/fig12.toml", "--vary", std::string(kLeftStiffness) + "=100:100:500"});
  else
    s.sweep("fig12", &Findings::fig12, 216, 5000, {"scenes/fig12.toml"});
  s.tried("tried_method", &Findings::tried_method, 12,
          {"--vary", "run.method=stable,event,moreau,paper", "--vary", damping[1] + ",0"});
  s.tried("tried_step", &Findings::tried_step, 10,
          Words{"--set", "run.method=paper", "--vary", "run.step_s=0.02,0.01,0.004,0.002,0.001"} +
              damping);
  s.tried("tried_restitution", &Findings::tried_restitution, 4,
          Words{"--vary", "contact.restitution=0.5,1"} + damping);
  s.tried("tried_rate", &Findings::tried_rate, 4,
          Words{"--set", "run.step_s=0.004", "--vary", "forces.random_rate_Hz=10,250"} + damping);
  s.tried("tried_start", &Findings::tried_start, 4,
          Words{"--vary", "start.vy_m_per_s=5,10"} + damping);
  s.tried("tried_random", &Findings::tried_random, 6,
          Words{"--vary", "forces.random_N=20,40,60"} + damping);
  s.tried("tried_propulsion", &Findings::tried_propulsion, 14,
          Words{"--vary", "forces.propulsion_N=8:0.5:11"} + damping);
  s.sweep("paper_method", &Findings::paper_method, 4, s.quick ? 4000 : 20000,
          Words{kSoft, "--vary", "run.method=paper,event"} + damping);
}

/// Adds the trajectories. With k_L = 500 few bodies traverse, so these studies have many trials.
void add_traces(Studies& s) {
  s.trace("fig9_500", into(&Findings::fig9_500), s.quick ? 3000 : 5000,
          {kSoft, "--set", set(kLeftStiffness, 500), "--set", set(kDamping, 50), "--only",
           "traversed"});
  s.trace("fig9_300", into(&Findings::fig9_300), 100, {kSoft, "--only", "traversed"});
  s.trace("fig9_100", into(&Findings::fig9_100), 100,
          {kSoft, "--set", set(kLeftStiffness, 100), "--only", "traversed"});
  s.trace("fig6", into(&Findings::fig6), 100,
          {kGate, "--set", set(kPropulsion, 9), "--set", set(kRandom, 10), "--only",
           "traversed right"});
  s.trace("exits", into(&Findings::exits), 100,
          {kGate, "--set", set(kPropulsion, 8), "--set", set(kRandom, 40), "--only", "exited"});
  s.trace("crossing", [](Findings& f, const Json& json) { f.crossing = json; }, 3,
          {kField, "--field", "--trial", "2"});
  s.trace("crossing_ways", nullptr, 20, {kField, "--field", "--figure", "crossing.svg"});
}

/// Adds the landscapes: Fig. 5, the barriers behind Fig. 9, and where the basin ends.
void add_landscapes(Studies& s) {
  s.landscape("fig5_symmetric", into(&Findings::fig5_symmetric),
              {kGate, "--set", set(kPropulsion, 7)});
  s.landscape("fig5_asymmetric", nullptr,
              {kGate, "--set", set(kPropulsion, 7), "--set", set(kLeftStiffness, 500), "--set",
               set(kRightStiffness, 250)});
  for (int k = 100; k <= 500; k += s.quick ? 200 : 50)
    s.landscape("barrier_" + std::to_string(k), into(&Findings::barriers, k),
                {kSoft, "--set", set(kLeftStiffness, k)});
  s.landscape("steep", into(&Findings::steep),
              {kGate, "--set", set(kPropulsion, 20), "--set", set(kRandom, 10), "--trials",
               s.quick ? "500" : "10000"});
}

/// Adds the validations: Fig. 11, Table IV, crossings, times; and the prediction with which the
/// page begins.
void add_validations(Studies& s) {
  s.add("prediction", run_predict, "predict",
        {kField, "--accuracy", s.quick ? "0.05" : "0.01", "--seed", "1", "--figure",
         "prediction.svg"},
        s.quick ? 1 : 5);
  const Words few_draws{"--null-draws", "99"}, one_start = Words{"--start", "0,0,15"} + few_draws;
  s.validate("field", into(&Findings::field), s.quick ? 5000 : 10000,
             Words{kField} + (s.quick ? few_draws : Words{}), s.quick ? 5 : 20);
  s.validate("field_paper_method", into(&Findings::field_paper_method), s.quick ? 200 : 2000,
             {kField, "--set", "run.method=paper"}, s.quick ? 3 : 10);
  s.validate(
      "field_no_drag", into(&Findings::field_no_drag), s.quick ? 1000 : 3000,
      Words{kField, "--set", "forces.drag_Ns_per_m=0", "--set", set(kDamping, 10)} + one_start, 2);
  for (const int random : {10, 20, 40})
    s.validate("field_random_" + std::to_string(random), into(&Findings::field_random, random),
               s.quick ? 300 : 3000, Words{kField, "--set", set(kRandom, random)} + one_start, 2);
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

const PaperPoint& fig8_at(const Findings& f, double damping, double force, double random) {
  return f.fig8.at({{kDamping, damping}, {kPropulsion, force}, {kRandom, random}});
}
const PaperPoint& fig12_at(const Findings& f, double damping, double force, double random,
                           double k_left) {
  return f.fig12.at(
      {{kDamping, damping}, {kPropulsion, force}, {kRandom, random}, {kLeftStiffness, k_left}});
}

}  // namespace gatewalk::cli
