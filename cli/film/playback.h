// SPDX-License-Identifier: MIT
#pragma once
/// Where everything is in a film at any time, between its steps too; by the rules of
/// web/replay.js.

#include <array>
#include <optional>
#include <vector>

#include "cli/film/film.h"

namespace gatewalk::cli {

struct Point {
  double x, y;
};

struct Segment {
  Point joint, tip;
};

/// A beam of gate (i_x, i_y) at an angle (rad), in the field's frame (m).
[[nodiscard]] Segment beam_of(const Film& film, int i_x, int i_y, dynamics::Side side,
                              double angle);
/// The same of the gate that a step is in.
[[nodiscard]] Segment beam_of(const Film& film, const FilmStep& step, dynamics::Side side,
                              double angle);
/// The point of that beam which is nearest to the body with its centre at `body`; all in the
/// field's frame (m).
[[nodiscard]] Point nearest_point(const Film& film, const FilmStep& step, dynamics::Side side,
                                  double angle, Point body);

/// The last step at or before a time, and how far it is from there to the next.
struct Between {
  std::size_t i = 0, j = 0;
  double part = 0.0;

  /// `value` is that of a step, by its number.
  template <class Value>
  [[nodiscard]] double operator()(const Value& value) const {
    return value(i) + part * (value(j) - value(i));
  }
};

/// Everything at one time.
struct Scenery {
  double time;  // s
  Between at;
  int i_x, i_y;                 // the gate that the body is in
  Point body;                   // m, in the field's frame
  std::array<double, 2> angle;  // rad
  std::array<dynamics::ContactMode, 2> contact;
  std::array<std::optional<std::size_t>, 2> last_hit;  // step; none so far
};

/// One run of a film, which must outlive it.
class Playback {
 public:
  /// Throws std::invalid_argument for a run without steps, steps that go back in time, and numbers
  /// that are none.
  Playback(const Film& film, const FilmRun& run);

  [[nodiscard]] const std::vector<FilmStep>& steps() const { return steps_; }
  [[nodiscard]] double start() const { return steps_.front().time; }  // s
  [[nodiscard]] double end() const { return steps_.back().time; }     // s
  /// The body at a step, in the field's frame (m).
  [[nodiscard]] Point place(std::size_t step) const { return {x_[step], y_[step]}; }

  [[nodiscard]] Between at(double time) const;
  [[nodiscard]] Scenery scenery(double time) const;
  /// The body's mean place around a time: what a calm camera looks at (m).
  [[nodiscard]] Point calm_place(double time) const;
  /// A number of a step, between steps.
  [[nodiscard]] double value(const Between& at, double FilmStep::*member) const {
    return at([&](std::size_t i) { return steps_[i].*member; });
  }

 private:
  const Film& film_;
  const std::vector<FilmStep>& steps_;
  std::vector<double> x_, y_;          // m, in the field's frame
  std::vector<double> sum_x_, sum_y_;  // m s, their integrals
};

}  // namespace gatewalk::cli
