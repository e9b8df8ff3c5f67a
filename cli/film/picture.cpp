// SPDX-License-Identifier: MIT
#include "cli/film/picture.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "cli/render/quantity.h"

namespace gatewalk::cli {
namespace {

using dynamics::ContactMode;
using dynamics::kLeft;
using dynamics::kRight;
using dynamics::Side;

constexpr std::array<const char*, 3> kContactNames{"free", "hit", "held"};
constexpr double kRightEdge = kPictureWidth - 32.0;  // of the panel

// The same colours as in web/replay.js.
constexpr Colour kText = rgb(0x1b1f24), kMuted = rgb(0x59626d), kLine = rgb(0xd5dae0),
                 kPaper = rgb(0xffffff), kStage = rgb(0xf5f7f9), kBlue = rgb(0x0072b2),
                 kRed = rgb(0xc8401c), kOrange = rgb(0xd98300), kGrey = rgb(0x7b858f),
                 kGreen = rgb(0x00805c), kSky = rgb(0x2b8fc9), kPurple = rgb(0xa8447f),
                 kDisc = rgb(0xdfe4ea), kEdge = rgb(0x2c333b);

constexpr Colour colour_of(Side side) { return side == kLeft ? kBlue : kRed; }

/// The text with a true minus sign.
std::string with_minus(std::string text) {
  if (const std::size_t minus = text.starts_with('>') ? 1 : 0; text[minus] == '-')
    text.replace(minus, 1, "−");
  return text;
}

std::string whole(double x) { return with_minus(std::to_string(std::lround(x))); }

}  // namespace

Picture::Picture(const Film& film, const FilmRun& run, double pace, bool labels)
    : film_(film),
      about_(run),
      run_(film, run),
      unit_(dynamics::scale_of(film.gate)),
      pace_(pace),
      labels_(labels) {
  std::vector<double> draws;
  for (const FilmStep& s : run.steps) {
    draws.push_back(std::abs(s.random_force));
    stored_ = std::max({stored_, s.body_energy, s.beams_energy, s.elastic});
    moved_ = std::max({moved_, s.work, s.lost});
  }
  const auto few =
      draws.begin() + static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(draws.size() - 1));
  std::nth_element(draws.begin(), few, draws.end());
  // The longer of two arrows spans two radii: propulsion, and the random force that few draws
  // exceed.
  if (const double strong = std::max(*few, std::abs(film.gate.forces.propulsion)); strong > 0.0)
    arrow_ = 2.0 * film.gate.body.radius / strong;
}

std::string_view Picture::draw(double time) {
  const Scenery now = run_.scenery(time);
  painter_.fill({0, 0, kPictureWidth, kPictureHeight}, kPaper);
  text(32, 46, 24, film_.title, kText, true, kPictureWidth - 64);
  text(32, 72, 16, about_.label + "; plays " + speed_words(pace_ * unit_.time), kMuted, false,
       kPictureWidth - 64);
  const PictureBox all = bounds();
  constexpr PictureBox kArea{32, 92, 920, kPictureHeight - 28};
  if (film_.is_field()) {
    // The field on the left, and on the right what a camera sees that follows the body.
    const double fit = (kArea.y1 - kArea.y0) * (all.x1 - all.x0) / (all.y1 - all.y0);
    const double middle = kArea.x0 + std::clamp(fit, 120.0, 440.0);
    stage({kArea.x0, kArea.y0, middle, kArea.y1}, now, all);
    const Point centre = run_.calm_place(time);
    const double half_x = 1.15 * film_.width(), half_y = 0.95 * film_.depth();
    stage({middle + 16, kArea.y0, kArea.x1, kArea.y1}, now,
          {centre.x - half_x, centre.y - half_y, centre.x + half_x, centre.y + half_y});
  } else {
    stage(kArea, now, all);
  }
  // Words and numbers change ten times in a second of the film, so that they can be read.
  const double word = 0.1 * pace_ * unit_.time;
  const double said = run_.start() + word * std::floor((time - run_.start()) / word + 1e-9);
  panel(952, now, time < run_.end() ? run_.scenery(said) : now);
  return painter_.pixels();
}

