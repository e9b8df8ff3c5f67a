// SPDX-License-Identifier: MIT
#include "cli/render/meaning.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

#include "cli/render/json.h"
#include "cli/render/quantity.h"
#include "cli/render/text.h"
#include "lattice/scene/settle.h"

namespace gatewalk::cli {
namespace {

using dynamics::Meaning;

// A walk ends at a Froude number of 1, where gravity no longer keeps the body on a stiff leg; fast
// runners reach 10 to 30. Feet hold by friction. Legs step a few times per length of the body.
constexpr double kFastestRun = 30.0, kMostGrip = 1.0, kMostSteps = 10.0, kLeastPatience = 5.0;

/// Three digits, without an exponent where people need none.
std::string three_digits(double x) {
  if (!std::isfinite(x)) return "-";
  const double size = std::abs(x);
  return size >= 100.0 && size < 1e6 ? fixed(x, 0) : digits(x, 3);
}

std::string times_as(double x) {
  return three_digits(x) + (three_digits(x) == "1" ? " time" : " times");
}
std::string degrees(double angle) {
  return three_digits(angle * 180.0 / std::numbers::pi) + " degrees";
}

std::string ringing(const dynamics::RingDown& r) {
  if (std::isfinite(r.period))
    return "swings once in " + quantity(r.period, "s", 3) + ", each swing " + three_digits(r.kept) +
           " of the one before";
  return std::isfinite(r.half) ? "creeps back without a swing, in the end half of its angle in " +
                                     quantity(r.half, "s", 3)
                               : "does not come back";
}

std::string_view words_of(dynamics::GateFate fate) {
  switch (fate) {
    case dynamics::GateFate::crosses:
      return "crosses";
    case dynamics::GateFate::leaves:
      return "leaves by a side";
    case dynamics::GateFate::trapped:
      break;
  }
  return "is trapped";
}

/// Numbers that decide alike in a line.
std::string steps_text(std::vector<dynamics::Deciding> left) {
  std::string text;
  while (!left.empty()) {
    const dynamics::Deciding first = left.front();
    std::string names;
    std::erase_if(left, [&](const dynamics::Deciding& d) {
      const bool alike = d.less == first.less && d.more == first.more;
      if (alike) names += (names.empty() ? "" : ", or ") + std::string(d.words);
      return alike;
    });
    text += (text.empty() ? "  on a step 1 % less of " : "            1 % less of ") + names +
            ": the body " + std::string(words_of(first.less)) + "; 1 % more: it " +
            std::string(words_of(first.more)) + "\n";
  }
  return text;
}

}  // namespace

std::vector<FarFromWalkers> far_from_walkers(const Meaning& m, const lattice::Scene& scene) {
  std::vector<FarFromWalkers> all;
  const bool has_top = std::isfinite(m.top_speed);
  const double fastest = has_top ? m.top_speed : m.passage_speed;
  if (m.froude > kFastestRun)
    all.push_back({"froude",
                   quantity(fastest, "m/s", 3) +
                       (has_top ? " at most in the open, " : " at the end of an open gate, ") +
                       three_digits(fastest / (2.0 * scene.gate.body.radius)) +
                       " body lengths per second",
                   "v^2/(g R) = " + three_digits(m.froude) +
                       ", with the radius for a leg: nothing walks above 1, and fast runners reach "
                       "10 to 30"});
  if (m.push_per_weight > kMostGrip)
    all.push_back({"push_per_weight",
                   "a push of " + times_as(m.push_per_weight) + " the body's weight",
                   "feet hold by friction, which is seldom more than the weight"});
  if (m.random_per_weight > kMostGrip)
    all.push_back({"random_per_weight",
                   "a random force of " + times_as(m.random_per_weight) + " the body's weight",
                   "feet hold by friction, which is seldom more than the weight"});
  if (m.draws_per_length > kMostSteps)
    all.push_back({"draws_per_length",
                   three_digits(m.draws_per_length) + " draws of the random force per body length",
                   "legs step a few times while the body goes its own length"});
  if (m.passages_waited < kLeastPatience)
    all.push_back({"passages_waited",
                   "trapped after " + quantity(scene.gate.run.time_limit, "s", 3) + ", " +
                       times_as(m.passages_waited) + " what an open gate takes",
                   "who is slow, or tries again, counts like who is stuck: run.time_limit_s is how "
                   "long you would watch"});
  return all;
}

std::string far_from_walkers_line(const lattice::Scene& scene) {
  if (scene.named.empty() || lattice::derived_keys(scene).empty()) return "";
  std::string all;
  for (const FarFromWalkers& far :
       far_from_walkers(dynamics::meaning_of(scene.gate, scene.start), scene))
    all += (all.empty() ? "" : "; ") + far.what;
  if (all.empty()) return all;
  return "that is far from any animal or robot that walks: " + all + " (gatewalk scene " +
         scene.source + " says why)";
}

Json to_json(const Meaning& m, const lattice::Scene& scene) {
  const auto of_beam = [](const dynamics::RingDown& r) {
    return Json{
        {"period_s", or_null(r.period)}, {"kept_per_swing", r.kept}, {"half_s", or_null(r.half)}};
  };
  Json json{{"top_speed_m_per_s", or_null(m.top_speed)},
            {"top_speed_time_s", or_null(m.top_speed_time)},
            {"passage_s", or_null(m.passage)},
            {"passage_speed_m_per_s", or_null(m.passage_speed)},
            {"shaken_sideways_m", m.shaken},
            {"draws_per_body_length", or_null(m.draws_per_length)},
            {"froude", or_null(m.froude)},
            {"push_per_weight", m.push_per_weight},
            {"random_per_weight", m.random_per_weight},
            {"passages_waited", m.passages_waited},
            {"resistance_N", or_null(m.beams.resistance)},
            {"resistance_angle_rad", or_null(m.beams.angle)},
            {"held_angle_rad", or_null(m.beams.held_angle)},
            {"ring_down",
             {{"left", of_beam(m.ring_down[dynamics::kLeft])},
              {"right", of_beam(m.ring_down[dynamics::kRight])}}}};
  json["far_from_walkers"] = Json::array();
  for (const FarFromWalkers& far : far_from_walkers(m, scene))
    json["far_from_walkers"].push_back(
        {{"name", far.name}, {"what", far.what}, {"reason", far.reason}});
  return json;
}

std::string meaning_text(const Meaning& m, const std::vector<dynamics::Deciding>& deciding,
                         const lattice::Scene& scene) {
  const auto& gate = scene.gate;
  const double body_length = 2.0 * gate.body.radius;
  const bool passes = std::isfinite(m.passage);
  std::string text = scene.terrain ? "\nwhat these numbers mean, in the scene's own gate:\n"
                                   : "\nwhat these numbers mean:\n";
  text += "  speed     ";
  if (std::isfinite(m.top_speed))
    text += "at most " + quantity(m.top_speed, "m/s", 3) + " in the open, " +
            three_digits(m.top_speed / body_length) + " body lengths per second (95 % of it " +
            quantity(m.top_speed_time, "s", 3) + " after a start from rest); ";
  else
    text += "without drag no top speed; ";
  text += passes ? "from the start through a gate without beams in " + quantity(m.passage, "s", 3) +
                       ", " + quantity(m.passage_speed, "m/s", 3) + " at its end\n"
                 : "it never gets through a gate, even without beams\n";
  text += "  sideways  noise shakes the body by " + quantity(m.shaken, "m", 3) +
          " (standard deviation) in " + quantity(std::min(m.passage, gate.run.time_limit), "s", 3) +
          ", " + three_digits(m.shaken / gate.beams.joint_x) + " of the way to a joint";
  if (gate.forces.propulsion > 0.0)
    text += "; the random force is " + times_as(gate.forces.random / gate.forces.propulsion) +
            " the push";
  if (passes) text += ", drawn " + times_as(m.draws_per_length) + " per body length";
  text += "\n  beams     ";
  if (m.beams.resistance == 0.0)
    text += "a body on the middle line gets past them without resistance\n";
  else if (std::isnan(m.beams.held_angle) && gate.forces.propulsion > 0.0)
    text += "on the middle line they resist with at most " + quantity(m.beams.resistance, "N", 3) +
            " (at " + degrees(m.beams.angle) + "); the push of " +
            quantity(gate.forces.propulsion, "N", 3) + " bends them aside\n";
  else if (gate.forces.propulsion > 0.0)
    text += "on the middle line they hold the push of " + quantity(gate.forces.propulsion, "N", 3) +
            " at " + degrees(m.beams.held_angle) +
            (std::isfinite(m.beams.resistance)
                 ? "; at " + degrees(m.beams.angle) + " they would hold " +
                       quantity(m.beams.resistance, "N", 3) +
                       ", the most: only speed or noise "
                       "takes the body on\n"
                 : "; there the body covers their joints and cannot get past\n");
  else
    text += "there is no push\n";
  const bool alike = gate.beams.stiffness_left == gate.beams.stiffness_right;
  text += std::string("            let go, ") + (alike ? "a beam " : "the left one ") +
          ringing(m.ring_down[dynamics::kLeft]) +
          (alike ? "" : "; the right one " + ringing(m.ring_down[dynamics::kRight])) + "\n";
  text += "  trapped   is who is still in a gate after " + quantity(gate.run.time_limit, "s", 3);
  if (passes) text += ", " + times_as(m.passages_waited) + " what a gate without beams takes";
  text += "\n";
  text += steps_text(deciding);
  const auto all = far_from_walkers(m, scene);
  if (!all.empty()) text += "far from any animal or robot that walks:\n";
  for (const FarFromWalkers& far : all) text += "  " + far.what + ": " + far.reason + "\n";
  return text;
}

std::vector<std::string> remarks(const Meaning& m, const std::vector<dynamics::Deciding>& deciding,
                                 const lattice::Scene& scene) {
  constexpr std::size_t kText = 12;  // where sentences begin
  std::vector<std::string> all;
  std::istringstream lines(meaning_text(m, deciding, scene));
  lines.exceptions(std::ios_base::badbit);
  std::string about;
  std::getline(lines, about);  // an empty line, and the heading
  std::getline(lines, about);
  for (std::string line; std::getline(lines, line) && line.starts_with("  ");) {
    std::string name = line.substr(2, kText - 2);
    name.erase(name.find_last_not_of(' ') + 1);
    if (!name.empty()) about = name;
    all.push_back(about + ": " + line.substr(kText));
  }
  for (const FarFromWalkers& far : far_from_walkers(m, scene))
    all.push_back("far from what walks: " + far.what + ": " + far.reason);
  return all;
}

}  // namespace gatewalk::cli
