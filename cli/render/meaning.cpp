// SPDX-License-Identifier: MIT
#include "cli/render/meaning.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "cli/fields/text.h"
#include "cli/render/quantity.h"
#include "cli/render/scene.h"
#include "lattice/scene/settle.h"
#include "lattice/scene/terrain.h"

namespace gatewalk::cli {
namespace {

using dynamics::Meaning;

// Limits for walkers. A walk ends at a Froude number of 1, where gravity no longer keeps the body
// on a stiff leg; fast runners reach 10 to 30. Friction holds the feet. Legs step a few times per
// body width.
constexpr const char* kGrip =
    "friction holds few robots by more than their weight; insects with claws hold by more";
constexpr double kFastestRun = 30.0, kMostGrip = 1.0, kMostSteps = 10.0, kLeastPatience = 5.0;

/// Three digits, without an exponent for numbers of moderate size.
std::string three_digits(double x) {
  if (!std::isfinite(x)) return "-";
  const double size = std::abs(x);
  return size >= 100.0 && size < 1e6 ? fixed(x, 0) : digits(x, 3);
}

std::string times_as(double x) {
  return three_digits(x) + (three_digits(x) == "1" ? " time" : " times");
}
/// A length in the unit in which a body is measured: "16 cm".
std::string length_words(double x) {
  return x >= 0.01 && x < 1.0 ? digits(100.0 * x, 3) + " cm" : quantity(x, "m", 3);
}
std::string degrees(double angle) {
  return three_digits(angle * 180.0 / std::numbers::pi) + " degrees";
}

std::string ringing(const dynamics::RingDown& r) {
  if (std::isfinite(r.period))
    return fmt::format("swings once in {}, each swing with {} of the amplitude before",
                       quantity(r.period, "s", 3), three_digits(r.kept));
  return std::isfinite(r.half)
             ? fmt::format("creeps back without a swing, in the end half of its angle in {}",
                           quantity(r.half, "s", 3))
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

/// A sentence on the meaning of the numbers, with its subject.
struct Sentence {
  std::string about, words;
};

/// Sentences on threshold numbers; numbers with the same effect share a sentence. Where noise makes
/// the runs differ, the push may still be near the beams' largest resistance.
std::vector<Sentence> thresholds(std::vector<dynamics::Deciding> left, double push,
                                 double resistance) {
  std::vector<Sentence> all;
  constexpr double kNear = 0.05;
  if (left.empty() && resistance > 0.0 && std::isfinite(resistance) &&
      std::abs(push - resistance) <= kNear * resistance)
    all.push_back(
        {"threshold",
         fmt::format(
             "the push is within {} % of the beams' largest resistance: 1 % more or less of "
             "a number can decide between crossing and being trapped (gatewalk analyze "
             "shows of which)",
             digits(100.0 * kNear))});
  while (!left.empty()) {
    const dynamics::Deciding first = left.front();
    std::string names;
    std::erase_if(left, [&](const dynamics::Deciding& d) {
      const bool alike = d.less == first.less && d.more == first.more;
      if (alike) names += (names.empty() ? "" : ", or ") + std::string(d.words);
      return alike;
    });
    all.push_back({"threshold", fmt::format("with 1 % less of {} the body {}; with 1 % more it {}",
                                            names, words_of(first.less), words_of(first.more))});
  }
  return all;
}

std::string speed_words(const lattice::Scene& scene, const Meaning& m) {
  const std::string top =
      std::isfinite(m.top_speed)
          ? fmt::format(
                "at most {} in the open, {} body widths per second (95 % of it {} after a start "
                "from rest); ",
                quantity(m.top_speed, "m/s", 3),
                three_digits(m.top_speed / (2.0 * scene.gate.body.radius)),
                quantity(m.top_speed_time, "s", 3))
          : "without drag there is no top speed; ";
  return top +
         (std::isfinite(m.passage)
              ? fmt::format("from the start the body passes a gate without beams in {}, at {} "
                            "in the end",
                            quantity(m.passage, "s", 3), quantity(m.passage_speed, "m/s", 3))
              : "the body never gets through a gate, even without beams");
}

std::string sideways_words(const lattice::Scene& scene, const Meaning& m) {
  const auto& gate = scene.gate;
  std::string text = fmt::format(
      "noise moves the body by {} (standard deviation) in {}, {} of the way to a joint",
      quantity(m.shaken, "m", 3), quantity(std::min(m.passage, gate.run.time_limit), "s", 3),
      three_digits(m.shaken / gate.beams.joint_x));
  if (gate.forces.propulsion > 0.0)
    text += fmt::format("; the random force is {} the push",
                        times_as(gate.forces.random / gate.forces.propulsion));
  if (std::isfinite(m.passage))
    text += fmt::format(", drawn {} per body width", times_as(m.draws_per_length));
  return text;
}

std::string resistance_words(const lattice::Scene& scene, const Meaning& m) {
  const auto& beams = m.beams;
  const std::string push = quantity(scene.gate.forces.propulsion, "N", 3),
                    resistance = quantity(beams.resistance, "N", 3), angle = degrees(beams.angle);
  if (beams.resistance == 0.0)
    return "a body on the middle line gets past the beams without resistance";
  if (!(scene.gate.forces.propulsion > 0.0)) return "there is no push";
  if (std::isnan(beams.held_angle))
    return fmt::format(
        "on the middle line the beams resist with at most {} (at {}); the push of {} bends them "
        "aside",
        resistance, angle, push);
  return fmt::format(
      "on the middle line the beams hold the push of {} at {}; {}", push, degrees(beams.held_angle),
      std::isfinite(beams.resistance)
          ? fmt::format("they resist most at {}, with {}, so only speed or noise takes the body on",
                        angle, resistance)
          : "there the body covers their joints and cannot get past");
}

std::string swing_words(const lattice::Scene& scene, const Meaning& m) {
  const auto& beams = scene.gate.beams;
  const std::string left = ringing(m.ring_down[dynamics::kLeft]);
  return beams.stiffness_left == beams.stiffness_right
             ? fmt::format("once released, a beam {}", left)
             : fmt::format("once released, the left beam {}; the right one {}", left,
                           ringing(m.ring_down[dynamics::kRight]));
}

/// Sentences on the meaning of the numbers, without those on far_from_walkers().
std::vector<Sentence> sentences(const SceneResult& result) {
  const auto& [scene, m, deciding] = result;
  const auto& gate = scene.gate;
  std::vector<Sentence> all{
      {"size",
       fmt::format("the body is {} wide, twice its radius; the joints of a gate are {} apart",
                   length_words(2.0 * gate.body.radius), length_words(2.0 * gate.beams.joint_x))},
      {"speed", speed_words(scene, m)},
      {"sideways", sideways_words(scene, m)},
      {"beams", resistance_words(scene, m)},
      {"beams", swing_words(scene, m)},
      {"trapped",
       fmt::format("a body counts as trapped after {} in one gate{}",
                   quantity(scene.gate.run.time_limit, "s", 3),
                   std::isfinite(m.passage) ? fmt::format(", {} what a gate without beams takes",
                                                          times_as(m.passages_waited))
                                            : "")}};
  for (Sentence& s : thresholds(deciding, scene.gate.forces.propulsion, m.beams.resistance))
    all.push_back(std::move(s));
  if (scene.derived.contains("start.vy_m_per_s") && scene.start.vy > m.top_speed)
    all.push_back(
        {"start",
         fmt::format("gatewalk computed the start speed {}, faster than the top speed of {} "
                     "in the open: give start.vy_m_per_s",
                     quantity(scene.start.vy, "m/s", 3), quantity(m.top_speed, "m/s", 3))});
  if (const std::string numbers = lattice::numbers_from_the_push(scene);
      !numbers.empty() && scene.named.contains("forces.propulsion_N"))
    all.push_back(
        {"push", fmt::format("gatewalk computed {} from the push; --set forces.propulsion_N=VALUE "
                             "changes the push alone",
                             numbers)});
  return all;
}

/// The meaning of the numbers, as a paragraph above the table of keys.
std::string meaning_text(const SceneResult& result) {
  std::string text = fmt::format("What these numbers mean{}\n",
                                 result.scene.terrain ? ", in the scene's own gate" : "");
  std::string before;
  for (const auto& [about, words] : sentences(result)) {
    text += wrapped(fmt::format("  {:<11}{}", about == before ? "" : about, words),
                    std::string(13, ' '));
    before = about;
  }
  const auto all = far_from_walkers(result.meaning, result.scene);
  if (!all.empty())
    text += "Beware: unusual for a walking animal or robot; measure your own numbers\n";
  for (const FarFromWalkers& far : all)
    text += wrapped(fmt::format("  {}: {}", far.what, far.reason), "    ");
  return text;
}

/// Remarks on the scene, each after its subject: "sideways: noise moves the body by ...".
std::vector<std::string> remarks(const SceneResult& result) {
  std::vector<std::string> all;
  for (const auto& [about, words] : sentences(result))
    all.push_back(fmt::format("{}: {}", about, words));
  for (const FarFromWalkers& far : far_from_walkers(result.meaning, result.scene))
    all.push_back(fmt::format("far from what walks: {}: {}", far.what, far.reason));
  return all;
}

void describe(Fields& out, const dynamics::RingDown& r) {
  out.number({"period_s", "s",
              "period of the beam's free swing; null: the beam creeps back without a swing"},
             r.period);
  out.number({"kept_per_swing", "1",
              "amplitude of a swing divided by that of the swing before; 0: no swing"},
             r.kept);
  out.number(
      {"half_s", "s",
       "time in which the angle, or its amplitude, halves in the long run; null: it never does"},
      r.half);
}

void describe_meaning(Fields& out, const Meaning& m, const lattice::Scene& scene) {
  out.number(
      {"top_speed_m_per_s", "m/s", "top speed without beams: propulsion / drag; null: no drag"},
      m.top_speed);
  out.number({"top_speed_time_s", "s", "time from rest to 95 % of the top speed; null: no drag"},
             m.top_speed_time);
  out.number(
      {"passage_s", "s",
       "time from the start to the end of a gate without beams and noise; null: never there"},
      m.passage);
  out.number({"passage_speed_m_per_s", "m/s",
              "speed at the end of the passage in passage_s; null: never there"},
             m.passage_speed);
  out.number({"shaken_sideways_m", "m",
              "standard deviation of the sideways place from noise after passage_s or the time "
              "limit, if shorter"},
             m.shaken);
  out.number({"draws_per_body_length", "1",
              "draws of the random force while the body moves its own length; null: no passage"},
             m.draws_per_length);
  out.number({"froude", "1",
              "Froude number v^2/(g R) with R the body radius, v the top speed or passage speed; "
              "null: no v"},
             m.froude);
  out.number({"push_per_weight", "1", "propulsion divided by the body's weight on Earth"},
             m.push_per_weight);
  out.number({"random_per_weight", "1", "random force divided by the body's weight on Earth"},
             m.random_per_weight);
  out.number({"passages_waited", "1", "run.time_limit_s divided by passage_s; 0: no passage"},
             m.passages_waited);
  out.number(
      {"resistance_N", "N",
       "largest resistance of both beams to a body on the middle line; null: it covers the joints"},
      m.beams.resistance);
  out.number({"resistance_angle_rad", "rad",
              "beam angle of the largest resistance; null: the body covers the joints"},
             m.beams.angle);
  out.number({"held_angle_rad", "rad",
              "beam angle at which the beams balance the propulsion; null: they never do"},
             m.beams.held_angle);
  out.object({"ring_down", "how a deflected beam comes to rest after its release"},
             [&](Fields& beams) {
               beams.object({"left", "the left beam"},
                            [&](Fields& f) { describe(f, m.ring_down[dynamics::kLeft]); });
               beams.object({"right", "the right beam"},
                            [&](Fields& f) { describe(f, m.ring_down[dynamics::kRight]); });
             });
  out.list(
      {"far_from_walkers", "numbers of meaning that are unusual for walking animals and robots"},
      far_from_walkers(m, scene), [](Fields& f, const FarFromWalkers& far) {
        f.text(Label("name", "key of the number in meaning")
                   .one_of({"froude", "push_per_weight", "random_per_weight",
                            "draws_per_body_length", "passages_waited"}),
               far.name);
        f.text({"what", "the number in words"}, far.what);
        f.text({"reason", "why the number is far from walking"}, far.reason);
      });
}

}  // namespace

std::vector<FarFromWalkers> far_from_walkers(const Meaning& m, const lattice::Scene& scene) {
  std::vector<FarFromWalkers> all;
  const bool has_top = std::isfinite(m.top_speed);
  const double fastest = has_top ? m.top_speed : m.passage_speed;
  if (m.froude > kFastestRun)
    all.push_back(
        {"froude",
         fmt::format("{} {}, {} body widths per second", quantity(fastest, "m/s", 3),
                     has_top ? "at most in the open" : "at the end of an open gate",
                     three_digits(fastest / (2.0 * scene.gate.body.radius))),
         fmt::format("v^2/(g R) = {}, with the radius for a leg: walking is usually below 1, and "
                     "fast runners reach 10 to 30",
                     three_digits(m.froude))});
  if (m.push_per_weight > kMostGrip)
    all.push_back({"push_per_weight",
                   fmt::format("a push of {} the body's weight", times_as(m.push_per_weight)),
                   kGrip});
  if (m.random_per_weight > kMostGrip)
    all.push_back(
        {"random_per_weight",
         fmt::format("a random force of {} the body's weight", times_as(m.random_per_weight)),
         kGrip});
  if (m.draws_per_length > kMostSteps)
    all.push_back({"draws_per_body_length",
                   three_digits(m.draws_per_length) + " draws of the random force per body width",
                   "legs step a few times while the body goes its own length"});
  if (m.passages_waited < kLeastPatience)
    all.push_back(
        {"passages_waited",
         fmt::format("trapped after {}, {} what an open gate takes",
                     quantity(scene.gate.run.time_limit, "s", 3), times_as(m.passages_waited)),
         "a slow body, or one that tries again, counts as stuck: run.time_limit_s is how long you "
         "would watch"});
  return all;
}

std::string far_from_walkers_line(const lattice::Scene& scene) {
  if (scene.named.empty() || lattice::derived_keys(scene).empty()) return "";
  const auto all = far_from_walkers(dynamics::meaning_of(scene.gate, scene.start), scene);
  if (all.empty()) return "";
  return fmt::format(
      "this scene is unusual for a walking animal or robot: {}{} (gatewalk scene {} says why)",
      all.front().what, all.size() > 1 ? fmt::format(", and {} more", all.size() - 1) : "",
      scene.source);
}

void describe(Fields& out, const SceneResult& result) {
  const lattice::Scene& scene = result.scene;
  out.list({"keys", "all keys of the scene with their values"}, lattice::describe(scene),
           [](Fields& f, const lattice::KeyInfo& k) {
             f.text({"key", "name of the key"}, k.key);
             f.text({"value", "value of the key, as TOML"}, k.value);
             f.text({"unit", "unit of the value; empty: a pure number or a text"}, k.unit);
             f.text({"range", "range of allowed values"}, k.range);
             f.text({"meaning", "meaning of the key"}, k.meaning);
             f.text({"source",
                     "origin of the value: a line of the file, --set, \"paper\" (default) or "
                     "\"derived\" from other keys"},
                    k.source);
           });
  out.object({"meaning", "physical quantities that follow from these values"},
             [&](Fields& f) { describe_meaning(f, result.meaning, scene); });
  out.texts({"remarks", "the quantities of meaning in sentences"}, remarks(result));
  out.text({"scene", "the whole scene, as TOML"}, lattice::to_toml(scene));
  out.optional(scene.terrain.has_value(), [&](Fields& f) {
    f.texts({"map", "types of the field's gates, one text for each row, the far row first"},
            lattice::map_rows(*scene.terrain, scene.field));
  });
  out.optional(!scene.actions.empty(), [&](Fields& f) {
    std::vector<std::string> names;
    for (const lattice::Terrain::Type& action : scene.actions) names.push_back(action.name);
    f.texts({"actions", "names of the actions that a body may take, in the order of their numbers"},
            names);
  });
}

std::string table_of(const SceneResult& result) {
  const lattice::Scene& scene = result.scene;
  std::string text = meaning_text(result);
  if (scene.terrain)
    text += fmt::format("\nMap of the gates' types, far row first:\n{}\n",
                        fmt::join(lattice::map_rows(*scene.terrain, scene.field), "\n"));
  std::vector<std::string> actions;
  for (const lattice::Terrain::Type& action : scene.actions)
    actions.push_back(action.name + (action.keys.empty() ? " (the scene as it is)" : ""));
  if (!actions.empty()) text += fmt::format("\nactions: {}\n", fmt::join(actions, ", "));
  return text + "\n" + table_of(lattice::describe(scene));
}

}  // namespace gatewalk::cli