/// The area to show (m): the field, or a single gate with all places that the run visits.
PictureBox Picture::bounds() const {
  const double margin = 3.0 * unit_.length, radius = film_.gate.body.radius;
  if (film_.is_field())
    return {(first_column() - 0.5) * film_.width() - margin, -radius - margin,
            (first_column() + film_.field.columns - 0.5) * film_.width() + margin,
            film_.field.rows * film_.depth() + radius + margin};
  const dynamics::Beams& beams = film_.gate.beams;
  double half = beams.joint_x, low = 0.0, high = beams.joint_y + beams.length;
  for (std::size_t i = 0; i < run_.steps().size(); ++i) {
    const auto [x, y] = run_.place(i);
    half = std::max({half, -x + radius, x + radius});
    low = std::min(low, y - radius);
    high = std::max(high, y + radius);
  }
  return {-half - margin, low - margin, half + margin, high + margin};
}

/// Draws the body among the beams into `box`, which shows at least the area `seen` (m).
void Picture::stage(const PictureBox& box, const Scenery& s, const PictureBox& seen) {
  const double scale =
      std::min((box.x1 - box.x0) / (seen.x1 - seen.x0), (box.y1 - box.y0) / (seen.y1 - seen.y0));
  const View view{.box = box,
                  .centre = {0.5 * (seen.x0 + seen.x1), 0.5 * (seen.y0 + seen.y1)},
                  .scale = scale,
                  .thick = std::clamp(0.9 * unit_.length * scale, 1.5, 5.0)};
  painter_.fill(box, kStage);
  const Painter::Clip inside(painter_, box);
  gates(view, s);
  trail(view, s);
  painter_.circle(view(s.body), film_.gate.body.radius * scale);
  painter_.fill_and_stroke(kDisc, 0.88, kEdge, std::clamp(0.4 * unit_.length * scale, 1.2, 2.0));
  for (const Side side : {kLeft, kRight}) moving_beam(view, s, side);
  forces(view, s);
  if (labels_) rule(view);
}

/// Draws the borders of the gates in sight and their beams at rest. A single gate has only side
/// borders.
void Picture::gates(const View& view, const Scenery& s) {
  const auto& [box, centre, scale, thick] = view;
  const double width = film_.width(), depth = film_.depth();
  const double half_x = 0.5 * (box.x1 - box.x0) / scale, half_y = 0.5 * (box.y1 - box.y0) / scale;
  const int first =
      std::max(first_column(), static_cast<int>(std::floor((centre.x - half_x) / width - 0.5)));
  const int last = std::min(first_column() + film_.field.columns - 1,
                            static_cast<int>(std::ceil((centre.x + half_x) / width + 0.5)));
  const int low = std::max(0, static_cast<int>(std::floor((centre.y - half_y) / depth - 1.0)));
  const int high =
      std::min(film_.field.rows - 1, static_cast<int>(std::ceil((centre.y + half_y) / depth)));
  {
    const Painter::FlatLines dashed(painter_, width * scale > 60.0 ? 5.0 : 3.0);
    const double bottom = film_.is_field() ? low * depth : centre.y - half_y;
    const double top = film_.is_field() ? (high + 1) * depth : centre.y + half_y;
    if (width * scale > 6.0)
      for (int k = first; k <= last + 1; ++k)
        painter_.line(view({(k - 0.5) * width, bottom}), view({(k - 0.5) * width, top}), kGreen,
                      1.2, 0.55);
    if (film_.is_field() && depth * scale > 6.0)
      for (int k = low; k <= high + 1; ++k)
        painter_.line(view({(first - 0.5) * width, k * depth}),
                      view({(last + 0.5) * width, k * depth}), kGreen, 1.2, 0.55);
  }
  if (!film_.is_field() || width * scale <= 12.0) return;
  for (int i_x = first; i_x <= last; ++i_x)
    for (int i_y = low; i_y <= high; ++i_y)
      for (const Side side : {kLeft, kRight}) {
        if (i_x == s.i_x && i_y == s.i_y) continue;
        const Segment beam = beam_of(film_, i_x, i_y, side, 0.0);
        painter_.line(view(beam.joint), view(beam.tip), colour_of(side), std::max(1.2, 0.6 * thick),
                      0.45);
      }
}

