// SPDX-License-Identifier: MIT
#pragma once
/// Small films made by hand: the body goes straight ahead and pushes the beams aside.

#include <algorithm>
#include <cmath>

#include "cli/fields/json_value.h"
#include "cli/film/replay.h"
#include "tests/support/twins.h"

namespace gatewalk::cli {

/// The film as the replay page reads it.
inline Json json_of(const Film& film) {
  return json_of([&](Fields& out) { describe(out, film); });
}

/// `steps` steps of 0.02 s. The body moves 0.5 m in each; a gate is 60 m deep.
inline Film small_film(int steps = 50) {
  using dynamics::ContactMode;
  Film film;
  film.title = "A small film";
  film.gate.forces.propulsion = 7.0;
  FilmRun run{
      "trial 1: traversed left after " + std::to_string(steps / 50) + " s", "traversed left", {}};
  for (int i = 0; i <= steps; ++i) {
    const int row = i / 120;
    const double y = 0.5 * i - 60.0 * row, pushed = std::clamp(0.05 * (y - 15.0), 0.0, 1.2);
    const ContactMode contact = pushed == 0.0 ? ContactMode::free
                                : y < 17.0    ? ContactMode::hit
                                              : ContactMode::held;
    run.steps.push_back({.time = 0.02 * i,
                         .i_x = 0,
                         .i_y = row,
                         .body = {0.0, y, 0.0, 25.0},
                         .angle = {pushed, pushed},
                         .contact = {contact, contact},
                         .random_force = 10.0 * std::sin(i),
                         .body_energy = 312.5,
                         .beams_energy = static_cast<double>(i % 3),
                         .elastic = 250.0 * pushed * pushed,
                         .work = 7.0 * 0.5 * i,
                         .lost = 3.0 * 0.5 * i,
                         .lost_in_hits = 0.0});
  }
  film.runs = {run};
  return film;
}

/// The body goes through three gates of a field of 3 x 3.
inline Film small_field_film() {
  Film film = small_film(330);
  film.title = "A small field";
  film.field.columns = film.field.rows = 3;
  return film;
}

/// A small field film whose middle row has shorter beams and more propulsion.
inline Film small_mixed_film() {
  Film film = small_field_film();
  dynamics::GateParams other = film.gate;
  other.beams.length = 15.0;
  other.forces.propulsion = 9.0;
  film.types = lattice::FieldGates::by_cell({film.gate, other}, 3, {0, 0, 0, 1, 1, 1, 0, 0, 0});
  for (FilmRun& run : film.runs)
    for (FilmStep& step : run.steps)
      step.type = film.types->type_of(step.i_x + film.field.start_column(), step.i_y);
  return film;
}

/// The same film of a scene with other units.
inline Film in_other_units(Film film, const test::Twin& twin) {
  const double time = twin.of(0, 1, 0), force = twin.of(1, -2, 1), joule = twin.of(2, -2, 1);
  film.gate = twin.of(film.gate);
  for (FilmRun& run : film.runs)
    for (FilmStep& s : run.steps) {
      s.time *= time;
      s.body = twin.of(s.body);
      s.random_force *= force;
      for (double* const energy :
           {&s.body_energy, &s.beams_energy, &s.elastic, &s.work, &s.lost, &s.lost_in_hits})
        *energy *= joule;
    }
  return film;
}

inline constexpr test::Twin kOtherUnits[] = {{.length = -5},
                                             {.mass = 5},
                                             {.time = -5},
                                             {.length = -10, .time = -10, .mass = -10},
                                             {.length = 10, .time = 10, .mass = 10},
                                             {.length = 10, .time = 4, .mass = -10},
                                             {.length = -3, .time = 10, .mass = 7}};

}  // namespace gatewalk::cli
