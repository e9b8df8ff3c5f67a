// SPDX-License-Identifier: MIT
#include "cli/film/film.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "cli/fields/text.h"
#include "cli/render/quantity.h"

namespace gatewalk::cli {
namespace {

using dynamics::kLeft;
using dynamics::kRight;

std::string title_of(const lattice::Scene& scene, const std::vector<std::string>& actions) {
  const dynamics::GateParams& p = scene.gate;
  if (!actions.empty())
    return fmt::format("{}: actions {}", scene.source, fmt::join(actions, ", "));
  return fmt::format("{}: F {}, Rm {}, k {} / {}, d {}, {}", scene.source,
                     quantity(p.forces.propulsion, "N", 7), quantity(p.forces.random, "N", 7),
                     digits(p.beams.stiffness_left), digits(p.beams.stiffness_right),
                     digits(p.beams.damping), p.run.method);
}

std::string label_of(const lattice::Recording& r, bool across_field, const dynamics::Scale& scale) {
  return fmt::format("trial {}: {} after {}{}", r.trial, r.ending,
                     reading(r.seconds, "s", 0.01 * scale.time),
                     across_field ? ", " + counted(r.gates, "gate", "gates") : "");
}

/// A step of a film without its random force, which belongs to the interval before a moment but
/// after a step.
FilmStep film_step(const lattice::Moment& m, const dynamics::Scale& scale) {
  const auto& [body, beams] = m.sample.state;
  const dynamics::Energies& e = m.energy;
  const double joule = scale.energy();
  return {.time = seven_digits(m.time, scale.time),
          .i_x = m.i_x,
          .i_y = m.i_y,
          .type = m.type,
          .body = {seven_digits(body.x, scale.length), seven_digits(body.y, scale.length),
                   seven_digits(body.vx, scale.speed()), seven_digits(body.vy, scale.speed())},
          .angle = {seven_digits(beams[kLeft].theta, 1.0), seven_digits(beams[kRight].theta, 1.0)},
          .contact = m.sample.contact,
          .body_energy = seven_digits(e.body, joule),
          .beams_energy = seven_digits(e.beams[kLeft] + e.beams[kRight], joule),
          .elastic = seven_digits(e.elastic[kLeft] + e.elastic[kRight], joule),
          .work = seven_digits(e.propulsion_work + e.random_work, joule),
          .lost = seven_digits(e.lost, joule),
          .lost_in_hits = seven_digits(e.hit_loss, joule)};
}

}  // namespace

std::string speed_words(double times_real) {
  constexpr double kEqual = 1e-6;
  const auto is_whole = [](double x) { return std::abs(x - std::round(x)) < kEqual * x; };
  if (std::abs(times_real - 1.0) < kEqual) return "in real time";
  if (times_real > 1.0) return fmt::format("at {} times real time", digits(times_real, 3));
  return fmt::format("at {} of real time", is_whole(1.0 / times_real)
                                               ? "1/" + digits(std::round(1.0 / times_real), 7)
                                               : digits(times_real, 3));
}

Film film_of(const lattice::Scene& scene, const lattice::Recordings& recordings) {
  Film film;
  film.title = title_of(scene, recordings.actions);
  film.gate = scene.gate;
  if (recordings.across_field) film.field = scene.field;
  if (recordings.gates.types().size() > 1) film.types = recordings.gates;
  film.actions = recordings.actions;
  const dynamics::Scale scale = dynamics::scale_of(scene.gate);
  for (const lattice::Recording& r : recordings.runs) {
    FilmRun run{label_of(r, recordings.across_field, scale), r.ending, {}};
    const std::size_t last = r.moments.size() - 1;
    for (std::size_t i = 0; i <= last; ++i) {
      run.steps.push_back(film_step(r.moments[i], scale));
      // A sample holds the force that acted before it; a film's step holds the force until the next
      // step.
      if (last > 0)
        run.steps.back().random_force =
            seven_digits(r.moments[std::min(i + 1, last)].sample.random_force, scale.force());
    }
    film.runs.push_back(std::move(run));
  }
  return film;
}

}  // namespace gatewalk::cli