/// Draws the body's track: all of it faintly, its last part strongly.
void Picture::trail(const View& view, const Scenery& s) {
  painter_.circle(view(run_.place(0)), 3.5);
  painter_.stroke(kMuted, 1.5);
  const auto draw = [&](std::size_t from, double width) {
    Point before = view(run_.place(from));
    painter_.move_to(before);
    for (std::size_t k = from + 1; k <= s.at.i; ++k) {
      const Point p = view(run_.place(k));
      if (std::abs(p.x - before.x) + std::abs(p.y - before.y) < 0.7) continue;
      painter_.line_to(p);
      before = p;
    }
    painter_.line_to(view(s.body));
    painter_.stroke(kText, width, 0.5);
  };
  const double wake = 1.5 * unit_.time;  // time of the track that is drawn strongly
  draw(0, 1.6);
  draw(run_.at(s.time - wake).i, 2.2);
}

/// Draws a beam of the gate that the body is in, with its contact and its last hit.
void Picture::moving_beam(const View& view, const Scenery& s, Side side) {
  const FilmStep& step = run_.steps()[s.at.i];
  const Segment beam = beam_of(film_, step, side, s.angle[side]);
  const Colour own = colour_of(side);
  const bool held = s.contact[side] == ContactMode::held;
  painter_.line(view(beam.joint), view(beam.tip), own, held ? 1.5 * view.thick : view.thick);
  painter_.circle(view(beam.joint), 1.1 * view.thick);
  painter_.fill(kEdge);
  if (held) {
    painter_.circle(view(nearest_point(film_, step, side, s.angle[side], s.body)),
                    1.5 * view.thick);
    painter_.fill_and_stroke(kStage, 1.0, own, 0.7 * view.thick);
  }
  if (!s.last_hit[side]) return;
  const FilmStep& hit = run_.steps()[*s.last_hit[side]];
  // time of the run for which a hit stays visible
  const double flash = 0.25 * std::max(1.0, pace_) * unit_.time;
  const double grown = (s.time - hit.time) / flash;
  if (grown > 1.0) return;
  const Point place =
      nearest_point(film_, hit, side, hit.angle[side], run_.place(*s.last_hit[side]));
  painter_.circle(view(place), view.thick * (1.6 + 2.6 * grown));
  painter_.stroke(own, 2.0, 0.9 * (1.0 - grown));
}

void Picture::forces(const View& view, const Scenery& s) {
  const Point body = view(s.body);
  const double random = run_.steps()[s.at.i].random_force;
  painter_.arrow(body, {body.x + arrow_ * random * view.scale, body.y}, kGrey, view.thick);
  painter_.arrow(body,
                 {body.x, body.y - arrow_ * film_.gate_of(run_.steps()[s.at.i]).forces.propulsion *
                                       view.scale},
                 kOrange, view.thick);
  painter_.circle(body, std::max(1.5, 0.6 * view.thick));
  painter_.fill(kEdge);
}

/// Draws a scale bar: the longest of 1, 2, 5, 10, ... m that takes at most a fifth of the width.
void Picture::rule(const View& view) {
  const auto& [box, centre, scale, thick] = view;
  const double wanted = 0.2 * (box.x1 - box.x0) / scale,
               power = std::pow(10.0, std::floor(std::log10(wanted)));
  const double length = power * (5.0 * power <= wanted ? 5.0 : 2.0 * power <= wanted ? 2.0 : 1.0);
  painter_.fill({box.x0 + 6, box.y1 - 36, box.x0 + 6 + (length * scale + 16), box.y1 - 36 + 32},
                kStage, 0.85);
  text(box.x0 + 14, box.y1 - 18, 14, quantity(length, "m"), kMuted);
  const Painter::FlatLines flat(painter_);
  painter_.line({box.x0 + 14, box.y1 - 12}, {box.x0 + 14 + length * scale, box.y1 - 12}, kMuted,
                2.0);
}

