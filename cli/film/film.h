// SPDX-License-Identifier: MIT
#pragma once
/// What is drawn of runs, by the page that plays them (replay.h) and in videos (video.h).

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "lattice/scene/study/recording.h"

namespace gatewalk::cli {

/// How things stand at the end of a step; work and losses since the run began.
struct FilmStep {
  double time = 0.0;                               // s, uneven steps allowed
  int i_x = 0, i_y = 0;                            // the gate that the body is in
  int type = 0;                                    // of Film::types, if there are
  dynamics::BodyState body;                        // in that gate's frame
  std::array<double, 2> angle{};                   // rad, of its beams, > 0 deflected forward
  std::array<dynamics::ContactMode, 2> contact{};  // holds until the next step
  double random_force = 0.0;                       // N, the same
  double body_energy = 0.0, beams_energy = 0.0;    // J, kinetic
  double elastic = 0.0;                            // J, of both beams
  double work = 0.0;                               // J, of propulsion and random force
  double lost = 0.0, lost_in_hits = 0.0;           // J
};

struct FilmRun {
  std::string label, ending;
  std::vector<FilmStep> steps;  // at least one
};

struct Film {
  std::string title;
  dynamics::GateParams gate;
  std::optional<lattice::FieldGates> types{};  // of the field's gates, if there are several
  std::vector<std::string> actions{};  // of a policy: type number t is taken with t % actions
  lattice::FieldParams field{.columns = 1, .rows = 1};  // 1 x 1: a gate alone
  std::vector<FilmRun> runs;

  [[nodiscard]] double width() const { return gate.gate_width(); }   // m, of a gate
  [[nodiscard]] double depth() const { return gate.gate_length(); }  // m, the same
  /// The gate at (i_x, i_y) of the field.
  [[nodiscard]] const dynamics::GateParams& gate_at(int i_x, int i_y) const {
    return types ? types->at(i_x + field.start_column(), i_y) : gate;
  }
  /// The gate that the body is in.
  [[nodiscard]] const dynamics::GateParams& gate_of(const FilmStep& step) const {
    return types ? types->types()[static_cast<std::size_t>(step.type)] : gate;
  }
  /// What the body does, of several actions.
  [[nodiscard]] const std::string& action_of(const FilmStep& step) const {
    return actions[static_cast<std::size_t>(step.type) % actions.size()];
  }
  [[nodiscard]] bool is_field() const { return field.columns * field.rows > 1; }
};

/// How fast a film plays what took `times_real` seconds for each of its own: "at 1/4 of real time".
[[nodiscard]] std::string speed_words(double times_real);

/// All runs as a film, with seven digits in the scene's own units.
[[nodiscard]] Film film_of(const lattice::Scene& scene, const lattice::Recordings& recordings);

}  // namespace gatewalk::cli
