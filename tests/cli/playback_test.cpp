// SPDX-License-Identifier: MIT
#include "cli/film/playback.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/cli/films.h"

namespace gatewalk::cli {
namespace {

using dynamics::ContactMode;
using dynamics::kLeft;
using dynamics::kRight;

/// A gate of 50 m x 60 m; two steps in gate (0, 0), one in gate (0, 1).
Film three_steps() {
  Film film = small_film(0);
  film.runs[0].steps = {{.time = 0.0, .body = {0.0, 10.0, 0.0, 0.0}, .angle = {0.0, 0.0}},
                        {.time = 2.0,
                         .body = {4.0, 50.0, 0.0, 0.0},
                         .angle = {1.0, 0.5},
                         .contact = {ContactMode::free, ContactMode::hit},
                         .body_energy = 8.0},
                        {.time = 3.0, .i_y = 1, .body = {4.0, 0.0, 0.0, 0.0}}};
  return film;
}

FilmStep step_in(const Film& film, int i_x, int i_y) {
  FilmStep step;
  step.i_x = i_x;
  step.i_y = i_y;
  if (film.types) step.type = film.types->type_of(i_x + film.field.start_column(), i_y);
  return step;
}

// Joints at (-25, 30) and (25, 30), beams of 25 m: both tips meet in the middle.
TEST(Playback, BeamsOfAnyGate) {
  const Film film = small_film(0);
  const Segment left = beam_of(film, 1, 2, kLeft, 0.0);
  EXPECT_EQ(left.joint.x, 25.0);
  EXPECT_EQ(left.joint.y, 150.0);
  EXPECT_EQ(left.tip.x, 50.0);
  EXPECT_EQ(left.tip.y, 150.0);
  const Segment right = beam_of(film, 0, 0, kRight, std::numbers::pi / 2);
  EXPECT_NEAR(right.tip.x, 25.0, 1e-12);
  EXPECT_NEAR(right.tip.y, 55.0, 1e-12);
}

TEST(Playback, BeamsAreThoseOfTheirGatesType) {
  const Film film = small_mixed_film();
  EXPECT_EQ(beam_of(film, 0, 0, kLeft, 0.0).tip.x, 0.0);
  EXPECT_EQ(beam_of(film, -1, 1, kLeft, 0.0).tip.x, -60.0);
  EXPECT_EQ(beam_of(film, 1, 2, kLeft, 0.0).tip.x, 50.0);
  const Point tip = nearest_point(film, step_in(film, 0, 1), kLeft, 0.0, {0.0, 90.0});
  EXPECT_NEAR(tip.x, -10.0, 1e-12);
  // A policy may choose another type in the same gate.
  FilmStep chosen = step_in(film, 0, 0);
  EXPECT_EQ(beam_of(film, chosen, kLeft, 0.0).tip.x, 0.0);
  EXPECT_EQ(film.gate_of(chosen).forces.propulsion, film.gate.forces.propulsion);
  chosen.type = 1;
  EXPECT_EQ(beam_of(film, chosen, kLeft, 0.0).tip.x, -10.0);
  EXPECT_EQ(film.gate_of(chosen).forces.propulsion, 9.0);
}

TEST(Playback, NearestPointOfABeam) {
  const Film film = small_film(0);
  const Point along = nearest_point(film, step_in(film, 0, 0), kLeft, 0.0, {-10.0, 15.0});
  EXPECT_NEAR(along.x, -10.0, 1e-12);
  EXPECT_NEAR(along.y, 30.0, 1e-12);
  const Point tip = nearest_point(film, step_in(film, 1, 1), kLeft, 0.0, {60.0, 70.0});
  EXPECT_NEAR(tip.x, 50.0, 1e-12);
  EXPECT_NEAR(tip.y, 90.0, 1e-12);
  const Point joint = nearest_point(film, step_in(film, 0, 0), kRight, 0.0, {40.0, 20.0});
  EXPECT_NEAR(joint.x, 25.0, 1e-12);
  EXPECT_NEAR(joint.y, 30.0, 1e-12);
}

TEST(Playback, GoesStraightFromStepToStep) {
  const Film film = three_steps();
  const Playback play(film, film.runs[0]);
  const Scenery s = play.scenery(0.5);
  EXPECT_EQ(s.body.x, 1.0);
  EXPECT_EQ(s.body.y, 20.0);
  EXPECT_EQ(s.angle[kLeft], 0.25);
  EXPECT_FALSE(s.last_hit[kRight]);
  EXPECT_EQ(play.value(s.at, &FilmStep::body_energy), 2.0);
  EXPECT_EQ(play.scenery(-1.0).body.y, 10.0) << "stands before it begins";
  EXPECT_EQ(play.scenery(9.0).body.y, 60.0) << "and after its end";
}

// While the body moves into another gate, the beams of the old gate keep their last angle.
TEST(Playback, BeamsLeftBehindStand) {
  const Film film = three_steps();
  const Playback play(film, film.runs[0]);
  const Scenery s = play.scenery(2.5);
  EXPECT_EQ(s.i_y, 0);
  EXPECT_EQ(s.body.y, 55.0) << "in the field's frame";
  EXPECT_EQ(s.angle[kLeft], 1.0);
  EXPECT_EQ(s.contact[kRight], ContactMode::hit) << "until the next step";
  EXPECT_EQ(s.last_hit[kRight], std::size_t{1});
  EXPECT_EQ(play.scenery(3.0).i_y, 1);
}

// The mean place within 0.75 s before and after, less at the ends. Speeds: 20 m/s, then 10 m/s.
TEST(Playback, ACalmCameraLooksAtTheMeanPlace) {
  const Film film = three_steps();
  const Playback play(film, film.runs[0]);
  EXPECT_DOUBLE_EQ(play.calm_place(1.0).y, 30.0);
  EXPECT_DOUBLE_EQ(play.calm_place(0.0).y, 10.0);
  // From 1.25 s (35 m) to 2 s (50 m) to 2.75 s (57.5 m).
  EXPECT_DOUBLE_EQ(play.calm_place(2.0).y, 0.5 * (0.5 * (35.0 + 50.0) + 0.5 * (50.0 + 57.5)));
}

}  // namespace
}  // namespace gatewalk::cli
