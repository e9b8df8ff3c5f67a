// SPDX-License-Identifier: MIT
#pragma once
// clang-format off
/// The result of `trace`; and runs to be watched: a page with an animation, made of a film.
///
/// The page reads the film as JSON:
///   {"title": text, "radius_m", "beam_m", "joint_x_m", "joint_y_m": of the body and the beams,
///    "scale": {"length_m", "mass_kg", "time_s"}: the scene's own units (dynamics::Scale), in which all that is
///    drawn and timed is a plain number; at normal speed one such unit of time takes a second,
///    "gate_m": [width, depth], "columns", "rows": the field's gates (1 x 1: a gate alone), "start_column",
///    "runs": [run, ...]}
/// A run is {"label": text, "ending": text, "propulsion_N": number} and arrays with an entry for each step:
///   t (s, uneven steps allowed), gx, gy (the gate the body is in: i_x, i_y), x, y (m, in the gate's frame),
///   vx, vy (m/s), left, right (deflection of the gate's beams, rad), contact_left, contact_right (0 free,
///   1 hit, 2 held), random_N, body_J, beams_J (kinetic), elastic_J, work_J (of propulsion and random force
///   so far), lost_J (so far), and perhaps lost_in_hits_J. A force and a contact hold until the next entry.
// clang-format on

#include <string>

#include <optional>

#include "cli/film/film.h"
#include "cli/render/choice.h"
#include "cli/render/fields.h"
#include "cli/render/provenance.h"

namespace gatewalk::cli {

/// The result of `trace`.
struct TraceResult {
  lattice::Recordings recordings;
  Film film{};                         // of the recordings
  std::optional<double> film_speed{};  // of a video: seconds of a run in one of it
  std::optional<lattice::Settled> method{};
  ActionMethods may_do{};  // under a policy
  Provenance made_by{};
};
void describe(Fields& out, const TraceResult& result);

/// The film as above, with lost_in_hits_J.
void describe(Fields& out, const Film& film);

/// A whole page with the animation of all runs of a film; it loads nothing from anywhere. Where
/// data are missing, the page says which.
[[nodiscard]] std::string replay_page(const Film& film);

}  // namespace gatewalk::cli
