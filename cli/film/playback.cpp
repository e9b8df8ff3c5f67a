// SPDX-License-Identifier: MIT
#include "cli/film/playback.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "dynamics/disc/contact.h"

namespace gatewalk::cli {
namespace {

using dynamics::ContactMode;
using dynamics::kLeft;
using dynamics::kRight;
using dynamics::Side;

std::vector<double> integral(const std::vector<FilmStep>& steps,
                             const std::vector<double>& values) {
  std::vector<double> sums(values.size(), 0.0);
  for (std::size_t i = 1; i < values.size(); ++i)
    sums[i] = sums[i - 1] + 0.5 * (values[i] + values[i - 1]) * (steps[i].time - steps[i - 1].time);
  return sums;
}

bool is_finite(const FilmStep& s) {
  const double all[] = {s.time,     s.body.x,   s.body.y,       s.body.vx,     s.body.vy,
                        s.angle[0], s.angle[1], s.random_force, s.body_energy, s.beams_energy,
                        s.elastic,  s.work,     s.lost};
  return std::all_of(std::begin(all), std::end(all), [](double x) { return std::isfinite(x); });
}

}  // namespace

namespace {

Segment beam_of(const Film& film, const dynamics::Beams& beams, int i_x, int i_y, Side side,
                double angle) {
  const double sign = side == kLeft ? 1.0 : -1.0;
  const auto along = dynamics::Direction::of(angle);
  const Point joint{-sign * beams.joint_x + film.width() * i_x, beams.joint_y + film.depth() * i_y};
  return {joint, {joint.x + sign * beams.length * along.c, joint.y + beams.length * along.s}};
}

}  // namespace

Segment beam_of(const Film& film, int i_x, int i_y, Side side, double angle) {
  return beam_of(film, film.gate_at(i_x, i_y).beams, i_x, i_y, side, angle);
}

Segment beam_of(const Film& film, const FilmStep& step, Side side, double angle) {
  return beam_of(film, film.gate_of(step).beams, step.i_x, step.i_y, side, angle);
}

Point nearest_point(const Film& film, const FilmStep& step, Side side, double angle, Point body) {
  const dynamics::BodyState at{body.x - film.width() * step.i_x, body.y - film.depth() * step.i_y};
  const dynamics::Touch touch = dynamics::nearest(film.gate_of(step), side, at, angle);
  const double distance = touch.gap + film.gate.body.radius;
  return {body.x - distance * touch.nx, body.y - distance * touch.ny};
}

Playback::Playback(const Film& film, const FilmRun& run) : film_(film), steps_(run.steps) {
  if (steps_.empty()) throw std::invalid_argument("film: a run without steps");
  for (const FilmStep& s : steps_) {
    if (!is_finite(s)) throw std::invalid_argument("film: a step holds what is no number");
    x_.push_back(s.body.x + film.width() * s.i_x);
    y_.push_back(s.body.y + film.depth() * s.i_y);
  }
  if (!std::is_sorted(steps_.begin(), steps_.end(),
                      [](const FilmStep& a, const FilmStep& b) { return a.time < b.time; }))
    throw std::invalid_argument("film: its time goes back");
  sum_x_ = integral(steps_, x_);
  sum_y_ = integral(steps_, y_);
}

Between Playback::at(double time) const {
  const auto later = std::upper_bound(steps_.begin(), steps_.end(), time,
                                      [](double t, const FilmStep& s) { return t < s.time; });
  Between b;
  b.i = later == steps_.begin() ? 0 : static_cast<std::size_t>(later - steps_.begin()) - 1;
  b.j = std::min(b.i + 1, steps_.size() - 1);
  const double step = steps_[b.j].time - steps_[b.i].time;
  b.part = step > 0.0 ? std::clamp((time - steps_[b.i].time) / step, 0.0, 1.0) : 0.0;
  return b;
}

Scenery Playback::scenery(double time) const {
  const Between now = at(time);
  const FilmStep &before = steps_[now.i], &after = steps_[now.j];
  Scenery s{.time = time,
            .at = now,
            .i_x = before.i_x,
            .i_y = before.i_y,
            .body = {now([&](std::size_t i) { return x_[i]; }),
                     now([&](std::size_t i) { return y_[i]; })},
            .angle = before.angle,
            .contact = before.contact,
            .last_hit = {}};
  // In another gate other beams move. Until then, the beams that the body leaves keep their last
  // angle.
  const bool same_gate = after.i_x == before.i_x && after.i_y == before.i_y;
  for (const Side side : {kLeft, kRight}) {
    if (same_gate) s.angle[side] = now([&](std::size_t i) { return steps_[i].angle[side]; });
    for (std::size_t i = now.i + 1; i-- > 0 && !s.last_hit[side];)
      if (steps_[i].contact[side] == ContactMode::hit) s.last_hit[side] = i;
  }
  return s;
}

Point Playback::calm_place(double time) const {
  const double unit = dynamics::scale_of(film_.gate).time;
  const double most = 0.75 * unit;  // before and after
  const double reach = std::min({most, time - start(), end() - time});
  if (!(reach > 1e-6 * unit)) return scenery(time).body;
  const auto up_to = [&](const std::vector<double>& sums, const std::vector<double>& values,
                         double when) {
    const Between b = at(when);
    return sums[b.i] + 0.5 * (when - steps_[b.i].time) *
                           (values[b.i] + b([&](std::size_t i) { return values[i]; }));
  };
  const auto mean = [&](const std::vector<double>& sums, const std::vector<double>& values) {
    return (up_to(sums, values, time + reach) - up_to(sums, values, time - reach)) / (2.0 * reach);
  };
  return {mean(sum_x_, x_), mean(sum_y_, y_)};
}

}  // namespace gatewalk::cli
