// SPDX-License-Identifier: MIT
#pragma once
/// The state of a film at any time, also between its steps, by the same rules as web/replay.js.

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
/// A beam, at an angle (rad), of the gate in which a step is; in the field's frame (m).
[[nodiscard]] Segment beam_of(const Film& film, const FilmStep& step, dynamics::Side side,
                              double angle);
/// The point of a beam that is nearest to a body with its centre at `body`; all in the field's
/// frame (m).
[[nodiscard]] Point nearest_point(const Film& film, const FilmStep& step, dynamics::Side side,
                                  double angle, Point body);

/// A time between two steps: the last step i at or before it, the next step j, and the fraction of
/// the way from i to j.
struct Between {
  std::size_t i = 0, j = 0;
  double part = 0.0;

  /// Interpolates `value`, a function of a step's number.
  template <class Value>
  [[nodiscard]] double operator()(const Value& value) const {
    return value(i) + part * (value(j) - value(i));
  }
};

/// The state at one time.
struct Scenery {
  double time;  // s
  Between at;
  int i_x, i_y;                 // the gate that the body is in
  Point body;                   // m, in the field's frame
  std::array<double, 2> angle;  // rad
  std::array<dynamics::ContactMode, 2> contact;
  std::array<std::optional<std::size_t>, 2> last_hit;  // step of the last hit; none so far
};

/// Plays one run of a film. The film must outlive this object.
class Playback {
 public:
  /// Throws std::invalid_argument for a run without steps, steps that go back in time, and
  /// non-finite numbers.
  Playback(const Film& film, const FilmRun& run);

  [[nodiscard]] const std::vector<FilmStep>& steps() const { return steps_; }
  [[nodiscard]] double start() const { return steps_.front().time; }  // s
  [[nodiscard]] double end() const { return steps_.back().time; }     // s
  /// The body at a step, in the field's frame (m).
  [[nodiscard]] Point place(std::size_t step) const { return {x_[step], y_[step]}; }

  [[nodiscard]] Between at(double time) const;
  [[nodiscard]] Scenery scenery(double time) const;
  /// The body's mean place around a time (m), at which a calm camera looks.
  [[nodiscard]] Point calm_place(double time) const;
  /// A number of a step, interpolated between steps.
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
