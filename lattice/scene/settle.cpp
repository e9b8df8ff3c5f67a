// SPDX-License-Identifier: MIT
#include "lattice/scene/settle.h"

#include <fmt/core.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "lattice/gates/gates.h"
#include "lattice/scene/bins.h"
#include "lattice/scene/scene_keys.h"
#include "lattice/scene/terrain.h"
#include "lattice/text/digits.h"

namespace gatewalk::lattice {
namespace {

/// The scene's start, and the centres of eight bins spread over the state space.
std::vector<dynamics::BodyState> pilot_starts(const Scene& scene, RunsFrom from) {
  std::vector<dynamics::BodyState> starts{scene.start};
  if (from == RunsFrom::start) return starts;
  const auto space = fixed_space(scene);
  for (int i = 0; i < 8; ++i) {
    const dynamics::StateRange range = space.range(i * (space.size() - 1) / 7);
    starts.push_back(dynamics::entry_state(scene.gate, range.middle()));
  }
  return starts;
}

const dynamics::Setting& setting_of(const dynamics::Choice& choice) {
  return choice.met ? choice.tried.back().setting : choice.reference;
}

/// The work of the chosen setting; infinite if no setting was good enough.
double work_of(const dynamics::Choice& choice) {
  return choice.met ? choice.tried.back().work : std::numeric_limits<double>::infinity();
}

}  // namespace

std::vector<std::string> keys_without_effect(const Scene& scene, RunsFrom from) {
  std::vector<std::string> told;
  const std::string& method = scene.gate.run.method;
  if (!scene.sweep.empty())
    told.push_back("the table [sweep] of " + scene.source +
                   " has no effect here: gatewalk sweep runs it");
  if (scene.terrain && from == RunsFrom::start) told.push_back(terrain_without_effect(scene));
  const auto unused = [&](const char* key, const std::string& why) {
    if (!has_effect(scene, key) && scene.named.contains(key))
      told.push_back(std::string(key) + " has no effect: " + why);
  };
  const std::string says = "run.method = \"" + method + "\" ";
  const bool chosen = method == "auto";
  unused("run.step_s", says + (chosen ? "chooses it" : "has no step"));
  unused("run.event_tolerance_m", says + (chosen ? "chooses it" : "does not use it"));
  return told;
}

std::string terrain_without_effect(const Scene& scene) {
  return scene.terrain ? "the table [terrain] of " + scene.source +
                             " has no effect here: one gate is run, the scene's own"
                       : "";
}

namespace {

bool of_the_method(std::string_view key) {
  return key == "run.step_s" || key == "run.event_tolerance_m" ||
         key == "contact.impulse_threshold_Ns";
}

}  // namespace

std::string derived_keys(const Scene& scene) {
  if (scene.named.empty() && !scene.terrain)
    return scene.source + " names no key: this is the paper's scene, 1 kg and 10 m in radius";
  const std::vector<KeyInfo> keys = describe(scene);
  const auto scaled = std::ranges::count_if(
      keys, [](const KeyInfo& k) { return k.source == "derived" && !of_the_method(k.key); });
  if (scaled == 0) return "";
  const auto unchanged = std::ranges::count_if(keys, [](const KeyInfo& k) {
    return k.source == "paper" && k.key.starts_with("contact.") && !of_the_method(k.key);
  });
  const auto left_out = scaled + unchanged;
  return fmt::format(
      "{0} leaves out {1} key{2}: gatewalk scaled the paper's value{3} of {4} to this body{5} "
      "(gatewalk scene {0} shows them)",
      scene.source, left_out, left_out == 1 ? "" : "s", scaled == 1 ? "" : "s",
      unchanged == 0 ? (scaled == 1 ? "it" : "them") : std::to_string(scaled),
      unchanged == 0 ? ""
                     : fmt::format(", and took {} of contact from the paper unchanged", unchanged));
}

namespace {

/// Keys that the scene leaves out and that would differ in a file with another forces.propulsion_N,
/// without keys of the method. An override does not change them.
std::vector<std::string> keys_that_follow_the_push(const Scene& scene) {
  constexpr std::string_view kPush = "forces.propulsion_N";
  const auto filled = [&](double push) {
    std::pair<dynamics::GateParams, dynamics::BodyState> all{scene.gate, Scene{}.start};
    all.first.forces.propulsion = push;
    dynamics::fill_in(all.first, all.second, [&](std::string_view key) {
      return key == kPush || scene.named.contains(key) || of_the_method(key);
    });
    return all;
  };
  std::vector<std::string> keys;
  if (!(scene.gate.forces.propulsion > 0.0)) return keys;
  const auto [here, start] = filled(scene.gate.forces.propulsion);
  const auto [there, other_start] = filled(2.0 * scene.gate.forces.propulsion);
  for (const dynamics::ParamInfo& info : dynamics::gate_param_table())
    if (scene.derived.contains(info.key) && info.key != kPush && info.get(here) != info.get(there))
      keys.emplace_back(info.key);
  if (scene.derived.contains("start.vy_m_per_s") && start.vy != other_start.vy)
    keys.emplace_back("start.vy_m_per_s");
  return keys;
}

}  // namespace

std::string numbers_from_the_push(const Scene& scene) {
  std::string all;
  for (const std::string& key : keys_that_follow_the_push(scene))
    if (!key.starts_with("run.")) all += (all.empty() ? "" : ", ") + key;
  if (const std::size_t comma = all.rfind(", "); comma != all.npos) all.replace(comma, 1, " and");
  return all;
}

namespace {
FieldGates gates_for(const Scene& scene, RunsFrom from) {
  return from == RunsFrom::all_types ? all_gates_of(scene) : gates_of(scene);
}
}  // namespace

std::optional<Settled> settle_method(Scene& scene, RunsFrom from, std::uint64_t seed,
                                     const dynamics::Work& work) {
  if (scene.gate.run.method != "auto") return {};
  Settled settled;
  settled.tolerance = scene.gate.run.tolerance;
  const auto starts = pilot_starts(scene, from);
  settled.pilot_starts = starts.size();
  const auto chosen_for = [&](const dynamics::GateParams& gate) {
    return dynamics::choose_method(
        gate, starts, seed,
        [&](const dynamics::Setting& s, std::int64_t done, std::int64_t trials) {
          work.tell("run.method \"auto\": pilot of " + std::to_string(trials) + " trials, " +
                        s.method + " " + shortest(s.value),
                    done, trials);
        });
  };
  // One method for all types of gates: of the methods chosen for each, the one with the most work.
  const FieldGates gates = gates_for(scene, from);
  settled.choice = chosen_for(scene.gate);
  for (std::size_t type = 1; type < gates.types().size(); ++type)
    if (dynamics::Choice other = chosen_for(gates.types()[type]);
        work_of(other) > work_of(settled.choice))
      settled.choice = std::move(other);
  scene.gate = setting_of(settled.choice).applied_to(scene.gate);
  return settled;
}

void check_outcomes(const Scene& scene, RunsFrom from, std::uint64_t seed, std::int64_t trials,
                    dynamics::Health& health, const dynamics::Work& work) {
  const FieldGates gates = gates_for(scene, from);
  for (const dynamics::GateParams& gate :
       from == RunsFrom::start ? std::vector{scene.gate} : gates.types())
    dynamics::check_outcomes(health, gate, pilot_starts(scene, from), seed,
                             dynamics::check_sample(trials), work);
}

}  // namespace gatewalk::lattice
