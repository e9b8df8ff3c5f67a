// SPDX-License-Identifier: MIT
#include "dynamics/disc/study/deciding.h"

#include <functional>
#include <optional>

#include "dynamics/disc/ensemble.h"

namespace gatewalk::dynamics {
namespace {

constexpr double kChange = 0.01;
constexpr int kRuns = 20;
constexpr std::int64_t kMostWork = 1'000'000;  // steps or evaluations; a second is too much here

std::optional<GateFate> fate_of(const GateRun& run) {
  if (run.outcome == Outcome::broken) return {};
  if (run.outcome == Outcome::trapped) return GateFate::trapped;
  return is_traversed(run.outcome) ? GateFate::crosses : GateFate::leaves;
}

/// Of all runs alike; nothing where they differ, or cannot be run.
std::optional<GateFate> fate(const GateParams& p, const BodyState& start) {
  try {
    const auto method = make_method(p);
    const int runs = p.forces.random > 0.0 ? kRuns : 1;
    std::optional<GateFate> all;
    for (int i = 0; i < runs; ++i) {
      const auto one = fate_of(run_gate_trial(p, *method, start, 1, i, kMostWork));
      if (!one || (all && *all != *one)) return {};
      all = one;
    }
    return all;
  } catch (const InvalidParameter&) {
    return {};
  }
}

struct Number {
  std::string_view words;
  std::function<void(GateParams&, BodyState&, double factor)> change;
};

}  // namespace

std::vector<Deciding> deciding_numbers(const GateParams& given, const BodyState& start) {
  const Number numbers[] = {
      {"the stiffness",
       [](GateParams& p, BodyState&, double f) {
         p.beams.stiffness_left *= f;
         p.beams.stiffness_right *= f;
       }},
      {"the push", [](GateParams& p, BodyState&, double f) { p.forces.propulsion *= f; }},
      {"the drag", [](GateParams& p, BodyState&, double f) { p.forces.drag *= f; }},
      {"the damping", [](GateParams& p, BodyState&, double f) { p.beams.damping *= f; }},
      {"the body's mass", [](GateParams& p, BodyState&, double f) { p.body.mass *= f; }},
      {"the body's radius", [](GateParams& p, BodyState&, double f) { p.body.radius *= f; }},
      {"the beams' length", [](GateParams& p, BodyState&, double f) { p.beams.length *= f; }},
      {"the speed at the start", [](GateParams&, BodyState& s, double f) { s.vy *= f; }},
  };
  GateParams usual = given;
  if (usual.run.method == "auto") {  // not chosen yet
    usual.run.method = "stable";
    usual.run.step = default_step(usual);
  }
  std::vector<Deciding> all;
  for (const Number& number : numbers) {
    const auto changed = [&](double factor) {
      GateParams p = usual;
      BodyState s = start;
      number.change(p, s, factor);
      return fate(p, s);
    };
    const auto less = changed(1.0 - kChange);
    if (!less) continue;
    const auto more = changed(1.0 + kChange);
    if (more && *more != *less) all.push_back({number.words, *less, *more});
  }
  return all;
}

}  // namespace gatewalk::dynamics