/// Draws time, contacts, forces and energies from x on. Bars show `now`, words and numbers `said`.
void Picture::panel(double x, const Scenery& now, const Scenery& said) {
  text(x, 124, 40, with_minus(reading(now.time, "s", 0.01 * unit_.time)), kText, true);
  if (now.time >= run_.end())
    text(x, 154, 17, "ended: " + about_.ending, kText, true, kRightEdge - x);
  else if (film_.is_field())
    text(x, 154, 17,
         fmt::format("gate: column {}, row {}{}", whole(said.i_x), whole(said.i_y),
                     film_.actions.empty() ? "" : ", " + film_.action_of(run_.steps()[said.at.i])),
         kMuted, false, kRightEdge - x);
  double y = 196;
  legend(x, y, said);
  y += 48;
  bars(x, y, "Energy stored now",
       {{"body, kinetic", &FilmStep::body_energy, stored_, kText},
        {"beams, kinetic", &FilmStep::beams_energy, stored_, kSky},
        {"beams, elastic", &FilmStep::elastic, stored_, kGreen}},
       now, said);
  y += 10;
  bars(x, y, "Put in and lost since the start",
       {{"work put in", &FilmStep::work, moved_, kOrange},
        {"lost", &FilmStep::lost, moved_, kPurple}},
       now, said);
}

/// Draws the legend of lines and arrows with their numbers; y becomes that of the last row after
/// it.
void Picture::legend(double x, double& y, const Scenery& said) {
  const auto words = [&](const std::string& name, const std::string& value) {
    text(x + 38, y, 16, name, kText);
    text(kRightEdge, y, 16, value, kText, false, -160);
  };
  for (const Side side : {kLeft, kRight}) {
    // A hit is named for a moment.
    const bool just_hit =
        said.last_hit[side] &&
        said.time - run_.steps()[*said.last_hit[side]].time < 0.1 * pace_ * unit_.time;
    const ContactMode contact =
        said.contact[side] == ContactMode::free && just_hit ? ContactMode::hit : said.contact[side];
    painter_.line({x, y - 5}, {x + 26, y - 5}, colour_of(side), 4.0);
    words(side == kLeft ? "left beam" : "right beam",
          fmt::format("{}, {}°", kContactNames[static_cast<std::size_t>(contact)],
                      whole(said.angle[side] * 180.0 / std::numbers::pi)));
    y += 27;
  }
  const auto force = [&](Colour c, const char* name, double newton) {
    painter_.arrow({x, y - 5}, {x + 26, y - 5}, c, 4.0);
    words(name, with_minus(reading(newton, "N", 0.1 * unit_.force())));
    y += 27;
  };
  force(kOrange, "propulsion", film_.gate_of(run_.steps()[said.at.i]).forces.propulsion);
  force(kGrey, "random force", run_.steps()[said.at.i].random_force);
  const auto velocity = [&](double dynamics::BodyState::*member) {
    return said.at([&](std::size_t i) { return run_.steps()[i].body.*member; });
  };
  const double speed =
      std::hypot(velocity(&dynamics::BodyState::vx), velocity(&dynamics::BodyState::vy));
  words("speed", reading(speed, "m/s", 0.1 * unit_.speed()));
}

void Picture::bars(double x, double& y, const char* heading, const std::vector<Bar>& bars,
                   const Scenery& now, const Scenery& said) {
  text(x, y, 16, heading, kText, true);
  y += 28;
  for (const auto& [name, energy, most, colour] : bars) {
    const double step = step_of(0.1 * unit_.energy(), most);
    text(x, y, 16, name, kText);
    text(kRightEdge, y, 16, with_minus(reading(run_.value(said.at, energy), "J", step)), kText,
         false, -160);
    painter_.fill({x, y + 7, kRightEdge, y + 15}, kLine);
    if (most > 0.0) {
      const double share = std::clamp(run_.value(now.at, energy) / most, 0.0, 1.0);
      painter_.fill({x, y + 7, x + share * (kRightEdge - x), y + 15}, colour);
    }
    y += 40;
  }
}

}  // namespace gatewalk::cli
