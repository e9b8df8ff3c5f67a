// SPDX-License-Identifier: MIT
#include "dynamics/disc/study/meaning.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>

#include "dynamics/disc/contact.h"
#include "dynamics/disc/ensemble.h"
#include "dynamics/disc/flow.h"
#include "dynamics/disc/landscape.h"

namespace gatewalk::dynamics {
namespace {

constexpr double kUnreached = std::numeric_limits<double>::infinity();
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// The resistance on the middle line (N): dE/dy of beam_energy, from the derivative of
/// forward_deflection.
double resistance_at(const GateParams& p, double y) {
  const double theta = forward_deflection(p, kLeft, 0.0, y);
  if (!(theta > 0.0)) return 0.0;
  if (std::isinf(theta)) return theta;
  const double length = p.beams.length, radius = p.body.radius;
  const double px = from_joint(p, kLeft, 0.0), py = y - p.beams.joint_y;
  const double d = std::hypot(px, py);
  double opening = 0.0;  // derivative of the opening angle by d
  if (const double tangent = d * d - radius * radius; tangent <= length * length) {
    opening = -radius / (d * std::sqrt(tangent));
  } else {
    const double cosine = (d * d + length * length - radius * radius) / (2.0 * d * length);
    opening = -(d * d - length * length + radius * radius) /
              (2.0 * d * d * length * std::sqrt(1.0 - cosine * cosine));
  }
  return (p.beams.stiffness_left + p.beams.stiffness_right) * theta *
         (px / (d * d) + opening * py / d);
}

/// The least x at which `is` is true, between `low`, where it is false, and `high`, where it is
/// true.
template <class Is>
double first_where(double low, double high, Is is) {
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    (is(middle) ? high : low) = middle;
  }
  return high;
}

/// A body without gates and noise.
struct Open {
  const GateParams& p;
  const BodyState& start;

  [[nodiscard]] BodyState after(double seconds) const {
    BodyState b = start;
    BodyFlow(p.forces.drag / p.body.mass, seconds).apply(b, 0.0, p.forces.propulsion / p.body.mass);
    return b;
  }
  [[nodiscard]] double passage() const {
    const auto through = [&](double t) { return after(t).y >= p.run.traverse_y; };
    const double unit = scale_of(p).time;
    double late = unit;
    while (!through(late))
      if ((late *= 2.0) > 1e12 * unit) return kUnreached;
    return first_where(0.0, late, through);
  }
};

}  // namespace

RingDown ring_down(const GateParams& p, Side side) {
  const double k = p.beams.stiffness(side) / p.beams.inertia();
  const double decay = 0.5 * p.beams.damping / p.beams.inertia();  // 1/s
  if (k > decay * decay) {
    const double period = 2.0 * std::numbers::pi / std::sqrt(k - decay * decay);
    return {period, std::exp(-decay * period), std::log(2.0) / decay};
  }
  const double slow = k / (decay + std::sqrt(decay * decay - k));  // the slower of both roots
  return {kUnreached, 0.0, k > 0.0 ? std::log(2.0) / slow : kUnreached};
}

BeamsOnTheMiddle beams_on_the_middle(const GateParams& p) {
  constexpr int kPoints = 4000;
  const double reach = p.beams.length + p.body.radius;
  const double push = p.forces.propulsion;
  BeamsOnTheMiddle found{0.0, 0.0, kNone};
  double low = p.beams.joint_y - reach, spacing = 2.0 * reach / kPoints, best = low;
  const auto holds = [&](double y) { return resistance_at(p, y) >= push; };
  const auto look = [&](bool for_balance) {
    for (int i = 0; i <= kPoints; ++i) {
      const double y = low + i * spacing, resists = resistance_at(p, y);
      if (for_balance && push > 0.0 && resists >= push && std::isnan(found.held_angle))
        found.held_angle = forward_deflection(p, kLeft, 0.0, first_where(y - spacing, y, holds));
      if (resists > found.resistance) {
        found.resistance = resists;
        best = y;
      }
    }
  };
  look(true);
  low = best - spacing;
  spacing *= 2.0 / kPoints;
  if (std::isfinite(found.resistance)) look(false);
  found.angle = forward_deflection(p, kLeft, 0.0, best);
  return found;
}

// A hold of the force f moves the body by f fall(h)/M and leaves it with the speed f rise(h)/M,
// which moves it by f rise(h) rise(u)/M during a later time u. Draws are independent, so their
// squares add.
double shaken_sideways(const GateParams& p, double seconds) {
  constexpr double kMostHolds = 1e6;
  const double drag = p.forces.drag / p.body.mass, draws = seconds * p.forces.random_rate;
  const double group = std::max(1.0, std::ceil(draws / kMostHolds));
  const double hold = group / p.forces.random_rate;
  const double holds = std::floor(draws / group), rest = std::max(0.0, seconds - holds * hold);
  const BodyFlow one(drag, hold);
  double squares = std::pow(BodyFlow(drag, rest).fall, 2);
  for (int i = 0; i < static_cast<int>(holds); ++i)
    squares += std::pow(one.fall + one.rise * BodyFlow(drag, rest + i * hold).rise, 2);
  return p.forces.random / p.body.mass * std::sqrt(squares / group);
}

Meaning meaning_of(const GateParams& p, const BodyState& start) {
  validate(p);
  const Open open{p, start};
  const double weight = p.body.mass * kGravity;
  Meaning m;
  m.top_speed = p.forces.drag > 0.0 ? p.forces.propulsion / p.forces.drag : kUnreached;
  m.top_speed_time =
      p.forces.drag > 0.0 ? p.body.mass / p.forces.drag * std::log(20.0) : kUnreached;
  m.passage = open.passage();
  m.passage_speed = std::isfinite(m.passage) ? open.after(m.passage).vy : kNone;
  m.shaken = shaken_sideways(p, std::min(m.passage, p.run.time_limit));
  m.draws_per_length =
      p.forces.random_rate * m.passage * 2.0 * p.body.radius / (p.run.traverse_y - start.y);
  const double fastest = std::isfinite(m.top_speed) ? m.top_speed : m.passage_speed;
  m.froude = fastest * fastest / (kGravity * p.body.radius);
  m.push_per_weight = p.forces.propulsion / weight;
  m.random_per_weight = p.forces.random / weight;
  m.passages_waited = p.run.time_limit / m.passage;
  m.beams = beams_on_the_middle(p);
  m.ring_down = {ring_down(p, kLeft), ring_down(p, kRight)};
  return m;
}

namespace {

constexpr double kChange = 0.01;
constexpr int kRuns = 20;
constexpr std::int64_t kMostWork = 1'000'000;  // steps or evaluations, well below a second

std::optional<GateFate> fate_of(const GateRun& run) {
  if (run.outcome == Outcome::broken) return {};
  if (run.outcome == Outcome::trapped) return GateFate::trapped;
  return is_traversed(run.outcome) ? GateFate::crosses : GateFate::leaves;
}

/// The fate of all runs; nullopt if the fates differ or the scene cannot be simulated.
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
