// SPDX-License-Identifier: MIT
#pragma once
/// The data of runs that the replay page (replay.h) and videos (video.h) draw.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "lattice/scene/study/recording.h"

namespace gatewalk::cli {

/// The state at the end of a step. Work and losses are sums since the run began.
struct FilmStep {
  double time = 0.0;                               // s; steps may be uneven
  int i_x = 0, i_y = 0;                            // the gate that the body is in
  int type = 0;                                    // index into Film::types, if there are several
  dynamics::BodyState body;                        // in that gate's frame
  std::array<double, 2> angle{};                   // rad, of its beams; > 0 is forward
  std::array<dynamics::ContactMode, 2> contact{};  // until the next step
  double random_force = 0.0;                       // N, until the next step
  double body_energy = 0.0, beams_energy = 0.0;    // J, kinetic
  double elastic = 0.0;                            // J, of both beams
  double work = 0.0;                               // J, by propulsion and random force
  double lost = 0.0, lost_in_hits = 0.0;           // J
};

struct FilmRun {
  std::string label, ending;
  std::vector<FilmStep> steps;  // at least one
};

struct Film {
  std::string title;
  dynamics::GateParams gate;
  std::optional<lattice::FieldGates> types{};  // gates of the field, if there are several types
  std::vector<std::string> actions{};          // of a policy: the type number modulo this size
  lattice::FieldParams field{.columns = 1, .rows = 1};  // 1 x 1: a single gate
  std::vector<FilmRun> runs;

  [[nodiscard]] double width() const { return gate.gate_width(); }   // m, of a gate
  [[nodiscard]] double depth() const { return gate.gate_length(); }  // m, of a gate
  /// The gate at (i_x, i_y) of the field.
  [[nodiscard]] const dynamics::GateParams& gate_at(int i_x, int i_y) const {
    return types ? types->at(i_x + field.start_column(), i_y) : gate;
  }
  /// The gate that the body is in.
  [[nodiscard]] const dynamics::GateParams& gate_of(const FilmStep& step) const {
    return types ? types->types()[static_cast<std::size_t>(step.type)] : gate;
  }
  /// The action that the body takes, under a policy.
  [[nodiscard]] const std::string& action_of(const FilmStep& step) const {
    return actions[static_cast<std::size_t>(step.type) % actions.size()];
  }
  [[nodiscard]] bool is_field() const { return field.columns * field.rows > 1; }
};

/// The speed of a film that plays `times_real` seconds in a second: "at 1/4 of real time".
[[nodiscard]] std::string speed_words(double times_real);

/// All runs as a film, in numbers of seven digits in the scene's own units.
[[nodiscard]] Film film_of(const lattice::Scene& scene, const lattice::Recordings& recordings);

}  // namespace gatewalk::cli
